// Values of a field at points: the GPU's side of tests/gpu/field_*.c.

layout(local_size_x = 64) in;
layout(std430) readonly buffer Points { vec4 points[]; };
layout(std430) writeonly buffer Results { vec4 results[]; };

#include "fields.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(points.length())) return;
    vec3 p = points[i].xyz;
    results[i] = PROBE;
}
