// BGK and TRT: the even and the odd parts of each pair go to an equilibrium of second order, each
// at its own rate. Ginzburg, Verhaeghe, d'Humieres, "Two-relaxation-time lattice Boltzmann scheme",
// 2008. Forces: Guo, Zheng, Shi, "Discrete lattice effects on the forcing term in the lattice
// Boltzmann method", 2002, eq. 20.
#ifndef SIM_LBM_COLLIDE_PAIRS_GLSL
#define SIM_LBM_COLLIDE_PAIRS_GLSL

#if LBM_TRT
// With this product of (tau - 1/2) of both rates, walls stand half way between cells whatever the
// viscosity (Ginzburg and d'Humieres, 2003).
#define LBM_MAGIC (3.0 / 16.0)
lbm_float lbm_odd_rate(lbm_float omega) {
    lbm_float over = 1.0 / omega - 0.5;
    return over / (LBM_MAGIC + 0.5 * over);
}
#else
lbm_float lbm_odd_rate(lbm_float omega) {
    return omega;
}
#endif

void lbm_collide(lbm_air a, lbm_float omega, inout lbm_element q[LBM_Q]) {
    lbm_float density = 1.0 + a.excess, odd_omega = lbm_odd_rate(omega);
    lbm_float same = a.excess - density * 1.5 * lbm_dot(a.u, a.u);
#if LBM_WEIGHTS_ONLY
    lbm_float even_push = lbm_float(0.0), odd_push = lbm_float(3.0), same_push = lbm_float(0.0);
#else
    lbm_float even_push = 9.0 - 4.5 * omega, odd_push = 3.0 - 1.5 * odd_omega;
    lbm_float same_push = (1.5 * omega - 3.0) * lbm_dot(a.u, a.force);
#endif
    lbm_float rest = lbm_unpack(q[0], LBM_AIR_SCALE);
    q[0] = lbm_pack(LBM_AIR_SCALE, rest + omega * (LBM_REST * same - rest) + LBM_REST * same_push);
#define COLLIDE(i, x, y, z)                                                                        \
    {                                                                                              \
        lbm_float up = lbm_unpack(q[i], LBM_AIR_SCALE), down = lbm_unpack(q[i + 1], LBM_AIR_SCALE); \
        lbm_float along = LBM_ALONG(a.u, x, y, z), push = LBM_ALONG(a.force, x, y, z);             \
        lbm_float even = LBM_WEIGHT(x, y, z) * (same + density * 4.5 * along * along);             \
        lbm_float odd = LBM_WEIGHT(x, y, z) * 3.0 * density * along;                               \
        even = omega * (even - 0.5 * (up + down)) +                                                \
               LBM_WEIGHT(x, y, z) * (same_push + even_push * along * push);                       \
        odd = odd_omega * (odd - 0.5 * (up - down)) + LBM_WEIGHT(x, y, z) * odd_push * push;       \
        q[i] = lbm_pack(LBM_AIR_SCALE, up + even + odd);                                           \
        q[i + 1] = lbm_pack(LBM_AIR_SCALE, down + even - odd);                                     \
    }
    LBM_PAIRS(COLLIDE)
#undef COLLIDE
}

#endif
