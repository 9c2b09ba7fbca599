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
#define LEVEL_FIRST 0
ivec3 level_places(ivec3 i) {
    return pyro_places(i);
}
#else
uniform vec3 level_size;
uniform int level_first;
#define LEVEL_SIZE ivec3(level_size)
#define LEVEL_FIRST level_first
ivec3 level_places(ivec3 i) {
    return i * ivec3(1, LEVEL_SIZE.x, LEVEL_SIZE.x * LEVEL_SIZE.y);
}
#endif

int level_at(ivec3 c) {
    ivec3 p = level_places(c);
    return LEVEL_FIRST + p.x + p.y + p.z;
}

const vec3 LEVEL_OPEN_LOW = vec3(PYRO_LOW_X == PYRO_OPEN, PYRO_LOW_Y == PYRO_OPEN, PYRO_LOW_Z == PYRO_OPEN);
const vec3 LEVEL_OPEN_HIGH = vec3(PYRO_HIGH_X == PYRO_OPEN, PYRO_HIGH_Y == PYRO_OPEN, PYRO_HIGH_Z == PYRO_OPEN);

// The neighbours of a cell, as places, and the weight of each: 0 where there is none.
struct level_near {
    ivec3 cell, below, above;
    vec3 low, high;
    vec3 outside_low, outside_high; // weights of pressure outside open faces
    float all;                      // the sum of all weights
};

// Outside an open face pressure is that of the surroundings, 0, half a cell away.
level_near level_near_of(ivec3 c) {
    level_near n;
    ivec3 last = LEVEL_SIZE - 1;
    bvec3 first = both(equal(c, ivec3(0)), not(PYRO_AROUND));
    bvec3 end = both(equal(c, last), not(PYRO_AROUND));
    n.cell = level_places(c);
    n.below = level_places(mix(max(c - 1, ivec3(0)), last, both(equal(c, ivec3(0)), PYRO_AROUND)));
    n.above = level_places(mix(min(c + 1, last), ivec3(0), both(equal(c, last), PYRO_AROUND)));
    n.low = mix(weights, vec3(0.0), first);
    n.high = mix(weights, vec3(0.0), end);
    n.outside_low = 2.0 * weights * LEVEL_OPEN_LOW * vec3(first);
    n.outside_high = 2.0 * weights * LEVEL_OPEN_HIGH * vec3(end);
    n.all = dot(n.low + n.high + n.outside_low + n.outside_high, vec3(1.0));
    return n;
}

// Solids close faces, in part where the level is coarse; light gas crosses them more easily.
#if PYRO_WEIGHED
#define LEVEL_COEFFICIENTS layout(std430) readonly buffer PyroCoefficients { PYRO_COEFFICIENTS coefficients[]; };
#if PYRO_VARIABLE
#define LEVEL_WEIGH_OUTSIDE(n, low_, high_)                                                        \
    n.all -= dot(n.outside_low * (1.0 - low_) + n.outside_high * (1.0 - high_), vec3(1.0));
#else
#define LEVEL_WEIGH_OUTSIDE(n, low_, high_)
#endif
#define LEVEL_WEIGH(n)                                                                             \
    {                                                                                              \
        int xy_ = LEVEL_FIRST + n.cell.x + n.cell.y, z_ = LEVEL_FIRST + n.cell.z;                  \
        vec3 low_ = pyro_coefficients(coefficients[xy_ + n.cell.z]).xyz;                                           \
        vec3 high_ = vec3(pyro_coefficients(coefficients[z_ + n.cell.y + n.above.x]).x,                            \
                          pyro_coefficients(coefficients[z_ + n.cell.x + n.above.y]).y,                            \
                          pyro_coefficients(coefficients[xy_ + n.above.z]).z);                                     \
        n.all -= dot(n.low * (1.0 - low_) + n.high * (1.0 - high_), vec3(1.0));                    \
        LEVEL_WEIGH_OUTSIDE(n, low_, high_)                                                        \
        n.low *= low_;                                                                             \
        n.high *= high_;                                                                           \
        if (low_ + high_ == vec3(0.0)) n.all = 0.0;                                                \
    }
#else
#define LEVEL_COEFFICIENTS
#define LEVEL_WEIGH(n)
#endif

// The sum of the neighbours, each by its weight.
#define LEVEL_SUM(from, n, sum)                                                                    \
    {                                                                                              \
        int xy_ = LEVEL_FIRST + n.cell.x + n.cell.y, z_ = LEVEL_FIRST + n.cell.z;                  \
        sum = n.low.x * from[z_ + n.cell.y + n.below.x] + n.high.x * from[z_ + n.cell.y + n.above.x] + \
              n.low.y * from[z_ + n.cell.x + n.below.y] + n.high.y * from[z_ + n.cell.x + n.above.y] + \
              n.low.z * from[xy_ + n.below.z] + n.high.z * from[xy_ + n.above.z];                  \
    }
int level_at(level_near n) {
    return LEVEL_FIRST + n.cell.x + n.cell.y + n.cell.z;
}
#endif
