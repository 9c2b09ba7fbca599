layout(std140, binding = 0) uniform Uniforms { mat3 a; };
layout(std430, binding = 1) buffer B { float b[]; };
void main() { b[0] = a[0][0]; }
