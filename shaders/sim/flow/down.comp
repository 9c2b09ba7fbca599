// From a level to the next coarser one: FLOW_SWEEPS sweeps of red-black Gauss-Seidel that begin
// with nothing (red cells, then black ones), and what they leave, restricted. After them only red
// cells have something left.
//
// With FLOW_FINEST, before that: the step of conjugate gradients that the last direction was found
// for (Hestenes and Stiefel 1952), and whether the solve is done.
layout(local_size_x = FLOW_GROUP) in;
#define FLOW_HALO (2 * FLOW_SWEEPS + 1)
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"
#include "sim/flow/tile.glsl"

uniform vec2 coarse_cells;
#define coarse_size ivec2(coarse_cells)
uniform int from_at, to_at; // where r of the first slice begins: here, on the coarser level
layout(std430) readonly buffer FlowFrom { float from[]; };
layout(std430) writeonly buffer FlowTo { float to[]; };
#if FLOW_SWEEPS > 1
uniform int z_at;
layout(std430) writeonly buffer FlowSwept { float swept[]; };
#endif
#ifdef FLOW_FINEST
uniform int iteration;
uniform float tolerance;
layout(std430) readonly buffer FlowDirection { float direction[]; }; // then its image
layout(std430) buffer FlowPressure { float pressure[]; };
layout(std430) writeonly buffer FlowResidual { float residual[]; };

// r of a cell once the direction is followed.
float follow(ivec2 cell, int slice, bool is_air, bool own, flow_way way, float mean) {
    uint at = flow_cell(cell, slice);
    float r = from[at];
    r = way.leads ? r - way.stride * direction[flow_cell_behind(cell, slice)] : is_air ? r - mean : 0.0;
    if (!own) return r;
    residual[at] = r;
    if (way.leads) pressure[at] += way.stride * direction[at];
    return r;
}

// The solve is done: the solution alone is wanted.
void finish(int slice, flow_way way) {
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE * FLOW_TILE; i += FLOW_GROUP) {
        ivec2 cell = flow_tile_first() + ivec2(i % FLOW_TILE, i / FLOW_TILE);
        if (!flow_inside(cell)) continue;
        uint at = flow_cell(cell, slice);
        pressure[at] += way.stride * direction[at];
    }
}
#endif

// With what the first half of a sweep gives red cells.
void load(int slice, flow_way way, float mean) {
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE_CELLS; i += FLOW_GROUP) {
        ivec2 p = ivec2(i % FLOW_WIDE, i / FLOW_WIDE) - FLOW_HALO;
        ivec2 cell = flow_around(flow_tile_first() + p, level_size);
        flow_tile_r[i] = flow_tile_z[i] = 0.0;
        if (!flow_within(cell, level_size)) continue;
        float d = flow_own(flow_coefficients_of(cell, slice));
#ifdef FLOW_FINEST
        float r = follow(cell, slice, d > 0.0, flow_tile_owns(p), way, mean);
#else
        float r = from[uint(from_at) + flow_level_cell(cell, slice)];
#endif
        flow_tile_r[i] = r;
        if (((p.x + p.y) & 1) == 0) flow_tile_z[i] = r * d;
    }
    barrier();
}

// What red cells have left takes the place of their z, which up.comp wants again.
void leave(int slice) {
    ivec2 p, cell;
    for (int k = int(gl_LocalInvocationIndex); k < flow_tile_count(1); k += FLOW_GROUP) {
        if (!flow_tile_find(k, 1, 0, p, cell)) continue;
        int i = flow_tile_at(p);
        uvec2 c = flow_coefficients_of(cell, slice);
        float z_own = flow_tile_z[i], left = flow_tile_around(i, c.x);
#if FLOW_SWEEPS > 1
        if (flow_tile_owns(p)) swept[uint(z_at) + flow_level_cell(cell, slice)] = z_own;
        float d = flow_diagonal(c);
        left += d > 0.0 ? flow_tile_r[i] - d * z_own : 0.0;
#endif
        flow_tile_z[i] = left;
    }
    barrier();
}

float restrict_(ivec2 p, ivec2 coarse) {
    float r = 0.0;
    for (int j = 0; j < 8; j++) { // red cells
        ivec2 o = ivec2(j % 2 * 2 + (j / 2 & 1), j / 2);
        ivec2 fine = flow_around(2 * coarse - 1 + o, level_size);
        if (!flow_within(fine, level_size) || !all(flow_asked(o, level_size))) continue;
        r += flow_share(fine, coarse, coarse_size) * flow_tile_z[flow_tile_at(2 * p - 1 + o)];
    }
    return r;
}

void main() {
    int slice = int(gl_WorkGroupID.z);
#ifdef FLOW_FINEST
    flow_way way = flow_begin(slice, iteration, tolerance);
    if (way.done && way.leads) finish(slice, way);
    if (way.done) return;
    load(slice, way, way.leads ? 0.0 : flow_means(slice).x);
#else
    if (flow_stopped(slice)) return;
    load(slice, flow_way(false, false, 0.0), 0.0);
#endif
    for (int border = FLOW_HALO - 1; border > 1; border--)
        flow_tile_sweep(border, FLOW_HALO - border & 1, slice);
    leave(slice);
    const int half_ = FLOW_TILE / 2;
    for (int k = int(gl_LocalInvocationIndex); k < half_ * half_; k += FLOW_GROUP) {
        ivec2 p = ivec2(k % half_, k / half_), coarse = flow_tile_first() / 2 + p;
        if (!flow_within(coarse, coarse_size)) continue;
        uint at = uint((slice * coarse_size.y + coarse.y) * coarse_size.x + coarse.x);
        to[uint(to_at) + at] = restrict_(p, coarse);
    }
}
