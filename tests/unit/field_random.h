// Random expressions of all kinds, and boxes.
#pragma once
#include "field_build.h"

#include "field/kinds.h"

static inline uint32_t random_below(uint32_t *seed, uint32_t end) {
    return (uint32_t)(random_float(seed) * (float)end) % end;
}

static inline box3 random_box(uint32_t *seed) { // with sides of up to 3 mm to 3 m
    float3 p = random_point(seed, 6);
    float size = powf(10, 3 * random_float(seed) - 2.5f);
    float x = size * random_float(seed), y = size * random_float(seed);
    return (box3){p, {p.x + x, p.y + y, p.z + size * random_float(seed)}};
}

static inline float3 random_inside(box3 b, uint32_t *seed) { // often on a side
    float t[3];
    for (int i = 0; i < 3; i++) t[i] = clampf(1.5f * random_float(seed) - 0.25f, 0, 1);
    return (float3){mixf(b.min.x, b.max.x, t[0]), mixf(b.min.y, b.max.y, t[1]),
                    mixf(b.min.z, b.max.z, t[2])};
}

static inline field *random_number(uint32_t *seed, int components, float scale) {
    static const float round[] = {0, 1, -1, 0.5f, 2};
    float v[4];
    for (int i = 0; i < 4; i++)
        v[i] = random_below(seed, 3) == 0 ? round[random_below(seed, COUNT_OF(round))]
                                          : scale * (2 * random_float(seed) - 1);
    return field_constant(build_memory(), components, v);
}

static inline field *random_leaf(uint32_t *seed, int components) {
    if (random_below(seed, 3) == 0) return random_number(seed, components, 3);
    field *p = make("position", NULL);
    const char *const parts[] = {"x", "y", "z"};
    if (components == 3) return p;
    return need_field(field_swizzle(build_memory(), p, parts[random_below(seed, 3)]));
}

// A number that the argument takes and that does not vary in space.
static inline field *random_uniform(uint32_t *seed, const field_arg *arg) {
    float v[4];
    bool limited = arg->desc.min != 0 || arg->desc.max != 0;
    for (int i = 0; i < 4; i++) {
        float width = 0.5f + fabsf(arg->desc.value[i]);
        v[i] = arg->desc.value[i] + width * (2 * random_float(seed) - 1);
        if (random_below(seed, 3) == 0) v[i] = arg->desc.value[i];
        float least =
            arg->desc.min > 0 ? fmaxf(arg->desc.min, 0.2f * arg->desc.value[i]) : arg->desc.min;
        if (limited) v[i] = clampf(v[i], least, fminf(arg->desc.max, 8));
    }
    return field_constant(build_memory(), arg->desc.components, v);
}

static inline field *random_tree(uint32_t *seed, int depth, int components);

static inline field *random_kind(uint32_t *seed, const field_kind *kind, int depth,
                                 int components) {
    const field *args[FIELD_MAX_ARGS] = {NULL};
    uint8_t options[FIELD_MAX_OPTIONS] = {0};
    int any = kind->components == 0 ? components : random_below(seed, 2) ? 1 : 3;
    for (size_t i = 0; i < FIELD_MAX_ARGS && kind->args[i].desc.name; i++) {
        const field_arg *arg = &kind->args[i];
        if (arg->uniform) {
            args[i] = random_uniform(seed, arg);
            continue;
        }
        int width = arg->desc.components ? arg->desc.components : any;
        if (i > 0 && random_below(seed, 4) == 0) width = 1;
        args[i] = random_below(seed, 3) == 0 ? random_leaf(seed, width)
                                             : random_tree(seed, depth - 1, width);
    }
    for (size_t i = 0; i < FIELD_MAX_OPTIONS && kind->options[i].name; i++) {
        uint32_t words = 0;
        while (words < 6 && kind->options[i].words[words]) words++;
        options[i] = (uint8_t)random_below(seed, words);
    }
    return field_make(build_memory(), kind->name, args, options);
}

// Of 1 or 3 components.
static inline field *random_tree(uint32_t *seed, int depth, int components) {
    uint32_t count = 0;
    while (field_kinds[count].name) count++;
    for (int tries = 0; depth > 0 && tries < 40; tries++) {
        const field_kind *kind = &field_kinds[KIND_WARP + random_below(seed, count - KIND_WARP)];
        if (kind->components != 0 && kind->components != components) continue;
        field *made = random_kind(seed, kind, depth, components);
        if (made && made->components == components) return made;
        err_clear();
    }
    return random_leaf(seed, components);
}
