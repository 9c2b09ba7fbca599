#include "lib/frame.glsl"
#include "lib/mesh.glsl"

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec2 uv;
layout(location = 2) out float distance;
layout(location = 3) flat out vec4 tint;

void main() {
    mesh_point p = mesh_pull();
    vec4 seen = frame.view * vec4(p.position, 1.0);
    world_normal = p.normal;
    uv = p.uv;
    distance = -seen.z;
    tint = p.tint;
    gl_Position = frame.projection * seen;
}
