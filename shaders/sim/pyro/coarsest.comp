// The coarsest level, by one group: sweeps of red-black Gauss-Seidel with overrelaxation, until all
// of it has heard of all of it.
layout(local_size_x = 256) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/levels.glsl"

uniform int sweeps;
uniform float relaxation;
layout(std430) coherent buffer PyroCoarsePressure { float coarse_pressure[]; };
layout(std430) readonly buffer PyroCoarseRight { float coarse_right[]; };
LEVEL_COEFFICIENTS

shared float sums[256];

// In a closed box what flows in and out cannot be balanced by pressure that varies: all of the gas
// becomes denser or thinner, and pressure takes what is left.
float mean_of_right() {
#if PYRO_CLOSED
    int count = LEVEL_SIZE.x * LEVEL_SIZE.y * LEVEL_SIZE.z;
    float sum = 0.0;
    for (int i = int(gl_LocalInvocationIndex); i < count; i += 256) sum += coarse_right[level_first + i];
    sums[gl_LocalInvocationIndex] = sum;
    for (uint step_ = 128u; step_ > 0u; step_ >>= 1) {
        barrier();
        if (gl_LocalInvocationIndex < step_)
            sums[gl_LocalInvocationIndex] += sums[gl_LocalInvocationIndex + step_];
    }
    barrier();
    return sums[0] / float(count);
#else
    return 0.0;
#endif
}

#if PYRO_COARSEST_CELLS <= 2048
// A thread's cells stay with it, and their pressure lies in shared memory: a sweep waits for nothing else.
#define CELLS ((PYRO_COARSEST_CELLS + 255) / 256)
shared float found[PYRO_COARSEST_CELLS];

void main() {
    level_near near[CELLS];
    float right[CELLS];
    int colours[CELLS]; // 2: no cell
    ivec3 size = LEVEL_SIZE;
    float mean = mean_of_right();
    for (int k = 0; k < CELLS; k++) {
        int i = int(gl_LocalInvocationIndex) + 256 * k;
        colours[k] = 2;
        if (i >= PYRO_COARSEST_CELLS) continue;
        ivec3 c = ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y));
        level_near n = level_near_of(c);
        LEVEL_WEIGH(n)
        near[k] = n;
        right[k] = coarse_right[level_first + i] - mean;
        found[i] = coarse_pressure[level_first + i];
        if (n.all > 0.0) colours[k] = (c.x + c.y + c.z) & 1;
    }
    barrier();
#undef LEVEL_FIRST
#define LEVEL_FIRST 0 // in shared memory
    for (int half_ = 0; half_ < 2 * sweeps; half_++) {
        for (int k = 0; k < CELLS; k++) {
            if (colours[k] != (half_ & 1)) continue;
            int i = int(gl_LocalInvocationIndex) + 256 * k;
            float own = found[i], around;
            LEVEL_SUM(found, near[k], around)
            found[i] = own + relaxation * ((around - right[k]) / near[k].all - own);
        }
        barrier();
    }
    for (int i = int(gl_LocalInvocationIndex); i < PYRO_COARSEST_CELLS; i += 256) coarse_pressure[level_first + i] = found[i];
}
#else
void main() {
    ivec3 size = LEVEL_SIZE;
    int count = size.x * size.y * size.z;
    float mean = mean_of_right();
    for (int half_ = 0; half_ < 2 * sweeps; half_++) {
        for (int i = int(gl_LocalInvocationIndex); i < count; i += 256) {
            ivec3 c = ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y));
            if (((c.x + c.y + c.z + half_) & 1) != 0) continue;
            level_near n = level_near_of(c);
            LEVEL_WEIGH(n)
            int at = level_first + i;
            float own = coarse_pressure[at], around;
            LEVEL_SUM(coarse_pressure, n, around)
            if (n.all > 0.0)
                coarse_pressure[at] = own + relaxation * ((around - coarse_right[at] + mean) / n.all - own);
        }
        memoryBarrierBuffer();
        barrier();
    }
}
#endif
