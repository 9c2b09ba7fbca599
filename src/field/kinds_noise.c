// Evaluators of the noise kinds: from a row's arguments and options to a noise_desc.
#include "field/kinds.h"
#include "field/noise.h"
#include <math.h>

static noise_desc describe(const float (*args)[4]) { // what all rows begin with
    return (noise_desc){
        .frequency = args[0][0],
        .octaves = args[1][0],
        .persistence = args[2][0],
        .lacunarity = args[3][0],
        .seed = args[4][0],
        .amplitude = args[5][0],
        .drift = {args[6][0], args[6][1], args[6][2]},
        .phase = args[7][0] + args[8][0],
    };
}

static noise_desc describe_scalar(const field *node, const float (*args)[4]) {
    noise_desc desc = describe(args);
    desc.fractal = (noise_fractal)node->options[0];
    desc.four = node->options[1] == 1;
    return desc;
}

void eval_perlin(const field *node, const field_context *context, float3 p, const float (*args)[4],
                 float out[4]) {
    (void)context;
    noise_desc desc = describe_scalar(node, args);
    desc.period = args[9][0];
    out[0] = noise_eval(NOISE_PERLIN, &desc, p);
}

void eval_value(const field *node, const field_context *context, float3 p, const float (*args)[4],
                float out[4]) {
    (void)context;
    noise_desc desc = describe_scalar(node, args);
    desc.period = args[9][0];
    out[0] = noise_eval(NOISE_VALUE, &desc, p);
}

void eval_simplex(const field *node, const field_context *context, float3 p, const float (*args)[4],
                  float out[4]) {
    (void)context;
    noise_desc desc = describe_scalar(node, args);
    float period = args[9][0]; // its lattice repeats after multiples of three
    desc.period = period >= 0.5f ? 3 * fmaxf(floorf(period / 3 + 0.5f), 1) : 0;
    out[0] = noise_eval(NOISE_SIMPLEX, &desc, p);
}

void eval_worley(const field *node, const field_context *context, float3 p, const float (*args)[4],
                 float out[4]) {
    (void)context;
    noise_desc desc = describe_scalar(node, args);
    desc.period = args[9][0];
    desc.power = args[10][0];
    desc.distance = (noise_distance)node->options[2];
    desc.paper = node->options[3] == 1;
    out[0] = noise_eval(NOISE_WORLEY, &desc, p);
}

void eval_curl(const field *node, const field_context *context, float3 p, const float (*args)[4],
               float out[4]) {
    (void)context;
    noise_desc desc = describe(args);
    desc.period = args[9][0];
    desc.delta = args[10][0];
    desc.paper = node->options[0] == 1;
    desc.four = node->options[1] == 1;
    noise_curl(&desc, p, out);
}
