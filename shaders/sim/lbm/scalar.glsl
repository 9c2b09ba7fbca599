// Collision of a scalar that the air carries, in four cells.
#ifndef SIM_LBM_SCALAR_GLSL
#define SIM_LBM_SCALAR_GLSL
#include "sim/lbm/state.glsl"

vec4 lbm_sum_scalar(vec4 g[LBM_SCALAR_Q]) {
    vec4 value = g[0];
#define SUM(i, x, y, z) value += g[i] + g[i + 1];
    LBM_SCALAR_PAIRS(SUM)
#undef SUM
    return value;
}

// `keep`: of the difference to ambient, what is left after the step.
#if LBM_SCALAR_Q == 27
// BGK, as published.
void lbm_collide_scalar(vec4 value, lbm_vec u, vec4 omega, float keep, float ambient, inout vec4 g[LBM_SCALAR_Q]) {
    vec4 same = value * (1.0 - 1.5 * lbm_dot(u, u));
    float gone = (1.0 - keep) * ambient;
    g[0] = keep * (g[0] + omega * (LBM_SCALAR_REST * same - g[0])) + LBM_SCALAR_REST * gone;
#define COLLIDE(i, x, y, z)                                                                        \
    {                                                                                              \
        vec4 along = LBM_ALONG(u, x, y, z);                                                        \
        vec4 even = LBM_SCALAR_WEIGHT(x, y, z) * (same + value * 4.5 * along * along);             \
        vec4 odd = LBM_SCALAR_WEIGHT(x, y, z) * 3.0 * value * along;                               \
        float back = LBM_SCALAR_WEIGHT(x, y, z) * gone;                                            \
        g[i] = keep * (g[i] + omega * (even + odd - g[i])) + back;                                 \
        g[i + 1] = keep * (g[i + 1] + omega * (even - odd - g[i + 1])) + back;                     \
    }
    LBM_SCALAR_PAIRS(COLLIDE)
#undef COLLIDE
}
#else
// Moments: the flux relaxes, the second moments go to equilibrium. A flux of more than a quarter of
// the value would make a population negative: it is kept below, so that values never fall below 0.
void lbm_collide_scalar(vec4 value, lbm_vec u, vec4 omega, float keep, float ambient, inout vec4 g[LBM_SCALAR_Q]) {
    vec4 most = LBM_SCALAR_SPEED * abs(value), same = LBM_SCALAR_REST * (keep * value + (1.0 - keep) * ambient);
    g[0] = same;
#define COLLIDE(i, x, y, z)                                                                        \
    {                                                                                              \
        vec4 flux = g[i] - g[i + 1];                                                               \
        flux += omega * (value * LBM_ALONG(u, x, y, z) - flux);                                    \
        flux = keep * clamp(flux, -most, most);                                                    \
        g[i] = 0.5 * (same + flux);                                                                \
        g[i + 1] = 0.5 * (same - flux);                                                            \
    }
    LBM_SCALAR_PAIRS(COLLIDE)
#undef COLLIDE
}
#endif

#endif
