uniform float a = 1;
void main() {}
