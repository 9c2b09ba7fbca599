// Vertices are pulled from a storage buffer, by index.
#include "lib/frame.glsl"
#include "lib/mesh.glsl"
struct vertex { vec4 position_u; vec4 normal_v; };
layout(std430, binding = 2) readonly buffer Vertices { vertex vertices[]; };
layout(std430, binding = 3) readonly buffer Indices { uint indices[]; };

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec2 uv;
layout(location = 2) out float distance;

void main() {
    vertex v = vertices[indices[gl_VertexIndex + part.range.x]];
    vec4 seen = frame.view * (part.transform * vec4(v.position_u.xyz, 1.0));
    world_normal = mat3(part.transform) * v.normal_v.xyz; // rotation and uniform scale only
    uv = vec2(v.position_u.w, v.normal_v.w);
    distance = -seen.z;
    gl_Position = frame.projection * seen;
}
