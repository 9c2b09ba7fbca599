#extension GL_EXT_buffer_reference : require
layout(buffer_reference) buffer R { uint a; };
layout(std430, binding = 1) buffer B { uvec2 b; };
void main() { R(b).a = 1; }
