// Draws the vertices that shell/vertices.glsl pushed out.
#include "lib/frame.glsl"
#include "grid.glsl"
uniform uint shell_at;
layout(std430) readonly buffer ShellVertices { vec4 shell_vertices[]; };
layout(location = 0) out vec3 place;
layout(location = 1) out float away;

void main() {
    place = shell_vertices[shell_at * uint(6 * SHELL_FACE) + uint(shell_corner(gl_VertexIndex))].xyz;
    vec4 seen = frame.view * vec4(place, 1.0);
    away = -seen.z;
    gl_Position = frame.projection * seen;
}
