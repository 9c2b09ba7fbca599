// Interpolation between keys. Every segment depends on its two keys, the cubic also on their
// neighbours: slopes are the mean of the adjacent secants, limited to three times the smaller one
// and zero at extrema, which keeps the curve within its keys (the box of Fritsch and Carlson,
// "Monotone piecewise cubic interpolation", 1980).
#include "field/curve.h"
#include "base/error.h"
#include "base/maths.h"
#include <math.h>
#include <string.h>

static const char *const names[CURVE_SHAPE_COUNT] = {
    "step", "linear", "cubic", "ease_in", "ease_out", "ease_in_out",
};

const char *curve_shape_name(curve_shape shape) {
    return (unsigned)shape < CURVE_SHAPE_COUNT ? names[shape] : "?";
}

static bool curve_check(const curve *desc) {
    if ((unsigned)desc->shape >= CURVE_SHAPE_COUNT)
        return err_set("curve: unknown shape %d", (int)desc->shape);
    if (desc->components < 1 || desc->components > 4)
        return err_set("curve: %d components; 1 to 4 are accepted", desc->components);
    if (desc->count == 0) return err_set("curve: no keys; at least one is needed");
    if (!isfinite(desc->period) || desc->period < 0)
        return err_set("curve: the period is %g s; 0 (none) or more is accepted",
                       (double)desc->period);
    for (size_t i = 0; i < desc->count; i++) {
        const curve_key *key = &desc->keys[i];
        for (int c = 0; c < desc->components; c++)
            if (!isfinite(key->value[c]))
                return err_set("curve: key %zu has a value that is not finite", i + 1);
        if (!isfinite(key->time)) return err_set("curve: key %zu has no finite time", i + 1);
        if (i > 0 && key->time <= desc->keys[i - 1].time)
            return err_set("curve: key %zu at %g s does not come after key %zu at %g s", i + 1,
                           (double)key->time, i, (double)desc->keys[i - 1].time);
        if (desc->period > 0 && (key->time < 0 || key->time > desc->period))
            return err_set("curve: key %zu at %g s lies outside the period of %g s", i + 1,
                           (double)key->time, (double)desc->period);
    }
    return true;
}

typedef struct owned_curve { // a curve first: what curve_create makes
    curve curve;
    arena *memory;
    curve_key *room; // what replacements are copied to; NULL until the first
    size_t most;     // keys that it holds
} owned_curve;

curve *curve_create(arena *memory, const curve *desc) {
    if (!curve_check(desc)) return NULL;
    owned_curve *c = arena_alloc(memory, sizeof *c);
    *c = (owned_curve){.curve = *desc, .memory = memory};
    c->curve.keys = arena_copy(memory, desc->keys, desc->count * sizeof *desc->keys);
    c->most = desc->count > CURVE_MAX_KEYS ? desc->count : CURVE_MAX_KEYS;
    return &c->curve;
}

bool curve_replace(curve *c, const curve *desc) {
    owned_curve *own = (owned_curve *)c;
    if (!curve_check(desc)) return false;
    if (desc->components != c->components)
        return err_set("curve: its values have %d component%s, not %d", c->components,
                       c->components == 1 ? "" : "s", desc->components);
    if (desc->count > own->most)
        return err_set("curve: %zu keys; at most %zu are accepted", desc->count, own->most);
    if (!own->room) own->room = arena_alloc(own->memory, own->most * sizeof *own->room);
    memcpy(own->room, desc->keys, desc->count * sizeof *own->room);
    *c = *desc;
    c->keys = own->room;
    return true;
}

static float secant(const curve *c, size_t i, int k) { // slope from key i to i + 1
    return (c->keys[i + 1].value[k] - c->keys[i].value[k]) /
           (c->keys[i + 1].time - c->keys[i].time);
}

static float slope(const curve *c, size_t i, int k) { // of the cubic at key i
    if (c->count < 2) return 0;
    if (i == 0) return secant(c, 0, k);
    if (i == c->count - 1) return secant(c, i - 1, k);
    float before = secant(c, i - 1, k), after = secant(c, i, k);
    if (before * after <= 0) return 0;
    float most = 3 * fminf(fabsf(before), fabsf(after));
    return clampf(0.5f * (before + after), -most, most);
}

static float hermite(const curve *c, size_t i, int k, float t) {
    float span = c->keys[i + 1].time - c->keys[i].time, t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * c->keys[i].value[k] + (t3 - 2 * t2 + t) * span * slope(c, i, k) +
           (3 * t2 - 2 * t3) * c->keys[i + 1].value[k] + (t3 - t2) * span * slope(c, i + 1, k);
}

static float ease(curve_shape shape, float t) {
    float u = 1 - t;
    switch (shape) {
    case CURVE_STEP:
        return 0;
    case CURVE_EASE_IN:
        return t * t * t;
    case CURVE_EASE_OUT:
        return 1 - u * u * u;
    case CURVE_EASE_IN_OUT:
        return t < 0.5f ? 4 * t * t * t : 1 - 4 * u * u * u;
    default:
        return t;
    }
}

void curve_eval(const curve *c, double time, float out[4]) {
    memset(out, 0, 4 * sizeof *out);
    if (!isfinite(time)) time = 0;
    if (c->period > 0) {
        double period = (double)c->period;
        time -= period * floor(time / period);
    }
    size_t low = 0, high = c->count; // the last key at or before `time` is below `high`
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if ((double)c->keys[middle].time <= time)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == 0 || low == c->count) {
        const curve_key *key = &c->keys[low == 0 ? 0 : c->count - 1];
        memcpy(out, key->value, (size_t)c->components * sizeof *out);
        return;
    }
    const curve_key *a = &c->keys[low - 1], *b = &c->keys[low];
    float t = (float)((time - (double)a->time) / ((double)b->time - (double)a->time));
    float eased = ease(c->shape, t);
    for (int k = 0; k < c->components; k++)
        out[k] = c->shape == CURVE_CUBIC ? hermite(c, low - 1, k, t)
                                         : mixf(a->value[k], b->value[k], eased);
}
