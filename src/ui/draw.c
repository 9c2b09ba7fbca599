// The look of widgets: colours, fills and edges in one place.
#include "base/srgb.h"
#include "ui/parts.h"
#include <math.h>

typedef struct rgb {
    uint8_t r, g, b;
} rgb;

static const rgb colors[UI_COLOR_COUNT] = {
    [UI_TEXT] = {222, 222, 222}, [UI_DIM] = {142, 142, 142},    [UI_ACCENT] = {240, 146, 62},
    [UI_GOOD] = {132, 182, 110}, [UI_WARNING] = {228, 180, 76}, [UI_ERROR] = {232, 102, 84},
    [UI_PANEL] = {36, 36, 36},   [UI_FIELD] = {24, 24, 24},     [UI_LINE] = {58, 58, 58},
};
// The same for those who see little contrast: white, and lines around all that can be used.
static const rgb contrast_colors[UI_COLOR_COUNT] = {
    [UI_TEXT] = {255, 255, 255}, [UI_DIM] = {214, 214, 214},    [UI_ACCENT] = {255, 200, 0},
    [UI_GOOD] = {130, 255, 130}, [UI_WARNING] = {255, 222, 60}, [UI_ERROR] = {255, 130, 120},
    [UI_PANEL] = {0, 0, 0},      [UI_FIELD] = {0, 0, 0},        [UI_LINE] = {150, 150, 150},
};
enum { CONTRAST_FLOOR = 60 }; // greys below it are those of what lies behind text
static bool contrast;

static const rgb accent_hover = {250, 160, 80}, accent_deep = {138, 86, 40},
                 accent_pale = {150, 120, 94};

enum { GREY_FILLED = 74, GREY_FILLED_HOVER = 86, GREY_HEADING = 46, GREY_HEADING_HOVER = 58 };

static uint32_t packed(rgb c, float alpha) {
    return (uint32_t)c.r | (uint32_t)c.g << 8 | (uint32_t)c.b << 16 |
           (uint32_t)lroundf(fminf(fmaxf(alpha, 0), 1) * 255) << 24;
}

void draw_set_contrast(bool on) {
    contrast = on;
}

bool draw_contrast(void) {
    return contrast;
}

uint32_t ui_rgba(ui_color color, float alpha) {
    return packed((contrast ? contrast_colors : colors)[color], alpha);
}

uint32_t ui_pack(const float linear[3], float alpha) {
    uint8_t encoded[3];
    for (int i = 0; i < 3; i++) {
        float v = fminf(fmaxf(linear[i], 0), 1);
        encoded[i] = (uint8_t)lroundf(srgb_from_linear(v) * 255);
    }
    return packed((rgb){encoded[0], encoded[1], encoded[2]}, alpha);
}

uint32_t draw_grey(int level) {
    uint8_t v = (uint8_t)(contrast && level < CONTRAST_FLOOR ? level / 3 : level);
    return packed((rgb){v, v, v}, 1);
}

void ui_checkers(ui_rect area, float size) {
    ui_fill(area, draw_grey(92), 0);
    int row = 0;
    for (float y = area.top; y < area.bottom; y += size, row ^= 1)
        for (float x = area.left + (row ? size : 0); x < area.right; x += 2 * size)
            ui_fill((ui_rect){x, y, fminf(x + size, area.right), fminf(y + size, area.bottom)},
                    draw_grey(142), 0);
}

void draw_text(ui_rect area, ui_color color, const char *text, float align) {
    draw_text_in(area, ui_rgba(color, 1), text, align);
}

void draw_chevron(float x, float y, bool down) {
    float r = 4 * ui_scale();
    uint32_t color = draw_enabled(ui_rgba(UI_DIM, 1));
    if (down)
        ui_triangle(x - r, y - r * 0.5f, x + r, y - r * 0.5f, x, y + r * 0.6f, color);
    else
        ui_triangle(x - r * 0.5f, y - r, x + r * 0.6f, y, x - r * 0.5f, y + r, color);
}

void draw_heading(ui_rect area, bool open, bool hovered) {
    float s = ui_scale();
    ui_fill(area, draw_grey(hovered ? GREY_HEADING_HOVER : GREY_HEADING), 4 * s);
    draw_chevron(area.left + 13 * s, (area.top + area.bottom) / 2, open);
}

void draw_switch(ui_rect area, bool on, bool hovered) {
    float s = ui_scale(), r = 8 * s, y = (area.top + area.bottom) / 2;
    uint32_t track = draw_grey(hovered ? GREY_RAISED_ACTIVE : GREY_RAISED_HOVER);
    if (on) track = packed(hovered ? accent_hover : colors[UI_ACCENT], 1);
    ui_fill((ui_rect){area.left, y - r, area.right, y + r}, draw_enabled(track), r);
    ui_disc(on ? area.right - r : area.left + r, y, r - 2.5f * s,
            draw_enabled(on ? draw_grey(24) : ui_rgba(UI_TEXT, 1)));
}

// The bar is filled up to the value, with a mark at its end.
static void bar_share(ui_rect area, float share, bool hovered, bool held) {
    float s = ui_scale(), x = area.left + (area.right - area.left) * share;
    uint32_t fill =
        held ? packed(accent_deep, 1) : draw_grey(hovered ? GREY_FILLED_HOVER : GREY_FILLED);
    ui_rect left = {area.left, area.top, x, area.bottom};
    if (x > area.left) draw_clipped(area, left, draw_enabled(fill), 4 * s);
    float edge = fminf(fmaxf(x, area.left + s), area.right - s);
    ui_fill((ui_rect){edge - s, area.top + 3 * s, edge + s, area.bottom - 3 * s},
            draw_enabled(packed(held || hovered ? colors[UI_ACCENT] : accent_pale, 1)), s);
}

void draw_bar(ui_rect area, double value, const number_range *range, const char *unit, bool hovered,
              bool held) {
    float s = ui_scale(), width = area.right - area.left, pad = 8 * s, gap = 4 * s;
    ui_fill(area, draw_enabled(ui_rgba(UI_FIELD, 1)), 4 * s);
    if (number_is_bounded(range))
        bar_share(area, (float)number_to_share(range, value), hovered, held);
    if (contrast)
        ui_frame(area, ui_rgba(held ? UI_ACCENT : UI_LINE, 1), 4 * s, s);
    else if (!number_is_bounded(range) && (hovered || held))
        ui_frame(area, held ? ui_rgba(UI_ACCENT, 1) : draw_grey(GREY_RAISED_ACTIVE), 4 * s, s);
    char text[64];
    number_text(range, value, text, sizeof text);
    float behind = unit && unit[0] ? ui_text_width(unit) + gap : 0;
    if (ui_text_width(text) + behind + 2 * pad > width) { // a component among several
        draw_text((ui_rect){area.left + 2 * s, area.top, area.right - 2 * s, area.bottom}, UI_TEXT,
                  text, 0.5f);
        return;
    }
    float end = area.right - pad - behind;
    draw_text((ui_rect){area.left + pad, area.top, end, area.bottom}, UI_TEXT, text, 1);
    if (behind > 0)
        draw_text((ui_rect){end + gap, area.top, area.right, area.bottom}, UI_DIM, unit, 0);
}

// The left half is opaque, the right half shows the alpha.
void draw_swatch(ui_rect area, const float *linear, int components) {
    float s = ui_scale(), round = 4 * s, middle = floorf((area.left + area.right) / 2);
    float opacity = components == 4 ? linear[3] : 1;
    ui_fill(area, ui_pack(linear, 1), round);
    if (opacity < 1) {
        ui_rect right = {middle, area.top, area.right, area.bottom};
        ui_checkers(right, 6 * s);
        ui_fill(right, ui_pack(linear, opacity), 0);
    }
    ui_frame(area, packed((rgb){255, 255, 255}, 0.12f), round, s);
    char text[64];
    color_text(linear, text, sizeof text);
    float light = 0.2126f * linear[0] + 0.7152f * linear[1] + 0.0722f * linear[2];
    ui_rect left = {area.left + 8 * s, area.top, opacity < 1 ? middle : area.right, area.bottom};
    draw_text_in(left, draw_grey(light < 0.2f ? 225 : 20), text, 0);
}
