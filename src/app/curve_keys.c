// Edits a curve's keys, which stay in strictly rising order of time.
#include "app/curve_keys.h"
#include <math.h>
#include <string.h>

static const float GAP = 1e-3f; // seconds between keys

size_t curve_keys_add(roil_curve *c, float time, const float value[4]) {
    if (c->count >= ROIL_MAX_STOPS) return ROIL_MAX_STOPS;
    size_t index = 0;
    for (size_t i = 0; i < c->count; i++) {
        if (fabsf(c->keys[i].time - time) < GAP) return ROIL_MAX_STOPS;
        if (c->keys[i].time < time) index = i + 1;
    }
    memmove(&c->keys[index + 1], &c->keys[index], (c->count - index) * sizeof c->keys[0]);
    c->count++;
    c->keys[index].time = time;
    memcpy(c->keys[index].value, value, sizeof c->keys[index].value);
    return index;
}

bool curve_keys_remove(roil_curve *c, size_t index) {
    if (c->count <= 1 || index >= c->count) return false;
    c->count--;
    memmove(&c->keys[index], &c->keys[index + 1], (c->count - index) * sizeof c->keys[0]);
    return true;
}

void curve_keys_move(roil_curve *c, size_t index, float time) {
    float low = index > 0 ? c->keys[index - 1].time + GAP : -INFINITY;
    float high = index + 1 < c->count ? c->keys[index + 1].time - GAP : INFINITY;
    if (low > high) return;
    c->keys[index].time = fminf(fmaxf(time, low), high);
}

// ---- plotting -----------------------------------------------------------------------------------

plot_range plot_range_of(const float *values, size_t count) {
    const float margin = 0.12f;
    plot_range r = {INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        r.low = fminf(r.low, values[i]);
        r.high = fmaxf(r.high, values[i]);
    }
    if (!(r.low <= r.high)) return (plot_range){0, 1};
    float span = r.high - r.low;
    if (span <= 1e-5f * fmaxf(fabsf(r.low), fabsf(r.high)) || span == 0)
        span = fmaxf(fabsf(r.high), 1) / margin * 0.5f; // of a constant: room above and below
    return (plot_range){r.low - margin * span, r.high + margin * span};
}

float plot_step(plot_range range, int count) {
    float least = (range.high - range.low) / (float)count;
    float power = powf(10, floorf(log10f(least)));
    if (power >= least) return power;
    if (2 * power >= least) return 2 * power;
    return 5 * power >= least ? 5 * power : 10 * power;
}

float plot_round(plot_range range, float value) {
    double step = pow(10, floor(log10(((double)range.high - (double)range.low) / 400)));
    float rounded = (float)(round((double)value / step) * step);
    return isfinite(rounded) ? fminf(fmaxf(rounded, range.low), range.high) : value;
}
