float f(float x) { return x > 0.0 ? f(x - 1.0) : 0.0; }
layout(std430, binding = 1) buffer B { float b; };
void main() { b = f(b); }
