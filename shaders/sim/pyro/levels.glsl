// Pressure on the levels of multigrid. The finest one lies in bricks, as the state does; each other
// one lies row by row, in a buffer that holds them all, and has half as many cells along the axes
// along which it is coarser. Pressure is that times the step and by density and side of a cell, m/s:
// what it takes from the velocity of a face is the difference of two cells. Right-hand sides are
// what flows out of a cell too much, m/s.
#ifndef SIM_PYRO_LEVELS_GLSL
#define SIM_PYRO_LEVELS_GLSL

uniform vec3 weights; // of differences along each axis: by the square of the distance of two cells

#ifdef PYRO_FINEST
#define LEVEL_SIZE PYRO_SIZE
int level_at(ivec3 c) {
    return pyro_at(c);
}
#else
uniform vec3 level_size;
uniform int level_first;
#define LEVEL_SIZE ivec3(level_size)
int level_at(ivec3 c) {
    return level_first + c.x + LEVEL_SIZE.x * (c.y + LEVEL_SIZE.y * c.z);
}
#endif

// The sum of the neighbours of a cell, each by its weight, and of the weights. Outside an open face
// pressure is that of the surroundings, 0, half a cell away.
#define LEVEL_AROUND(name, from)                                                                   \
    vec2 name(ivec3 c) {                                                                           \
        vec2 sum = vec2(0.0);                                                                      \
        for (int axis = 0; axis < 3; axis++)                                                       \
            for (int side = 0; side < 2; side++) {                                                 \
                ivec3 n = c;                                                                       \
                n[axis] += 2 * side - 1;                                                           \
                int face = side == 0 ? PYRO_LOW[axis] : PYRO_HIGH[axis];                           \
                float w = weights[axis];                                                           \
                bool outside = n[axis] < 0 || n[axis] >= LEVEL_SIZE[axis];                         \
                if (outside && face == PYRO_PERIODIC) {                                            \
                    n[axis] = side == 0 ? LEVEL_SIZE[axis] - 1 : 0;                                \
                    outside = false;                                                               \
                }                                                                                  \
                if (outside) {                                                                     \
                    sum.y += face == PYRO_OPEN ? 2.0 * w : 0.0;                                    \
                } else {                                                                           \
                    sum += w * vec2(from[level_at(n)], 1.0);                                       \
                }                                                                                  \
            }                                                                                      \
        return sum;                                                                                \
    }
#endif
