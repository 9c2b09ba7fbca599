// Collision in the cells of an element: what arrives becomes what leaves. Populations are less their weights, so
// that small differences keep their digits; `excess` is the density less 1.
#ifndef SIM_LBM_COLLIDE_GLSL
#define SIM_LBM_COLLIDE_GLSL
#include "sim/lbm/state.glsl"

struct lbm_tensor { // symmetric
    lbm_float xx, yy, zz, xy, xz, yz;
};

struct lbm_air {
    lbm_float excess;
    lbm_vec u;        // with half of what the force adds
    lbm_vec force;    // on a cell
    lbm_tensor stress; // second central moments, less those of equilibrium
};

struct lbm_sums { // of populations, by direction, and products of directions
    lbm_float excess;
    lbm_vec momentum;
    lbm_tensor second;
};

void lbm_add_pair(const int X, const int Y, const int Z, lbm_float up, lbm_float down, inout lbm_sums s) {
    lbm_float even = up + down, odd = up - down;
    s.excess += even;
    if (X != 0) s.momentum.x += float(X) * odd;
    if (Y != 0) s.momentum.y += float(Y) * odd;
    if (Z != 0) s.momentum.z += float(Z) * odd;
    if (X != 0) s.second.xx += even;
    if (Y != 0) s.second.yy += even;
    if (Z != 0) s.second.zz += even;
    if (X * Y != 0) s.second.xy += float(X * Y) * even;
    if (X * Z != 0) s.second.xz += float(X * Z) * even;
    if (Y * Z != 0) s.second.yz += float(Y * Z) * even;
}

lbm_sums lbm_begin_sums(lbm_float rest) {
    lbm_float none = lbm_float(0.0);
    return lbm_sums(rest, lbm_vec(none, none, none), lbm_tensor(none, none, none, none, none, none));
}

// Pair by pair, so that few unpacked ones need registers at a time.
lbm_sums lbm_sum(lbm_element q[LBM_Q]) {
    lbm_sums s = lbm_begin_sums(lbm_unpack(q[0], LBM_AIR_SCALE));
#define SUM(i, x, y, z)                                                                            \
    lbm_add_pair(x, y, z, lbm_unpack(q[i], LBM_AIR_SCALE), lbm_unpack(q[i + 1], LBM_AIR_SCALE), s);
    LBM_PAIRS(SUM)
#undef SUM
    return s;
}

// The part of the second moments that equilibrium has not, in the frame that moves with u, where
// half of the force's momentum is still missing.
lbm_tensor lbm_stress(lbm_tensor second, lbm_float excess, lbm_vec u, lbm_vec force) {
    lbm_float density = 1.0 + excess, third = excess * (1.0 / 3.0);
    lbm_vec m = lbm_vec(density * u.x - force.x, density * u.y - force.y, density * u.z - force.z);
    lbm_vec h = lbm_vec(0.5 * force.x, 0.5 * force.y, 0.5 * force.z);
    return lbm_tensor(second.xx - third - u.x * m.x, second.yy - third - u.y * m.y,
                      second.zz - third - u.z * m.z,
                      second.xy - u.x * (m.y + h.y) + u.y * h.x,
                      second.xz - u.x * (m.z + h.z) + u.z * h.x,
                      second.yz - u.y * (m.z + h.z) + u.z * h.y);
}

#if LBM_SUBGRID
// Hou, Sterling, Chen, Doolen, "A lattice Boltzmann subgrid model for high Reynolds number flows",
// 1996, eqs. 15 to 17: the relaxation time with the eddies' part, from the stress at hand.
lbm_float lbm_eddy_tau(lbm_air a, float tau, float constant) {
    lbm_tensor s = a.stress;
    lbm_float off = s.xy * s.xy + s.xz * s.xz + s.yz * s.yz;
    lbm_float norm = sqrt(s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + 2.0 * off);
    float factor = 18.0 * sqrt(2.0) * constant * constant;
    return 0.5 * (tau + sqrt(tau * tau + factor * norm / (1.0 + a.excess)));
}
#endif

#if LBM_CENTRAL_MOMENTS
#include "sim/lbm/collide_moments.glsl"
#else
#include "sim/lbm/collide_pairs.glsl"
#endif

#endif
