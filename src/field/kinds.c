// The table of kinds. Rows that other files treat as cases of their own come first, in the order of
// the enumeration in kinds.h.
#include "field/kinds.h"

// An argument; one that must not vary in space; one of these that is given per second.
#define ARG(...)                                                                                   \
    {                                                                                              \
        .desc = { __VA_ARGS__ }                                                                    \
    }
#define STILL(...)                                                                                 \
    { .desc = {__VA_ARGS__}, .uniform = true }
#define RATE(...)                                                                                  \
    { .desc = {__VA_ARGS__}, .uniform = true, .rate = true }
#define ANY .components = 0, .required = true, .unit = ""
#define SAME .components = 0, .unit = ""
#define SCALAR(UNIT) .components = 1, .unit = UNIT
#define VECTOR(UNIT) .components = 3, .unit = UNIT

#define RANGE(NAME) .ranges = ranges_##NAME, .range_function = "range_" #NAME

#define BUILTIN(NAME) .group = "operator", .function = NAME, .cost = 1
#define LIBRARY(NAME)                                                                              \
    .group = "operator", .include = "lib/operator.glsl", .function = NAME, .cost = 4
#define SHAPE(NAME)                                                                                \
    .group = "shape", .components = 1, .include = "lib/shape.glsl", .function = NAME,              \
    .spatial = true, .cost = 12
#define BLAST(NAME, COMPONENTS)                                                                    \
    .group = "blast", .components = COMPONENTS, .include = "lib/blast.glsl", .function = NAME,     \
    .spatial = true, .cost = 200
#define NOISE(NAME) .group = "noise", .include = "lib/noise.glsl", .function = NAME, .spatial = true
#define PARTICLE(NAME, COMPONENTS)                                                                 \
    .group = "source", .include = "lib/particle.glsl", .function = "particle_said_" NAME,          \
    .components = COMPONENTS, .spatial = true, .cost = 1, .eval = eval_zero,                       \
    .ranges = ranges_unknown, .range_function = "range_nowhere" #COMPONENTS
#define ranges_nowhere ranges_unknown
#define SHELL(NAME, COMPONENTS, RANGES)                                                            \
    .group = "source", .include = "lib/shell.glsl", .function = "shell_said_" NAME,                \
    .components = COMPONENTS, .spatial = true, .cost = 1, .eval = eval_zero,                       \
    .ranges = ranges_##RANGES, .range_function = "range_" #RANGES #COMPONENTS
#define POINT_LIGHT(NAME)                                                                          \
    .group = "source", .include = "lib/point_light.glsl", .function = "point_light_current_" NAME, \
    .components = 1, .spatial = true, .cost = 1, .eval = eval_zero, .ranges = ranges_unknown,      \
    .range_function = "range_nowhere1"

#define INSTANCE(NAME, EVAL, COMPONENTS)                                                           \
    .group = "source", .include = "lib/instance.glsl", .function = "instance_said_" NAME,          \
    .components = COMPONENTS, .spatial = true, .cost = 1, .eval = eval_instance_##EVAL,            \
    .ranges = ranges_unknown, .range_function = "range_nowhere" #COMPONENTS

#define UNARY                                                                                      \
    { ARG("value", ANY, .help = "what it works on") }
#define BINARY                                                                                     \
    { ARG("a", ANY, .help = "first"), ARG("b", ANY, .help = "second") }

// clang-format off
#define BLAST_PLACE ARG("position", VECTOR("m"), .help = "where it bursts")
#define BLAST_AGE ARG("age", SCALAR("s"), .help = "since it burst; below 0: it has not")
#define BLAST_CHARGE                                                                               \
    ARG("charge", SCALAR("kg"), .value = {1}, .min = 1e-6f, .max = 1e12f,                          \
        .help = "TNT that is as strong, in free air; on the ground a burst is as one of 1.8 times the charge")
#define OCTAVE_ARGS(OCTAVES)                                                                       \
    STILL("frequency", SCALAR("1/m"), .value = {1}, .min = 1e-6f, .max = 1e6f,                     \
          .help = "lattice cells a metre, of the first octave"),                                   \
    STILL("octaves", SCALAR(""), .value = {OCTAVES}, .min = 1, .max = 12,                          \
          .help = "layers of rising frequency, exactly so many"),                                  \
    STILL("persistence", SCALAR(""), .value = {0.5f}, .min = 0, .max = 1,                          \
          .help = "weight of an octave relative to the one before (gain)"),                        \
    STILL("lacunarity", SCALAR(""), .value = {2}, .min = 1, .max = 8,                              \
          .help = "frequency of an octave relative to the one before"),                            \
    STILL("seed", SCALAR(""), .min = 0, .max = 16777215,                                           \
          .help = "whole number; another one gives another pattern")
#define MOTION_ARGS                                                                                \
    RATE("drift", VECTOR("m/s"), .help = "the noise is taken at p + drift * time"),                \
    RATE("speed", SCALAR("1/s"), .help = "rate of the fourth coordinate, in cells: the pattern "   \
                                         "boils; giving it chooses dimensions = 4"),               \
    STILL("w", SCALAR("cells"),                                                                    \
          .help = "added to the fourth coordinate; giving it chooses dimensions = 4")
#define AMPLITUDE_ARG ARG("amplitude", SCALAR(""), .value = {1}, .help = "factor of the result")
#define PERIOD_ARG                                                                                 \
    STILL("period", SCALAR("cells"), .min = 0, .max = 65536,                                       \
          .help = "repeats after so many cells of the first octave, in every dimension; 0: never")
// clang-format on
#define FRACTAL_OPTION                                                                             \
    {                                                                                              \
        "fractal", {"fbm", "ridged", "billow"},                                                    \
            "fbm: mean of octaves; ridged, billow: folded at the middle"                           \
    }
#define DIMENSIONS_OPTION                                                                          \
    { "dimensions", {"3", "4"}, "4: the fourth coordinate is time * speed + w" }
#define LATTICE_NOISE(NAME, COST)                                                                  \
    NOISE(NAME), .components = 1, .cost = COST,                                                    \
                 .args = {OCTAVE_ARGS(3), AMPLITUDE_ARG, MOTION_ARGS, PERIOD_ARG},                 \
                 .options = {FRACTAL_OPTION, DIMENSIONS_OPTION}

// clang-format off
const field_kind field_kinds[] = {
    // ---- values
    [KIND_CONSTANT] = {"constant", .group = "value", .summary = "a number, vector or colour",
        .eval = eval_constant},
    [KIND_PARAM] = {"param", .group = "value", .summary = "a declared parameter of the effect"},
    [KIND_CURVE] = {"curve", .group = "value", .summary = "keys over time"},
    [KIND_CALL] = {"call", .group = "value", .summary = "a Lua function of the time"},
    [KIND_TIME] = {"time", .group = "value", .summary = "seconds since the effect began",
        .components = 1},

    // ---- sources
    [KIND_GRID] = {"grid", .group = "source", .spatial = true, .cost = 30, .ranges = ranges_grid,
        .summary = "a channel of a sequence, bake or solver; 0 outside its box"},
    [KIND_PALETTE] = {"palette", .group = "source", .components = 4, .cost = 20,
        .summary = "colour and alpha of a palette at a number",
        .args = {ARG("at", SCALAR(""), .required = true, .help = "position, in the palette's range")},
        .eval = eval_palette, .ranges = ranges_palette},
    [KIND_GLSL] = {"glsl", .group = "source", .spatial = true, .cost = 50, .ranges = ranges_unknown,
        .summary = "a user's GLSL function of the point"},

    // ---- operators
    [KIND_SWIZZLE] = {"swizzle", .group = "operator",
        .summary = "some components of a vector or colour, in any order", .eval = eval_swizzle, .ranges = ranges_swizzle},
    [KIND_WARP] = {"warp", .group = "operator",
        .summary = "takes a field at p + amount * by(p)",
        .args = {ARG("value", ANY, .help = "the field to bend"),
                 ARG("by", VECTOR(""), .required = true, .help = "offset"),
                 ARG("amount", SCALAR(""), .value = {1}, .help = "factor of the offset")},
        .bounds = bounds_warp},
    [KIND_TRANSFORM] = {"transform", .group = "operator",
        .summary = "scales, then rotates (about X, then Y, then Z), then moves a field",
        .args = {ARG("value", ANY, .help = "the field to place"),
                 STILL("translate", VECTOR("m"), .help = "where its origin goes"),
                 STILL("rotate", VECTOR("degrees"), .help = "Euler angles"),
                 STILL("scale", VECTOR(""), .value = {1, 1, 1}, .min = 1e-6f, .max = 1e6f,
                  .help = "factor of its size")},
        .bounds = bounds_transform},
    [KIND_ADVECT] = {"advect", .group = "operator",
        .summary = "noise that a flow carries: blends patterns that are made anew before it tears "
                   "them apart, at full contrast (Max and Becker 1995, Neyret 2003). Shape its "
                   "result, not its value; it may leave the value's range a little",
        .args = {ARG("value", ANY, .help = "what is carried; its noises get other seeds again and again"),
                 ARG("velocity", VECTOR("m/s"), .required = true, .help = "of the flow"),
                 STILL("period", SCALAR("s"), .value = {1}, .min = 1e-3f, .max = 1e6f,
                  .help = "how long a pattern is carried: longer follows the flow longer, shorter "
                          "is torn less"),
                 ARG("mean", SAME, .value = {0.5f}, .help = "what the value varies around")},
        .options = {{"phases", {"2", "3"}, "patterns at a time; 3 is dearer and steadier"},
                    {"path", {"straight", "curved"},
                     "along which the past is sought; curved asks for the velocity twice"}}},
    [KIND_POSITION] = {"position", .group = "operator", .components = 3, .spatial = true,
        .summary = "the point itself, in metres", .eval = eval_position, .ranges = ranges_position},
    [KIND_ADD] = {"add", .group = "operator", .cost = 1, .summary = "a + b", .args = BINARY,
        .eval = eval_add, RANGE(add)},
    [KIND_SUB] = {"sub", .group = "operator", .cost = 1, .summary = "a - b", .args = BINARY,
        .eval = eval_sub, RANGE(sub)},
    [KIND_MUL] = {"mul", .group = "operator", .cost = 1, .args = BINARY,
        .summary = "a * b; dear factors are only computed where the cheap ones are not zero",
        .eval = eval_mul, RANGE(mul), .bounds = bounds_mul},
    [KIND_NEGATE] = {"negate", .group = "operator", .cost = 1, .summary = "-value", .args = UNARY,
        .eval = eval_negate, RANGE(negate)},
    {"div", LIBRARY("operator_div"), .summary = "a / b; 0 where b is 0", .args = BINARY,
        .eval = eval_div, RANGE(div), .bounds = bounds_div},
    {"min", BUILTIN("min"), .summary = "the smaller", .args = BINARY, .eval = eval_min, RANGE(min),
        .bounds = bounds_min},
    {"max", BUILTIN("max"), .summary = "the greater", .args = BINARY, .eval = eval_max, RANGE(max)},
    {"mix", BUILTIN("mix"), .summary = "a + (b - a) * t",
        .args = {ARG("a", ANY, .help = "result at t = 0"), ARG("b", ANY, .help = "result at t = 1"),
                 ARG("t", SAME, .value = {0.5f}, .help = "share of b")},
        .eval = eval_mix, RANGE(mix), .bounds = bounds_mix},
    {"clamp", BUILTIN("clamp"), .summary = "limits a value to a range",
        .args = {ARG("value", ANY, .help = "what it limits"),
                 ARG("low", SAME, .help = "least result"),
                 ARG("high", SAME, .value = {1}, .help = "greatest result")},
        .eval = eval_clamp, RANGE(clamp)},
    {"remap", LIBRARY("operator_remap"), .summary = "one range to another, linearly, unlimited",
        .args = {ARG("value", ANY, .help = "what it maps"),
                 ARG("in_min", SAME, .help = "becomes out_min"),
                 ARG("in_max", SAME, .value = {1}, .help = "becomes out_max"),
                 ARG("out_min", SAME, .help = "result at in_min"),
                 ARG("out_max", SAME, .value = {1}, .help = "result at in_max")},
        .eval = eval_remap, RANGE(remap)},
    {"smoothstep", LIBRARY("operator_smoothstep"),
        .summary = "0 up to low, 1 from high, t * t * (3 - 2 * t) between. The method takes the "
                   "arguments in this order, f:smoothstep(low, high); the function in GLSL's, "
                   "smoothstep(low, high, value)",
        .args = {ARG("value", ANY, .help = "what it maps"),
                 ARG("low", SAME, .help = "end of 0"),
                 ARG("high", SAME, .value = {1}, .help = "start of 1")},
        .eval = eval_smoothstep, RANGE(smoothstep)},
    {"step", LIBRARY("operator_step"), .summary = "1 from the edge on, 0 below. The method takes the arguments in this order, "
                   "f:step(edge); the function in GLSL's, step(edge, value)",
        .args = {ARG("value", ANY, .help = "what it tests"),
                 ARG("edge", SAME, .value = {0.5f}, .help = "least value that gives 1")},
        .eval = eval_step, RANGE(step)},
    {"pow", LIBRARY("operator_pow"), .summary = "a ^ b; 0 where a is negative", .args = BINARY,
        .eval = eval_pow, RANGE(pow)},
    {"abs", BUILTIN("abs"), .summary = "without its sign", .args = UNARY, .eval = eval_abs, RANGE(abs)},
    {"sqrt", LIBRARY("operator_sqrt"), .summary = "square root; 0 of negative values",
        .args = UNARY, .eval = eval_sqrt, RANGE(sqrt)},
    {"exp", LIBRARY("operator_exp"), .summary = "e ^ value; values above 80 count as 80",
        .args = UNARY, .eval = eval_exp, RANGE(exp)},
    {"sin", BUILTIN("sin"), .summary = "sine of radians", .args = UNARY, .eval = eval_sin, RANGE(sin)},
    {"floor", BUILTIN("floor"), .summary = "the whole number below", .args = UNARY,
        .eval = eval_floor, RANGE(floor)},
    {"fract", BUILTIN("fract"), .summary = "what is left above the whole number below, 0..1",
        .args = UNARY, .eval = eval_fract, RANGE(fract)},
    {"length", BUILTIN("length"), .components = 1, .summary = "length of a vector", .args = UNARY,
        .eval = eval_length, RANGE(length)},
    {"dot", BUILTIN("dot"), .components = 1, .summary = "scalar product", .args = BINARY,
        .eval = eval_dot, RANGE(dot), .bounds = bounds_dot},
    {"atan", LIBRARY("operator_atan"), .components = 1,
        .summary = "angle from the axis of x to the point (x, y), in radians, -pi to pi; 0 where both are 0. "
                   "In GLSL's order: atan(y, x)",
        .args = {ARG("y", SCALAR(""), .required = true, .help = "of the point"), ARG("x", SCALAR(""), .value = {1}, .help = "of the point")},
        .eval = eval_atan, RANGE(atan)},
    {"vec", BUILTIN("vec3"), .components = 3, .summary = "a vector of three numbers",
        .args = {ARG("x", SCALAR(""), .help = "first"), ARG("y", SCALAR(""), .help = "second"),
                 ARG("z", SCALAR(""), .help = "third")},
        .eval = eval_vec, RANGE(vec)},

    // ---- shapes
    {"sphere", SHAPE("shape_sphere"), .summary = "a ball; 0 outside, 1 from `falloff` below the surface",
        .args = {ARG("position", VECTOR("m"), .help = "centre"),
                 ARG("radius", SCALAR("m"), .value = {1}, .min = 0, .max = 1e6f, .help = "to the surface"),
                 ARG("falloff", SCALAR("m"), .min = 0, .max = 1e6f, .help = "depth at which it is 1; 0: a hard edge")},
        .eval = eval_sphere, RANGE(sphere), .bounds = bounds_sphere},
    {"box", SHAPE("shape_box"), .summary = "a box along the axes; 0 outside, 1 from `falloff` below the surface",
        .args = {ARG("position", VECTOR("m"), .help = "centre"),
                 ARG("size", VECTOR("m"), .value = {1, 1, 1}, .min = 0, .max = 1e6f, .help = "edge lengths"),
                 ARG("falloff", SCALAR("m"), .min = 0, .max = 1e6f, .help = "depth at which it is 1; 0: a hard edge")},
        .eval = eval_box, RANGE(box), .bounds = bounds_box},
    {"capsule", SHAPE("shape_capsule"), .summary = "a line with round ends; 0 outside, 1 from `falloff` below the surface",
        .args = {ARG("from", VECTOR("m"), .help = "centre of one end"),
                 ARG("to", VECTOR("m"), .value = {0, 0, 1}, .help = "centre of the other end"),
                 ARG("radius", SCALAR("m"), .value = {0.5f}, .min = 0, .max = 1e6f, .help = "around the line"),
                 ARG("falloff", SCALAR("m"), .min = 0, .max = 1e6f, .help = "depth at which it is 1; 0: a hard edge")},
        .eval = eval_capsule, RANGE(capsule), .bounds = bounds_capsule},
    {"torus", SHAPE("shape_torus"), .summary = "a ring about Z; 0 outside, 1 from `falloff` below the surface",
        .args = {ARG("position", VECTOR("m"), .help = "centre"),
                 ARG("radius", SCALAR("m"), .value = {1}, .min = 0, .max = 1e6f, .help = "from the centre to the middle of the tube"),
                 ARG("thickness", SCALAR("m"), .value = {0.25f}, .min = 0, .max = 1e6f, .help = "radius of the tube"),
                 ARG("falloff", SCALAR("m"), .min = 0, .max = 1e6f, .help = "depth at which it is 1; 0: a hard edge")},
        .eval = eval_torus, RANGE(torus), .bounds = bounds_torus},
    {"disc", SHAPE("shape_disc"), .summary = "a disc in X and Y, the same at every Z: for slices; 0 outside, 1 from `falloff` below the edge",
        .args = {ARG("x", SCALAR(""), .value = {0.5f}, .help = "centre"), ARG("y", SCALAR(""), .value = {0.5f}, .help = "centre"),
                 ARG("radius", SCALAR(""), .value = {0.1f}, .min = 0, .max = 1e6f, .help = "to the edge"),
                 ARG("falloff", SCALAR(""), .min = 0, .max = 1e6f, .help = "depth at which it is 1; 0: a hard edge")},
        .eval = eval_disc, RANGE(disc), .bounds = bounds_disc},

    // ---- bursts
    {"blast_pressure", BLAST("blast_pressure", 1),
        .summary = "what a burst of TNT adds to the pressure of free air (Pa): a front, then a pulse that ends in suction. "
                   "Of the front and its impulse, Kinney and Graham 1985; of the pulse, Friedlander 1946",
        .args = {BLAST_PLACE, BLAST_AGE, BLAST_CHARGE}, .eval = eval_blast_pressure, RANGE(blast_pressure)},
    {"blast_velocity", BLAST("blast_velocity", 3),
        .summary = "how fast the air moves behind the front of such a burst (m/s), outwards and then back: by Rankine and Hugoniot "
                   "from its pressure",
        .args = {BLAST_PLACE, BLAST_AGE, BLAST_CHARGE}, .eval = eval_blast_velocity, RANGE(blast_velocity)},
    {"blast_impulse", BLAST("blast_impulse", 1),
        .summary = "overpressure of such a burst added up until it becomes suction (Pa s): what is thrown goes at that times its "
                   "area by its mass",
        .args = {BLAST_PLACE, BLAST_CHARGE}, .eval = eval_blast_impulse, RANGE(blast_impulse)},
    {"blast_arrival", BLAST("blast_arrival", 1), .summary = "how long after such a burst its front arrives (s)",
        .args = {BLAST_PLACE, BLAST_CHARGE}, .eval = eval_blast_arrival, RANGE(blast_arrival)},

    // ---- noise; arguments and options in the order of the GLSL functions
    {"perlin", LATTICE_NOISE("noise_perlin", 200), .eval = eval_perlin, RANGE(perlin),
        .summary = "gradient noise, 0..1, mean 0.5 (Perlin 2002; an integer hash instead of his table)"},
    {"value", LATTICE_NOISE("noise_value", 120), .eval = eval_value, RANGE(value),
        .summary = "smoothly joined random values, 0..1, mean 0.5"},
    {"simplex", LATTICE_NOISE("noise_simplex", 180), .eval = eval_simplex, RANGE(simplex),
        .summary = "gradient noise on simplices, 0..1, mean 0.5; a period becomes a multiple of 3 (Perlin 2001, Gustavson 2005)"},
    {"worley", NOISE("noise_worley"), .components = 1, .cost = 500,
        .args = {OCTAVE_ARGS(1), AMPLITUDE_ARG, MOTION_ARGS, PERIOD_ARG,
                 STILL("power", SCALAR(""), .value = {1}, .min = 0.01f, .max = 16,
                  .help = "exponent of the distance: below 1 softer, above 1 sharper")},
        .options = {FRACTAL_OPTION, DIMENSIONS_OPTION,
                    {"distance", {"f1", "f2", "f2_f1"}, "to the nearest feature point, the second, or their difference"},
                    {"mode", {"default", "paper"}, "paper: the fract hash of Raseta et al., section 3.7.2"}},
        .eval = eval_worley, RANGE(worley),
        .summary = "cells, 0..1, high near feature points: 1 - distance^power, for f2_f1 distance^power (Worley 1996)"},
    {"curl", NOISE("noise_curl"), .components = 3, .cost = 300,
        .args = {OCTAVE_ARGS(1),
                 ARG("amount", SCALAR(""), .value = {1}, .help = "factor of the result"), MOTION_ARGS, PERIOD_ARG,
                 STILL("step", SCALAR("m"), .value = {0.01f}, .min = 1e-6f, .max = 1e3f,
                  .help = "half distance of the paper's differences")},
        .options = {{"mode", {"default", "paper"},
                     "default: exact curl, free of divergence; paper: its differences of one scalar, section 3.7.3"},
                    DIMENSIONS_OPTION},
        .eval = eval_curl, RANGE(curl),
        .summary = "swirling vectors: the curl of three Perlin noises, a unit of length a cell (Bridson 2007)"},

    // ---- of the particle that a field is evaluated for; where there is none, 0
    {"particle_age", PARTICLE("age", 1), .summary = "part of a particle's life that has passed, 0..1"},
    {"particle_quantity", PARTICLE("quantity", 1), .summary = "the number that a particle carries (`quantity` of particles)"},
    {"particle_random", PARTICLE("random", 1), .summary = "a number of a particle's own, evenly spread over 0..1"},
    {"particle_velocity", PARTICLE("velocity", 3), .summary = "of a particle (m/s)"},

    // ---- of the one of `instances` that a field is evaluated for; where there is none, 0
    {"instance_state", INSTANCE("state", state, 4), .summary = "four numbers of an instance, which the script sets: instance_state.x"},
    {"instance_random", INSTANCE("random", random, 1), .summary = "a number of an instance's own, evenly spread over 0..1"},
    {"instance_index", INSTANCE("index", index, 1), .summary = "number of an instance among those of its object, from 0 on"},
    {"instance_glow", INSTANCE("glow", glow, 1), .summary = "factor of what an instance emits"},

    // ---- of the light of `point_lights` that a field is evaluated for; where there is none, 0
    {"light_index", POINT_LIGHT("index"), .summary = "number of a light of point_lights, from 0 on"},
    {"light_random", POINT_LIGHT("random"), .summary = "a number of a light's own, evenly spread over 0..1"},

    // ---- of the shell, and its point, that a field is evaluated for; where there is none, 0
    {"shell_age", SHELL("age", 1, share), .summary = "part of a shell's life that has passed, 0..1"},
    {"shell_random", SHELL("random", 1, share), .summary = "a number of a shell's own, evenly spread over 0..1"},
    {"shell_shift", SHELL("shift", 3, share), .summary = "three more of these, by which noise is moved so that no two shells look alike"},
    {"shell_depth", SHELL("depth", 1, nowhere), .summary = "what the field `shell_depth` of a shell gave for it"},
    {"shell_displacement", SHELL("displacement", 1, nowhere), .summary = "how far the surface is pushed out, in radii"},
    {"shell_normal", SHELL("normal", 3, way), .summary = "of the surface of a shell, towards the eye, of length 1"},
    {"shell_view", SHELL("view", 3, way), .summary = "from the surface of a shell to the eye, of length 1"},
    {NULL},
};
// clang-format on
