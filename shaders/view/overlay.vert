// Triangles of a user interface, pulled by index.
struct vertex { float x, y, u, v; uint color; }; // roil_vertex of roil.h
layout(std430) readonly buffer Vertices { vertex vertices[]; };
layout(std430) readonly buffer Indices { uint indices[]; };
layout(std140) uniform View { vec4 size; }; // of the canvas, pixels

layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 color;

void main() {
    vertex v = vertices[indices[gl_VertexIndex]];
    uv = vec2(v.u, v.v);
    color = unpackUnorm4x8(v.color);
    gl_Position = vec4(2.0 * vec2(v.x, v.y) / size.xy - 1.0, 0.0, 1.0);
}
