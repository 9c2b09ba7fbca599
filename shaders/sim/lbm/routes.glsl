// A scalar on D3Q7 beside bodies, where it goes with what the links of the air carry instead of with
// the velocity. The air passes staircases by 18 or 26 links, of which a scalar has six: what these
// would carry by the velocity does not add up to 0 even where the flow is steady, and smoke that was
// even grows thick in one cell and thin in the next. A tracer stays even when its fluxes are those of
// the mass: Lin and Rood, "Multidimensional flux-form semi-Lagrangian transport schemes", Mon.
// Weather Rev. 124, 1996. Those are known here, what a cell sends along a link less what comes back by
// it: Koerner et al., "Lattice Boltzmann model for free surface flow for modeling foaming", J. Stat.
// Phys. 121, 2005.
//
// What goes along an edge or a corner takes axes instead: a half by the one cell between and a half
// by the other, or all of it by the one that is air. The cell that it leaves answers for the first
// step of the way, the one that it reaches for the last. So each cell needs to know its own links
// alone, and in a steady flow all that enters a cell leaves it again. (Of the three steps of a corner
// the one in the middle is counted to the others.)
//
// All of the scalar but these fluxes goes to equilibrium at once, since what is left of earlier fluxes
// tells of the shear beside walls more than of edges in the smoke.
#ifndef SIM_LBM_ROUTES_GLSL
#define SIM_LBM_ROUTES_GLSL
#include "sim/lbm/bodies.glsl"

#if LBM_ROUTES
lbm_float lbm_routes[6]; // what goes out: +x -x +y -y +z -z

// 1 where the cell there is air.
lbm_float lbm_opens(const int x, const int y, const int z) {
    return lbm_float(1u - (lbm_solids >> LBM_DIRECTION(x, y, z) & 1u));
}

// `mass` leaves by a link. Half of what passes a link of an axis is said by the cell at its other end, hence
// the factors: of two ways 1 each, of one alone 2.
void lbm_route(const int x, const int y, const int z, lbm_float mass) {
    lbm_float none = lbm_float(0.0);
    lbm_float by_x = x == 0 ? none : lbm_opens(x, 0, 0);
    lbm_float by_y = y == 0 ? none : lbm_opens(0, y, 0);
    lbm_float by_z = z == 0 ? none : lbm_opens(0, 0, z), ways = by_x + by_y + by_z;
    mass *= lbm_opens(x, y, z);
    const int steps = x * x + y * y + z * z;
    if (steps == 2) mass *= 3.0 - ways; // without a way it goes nowhere
    if (steps == 3) mass *= 3.0 / max(ways, lbm_float(1.0));
    if (x != 0) lbm_routes[x > 0 ? 0 : 1] += by_x * mass;
    if (y != 0) lbm_routes[y > 0 ? 2 : 3] += by_y * mass;
    if (z != 0) lbm_routes[z > 0 ? 4 : 5] += by_z * mass;
}

// Before the air collides: what has come.
void lbm_begin_routes(lbm_element q[LBM_Q]) {
    for (int i = 0; i < 6; i++) lbm_routes[i] = lbm_float(0.0);
#define ARRIVE(i, x, y, z)                                                                         \
    lbm_route(x, y, z, -lbm_unpack(q[i + 1], LBM_AIR_SCALE));                                      \
    lbm_route(-(x), -(y), -(z), -lbm_unpack(q[i], LBM_AIR_SCALE));
    LBM_PAIRS(ARRIVE)
#undef ARRIVE
}

// After it: what goes. Makes velocities of it all; into solids, whence it comes back, that of the air.
void lbm_end_routes(lbm_element q[LBM_Q], lbm_float density, lbm_vec u) {
#define LEAVE(i, x, y, z)                                                                          \
    lbm_route(x, y, z, lbm_unpack(q[i], LBM_AIR_SCALE));                                           \
    lbm_route(-(x), -(y), -(z), lbm_unpack(q[i + 1], LBM_AIR_SCALE));
    LBM_PAIRS(LEAVE)
#undef LEAVE
    lbm_float volume = 1.0 / density;
#define END(i, x, y, z)                                                                            \
    lbm_routes[i - 1] = mix(LBM_ALONG(u, x, y, z), volume * lbm_routes[i - 1], lbm_opens(x, y, z)); \
    lbm_routes[i] = mix(-LBM_ALONG(u, x, y, z), volume * lbm_routes[i], lbm_opens(-(x), -(y), -(z)));
    LBM_AXES(END)
#undef END
}

// What collision makes of a scalar, in the lanes. As in scalar.glsl nothing is sent that is not there.
void lbm_route_scalar(lbm_float value, uint lanes, float keep, float ambient, inout lbm_float g[LBM_SCALAR_Q]) {
    lbm_float most = LBM_SCALAR_SPEED * abs(value), all = keep * value + (1.0 - keep) * ambient;
    lbm_float same = LBM_SCALAR_REST * all, sum = lbm_float(0.0), made[LBM_SCALAR_Q];
    for (int i = 1; i < LBM_SCALAR_Q; i++) {
        made[i] = 0.5 * (same + keep * clamp(value * lbm_routes[i - 1], -most, most));
        sum += made[i];
    }
    lbm_float part = min(abs(all) / max(abs(sum), 1e-30), lbm_float(1.0));
    lbm_bool here = lbm_in_lanes(lanes);
    g[0] = mix(g[0], all - part * sum, here);
    for (int i = 1; i < LBM_SCALAR_Q; i++) g[i] = mix(g[i], part * made[i], here);
}
#endif

#endif
