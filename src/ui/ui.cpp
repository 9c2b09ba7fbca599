// ui.h over Dear ImGui: the style of the window, the user's input, and the begin and end of a
// frame. Widgets that an artist looks at all day (bars of numbers, toggles, headings, icons) are
// drawn by ui_widgets.cpp and widgets.c; the rest is ImGui's, with another style. Input comes
// through ImGui's GLFW backend, triangles leave as a roil_picture.
#include "ui/ui_state.hpp"
#include <backends/imgui_impl_glfw.h>

using namespace face;

static_assert(sizeof(ImDrawVert) == sizeof(roil_vertex) &&
                  offsetof(ImDrawVert, col) == offsetof(roil_vertex, color),
              "vertices are copied as they are");

state face::ui;

namespace {

const float TEXT_SIZE = 16;

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
        {ImGuiCol_Border, draw_contrast() ? ui_rgba(UI_LINE, 1) : draw_grey(14)},
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

static void input_apply(const input_event *e) {
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

static void set_style(void) {
    ImGuiStyle style;
    set_sizes(style);
    if (draw_contrast()) style.FrameBorderSize = 1;
    style.ScaleAllSizes(ui.scale);
    set_colors(style.Colors);
    ImGui::GetStyle() = style;
}

void ui_set_scale(float scale) {
    if (scale == ui.scale) return;
    ui.scale = scale;
    set_style();
    load_atlas();
}

void ui_set_contrast(bool on) {
    if (on == draw_contrast()) return;
    draw_set_contrast(on);
    set_style();
}

void ui_walk(const char *panel) {
    ui.walks = panel != nullptr;
    if (panel) ImGui::SetWindowFocus(panel);
}

bool ui_walks(void) {
    return ui.walks;
}

bool ui_types(void) {
    return ImGui::GetIO().WantTextInput;
}

float ui_scale(void) {
    return ui.scale;
}

// GLFW reports the pointer in screen coordinates, which are coarser than pixels on a display of
// high density. Everything here uses pixels.
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

bool ui_acts(void) {
    return input_acts(&ui.input);
}

// The backend asks GLFW for the state of now; this frame uses the state at its place in the queue.
static void take_input(ImGuiIO &io) {
    input_frame frame = {};
    input_event e;
    while (input_take(&ui.input, &frame, &e)) input_apply(&e);
    ImGui_ImplGlfw_NewFrame();
    io.MousePos = ui.pointer;
    for (int i = 0; i < BUTTONS; i++) io.MouseDown[i] = ui.buttons[i];
}

void ui_begin(void) {
    ImGuiIO &io = ImGui::GetIO();
    // Keys choose in what popped up, and where they walk: elsewhere they are the program's own.
    bool walks = ui.walks || GImGui->OpenPopupStack.Size;
    io.ConfigFlags = walks ? ImGuiConfigFlags_NavEnableKeyboard : 0;
    io.KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER; // that activates; ImGui's own choice is the bar
    // Tab walks through fields only while one is typed in; else it is the program's own.
    io.KeyMap[ImGuiKey_Tab] = io.WantTextInput || ui.walks ? GLFW_KEY_TAB : -1;
    take_input(io);
    use_pixels(io);
    io.DeltaTime = fminf(io.DeltaTime, 0.1f); // the loop may have slept
    ImGui::NewFrame();
    if (!ui_held()) ui.bare = 0;
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

bool ui_held(void) {
    bool held = false;
    for (int i = 0; i < 3; i++)
        held = held || (ImGui::IsMouseDown(i) && !ImGui::IsMouseClicked(i)) ||
               ImGui::IsMouseReleased(i);
    return held;
}

bool ui_wants_keys(void) {
    return ImGui::GetIO().WantTextInput || GImGui->OpenPopupStack.Size || ui.walks;
}

void ui_copy(const char *text) {
    ImGui::SetClipboardText(text);
}
