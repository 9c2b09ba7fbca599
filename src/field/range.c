// The walk over an expression for its ranges.
#include "field/range.h"
#include "base/map.h"
#include "base/memory.h"
#include "field/kinds.h"
#include <math.h>

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
