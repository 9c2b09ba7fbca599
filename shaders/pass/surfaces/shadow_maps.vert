#include "lib/mesh.glsl"
layout(std430) readonly buffer Views { view_entry views_drawn[]; };

layout(location = 0) out vec2 uv;

void main() {
    mesh_point p = mesh_pull();
    uv = p.uv;
    gl_Position = views_drawn[part.flags.y].clip * vec4(p.position, 1.0);
}
