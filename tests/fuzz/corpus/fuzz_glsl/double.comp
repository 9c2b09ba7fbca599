layout(std430, binding = 1) buffer B { double b[]; };
void main() { b[0] = 2.0lf; }
