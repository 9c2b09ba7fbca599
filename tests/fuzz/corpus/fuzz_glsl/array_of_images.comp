layout(binding = 0) uniform sampler2D many[4];
layout(std430, binding = 1) buffer B { vec4 b[]; };
void main() { b[0] = texture(many[1], vec2(0)); }
