// Bodies that move: what they push. Ladd, "Numerical simulations of particulate suspensions via a
// discretized Boltzmann equation", part 1, 1994, eq. 3.6: what comes back from a wall has the
// momentum 2 w rho (c . v) / cs^2 more; so have scalars, since what a wall pushes moves as fast as
// it: the flux into the cells before it is what those that it covers lose, behind it the same is
// taken away that uncovered cells begin with. A scalar grows by the same part as the air does, also
// where a wall meets a link of the air that the scalar has not.
#ifndef SIM_LBM_BODIES_GLSL
#define SIM_LBM_BODIES_GLSL
#include "sim/lbm/cells.glsl"

ivec3 lbm_cell_at(uvec3 at, uint lane) {
    return ivec3(at.xy, at.z + LBM_LAYERS * lane);
}

#if LBM_BODIES
layout(std430) readonly buffer LbmIds { uint lbm_ids[]; }; // of cells, x fastest; 0: air

struct LbmBody { // a rigid motion
    vec4 centre;  // a point that moves with `linear`; w: 1 if the body moves at all
    vec4 linear;  // in a step
    vec4 angular; // radians in a step
};
layout(std430) readonly buffer LbmBodies { LbmBody lbm_bodies[]; }; // by id
uniform float lbm_body_speed; // greatest, in a step

bool lbm_body_moves(uint id) {
    return lbm_bodies[id].centre.w != 0.0;
}

bool lbm_is_inside(ivec3 cell) { // or beyond a face that leads round
    const ivec3 size = ivec3(LBM_NX, LBM_NY, LBM_NZ);
    const bvec3 round_ = bvec3(LBM_FACE_0 == 0, LBM_FACE_2 == 0, LBM_FACE_4 == 0);
    bvec3 inside = equal(uvec3(lessThan(uvec3(cell), uvec3(size))), uvec3(1u));
    return all(bvec3(uvec3(inside) | uvec3(round_)));
}

// Round where the lattice goes round; nothing stands beyond other faces.
uint lbm_id_at(ivec3 cell) {
    if (!lbm_is_inside(cell)) return 0u;
    cell = lbm_wrap(cell);
    return lbm_ids[uint(cell.x) + LBM_NX * (uint(cell.y) + LBM_NY * uint(cell.z))];
}

// The ids of three cells along x, the middle one `at`; `inside`: it has neighbours in its row, and the row is
// one of the lattice.
uvec3 lbm_three_ids(bool inside, ivec3 at) {
    const ivec3 x = ivec3(1, 0, 0);
    if (!inside) return uvec3(lbm_id_at(at - x), lbm_id_at(at), lbm_id_at(at + x));
    uint middle = uint(at.x) + LBM_NX * (uint(at.y) + LBM_NY * uint(at.z));
    return uvec3(lbm_ids[middle - 1u], lbm_ids[middle], lbm_ids[middle + 1u]);
}

uniform uint lbm_moved; // bodies came to lie in other cells just before this step

// The first step after a cell became solid, or air, what passes between it and others was sent by
// air, or filled as if it was: then walls push nothing, or mass would not be kept.
bool lbm_is_new(ivec3 cell) {
    uint lane, element = lbm_element_of(lbm_wrap(cell), lane);
    return (lbm_cells[element] >> 8u * lane & LBM_CELL_NEW) != 0u;
}

vec3 lbm_body_velocity(uint id, vec3 point) {
    LbmBody b = lbm_bodies[id];
    vec3 v = b.linear.xyz + cross(b.angular.xyz, point - b.centre.xyz);
    return v * min(1.0, lbm_body_speed * inversesqrt(max(dot(v, v), 1e-20)));
}

bool lbm_is_wall(ivec3 cell) { // of a face
    ivec3 at = lbm_wrap(cell);
    return LBM_FACE_IS_WALL(LBM_FACE_0) && at.x == 0 || LBM_FACE_IS_WALL(LBM_FACE_1) && at.x == LBM_NX - 1 ||
           LBM_FACE_IS_WALL(LBM_FACE_2) && at.y == 0 || LBM_FACE_IS_WALL(LBM_FACE_3) && at.y == LBM_NY - 1 ||
           LBM_FACE_IS_WALL(LBM_FACE_4) && at.z == 0 || LBM_FACE_IS_WALL(LBM_FACE_5) && at.z == LBM_NZ - 1;
}

// How fast the wall moves along a direction from which comes what arrives in a cell; 0: there is none.
// `id`: of the body there.
float lbm_wall_speed(ivec3 cell, ivec3 direction, uint id) {
    if (id == 0u || lbm_moved != 0u && lbm_is_new(cell - direction)) return 0.0;
    vec3 point = vec3(cell) + 0.5 - 0.5 * vec3(direction);
    return dot(vec3(direction), lbm_body_velocity(id, point));
}

#define LBM_DIRECTION(x, y, z) (13 + (x) + 3 * (y) + 9 * (z)) // of 27
// Of the cells of an element, in all directions; and as bits, in which of them a solid lies. Ids are loaded
// together; the rest is in a loop that is not unrolled: few cells come here, and processors that run all
// branches under a mask leave a loop when it is empty.
float lbm_wall_speeds[27 * LBM_LANES];
#if LBM_LANES == 2
uvec2 lbm_solids = uvec2(0u);
#else
uvec4 lbm_solids = uvec4(0u);
#endif

lbm_float lbm_wall_speeds_at(const int i) {
#if LBM_LANES == 2
    return vec2(lbm_wall_speeds[i], lbm_wall_speeds[i + 27]);
#else
    return vec4(lbm_wall_speeds[i], lbm_wall_speeds[i + 27], lbm_wall_speeds[i + 54], lbm_wall_speeds[i + 81]);
#endif
}

#define LBM_WALL_SPEEDS(x, y, z) lbm_wall_speeds_at(LBM_DIRECTION(x, y, z))
lbm_float lbm_pushed; // the part by which walls make more of the air of a cell

void lbm_find_walls(uvec3 at, uint near) {
    for (int i = 0; i < 27 * LBM_LANES; i++) lbm_wall_speeds[i] = 0.0;
    for (uint left = near; left != 0u; left &= left - 1u) {
        int k = findLSB(left);
        ivec3 cell = lbm_cell_at(at, uint(k));
        bool new_ = lbm_moved != 0u && lbm_is_new(cell);
        const ivec3 last = ivec3(LBM_NX, LBM_NY, LBM_NZ) - 1;
        bool inside = all(greaterThan(cell, ivec3(0))) && all(lessThan(cell, last));
        uint solids = 0u;
        uvec3 ids[9];
        for (int i = 0; i < 9; i++) ids[i] = lbm_three_ids(inside, cell + ivec3(0, 1 - i % 3, 1 - i / 3));
        [[dont_unroll]] for (int i = 0; i < 27; i++) {
            int layer = i * 57 >> 9, row = i * 86 >> 8; // i / 9, i / 3
            ivec3 direction = ivec3(i - 3 * row, row - 3 * layer, layer) - 1;
            uint id = ids[row][1 - direction.x];
            if (!new_) lbm_wall_speeds[27 * k + i] = lbm_wall_speed(cell, direction, id);
            if (LBM_ROUTES && (id != 0u || lbm_is_wall(cell - direction))) solids |= 1u << 26 - i;
        }
        lbm_solids[k] = solids;
    }
    lbm_pushed = lbm_float(0.0);
#define ADD(i, x, y, z)                                                                            \
    lbm_pushed += 6.0 * LBM_WEIGHT(x, y, z) * (LBM_WALL_SPEEDS(x, y, z) + LBM_WALL_SPEEDS(-(x), -(y), -(z)));
    LBM_PAIRS(ADD)
#undef ADD
}

void lbm_push_air(inout lbm_float f[LBM_Q]) {
    lbm_float density = 1.0 + f[0];
#define ADD(i, x, y, z) density += f[i] + f[i + 1];
    LBM_PAIRS(ADD)
#undef ADD
#define PUSH(i, x, y, z)                                                                           \
    {                                                                                              \
        lbm_float a = 6.0 * LBM_WEIGHT(x, y, z) * LBM_WALL_SPEEDS(x, y, z);                        \
        lbm_float b = 6.0 * LBM_WEIGHT(x, y, z) * LBM_WALL_SPEEDS(-(x), -(y), -(z));               \
        f[i] += density * a;                                                                       \
        f[i + 1] += density * b;                                                                   \
    }
    LBM_PAIRS(PUSH)
#undef PUSH
}

void lbm_push_scalar(inout lbm_float g[LBM_SCALAR_Q]) {
    lbm_float value = g[0];
#define ADD(i, x, y, z) value += g[i] + g[i + 1];
    LBM_SCALAR_PAIRS(ADD)
#undef ADD
    g[0] += value * lbm_pushed; // less what the links bring
    value *= 2.0 / LBM_SCALAR_SPEED;
#define PUSH(i, x, y, z)                                                                           \
    {                                                                                              \
        lbm_float a = LBM_SCALAR_WEIGHT(x, y, z) * value * LBM_WALL_SPEEDS(x, y, z);               \
        lbm_float b = LBM_SCALAR_WEIGHT(x, y, z) * value * LBM_WALL_SPEEDS(-(x), -(y), -(z));      \
        g[i] += a;                                                                                 \
        g[i + 1] += b;                                                                             \
        g[0] -= a + b;                                                                             \
    }
    LBM_SCALAR_PAIRS(PUSH)
#undef PUSH
}
#endif

#endif
