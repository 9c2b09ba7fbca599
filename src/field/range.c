// Interval arithmetic, and its walk over an expression. See shaders/lib/range.glsl.
#include "field/range.h"
#include "base/map.h"
#include "base/memory.h"
#include "field/kinds.h"
#include <math.h>

static const float most = 1e15f, end = 1e30f, rounding = 1e-6f;

interval range_make(float low, float high) {
    return (interval){low >= -most ? fminf(low, most) : -end,
                      high <= most ? fmaxf(high, -most) : end};
}

interval range_wide(float low, float high) {
    return range_make(low - rounding * fabsf(low), high + rounding * fabsf(high));
}

interval range_number(float v) {
    return range_make(v, v);
}

interval range_unknown(void) {
    return (interval){-end, end};
}

interval range_union(interval a, interval b) {
    return (interval){fminf(a.low, b.low), fmaxf(a.high, b.high)};
}

interval range_add(interval a, interval b) {
    return range_make(a.low + b.low, a.high + b.high);
}

interval range_sub(interval a, interval b) {
    return range_make(a.low - b.high, a.high - b.low);
}

static float times(float a, float b) {
    if (a == 0 || b == 0) return 0;
    return fmaxf(fabsf(a), fabsf(b)) > most ? ((a < 0) == (b < 0) ? end : -end) : a * b;
}

interval range_mul(interval a, interval b) {
    float ll = times(a.low, b.low), lh = times(a.low, b.high);
    float hl = times(a.high, b.low), hh = times(a.high, b.high);
    return range_wide(fminf(fminf(ll, lh), fminf(hl, hh)), fmaxf(fmaxf(ll, lh), fmaxf(hl, hh)));
}

interval range_mix(interval a, interval b, interval t) {
    interval rest = range_sub((interval){1, 1}, t);
    interval from = range_add(range_mul(a, (interval){rest.high, rest.high}),
                              range_mul(b, (interval){t.low, t.low}));
    interval to = range_add(range_mul(a, (interval){rest.low, rest.low}),
                            range_mul(b, (interval){t.high, t.high}));
    return range_union(from, to);
}

// ---- expressions ------------------------------------------------------------------------------

typedef struct walk {
    const field_context *context;
    map places; // (node, box) -> index of its ranges
    intervals *values;
    size_t count, capacity;
    uint32_t boxes; // handed out so far
} walk;

static bool find(walk *w, const field *node, const intervals *at, uint32_t box, intervals *out);

static bool find_args(walk *w, const field *node, const intervals *at, uint32_t box, size_t first,
                      intervals out[FIELD_MAX_ARGS]) {
    for (size_t i = first; i < kind_arg_count(node); i++) {
        if (!find(w, node->args[i], at, box, &out[i])) return false;
        for (int c = 1; node->args[i]->components == 1 && c < 4; c++) out[i].c[c] = out[i].c[0];
    }
    return true;
}

static void transform(const intervals args[FIELD_MAX_ARGS], const intervals *at, intervals *out) {
    float values[3][4], m[3][4], back[3][4];
    for (int i = 0; i < 3; i++) // they do not vary in space
        for (int c = 0; c < 4; c++) values[i][c] = args[i + 1].c[c].low;
    kind_transform_matrix(values[0], values[1], values[2], m, back);
    for (int i = 0; i < 3; i++) {
        out->c[i] = range_number(m[i][3]);
        for (int k = 0; k < 3; k++)
            out->c[i] = range_add(out->c[i], range_mul(at->c[k], range_number(m[i][k])));
    }
}

bool kind_is_displacement(const field *by) {
    return kind_of(by) == KIND_SUB && kind_of(by->args[1]) == KIND_POSITION;
}

static bool warp(walk *w, const field *node, const intervals *at, uint32_t box,
                 const intervals args[FIELD_MAX_ARGS], intervals *out) {
    intervals to = {0};
    bool whole = kind_is_displacement(node->args[1]);
    if (whole && !find(w, node->args[1]->args[0], at, box, &to)) return false;
    bool one = whole && node->args[1]->args[0]->components == 1;
    for (int c = 0; c < 3; c++)
        out->c[c] = whole ? range_mix(at->c[c], to.c[one ? 0 : c], args[2].c[0])
                          : range_add(at->c[c], range_mul(args[2].c[0], args[1].c[c]));
    return true;
}

static bool find_now(walk *w, const field *node, const intervals *at, uint32_t box,
                     intervals *out) {
    intervals args[FIELD_MAX_ARGS], moved = {0};
    if (node->uniform) {
        float value[4];
        if (!field_eval(node, w->context, (float3){0, 0, 0}, value)) return false;
        for (int c = 0; c < 4; c++) out->c[c] = range_number(value[c]);
        return true;
    }
    switch (kind_of(node)) {
    case KIND_WARP:
    case KIND_TRANSFORM:
        if (!find_args(w, node, at, box, 1, args)) return false;
        if (kind_of(node) == KIND_TRANSFORM)
            transform(args, at, &moved);
        else if (!warp(w, node, at, box, args, &moved))
            return false;
        return find(w, node->args[0], &moved, ++w->boxes, out);
    default:
        if (!find_args(w, node, at, box, 0, args)) return false;
        *out = node->kind->ranges(&(field_box){node, w->context, at}, args);
        return true;
    }
}

static bool find(walk *w, const field *node, const intervals *at, uint32_t box, intervals *out) {
    const uint32_t *place = map_find(&w->places, node, box);
    if (place) {
        *out = w->values[*place];
        return true;
    }
    *out = (intervals){0};
    if (!find_now(w, node, at, box, out)) return false;
    MEM_RESERVE(w->values, w->count + 1, w->capacity);
    w->values[w->count] = *out;
    map_set(&w->places, node, box, (uint32_t)w->count++);
    return true;
}

bool field_ranges(const field *node, const field_context *context, box3 box, intervals *out) {
    walk w = {.context = context};
    intervals at = {{range_make(box.min.x, box.max.x), range_make(box.min.y, box.max.y),
                     range_make(box.min.z, box.max.z)}};
    bool ok = find(&w, node, &at, 0, out);
    map_free(&w.places);
    mem_free(w.values);
    return ok;
}
