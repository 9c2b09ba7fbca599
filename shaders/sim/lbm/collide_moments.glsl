// Collision of central moments: what has no trace among those of second order relaxes, all others
// go to equilibrium at once. That keeps the least viscosities stable.
// Geier, Greiner, Korvink, "Cascaded digital lattice Boltzmann automata for high Reynolds number
// flow", 2006. Their closed form: De Rosis, "Nonorthogonal central-moments-based lattice Boltzmann
// scheme in three dimensions", 2017 (D3Q27); De Rosis and Coreixas, "Multiphysics flow simulations
// using D3Q19 lattice Boltzmann methods based on central moments", 2020. A force in all orders:
// De Rosis, Huang, Coreixas, "Universal formulation of central-moments-based lattice Boltzmann
// method with external forcing for multiphysics simulations", 2019.
//
// In the frame that moves with the air, the moments after collision are: density d; half of the
// force, h; the stress s, and d / 3 along each axis; h / 3 of third and h / 9 of fifth order; d / 9
// of fourth and d / 27 of sixth. All others are 0.
#ifndef SIM_LBM_COLLIDE_MOMENTS_GLSL
#define SIM_LBM_COLLIDE_MOMENTS_GLSL

lbm_tensor lbm_relax(lbm_tensor s, lbm_float omega) {
    lbm_float keep = 1.0 - omega, mean = (s.xx + s.yy + s.zz) * (1.0 / 3.0);
    return lbm_tensor(keep * (s.xx - mean), keep * (s.yy - mean), keep * (s.zz - mean),
                      keep * s.xy, keep * s.xz, keep * s.yz);
}

lbm_vec lbm_half_force(lbm_air air) {
    return lbm_vec(0.5 * air.force.x, 0.5 * air.force.y, 0.5 * air.force.z);
}

void lbm_leave(out lbm_element q, lbm_float f) {
    q = lbm_pack(LBM_AIR_SCALE, f);
}

#if LBM_Q == 19
struct lbm_plane { // moments along two axes, a and b, in the frame at rest
    lbm_float ab, abb, baa, aabb; // the last less that of the weights
};

lbm_plane lbm_plane_of(lbm_float excess, lbm_float ua, lbm_float ub, lbm_float ha, lbm_float hb, lbm_float saa, lbm_float sbb, lbm_float sab) {
    lbm_float density = 1.0 + excess, kaa = density * (1.0 / 3.0) + saa, kbb = density * (1.0 / 3.0) + sbb;
    lbm_float ab = ua * hb, ba = ub * ha, mean = density * ua * ub + ab + ba;
    lbm_plane p;
    p.ab = mean + sab;
    p.abb = ha * (1.0 / 3.0) + ua * kbb + ub * (2.0 * sab + mean + ab);
    p.baa = hb * (1.0 / 3.0) + ub * kaa + ua * (2.0 * sab + mean + ba);
    p.aabb = excess * (1.0 / 9.0) + (ua * ha + ub * hb) * (2.0 / 3.0) + ua * ua * kbb + ub * ub * kaa +
             ua * ub * (4.0 * sab + mean + ab + ba);
    return p;
}

void lbm_collide(lbm_air air, lbm_float omega, inout lbm_element q[LBM_Q]) {
    lbm_float density = 1.0 + air.excess, third = air.excess * (1.0 / 3.0);
    lbm_vec u = air.u, h = lbm_half_force(air);
    lbm_tensor s = lbm_relax(air.stress, omega);
    lbm_float x = density * u.x + h.x, y = density * u.y + h.y, z = density * u.z + h.z;
    lbm_float xx = third + s.xx + u.x * (x + h.x), yy = third + s.yy + u.y * (y + h.y);
    lbm_float zz = third + s.zz + u.z * (z + h.z), rest = air.excess - xx - yy - zz;
#define SET(i, second, first)                                                                      \
    {                                                                                              \
        lbm_float even = 0.5 * (second), odd = 0.5 * (first);                                      \
        lbm_leave(q[i], even + odd);                                                               \
        lbm_leave(q[i + 1], even - odd);                                                           \
    }
// Directions `up` along (A, B) and `down` along (sign, -sign); what a plane has is not along an axis.
#define PLANE(A, B, AA, BB, AB, up, down, sign)                                                    \
    {                                                                                              \
        lbm_plane p = lbm_plane_of(air.excess, u.A, u.B, h.A, h.B, s.AA, s.BB, s.AB);              \
        SET(up, 0.5 * (p.aabb + p.ab), 0.5 * (p.abb + p.baa))                                      \
        SET(down, 0.5 * (p.aabb - p.ab), sign * 0.5 * (p.abb - p.baa))                             \
        rest += p.aabb;                                                                            \
        AA -= p.aabb;                                                                              \
        BB -= p.aabb;                                                                              \
        A -= p.abb;                                                                                \
        B -= p.baa;                                                                                \
    }
    PLANE(x, y, xx, yy, xy, 7, 9, 1.0)
    PLANE(x, z, xx, zz, xz, 11, 13, -1.0)
    PLANE(y, z, yy, zz, yz, 15, 17, -1.0)
#undef PLANE
    lbm_leave(q[0], rest);
    SET(1, xx, x)
    SET(3, yy, y)
    SET(5, zz, z)
#undef SET
}
#else
struct lbm_line { // along one axis: at rest, up, down
    lbm_float o, p, n;
};

// From moments of order 0, 1, 2 in the frame that moves with u to populations of one axis, these
// less `weight` times 2/3, 1/6, 1/6, the moments less `weight` times 1, 0, 1/3.
lbm_line lbm_line_of(lbm_float u, const float weight, lbm_float k0, lbm_float k1, lbm_float k2) {
    lbm_float au = (k0 + weight) * u, even = 0.5 * (u * (au + 2.0 * k1) + k2), odd = 0.5 * (au + k1);
    return lbm_line(k0 - 2.0 * even, even + odd, even - odd);
}

// Axis by axis: z, then y, then x. Of the order along x: `weight` is 1, 0 or 1/3.
struct lbm_slab {
    lbm_line o, p, n; // along y, each along z
};

lbm_slab lbm_slab_of(lbm_float u, const float weight, lbm_line k0, lbm_line k1, lbm_line k2) {
    lbm_line o = lbm_line_of(u, weight * (2.0 / 3.0), k0.o, k1.o, k2.o);
    lbm_line p = lbm_line_of(u, weight * (1.0 / 6.0), k0.p, k1.p, k2.p);
    lbm_line n = lbm_line_of(u, weight * (1.0 / 6.0), k0.n, k1.n, k2.n);
    return lbm_slab(lbm_line(o.o, p.o, n.o), lbm_line(o.p, p.p, n.p), lbm_line(o.n, p.n, n.n));
}

void lbm_collide(lbm_air air, lbm_float omega, inout lbm_element q[LBM_Q]) {
    const float third = 1.0 / 3.0, ninth = 1.0 / 9.0;
    lbm_vec u = air.u, h = lbm_half_force(air);
    lbm_tensor s = lbm_relax(air.stress, omega);
    lbm_float e = air.excess, e3 = third * e, e9 = ninth * e, none = lbm_float(0.0);
    lbm_slab k0 = lbm_slab_of(u.y, 1.0, lbm_line_of(u.z, 1.0, e, h.z, e3 + s.zz),
                              lbm_line_of(u.z, 0.0, h.y, s.yz, third * h.y),
                              lbm_line_of(u.z, third, e3 + s.yy, third * h.z, e9));
    lbm_slab k1 = lbm_slab_of(u.y, 0.0, lbm_line_of(u.z, 0.0, h.x, s.xz, third * h.x),
                              lbm_line_of(u.z, 0.0, s.xy, none, none),
                              lbm_line_of(u.z, 0.0, third * h.x, none, ninth * h.x));
    lbm_slab k2 = lbm_slab_of(u.y, third, lbm_line_of(u.z, third, e3 + s.xx, third * h.z, e9),
                              lbm_line_of(u.z, 0.0, third * h.y, none, ninth * h.y),
                              lbm_line_of(u.z, ninth, e9, ninth * h.z, third * e9));
#define SET(Y, Z, weight, rest, up, down)                                                          \
    {                                                                                              \
        lbm_line line = lbm_line_of(u.x, weight, k0.Y.Z, k1.Y.Z, k2.Y.Z);                          \
        lbm_leave(q[rest], line.o);                                                                \
        lbm_leave(q[up], line.p);                                                                  \
        lbm_leave(q[down], line.n);                                                                \
    }
    SET(o, o, 4.0 / 9.0, 0, 1, 2)
    SET(p, o, 1.0 / 9.0, 3, 7, 10)
    SET(n, o, 1.0 / 9.0, 4, 9, 8)
    SET(o, p, 1.0 / 9.0, 5, 11, 13)
    SET(o, n, 1.0 / 9.0, 6, 14, 12)
    SET(p, p, 1.0 / 36.0, 15, 19, 21)
    SET(n, n, 1.0 / 36.0, 16, 22, 20)
    SET(n, p, 1.0 / 36.0, 17, 23, 25)
    SET(p, n, 1.0 / 36.0, 18, 26, 24)
#undef SET
}
#endif

#endif
