// Collision of a scalar that the air carries, in the cells of an element.
#ifndef SIM_LBM_SCALAR_GLSL
#define SIM_LBM_SCALAR_GLSL
#include "sim/lbm/state.glsl"

lbm_float lbm_sum_scalar(lbm_element q[LBM_SCALAR_Q]) {
    lbm_float value = lbm_unpack(q[0], LBM_SCALAR_SCALE);
#define SUM(i, x, y, z)                                                                            \
    value += lbm_unpack(q[i], LBM_SCALAR_SCALE) + lbm_unpack(q[i + 1], LBM_SCALAR_SCALE);
    LBM_SCALAR_PAIRS(SUM)
#undef SUM
    return value;
}

// `keep`: of the difference to ambient, what is left after the step.
#if LBM_SCALAR_Q == 27
// BGK, as published.
void lbm_collide_scalar(lbm_float value, lbm_vec u, lbm_float omega, float keep, float ambient, inout lbm_float g[LBM_SCALAR_Q]) {
    lbm_float same = value * (1.0 - 1.5 * lbm_dot(u, u));
    float gone = (1.0 - keep) * ambient;
    g[0] = keep * (g[0] + omega * (LBM_SCALAR_REST * same - g[0])) + LBM_SCALAR_REST * gone;
#define COLLIDE(i, x, y, z)                                                                        \
    {                                                                                              \
        lbm_float along = LBM_ALONG(u, x, y, z);                                                   \
        lbm_float even = LBM_SCALAR_WEIGHT(x, y, z) * (same + value * 4.5 * along * along);        \
        lbm_float odd = LBM_SCALAR_WEIGHT(x, y, z) * 3.0 * value * along;                          \
        float back = LBM_SCALAR_WEIGHT(x, y, z) * gone;                                            \
        g[i] = keep * (g[i] + omega * (even + odd - g[i])) + back;                                 \
        g[i + 1] = keep * (g[i + 1] + omega * (even - odd - g[i + 1])) + back;                     \
    }
    LBM_SCALAR_PAIRS(COLLIDE)
#undef COLLIDE
}
#else
// Moments: the flux relaxes, the second moments go to equilibrium at once.
//
// Where relaxation is fast, sharp edges ring. What of the flux is not of the flow tells how steep
// they are: as a part of the most that keeps populations above 0, it is half of the relative change
// from cell to cell. Near 1 and beyond, the flux is damped; and cut to that most, so that values
// never fall below 0. Smooth parts are left as they are, since damping goes with the eighth power.
// src/sim/README.md has figures.
#define LBM_EDGE_DAMPING 16.0

void lbm_collide_scalar(lbm_float value, lbm_vec u, lbm_float omega, float keep, float ambient, inout lbm_float g[LBM_SCALAR_Q]) {
    lbm_float most = LBM_SCALAR_SPEED * abs(value), same = LBM_SCALAR_REST * (keep * value + (1.0 - keep) * ambient);
    lbm_vec flow = lbm_vec(value * u.x, value * u.y, value * u.z);
    lbm_vec beside = lbm_vec(g[1] - g[2] - flow.x, g[3] - g[4] - flow.y, g[5] - g[6] - flow.z);
    lbm_float edge = lbm_dot(beside, beside) / max(most * most, 1e-30);
    edge *= edge;
    lbm_float left = (1.0 - omega) / (1.0 + LBM_EDGE_DAMPING * edge * edge);
    g[0] = same;
#define COLLIDE(i, x, y, z)                                                                        \
    {                                                                                              \
        lbm_float flux = LBM_ALONG(flow, x, y, z) + left * LBM_ALONG(beside, x, y, z);             \
        flux = keep * clamp(flux, -most, most);                                                    \
        g[i] = 0.5 * (same + flux);                                                                \
        g[i + 1] = 0.5 * (same - flux);                                                            \
    }
    LBM_SCALAR_PAIRS(COLLIDE)
#undef COLLIDE
}
#endif

#endif
