// Shared by the files that stand on Dear ImGui: its headers, and the state of the one window.
#pragma once
#include "ui/parts.h"
#include "ui/ui.h"
extern "C" {
#include "base/memory.h"
#include "ui/input.h"
}
#include <GLFW/glfw3.h>
#include <cmath>
#include <cstring>
#include <imgui.h>
#define IMGUI_DEFINE_MATH_OPERATORS
#include <imgui_internal.h>

namespace face {

enum { MAX_TABLES = 8, BUTTONS = 3 };

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
    bool walks; // keys go from widget to widget (ui_walk)
};
extern state ui;

inline ImVec4 rgba(ImU32 color) {
    return ImGui::ColorConvertU32ToFloat4(color);
}

inline ImVec2 low(ui_rect r) {
    return ImVec2(r.left, r.top);
}

inline ImVec2 high(ui_rect r) {
    return ImVec2(r.right, r.bottom);
}

inline ImDrawList *list() { // outside of panels: behind them
    return ui.depth ? ImGui::GetWindowDrawList() : ImGui::GetBackgroundDrawList();
}

} // namespace face
