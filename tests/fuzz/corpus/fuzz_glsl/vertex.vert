layout(std430, binding = 0) readonly buffer Points { vec4 points[]; };
layout(location = 0) out vec2 at;
void main() { at = points[gl_VertexIndex].xy; gl_Position = vec4(at, 0, 1); }
