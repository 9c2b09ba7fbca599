shared vec4 much[1 << 24];
void main() { much[gl_LocalInvocationIndex] = vec4(1); }
