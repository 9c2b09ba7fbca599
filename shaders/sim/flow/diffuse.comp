// Diffusion where a step of central differences would be too long: a stage of the Runge-Kutta-
// Legendre method of first order (Meyer, Balsara and Aslam 2012), which is stable over (s^2 + s) /
// 2 such steps in s stages.
layout(local_size_x = 16, local_size_y = 16) in;
#define FLOW_OBSTACLES readonly
#include "sim/flow/state.glsl"
#include "sim/flow/friction.glsl"

uniform vec3 weights; // of the stage before, of the one before that, of what diffuses
layout(std430) readonly buffer FlowVelocityFrom { vec2 before[]; };
layout(std430) readonly buffer FlowVelocityLast { vec2 earlier[]; };
layout(std430) writeonly buffer FlowVelocityTo { vec2 velocity_to[]; };

FLOW_LAPLACE(laplace_u, before, x)
FLOW_LAPLACE(laplace_v, before, y)
FLOW_LAPLACE_BOTH(laplace, laplace_u, laplace_v)

// What nothing passes stays as it is.
bvec2 is_held(ivec2 cell, int slice) {
    bvec2 at_wall = bvec2((FLOW_FACE_LEFT == FLOW_CLOSED && cell.x == 0) ||
                              (FLOW_FACE_RIGHT == FLOW_CLOSED && cell.x == FLOW_NX),
                          (FLOW_FACE_BOTTOM == FLOW_CLOSED && cell.y == 0) ||
                              (FLOW_FACE_TOP == FLOW_CLOSED && cell.y == FLOW_NY));
    bool here = flow_is_blocked(cell, slice);
    return bvec2(at_wall.x || here || flow_is_blocked(cell - ivec2(1, 0), slice),
                 at_wall.y || here || flow_is_blocked(cell - ivec2(0, 1), slice));
}

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    int slice = int(gl_GlobalInvocationID.z);
    ivec2 last = FLOW_SIZE - ivec2(FLOW_AROUND_X, FLOW_AROUND_Y);
    if (any(greaterThan(cell, last))) return;
    uint at = flow_corner(cell, slice);
    vec2 v = weights.x * before[at] + weights.y * earlier[at] + weights.z * laplace(cell, slice);
    velocity_to[at] = mix(v, before[at], is_held(cell, slice));
}
