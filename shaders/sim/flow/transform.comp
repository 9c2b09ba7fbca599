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

// What the sum runs over: cells of a row, or modes. Where they fold, a row is its sum with itself from
// the other end, or the difference, for modes of the one and the other kind.
float value_at(int i, int y, int slice, float sign) {
    if (i >= FLOW_NX || y >= FLOW_NY) return 0.0;
#ifdef FLOW_BACK
    return lines[line_at(i, y, slice)];
#elif FLOW_FOLDS
    return r[flow_cell(ivec2(i, y), slice)] + sign * r[flow_cell(ivec2(FLOW_NX - 1 - i, y), slice)];
#else
    return r[flow_cell(ivec2(i, y), slice)];
#endif
}

// Part of both matrices: FLOW_TILE of what the sum runs over, from `i` on. Neighbouring threads read
// what lies side by side, modes and rows along x, lines along y.
void load(int i, ivec2 first, int slice, float sign) {
    barrier();
    for (int k = int(gl_LocalInvocationIndex); k < FLOW_TILE * FLOW_TILE; k += FLOW_GROUP) {
        int fast = k % FLOW_TILE, slow = k / FLOW_TILE;
#ifdef FLOW_BACK
        some_modes[slow * PITCH + fast] = mode_at(i + slow, first.x + fast);
        some_values[slow * PITCH + fast] = value_at(i + slow, first.y + fast, slice, sign);
#else
        some_modes[fast * PITCH + slow] = mode_at(first.x + slow, i + fast);
        some_values[fast * PITCH + slow] = value_at(i + fast, first.y + slow, slice, sign);
#endif
    }
    barrier();
}

float sums[EACH][EACH];

void add_products(int begin, int end, ivec2 first, ivec2 thread, int slice, float sign) {
    for (int i = begin; i < end; i += FLOW_TILE) {
        load(i, first, slice, sign);
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
}

#ifdef FLOW_BACK
float give(ivec2 at, int slice, float value) { // z; its product with r
    if (!flow_inside(at)) return 0.0;
    uint cell = flow_cell(at, slice);
    z[cell] = value;
    return value * r[cell];
}

// By all threads of a group. Where they fold there are half as many groups as parts.
void leave(int slice, float product) {
    flow_leave(slice, FLOW_PARTS_RZ, vec4(product, 0.0, 0.0, 0.0));
#if FLOW_FOLDS
    uint parts = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    if (gl_LocalInvocationIndex == 0u)
        flow_parts[flow_parts_at(slice, FLOW_PARTS_RZ) + parts + gl_WorkGroupID.y * gl_NumWorkGroups.x +
                   gl_WorkGroupID.x] = vec4(0.0);
#endif
}
#endif

void main() {
    int slice = int(gl_WorkGroupID.z);
    if (flow_stopped(slice)) return;
    ivec2 thread = ivec2(gl_LocalInvocationIndex) / ivec2(1, SIDE) % SIDE;
    ivec2 first = ivec2(gl_WorkGroupID.xy) * FLOW_TILE;
    // The first index is along x: a cell, or a mode. Lines are written along y, cells along x.
#ifndef FLOW_BACK
    thread = thread.yx;
#endif
    for (int a = 0; a < EACH; a++)
        for (int b = 0; b < EACH; b++) sums[a][b] = 0.0;
    const int half_ = FLOW_FOLDS == 1 ? FLOW_NX / 2 : FLOW_NX;
    float sign = first.x < half_ ? 1.0 : -1.0, product = 0.0;
    add_products(0, half_, first, thread, slice, sign);
#if defined(FLOW_BACK) && FLOW_FOLDS
    float same[EACH][EACH] = sums; // from both ends
    for (int a = 0; a < EACH; a++)
        for (int b = 0; b < EACH; b++) sums[a][b] = 0.0;
    add_products(half_, FLOW_NX, first, thread, slice, sign);
#endif
    for (int a = 0; a < EACH; a++) {
        for (int b = 0; b < EACH; b++) {
            ivec2 at = first + thread + ivec2(a, b) * SIDE;
#if defined(FLOW_BACK) && FLOW_FOLDS
            product += give(at, slice, same[a][b] + sums[a][b]);
            product += give(ivec2(FLOW_NX - 1 - at.x, at.y), slice, same[a][b] - sums[a][b]);
#elif defined(FLOW_BACK)
            product += give(at, slice, sums[a][b]);
#else
            if (flow_inside(at)) lines[line_at(at.x, at.y, slice)] = sums[a][b];
#endif
        }
    }
#ifdef FLOW_BACK
    leave(slice, product);
#endif
}
