// Boundaries within a step: what arrives from beyond faces and from bodies that move, before
// collision, and what stays in solid cells, after it.
//
// Solid cells keep what arrives: no place that they read is written. What a cell of air sends into
// one is then what arrives from there two steps later: bounce-back with the wall half way between the
// two, by which a steady flow is that of half-way bounce-back, and the way back takes the time of
// full-way bounce-back. Links within a solid are never read.
//
// Cells at faces that air can pass or slide along are wet: what would arrive from beyond is replaced,
// then they collide like all others.
//   slip: mirrored in the face, which lies in the middle of these cells. So are, where two faces meet,
//     those of the second one, x before y before z.
//   inflow: of the given velocity, with the density that follows from what arrives from within: Zou
//     and He, "On pressure and velocity boundary conditions for the lattice Boltzmann BGK model",
//     1997, eq. 19.
//   open: velocity and density from the same relation and a wave that comes in from outside, which
//     is none: Izquierdo and Fueyo, "Characteristic nonreflecting boundary conditions for open
//     boundaries in lattice Boltzmann methods", 2008, without the terms along the face. The wave is
//     remembered and tends, slowly, to what makes the density 1 (air leaves), or the velocity that of
//     the wind (the wind enters): Poinsot and Lele, "Boundary conditions for direct simulations of
//     compressible viscous flows", 1992, eq. 40.
// The populations of both are equilibrium and the stress at hand: Latt, Chopard, Malaspinas, Deville,
// Michler, "Straight velocity boundaries in the lattice Boltzmann method", 2008, section III C.
#ifndef SIM_LBM_WALLS_GLSL
#define SIM_LBM_WALLS_GLSL
#include "sim/lbm/routes.glsl"

// ---- solids -----------------------------------------------------------------------------------

// In lanes of solids, what arrived takes the place of what collision made of it.
void lbm_keep_air(uint solid, lbm_element arrived[LBM_Q], inout lbm_element q[LBM_Q]) {
    q[0] = lbm_choose(q[0], arrived[0], solid);
#define KEEP(i, x, y, z)                                                                           \
    q[i] = lbm_choose(q[i], arrived[i + 1], solid);                                                \
    q[i + 1] = lbm_choose(q[i + 1], arrived[i], solid);
    LBM_PAIRS(KEEP)
#undef KEEP
}

void lbm_keep_scalar(uint solid, lbm_element arrived[LBM_SCALAR_Q], inout lbm_element q[LBM_SCALAR_Q]) {
    q[0] = lbm_choose(q[0], arrived[0], solid);
#define KEEP(i, x, y, z)                                                                           \
    q[i] = lbm_choose(q[i], arrived[i + 1], solid);                                                \
    q[i + 1] = lbm_choose(q[i + 1], arrived[i], solid);
    LBM_SCALAR_PAIRS(KEEP)
#undef KEEP
}

// ---- faces ------------------------------------------------------------------------------------

#if LBM_RIMS // there are faces that are neither periodic nor walls

uniform vec4 lbm_face_velocity[6]; // of inflow, and of the wind at open faces
uniform vec4 lbm_face_scalar[6];   // of inflow

// The wave that comes in at each cell of an open face: velocity outward less LBM_SOUND times the
// excess. Of all elements there, by face.
layout(std430) buffer LbmWaves { lbm_float lbm_waves[]; };

const float LBM_SOUND = 0.57735027;
const float LBM_FACE_SPEED = 0.3;  // greatest across a face
const float LBM_WAVE_PULL = 0.25;  // sigma of Poinsot and Lele, 0.25 there as well

struct lbm_rim {  // lanes at faces
    int face;     // that air passes; -1: none
    lbm_bool lanes;  // where
    lbm_bool x_low, x_high, y_low, y_high, z_low, z_high; // at faces that mirror
};

bool lbm_at_rim(uvec3 at) {
    return LBM_FACE_0 >= 2 && at.x == 0u || LBM_FACE_1 >= 2 && at.x == LBM_NX - 1u ||
           LBM_FACE_2 >= 2 && at.y == 0u || LBM_FACE_3 >= 2 && at.y == LBM_NY - 1u ||
           LBM_FACE_4 >= 2 && at.z == 0u || LBM_FACE_5 >= 2 && at.z == LBM_LAYERS - 1u;
}

lbm_rim lbm_rim_at(uvec3 at) {
    lbm_rim r = lbm_rim(-1, lbm_bool(true), lbm_bool(false), lbm_bool(false), lbm_bool(false), lbm_bool(false),
                        lbm_bool(false), lbm_bool(false));
#define FACE(k, here, mirror)                                                                      \
    if (LBM_FACE_##k >= 2 && (here)) {                                                             \
        if (LBM_FACE_IS_OPEN(LBM_FACE_##k) && r.face < 0) r.face = k;                              \
        else mirror = lbm_bool(true);                                                              \
    }
    FACE(0, at.x == 0u, r.x_low)
    FACE(1, at.x == LBM_NX - 1u, r.x_high)
    FACE(2, at.y == 0u, r.y_low)
    FACE(3, at.y == LBM_NY - 1u, r.y_high)
#undef FACE
#define FACE(k, layer, lane, mirror)                                                               \
    if (LBM_FACE_##k >= 2 && at.z == layer) {                                                      \
        lbm_bool here = lbm_in_lanes(lane);                                                        \
        if (LBM_FACE_IS_OPEN(LBM_FACE_##k) && r.face < 0) {                                        \
            r.face = k;                                                                            \
            r.lanes = here;                                                                        \
        } else {                                                                                   \
            mirror = here;                                                                         \
        }                                                                                          \
    }
    FACE(4, 0u, 1u, r.z_low)
    FACE(5, LBM_LAYERS - 1u, LBM_LAST_LANE, r.z_high)
#undef FACE
    return r;
}

#if LBM_Q == 27
#define LBM_MIRRORS_X LBM_MIRRORS_27_X
#define LBM_MIRRORS_Y LBM_MIRRORS_27_Y
#define LBM_MIRRORS_Z LBM_MIRRORS_27_Z
#else
#define LBM_MIRRORS_X LBM_MIRRORS_19_X
#define LBM_MIRRORS_Y LBM_MIRRORS_19_Y
#define LBM_MIRRORS_Z LBM_MIRRORS_19_Z
#endif
#if LBM_SCALAR_Q == 27
#define LBM_SCALAR_MIRRORS_X LBM_MIRRORS_27_X
#define LBM_SCALAR_MIRRORS_Y LBM_MIRRORS_27_Y
#define LBM_SCALAR_MIRRORS_Z LBM_MIRRORS_27_Z
#else
#define LBM_SCALAR_MIRRORS_X(M) M(1, 2)
#define LBM_SCALAR_MIRRORS_Y(M) M(3, 4)
#define LBM_SCALAR_MIRRORS_Z(M) M(5, 6)
#endif

// What flies away from a face from what flies towards it: a goes up along the axis, b down.
#define LBM_MIRROR(F, a, b, low, high)                                                             \
    {                                                                                              \
        lbm_float up = F[a], down = F[b];                                                          \
        F[a] = mix(up, down, low);                                                                 \
        F[b] = mix(down, up, high);                                                                \
    }

void lbm_mirror_air(lbm_rim r, inout lbm_float f[LBM_Q]) {
#define MIRROR(a, b) LBM_MIRROR(f, a, b, r.x_low, r.x_high)
    LBM_MIRRORS_X(MIRROR)
#undef MIRROR
#define MIRROR(a, b) LBM_MIRROR(f, a, b, r.y_low, r.y_high)
    LBM_MIRRORS_Y(MIRROR)
#undef MIRROR
#define MIRROR(a, b) LBM_MIRROR(f, a, b, r.z_low, r.z_high)
    LBM_MIRRORS_Z(MIRROR)
#undef MIRROR
}

void lbm_mirror_scalar(lbm_rim r, inout lbm_float g[LBM_SCALAR_Q]) {
#define MIRROR(a, b) LBM_MIRROR(g, a, b, r.x_low, r.x_high)
    LBM_SCALAR_MIRRORS_X(MIRROR)
#undef MIRROR
#define MIRROR(a, b) LBM_MIRROR(g, a, b, r.y_low, r.y_high)
    LBM_SCALAR_MIRRORS_Y(MIRROR)
#undef MIRROR
#define MIRROR(a, b) LBM_MIRROR(g, a, b, r.z_low, r.z_high)
    LBM_SCALAR_MIRRORS_Z(MIRROR)
#undef MIRROR
}

ivec3 lbm_outward(int face) {
    int side = 2 * (face & 1) - 1;
    return ivec3(face < 2 ? side : 0, face >> 1 == 1 ? side : 0, face >= 4 ? side : 0);
}

bool lbm_flows_in(int face) {
    const uint faces = uint(LBM_FACE_IS_INFLOW(LBM_FACE_0)) | uint(LBM_FACE_IS_INFLOW(LBM_FACE_1)) << 1 |
                       uint(LBM_FACE_IS_INFLOW(LBM_FACE_2)) << 2 | uint(LBM_FACE_IS_INFLOW(LBM_FACE_3)) << 3 |
                       uint(LBM_FACE_IS_INFLOW(LBM_FACE_4)) << 4 | uint(LBM_FACE_IS_INFLOW(LBM_FACE_5)) << 5;
    return (faces >> face & 1u) != 0u;
}

uint lbm_wave_at(int face, uvec3 at) {
    const uint X = LBM_NY * LBM_LAYERS, Y = LBM_NX * LBM_LAYERS;
    uint up = uint(face & 1);
    if (face < 2) return X * up + at.y + LBM_NY * at.z;
    if (face < 4) return X * 2u + Y * up + at.x + LBM_NX * at.z;
    return (X + Y) * 2u + LBM_LAYER * up + at.x + LBM_NX * at.y;
}

// Sums over what does not come from beyond the face: the first twice where it flies outward, which
// by what stays unknown is density times (1 + velocity outward), less 1; then mass and momentum.
struct lbm_within {
    lbm_float twice, mass;
    lbm_vec momentum;
};

lbm_within lbm_look_within(ivec3 outward, lbm_float f[LBM_Q]) {
    lbm_within w = lbm_within(f[0], f[0] + 5.0 / 6.0, lbm_vec_all(vec3(0.0)));
#define ADD(v, along, X, Y, Z)                                                                     \
    w.twice += float(1 + along) * v;                                                               \
    w.mass += along < 0 ? lbm_float(0.0) : v;                                                      \
    w.momentum.x += along < 0 ? lbm_float(0.0) : float(X) * v;                                     \
    w.momentum.y += along < 0 ? lbm_float(0.0) : float(Y) * v;                                     \
    w.momentum.z += along < 0 ? lbm_float(0.0) : float(Z) * v;
#define LOOK(i, X, Y, Z)                                                                           \
    {                                                                                              \
        int along = X * outward.x + Y * outward.y + Z * outward.z;                                 \
        ADD(f[i], along, X, Y, Z)                                                                  \
        ADD(f[i + 1], -along, -(X), -(Y), -(Z))                                                    \
    }
    LBM_PAIRS(LOOK)
#undef LOOK
#undef ADD
    return w;
}

lbm_vec lbm_velocity(lbm_float f[LBM_Q]) {
    lbm_float density = 1.0 + f[0];
    lbm_vec m = lbm_vec_all(vec3(0.0));
#define ADD(i, X, Y, Z)                                                                            \
    density += f[i] + f[i + 1];                                                                    \
    m.x += float(X) * (f[i] - f[i + 1]);                                                           \
    m.y += float(Y) * (f[i] - f[i + 1]);                                                           \
    m.z += float(Z) * (f[i] - f[i + 1]);
    LBM_PAIRS(ADD)
#undef ADD
    return lbm_vec(m.x / density, m.y / density, m.z / density);
}

// To equilibrium, the stress of what arrives from within, and that of its mirror from beyond.
void lbm_add_stress(ivec3 outward, lbm_float part, lbm_float f[LBM_Q], inout lbm_float made[LBM_Q]) {
    lbm_float xx = lbm_float(0.0), yy = xx, zz = xx, xy = xx, xz = xx, yz = xx;
#define SUM(i, X, Y, Z)                                                                            \
    {                                                                                              \
        int along = X * outward.x + Y * outward.y + Z * outward.z;                                 \
        lbm_float a = f[i] - made[i], b = f[i + 1] - made[i + 1];                                  \
        lbm_float both = along == 0 ? a + b : 2.0 * (along > 0 ? a : b);                           \
        if (X != 0) xx += both;                                                                    \
        if (Y != 0) yy += both;                                                                    \
        if (Z != 0) zz += both;                                                                    \
        xy += float(X * Y) * both;                                                                 \
        xz += float(X * Z) * both;                                                                 \
        yz += float(Y * Z) * both;                                                                 \
    }
    LBM_PAIRS(SUM)
#undef SUM
    part *= 4.5;
    lbm_float third = (xx + yy + zz) * (1.0 / 3.0);
    made[0] -= LBM_REST * part * third;
#define ADD(i, X, Y, Z)                                                                            \
    {                                                                                              \
        lbm_float along = float(X * X) * xx + float(Y * Y) * yy + float(Z * Z) * zz - third +      \
                     2.0 * (float(X * Y) * xy + float(X * Z) * xz + float(Y * Z) * yz);            \
        made[i] += LBM_WEIGHT(X, Y, Z) * part * along;                                             \
        made[i + 1] += LBM_WEIGHT(X, Y, Z) * part * along;                                         \
    }
    LBM_PAIRS(ADD)
#undef ADD
}

void lbm_pass_face(lbm_rim r, uvec3 at, const bool wave_goes_on, inout lbm_float f[LBM_Q]) {
    ivec3 outward = lbm_outward(r.face);
    vec3 n = vec3(outward), wind = lbm_face_velocity[r.face].xyz;
    const int size[3] = int[3](LBM_NX, LBM_NY, LBM_NZ);
    float wind_out = dot(wind, n), pull = LBM_WAVE_PULL * LBM_SOUND / float(size[r.face >> 1]);
    lbm_within w = lbm_look_within(outward, f);
    lbm_float out_, excess;
    if (lbm_flows_in(r.face)) {
        out_ = lbm_float(wind_out);
        excess = (w.twice - out_) / (1.0 + out_);
    } else {
        uint place = lbm_wave_at(r.face, at);
        lbm_float wave = lbm_waves[place], b = 1.0 + LBM_SOUND + wave, q = w.twice - wave;
        excess = 2.0 * q / (b + sqrt(max(b * b + 4.0 * LBM_SOUND * q, 0.01)));
        out_ = clamp(wave + LBM_SOUND * excess, -LBM_FACE_SPEED, LBM_FACE_SPEED);
        wave += pull * (wind_out < 0.0 ? wind_out - out_ : LBM_SOUND * excess);
        if (wave_goes_on) lbm_waves[place] = wave;
    }
    // Along the face what leaves goes on as it came, what enters brings the wind's.
    lbm_float leaves = lbm_float(greaterThanEqual(out_, lbm_float(0.0))) / w.mass;
    lbm_vec u = lbm_vec(w.momentum.x * leaves, w.momentum.y * leaves, w.momentum.z * leaves);
    lbm_float enters = lbm_float(lessThan(out_, lbm_float(0.0)));
    u.x = mix(u.x + enters * wind.x, n.x * out_, lbm_bool(outward.x != 0));
    u.y = mix(u.y + enters * wind.y, n.y * out_, lbm_bool(outward.y != 0));
    u.z = mix(u.z + enters * wind.z, n.z * out_, lbm_bool(outward.z != 0));
    lbm_float made[LBM_Q];
    lbm_set_equilibrium(excess, u, made);
    lbm_add_stress(outward, 1.0 - enters, f, made);
    for (int i = 0; i < LBM_Q; i++) f[i] = mix(f[i], made[i], r.lanes);
}

lbm_vec lbm_left; // velocity of the air, as lbm_meet_air leaves it

void lbm_pass_face_with(const int s, lbm_rim r, float ambient, inout lbm_float g[LBM_SCALAR_Q]) {
    lbm_vec u = lbm_left;
    ivec3 outward = lbm_outward(r.face);
    lbm_float out_ = LBM_ALONG(u, outward.x, outward.y, outward.z);
    lbm_float value = g[0];
#define LOOK(i, X, Y, Z)                                                                           \
    {                                                                                              \
        int along = X * outward.x + Y * outward.y + Z * outward.z;                                 \
        value += float(1 + along) * g[i] + float(1 - along) * g[i + 1];                            \
    }
    LBM_SCALAR_PAIRS(LOOK)
#undef LOOK
    value = mix(lbm_float(ambient), value / (1.0 + out_), greaterThanEqual(out_, lbm_float(0.0)));
    if (lbm_flows_in(r.face)) value = lbm_float(lbm_face_scalar[r.face][s]);
    lbm_float made[LBM_SCALAR_Q];
    lbm_set_scalar_equilibrium(value, u, made);
    for (int i = 0; i < LBM_SCALAR_Q; i++) g[i] = mix(g[i], made[i], r.lanes);
}
#endif

// ---- a step calls -----------------------------------------------------------------------------

// Whether an element has anything to do with faces or bodies that change what arrives.
bool lbm_meets(uvec3 at, lbm_site site) {
    bool any_ = site.near != 0u;
#if LBM_RIMS && LBM_REGION != LBM_CORE
    any_ = any_ || lbm_at_rim(at);
#endif
    return any_;
}

// Of an element, before these.
void lbm_find_bodies(uvec3 at, lbm_site site) {
#if LBM_BODIES
    if (site.near != 0u) lbm_find_walls(at, site.near);
#endif
}

// Makes what arrives in an element what it should be: of air, of scalar s (a constant). `step_waves`: those at
// open faces go a step on.
void lbm_meet_air(uvec3 at, lbm_site site, const bool step_waves, inout lbm_float f[LBM_Q]) {
#if LBM_RIMS && LBM_REGION != LBM_CORE
    if (lbm_at_rim(at)) {
        lbm_rim r = lbm_rim_at(at);
        lbm_mirror_air(r, f);
        if (r.face >= 0) lbm_pass_face(r, at, step_waves, f);
    }
#endif
#if LBM_BODIES
    if (site.near != 0u) lbm_push_air(f);
#endif
#if LBM_RIMS && LBM_REGION != LBM_CORE
    lbm_left = lbm_velocity(f);
#endif
}

// At faces that air passes after that.
void lbm_meet_scalar(const int s, uvec3 at, lbm_site site, float ambient, inout lbm_float g[LBM_SCALAR_Q]) {
#if LBM_RIMS && LBM_REGION != LBM_CORE
    if (lbm_at_rim(at)) {
        lbm_rim r = lbm_rim_at(at);
        lbm_mirror_scalar(r, g);
        if (r.face >= 0) lbm_pass_face_with(s, r, ambient, g);
    }
#endif
#if LBM_BODIES
    if (site.near != 0u) lbm_push_scalar(g);
#endif
}

#endif
