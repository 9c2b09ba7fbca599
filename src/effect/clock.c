// Grids that are played at a speed, or from a start, that changes. The time played is the sum of
// the speed over the frames of the effect. A frame after a jump therefore shows what it would have
// shown if all frames had been drawn, and a speed that a user changes affects only what follows.
// When time goes back, the sum starts from the beginning, with the speeds at that time.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <math.h>

enum { MOST_FRAMES = 1000000 };

struct effect_clock {
    const field_grid *grid;
    const field *speed, *start;
    double *played; // seconds of the grid's own, at each frame since the first
    size_t capacity;
};

void effect_add_clock(effect *e, const field_grid *grid, const field *speed, const field *start) {
    *MEM_ADD(e->clocks, e->clock_count, e->clock_capacity) =
        (effect_clock){.grid = grid, .speed = speed, .start = start};
}

void effect_free_clocks(effect *e) {
    for (size_t i = 0; i < e->clock_count; i++) mem_free(e->clocks[i].played);
    mem_free(e->clocks);
}

void effect_restart_clocks(effect *e) {
    e->clocked = 0;
}

static bool value_at(const effect *e, const field *node, double time, double *out) {
    field_context context = e->context;
    float value[4];
    context.time = time;
    if (!field_eval(node, &context, (float3){0, 0, 0}, value)) return false;
    *out = (double)value[0];
    return true;
}

// The speed between two frames is that of the middle.
bool effect_tick(effect *e) {
    size_t k = e->clocked;
    for (size_t i = 0; i < e->clock_count; i++) {
        effect_clock *c = &e->clocks[i];
        double speed = 0;
        if (k > 0 && !value_at(e, c->speed, ((double)k - 0.5) / e->facts.fps, &speed)) return false;
        MEM_RESERVE(c->played, k + 1, c->capacity);
        c->played[k] = k > 0 ? c->played[k - 1] + speed / e->facts.fps : 0;
    }
    e->clocked++;
    return true;
}

bool effect_aim_clocks(effect *e, double frame, double *next) {
    *next = (double)INFINITY;
    if (e->clock_count == 0) return true;
    double whole = fmax(floor(frame - e->facts.first + 1e-6), 0);
    if (whole > MOST_FRAMES)
        return err_set("frame %g: a speed that moves is added up over at most %d frames", frame,
                       MOST_FRAMES);
    if (whole + 1 < (double)e->clocked) effect_restart_clocks(e);
    if ((double)e->clocked <= whole) *next = e->facts.first + (double)e->clocked;
    return true;
}

// Returns what has been played at a time, as known now. Beyond the known time, and before the first
// frame, the speed is constant.
static bool played_at(const effect *e, const effect_clock *c, double now, double time,
                      double *out) {
    double speed, from = fmin(fmax(time, 0), now);
    size_t k = 0;
    *out = 0;
    if (e->clocked > 0) {
        k = (size_t)fmin(floor(fmax(from, 0) * e->facts.fps + 1e-6), (double)(e->clocked - 1));
        *out = c->played[k];
    }
    double at = (double)k / e->facts.fps;
    if (k + 1 < e->clocked) {
        *out += (c->played[k + 1] - c->played[k]) * (time - at) * e->facts.fps;
        return true;
    }
    if (!value_at(e, c->speed, 0.5 * (at + fmax(from, at)), &speed)) return false;
    *out += speed * (from - at);
    if (from == time) return true;
    if (!value_at(e, c->speed, from, &speed)) return false;
    *out += speed * (time - from);
    return true;
}

bool effect_grid_time(const effect *e, const field_grid *grid, double now, double *out) {
    *out = now;
    for (size_t i = 0; i < e->clock_count; i++) {
        const effect_clock *c = &e->clocks[i];
        double start, begun;
        if (c->grid != grid) continue;
        if (!value_at(e, c->start, now, &start) || !played_at(e, c, now, start, &begun) ||
            !played_at(e, c, now, now, out))
            return err_prefix("'%s', speed and start: ", grid->label ? grid->label : grid->name);
        *out -= begun;
    }
    return true;
}
