// From a level to the next finer one: what down.comp's sweep gave, and what the coarser level makes
// of what that left, then a sweep in the opposite order (black cells, then red ones), so that the
// whole cycle is symmetric.
layout(local_size_x = 256) in;
#define FLOW_HALO 2
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

float coarse(ivec2 cell, int slice) {
    if (cell.x < 0 || cell.y < 0) return 0.0;
    return z[uint(coarse_z_at + (slice * coarse_size.y + cell.y) * coarse_size.x + cell.x)];
}

float interpolate(ivec2 fine, int slice) {
    ivec2 own = fine >> 1, other = flow_others(fine, coarse_size);
    return 0.5625 * coarse(own, slice) + 0.0625 * coarse(other, slice) +
           0.1875 * (coarse(ivec2(other.x, own.y), slice) + coarse(ivec2(own.x, other.y), slice));
}

void load(int slice) {
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE_CELLS; i += FLOW_GROUP) {
        ivec2 p = ivec2(i % FLOW_WIDE, i / FLOW_WIDE) - FLOW_HALO;
        ivec2 cell = flow_around(flow_tile_first() + p, level_size);
        flow_tile_nothing(i);
        if (!flow_within(cell, level_size)) continue;
        flow_tile_coefficients(i, cell, slice);
        flow_tile_r[i] = from[uint(from_at) + flow_level_cell(cell, slice)];
        if (((p.x + p.y) & 1) == 0 && flow_tile_d[i] > 0.0)
            flow_tile_z[i] = flow_tile_r[i] * flow_tile_d[i] + interpolate(cell, slice);
    }
}

// Updates a cell; r z of it, if it is the tile's own.
float update(ivec2 p, int slice) {
    int i = flow_tile_at(p);
    float value = (flow_tile_r[i] + flow_tile_around(i)) * flow_tile_d[i];
    flow_tile_z[i] = value;
    ivec2 cell = flow_tile_first() + p;
    bool own = all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, ivec2(FLOW_TILE)));
    if (!own || !flow_within(cell, level_size)) return 0.0;
    z[uint(z_at) + flow_level_cell(cell, slice)] = value;
    return value * flow_tile_r[i];
}

void main() {
    int slice = int(gl_WorkGroupID.z), thread = int(gl_LocalInvocationIndex);
    if (flow_known[slice * FLOW_KNOWN + FLOW_DONE] > 0.0) return;
    load(slice);
    barrier();
    float sum = 0.0;
    for (int k = thread; k < flow_tile_count(1); k += FLOW_GROUP)
        sum += update(flow_tile_cell(k, 1, 1), slice);
    barrier();
    for (int k = thread; k < flow_tile_count(0); k += FLOW_GROUP)
        sum += update(flow_tile_cell(k, 0, 0), slice);
#ifdef FLOW_FINEST
    flow_leave(slice, FLOW_PARTS_RZ, vec4(sum, 0.0, 0.0, 0.0));
#endif
}
