// A thread for each vertex of each shell.
layout(local_size_x = 64) in;
#include "grid.glsl"
layout(std430) writeonly buffer ShellVertices { vec4 shell_vertices[]; }; // where (m)

void main() {
    int vertex = int(gl_GlobalInvocationID.x);
    uint shell = gl_GlobalInvocationID.y;
    if (vertex >= 6 * SHELL_FACE || shell >= shell_count) return;
    shell_record s = shell_records[shell];
    shell_said = shell_facts_of(s);
    vec3 way = shell_way(vertex);
    vec3 p = s.ball.xyz + s.ball.w * (1.0 + shell_displaced(way)) * way;
    shell_vertices[shell * uint(6 * SHELL_FACE) + uint(vertex)] = vec4(p, 1.0);
}
