// Which cells of an element are air: bodies from a buffer of one byte a cell (cells.comp makes it),
// walls from where a cell is. Lanes as bits.
#ifndef SIM_LBM_CELLS_GLSL
#define SIM_LBM_CELLS_GLSL
#include "sim/lbm/state.glsl"

#define LBM_NZ (LBM_LAYERS * LBM_LANES)

// Faces, as lbm_face in src/sim/lbm.h; LBM_FACE_0 to LBM_FACE_5 are those of the lattice.
#define LBM_FACE_IS_WALL(k) ((k) == 1)
#define LBM_FACE_IS_OPEN(k) ((k) >= 3) // air comes and goes
#define LBM_FACE_IS_INFLOW(k) ((k) == 4)

#define LBM_ALL_LANES ((1u << LBM_LANES) - 1u)
#define LBM_LAST_LANE (1u << (LBM_LANES - 1))

// Of a cell's byte.
#define LBM_CELL_SOLID 1u
#define LBM_CELL_NEW 2u  // it became solid, or air, when bodies moved last
#define LBM_CELL_REACHED 4u // air whose scalars a body changes (routes.glsl): up to two cells away
#define LBM_CELL_NEAR 8u // air beside a body that moves, or, with such scalars, any

// Round the lattice in all directions, as memory goes: from less than it beyond. No division: that is
// slow where it is not done by a unit of its own.
ivec3 lbm_wrap(ivec3 cell) {
    const ivec3 size = ivec3(LBM_NX, LBM_NY, LBM_NZ);
    return cell + size * (ivec3(lessThan(cell, ivec3(0))) - ivec3(greaterThanEqual(cell, size)));
}

// Elements as they are counted, x fastest; `at`: x, y, layer.
uint lbm_element_at(uvec3 at) {
    return at.x + LBM_NX * at.y + LBM_LAYER * at.z;
}

// The element and the lane that a cell of the lattice lies in.
uint lbm_element_of(ivec3 cell, out uint lane) {
    lane = uint((float(cell.z) + 0.5) * (1.0 / float(LBM_LAYERS)));
    return lbm_element_at(uvec3(cell.xy, uint(cell.z) - lane * LBM_LAYERS));
}

// Bodies stand where scalars have fewer links than the air.
#define LBM_ROUTES (LBM_BODIES != 0 && LBM_BY_LINKS != 0 && LBM_SCALARS > 0 && LBM_SCALAR_Q == 7)

struct lbm_site { // of an element
    uint solid; // lanes that no air is in
    uint near;  // lanes of air beside a body that moves, or, where LBM_ROUTES, any
    uint reached; // lanes of air whose scalars a body changes
};

#if LBM_BODIES
layout(std430) buffer LbmCells { uint lbm_cells[]; }; // one an element, a byte a lane

uint lbm_bits(uint bytes, uint flag) {
    return ((bytes / flag) & 0x01010101u) * 0x01020408u >> 24 & 15u;
}

uint lbm_lanes_with(uint element, uint flag) {
    return lbm_bits(lbm_cells[element], flag);
}
#endif

// `at`: x, y, layer.
uint lbm_wall_lanes(uvec3 at) {
    if (LBM_REGION == LBM_CORE) return 0u;
    bool all = LBM_FACE_IS_WALL(LBM_FACE_0) && at.x == 0u ||
               LBM_FACE_IS_WALL(LBM_FACE_1) && at.x == LBM_NX - 1u ||
               LBM_FACE_IS_WALL(LBM_FACE_2) && at.y == 0u ||
               LBM_FACE_IS_WALL(LBM_FACE_3) && at.y == LBM_NY - 1u;
    uint some = LBM_FACE_IS_WALL(LBM_FACE_4) && at.z == 0u ? 1u : 0u;
    if (LBM_FACE_IS_WALL(LBM_FACE_5) && at.z == LBM_LAYERS - 1u) some |= LBM_LAST_LANE;
    return all ? LBM_ALL_LANES : some;
}

lbm_site lbm_site_at(uvec3 at, uint element) {
    lbm_site site = lbm_site(lbm_wall_lanes(at), 0u, 0u);
#if LBM_BODIES
    site.solid |= lbm_lanes_with(element, LBM_CELL_SOLID);
    site.near = lbm_lanes_with(element, LBM_CELL_NEAR);
    site.reached = lbm_lanes_with(element, LBM_CELL_REACHED);
#endif
    return site;
}

lbm_bool lbm_in_lanes(uint bits) {
#if LBM_LANES == 2
    return notEqual(uvec2(bits) >> uvec2(0, 1) & 1u, uvec2(0u));
#else
    return notEqual(uvec4(bits) >> uvec4(0, 1, 2, 3) & 1u, uvec4(0u));
#endif
}

// `b` in the lanes, else `a`.
lbm_element lbm_choose(lbm_element a, lbm_element b, uint lanes) {
#if LBM_HALF
#if LBM_LANES == 2
    uint first = lanes;
    uint mask = (first & 1u) * 0xffffu | (first >> 1 & 1u) * 0xffff0000u;
#else
    uvec2 first = uvec2(lanes) >> uvec2(0, 2);
    uvec2 mask = (first & 1u) * 0xffffu | (first >> 1 & 1u) * 0xffff0000u;
#endif
    return a & ~mask | b & mask;
#else
    return mix(a, b, lbm_in_lanes(lanes));
#endif
}

#endif
