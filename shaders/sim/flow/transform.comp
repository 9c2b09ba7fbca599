// Between rows of cells and what they are made of: sums of the modes of the pressure's equation along
// x (src/sim/flow_transform.c). Products of matrices, a tile to a group. With FLOW_BACK from modes to
// cells: z, and its product with r.
layout(local_size_x = FLOW_GROUP) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

layout(std430) readonly buffer FlowModes { float modes[]; }; // mode after mode, of FLOW_NX cells
layout(std430) readonly buffer FlowResidual { float r[]; };
#ifdef FLOW_BACK
layout(std430) readonly buffer FlowLines { float lines[]; }; // mode after mode, each along y
layout(std430) writeonly buffer FlowZ { float z[]; };
#else
layout(std430) writeonly buffer FlowLines { float lines[]; };
#endif

const int SIDE = FLOW_GROUP == 256 ? 16 : 8; // of the group, as a square
const int EACH = FLOW_TILE / SIDE;           // results of a thread along each side
const int PITCH = FLOW_TILE + 1;             // so that columns lie in different banks
shared float some_modes[FLOW_TILE * PITCH], some_values[FLOW_TILE * PITCH];

uint line_at(int mode, int y, int slice) {
    return uint((slice * FLOW_NX + mode) * FLOW_NY + y);
}

float mode_at(int mode, int x) {
    return mode < FLOW_NX && x < FLOW_NX ? modes[mode * FLOW_NX + x] : 0.0;
}

// What the sum runs over: cells of a row, or modes.
float value_at(int i, int y, int slice) {
    if (i >= FLOW_NX || y >= FLOW_NY) return 0.0;
#ifdef FLOW_BACK
    return lines[line_at(i, y, slice)];
#else
    return r[flow_cell(ivec2(i, y), slice)];
#endif
}

// Part of both matrices: FLOW_TILE of what the sum runs over, from `i` on. Neighbouring threads read
// what lies side by side, modes and rows along x, lines along y.
void load(int i, ivec2 first, int slice) {
    barrier();
    for (int k = int(gl_LocalInvocationIndex); k < FLOW_TILE * FLOW_TILE; k += FLOW_GROUP) {
        int fast = k % FLOW_TILE, slow = k / FLOW_TILE;
#ifdef FLOW_BACK
        some_modes[slow * PITCH + fast] = mode_at(i + slow, first.x + fast);
        some_values[slow * PITCH + fast] = value_at(i + slow, first.y + fast, slice);
#else
        some_modes[fast * PITCH + slow] = mode_at(first.x + slow, i + fast);
        some_values[fast * PITCH + slow] = value_at(i + fast, first.y + slow, slice);
#endif
    }
    barrier();
}

void main() {
    int slice = int(gl_WorkGroupID.z);
    if (flow_stopped(slice)) return;
    ivec2 thread = ivec2(gl_LocalInvocationIndex) / ivec2(1, SIDE) % SIDE;
    ivec2 first = ivec2(gl_WorkGroupID.xy) * FLOW_TILE;
    // The first index is along x: a cell, or a mode. Lines are written along y, cells along x.
#ifndef FLOW_BACK
    thread = thread.yx;
#endif
    float sums[EACH][EACH];
    for (int a = 0; a < EACH; a++)
        for (int b = 0; b < EACH; b++) sums[a][b] = 0.0;
    for (int i = 0; i < FLOW_NX; i += FLOW_TILE) {
        load(i, first, slice);
        for (int k = 0; k < FLOW_TILE; k++) {
            float m[EACH], v[EACH];
            for (int a = 0; a < EACH; a++) {
                m[a] = some_modes[k * PITCH + thread.x + a * SIDE];
                v[a] = some_values[k * PITCH + thread.y + a * SIDE];
            }
            for (int a = 0; a < EACH; a++)
                for (int b = 0; b < EACH; b++) sums[a][b] += m[a] * v[b];
        }
    }
    float product = 0.0;
    for (int a = 0; a < EACH; a++) {
        for (int b = 0; b < EACH; b++) {
            ivec2 at = first + thread + ivec2(a, b) * SIDE;
            if (!flow_inside(at)) continue;
#ifdef FLOW_BACK
            uint cell = flow_cell(at, slice);
            z[cell] = sums[a][b];
            product += sums[a][b] * r[cell];
#else
            lines[line_at(at.x, at.y, slice)] = sums[a][b];
#endif
        }
    }
#ifdef FLOW_BACK
    flow_leave(slice, FLOW_PARTS_RZ, vec4(product, 0.0, 0.0, 0.0));
#endif
}
