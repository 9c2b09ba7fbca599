// Evaluators and ranges of the noise kinds: from a row's arguments and options to a noise_desc.
#include "field/kinds.h"
#include "field/noise.h"
#include <math.h>

enum { AMPLITUDE = 5 }; // argument

static noise_desc describe(const float (*args)[4]) { // what all rows begin with
    return (noise_desc){
        .frequency = args[0][0],
        .octaves = args[1][0],
        .persistence = args[2][0],
        .lacunarity = args[3][0],
        .seed = args[4][0],
        .amplitude = args[AMPLITUDE][0],
        .drift = {args[6][0], args[6][1], args[6][2]},
        .phase = args[7][0] + args[8][0],
        .period = args[9][0],
    };
}

static noise_desc describe_scalar(const field *node, const float (*args)[4]) {
    noise_desc desc = describe(args);
    desc.fractal = node->options[0];
    desc.four = node->options[1] == 1;
    return desc;
}

static noise_desc describe_simplex(const field *node, const float (*args)[4]) {
    noise_desc desc = describe_scalar(node, args); // its lattice repeats after multiples of three
    desc.period = desc.period >= 0.5f ? 3 * fmaxf(floorf(desc.period / 3 + 0.5f), 1) : 0;
    return desc;
}

static noise_desc describe_worley(const field *node, const float (*args)[4]) {
    noise_desc desc = describe_scalar(node, args);
    desc.power = args[10][0];
    desc.distance = node->options[2];
    desc.paper = node->options[3] == 1;
    return desc;
}

static noise_desc describe_curl(const field *node, const float (*args)[4]) {
    noise_desc desc = describe(args);
    desc.delta = args[10][0];
    desc.paper = node->options[0] == 1;
    desc.four = node->options[1] == 1;
    return desc;
}

// Arguments that do not vary in space: all but the amplitude.
static void numbers(const field *node, const intervals *args, float out[FIELD_MAX_ARGS][4]) {
    for (size_t i = 0; i < kind_arg_count(node); i++)
        for (int c = 0; c < 4; c++) out[i][c] = args[i].c[c].low;
}

#define SCALAR_NOISE(NAME, BASE, DESCRIBE)                                                         \
    void eval_##NAME(const field_point *at, const float(*args)[4], float out[4]) {                 \
        noise_desc desc = DESCRIBE(at->node, args);                                                \
        out[0] = noise_eval(BASE, &desc, at->p);                                                   \
    }                                                                                              \
    intervals ranges_##NAME(const field_box *in, const intervals *args) {                          \
        float values[FIELD_MAX_ARGS][4];                                                           \
        numbers(in->node, args, values);                                                           \
        noise_desc desc = DESCRIBE(in->node, (const float(*)[4])values);                           \
        return (intervals){{range_mul(args[AMPLITUDE].c[0], noise_range(BASE, &desc, in->at))}};   \
    }

SCALAR_NOISE(perlin, NOISE_PERLIN, describe_scalar)
SCALAR_NOISE(value, NOISE_VALUE, describe_scalar)
SCALAR_NOISE(simplex, NOISE_SIMPLEX, describe_simplex)
SCALAR_NOISE(worley, NOISE_WORLEY, describe_worley)

void eval_curl(const field_point *at, const float (*args)[4], float out[4]) {
    noise_desc desc = describe_curl(at->node, args);
    noise_curl(&desc, at->p, out);
}

intervals ranges_curl(const field_box *in, const intervals *args) {
    float values[FIELD_MAX_ARGS][4];
    numbers(in->node, args, values);
    noise_desc desc = describe_curl(in->node, (const float(*)[4])values);
    intervals out = noise_curl_ranges(&desc, in->at);
    for (int i = 0; i < 3; i++) out.c[i] = range_mul(args[AMPLITUDE].c[0], out.c[i]);
    return out;
}
