// What a state looks like: images of halves that others sample.
layout(local_size_x = 16, local_size_y = 16) in;
#define FLOW_STATE
#include "sim/flow/state.glsl"

uniform float pressure_unit; // of 1 m^2/s^2
layout(std430) readonly buffer FlowPressure { float pressure[]; };
layout(rgba16f) writeonly uniform image3D scalars;
layout(rg16f) writeonly uniform image3D velocity;

const float MOST = 65000.0;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!flow_inside(at.xy)) return;
    vec4 s = flow_scalars_of(at.xy, at.z);
    s.w = pressure[flow_cell(at.xy, at.z)] / pressure_unit;
    vec2 v = flow_velocity_of(at.xy, at.z);
    imageStore(scalars, at, clamp(s, -MOST, MOST));
    imageStore(velocity, at, vec4(clamp(v, -MOST, MOST), 0.0, 0.0));
}
