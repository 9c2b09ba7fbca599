// From a level to the next coarser one: a sweep of red-black Gauss-Seidel that begins with nothing
// (red cells, then black ones), and what it leaves, restricted. After it only red cells have
// something left. The sweep's result is not kept: up.comp makes what it needs of it again.
//
// With FLOW_FINEST, before that: the step of conjugate gradients that the last direction was found
// for (Hestenes and Stiefel 1952).
layout(local_size_x = 256) in;
#define FLOW_HALO 3
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"
#include "sim/flow/tile.glsl"

uniform vec2 coarse_cells;
#define coarse_size ivec2(coarse_cells)
uniform int from_at, to_at; // where r of the first slice begins: here, on the coarser level
layout(std430) readonly buffer FlowFrom { float from[]; };
layout(std430) writeonly buffer FlowTo { float to[]; };
#ifdef FLOW_FINEST
uniform int iteration;
layout(std430) readonly buffer FlowDirection { float direction[]; };
layout(std430) readonly buffer FlowImage { float image[]; }; // of the direction
layout(std430) buffer FlowPressure { float pressure[]; };
layout(std430) writeonly buffer FlowResidual { float residual[]; };
#endif

// Loads the tile; what remains of r, scaled to as if all cells had four neighbours, squared.
float load(int slice) {
#ifdef FLOW_FINEST
    float mean = iteration == 0 ? flow_mean(slice, FLOW_PARTS_BUILD) : 0.0;
    float stride = iteration > 0 ? flow_stride(slice, (iteration + 1) & 1) : 0.0;
#endif
    float sum = 0.0;
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE_CELLS; i += FLOW_GROUP) {
        ivec2 p = ivec2(i % FLOW_WIDE, i / FLOW_WIDE) - FLOW_HALO;
        ivec2 cell = flow_around(flow_tile_first() + p, level_size);
        flow_tile_nothing(i);
        if (!flow_within(cell, level_size)) continue;
        flow_tile_coefficients(i, cell, slice);
        uint at = flow_level_cell(cell, slice);
        float r = from[uint(from_at) + at];
#ifdef FLOW_FINEST
        r = iteration == 0 ? (flow_tile_d[i] > 0.0 ? r - mean : 0.0) : r - stride * image[at];
        bool own = all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, ivec2(FLOW_TILE))) &&
                   flow_within(flow_tile_first() + p, level_size);
        if (own) {
            residual[at] = r;
            if (iteration > 0) pressure[at] += stride * direction[at];
            float left = 4.0 * r * flow_tile_d[i];
            sum += left * left;
        }
#endif
        flow_tile_r[i] = r;
        if (((p.x + p.y) & 1) == 0) flow_tile_z[i] = r * flow_tile_d[i];
    }
    return sum;
}

void main() {
    int slice = int(gl_WorkGroupID.z), thread = int(gl_LocalInvocationIndex);
    if (flow_known[slice * FLOW_KNOWN + FLOW_DONE] > 0.0) return;
    float sum = load(slice);
#ifdef FLOW_FINEST
    flow_leave(slice, FLOW_PARTS_R, vec4(sum, 0.0, 0.0, 0.0));
#endif
    barrier();
    for (int k = thread; k < flow_tile_count(2); k += FLOW_GROUP) {
        int i = flow_tile_at(flow_tile_cell(k, 2, 1));
        flow_tile_z[i] = (flow_tile_r[i] + flow_tile_around(i)) * flow_tile_d[i];
    }
    barrier();
    for (int k = thread; k < flow_tile_count(1); k += FLOW_GROUP) { // now what red cells have left
        int i = flow_tile_at(flow_tile_cell(k, 1, 0));
        flow_tile_z[i] = flow_tile_d[i] > 0.0 ? flow_tile_around(i) : 0.0;
    }
    barrier();
    const int half_ = FLOW_TILE / 2;
    for (int k = thread; k < half_ * half_; k += FLOW_GROUP) {
        ivec2 p = ivec2(k % half_, k / half_), coarse = flow_tile_first() / 2 + p;
        if (!flow_within(coarse, coarse_size)) continue;
        float r = 0.0;
        for (int j = 0; j < 8; j++) { // red ones
            ivec2 o = ivec2(j % 2 * 2 + (j / 2 & 1), j / 2);
            ivec2 fine = flow_around(2 * coarse - 1 + o, level_size);
            if (!flow_within(fine, level_size) || !all(flow_asked(o, level_size))) continue;
            r += flow_share(fine, coarse, coarse_size) * flow_tile_z[flow_tile_at(2 * p - 1 + o)];
        }
        to[uint(to_at) + uint((slice * coarse_size.y + coarse.y) * coarse_size.x + coarse.x)] = r;
    }
}
