// The editor of a curve: a plot over time with the keys as handles, and the selected key as
// numbers.
#include "app/panel_parts.h"
#include "base/maths.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SAMPLES = 192 };
static const float HEIGHT = 168, LEFT = 40, BOTTOM = 20, TOP = 8, RIGHT = 10; // units
static const float HANDLE = 4.5f, REACH = 9;                                  // units

static const char *const shapes[] = {"step",    "linear",   "cubic",
                                     "ease_in", "ease_out", "ease_in_out"};

typedef struct editor {
    live *l;
    shape_state *state;
    roil_curve curve;
    float samples[SAMPLES][4]; // across the range of time
    ui_canvas canvas;
    ui_rect plot;
} editor;

// ---- places -----------------------------------------------------------------------------------

static float share_of(plot_range r, float value) {
    return (value - r.low) / (r.high - r.low);
}

static float to_x(const editor *e, float time) {
    return mixf(e->plot.left, e->plot.right, share_of(e->state->time, time));
}

static float to_y(const editor *e, float value) {
    return mixf(e->plot.bottom, e->plot.top, share_of(e->state->value, value));
}

static float from_x(const editor *e, float x) {
    float share = (x - e->plot.left) / fmaxf(e->plot.right - e->plot.left, 1);
    return mixf(e->state->time.low, e->state->time.high, clampf(share, 0, 1));
}

static float from_y(const editor *e, float y) {
    float share = (e->plot.bottom - y) / fmaxf(e->plot.bottom - e->plot.top, 1);
    return mixf(e->state->value.low, e->state->value.high, clampf(share, 0, 1));
}

// ---- ranges -----------------------------------------------------------------------------------

// Returns the time of the whole effect, and of the curve if it continues after it; or a particle's
// life.
static plot_range time_range(const editor *e) {
    if (e->curve.over_age) return (plot_range){0, 1};
    timeline t = e->l->time;
    t.frame = t.first;
    float low = (float)timeline_seconds(&t);
    t.frame = t.last;
    float high = (float)timeline_seconds(&t);
    if (e->curve.count) {
        low = fminf(low, e->curve.keys[0].time);
        high = fmaxf(high, e->curve.keys[e->curve.count - 1].time);
    }
    high = fmaxf(high, e->curve.period);
    return (plot_range){low, high > low ? high : low + 1};
}

static bool curve_sample(editor *e) {
    double times[SAMPLES];
    plot_range r = e->state->time;
    for (size_t i = 0; i < SAMPLES; i++)
        times[i] = (double)mixf(r.low, r.high, (float)i / (SAMPLES - 1));
    return roil_sample_curve(e->l->effect, e->state->name, times, e->samples, SAMPLES);
}

static plot_range value_range(const editor *e) {
    float values[(SAMPLES + ROIL_MAX_STOPS) * 4];
    size_t count = 0;
    for (int k = 0; k < e->curve.components; k++) {
        for (size_t i = 0; i < SAMPLES; i++) values[count++] = e->samples[i][k];
        for (size_t i = 0; i < e->curve.count; i++) values[count++] = e->curve.keys[i].value[k];
    }
    return plot_range_of(values, count);
}

static bool curve_prepare(editor *e) {
    bool held = e->state->dragging;
    if (!held) e->state->time = time_range(e);
    if (!curve_sample(e)) return false;
    if (!held) e->state->value = value_range(e);
    return true;
}

// ---- drawing ----------------------------------------------------------------------------------

static uint32_t color_of(const editor *e, int component, float alpha) {
    static const float colors[4][3] = {
        {0.85f, 0.16f, 0.12f}, {0.2f, 0.62f, 0.16f}, {0.1f, 0.32f, 0.9f}, {0.6f, 0.6f, 0.6f}};
    if (e->curve.components == 1) return ui_rgba(UI_ACCENT, alpha);
    return ui_pack(colors[component], alpha);
}

static void draw_times(const editor *e) {
    plot_range r = e->state->time;
    float step = plot_step(r, 6), scale = ui_scale();
    float end = e->plot.right;
    for (float n = ceilf(r.low / step); n * step <= r.high; n++) {
        char text[32];
        float x = to_x(e, n * step);
        bool last = (n + 1) * step > r.high;
        snprintf(text, sizeof text, last && !e->curve.over_age ? "%.4g s" : "%.4g",
                 (double)(n * step));
        float half = 0.5f * ui_text_width(text);
        ui_line(x, e->plot.top, x, e->plot.bottom, ui_rgba(UI_LINE, 0.6f), scale);
        ui_label(fminf(x - half, end + RIGHT * scale - 2 * half), e->plot.bottom + 2 * scale,
                 ui_rgba(UI_DIM, 1), text);
    }
}

static void draw_values(const editor *e) {
    plot_range r = e->state->value;
    float step = plot_step(r, 5), scale = ui_scale();
    for (float n = ceilf(r.low / step); n * step <= r.high; n++) {
        char text[32];
        float value = n == 0 ? 0 : n * step, y = to_y(e, value);
        snprintf(text, sizeof text, "%.4g", (double)value);
        ui_line(e->plot.left, y, e->plot.right, y, ui_rgba(UI_LINE, n == 0 ? 1 : 0.6f), scale);
        ui_label(e->plot.left - ui_text_width(text) - 5 * scale, y - 0.5f * ui_line_height(),
                 ui_rgba(UI_DIM, 1), text);
    }
}

static void draw_line(const editor *e, int component) {
    float xy[SAMPLES * 2];
    for (size_t i = 0; i < SAMPLES; i++) {
        xy[2 * i] = mixf(e->plot.left, e->plot.right, (float)i / (SAMPLES - 1));
        xy[2 * i + 1] = clampf(to_y(e, e->samples[i][component]), e->plot.top, e->plot.bottom);
    }
    ui_polyline(xy, SAMPLES, color_of(e, component, 1), 1.75f * ui_scale());
}

static void draw_key(const editor *e, size_t i, int component) {
    const roil_key *k = &e->curve.keys[i];
    float x = to_x(e, k->time),
          y = clampf(to_y(e, k->value[component]), e->plot.top, e->plot.bottom);
    bool selected = e->state->selected == i && e->state->component == component;
    float radius = (selected ? HANDLE + 1 : HANDLE) * ui_scale();
    ui_disc(x, y, radius, color_of(e, component, 1));
    ui_ring(x, y, radius, ui_rgba(selected ? UI_TEXT : UI_FIELD, 1), 1.5f * ui_scale());
}

static void draw_playhead(const editor *e) {
    float x = to_x(e, (float)timeline_seconds(&e->l->time));
    ui_line(x, e->plot.top, x, e->plot.bottom, ui_rgba(UI_TEXT, 0.55f), ui_scale());
}

static void draw_plot(const editor *e) {
    ui_fill(e->plot, ui_rgba(UI_FIELD, 1), 2 * ui_scale());
    draw_times(e);
    draw_values(e);
    if (!e->curve.over_age) draw_playhead(e);
    for (int k = 0; k < e->curve.components; k++) draw_line(e, k);
    for (int k = 0; k < e->curve.components; k++)
        for (size_t i = 0; i < e->curve.count; i++) draw_key(e, i, k);
}

// ---- editing ----------------------------------------------------------------------------------

static size_t key_under(const editor *e, int *component) {
    float best = REACH * ui_scale();
    size_t found = ROIL_MAX_STOPS;
    for (int k = 0; k < e->curve.components; k++)
        for (size_t i = 0; i < e->curve.count; i++) {
            const roil_key *key = &e->curve.keys[i];
            float distance =
                hypotf(to_x(e, key->time) - e->canvas.x, to_y(e, key->value[k]) - e->canvas.y);
            if (distance >= best) continue;
            best = distance;
            found = i;
            *component = k;
        }
    return found;
}

static void curve_press(editor *e) {
    shape_state *s = e->state;
    s->component = 0;
    s->selected = key_under(e, &s->component);
    if (s->selected == ROIL_MAX_STOPS) return;
    const roil_key *key = &e->curve.keys[s->selected];
    s->dragging = true;
    s->grab_x = to_x(e, key->time) - e->canvas.x;
    s->grab_y = to_y(e, key->value[s->component]) - e->canvas.y;
}

static bool curve_drag(editor *e) {
    const shape_state *s = e->state;
    if (e->canvas.dx == 0 && e->canvas.dy == 0) return false;
    roil_key *key = &e->curve.keys[s->selected], before = *key;
    float time = from_x(e, e->canvas.x + s->grab_x), value = from_y(e, e->canvas.y + s->grab_y);
    curve_keys_move(&e->curve, s->selected, plot_round(s->time, time));
    key->value[s->component] = plot_round(s->value, value);
    return memcmp(key, &before, sizeof before) != 0;
}

static bool add_key(editor *e) {
    float time = plot_round(e->state->time, from_x(e, e->canvas.x)), value[1][4];
    if (!roil_sample_curve(e->l->effect, e->state->name, &(double){(double)time}, value, 1))
        return false;
    size_t index = curve_keys_add(&e->curve, time, value[0]);
    if (index == ROIL_MAX_STOPS) {
        live_notice(e->l, "there is no room for another key");
        return false;
    }
    e->state->selected = index;
    e->state->component = 0;
    return true;
}

static bool remove_key(editor *e, size_t index) {
    if (!curve_keys_remove(&e->curve, index)) {
        live_notice(e->l, "a curve keeps one key at least");
        return false;
    }
    e->state->selected = ROIL_MAX_STOPS;
    return true;
}

static bool handle_pointer(editor *e) {
    const ui_canvas *c = &e->canvas;
    shape_state *s = e->state;
    int component;
    if (s->selected >= e->curve.count || s->component >= e->curve.components) { // after a reload
        s->selected = ROIL_MAX_STOPS;
        s->dragging = false;
    }
    size_t under = key_under(e, &component);
    if (c->double_clicked && under == ROIL_MAX_STOPS) return add_key(e);
    if (c->right_pressed) return under != ROIL_MAX_STOPS && remove_key(e, under);
    if (c->pressed) curve_press(e);
    if (!c->held) s->dragging = false;
    return s->dragging && curve_drag(e);
}

static bool edit_shape(editor *e) {
    size_t index = 0;
    for (size_t i = 0; i < COUNT_OF(shapes); i++)
        if (strcmp(shapes[i], e->curve.shape) == 0) index = i;
    panel_label("Shape");
    if (!ui_choice("##shape", &index, shapes, COUNT_OF(shapes))) return false;
    e->curve.shape = shapes[index];
    return true;
}

static bool edit_key(editor *e) {
    size_t i = e->state->selected;
    if (i >= e->curve.count) return false;
    roil_key *key = &e->curve.keys[i];
    float time = key->time;
    bool changed = false;
    panel_label(e->curve.over_age ? "Age" : "Time");
    if (ui_number("##time", &time, 1, -INFINITY, INFINITY, false, e->curve.over_age ? "" : "s")) {
        curve_keys_move(&e->curve, i, time);
        changed = true;
    }
    panel_label("Value");
    changed |=
        ui_number("##value", key->value, e->curve.components, -INFINITY, INFINITY, false, "");
    return changed;
}

// ---- whole ------------------------------------------------------------------------------------

static void open_canvas(editor *e) {
    float scale = ui_scale();
    e->canvas = ui_canvas_begin("plot", 0, HEIGHT * scale);
    e->plot = e->canvas.area;
    e->plot.left += LEFT * scale;
    e->plot.top += TOP * scale;
    e->plot.right -= RIGHT * scale;
    e->plot.bottom -= BOTTOM * scale;
}

static bool curve_paint(editor *e) {
    open_canvas(e);
    bool changed = handle_pointer(e);
    draw_plot(e);
    ui_canvas_end();
    panel_table_begin("key");
    if (!e->curve.over_age) changed |= edit_shape(e);
    changed |= edit_key(e);
    ui_table_end();
    if (e->curve.over_age) ui_text_color(UI_DIM, "Over a particle's life, from 0 to 1.");
    if (e->state->selected == ROIL_MAX_STOPS)
        ui_text_color(UI_DIM, "Double click adds a key, right click removes one.");
    if (e->curve.period > 0)
        ui_text_color(UI_DIM, "Repeats every %.4g s.", (double)e->curve.period);
    return changed;
}

static void curve_send(editor *e) {
    char *text = roil_curve_text(&e->curve);
    live_set(e->l, e->state->name, text);
    roil_free(text);
}

bool curve_draw(live *l, const char *name) {
    shape_state state = shape_state_take(&l->panel->curve, name);
    editor e = {.l = l, .state = &state};
    if (!roil_get_curve(l->effect, name, &e.curve) || !curve_prepare(&e)) {
        ui_text_color(UI_ERROR, "%s", roil_error());
        return false;
    }
    ui_push(name);
    bool changed = curve_paint(&e);
    if (changed) curve_send(&e);
    panel_shape_buttons(l, name);
    ui_pop();
    shape_state_give(&l->panel->curve, &state);
    return changed;
}
