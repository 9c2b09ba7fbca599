// From a level to the next finer one: what down.comp's sweeps gave, and what the coarser level
// makes of what they left, then sweeps in the opposite order (black cells, then red ones), so that the
// whole cycle is symmetric.
layout(local_size_x = FLOW_GROUP) in;
#define FLOW_HALO (2 * FLOW_SWEEPS)
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"
#include "sim/flow/tile.glsl"

uniform vec2 coarse_cells;
#define coarse_size ivec2(coarse_cells)
uniform int from_at;          // where r of the first slice begins
uniform int z_at, coarse_z_at; // where z of the first slice begins: here, on the coarser level
layout(std430) readonly buffer FlowFrom { float from[]; };
layout(std430) buffer FlowZ { float z[]; };
#if FLOW_SWEEPS > 1
layout(std430) readonly buffer FlowSwept { float swept[]; };
#endif

float coarse(ivec2 cell, int slice) {
    if (cell.x < 0 || cell.y < 0) return 0.0;
    return z[uint(coarse_z_at + (slice * coarse_size.y + cell.y) * coarse_size.x + cell.x)];
}

float interpolate(ivec2 fine, int slice) {
    ivec2 own = fine >> 1, other = flow_others(fine, coarse_size);
    return 0.5625 * coarse(own, slice) + 0.0625 * coarse(other, slice) +
           0.1875 * (coarse(ivec2(other.x, own.y), slice) + coarse(ivec2(own.x, other.y), slice));
}

// Of red cells; black ones are made from these.
float begin(ivec2 cell, uint at, float r, int slice) {
    float d = flow_own(flow_coefficients_of(cell, slice));
    if (d == 0.0) return 0.0;
#if FLOW_SWEEPS > 1
    return swept[uint(z_at) + at] + interpolate(cell, slice);
#else
    return r * d + interpolate(cell, slice);
#endif
}

void load(int slice) {
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE_CELLS; i += FLOW_GROUP) {
        ivec2 p = ivec2(i % FLOW_WIDE, i / FLOW_WIDE) - FLOW_HALO;
        ivec2 cell = flow_around(flow_tile_first() + p, level_size);
        flow_tile_r[i] = flow_tile_z[i] = 0.0;
        if (!flow_within(cell, level_size)) continue;
        uint at = flow_level_cell(cell, slice);
        flow_tile_r[i] = from[uint(from_at) + at];
        if (((p.x + p.y) & 1) == 0) flow_tile_z[i] = begin(cell, at, flow_tile_r[i], slice);
    }
    barrier();
}

void main() {
    int slice = int(gl_WorkGroupID.z);
    if (flow_stopped(slice)) return;
    load(slice);
    for (int border = FLOW_HALO - 1; border >= 0; border--)
        flow_tile_sweep(border, border & 1, slice);
    float sum = 0.0;
    for (int k = int(gl_LocalInvocationIndex); k < FLOW_TILE * FLOW_TILE; k += FLOW_GROUP) {
        ivec2 p = ivec2(k % FLOW_TILE, k / FLOW_TILE), cell = flow_tile_first() + p;
        if (!flow_within(cell, level_size)) continue;
        int i = flow_tile_at(p);
        z[uint(z_at) + flow_level_cell(cell, slice)] = flow_tile_z[i];
        sum += flow_tile_z[i] * flow_tile_r[i];
    }
#ifdef FLOW_FINEST
    flow_leave(slice, FLOW_PARTS_RZ, vec4(sum, 0.0, 0.0, 0.0));
#endif
}
