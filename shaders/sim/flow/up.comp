// From a level to the next finer one: what down.comp's sweep gave, and what the coarser level makes
// of what that left, then a sweep in the opposite order (black cells, then red ones), so that the
// whole cycle is symmetric.
layout(local_size_x = FLOW_GROUP) in;
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

// Red cells: z before the sweep. Black ones: r.
void load(int slice) {
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE_CELLS; i += FLOW_GROUP) {
        ivec2 p = ivec2(i % FLOW_WIDE, i / FLOW_WIDE) - FLOW_HALO;
        ivec2 cell = flow_around(flow_tile_first() + p, level_size);
        flow_tile[i] = 0.0;
        if (!flow_within(cell, level_size)) continue;
        float value = from[uint(from_at) + flow_level_cell(cell, slice)];
        if (((p.x + p.y) & 1) == 0) {
            float d = flow_own(flow_coefficients_of(cell, slice));
            value = d > 0.0 ? value * d + interpolate(cell, slice) : 0.0;
        }
        flow_tile[i] = value;
    }
    barrier();
}

// Of a cell with r; r z of it, if it is the tile's own.
float update(ivec2 p, float r, uvec2 c, uint at) {
    int i = flow_tile_at(p);
    float value = (r + flow_tile_around(i, c.x)) * flow_own(c);
    flow_tile[i] = value;
    if (!flow_tile_owns(p)) return 0.0;
    z[uint(z_at) + at] = value;
    return value * r;
}

void main() {
    int slice = int(gl_WorkGroupID.z), thread = int(gl_LocalInvocationIndex);
    if (flow_stopped(slice)) return;
    load(slice);
    float sum = 0.0;
    for (int k = thread; k < flow_tile_count(1); k += FLOW_GROUP) {
        ivec2 p = flow_tile_cell(k, 1, 1), cell = flow_around(flow_tile_first() + p, level_size);
        if (!flow_within(cell, level_size)) continue;
        uvec2 c = flow_coefficients_of(cell, slice);
        sum += update(p, flow_tile[flow_tile_at(p)], c, flow_level_cell(cell, slice));
    }
    barrier();
    for (int k = thread; k < flow_tile_count(0); k += FLOW_GROUP) {
        ivec2 p = flow_tile_cell(k, 0, 0), cell = flow_tile_first() + p;
        if (!flow_within(cell, level_size)) continue;
        uint at = flow_level_cell(cell, slice);
        sum += update(p, from[uint(from_at) + at], flow_coefficients_of(cell, slice), at);
    }
#ifdef FLOW_FINEST
    flow_leave(slice, FLOW_PARTS_RZ, vec4(sum, 0.0, 0.0, 0.0));
#endif
}
