// Kinds that building, evaluation, bounds and the generator treat as cases of their own, by their
// place in field_kinds; and the functions that the table's rows name.
#pragma once
#include "field/field.h"
#include "field/range.h"

enum {
    KIND_CONSTANT,
    KIND_PARAM,
    KIND_CURVE,
    KIND_CALL,
    KIND_TIME,
    KIND_GRID,
    KIND_PALETTE,
    KIND_GLSL,
    KIND_SWIZZLE,
    KIND_WARP,
    KIND_TRANSFORM,
    KIND_ADVECT,
    KIND_POSITION,
    KIND_ADD,
    KIND_SUB,
    KIND_MUL,
    KIND_NEGATE,
    KIND_SPECIAL_COUNT
};

static inline int kind_of(const field *node) {
    return (int)(node->kind - field_kinds);
}

typedef void kind_eval(const field_point *at, const float (*args)[4], float out[4]);
typedef box3 kind_bounds(const field *node, const field_context *context, const box3 *args);

kind_eval eval_constant, eval_palette, eval_swizzle, eval_position, eval_add, eval_sub, eval_mul,
    eval_negate, eval_div, eval_min, eval_max, eval_mix, eval_clamp, eval_remap, eval_smoothstep,
    eval_step, eval_pow, eval_abs, eval_sqrt, eval_exp, eval_sin, eval_floor, eval_fract,
    eval_length, eval_dot, eval_atan, eval_vec, eval_zero, eval_instance_state,
    eval_instance_random, eval_instance_index, eval_instance_glow;
kind_eval eval_sphere, eval_box, eval_capsule, eval_torus, eval_disc;
kind_eval eval_blast_pressure, eval_blast_velocity, eval_blast_impulse, eval_blast_arrival;
kind_eval eval_perlin, eval_simplex, eval_value, eval_worley, eval_curl;

kind_ranges ranges_grid, ranges_palette, ranges_unknown, ranges_swizzle, ranges_position,
    ranges_add, ranges_sub, ranges_mul, ranges_negate, ranges_div, ranges_min, ranges_max,
    ranges_mix, ranges_clamp, ranges_remap, ranges_smoothstep, ranges_step, ranges_pow, ranges_abs,
    ranges_sqrt, ranges_exp, ranges_sin, ranges_floor, ranges_fract, ranges_length, ranges_dot,
    ranges_atan, ranges_vec, ranges_share, ranges_way;
kind_ranges ranges_sphere, ranges_box, ranges_capsule, ranges_torus, ranges_disc;
kind_ranges ranges_blast_pressure, ranges_blast_velocity, ranges_blast_impulse,
    ranges_blast_arrival;
kind_ranges ranges_perlin, ranges_simplex, ranges_value, ranges_worley, ranges_curl;

kind_bounds bounds_mul, bounds_div, bounds_mix, bounds_min, bounds_dot, bounds_warp,
    bounds_transform, bounds_sphere, bounds_box, bounds_capsule, bounds_torus, bounds_disc;

// What a node "advect" stands for, made of other kinds (advect.c). NULL with a message.
field *field_advect(arena *memory, const field *node);
// The same node with other arguments of the same widths. NULL with a message: nested too deeply.
field *field_with_args(arena *memory, const field *node, const field *const *args);

// Whether "by" of a "warp" is a field minus the position. Then p + amount * by is a mix of p and
// the field, whose range is narrower than that of the sum.
bool kind_is_displacement(const field *by);

// Components an argument's value is widened to before the kind computes with it.
int kind_arg_width(const field *node, size_t arg);
size_t kind_arg_count(const field *node);

// Value of an argument that does not vary in space; false when it does, or a Lua function failed.
bool kind_uniform_arg(const field *node, size_t arg, const field_context *context, float out[4]);

// Rows of the 3x4 matrix that takes a point to where a "transform" samples its field; and the
// matrix back.
void kind_transform_matrix(const float translate[4], const float rotate[4], const float scale[4],
                           float rows[3][4], float back[3][4]);
