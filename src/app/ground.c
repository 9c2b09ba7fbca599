// A grid on the ground, and looking along an axis.
#include "app/handles.h"
#include "app/label.h"
#include <math.h>
#include <stdio.h>

enum { LINES = 20 };            // to each side
static const float EACH = 0.1f; // of the eye's distance, about, from a line to the next

bool view_lens(const live *l, lens *out) {
    roil_camera camera;
    if (!l->effect || !l->width || !l->height || !roil_get_camera(l->effect, &camera)) return false;
    *out = lens_make(&camera, l->view, (float)l->width / (float)l->height);
    return true;
}

float near_distance(const roil_camera *c) {
    orbit seen;
    orbit_from(&seen, c);
    return orbit_height(&seen) / 0.728f;
}

float ground_step(const live *l) {
    roil_camera camera;
    if (!l->effect || !roil_get_camera(l->effect, &camera)) return 1;
    float wanted = fmaxf(near_distance(&camera) * EACH, 1e-6f);
    float power = powf(10, floorf(log10f(wanted))), parts = wanted / power;
    return power * (parts < 2 ? 1 : parts < 5 ? 2 : 5);
}

// In two colours: legible over a white sky, and over fire.
static void draw_line(const lens *view, const float a[3], const float b[3], uint32_t color,
                      float width) {
    float at[4], s = ui_scale();
    if (!lens_project_line(view, a, b, at)) return;
    ui_line(at[0], at[1], at[2], at[3], 0x38000000, (width + 1.4f) * s);
    ui_line(at[0], at[1], at[2], at[3], color, width * s);
}

void ground_draw(const live *l, const lens *view) {
    static const uint32_t axes[] = {0xc04a4af0, 0xc04ac85a}; // red, green
    roil_camera camera;
    if (!l->effect || !roil_get_camera(l->effect, &camera)) return;
    float step = ground_step(l), reach = LINES * step;
    for (int way = 0; way < 2; way++) {
        float middle = roundf(camera.target[way] / step), across = camera.target[!way];
        across = roundf(across / step) * step;
        for (int i = -LINES; i <= LINES; i++) {
            float at = (middle + (float)i) * step, a[3] = {0}, b[3] = {0};
            a[way] = b[way] = at;
            a[!way] = across - reach;
            b[!way] = across + reach;
            bool axis = fabsf(at) < step / 2;
            draw_line(view, a, b, axis ? axes[!way] : 0x60ffffff, axis ? 1.6f : 1);
        }
    }
    char text[48];
    snprintf(text, sizeof text, "grid %g m", (double)step);
    float s = ui_scale(), width = ui_text_width(text) + 12 * s, high = label_height() + 4 * s;
    ui_rect at = {view->picture.left + 12 * s, view->picture.bottom - 12 * s - high, 0, 0};
    at.right = at.left + width;
    at.bottom = at.top + high;
    ui_fill(at, ui_rgba(UI_PANEL, 0.8f), 4 * s);
    ui_label(at.left + 6 * s, at.top + 2 * s, ui_rgba(UI_TEXT, 1), text);
}
