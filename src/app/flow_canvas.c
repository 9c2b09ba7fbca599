// The slice that a user works in: dragging pushes the flow or selects squares, and clicks put
// templates into it.
#include "app/flow_tools.h"
#include "app/label.h"
#include "base/clock.h"
#include "base/log.h"
#include <math.h>

static const float SHARE = 0.5f;   // of the pointer's speed that a push gives what lies there
static const float STEP = 1.1f;    // of a size, by a notch of the wheel
static const float TURN = 15;      // degrees, by a notch with Shift
static const float LEAST_SIDE = 4; // cells that are worth to be captured
static const double LONGEST = 0.5, SHORTEST = 1 / 240.0; // seconds between two looks at the pointer
static const float ARROWS = 22;                          // units

typedef struct sheet { // the slice on the canvas
    ui_rect area;
    float size; // pixels for its width
} sheet;

static sheet lay_out(const ui_canvas *c, const roil_slices *flow) {
    float width = c->area.right - c->area.left, height = c->area.bottom - c->area.top;
    float aspect = flow->height / flow->width;
    sheet out = {.size = floorf(fminf(width, height / aspect))};
    float high = floorf(out.size * aspect), left = floorf(c->area.left + (width - out.size) / 2);
    float top = floorf(c->area.top + (height - high) / 2);
    out.area = (ui_rect){left, top, left + out.size, top + high};
    return out;
}

static void place_of(const sheet *s, float x, float y, float out[2]) {
    out[0] = (x - s->area.left) / s->size;
    out[1] = (s->area.bottom - y) / s->size;
}

static ui_rect square_of(const sheet *s, const float middle[2], float side) {
    float x = s->area.left + middle[0] * s->size, y = s->area.bottom - middle[1] * s->size;
    float half = side * s->size / 2;
    return (ui_rect){x - half, y - half, x + half, y + half};
}

static bool is_inside(const sheet *s, const ui_canvas *c) {
    return c->hovered && c->x >= s->area.left && c->x < s->area.right && c->y >= s->area.top &&
           c->y < s->area.bottom;
}

static roil_slices_square square_at(const flow_tools *t, const float middle[2], float side) {
    return (roil_slices_square){t->view.flow, t->view.slice, {middle[0], middle[1]}, side};
}

// ---- pushing ------------------------------------------------------------------------------------

// Accelerates the flow under the pointer by a part of the pointer's speed, in one step.
static void flow_push(live *l, flow_tools *t, const sheet *s, const ui_canvas *c) {
    const roil_slices *flow = &t->flows[t->view.flow];
    float now[2], force[2];
    place_of(s, c->x, c->y, now);
    double passed = fmin(fmax(clock_seconds() - t->looked, SHORTEST), LONGEST);
    if (t->pushing && !c->pressed && (c->dx != 0 || c->dy != 0)) {
        float middle[2];
        for (int i = 0; i < 2; i++) {
            float speed = (now[i] - t->last[i]) * flow->width / (float)passed;
            force[i] = SHARE * speed / (float)flow->time_step;
            middle[i] = (now[i] + t->last[i]) / 2;
        }
        const roil_slices_square where = square_at(t, middle, t->push_side);
        if (!roil_slices_push(l->effect, &where, force)) live_notice(l, "%s", roil_error());
        log_write(LOG_DEBUG, "live: pushed %s at %.3f %.3f by %.3g %.3g", flow->name,
                  (double)middle[0], (double)middle[1], (double)force[0], (double)force[1]);
    }
    t->pushing = c->held; // and in the frame in which it is let go
    t->last[0] = now[0], t->last[1] = now[1];
    t->looked = clock_seconds();
}

// ---- selecting ----------------------------------------------------------------------------------

// Draws a square from its first corner towards the pointer, within the slice.
static void draw_out(flow_tools *t, const sheet *s, const ui_canvas *c) {
    const roil_slices *flow = &t->flows[t->view.flow];
    const float high[2] = {1, flow->height / flow->width};
    float now[2], way[2];
    place_of(s, c->x, c->y, now);
    if (c->pressed) t->corner[0] = now[0], t->corner[1] = now[1];
    float side = 0;
    for (int i = 0; i < 2; i++) side = fmaxf(side, fabsf(now[i] - t->corner[i]));
    for (int i = 0; i < 2; i++) {
        way[i] = now[i] < t->corner[i] ? -1 : 1;
        side = fminf(side, way[i] < 0 ? t->corner[i] : high[i] - t->corner[i]);
    }
    t->side = side * (float)flow->size[0] < LEAST_SIDE ? 0 : side;
    for (int i = 0; i < 2; i++) t->middle[i] = t->corner[i] + way[i] * side / 2;
    if (c->pressed) t->side = 0;
}

static void select_square(flow_tools *t, const sheet *s, const ui_canvas *c) {
    if (c->pressed ? is_inside(s, c) : (c->held || c->released) && t->corner[0] >= 0)
        draw_out(t, s, c);
    if (c->pressed && !is_inside(s, c)) t->corner[0] = -1; // what is drawn out begins in the slice
    if (t->side <= 0) return;
    ui_rect square = square_of(s, t->middle, t->side);
    ui_frame(square, ui_rgba(UI_PANEL, 0.8f), 0, 3 * ui_scale());
    ui_frame(square, ui_rgba(UI_ACCENT, 1), 0, ui_scale());
}

// ---- putting ------------------------------------------------------------------------------------

static void flow_put(live *l, flow_tools *t, const sheet *s, const ui_canvas *c) {
    if (!is_inside(s, c) || !t->file[0]) return;
    roil_template_use *use = &t->use;
    if (c->wheel != 0 && c->shift) use->angle = remainderf(use->angle + TURN * c->wheel, 360);
    if (c->wheel != 0 && !c->shift)
        use->where.side = fminf(fmaxf(use->where.side * powf(STEP, c->wheel), 0.01f), 1);
    float at[2], side = use->where.side;
    place_of(s, c->x, c->y, at);
    ui_rect square = square_of(s, at, side);
    const roil_texture *icon = flow_list_icon(t);
    if (icon && use->angle == 0) ui_image(square, icon);
    ui_frame(square, ui_rgba(UI_ACCENT, 1), 0, ui_scale());
    float turn = use->angle * 0.0174532925f, half = side * s->size / 2; // to where its top goes
    ui_line(c->x, c->y, c->x - half * sinf(turn), c->y - half * cosf(turn), ui_rgba(UI_ACCENT, 1),
            2 * ui_scale());
    if (!c->pressed) return;
    use->where = square_at(t, at, side);
    use->file = t->file;
    t->put = roil_template_put(l->effect, use);
    t->line[0] = '\0';
    if (!t->put)
        live_notice(l, "%s", roil_error());
    else
        log_write(LOG_DEBUG, "live: put %s at %.3f %.3f", t->file, (double)at[0], (double)at[1]);
}

// ---- the canvas ---------------------------------------------------------------------------------

void flow_canvas_draw(live *l, flow_tools *t, float height) {
    ui_canvas c = ui_canvas_begin("slice view", 0, height);
    ui_fill(c.area, ui_rgba(UI_FIELD, 1), 0);
    if (t->flow_count == 0) {
        label_within(c.area.left + 12 * ui_scale(), c.area.top + 12 * ui_scale(),
                     c.area.right - c.area.left, ui_rgba(UI_DIM, 1),
                     "The effect has no slices { }");
        ui_canvas_end();
        return;
    }
    const sheet s = lay_out(&c, &t->flows[t->view.flow]);
    ui_mark("sheet", s.area);
    t->wanted[0] = (uint32_t)fmaxf(s.area.right - s.area.left, 1);
    t->wanted[1] = (uint32_t)fmaxf(s.area.bottom - s.area.top, 1);
    t->view.arrows = ARROWS * ui_scale();
    if (t->texture && !t->failure[0]) ui_image(s.area, t->texture);
    if (t->failure[0])
        label_within(c.area.left + 12 * ui_scale(), c.area.top + 12 * ui_scale(),
                     c.area.right - c.area.left - 24 * ui_scale(), ui_rgba(UI_DIM, 1), t->failure);
    if (t->tool == FLOW_PUSH) flow_push(l, t, &s, &c);
    if (t->tool == FLOW_SELECT) select_square(t, &s, &c);
    if (t->tool == FLOW_PUT) flow_put(l, t, &s, &c);
    ui_canvas_end();
}
