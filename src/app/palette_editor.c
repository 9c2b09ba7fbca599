// The editor of a palette: its ramp, the stops below it as handles, and the selected stop as
// numbers.
#include "app/palette_stops.h"
#include "app/panel_parts.h"
#include "base/maths.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SAMPLES = 256, STRIPS = 128, MADE_STOPS = 8 };
static const float RAMP = 36, RAIL = 22, HANDLE = 6, REACH = 9; // units
static const float LEAVE = 40; // units from the canvas at which a dragged stop is let fall

typedef struct editor {
    live *l;
    shape_state *state;
    roil_palette palette;
    float samples[SAMPLES][4]; // across its range, at the time that is shown
    ui_canvas canvas;
    ui_rect ramp;
    float rail; // middle of the handles
} editor;

// ---- places -----------------------------------------------------------------------------------

// The ramp's range is fixed while a stop is dragged. Where no range is declared, the outermost
// stops define it.
static float to_x(const editor *e, float at) {
    plot_range view = e->state->value;
    float share = view.high > view.low ? (at - view.low) / (view.high - view.low) : 0;
    return mixf(e->ramp.left, e->ramp.right, clampf(share, 0, 1));
}

static float from_x(const editor *e, float x) {
    float share = (x - e->ramp.left) / fmaxf(e->ramp.right - e->ramp.left, 1);
    return mixf(e->state->value.low, e->state->value.high, clampf(share, 0, 1));
}

static float place_under(const editor *e, float x) {
    return plot_round(e->state->value, from_x(e, x));
}

static void sample_at(const editor *e, float at, float out[4]) {
    float span = e->palette.max - e->palette.min;
    float place = span > 0 ? clampf((at - e->palette.min) / span, 0, 1) * (SAMPLES - 1) : 0;
    size_t i = (size_t)place < SAMPLES - 2 ? (size_t)place : SAMPLES - 2;
    for (int k = 0; k < 4; k++)
        out[k] = mixf(e->samples[i][k], e->samples[i + 1][k], place - (float)i);
}

// Returns the stop under the pointer; of several at one place, the selected one.
static size_t stop_under(const editor *e) {
    float best = REACH * ui_scale();
    size_t found = ROIL_MAX_STOPS;
    if (fabsf(e->canvas.y - e->rail) > 0.5f * RAIL * ui_scale()) return found;
    for (size_t i = 0; i < e->palette.count; i++) {
        float distance = fabsf(to_x(e, e->palette.stops[i].at) - e->canvas.x);
        if (distance > best || (distance == best && i != e->state->selected)) continue;
        best = distance;
        found = i;
    }
    return found;
}

// ---- drawing ----------------------------------------------------------------------------------

static float peak(const float color[4]) {
    return fmaxf(color[0], fmaxf(color[1], color[2]));
}

// Reduces colours brighter than white so that they keep their hue.
static uint32_t shown_color(const float color[4], float alpha) {
    float scale = 1 / fmaxf(peak(color), 1);
    return ui_pack((const float[]){color[0] * scale, color[1] * scale, color[2] * scale}, alpha);
}

// Shows how bright colours beyond white are: a logarithmic line over the ramp, up to the brightest.
static void draw_brightness(const editor *e) {
    float xy[SAMPLES * 2], most = 1, height = e->ramp.bottom - e->ramp.top;
    for (size_t i = 0; i < SAMPLES; i++) most = fmaxf(most, peak(e->samples[i]));
    if (most < 1.05f) return;
    for (size_t i = 0; i < SAMPLES; i++) {
        float share = logf(fmaxf(peak(e->samples[i]), 1)) / logf(most);
        float at = mixf(e->palette.min, e->palette.max, (float)i / (SAMPLES - 1));
        xy[2 * i] = to_x(e, at);
        xy[2 * i + 1] = e->ramp.bottom - (0.08f + 0.84f * share) * height;
    }
    const float black[3] = {0};
    ui_polyline(xy, SAMPLES, ui_pack(black, 0.45f), 3 * ui_scale());
    ui_polyline(xy, SAMPLES, ui_rgba(UI_TEXT, 0.9f), ui_scale());
    char text[32];
    snprintf(text, sizeof text, "\u00d7%.3g", (double)most);
    float left = e->ramp.left + 4 * ui_scale(), top = e->ramp.top + 3 * ui_scale();
    float pad = 3 * ui_scale();
    ui_fill((ui_rect){left, top, left + ui_text_width(text) + 2 * pad, top + ui_line_height()},
            ui_pack(black, 0.5f), pad);
    ui_label(left + pad, top, ui_rgba(UI_TEXT, 1), text);
}

static void draw_ramp(const editor *e) {
    ui_checkers(e->ramp, 6 * ui_scale());
    float width = (e->ramp.right - e->ramp.left) / STRIPS, left[4], right[4];
    sample_at(e, from_x(e, e->ramp.left), right);
    for (size_t i = 0; i < STRIPS; i++) {
        float x = e->ramp.left + (float)i * width;
        memcpy(left, right, sizeof left);
        sample_at(e, from_x(e, x + width), right);
        ui_gradient((ui_rect){x, e->ramp.top, x + width, e->ramp.bottom},
                    shown_color(left, left[3]), shown_color(right, right[3]));
    }
    draw_brightness(e);
    ui_frame(e->ramp, ui_rgba(UI_LINE, 1), 0, ui_scale());
}

static void draw_stop(const editor *e, size_t i, bool hot) {
    const roil_stop *s = &e->palette.stops[i];
    bool selected = i == e->state->selected;
    float x = to_x(e, s->at), radius = HANDLE * ui_scale();
    float alpha = selected && e->state->leaving ? 0.25f : 1;
    ui_color edge = selected ? UI_ACCENT : hot ? UI_TEXT : UI_DIM;
    ui_line(x, e->ramp.bottom, x, e->rail - radius, ui_rgba(edge, alpha), ui_scale());
    ui_disc(x, e->rail, radius, shown_color(s->color, alpha));
    ui_ring(x, e->rail, radius, ui_rgba(edge, alpha), (selected ? 2 : 1.5f) * ui_scale());
}

static void draw_stops(const editor *e) {
    size_t hot = e->canvas.hovered ? stop_under(e) : ROIL_MAX_STOPS;
    ui_line(e->ramp.left, e->rail, e->ramp.right, e->rail, ui_rgba(UI_LINE, 1), ui_scale());
    for (size_t i = 0; i < e->palette.count; i++)
        if (i != e->state->selected) draw_stop(e, i, i == hot);
    if (e->state->selected < e->palette.count) draw_stop(e, e->state->selected, false);
}

// ---- editing ----------------------------------------------------------------------------------

static bool remove_stop(editor *e, size_t index) {
    if (!palette_stops_remove(&e->palette, index)) {
        live_notice(e->l, "a palette keeps two stops at least");
        return false;
    }
    e->state->selected = ROIL_MAX_STOPS;
    return true;
}

static bool add_stop(editor *e) {
    float color[4], at = place_under(e, e->canvas.x);
    sample_at(e, at, color);
    size_t index = palette_stops_add(&e->palette, at, color);
    if (index == ROIL_MAX_STOPS) {
        live_notice(e->l, "a palette has %d stops at most", ROIL_MAX_STOPS);
        return false;
    }
    e->state->selected = index;
    return true;
}

static bool palette_press(editor *e) {
    bool on_rail = fabsf(e->canvas.y - e->rail) <= 0.5f * RAIL * ui_scale(), added = false;
    e->state->selected = stop_under(e);
    if (e->state->selected == ROIL_MAX_STOPS && on_rail) added = add_stop(e);
    if (e->state->selected == ROIL_MAX_STOPS) return false;
    e->state->dragging = true;
    e->state->leaving = false;
    e->state->grab_x = to_x(e, e->palette.stops[e->state->selected].at) - e->canvas.x;
    return added;
}

static bool palette_drag(editor *e) {
    shape_state *s = e->state;
    float over = e->canvas.area.top - e->canvas.y, under = e->canvas.y - e->canvas.area.bottom;
    s->leaving = fmaxf(over, under) > LEAVE * ui_scale() && e->palette.count > 2;
    if (s->leaving || (e->canvas.dx == 0 && e->canvas.dy == 0)) return false;
    float before = e->palette.stops[s->selected].at;
    palette_stops_move(&e->palette, s->selected, place_under(e, e->canvas.x + s->grab_x));
    return e->palette.stops[s->selected].at != before;
}

static bool let_go(editor *e) {
    bool leaving = e->state->leaving;
    e->state->dragging = e->state->leaving = false;
    return leaving && remove_stop(e, e->state->selected);
}

static bool handle_pointer(editor *e) {
    const ui_canvas *c = &e->canvas;
    if (e->state->selected >= e->palette.count) { // as after a reload
        e->state->selected = ROIL_MAX_STOPS;
        e->state->dragging = false;
    }
    if (c->pressed) return palette_press(e);
    if (c->right_pressed) {
        size_t under = stop_under(e);
        return under != ROIL_MAX_STOPS && remove_stop(e, under);
    }
    if (!e->state->dragging) return false;
    return c->held ? palette_drag(e) : let_go(e);
}

static bool edit_stop(editor *e) {
    size_t i = e->state->selected;
    if (i >= e->palette.count) {
        ui_text_color(UI_DIM, "A click below adds a stop, a right click removes one.");
        return false;
    }
    roil_stop *s = &e->palette.stops[i];
    float low = i > 0 ? s[-1].at : -INFINITY, high = i + 1 < e->palette.count ? s[1].at : INFINITY;
    float at = s->at;
    bool changed = false;
    panel_table_begin("stop");
    panel_label("Position");
    if (ui_number("##position", &at, 1, low, high, false, "")) {
        palette_stops_move(&e->palette, i, at);
        changed = true;
    }
    panel_label("Colour");
    changed |= ui_color_edit("##color", s->color, 3);
    panel_label("Alpha");
    changed |= ui_number("##alpha", &s->color[3], 1, 0, 1, false, "");
    ui_table_end();
    return changed;
}

// ---- whole ------------------------------------------------------------------------------------

static bool palette_send(editor *e) {
    char *text = roil_palette_text(&e->palette);
    live_set(e->l, e->state->name, text);
    roil_free(text);
    return true;
}

static bool open_canvas(editor *e) {
    float pad = (HANDLE + 2) * ui_scale();
    bool stops = e->palette.count && !e->palette.keyed;
    if (!e->state->dragging) e->state->value = (plot_range){e->palette.min, e->palette.max};
    e->canvas = ui_canvas_begin("ramp", 0, (RAMP + (stops ? RAIL : 0)) * ui_scale());
    e->ramp = e->canvas.area;
    e->ramp.left += pad;
    e->ramp.right -= pad;
    e->ramp.bottom = e->ramp.top + RAMP * ui_scale();
    e->rail = e->ramp.bottom + 0.5f * RAIL * ui_scale();
    if (stops)
        ui_mark("stops",
                (ui_rect){e->ramp.left, e->ramp.bottom, e->ramp.right, e->canvas.area.bottom});
    return stops;
}

// Draws the settings of a blackbody palette, which has no stops.
static bool draw_law(editor *e) {
    ui_text_color(UI_DIM, "Black body, %.4g to %.4g K.", (double)e->palette.min,
                  (double)e->palette.max);
    bool make = ui_small_button("Make stops");
    ui_tooltip("replace the law by stops that can be moved");
    ui_same_line();
    if (!make) return false;
    palette_stops_fit(&e->palette, (const float(*)[4])e->samples, SAMPLES, MADE_STOPS);
    for (size_t i = 0; i < e->palette.count; i++)
        e->palette.stops[i].at = plot_round(e->state->value, e->palette.stops[i].at);
    return palette_send(e);
}

static bool palette_paint(editor *e) {
    bool changed = false, stops = open_canvas(e);
    if (stops) changed = handle_pointer(e);
    draw_ramp(e);
    if (stops) draw_stops(e);
    ui_canvas_end();
    if (!e->palette.count) return draw_law(e);
    if (e->palette.keyed) {
        ui_text_wrapped("It moves in time: its keys are edited in the effect file.");
        return false;
    }
    changed |= edit_stop(e);
    return changed && palette_send(e);
}

bool palette_draw(live *l, const char *name) {
    shape_state state = shape_state_take(&l->panel->palette, name);
    editor e = {.l = l, .state = &state};
    double time = timeline_seconds(&l->time);
    if (!roil_get_palette(l->effect, name, &e.palette) ||
        !roil_sample_palette(l->effect, name, time, e.samples, SAMPLES)) {
        ui_text_color(UI_ERROR, "%s", roil_error());
        return false;
    }
    ui_push(name);
    bool changed = palette_paint(&e);
    panel_shape_buttons(l, name);
    ui_pop();
    shape_state_give(&l->panel->palette, &state);
    return changed;
}
