// Values of a field on the host, each rounded a little wrong: another device may round like that.
// What it gives may differ from the host's only as far as such values do (Monte Carlo arithmetic:
// Parker 1997).
#pragma once
#include "field_random.h"

#include "base/map.h"

// Of each value that a part of a field takes, and of each coordinate of a point it is moved to.
// Devices have sines with an error of some 2^-21 near 0, and products that are not rounded.
#define DISTURBED_RELATIVE 4e-6f
#define DISTURBED_ABSOLUTE 1e-6f
// Of a palette's colours: a sampler may filter texels of halves in halves, with weights of 8 bits.
#define DISTURBED_COLOR 6e-4f

typedef struct disturbed {
    const field_context *context;
    float scale; // of the disturbance; 0: none
    uint32_t seed;
    map places; // (part, point) -> index of its value
    float (*values)[4];
    size_t count, capacity;
    uint32_t points;
    bool numbers; // all values so far are finite
} disturbed;

static inline float disturbed_number(disturbed *d, float v) {
    if (!isfinite(v)) d->numbers = false;
    float by = d->scale * (2 * random_float(&d->seed) - 1);
    return v + by * (DISTURBED_RELATIVE * fabsf(v) + DISTURBED_ABSOLUTE);
}

static inline bool disturbed_part(disturbed *d, const field *node, float3 p, uint32_t point,
                                  float out[4]);

static inline bool disturbed_moved(disturbed *d, const field *node, float3 p,
                                   const float (*args)[4], float out[4]) {
    float3 at;
    if (kind_of(node) == KIND_WARP) {
        at = (float3){p.x + args[2][0] * args[1][0], p.y + args[2][0] * args[1][1],
                      p.z + args[2][0] * args[1][2]};
    } else {
        float m[3][4], back[3][4];
        kind_transform_matrix(args[1], args[2], args[3], m, back);
        at.x = m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3];
        at.y = m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3];
        at.z = m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3];
    }
    at = (float3){disturbed_number(d, at.x), disturbed_number(d, at.y), disturbed_number(d, at.z)};
    return disturbed_part(d, node->args[0], at, ++d->points, out);
}

static inline bool disturbed_now(disturbed *d, const field *node, float3 p, uint32_t point,
                                 float out[4]) {
    int kind = kind_of(node);
    bool moves = kind == KIND_WARP || kind == KIND_TRANSFORM;
    float args[FIELD_MAX_ARGS][4] = {{0}};
    if (!node->args[0]) return field_eval(node, d->context, p, out);
    for (size_t i = moves; i < FIELD_MAX_ARGS && node->args[i]; i++) {
        const field *arg = node->args[i];
        if (!disturbed_part(d, arg, p, point, args[i])) return false;
        for (int c = 0; c < arg->components; c++)
            args[i][c] = arg->uniform ? args[i][c] : disturbed_number(d, args[i][c]);
        for (int c = 1; arg->components == 1 && c < 4; c++) args[i][c] = args[i][0];
    }
    if (moves) return disturbed_moved(d, node, p, (const float(*)[4])args, out);
    node->kind->eval(&(field_point){node, d->context, p}, (const float(*)[4])args, out);
    for (int c = 0; kind == KIND_PALETTE && c < 4; c++)
        out[c] *= 1 + d->scale * (2 * random_float(&d->seed) - 1) * DISTURBED_COLOR;
    return true;
}

// Shared parts are evaluated once at a point, and disturbed anew for each use.
static inline bool disturbed_part(disturbed *d, const field *node, float3 p, uint32_t point,
                                  float out[4]) {
    memset(out, 0, 4 * sizeof *out);
    const uint32_t *place = map_find(&d->places, node, point);
    if (place) {
        memcpy(out, d->values[*place], 4 * sizeof *out);
        return true;
    }
    if (!disturbed_now(d, node, p, point, out)) return false;
    MEM_RESERVE(d->values, d->count + 1, d->capacity);
    memcpy(d->values[d->count], out, 4 * sizeof *out);
    map_set(&d->places, node, point, (uint32_t)d->count++);
    return true;
}

// As field_eval, with each value off by up to `scale` times what a device may round wrong.
// `numbers`: whether all values on the way are finite.
static inline bool field_eval_disturbed(const field *node, const field_context *context, float3 p,
                                        float scale, uint32_t *seed, float out[4], bool *numbers) {
    disturbed d = {.context = context, .scale = scale, .seed = *seed, .numbers = true};
    bool ok = disturbed_part(&d, node, p, 0, out);
    for (int c = 0; ok && c < node->components; c++) out[c] = disturbed_number(&d, out[c]);
    *seed = d.seed;
    *numbers = d.numbers;
    map_free(&d.places);
    mem_free(d.values);
    return ok;
}
