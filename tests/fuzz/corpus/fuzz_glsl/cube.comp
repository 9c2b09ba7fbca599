layout(binding = 0) uniform samplerCube sky;
layout(std430, binding = 1) buffer B { vec4 b[]; };
void main() { b[0] = textureLod(sky, vec3(1), 0); }
