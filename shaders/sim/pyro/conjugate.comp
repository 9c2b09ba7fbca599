// Conjugate gradients whose steps a V-cycle has found (McAdams, Sifakis and Teran 2010), for boxes with
// solids: coarse levels see thin ones in part, and cycles alone are slow there. A V-cycle is not quite
// symmetric, so each direction is made conjugate to the last one itself (Notay 2000). In one of five
// parts:
//   RESIDUAL  right: what the last step's pressure leaves of it
//   ACROSS    what the cycle found, by what the last direction changes: a sum
//   TURN      the next direction
//   APPLY     what it changes; how far that goes along what is left: two sums
//   MOVE      pressure, and what it leaves
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#define PYRO_FINEST
#include "sim/pyro/state.glsl"
#include "sim/pyro/levels.glsl"

layout(std430) buffer PyroPressure { float pressure[]; };
layout(std430) buffer PyroRight { float right[]; };
layout(std430) buffer PyroFound { float found[]; };         // by a cycle
layout(std430) buffer PyroDirection { float direction[]; };
layout(std430) buffer PyroChange { float change[]; };       // of what is left, by the direction
layout(std430) writeonly buffer PyroReport { vec4 report[]; };
layout(std430) readonly buffer PyroSums { vec4 sums[]; };   // of RESIDUAL, ACROSS, APPLY
uniform int begins;                                         // 1: there is no last direction
LEVEL_COEFFICIENTS

shared vec2 parts[256];

void add_up(vec2 part) {
    uint i = gl_LocalInvocationIndex;
    parts[i] = part;
    for (uint step_ = 128u; step_ > 0u; step_ >>= 1) {
        barrier();
        if (i < step_) parts[i] += parts[i + step_];
    }
    uint group = (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (i == 0u) report[group] = vec4(parts[0], 0.0, 0.0);
}

float ratio(float a, float b) {
    return abs(b) > 1e-30 ? a / b : 0.0;
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
#if defined(RESIDUAL) || defined(APPLY) || (defined(TURN) && PYRO_CLOSED)
    level_near n = level_near_of(c);
    LEVEL_WEIGH(n)
    int at = level_at(n);
#else
    int at = pyro_at(c);
#endif
#ifdef RESIDUAL
    float around;
    LEVEL_SUM(pressure, n, around)
    float left = n.all > 0.0 ? right[at] - (around - n.all * pressure[at]) : 0.0;
    right[at] = left;
    found[at] = 0.0;
#if PYRO_CLOSED
    add_up(vec2(left, n.all > 0.0));
#endif
#elif defined(ACROSS)
    add_up(vec2(found[at] * change[at], 0.0));
#elif defined(TURN)
    float last = begins != 0 ? 0.0 : ratio(sums[1].x, sums[2].x) * direction[at];
    direction[at] = found[at] - last;
    found[at] = 0.0;
#if PYRO_CLOSED
    // What no pressure can balance in a closed box: all of the gas becomes denser or thinner.
    if (begins != 0 && n.all > 0.0) right[at] -= ratio(sums[0].x, sums[0].y);
#endif
#elif defined(APPLY)
    float around;
    LEVEL_SUM(direction, n, around)
    float own = direction[at], left = around - n.all * own;
    change[at] = left;
    add_up(own * vec2(left, right[at]));
#else
    float far = clamp(ratio(sums[2].y, sums[2].x), 0.0, 2.0);
    pressure[at] += far * direction[at];
    right[at] -= far * change[at];
#endif
}
