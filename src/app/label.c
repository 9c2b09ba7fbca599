// Text on a canvas, a switch, a place.
#include "app/label.h"
#include "app/panel_model.h"
#include <math.h>

static const float SPACING = 6, PADDING = 4, SWITCH_PADDING = 9; // units
static const float MARGIN = 16, LEAST_WIDE = 420, LEAST_HIGH = 240;

float label_height(void) {
    return ui_line_height() - SPACING * ui_scale();
}

float label_row(void) {
    return label_height() + 2 * PADDING * ui_scale();
}

void label_right(float right, float y, uint32_t color, const char *text) {
    ui_label(right - ui_text_width(text), y, color, text);
}

void label_center(float x, float y, uint32_t color, const char *text) {
    ui_label(x - ui_text_width(text) / 2, y, color, text);
}

void label_within(float left, float y, float width, uint32_t color, const char *text) {
    char shown[256];
    panel_shorten(text, width, ui_text_width, shown, sizeof shown);
    ui_label(left, y, color, shown);
}

bool label_switch(const char *label, bool *on, uint32_t color) {
    float s = ui_scale(), width = ui_text_width(label);
    ui_canvas c = ui_canvas_begin(label, ceilf(width + 2 * SWITCH_PADDING * s), label_row());
    if (c.pressed) *on = !*on;
    ui_fill(c.area, *on ? ui_rgba(UI_LINE, 1) : ui_rgba(UI_FIELD, 1), 4 * s);
    ui_rect foot = {c.area.left + 5 * s, c.area.bottom - 3 * s, c.area.right - 5 * s,
                    c.area.bottom - s};
    if (*on) ui_fill(foot, color, s);
    label_center((c.area.left + c.area.right) / 2, c.area.top + PADDING * s,
                 ui_rgba(*on || c.hovered ? UI_TEXT : UI_DIM, 1), label);
    ui_canvas_end();
    return c.pressed;
}

ui_rect label_place(ui_rect view, float width, float height, bool right) {
    float s = ui_scale(), margin = MARGIN * s;
    float wide = fminf(width * s, fmaxf(view.right - view.left - 2 * margin, LEAST_WIDE * s));
    float high = fminf(height * s, fmaxf(view.bottom - view.top - 2 * margin, LEAST_HIGH * s));
    float left = right ? fmaxf(view.right - margin - wide, view.left) : view.left + margin;
    return (ui_rect){left, view.top + margin, left + wide, view.top + margin + high};
}
