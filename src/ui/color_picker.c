// The popup that chooses a colour. The stored colour is linear and of any brightness; the user
// edits a colour as displays show it (hue, saturation, value in sRGB) and an intensity.
#include "base/maths.h"
#include "base/srgb.h"
#include "ui/parts.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HUE_STEPS = 6 };
static const float SIDE = 220, STRIP = 14, MAX_INTENSITY = 64;

// Black and grey have no hue, so the last one chosen is kept while the colour stays the same.
static struct {
    float linear[3];
    float hsv[3]; // 0 to 1
    float intensity;
} chosen = {.linear = {-1, -1, -1}};

static void rgb_from_hsv(const float hsv[3], float rgb[3]) {
    for (int i = 0; i < 3; i++) {
        float k = fmodf((float)(5 - 2 * i) + hsv[0] * 6, 6);
        rgb[i] = hsv[2] * (1 - hsv[1] * clampf(fminf(k, 4 - k), 0, 1));
    }
}

static void hsv_from_rgb(const float rgb[3], float hsv[3]) {
    float high = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])), low = fminf(rgb[0], fminf(rgb[1], rgb[2]));
    float span = high - low, hue = hsv[0];
    if (span > 1e-5f) {
        if (high == rgb[0])
            hue = (rgb[1] - rgb[2]) / span;
        else if (high == rgb[1])
            hue = 2 + (rgb[2] - rgb[0]) / span;
        else
            hue = 4 + (rgb[0] - rgb[1]) / span;
        hue = hue / 6 - floorf(hue / 6);
    }
    hsv[0] = hue;
    if (high > 0) hsv[1] = span / high;
    hsv[2] = high;
}

static float intensity_of(const float linear[3]) {
    return fmaxf(1, fmaxf(linear[0], fmaxf(linear[1], linear[2])));
}

static void picker_choose(const float linear[3]) {
    if (memcmp(chosen.linear, linear, sizeof chosen.linear) == 0) return;
    memcpy(chosen.linear, linear, sizeof chosen.linear);
    chosen.intensity = intensity_of(linear);
    float rgb[3];
    for (int i = 0; i < 3; i++) rgb[i] = srgb_from_linear(fmaxf(linear[i], 0) / chosen.intensity);
    hsv_from_rgb(rgb, chosen.hsv);
}

static void picker_give(float linear[3]) {
    float rgb[3];
    rgb_from_hsv(chosen.hsv, rgb);
    for (int i = 0; i < 3; i++) linear[i] = linear_from_srgb(rgb[i]) * chosen.intensity;
    memcpy(chosen.linear, linear, sizeof chosen.linear);
}

void color_text(const float linear[3], char *out, size_t capacity) {
    float intensity = intensity_of(linear);
    int rgb[3];
    for (int i = 0; i < 3; i++)
        rgb[i] = (int)lroundf(srgb_from_linear(clampf(linear[i] / intensity, 0, 1)) * 255);
    int length = snprintf(out, capacity, "#%02x%02x%02x", (unsigned)rgb[0], (unsigned)rgb[1],
                          (unsigned)rgb[2]);
    if (intensity > 1.0001f && length > 0 && (size_t)length < capacity)
        snprintf(out + length, capacity - (size_t)length, " \u00d7 %.3g", (double)intensity);
}

static uint32_t of_hsv(float hue, float saturation, float value) {
    float rgb[3], linear[3];
    rgb_from_hsv((float[3]){hue, saturation, value}, rgb);
    for (int i = 0; i < 3; i++) linear[i] = linear_from_srgb(rgb[i]);
    return ui_pack(linear, 1);
}

// ---- parts of the popup -----------------------------------------------------------------------

static float share_x(const ui_canvas *c) {
    return clampf((c->x - c->area.left) / (c->area.right - c->area.left), 0, 1);
}

// Saturation increases to the right, value upwards: two gradients, drawn row by row.
static bool square(void) {
    enum { ROWS = 52 };
    ui_canvas c = ui_canvas_begin("square", SIDE * ui_scale(), SIDE * 0.72f * ui_scale());
    float height = c.area.bottom - c.area.top, width = c.area.right - c.area.left;
    for (int i = 0; i < ROWS; i++) {
        float value = 1 - ((float)i + 0.5f) / ROWS;
        ui_rect row = {c.area.left, c.area.top + height * (float)i / ROWS, c.area.right,
                       c.area.top + height * (float)(i + 1) / ROWS};
        ui_gradient(row, of_hsv(chosen.hsv[0], 0, value), of_hsv(chosen.hsv[0], 1, value));
    }
    if (c.held) {
        part_changed();
        chosen.hsv[1] = share_x(&c);
        chosen.hsv[2] = clampf(1 - (c.y - c.area.top) / height, 0, 1);
    }
    float x = c.area.left + width * chosen.hsv[1], y = c.area.bottom - height * chosen.hsv[2];
    ui_ring(x, y, 6 * ui_scale(), ui_pack((float[3]){0, 0, 0}, 0.8f), 3 * ui_scale());
    ui_ring(x, y, 6 * ui_scale(), ui_pack((float[3]){1, 1, 1}, 1), 1.6f * ui_scale());
    ui_canvas_end();
    return c.held;
}

static void picker_mark(const ui_canvas *c, float share) {
    float s = ui_scale(), x = c->area.left + (c->area.right - c->area.left) * share;
    x = clampf(x, c->area.left + 2 * s, c->area.right - 2 * s);
    ui_rect box = {x - 2 * s, c->area.top, x + 2 * s, c->area.bottom};
    ui_fill(box, ui_pack((float[3]){1, 1, 1}, 1), s);
    ui_frame(box, ui_pack((float[3]){0, 0, 0}, 0.8f), s, s);
}

static bool hue_strip(void) {
    ui_canvas c = ui_canvas_begin("hue", SIDE * ui_scale(), STRIP * ui_scale());
    float width = c.area.right - c.area.left;
    for (int i = 0; i < HUE_STEPS; i++) {
        ui_rect part = c.area;
        part.left = c.area.left + width * (float)i / HUE_STEPS;
        part.right = c.area.left + width * (float)(i + 1) / HUE_STEPS;
        ui_gradient(part, of_hsv((float)i / HUE_STEPS, 1, 1),
                    of_hsv((float)(i + 1) / HUE_STEPS, 1, 1));
    }
    if (c.held) {
        part_changed();
        chosen.hsv[0] = fminf(share_x(&c), 0.9999f);
    }
    picker_mark(&c, chosen.hsv[0]);
    ui_canvas_end();
    return c.held;
}

static bool alpha_strip(float *alpha) {
    ui_canvas c = ui_canvas_begin("alpha", SIDE * ui_scale(), STRIP * ui_scale());
    float rgb[3], linear[3];
    rgb_from_hsv(chosen.hsv, rgb);
    for (int i = 0; i < 3; i++) linear[i] = linear_from_srgb(rgb[i]);
    ui_checkers(c.area, STRIP / 2 * ui_scale());
    ui_gradient(c.area, ui_pack(linear, 0), ui_pack(linear, 1));
    if (c.held) {
        part_changed();
        *alpha = share_x(&c);
    }
    picker_mark(&c, clampf(*alpha, 0, 1));
    ui_canvas_end();
    return c.held;
}

static bool hex_input(float *linear) {
    static char text[16];
    static float shown[3] = {-1, -1, -1};
    unsigned r, g, b;
    if (memcmp(shown, linear, sizeof shown) != 0) { // changed elsewhere
        color_text(linear, text, sizeof text);
        text[7] = '\0'; // without the intensity
        memcpy(shown, linear, sizeof shown);
    }
    ui_width(SIDE * ui_scale());
    const char *digits = text;
    bool typed = ui_input("Hex", "#rrggbb", text, sizeof text);
    if (*digits == '#') digits++;
    if (!typed || strlen(digits) != 6 || sscanf(digits, "%2x%2x%2x", &r, &g, &b) != 3) return false;
    const unsigned parts[3] = {r, g, b};
    for (int i = 0; i < 3; i++)
        linear[i] = linear_from_srgb((float)parts[i] / 255) * chosen.intensity;
    memcpy(shown, linear, sizeof shown);
    return true;
}

bool color_picker(float *linear, int components) {
    picker_choose(linear);
    bool changed = square();
    changed = hue_strip() || changed;
    ui_width(SIDE * ui_scale());
    changed = ui_number("Intensity", &chosen.intensity, 1, 1, MAX_INTENSITY, true, NULL) || changed;
    if (changed) picker_give(linear);
    if (components == 4) changed = alpha_strip(&linear[3]) || changed;
    changed = hex_input(linear) || changed;
    ui_width(SIDE * ui_scale());
    changed = ui_number("##linear", linear, 3, 0, INFINITY, false, NULL) || changed;
    ui_tooltip("red, green and blue as light: linear, of any brightness");
    return changed;
}
