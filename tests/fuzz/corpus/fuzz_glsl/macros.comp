#define TWICE(x) x x
#define FOUR(x) TWICE(TWICE(x))
#define ADD(a, b) (a + \
    b)
#if (1 + 2 * (3 << 1)) > 4 && defined(FOUR)
shared float part[64];
#else
#error no
#endif
layout(local_size_x = 64) in;
layout(std430) writeonly buffer Result { float sums[]; };
float f(float a) { return ADD(a, 1.0); }
float g(float a) { return f(f(a)); }
void main() {
    float a = 0;
    FOUR(a = g(a);)
    part[gl_LocalInvocationIndex] = a;
    barrier();
    switch (int(a)) { case 0: a = 1; break; default: a = part[0]; }
    sums[gl_GlobalInvocationID.x] = a;
}
