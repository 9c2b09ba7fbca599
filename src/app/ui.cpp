// ui.h over Dear ImGui. Widgets that an artist looks at all day (bars of numbers, toggles,
// headings, icons) are drawn here by hand; the rest is ImGui's, restyled. Input comes through
// ImGui's GLFW backend, triangles leave as a roil_picture.
#include "app/ui.h"
#include "app/ui_parts.h"
#include "base/memory.h"
#include "base/str.h"
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <cfloat>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <imgui.h>
#include <imgui_internal.h>

static_assert(sizeof(ImDrawVert) == sizeof(roil_vertex), "vertices are copied as they are");
static_assert(offsetof(ImDrawVert, uv) == offsetof(roil_vertex, u), "vertices are copied");
static_assert(offsetof(ImDrawVert, col) == offsetof(roil_vertex, color), "vertices are copied");

namespace {

enum { MAX_TABLES = 8 };
const float LABEL_SHARE = 0.4f, TEXT_SIZE = 16, TIP_SECONDS = 0.45f, TIP_WIDTH = 340;

struct state {
    GLFWwindow *window;
    roil *r;
    roil_texture *atlas;
    char *layout;
    float scale;
    ImFont *fonts[FONT_KIND_COUNT];
    // of the picture
    roil_vertex *vertices;
    uint32_t *indices;
    roil_draw *draws;
    size_t vertex_capacity, index_capacity, draw_capacity;
    // of the next widget
    bool has_width;
    float width;
    // between begin and end
    int depth;               // of panels and windows
    bool panel;              // the outermost is one
    bool tables[MAX_TABLES]; // that are open, and visible
    int table_depth;
    ImVec2 tip_at; // where the pointer rests on a widget
    float tip_seconds;
    ImGuiID bare;   // area where a button was pressed that no panel covers; 0: none
    ImGuiID typing; // number in which text is typed
    char typed[64], typed_first[64];
} ui;

const ImU32 colors[UI_COLOR_COUNT] = {
    IM_COL32(222, 222, 222, 255), // text
    IM_COL32(142, 142, 142, 255), // dim
    IM_COL32(240, 146, 62, 255),  // accent
    IM_COL32(132, 182, 110, 255), // good
    IM_COL32(228, 180, 76, 255),  // warning
    IM_COL32(232, 102, 84, 255),  // error
    IM_COL32(36, 36, 36, 255),    // panel
    IM_COL32(24, 24, 24, 255),    // field
    IM_COL32(58, 58, 58, 255),    // line
};
const ImU32 RAISED = IM_COL32(54, 54, 54, 255), RAISED_HOVER = IM_COL32(68, 68, 68, 255),
            RAISED_ACTIVE = IM_COL32(82, 82, 82, 255), FILLED = IM_COL32(74, 74, 74, 255),
            FILLED_HOVER = IM_COL32(86, 86, 86, 255), FILLED_ACTIVE = IM_COL32(138, 86, 40, 255);

ImVec4 rgba(ImU32 color) {
    return ImGui::ColorConvertU32ToFloat4(color);
}

ImDrawList *list() { // outside of panels: behind them
    return ui.depth ? ImGui::GetWindowDrawList() : ImGui::GetBackgroundDrawList();
}

// ---- style ------------------------------------------------------------------------------------

void set_sizes(ImGuiStyle &s) {
    s.WindowPadding = ImVec2(12, 12);
    s.FramePadding = ImVec2(8, 4);
    s.ItemSpacing = ImVec2(8, 6);
    s.ItemInnerSpacing = ImVec2(6, 4);
    s.CellPadding = ImVec2(6, 3);
    s.ScrollbarSize = 10;
    s.GrabMinSize = 10;
    s.WindowRounding = 6;
    s.PopupRounding = 6;
    s.FrameRounding = 4;
    s.TabRounding = 4;
    s.ScrollbarRounding = 5;
    s.GrabRounding = 4;
    s.WindowBorderSize = s.PopupBorderSize = 1;
    s.FrameBorderSize = s.TabBorderSize = 0;
    s.WindowTitleAlign = ImVec2(0, 0.5f);
    s.WindowMenuButtonPosition = ImGuiDir_None;
    s.DisabledAlpha = 0.45f;
    s.CurveTessellationTol = 0.8f;
    s.CircleTessellationMaxError = 0.2f;
}

void set_colors(ImVec4 *c) {
    static const struct {
        ImGuiCol at;
        ImU32 color;
    } rows[] = {
        {ImGuiCol_Text, colors[UI_TEXT]},
        {ImGuiCol_TextDisabled, colors[UI_DIM]},
        {ImGuiCol_WindowBg, colors[UI_PANEL]},
        {ImGuiCol_PopupBg, IM_COL32(44, 44, 44, 255)},
        {ImGuiCol_Border, IM_COL32(14, 14, 14, 255)},
        {ImGuiCol_FrameBg, RAISED},
        {ImGuiCol_FrameBgHovered, RAISED_HOVER},
        {ImGuiCol_FrameBgActive, RAISED_ACTIVE},
        {ImGuiCol_TitleBg, IM_COL32(44, 44, 44, 255)},
        {ImGuiCol_TitleBgActive, IM_COL32(50, 50, 50, 255)},
        {ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0)},
        {ImGuiCol_ScrollbarGrab, IM_COL32(66, 66, 66, 255)},
        {ImGuiCol_ScrollbarGrabHovered, IM_COL32(84, 84, 84, 255)},
        {ImGuiCol_ScrollbarGrabActive, IM_COL32(104, 104, 104, 255)},
        {ImGuiCol_CheckMark, colors[UI_ACCENT]},
        {ImGuiCol_Button, RAISED},
        {ImGuiCol_ButtonHovered, RAISED_HOVER},
        {ImGuiCol_ButtonActive, RAISED_ACTIVE},
        {ImGuiCol_Header, IM_COL32(240, 146, 62, 52)},
        {ImGuiCol_HeaderHovered, IM_COL32(255, 255, 255, 26)},
        {ImGuiCol_HeaderActive, IM_COL32(255, 255, 255, 40)},
        {ImGuiCol_Separator, colors[UI_LINE]},
        {ImGuiCol_ResizeGrip, IM_COL32(255, 255, 255, 20)},
        {ImGuiCol_ResizeGripHovered, IM_COL32(255, 255, 255, 60)},
        {ImGuiCol_ResizeGripActive, colors[UI_ACCENT]},
        {ImGuiCol_Tab, IM_COL32(0, 0, 0, 0)},
        {ImGuiCol_TabHovered, RAISED_HOVER},
        {ImGuiCol_TabActive, RAISED},
        {ImGuiCol_TabUnfocused, IM_COL32(0, 0, 0, 0)},
        {ImGuiCol_TabUnfocusedActive, RAISED},
        {ImGuiCol_TextSelectedBg, IM_COL32(240, 146, 62, 90)},
        {ImGuiCol_NavHighlight, IM_COL32(0, 0, 0, 0)},
    };
    for (const auto &row : rows) c[row.at] = rgba(row.color);
}

void load_font(ImFontAtlas *atlas, font_kind kind) {
    // Latin, punctuation, arrows, and the mathematical signs of units
    static const ImWchar ranges[] = {0x20,   0x17f,  0x2010, 0x203a, 0x2190, 0x2193, 0x2212, 0x2212,
                                     0x221e, 0x221e, 0x2248, 0x2248, 0x2264, 0x2265, 0};
    ImFontConfig config;
    config.OversampleH = 3;
    config.OversampleV = 1;
    config.FontDataOwnedByAtlas = false;
    float size = TEXT_SIZE * ui.scale * (kind == FONT_MONO ? 0.92f : 1);
    font_file file = font_read(kind);
    config.FontNo = file.face;
    if (file.data) // copied
        ui.fonts[kind] =
            atlas->AddFontFromMemoryTTF(file.data, (int)file.size, floorf(size), &config, ranges);
    else
        ui.fonts[kind] = atlas->AddFontDefault();
    font_free(&file);
}

bool load_atlas() {
    ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    atlas->Clear();
    for (int kind = 0; kind < FONT_KIND_COUNT; kind++) load_font(atlas, (font_kind)kind);
    unsigned char *pixels;
    int width, height;
    if (!atlas->Build()) { // a damaged file: the built-in font is always there
        atlas->Clear();
        for (auto &font : ui.fonts) font = atlas->AddFontDefault();
    }
    atlas->GetTexDataAsRGBA32(&pixels, &width, &height);
    roil_texture_destroy(ui.r, ui.atlas);
    ui.atlas = roil_texture_create(ui.r, (uint32_t)width, (uint32_t)height, pixels);
    atlas->SetTexID(ui.atlas);
    atlas->ClearTexData();
    return ui.atlas;
}

} // namespace

// ---- life -------------------------------------------------------------------------------------

bool ui_open(GLFWwindow *window, roil *r, const char *layout) {
    ui = state();
    ui.window = window;
    ui.r = r;
    if (layout) ui.layout = (char *)mem_copy(layout, strlen(layout) + 1);
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = ui.layout;
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    ImGui_ImplGlfw_InitForOther(window, true);
    ui_set_scale(1);
    if (ui.atlas) return true;
    ui_close();
    return false;
}

void ui_close(void) {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    roil_texture_destroy(ui.r, ui.atlas);
    mem_free(ui.vertices);
    mem_free(ui.indices);
    mem_free(ui.draws);
    mem_free(ui.layout);
    ui = state();
}

void ui_set_scale(float scale) {
    if (scale == ui.scale) return;
    ui.scale = scale;
    ImGuiStyle style;
    set_sizes(style);
    style.ScaleAllSizes(scale);
    set_colors(style.Colors);
    ImGui::GetStyle() = style;
    load_atlas();
}

float ui_scale(void) {
    return ui.scale;
}

// GLFW counts the pointer in screen coordinates, which a display of high density makes coarser than
// pixels. Everything here is in pixels.
static void use_pixels(ImGuiIO &io) {
    int width, height;
    glfwGetFramebufferSize(ui.window, &width, &height);
    ImVec2 ratio = io.DisplayFramebufferScale;
    if (ImGui::IsMousePosValid(&io.MousePos))
        io.MousePos = ImVec2(io.MousePos.x * ratio.x, io.MousePos.y * ratio.y);
    io.DisplaySize = ImVec2((float)width, (float)height);
    io.DisplayFramebufferScale = ImVec2(1, 1);
}

void ui_begin(void) {
    ImGuiIO &io = ImGui::GetIO();
    // Tab walks through fields only while one is typed in; else it is the program's own.
    io.KeyMap[ImGuiKey_Tab] = io.WantTextInput ? GLFW_KEY_TAB : -1;
    ImGui_ImplGlfw_NewFrame();
    use_pixels(io);
    io.DeltaTime = fminf(io.DeltaTime, 0.1f); // the loop may have slept
    ImGui::NewFrame();
    if (!ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(1) && !ImGui::IsMouseDown(2)) ui.bare = 0;
}

static void take_list(const ImDrawList *from, roil_picture *out) {
    size_t vertices = out->vertex_count, indices = out->index_count, draws = out->draw_count;
    size_t more = (size_t)from->VtxBuffer.Size, more_indices = (size_t)from->IdxBuffer.Size;
    ui.vertices = (roil_vertex *)mem_reserve(ui.vertices, sizeof *ui.vertices, vertices + more,
                                             &ui.vertex_capacity);
    ui.indices = (uint32_t *)mem_reserve(ui.indices, sizeof *ui.indices, indices + more_indices,
                                         &ui.index_capacity);
    ui.draws = (roil_draw *)mem_reserve(ui.draws, sizeof *ui.draws,
                                        draws + (size_t)from->CmdBuffer.Size, &ui.draw_capacity);
    if (more)
        memcpy((void *)(ui.vertices + vertices), from->VtxBuffer.Data, more * sizeof(ImDrawVert));
    for (const ImDrawCmd &cmd : from->CmdBuffer) {
        if (!cmd.ElemCount || cmd.UserCallback) continue;
        roil_draw *draw = &ui.draws[out->draw_count++];
        draw->texture = (const roil_texture *)cmd.GetTexID();
        draw->first = (uint32_t)out->index_count;
        draw->count = cmd.ElemCount;
        memcpy(draw->clip, &cmd.ClipRect, sizeof draw->clip);
        const ImDrawIdx *index = from->IdxBuffer.Data + cmd.IdxOffset;
        uint32_t base = (uint32_t)vertices + cmd.VtxOffset;
        for (unsigned i = 0; i < cmd.ElemCount; i++)
            ui.indices[out->index_count++] = base + index[i];
    }
    out->vertex_count += more;
}

void ui_end(roil_picture *out) {
    ImGui::Render();
    out->vertex_count = out->index_count = out->draw_count = 0;
    const ImDrawData *data = ImGui::GetDrawData();
    for (int i = 0; i < data->CmdListsCount; i++) take_list(data->CmdLists[i], out);
    out->vertices = ui.vertices;
    out->indices = ui.indices;
    out->draws = ui.draws;
}

bool ui_wants_mouse(void) {
    return ImGui::GetIO().WantCaptureMouse;
}

bool ui_wants_keys(void) {
    return ImGui::GetIO().WantTextInput;
}

void ui_copy(const char *text) {
    ImGui::SetClipboardText(text);
}

// ---- windows and layout -----------------------------------------------------------------------

static const ImGuiWindowFlags STILL = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoBringToFrontOnFocus;

void ui_panel_begin(const char *name, ui_rect where) {
    ImGui::SetNextWindowPos(ImVec2(where.left, where.top));
    ImGui::SetNextWindowSize(ImVec2(where.right - where.left, where.bottom - where.top));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::Begin(name, nullptr, STILL);
    ImGui::PopStyleVar(3);
    if (!ui.depth++) ui.panel = true;
}

void ui_panel_end(void) {
    ui.depth--;
    ImGui::End();
}

bool ui_window_begin(const char *title, bool *open, ui_rect where, bool fixed) {
    ImGui::SetNextWindowPos(ImVec2(where.left, where.top), ImGuiCond_FirstUseEver);
    if (!fixed)
        ImGui::SetNextWindowSize(ImVec2(where.right - where.left, where.bottom - where.top),
                                 ImGuiCond_FirstUseEver);
    ImGui::PushFont(ui.fonts[FONT_STRONG]); // of the title
    bool visible = ImGui::Begin(
        title, open, ImGuiWindowFlags_NoCollapse | (fixed ? ImGuiWindowFlags_AlwaysAutoResize : 0));
    ImGui::PopFont();
    if (!ui.depth++) ui.panel = false;
    return visible;
}

void ui_window_end(void) {
    ui_panel_end();
}

ui_rect ui_space(void) {
    ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    return {at.x, at.y, at.x + room.x, at.y + room.y};
}

void ui_same_line(void) {
    ImGui::SameLine();
}

void ui_align_right(float width) {
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width);
}

void ui_gap(float height) {
    ImGui::Dummy(ImVec2(0, fmaxf(height - ImGui::GetStyle().ItemSpacing.y, 0)));
}

void ui_separator(void) {
    ImGui::Separator();
}

void ui_width(float width) {
    ui.has_width = true;
    ui.width = width;
}

static float take_width(void) {
    float room = ImGui::GetContentRegionAvail().x, wanted = ui.has_width ? ui.width : 0;
    ui.has_width = false;
    return floorf(fmaxf(wanted > 0 ? wanted : room + wanted, 1));
}

void ui_push(const char *id) {
    ImGui::PushID(id);
}

void ui_pop(void) {
    ImGui::PopID();
}

void ui_disable_begin(bool disabled) {
    ImGui::BeginDisabled(disabled);
}

void ui_disable_end(void) {
    ImGui::EndDisabled();
}

bool ui_section(const char *label, bool open) {
    bool *is_open = ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID(label), open);
    float height = ImGui::GetFrameHeight(), s = ui.scale;
    ImVec2 at = ImGui::GetCursorScreenPos();
    float width = fmaxf(ImGui::GetContentRegionAvail().x, 1);
    if (ImGui::InvisibleButton(label, ImVec2(width, height))) *is_open = !*is_open;
    ImGui::SetItemAllowOverlap(); // buttons may stand at its right end
    bool hovered = ImGui::IsItemHovered();
    ui_fill({at.x, at.y, at.x + width, at.y + height},
            hovered ? IM_COL32(58, 58, 58, 255) : IM_COL32(46, 46, 46, 255), 4 * s);
    float x = at.x + 13 * s, y = at.y + height / 2, r = 4 * s;
    if (*is_open)
        ui_triangle(x - r, y - r / 2, x + r, y - r / 2, x, y + r * 0.6f, colors[UI_DIM]);
    else
        ui_triangle(x - r / 2, y - r, x + r * 0.6f, y, x - r / 2, y + r, colors[UI_DIM]);
    ImFont *font = ui.fonts[FONT_STRONG];
    list()->AddText(font, font->FontSize, ImVec2(at.x + 26 * s, y - font->FontSize / 2),
                    ImGui::GetColorU32(ImGuiCol_Text), label, ImGui::FindRenderedTextEnd(label));
    return *is_open;
}

bool ui_tabs_begin(const char *id) {
    return ImGui::BeginTabBar(id, ImGuiTabBarFlags_FittingPolicyScroll);
}

void ui_tabs_end(void) {
    ImGui::EndTabBar();
}

bool ui_tab_begin(const char *label) {
    return ImGui::BeginTabItem(label);
}

void ui_tab_end(void) {
    ImGui::EndTabItem();
}

void ui_table_begin(const char *id, int columns, const float *widths) {
    IM_ASSERT(ui.table_depth < MAX_TABLES);
    bool visible = ImGui::BeginTable(
        id, columns, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_NoSavedSettings);
    for (int i = 0; visible && i < columns; i++)
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, widths[i]);
    ui.tables[ui.table_depth++] = visible;
}

void ui_table_next(void) {
    if (ui.tables[ui.table_depth - 1]) ImGui::TableNextColumn();
}

void ui_table_end(void) {
    if (ui.tables[--ui.table_depth]) ImGui::EndTable();
}

// ---- text -------------------------------------------------------------------------------------

static void text_of(ImU32 color, const char *format, va_list args) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextV(format, args);
    ImGui::PopStyleColor();
}

void ui_text(const char *format, ...) {
    va_list args;
    va_start(args, format);
    text_of(colors[UI_TEXT], format, args);
    va_end(args);
}

void ui_text_color(ui_color color, const char *format, ...) {
    va_list args;
    va_start(args, format);
    text_of(colors[color], format, args);
    va_end(args);
}

void ui_text_wrapped(const char *text) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
}

void ui_text_mono(ui_color color, const char *text) {
    ImGui::PushFont(ui.fonts[FONT_MONO]);
    ImGui::PushStyleColor(ImGuiCol_Text, colors[color]);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

// After the pointer has rested for a moment, so that nothing flickers along its way.
void ui_tooltip(const char *text) {
    if (!text || !text[0] || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImVec2 at = ImGui::GetItemRectMin();
    bool same = at.x == ui.tip_at.x && at.y == ui.tip_at.y && !ImGui::IsAnyMouseDown();
    ui.tip_seconds = same ? ui.tip_seconds + ImGui::GetIO().DeltaTime : 0;
    ui.tip_at = at;
    if (ui.tip_seconds < TIP_SECONDS) return;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10 * ui.scale, 7 * ui.scale));
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(TIP_WIDTH * ui.scale);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

float ui_text_width(const char *text) {
    return ImGui::CalcTextSize(text).x;
}

float ui_line_height(void) {
    return ImGui::GetTextLineHeightWithSpacing();
}

// ---- widgets ----------------------------------------------------------------------------------

static ImU32 with_alpha(ImU32 color) { // of what is disabled
    return ImGui::GetColorU32(rgba(color));
}

static bool is_shown(const char *label) {
    return ImGui::FindRenderedTextEnd(label) != label;
}

static void put_text(ui_rect area, ImU32 color, const char *text, float align) {
    const char *end = ImGui::FindRenderedTextEnd(text);
    ImVec2 size = ImGui::CalcTextSize(text, end);
    float room = area.right - area.left, x = area.left + fmaxf(room - size.x, 0) * align;
    float y = floorf((area.top + area.bottom - size.y) / 2);
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::RenderTextEllipsis(list(), ImVec2(floorf(x), y), ImVec2(area.right, area.bottom),
                              area.right, area.right, text, end, &size);
    ImGui::PopStyleColor();
}

// A row is one item to what asks about the last one: the label, if it is shown, and the widget, for
// which the width is returned.
static float row_begin(const char *label) {
    float width = take_width();
    ImGui::BeginGroup();
    ImGui::PushID(label);
    if (!is_shown(label)) return width;
    ImVec2 at = ImGui::GetCursorScreenPos();
    float column = floorf(width * LABEL_SHARE), height = ImGui::GetFrameHeight();
    ImGui::Dummy(ImVec2(column, height));
    put_text({at.x, at.y, at.x + column - 6 * ui.scale, at.y + height}, with_alpha(colors[UI_TEXT]),
             label, 0);
    ImGui::SameLine(0, 0);
    return width - column;
}

static void row_end(void) {
    ImGui::PopID();
    ImGui::EndGroup();
}

bool ui_button(const char *label) {
    float width = ui.has_width ? take_width() : 0;
    return ImGui::Button(label, ImVec2(width, 0));
}

bool ui_small_button(const char *label) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(6 * ui.scale, 0));
    bool pressed = ImGui::Button(label);
    ImGui::PopStyleVar();
    return pressed;
}

bool ui_icon_button(const char *id, int icon, bool active, const char *tooltip) {
    ImVec2 at = ImGui::GetCursorScreenPos();
    float side = ImGui::GetFrameHeight(), inset = floorf(side * 0.18f);
    bool pressed = ImGui::InvisibleButton(id, ImVec2(side, side));
    ui_rect area = {at.x, at.y, at.x + side, at.y + side};
    bool hovered = ImGui::IsItemHovered();
    if (hovered) ui_fill(area, ImGui::IsItemActive() ? RAISED_ACTIVE : RAISED_HOVER, 4 * ui.scale);
    ui_color color = active ? UI_ACCENT : hovered ? UI_TEXT : UI_DIM;
    icon_draw(icon, {area.left + inset, area.top + inset, area.right - inset, area.bottom - inset},
              with_alpha(colors[color]));
    ui_tooltip(tooltip);
    return pressed;
}

bool ui_toggle(const char *label, bool *value) {
    bool column = ui.has_width, shown = is_shown(label);
    float s = ui.scale, height = ImGui::GetFrameHeight(), track = 30 * s;
    if (column) {
        row_begin(label);
    } else {
        ImGui::BeginGroup();
        ImGui::PushID(label);
    }
    ImVec2 at = ImGui::GetCursorScreenPos();
    float text = column || !shown ? 0 : 7 * s + ImGui::CalcTextSize(label, nullptr, true).x;
    bool changed = ImGui::InvisibleButton("##value", ImVec2(track + text, height));
    ImGuiID id = ImGui::GetItemID();
    if (changed) {
        *value = !*value;
        ImGui::MarkItemEdited(id);
    }
    bool hovered = ImGui::IsItemHovered();
    float y = at.y + height / 2, r = 8 * s, knob = at.x + (*value ? track - r : r);
    ImU32 fill = *value ? (hovered ? IM_COL32(250, 160, 80, 255) : colors[UI_ACCENT])
                        : (hovered ? RAISED_ACTIVE : RAISED_HOVER);
    ui_fill({at.x, y - r, at.x + track, y + r}, with_alpha(fill), r);
    ui_disc(knob, y, r - 2.5f * s,
            with_alpha(*value ? IM_COL32(30, 24, 18, 255) : colors[UI_TEXT]));
    if (text > 0)
        put_text({at.x + track + 7 * s, at.y, at.x + track + text + 1, at.y + height},
                 with_alpha(colors[UI_TEXT]), label, 0);
    row_end();
    return changed;
}

bool ui_selectable(const char *label, bool selected) {
    return ImGui::Selectable(label, selected);
}

bool ui_choice(const char *label, size_t *index, const char *const *words, size_t count) {
    bool changed = false;
    float width = row_begin(label), height = ImGui::GetFrameHeight(), s = ui.scale;
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::SetNextItemWidth(width);
    const char *now = *index < count ? words[*index] : "";
    bool open = ImGui::BeginCombo("##value", now,
                                  ImGuiComboFlags_NoArrowButton | ImGuiComboFlags_HeightLarge);
    for (size_t i = 0; open && i < count; i++) {
        ImGui::PushID((int)i);
        if (ImGui::Selectable(words[i], i == *index) && i != *index) {
            *index = i;
            changed = true;
        }
        if (i == *index) ImGui::SetItemDefaultFocus();
        ImGui::PopID();
    }
    if (open) ImGui::EndCombo();
    float x = at.x + width - 13 * s, y = at.y + height / 2, r = 4 * s;
    ui_triangle(x - r, y - r / 2, x + r, y - r / 2, x, y + r * 0.6f, with_alpha(colors[UI_DIM]));
    row_end();
    return changed;
}

bool ui_input(const char *label, const char *hint, char *text, size_t capacity) {
    ImGui::SetNextItemWidth(row_begin(label));
    bool changed = ImGui::InputTextWithHint("##value", hint ? hint : "", text, capacity);
    row_end();
    return changed;
}

// ---- numbers ----------------------------------------------------------------------------------

// The text takes the bar's place until Return or a click elsewhere; Escape leaves the number as it
// was.
static bool bar_type(const ImRect &box, ImGuiID id, double *value, const number_range *range) {
    if (ui.typing != id) {
        ui.typing = id;
        number_text(range, *value, ui.typed, sizeof ui.typed);
        str_copy(ui.typed_first, sizeof ui.typed_first, ui.typed);
    }
    ImGui::TempInputText(box, id, "##typed", ui.typed, (int)sizeof ui.typed,
                         ImGuiInputTextFlags_CharsScientific | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::TempInputIsActive(id)) return false;
    ui.typing = 0;
    double typed;
    if (strcmp(ui.typed, ui.typed_first) == 0 || !number_parse(range, ui.typed, &typed) ||
        typed == *value)
        return false;
    *value = typed;
    return true;
}

static bool bar_drag(ImGuiID id, double *value, const number_range *range, float width) {
    static double exact; // where the pointer is; `value` is rounded
    ImGuiContext &g = *GImGui;
    if (g.ActiveId != id || g.ActiveIdSource != ImGuiInputSource_Mouse) return false;
    if (!g.IO.MouseDown[0]) {
        ImGui::ClearActiveID();
        return false;
    }
    if (g.ActiveIdIsJustActivated) exact = *value;
    float pixels = g.IO.MouseDelta.x * (g.IO.KeyShift ? 0.1f : 1);
    if (g.ActiveIdIsJustActivated || pixels == 0) return false;
    exact = number_drag(range, exact, (double)pixels, (double)width);
    double rounded = number_round(range, exact);
    if (rounded == *value) return false;
    *value = rounded;
    ImGui::MarkItemEdited(id);
    return true;
}

static void bar_draw(ui_rect box, double value, const number_range *range, const char *unit,
                     bool hovered, bool held) {
    float s = ui.scale, width = box.right - box.left, round = 4 * s;
    ui_fill(box, with_alpha(colors[UI_FIELD]), round);
    if (number_is_bounded(range)) {
        float x = box.left + width * (float)number_to_share(range, value);
        list()->PushClipRect(ImVec2(box.left, box.top), ImVec2(x, box.bottom), true);
        ui_fill(box, with_alpha(held ? FILLED_ACTIVE : hovered ? FILLED_HOVER : FILLED), round);
        list()->PopClipRect();
        float edge = fminf(fmaxf(x, box.left + s), box.right - s);
        ui_fill({edge - s, box.top + 3 * s, edge + s, box.bottom - 3 * s},
                with_alpha(held || hovered ? colors[UI_ACCENT] : IM_COL32(150, 120, 94, 255)), s);
    } else if (hovered || held) {
        ui_frame(box, held ? colors[UI_ACCENT] : RAISED_ACTIVE, round, s);
    }
    char text[64];
    number_text(range, value, text, sizeof text);
    float digits = ImGui::CalcTextSize(text).x, pad = 8 * s;
    float behind = unit && unit[0] ? ImGui::CalcTextSize(unit).x + 4 * s : 0;
    if (digits + behind + 2 * pad > width) {
        put_text({box.left + 2 * s, box.top, box.right - 2 * s, box.bottom},
                 with_alpha(colors[UI_TEXT]), text, 0.5f);
        return;
    }
    ui_rect inside = {box.left + pad, box.top, box.right - pad - behind, box.bottom};
    put_text(inside, with_alpha(colors[UI_TEXT]), text, 1);
    if (behind > 0)
        put_text({inside.right + 4 * s, box.top, box.right, box.bottom}, with_alpha(colors[UI_DIM]),
                 unit, 0);
}

static bool bar(const char *name, double *value, const number_range *range, const char *unit,
                float width) {
    ImGuiContext &g = *GImGui;
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    ImGuiID id = window->GetID(name);
    ImVec2 at = window->DC.CursorPos, size(width, ImGui::GetFrameHeight());
    ImRect box(at, ImVec2(at.x + size.x, at.y + size.y));
    ImGui::ItemSize(size, g.Style.FramePadding.y);
    if (!ImGui::ItemAdd(box, id, nullptr, ImGuiItemFlags_Inputable)) return false;
    bool hovered = ImGui::ItemHoverable(box, id), typing = ImGui::TempInputIsActive(id);
    bool tabbed = (g.LastItemData.StatusFlags & ImGuiItemStatusFlags_FocusedByTabbing) != 0;
    if (!typing && (tabbed || (hovered && g.IO.MouseClicked[0]))) {
        ImGui::SetActiveID(id, window);
        ImGui::SetFocusID(id, window);
        ImGui::FocusWindow(window);
        g.ActiveIdSource = ImGuiInputSource_Mouse;
        typing = tabbed || g.IO.KeyCtrl || g.IO.MouseDoubleClicked[0];
    }
    if (typing) return bar_type(box, id, value, range);
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    bool changed = bar_drag(id, value, range, width);
    bar_draw({box.Min.x, box.Min.y, box.Max.x, box.Max.y}, *value, range, unit, hovered,
             g.ActiveId == id);
    return changed;
}

bool ui_number(const char *label, float *value, int components, float min, float max,
               bool log_scale, const char *unit) {
    const number_range range = {(double)min, (double)max, log_scale, false};
    float width = row_begin(label), gap = 3 * ui.scale, left = width;
    bool changed = false;
    for (int i = 0; i < components; i++) {
        char name[16];
        snprintf(name, sizeof name, "##%d", i);
        double v = (double)value[i];
        float part = floorf((left - gap * (float)(components - 1 - i)) / (float)(components - i));
        if (i) ImGui::SameLine(0, gap);
        if (bar(name, &v, &range, unit, fmaxf(part, 1))) {
            value[i] = (float)v;
            changed = true;
        }
        left -= part + gap;
    }
    row_end();
    return changed;
}

bool ui_whole(const char *label, int *value, int min, int max, const char *unit) {
    const number_range range = {(double)min, (double)max, false, true};
    double v = *value;
    bool changed = bar("##value", &v, &range, unit, row_begin(label));
    if (changed) *value = (int)v;
    row_end();
    return changed;
}

// ---- colours ----------------------------------------------------------------------------------

static void swatch(ui_rect box, const float *linear, int components) {
    float round = 4 * ui.scale, middle = (box.left + box.right) / 2;
    const float opacity = components == 4 ? linear[3] : 1;
    if (opacity < 1) {
        ui_checkers({middle, box.top, box.right, box.bottom}, 6 * ui.scale);
        ui_fill({middle, box.top, box.right, box.bottom}, ui_pack(linear, opacity), 0);
        ui_fill({box.left, box.top, middle, box.bottom}, ui_pack(linear, 1), 0);
    } else {
        ui_fill(box, ui_pack(linear, 1), round);
    }
    ui_frame(box, IM_COL32(255, 255, 255, 30), opacity < 1 ? 0 : round, ui.scale);
    char text[64];
    color_text(linear, text, sizeof text);
    float light = 0.2126f * linear[0] + 0.7152f * linear[1] + 0.0722f * linear[2];
    bool dark = light * opacity + 0.05f * (1 - opacity) < 0.2f;
    put_text({box.left + 8 * ui.scale, box.top, box.right - 8 * ui.scale, box.bottom},
             with_alpha(dark ? IM_COL32(225, 225, 225, 255) : IM_COL32(20, 20, 20, 255)), text, 1);
}

bool ui_color_edit(const char *label, float *linear, int components) {
    bool changed = false;
    float width = row_begin(label);
    ImVec2 at = ImGui::GetCursorScreenPos(), size(width, ImGui::GetFrameHeight());
    if (ImGui::InvisibleButton("##swatch", size)) ImGui::OpenPopup("picker");
    ImGuiID id = ImGui::GetItemID();
    swatch({at.x, at.y, at.x + size.x, at.y + size.y}, linear, components);
    if (ImGui::BeginPopup("picker")) {
        ui.depth++;
        changed = color_picker(linear, components);
        ui.depth--;
        ImGui::EndPopup();
    }
    if (changed) ImGui::MarkItemEdited(id);
    row_end();
    return changed;
}

// ---- about the last widget --------------------------------------------------------------------

bool ui_active(void) {
    return ImGui::IsItemActive();
}

bool ui_released(void) {
    return ImGui::IsItemDeactivatedAfterEdit();
}

bool ui_hovered(void) {
    return ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled);
}

bool ui_menu_begin(const char *id) {
    return ImGui::BeginPopupContextItem(id);
}

void ui_menu_end(void) {
    ImGui::EndPopup();
}

bool ui_item(const char *label) {
    return ImGui::MenuItem(label);
}

// ---- canvas -----------------------------------------------------------------------------------

static ui_canvas canvas_of(ui_rect area, bool hovered) {
    const ImGuiIO &io = ImGui::GetIO();
    ui_canvas c = {};
    c.area = area;
    c.x = io.MousePos.x;
    c.y = io.MousePos.y;
    c.hovered = hovered;
    c.pressed = hovered && io.MouseClicked[0];
    c.right_pressed = hovered && io.MouseClicked[1];
    c.double_clicked = hovered && io.MouseDoubleClicked[0];
    c.dx = io.MouseDelta.x;
    c.dy = io.MouseDelta.y;
    c.wheel = hovered ? io.MouseWheel : 0;
    c.shift = io.KeyShift;
    c.control = io.KeyCtrl;
    return c;
}

ui_canvas ui_canvas_begin(const char *id, float width, float height) {
    const ImGuiIO &io = ImGui::GetIO();
    ImVec2 at = ImGui::GetCursorScreenPos();
    float wide = fmaxf(width > 0 ? width : ImGui::GetContentRegionAvail().x, 1);
    height = fmaxf(height, 1);
    ImGui::InvisibleButton(id, ImVec2(wide, height),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    bool active = ImGui::IsItemActive();
    if (!ui.panel) ImGui::SetItemUsingMouseWheel();
    ui_canvas c = canvas_of({at.x, at.y, at.x + wide, at.y + height}, ImGui::IsItemHovered());
    c.held = active && io.MouseDown[0];
    c.middle_held = active && io.MouseDown[2];
    c.released = (active || ImGui::IsItemDeactivated()) && io.MouseReleased[0];
    list()->PushClipRect(at, ImVec2(c.area.right, c.area.bottom), true);
    return c;
}

void ui_canvas_end(void) {
    list()->PopClipRect();
}

static ui_canvas bare(ImGuiID id, ui_rect area) {
    const ImGuiIO &io = ImGui::GetIO();
    bool inside = io.MousePos.x >= area.left && io.MousePos.x < area.right &&
                  io.MousePos.y >= area.top && io.MousePos.y < area.bottom;
    bool free = !io.WantCaptureMouse && !ui.bare && inside;
    ui_canvas c = canvas_of(area, free);
    if (free && (io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2])) {
        ui.bare = id;
        ImGui::ClearActiveID(); // ends typing
    }
    c.held = ui.bare == id && io.MouseDown[0];
    c.middle_held = ui.bare == id && io.MouseDown[2];
    c.released = ui.bare == id && io.MouseReleased[0];
    return c;
}

ui_canvas ui_bare(ui_rect area) {
    const float corner[2] = {area.left, area.top};
    return bare(ImHashData(corner, sizeof corner), area);
}

bool ui_splitter(ui_rect area, float *position) {
    ui_canvas c = bare(ImHashStr("splitter"), area);
    if (c.hovered || c.held) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    ui_fill(area, colors[UI_FIELD], 0);
    if (c.hovered || c.held) ui_fill(area, ui_rgba(UI_ACCENT, c.held ? 1 : 0.6f), 0);
    if (c.held) *position = c.x;
    return c.held;
}

uint32_t ui_rgba(ui_color color, float alpha) {
    return (colors[color] & 0xffffffu) | (uint32_t)(alpha * 255 + 0.5f) << 24;
}

uint32_t ui_pack(const float rgb[3], float alpha) {
    uint32_t out = (uint32_t)(fminf(fmaxf(alpha, 0), 1) * 255 + 0.5f) << 24;
    for (int i = 0; i < 3; i++) {
        float v = fminf(fmaxf(rgb[i], 0), 1);
        float encoded = v <= 0.0031308f ? v * 12.92f : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
        out |= (uint32_t)(encoded * 255 + 0.5f) << (8 * i);
    }
    return out;
}

void ui_line(float x0, float y0, float x1, float y1, uint32_t color, float width) {
    list()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color, width);
}

void ui_polyline(const float *xy, size_t count, uint32_t color, float width) {
    static_assert(sizeof(ImVec2) == 2 * sizeof *xy, "points are pairs");
    list()->AddPolyline((const ImVec2 *)xy, (int)count, color, 0, width);
}

void ui_fill(ui_rect area, uint32_t color, float rounding) {
    list()->AddRectFilled(ImVec2(area.left, area.top), ImVec2(area.right, area.bottom), color,
                          rounding);
}

void ui_frame(ui_rect area, uint32_t color, float rounding, float width) {
    list()->AddRect(ImVec2(area.left, area.top), ImVec2(area.right, area.bottom), color, rounding,
                    0, width);
}

void ui_gradient(ui_rect area, uint32_t left, uint32_t right) {
    list()->AddRectFilledMultiColor(ImVec2(area.left, area.top), ImVec2(area.right, area.bottom),
                                    left, right, right, left);
}

void ui_checkers(ui_rect area, float size) {
    ui_fill(area, IM_COL32(92, 92, 92, 255), 0);
    int row = 0;
    for (float y = area.top; y < area.bottom; y += size, row ^= 1)
        for (float x = area.left + (row ? size : 0); x < area.right; x += 2 * size)
            ui_fill({x, y, fminf(x + size, area.right), fminf(y + size, area.bottom)},
                    IM_COL32(142, 142, 142, 255), 0);
}

void ui_triangle(float x0, float y0, float x1, float y1, float x2, float y2, uint32_t color) {
    // Smooth edges come out for one order of corners only.
    bool turned = (x1 - x0) * (y2 - y0) < (x2 - x0) * (y1 - y0);
    ImVec2 a(x0, y0), b(x1, y1), c(x2, y2);
    list()->AddTriangleFilled(a, turned ? c : b, turned ? b : c, color);
}

void ui_disc(float x, float y, float radius, uint32_t color) {
    list()->AddCircleFilled(ImVec2(x, y), radius, color);
}

void ui_ring(float x, float y, float radius, uint32_t color, float width) {
    list()->AddCircle(ImVec2(x, y), radius, color, 0, width);
}

void ui_label(float x, float y, uint32_t color, const char *text) {
    list()->AddText(ImVec2(floorf(x), floorf(y)), color, text);
}

void ui_image(ui_rect area, const roil_texture *texture) {
    list()->AddImage((ImTextureID)texture, ImVec2(area.left, area.top),
                     ImVec2(area.right, area.bottom));
}

void ui_shade(ui_rect area) {
    ImGui::GetBackgroundDrawList()->AddRectFilled(
        ImVec2(area.left, area.top), ImVec2(area.right, area.bottom), IM_COL32(0, 0, 0, 150));
}
