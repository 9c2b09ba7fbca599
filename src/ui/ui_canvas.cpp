// Canvases (ui.h): areas that are drawn to and take clicks, over Dear ImGui.
#include "ui/ui_state.hpp"

using namespace face;

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
