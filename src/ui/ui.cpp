// ui.h over Dear ImGui. Widgets that an artist looks at all day (bars of numbers, toggles,
// headings, icons) are drawn here by hand; the rest is ImGui's, restyled. Input comes through
// ImGui's GLFW backend, triangles leave as a roil_picture.
#include "ui/ui.h"
#include "ui/parts.h"
extern "C" {
#include "base/memory.h"
#include "ui/input.h"
}
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <cmath>
#include <cstring>
#include <imgui.h>
#define IMGUI_DEFINE_MATH_OPERATORS
#include <imgui_internal.h>

static_assert(sizeof(ImDrawVert) == sizeof(roil_vertex) &&
                  offsetof(ImDrawVert, col) == offsetof(roil_vertex, color),
              "vertices are copied as they are");

namespace {

enum { MAX_TABLES = 8, BUTTONS = 3 };
const float TEXT_SIZE = 16, TIP_SECONDS = 0.45f, TIP_WIDTH = 340, CARD_ROUNDING = 6, CARD_EDGE = 4;

struct state {
    GLFWwindow *window;
    roil *r;
    roil_texture *atlas;
    char *layout;
    float scale;
    ImFont *fonts[FONT_KIND_COUNT];
    int depth;               // of panels and windows
    bool panel;              // the outermost is one
    bool tables[MAX_TABLES]; // that are open, and visible
    int table_depth;
    ImVec2 tip_at; // where the pointer rests on a widget
    float tip_seconds;
    ImGuiID bare; // area where a button was pressed that no panel covers; 0: none
    number_typing typing;
    input_queue input;
    ImVec2 pointer; // screen coordinates
    bool buttons[BUTTONS];
    void (*key)(void *user, int key, int mods, bool again);
    void *key_user;
} ui;

ImVec4 rgba(ImU32 color) {
    return ImGui::ColorConvertU32ToFloat4(color);
}

ImVec2 low(ui_rect r) {
    return ImVec2(r.left, r.top);
}

ImVec2 high(ui_rect r) {
    return ImVec2(r.right, r.bottom);
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
    s.WindowRounding = 6;
    s.PopupRounding = 6;
    s.FrameRounding = 4;
    s.TabRounding = 4;
    s.ScrollbarRounding = 5;
    s.DisabledAlpha = 0.45f;
    s.CircleTessellationMaxError = 0.2f;
}

void set_colors(ImVec4 *c) {
    const struct {
        ImGuiCol at;
        ImU32 color;
    } rows[] = {
        {ImGuiCol_Text, ui_rgba(UI_TEXT, 1)},
        {ImGuiCol_TextDisabled, ui_rgba(UI_DIM, 1)},
        {ImGuiCol_WindowBg, ui_rgba(UI_PANEL, 1)},
        {ImGuiCol_PopupBg, draw_grey(GREY_POPUP)},
        {ImGuiCol_Border, draw_grey(14)},
        {ImGuiCol_TitleBg, draw_grey(GREY_POPUP)},
        {ImGuiCol_TitleBgActive, draw_grey(50)},
        {ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0)},
        {ImGuiCol_Header, IM_COL32(240, 146, 62, 52)},
        {ImGuiCol_HeaderHovered, IM_COL32(255, 255, 255, 26)},
        {ImGuiCol_HeaderActive, IM_COL32(255, 255, 255, 40)},
        {ImGuiCol_Separator, ui_rgba(UI_LINE, 1)},
        {ImGuiCol_Tab, IM_COL32(0, 0, 0, 0)},
        {ImGuiCol_TabHovered, draw_grey(GREY_RAISED_HOVER)},
        {ImGuiCol_TabActive, draw_grey(GREY_RAISED)},
        {ImGuiCol_TabUnfocused, IM_COL32(0, 0, 0, 0)},
        {ImGuiCol_TabUnfocusedActive, draw_grey(GREY_RAISED)},
        {ImGuiCol_NavHighlight, ui_rgba(UI_ACCENT, 0.7f)},
        {ImGuiCol_TextSelectedBg, IM_COL32(240, 146, 62, 90)},
    };
    for (const auto &row : rows) c[row.at] = rgba(row.color);
    // Each of these is followed by its hovered and its active colour.
    const int raised[] = {ImGuiCol_FrameBg, ImGuiCol_Button, ImGuiCol_ScrollbarGrab,
                          ImGuiCol_ResizeGrip};
    for (int at : raised)
        for (int i = 0; i < 3; i++) c[at + i] = rgba(draw_grey(GREY_RAISED + i * GREY_STEP));
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

// ---- input ------------------------------------------------------------------------------------

static void apply(const input_event *e) {
    switch (e->kind) {
    case INPUT_MOVE:
        ui.pointer = ImVec2((float)e->x, (float)e->y);
        break;
    case INPUT_WHEEL:
        ImGui_ImplGlfw_ScrollCallback(ui.window, e->x, e->y);
        break;
    case INPUT_BUTTON:
        if (e->code < BUTTONS) ui.buttons[e->code] = e->action == GLFW_PRESS;
        break;
    case INPUT_KEY:
        ImGui_ImplGlfw_KeyCallback(ui.window, e->code, e->scan, e->action, e->mods);
        if (ui.key && e->action != GLFW_RELEASE)
            ui.key(ui.key_user, e->code, e->mods, e->action == GLFW_REPEAT);
        break;
    case INPUT_CHAR:
        ImGui_ImplGlfw_CharCallback(ui.window, (unsigned)e->code);
        break;
    }
}

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
    ImGui_ImplGlfw_InitForOther(window, false);
    input_listen(window, &ui.input);
    glfwSetWindowFocusCallback(window, ImGui_ImplGlfw_WindowFocusCallback);
    ui.pointer = ImVec2(-FLT_MAX, -FLT_MAX);
    ui_set_scale(1);
    if (ui.atlas) return true;
    ui_close();
    return false;
}

void ui_close(void) {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    roil_texture_destroy(ui.r, ui.atlas);
    picture_free();
    mem_free(ui.layout);
    marks_free();
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

void ui_on_key(void (*key)(void *user, int key, int mods, bool again), void *user) {
    ui.key = key;
    ui.key_user = user;
}

bool ui_pending(void) {
    return ui.input.count > 0;
}

// The backend asks GLFW how things are now; this frame sees them as they were in its turn.
static void take_input(ImGuiIO &io) {
    input_frame frame = {};
    input_event e;
    while (input_take(&ui.input, &frame, &e)) apply(&e);
    ImGui_ImplGlfw_NewFrame();
    io.MousePos = ui.pointer;
    for (int i = 0; i < BUTTONS; i++) io.MouseDown[i] = ui.buttons[i];
}

void ui_begin(void) {
    ImGuiIO &io = ImGui::GetIO();
    // Keys choose in what popped up, and there alone: elsewhere they are the program's own.
    io.ConfigFlags = GImGui->OpenPopupStack.Size ? ImGuiConfigFlags_NavEnableKeyboard : 0;
    io.KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER; // that activates; ImGui's own choice is the bar
    // Tab walks through fields only while one is typed in; else it is the program's own.
    io.KeyMap[ImGuiKey_Tab] = io.WantTextInput ? GLFW_KEY_TAB : -1;
    take_input(io);
    use_pixels(io);
    io.DeltaTime = fminf(io.DeltaTime, 0.1f); // the loop may have slept
    ImGui::NewFrame();
    if (!ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(1) && !ImGui::IsMouseDown(2)) ui.bare = 0;
}

void ui_end(roil_picture *out) {
    ImGui::Render();
    const ImDrawData *data = ImGui::GetDrawData();
    picture_begin();
    for (int i = 0; i < data->CmdListsCount; i++) {
        const ImDrawList *from = data->CmdLists[i];
        size_t first = picture_vertices((const roil_vertex *)from->VtxBuffer.Data,
                                        (size_t)from->VtxBuffer.Size);
        for (const ImDrawCmd &cmd : from->CmdBuffer)
            picture_draw((const roil_texture *)cmd.GetTexID(), &cmd.ClipRect.x,
                         from->IdxBuffer.Data + cmd.IdxOffset, cmd.ElemCount,
                         first + cmd.VtxOffset);
    }
    picture_end(out);
    marks_write();
}

bool ui_wants_keys(void) {
    return ImGui::GetIO().WantTextInput || GImGui->OpenPopupStack.Size;
}

void ui_copy(const char *text) {
    ImGui::SetClipboardText(text);
}

// ---- windows and layout -----------------------------------------------------------------------

static const ImGuiWindowFlags STILL = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoBringToFrontOnFocus;

static void panel_begin(const char *name, ui_rect where, ImGuiWindowFlags flags, bool framed) {
    ImGui::SetNextWindowPos(low(where));
    ImGui::SetNextWindowSize(high(where) - low(where));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, framed ? CARD_ROUNDING * ui.scale : 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, framed ? ui.scale : 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::Begin(name, nullptr, flags);
    ui_mark(name, where);
    ImGui::PopStyleVar(3);
    if (!ui.depth++) ui.panel = true;
}

void ui_panel_begin(const char *name, ui_rect where) {
    panel_begin(name, where, STILL, false);
}

void ui_panel_end(void) {
    ui.depth--;
    ImGui::End();
}

void ui_card_begin(const char *name, ui_rect where, uint32_t edge) {
    ImVec2 display = ImGui::GetIO().DisplaySize, size = high(where) - low(where);
    float left = fmaxf(fminf(where.left, display.x - size.x), 0);
    float top = fmaxf(fminf(where.top, display.y - size.y), 0);
    panel_begin(name, {left, top, fminf(left + size.x, display.x), fminf(top + size.y, display.y)},
                STILL | ImGuiWindowFlags_NoFocusOnAppearing, true);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    list()->PushClipRectFullScreen(); // beyond the padding
    list()->AddRectFilled(ImVec2(left, top), ImVec2(left + CARD_EDGE * ui.scale, top + size.y),
                          edge, CARD_ROUNDING * ui.scale, ImDrawFlags_RoundCornersLeft);
    list()->PopClipRect();
}

void ui_card_end(void) {
    ui_panel_end();
}

bool ui_window_begin(const char *title, bool *open, ui_rect where, bool fixed) {
    ImGui::SetNextWindowPos(low(where), ImGuiCond_FirstUseEver);
    if (!fixed) ImGui::SetNextWindowSize(high(where) - low(where), ImGuiCond_FirstUseEver);
    bool visible = ImGui::Begin(
        title, open, ImGuiWindowFlags_NoCollapse | (fixed ? ImGuiWindowFlags_AlwaysAutoResize : 0));
    ImVec2 at = ImGui::GetWindowPos(), end = at + ImGui::GetWindowSize();
    ui_mark(title, {at.x, at.y, end.x, end.y});
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

void ui_separator(void) {
    ImGui::Separator();
}

void ui_push(const char *id) {
    ImGui::PushID(id);
    marks_push(id);
}

void ui_pop(void) {
    marks_pop();
    ImGui::PopID();
}

void ui_disable_begin(bool disabled) {
    ImGui::BeginDisabled(disabled);
}

void ui_disable_end(void) {
    ImGui::EndDisabled();
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
    part_forget_width();
    if (!ui.tables[ui.table_depth - 1]) return;
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding(); // a label beside a widget
}

void ui_table_end(void) {
    if (ui.tables[--ui.table_depth]) ImGui::EndTable();
}

// ---- text -------------------------------------------------------------------------------------

void part_text(uint32_t color, const char *text) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
}

void ui_text_wrapped(const char *text) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
}

// After the pointer has rested for a moment, so that nothing flickers along its way.
void ui_tooltip(const char *text) {
    if (!text || !text[0] || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImVec2 at = ImGui::GetItemRectMin();
    bool same = at.x == ui.tip_at.x && at.y == ui.tip_at.y && !ImGui::IsAnyMouseDown() &&
                !ImGui::GetIO().WantTextInput;
    ui.tip_seconds = same ? ui.tip_seconds + ImGui::GetIO().DeltaTime : 0;
    ui.tip_at = at;
    if (ui.tip_seconds < TIP_SECONDS) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(TIP_WIDTH * ui.scale);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

float ui_text_width(const char *text) {
    return ImGui::CalcTextSize(text).x;
}

float ui_line_height(void) {
    return ImGui::GetTextLineHeightWithSpacing();
}

// ---- widgets ----------------------------------------------------------------------------------

uint32_t draw_enabled(uint32_t color) {
    return ImGui::GetColorU32(rgba(color));
}

void draw_text_in(ui_rect area, uint32_t color, const char *text, float align) {
    const char *end = ImGui::FindRenderedTextEnd(text);
    ImVec2 size = ImGui::CalcTextSize(text, end);
    float room = area.right - area.left, x = area.left + fmaxf(room - size.x, 0) * align;
    float y = floorf((area.top + area.bottom - size.y) / 2);
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::RenderTextEllipsis(list(), ImVec2(floorf(x), y), high(area), area.right, area.right,
                              text, end, &size);
    ImGui::PopStyleColor();
}

void draw_clipped(ui_rect area, ui_rect clip, uint32_t color, float rounding) {
    list()->PushClipRect(low(clip), high(clip), true);
    ui_fill(area, color, rounding);
    list()->PopClipRect();
}

void part_group_begin(const char *id) {
    ImGui::BeginGroup();
    ImGui::PushID(id);
}

void part_space(float width, float height) {
    ImGui::Dummy(ImVec2(width, height));
}

static void mark_last(const char *name) {
    if (ImGui::GetCurrentWindow()->Hidden) return; // a popup whose place is not known yet
    ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    ui_mark(name, {a.x, a.y, b.x, b.y});
}

void part_group_end(const char *id) {
    ImGui::PopID();
    ImGui::EndGroup();
    mark_last(id);
}

void part_same_line(float gap) {
    ImGui::SameLine(0, gap);
}

part_area part_area_begin(const char *id, float width) {
    ImVec2 at = ImGui::GetCursorScreenPos();
    float height = ImGui::GetFrameHeight();
    part_area a = {};
    if (!(width > 0)) width = height;
    a.clicked = ImGui::InvisibleButton(id, ImVec2(fmaxf(width, 1), height));
    ImGui::SetItemAllowOverlap();
    float &baseline = ImGui::GetCurrentWindow()->DC.PrevLineTextBaseOffset; // of text behind it
    baseline = fmaxf(baseline, ImGui::GetStyle().FramePadding.y);
    a.hovered = ImGui::IsItemHovered();
    a.held = ImGui::IsItemActive();
    a.area = {at.x, at.y, at.x + width, at.y + height};
    ui_mark(id, a.area);
    return a;
}

void part_changed(void) {
    ImGui::MarkItemEdited(ImGui::GetItemID());
}

bool *part_flag(const char *id, bool initial) {
    return ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID(id), initial);
}

void part_font_begin(font_kind kind) {
    ImGui::PushFont(ui.fonts[kind]);
}

void part_font_end(void) {
    ImGui::PopFont();
}

void part_popup_open(const char *id) {
    ImGui::OpenPopup(id);
}

bool part_popup_begin(const char *id) {
    if (!ImGui::BeginPopup(id)) return false;
    ui.depth++;
    return true;
}

void part_popup_end(void) {
    ui.depth--;
    ImGui::EndPopup();
}

bool part_button(const char *label, float width) {
    bool pressed = ImGui::Button(label, ImVec2(width, 0));
    mark_last(label);
    return pressed;
}

bool ui_small_button(const char *label) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(6 * ui.scale, 0));
    bool pressed = ImGui::Button(label);
    ImGui::PopStyleVar();
    return pressed;
}

bool ui_choice(const char *label, size_t *index, const char *const *words, size_t count) {
    bool changed = false;
    float width = part_row_begin(label), height = ImGui::GetFrameHeight();
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
        mark_last(words[i]);
        if (i == *index) ImGui::SetItemDefaultFocus();
        ImGui::PopID();
    }
    if (open) ImGui::EndCombo();
    draw_chevron(at.x + width - 13 * ui.scale, at.y + height / 2, true);
    part_row_end(label);
    return changed;
}

bool ui_input(const char *label, const char *hint, char *text, size_t capacity) {
    ImGui::SetNextItemWidth(part_row_begin(label));
    bool changed = ImGui::InputTextWithHint("##value", hint ? hint : "", text, capacity);
    part_row_end(label);
    return changed;
}

// ---- numbers ----------------------------------------------------------------------------------

// The text takes the bar's place until Return or a click elsewhere; Escape leaves the number as it
// was.
static void bar_type(const ImRect &box, ImGuiID id, const char *name) {
    number_typing *t = &ui.typing;
    ImGui::TempInputText(box, id, name, t->text, (int)sizeof t->text,
                         ImGuiInputTextFlags_CharsScientific | ImGuiInputTextFlags_AutoSelectAll);
    if (!ImGui::TempInputIsActive(id)) number_type_leave(t);
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

bool part_bar(const char *name, double *value, const number_range *range, const char *unit,
              float width) {
    ImGuiContext &g = *GImGui;
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    ImGuiID id = window->GetID(name);
    ImVec2 at = window->DC.CursorPos, size(width, ImGui::GetFrameHeight());
    ImRect box(at, ImVec2(at.x + size.x, at.y + size.y));
    ImGui::ItemSize(size, g.Style.FramePadding.y);
    if (!ImGui::ItemAdd(box, id, nullptr, ImGuiItemFlags_Inputable)) return false;
    bool hovered = ImGui::ItemHoverable(box, id), typing = ImGui::TempInputIsActive(id);
    bool tabbed = (g.LastItemData.StatusFlags & ImGuiItemStatusFlags_FocusedByTabbing) ||
                  g.NavActivateInputId == id;
    if (!typing && (tabbed || (hovered && g.IO.MouseClicked[0]))) {
        ImGui::SetActiveID(id, window);
        ImGui::SetFocusID(id, window);
        ImGui::FocusWindow(window);
        g.ActiveIdSource = ImGuiInputSource_Mouse;
        typing = tabbed || g.IO.KeyCtrl || g.IO.MouseDoubleClicked[0];
    }
    if (typing) {
        number_type_begin(&ui.typing, id, range, *value);
        bar_type(box, id, name);
        return number_type_take(&ui.typing, id, range, value);
    }
    if (ui.typing.id == id) number_type_leave(&ui.typing); // the pointer went elsewhere
    if (number_type_take(&ui.typing, id, range, value)) return true;
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    bool changed = bar_drag(id, value, range, width);
    draw_bar({box.Min.x, box.Min.y, box.Max.x, box.Max.y}, *value, range, unit, hovered,
             g.ActiveId == id);
    return changed;
}

// ---- about the last widget --------------------------------------------------------------------

bool ui_active(void) {
    return ImGui::IsItemActive();
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
    bool chosen = ImGui::MenuItem(label);
    mark_last(label);
    return chosen;
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
    ImVec2 room = ImGui::GetContentRegionAvail();
    float wide = fmaxf(width > 0 ? width : room.x, 1);
    height = fmaxf(height > 0 ? height : room.y, 1);
    ImGui::InvisibleButton(id, ImVec2(wide, height),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    bool active = ImGui::IsItemActive();
    if (!ui.panel) ImGui::SetItemUsingMouseWheel();
    ui_canvas c = canvas_of({at.x, at.y, at.x + wide, at.y + height}, ImGui::IsItemHovered());
    ui_mark(id, c.area);
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
    bool inside = ImRect(low(area), high(area)).Contains(io.MousePos);
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

ui_canvas part_bare_sideways(const char *id, ui_rect area) {
    ui_canvas c = bare(ImHashStr(id), area);
    if (c.hovered || c.held) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    return c;
}

void ui_line(float x0, float y0, float x1, float y1, uint32_t color, float width) {
    list()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color, width);
}

void ui_polyline(const float *xy, size_t count, uint32_t color, float width) {
    static_assert(sizeof(ImVec2) == 2 * sizeof *xy, "points are pairs");
    list()->AddPolyline((const ImVec2 *)xy, (int)count, color, 0, width);
}

void ui_fill(ui_rect area, uint32_t color, float rounding) {
    list()->AddRectFilled(low(area), high(area), color, rounding);
}

void ui_frame(ui_rect area, uint32_t color, float rounding, float width) {
    list()->AddRect(low(area), high(area), color, rounding, 0, width);
}

void ui_gradient(ui_rect area, uint32_t left, uint32_t right) {
    list()->AddRectFilledMultiColor(low(area), high(area), left, right, right, left);
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
    list()->AddImage((ImTextureID)texture, low(area), high(area));
}

void ui_shade(ui_rect area) {
    ImGui::GetBackgroundDrawList()->AddRectFilled(low(area), high(area), IM_COL32(0, 0, 0, 150));
}
