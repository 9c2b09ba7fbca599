float f(float x);
void main() { float a = f(1); }
