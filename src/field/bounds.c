// What can be asked of an expression besides its value: where it can differ from zero, which grids
// it samples, how it reads. Walks visit a shared node once.
#include "base/map.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/kinds.h"
#include "field/range.h"
#include <math.h>
#include <string.h>

typedef struct boxes {
    const field_context *context;
    bool whole; // grids, whatever they hold
    map places; // node -> index of its box
    box3 *values;
    size_t count, capacity;
} boxes;

static bool is_zero(const float value[4], int components) {
    for (int c = 0; c < components; c++)
        if (value[c] != 0) return false;
    return true;
}

// A kind that computes point by point and makes zero of zeros is zero outside of the boxes of its
// arguments; arguments that do not vary in space keep their values in this test.
static bool bounds_by_zeros(const field *node, const field_context *context, const box3 *args,
                            box3 *box) {
    *box = box3_infinite();
    if (node->kind->spatial || !node->kind->eval) return true;
    float values[FIELD_MAX_ARGS][4] = {{0}}, out[4] = {0};
    box3 all = box3_empty();
    for (size_t i = 0; i < FIELD_MAX_ARGS && node->args[i]; i++) {
        if (!node->args[i]->uniform)
            all = box3_union(all, args[i]);
        else if (!kind_uniform_arg(node, i, context, values[i]))
            return false;
    }
    node->kind->eval(&(field_point){.node = node, .context = context}, (const float(*)[4])values,
                     out);
    if (is_zero(out, node->components)) *box = all;
    return true;
}

static box3 bounds_grid(const field *node, bool whole) {
    const field_grid *grid = node->object;
    if (grid->repeats) return box3_infinite();
    return whole ? grid->box : box3_intersect(grid->box, grid->state.active);
}

static bool find(boxes *b, const field *node, box3 *out);

// Of arguments that do not vary in space only factors and the like have a box that counts.
static bool find_args(boxes *b, const field *node, box3 *out) {
    const bool all = node->kind->bounds && !node->kind->spatial;
    for (size_t i = 0; i < FIELD_MAX_ARGS && node->args[i]; i++)
        if ((all || !node->args[i]->uniform) && !find(b, node->args[i], &out[i])) return false;
    return true;
}

static bool find(boxes *b, const field *node, box3 *out) {
    if (node->uniform) {
        float value[4];
        if (!field_eval(node, b->context, (float3){0, 0, 0}, value)) return false;
        *out = is_zero(value, node->components) ? box3_empty() : box3_infinite();
        return true;
    }
    const uint32_t *place = map_find(&b->places, node, 0);
    if (place) {
        *out = b->values[*place];
        return true;
    }
    box3 args[FIELD_MAX_ARGS];
    if (!find_args(b, node, args)) return false;
    if (kind_of(node) == KIND_GRID)
        *out = bounds_grid(node, b->whole);
    else if (node->kind->bounds)
        *out = node->kind->bounds(node, b->context, args);
    else if (!bounds_by_zeros(node, b->context, args, out))
        return false;
    MEM_RESERVE(b->values, b->count + 1, b->capacity);
    b->values[b->count] = *out;
    map_set(&b->places, node, 0, (uint32_t)b->count++);
    return true;
}

static bool bounds(const field *node, const field_context *context, bool whole, box3 *out) {
    boxes b = {.context = context, .whole = whole};
    bool ok = find(&b, node, out);
    map_free(&b.places);
    mem_free(b.values);
    return ok;
}

const field *field_without_bounds(const field *node, const field_context *context) {
    boxes b = {.context = context};
    for (const field *next = node; next;) {
        node = next;
        next = NULL;
        for (size_t i = 0; i < kind_arg_count(node); i++) {
            box3 box;
            const field *arg = node->args[i];
            if (arg->uniform || !find(&b, arg, &box)) continue;
            if (box3_is_finite(box)) { // this one had bounds, and its owner lost them
                next = NULL;
                break;
            }
            if (!next) next = arg;
        }
    }
    map_free(&b.places);
    mem_free(b.values);
    return node;
}

bool field_bounds(const field *node, const field_context *context, box3 *out) {
    return bounds(node, context, false, out);
}

bool field_bounds_of_grids(const field *node, const field_context *context, box3 *out) {
    return bounds(node, context, true, out);
}

// ---- boxes of kinds ---------------------------------------------------------------------------

box3 bounds_mul(const field *node, const field_context *context, const box3 *args) {
    (void)node, (void)context;
    return box3_intersect(args[0], args[1]);
}

box3 bounds_dot(const field *node, const field_context *context, const box3 *args) {
    return bounds_mul(node, context, args);
}

box3 bounds_div(const field *node, const field_context *context, const box3 *args) {
    (void)node, (void)context;
    return box3_intersect(args[0], args[1]); // 0 where the divisor is 0
}

box3 bounds_mix(const field *node, const field_context *context, const box3 *args) {
    (void)node, (void)context;
    return box3_union(args[0], box3_intersect(args[1], args[2]));
}

// Never below zero, as far as can be told at a glance: shapes and what they are multiplied with.
static bool not_negative(const field *node, int depth) {
    if (strcmp(node->kind->group, "shape") == 0) return true;
    if (kind_of(node) == KIND_CONSTANT)
        return node->value[0] >= 0 && node->value[1] >= 0 && node->value[2] >= 0 &&
               node->value[3] >= 0;
    bool passes = kind_of(node) == KIND_MUL || kind_of(node) == KIND_ADD ||
                  strcmp(node->kind->name, "min") == 0;
    return passes && depth > 0 && not_negative(node->args[0], depth - 1) &&
           not_negative(node->args[1], depth - 1);
}

box3 bounds_min(const field *node, const field_context *context, const box3 *args) {
    (void)context;
    if (not_negative(node->args[0], 4) && not_negative(node->args[1], 4))
        return box3_intersect(args[0], args[1]);
    return box3_union(args[0], args[1]);
}

// By the range over all of space; that of a large expression is not asked for.
static float ranged(const field *node, const field_context *context) {
    const uint32_t large = 256;
    const float known = 1e12f;
    intervals all;
    float most = 0;
    if (node->size > large || !field_ranges(node, context, box3_infinite(), &all)) return INFINITY;
    for (int c = 0; c < node->components; c++)
        most = fmaxf(most, fmaxf(fabsf(all.c[c].low), fabsf(all.c[c].high)));
    return most < known ? most : INFINITY;
}

// How far a vector field can reach along an axis, INFINITY when unknown.
static float longest(const field *node, const field_context *context, int depth) {
    float value[4];
    if (node->uniform) {
        if (!field_eval(node, context, (float3){0, 0, 0}, value)) return INFINITY;
        float square = 0;
        for (int c = 0; c < node->components; c++) square += value[c] * value[c];
        return sqrtf(square);
    }
    if (depth == 0) return INFINITY;
    float a, b;
    switch (kind_of(node)) {
    case KIND_ADD:
    case KIND_SUB:
    case KIND_MUL:
        a = longest(node->args[0], context, depth - 1);
        b = longest(node->args[1], context, depth - 1);
        if (kind_of(node) == KIND_MUL) return a == 0 || b == 0 ? 0 : a * b;
        return a + b;
    case KIND_NEGATE:
        return longest(node->args[0], context, depth - 1);
    case KIND_WARP:
    case KIND_TRANSFORM:
        return longest(node->args[0], context, depth - 1);
    case KIND_GRID: {
        const field_grid *grid = node->object;
        return grid->longest > 0 ? grid->longest : INFINITY;
    }
    default:
        break;
    }
    // A component of the curl of unit noise stays below 7.6 (RANGE_CURL of lib/range_noise.glsl);
    // its paper mode differs two noises of -1..1 in each component, an octave more or less.
    if (strcmp(node->kind->name, "curl") == 0) {
        if (node->options[0] == 0) return 7.6f * longest(node->args[5], context, depth - 1);
        float octaves[4];
        if (!kind_uniform_arg(node, 1, context, octaves)) return INFINITY;
        return 3.5f * octaves[0] * longest(node->args[5], context, depth - 1);
    }
    if (strcmp(node->kind->group, "noise") == 0) return longest(node->args[5], context, depth - 1);
    return ranged(node, context);
}

float field_longest(const field *node, const field_context *context) {
    return longest(node, context, 8);
}

box3 bounds_warp(const field *node, const field_context *context, const box3 *args) {
    float reach = longest(node->args[1], context, 8), amount = longest(node->args[2], context, 8);
    if (amount == 0 || reach == 0) return args[0];
    if (box3_is_empty(args[0])) return args[0];
    return isfinite(reach * amount) ? box3_grow(args[0], reach * amount) : box3_infinite();
}

box3 bounds_transform(const field *node, const field_context *context, const box3 *args) {
    float t[4], r[4], s[4], there[3][4], m[3][4];
    if (box3_is_empty(args[0])) return args[0];
    if (!box3_is_finite(args[0]) || !kind_uniform_arg(node, 1, context, t) ||
        !kind_uniform_arg(node, 2, context, r) || !kind_uniform_arg(node, 3, context, s))
        return box3_infinite();
    kind_transform_matrix(t, r, s, there, m);
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
        const float a[3] = {args[0].min.x, args[0].min.y, args[0].min.z};
        const float b[3] = {args[0].max.x, args[0].max.y, args[0].max.z};
        low[i] = high[i] = m[i][3];
        for (int k = 0; k < 3; k++) {
            low[i] += fminf(m[i][k] * a[k], m[i][k] * b[k]);
            high[i] += fmaxf(m[i][k] * a[k], m[i][k] * b[k]);
        }
    }
    return (box3){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

// ---- grids and text ---------------------------------------------------------------------------

typedef struct grid_list {
    const field_grid **out;
    size_t capacity, count;
    map seen; // nodes and grids
} grid_list;

static void collect(grid_list *list, const field *node) {
    if (map_find(&list->seen, node, 0)) return;
    map_set(&list->seen, node, 0, 0);
    if (kind_of(node) == KIND_GRID && !map_find(&list->seen, node->object, 1)) {
        map_set(&list->seen, node->object, 1, 0);
        if (list->count < list->capacity) list->out[list->count] = node->object;
        list->count++;
    }
    for (size_t i = 0; i < kind_arg_count(node); i++) collect(list, node->args[i]);
}

size_t field_grids(const field *node, const field_grid **out, size_t capacity) {
    grid_list list = {.out = out, .capacity = capacity};
    collect(&list, node);
    map_free(&list.seen);
    return list.count;
}

static bool samples(map *seen, const field *node, const field_grid *grid, int image) {
    if (map_find(seen, node, 0)) return false;
    map_set(seen, node, 0, 0);
    bool found = kind_of(node) == KIND_GRID && node->object == grid && node->index / 4 == image;
    for (size_t i = 0; i < kind_arg_count(node) && !found; i++)
        found = samples(seen, node->args[i], grid, image);
    return found;
}

bool field_samples(const field *node, const field_grid *grid, int image) {
    map seen = {0};
    bool found = samples(&seen, node, grid, image);
    map_free(&seen);
    return found;
}

static void print(const field *node, strbuf *out, size_t limit) {
    if (out->length > limit) return;
    switch (kind_of(node)) {
    case KIND_CONSTANT:
        strbuf_add(out, node->components > 1 ? "{" : "");
        for (int c = 0; c < node->components; c++)
            strbuf_add(out, "%s%g", c > 0 ? ", " : "", (double)node->value[c]);
        strbuf_add(out, node->components > 1 ? "}" : "");
        return;
    case KIND_PARAM:
        strbuf_add(out, "param %d", node->index);
        return;
    case KIND_CALL:
        strbuf_add(out, "function %d", node->index);
        return;
    case KIND_CURVE:
        strbuf_add(out, "curve ");
        curve_print(node->object, out);
        return;
    case KIND_GRID: {
        const field_grid *grid = node->object;
        strbuf_add(out, "%s[%d]", grid->name ? grid->name : "grid", node->index);
        return;
    }
    case KIND_SWIZZLE:
        print(node->args[0], out, limit);
        strbuf_add(out, ".");
        for (int c = 0; c < node->components; c++)
            strbuf_add(out, "%c", "xyzw"[node->index >> 2 * c & 3]);
        return;
    case KIND_GLSL:
        strbuf_add(out, "%s", ((const field_glsl *)node->object)->function);
        break;
    default:
        strbuf_add(out, "%s", node->kind->name);
        break;
    }
    if (!node->args[0]) return;
    strbuf_add(out, "(");
    for (size_t i = 0; i < kind_arg_count(node); i++) {
        if (i > 0) strbuf_add(out, ", ");
        print(node->args[i], out, limit);
    }
    strbuf_add(out, ")");
}

void field_print(const field *node, strbuf *out) {
    const size_t most = 1000; // a shared node is printed at every use
    size_t start = out->length;
    print(node, out, start + most);
    if (out->length > start + most) strbuf_add(out, " ...");
}
