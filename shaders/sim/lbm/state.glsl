// The state of a lattice Boltzmann solver, for its own shaders and those of others (lbm_defines,
// lbm_bind and lbm_parity in src/sim/lbm.h give what this needs).
//
// Streaming is in place: Lehmann, "Esoteric Pull and Esoteric Push", Computation 10(6), 2022,
// section 4.2. A cell reads direction i (odd) from its own place and i + 1 from that of its
// neighbour along i, and leaves what collision made of them in the other's place; so each place is
// read and written by one cell only, and the two places of a pair change roles in each step.
//
// What arrives at an element is what its cells hold before collision.
#ifndef SIM_LBM_STATE_GLSL
#define SIM_LBM_STATE_GLSL
#include "sim/lbm/element.glsl"
#include "sim/lbm/lattice.glsl"

uniform uint lbm_parity; // of steps

#if LBM_Q == 27
#define LBM_PAIRS(X) LBM_D3Q27(X)
#define LBM_REST LBM_D3Q27_REST
#define LBM_AXIS LBM_D3Q27_AXIS
#define LBM_EDGE LBM_D3Q27_EDGE
#define LBM_CORNER LBM_D3Q27_CORNER
#else
#define LBM_PAIRS(X) LBM_D3Q19(X)
#define LBM_REST LBM_D3Q19_REST
#define LBM_AXIS LBM_D3Q19_AXIS
#define LBM_EDGE LBM_D3Q19_EDGE
#define LBM_CORNER 0.0
#endif
// Of pairs: X(direction, x, y, z) gives LBM_WEIGHT(x, y, z).
#define LBM_WEIGHT(x, y, z)                                                                        \
    ((x) * (x) + (y) * (y) + (z) * (z) == 1   ? LBM_AXIS                                           \
     : (x) * (x) + (y) * (y) + (z) * (z) == 2 ? LBM_EDGE                                           \
                                              : LBM_CORNER)

#if LBM_SCALAR_Q == 27
#define LBM_SCALAR_PAIRS(X) LBM_D3Q27(X)
#define LBM_SCALAR_REST LBM_D3Q27_REST
#define LBM_SCALAR_SPEED (1.0 / 3.0) // square of that of sound
#define LBM_SCALAR_WEIGHT(x, y, z)                                                                 \
    ((x) * (x) + (y) * (y) + (z) * (z) == 1   ? LBM_D3Q27_AXIS                                     \
     : (x) * (x) + (y) * (y) + (z) * (z) == 2 ? LBM_D3Q27_EDGE                                     \
                                              : LBM_D3Q27_CORNER)
#else
#define LBM_SCALAR_PAIRS(X) LBM_D3Q7(X)
#define LBM_SCALAR_REST LBM_D3Q7_REST
#define LBM_SCALAR_SPEED (1.0 / 4.0)
#define LBM_SCALAR_WEIGHT(x, y, z) LBM_D3Q7_AXIS
#endif

// What a dispatch does: all; what is not at a face that is not periodic; what is; the latter and then the former.
#define LBM_WHOLE 0
#define LBM_CORE 1
#define LBM_SKIN 2
#define LBM_SKIN_FIRST 3
#ifndef LBM_REGION
#define LBM_REGION LBM_WHOLE
#endif

// X(s) for each scalar, a constant; and the last first.
#if LBM_SCALARS == 0
#define LBM_EACH_SCALAR(X)
#define LBM_EACH_SCALAR_BACK(X)
#elif LBM_SCALARS == 1
#define LBM_EACH_SCALAR(X) X(0)
#define LBM_EACH_SCALAR_BACK(X) X(0)
#elif LBM_SCALARS == 2
#define LBM_EACH_SCALAR(X) X(0) X(1)
#define LBM_EACH_SCALAR_BACK(X) X(1) X(0)
#else
#define LBM_EACH_SCALAR(X) X(0) X(1) X(2)
#define LBM_EACH_SCALAR_BACK(X) X(2) X(1) X(0)
#endif

// ---- all directions ---------------------------------------------------------------------------

// `scale`: of memory over that of the values.
void lbm_unpack_air(lbm_element q[LBM_Q], const float scale, out lbm_float f[LBM_Q]) {
    f[0] = lbm_unpack(q[0], scale);
#define UNPACK(i, x, y, z)                                                                         \
    f[i] = lbm_unpack(q[i], scale);                                                                \
    f[i + 1] = lbm_unpack(q[i + 1], scale);
    LBM_PAIRS(UNPACK)
#undef UNPACK
}

void lbm_pack_air(lbm_float f[LBM_Q], const float scale, out lbm_element q[LBM_Q]) {
    q[0] = lbm_pack(scale, f[0]);
#define PACK(i, x, y, z)                                                                           \
    q[i] = lbm_pack(scale, f[i]);                                                                  \
    q[i + 1] = lbm_pack(scale, f[i + 1]);
    LBM_PAIRS(PACK)
#undef PACK
}

void lbm_unpack_scalar(lbm_element q[LBM_SCALAR_Q], const float scale, out lbm_float g[LBM_SCALAR_Q]) {
    g[0] = lbm_unpack(q[0], scale);
#define UNPACK(i, x, y, z)                                                                         \
    g[i] = lbm_unpack(q[i], scale);                                                                \
    g[i + 1] = lbm_unpack(q[i + 1], scale);
    LBM_SCALAR_PAIRS(UNPACK)
#undef UNPACK
}

void lbm_pack_scalar(lbm_float g[LBM_SCALAR_Q], const float scale, out lbm_element q[LBM_SCALAR_Q]) {
    q[0] = lbm_pack(scale, g[0]);
#define PACK(i, x, y, z)                                                                           \
    q[i] = lbm_pack(scale, g[i]);                                                                  \
    q[i + 1] = lbm_pack(scale, g[i + 1]);
    LBM_SCALAR_PAIRS(PACK)
#undef PACK
}

// ---- places -----------------------------------------------------------------------------------

struct lbm_place { // of an access
    uint home; // in memory
    uint x, x_up, x_down, y, y_up, y_down, z, z_up; // parts of `home` and of that of neighbours
    bool last; // the layer above is the first one, its lanes one lane on
};

// What a layer adds to `home`.
uint lbm_depth(uint z) {
#if LBM_STRIDE > 1
    uint row = z / LBM_SPAN;
    return (z - row * LBM_SPAN) * (LBM_LAYER * LBM_STRIDE) + row;
#else
    return z * LBM_LAYER;
#endif
}

// `at`: x, y, z % LBM_LAYERS of an element; z % LBM_SPAN of a bundle.
uint lbm_home(uvec3 at) {
    return (at.x + at.y * LBM_NX) * LBM_STRIDE + lbm_depth(at.z);
}

lbm_place lbm_place_at(uvec3 at) {
    const uint row = LBM_NX * LBM_STRIDE;
    lbm_place p;
    p.x = at.x * LBM_STRIDE;
    p.x_up = at.x == LBM_NX - 1u ? 0u : p.x + LBM_STRIDE;
    p.x_down = at.x == 0u ? row - LBM_STRIDE : p.x - LBM_STRIDE;
    p.y = at.y * row;
    p.y_up = at.y == LBM_NY - 1u ? 0u : p.y + row;
    p.y_down = at.y == 0u ? (LBM_NY - 1u) * row : p.y - row;
    p.z = lbm_depth(at.z);
    p.last = at.z == LBM_DEPTH - 1u;
    p.z_up = p.last ? 0u : lbm_depth(at.z + 1u);
    p.home = p.x + p.y + p.z;
    return p;
}

// The one a step along (x, y, z), which are constants.
uint lbm_there(lbm_place p, const int x, const int y, const int z) {
    return (x == 0 ? p.x : x > 0 ? p.x_up : p.x_down) +
           (y == 0 ? p.y : y > 0 ? p.y_up : p.y_down) + (z == 0 ? p.z : p.z_up);
}

// Slots: those of pairs, then those at rest. Each has an element for each of the lattice.
#define LBM_AIR_PAIR(i) ((i) - 1)
#define LBM_SCALAR_PAIR(s, i) (LBM_Q - 1 + (s) * (LBM_SCALAR_Q - 1) + (i) - 1)
#define LBM_AIR_AT_REST (LBM_Q - 1 + LBM_SCALARS * (LBM_SCALAR_Q - 1))
#define LBM_SCALAR_AT_REST(s) (LBM_AIR_AT_REST + 1 + (s))
#define LBM_SLOTS (LBM_AIR_AT_REST + 1 + LBM_SCALARS)

// As it lies in memory.
#if LBM_SOFTWARE && LBM_HALF
#define lbm_memory uint64_t
#define lbm_from_memory(m) unpackUint2x32(m)
#define lbm_to_memory(e) packUint2x32(e)
#elif LBM_SOFTWARE
#define lbm_memory u64vec2
lbm_element lbm_from_memory(lbm_memory m) {
    return uintBitsToFloat(uvec4(unpackUint2x32(m.x), unpackUint2x32(m.y)));
}

lbm_memory lbm_to_memory(lbm_element e) {
    uvec4 words = floatBitsToUint(e);
    return u64vec2(packUint2x32(words.xy), packUint2x32(words.zw));
}
#else
#define lbm_memory lbm_access
#define lbm_from_memory(m) (m)
#define lbm_to_memory(e) (e)
#endif

// LBM_EACH_BUFFER, one of these, is LBM_BUFFER(k, block, array) for each buffer of the state. A
// buffer holds LBM_RUN slots, an even number, so that no pair is apart.
#define LBM_BUFFERS_1 LBM_BUFFER(0, LbmState0, lbm_state_0)
#define LBM_BUFFERS_2 LBM_BUFFERS_1 LBM_BUFFER(1, LbmState1, lbm_state_1)
#define LBM_BUFFERS_3 LBM_BUFFERS_2 LBM_BUFFER(2, LbmState2, lbm_state_2)
#define LBM_BUFFERS_4 LBM_BUFFERS_3 LBM_BUFFER(3, LbmState3, lbm_state_3)
#define LBM_BUFFERS_5 LBM_BUFFERS_4 LBM_BUFFER(4, LbmState4, lbm_state_4)
#define LBM_BUFFERS_6 LBM_BUFFERS_5 LBM_BUFFER(5, LbmState5, lbm_state_5)
#define LBM_BUFFERS_7 LBM_BUFFERS_6 LBM_BUFFER(6, LbmState6, lbm_state_6)
#define LBM_BUFFERS_8 LBM_BUFFERS_7 LBM_BUFFER(7, LbmState7, lbm_state_7)
#define LBM_BUFFERS_9 LBM_BUFFERS_8 LBM_BUFFER(8, LbmState8, lbm_state_8)
#define LBM_BUFFERS_10 LBM_BUFFERS_9 LBM_BUFFER(9, LbmState9, lbm_state_9)
#define LBM_BUFFERS_11 LBM_BUFFERS_10 LBM_BUFFER(10, LbmState10, lbm_state_10)
#define LBM_BUFFERS_12 LBM_BUFFERS_11 LBM_BUFFER(11, LbmState11, lbm_state_11)
#define LBM_BUFFERS_13 LBM_BUFFERS_12 LBM_BUFFER(12, LbmState12, lbm_state_12)
#define LBM_BUFFERS_14 LBM_BUFFERS_13 LBM_BUFFER(13, LbmState13, lbm_state_13)
#define LBM_BUFFERS_15 LBM_BUFFERS_14 LBM_BUFFER(14, LbmState14, lbm_state_14)
#define LBM_BUFFERS_16 LBM_BUFFERS_15 LBM_BUFFER(15, LbmState15, lbm_state_15)
#define LBM_BUFFER(k, block, array) layout(std430) buffer block { lbm_memory array[]; };
LBM_EACH_BUFFER
#undef LBM_BUFFER

// Where `home` is in its slot's buffer. `slot` is a constant, the first of a pair; `side`, 0 or 1,
// need not be.
//
// LBM_BLOCK: so many elements of a slot lie together, then come as many of the next one: what a group
// of threads reads is near to each other, and its addresses differ by constants. 0: the whole of a
// slot lies together.
uint lbm_memory_at(const int slot, uint side, uint home) {
    const int first = slot / LBM_RUN * LBM_RUN;
    const uint own = uint(slot - first);
#if LBM_BLOCK
    const uint block = uint(LBM_BLOCK * LBM_STRIDE / LBM_BUNDLE), inside = block - 1u;
    const uint slots = uint(min(LBM_RUN, LBM_SLOTS - first));
    return (home & ~inside) * slots + (home & inside) + side * block + own * block;
#else
    return (own + side) * (LBM_LAYERS / LBM_BUNDLE * LBM_LAYER * LBM_STRIDE) + home;
#endif
}

// What is not of the slot's buffer is left out by the driver.
lbm_access lbm_load(const int slot, uint side, uint home) {
    uint at = lbm_memory_at(slot, side, home);
    lbm_memory m;
#define LBM_BUFFER(k, block, array) if (slot / LBM_RUN == k) m = array[at];
    LBM_EACH_BUFFER
#undef LBM_BUFFER
    return lbm_from_memory(m);
}

void lbm_store(const int slot, uint side, uint home, lbm_access a) {
    uint at = lbm_memory_at(slot, side, home);
    lbm_memory m = lbm_to_memory(a);
#define LBM_BUFFER(k, block, array) if (slot / LBM_RUN == k) array[at] = m;
    LBM_EACH_BUFFER
#undef LBM_BUFFER
}

// Lanes turned where they go round. Without a branch, which loads would wait for.
lbm_access lbm_from_above(lbm_place p, lbm_access a) {
    return mix(a, lbm_next_row(a), lbm_access_mask(p.last));
}

lbm_access lbm_to_above(lbm_place p, lbm_access a) {
    return mix(a, lbm_last_row(a), lbm_access_mask(p.last));
}

// A pair's second direction, from or to the neighbour along its first, (x, y, z).
lbm_access lbm_load_there(const int slot, uint side, lbm_place p, const int x, const int y, const int z) {
    lbm_access a = lbm_load(slot, side, lbm_there(p, x, y, z));
    return z > 0 ? lbm_from_above(p, a) : a;
}

void lbm_store_there(const int slot, uint side, lbm_place p, const int x, const int y, const int z, lbm_access a) {
    lbm_store(slot, side, lbm_there(p, x, y, z), z > 0 ? lbm_to_above(p, a) : a);
}

// ---- populations ------------------------------------------------------------------------------

// What arrives at an element: of air, of scalar s (a constant).
void lbm_load_air(lbm_place p, out lbm_access q[LBM_Q]) {
    q[0] = lbm_load(LBM_AIR_AT_REST, 0u, p.home);
#define LOAD(i, x, y, z)                                                                           \
    q[i] = lbm_load(LBM_AIR_PAIR(i), 1u - lbm_parity, p.home);                                     \
    q[i + 1] = lbm_load_there(LBM_AIR_PAIR(i), lbm_parity, p, x, y, z);
    LBM_PAIRS(LOAD)
#undef LOAD
}

void lbm_load_scalar(const int s, lbm_place p, out lbm_access q[LBM_SCALAR_Q]) {
    q[0] = lbm_load(LBM_SCALAR_AT_REST(s), 0u, p.home);
#define LOAD(i, x, y, z)                                                                           \
    q[i] = lbm_load(LBM_SCALAR_PAIR(s, i), 1u - lbm_parity, p.home);                               \
    q[i + 1] = lbm_load_there(LBM_SCALAR_PAIR(s, i), lbm_parity, p, x, y, z);
    LBM_SCALAR_PAIRS(LOAD)
#undef LOAD
}

// Changes what arrives.
void lbm_replace_air(lbm_place p, lbm_access q[LBM_Q]) {
    lbm_store(LBM_AIR_AT_REST, 0u, p.home, q[0]);
#define STORE(i, x, y, z)                                                                          \
    lbm_store(LBM_AIR_PAIR(i), 1u - lbm_parity, p.home, q[i]);                                     \
    lbm_store_there(LBM_AIR_PAIR(i), lbm_parity, p, x, y, z, q[i + 1]);
    LBM_PAIRS(STORE)
#undef STORE
}

void lbm_replace_scalar(const int s, lbm_place p, lbm_access q[LBM_SCALAR_Q]) {
    lbm_store(LBM_SCALAR_AT_REST(s), 0u, p.home, q[0]);
#define STORE(i, x, y, z)                                                                          \
    lbm_store(LBM_SCALAR_PAIR(s, i), 1u - lbm_parity, p.home, q[i]);                               \
    lbm_store_there(LBM_SCALAR_PAIR(s, i), lbm_parity, p, x, y, z, q[i + 1]);
    LBM_SCALAR_PAIRS(STORE)
#undef STORE
}

// Sends off what collision left: the step's, once for each element.
void lbm_send_air(lbm_place p, lbm_access q[LBM_Q]) {
    lbm_store(LBM_AIR_AT_REST, 0u, p.home, q[0]);
#define STORE(i, x, y, z)                                                                          \
    lbm_store_there(LBM_AIR_PAIR(i), lbm_parity, p, x, y, z, q[i]);                                \
    lbm_store(LBM_AIR_PAIR(i), 1u - lbm_parity, p.home, q[i + 1]);
    LBM_PAIRS(STORE)
#undef STORE
}

void lbm_send_scalar(const int s, lbm_place p, lbm_access q[LBM_SCALAR_Q]) {
    lbm_store(LBM_SCALAR_AT_REST(s), 0u, p.home, q[0]);
#define STORE(i, x, y, z)                                                                          \
    lbm_store_there(LBM_SCALAR_PAIR(s, i), lbm_parity, p, x, y, z, q[i]);                          \
    lbm_store(LBM_SCALAR_PAIR(s, i), 1u - lbm_parity, p.home, q[i + 1]);
    LBM_SCALAR_PAIRS(STORE)
#undef STORE
}

// ---- in all lanes -------------------------------------------------------------------------------

struct lbm_vec { // a vector in each lane
    lbm_float x, y, z;
};

lbm_vec lbm_vec_all(vec3 v) {
    return lbm_vec(lbm_float(v.x), lbm_float(v.y), lbm_float(v.z));
}

lbm_float lbm_dot(lbm_vec a, lbm_vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Along a direction, whose parts are constants.
#define LBM_ALONG(v, X, Y, Z) (float(X) * (v).x + float(Y) * (v).y + float(Z) * (v).z)

// Equilibrium of second order, less the weights: density 1 + excess, velocity u.
void lbm_set_equilibrium(lbm_float excess, lbm_vec u, out lbm_float f[LBM_Q]) {
    lbm_float density = 1.0 + excess, same = excess - density * 1.5 * lbm_dot(u, u);
    f[0] = LBM_REST * same;
#define SET(i, x, y, z)                                                                            \
    {                                                                                              \
        lbm_float along = LBM_ALONG(u, x, y, z);                                                   \
        lbm_float even = LBM_WEIGHT(x, y, z) * (same + density * 4.5 * along * along);             \
        lbm_float odd = LBM_WEIGHT(x, y, z) * 3.0 * density * along;                               \
        f[i] = even + odd;                                                                         \
        f[i + 1] = even - odd;                                                                     \
    }
    LBM_PAIRS(SET)
#undef SET
}

// Equilibrium of a scalar that air of velocity u carries: linear in u (D3Q7), of second order
// (D3Q27, as published).
void lbm_set_scalar_equilibrium(lbm_float value, lbm_vec u, out lbm_float g[LBM_SCALAR_Q]) {
#if LBM_SCALAR_Q == 27
    lbm_float same = value * (1.0 - 1.5 * lbm_dot(u, u));
#else
    lbm_float same = value;
#endif
    g[0] = LBM_SCALAR_REST * same;
#define SET(i, x, y, z)                                                                            \
    {                                                                                              \
        lbm_float along = LBM_ALONG(u, x, y, z) * (1.0 / LBM_SCALAR_SPEED);                        \
        lbm_float even = LBM_SCALAR_WEIGHT(x, y, z) * same;                                        \
        lbm_float odd = LBM_SCALAR_WEIGHT(x, y, z) * value * along;                                \
        if (LBM_SCALAR_Q == 27) even += 0.5 * along * odd;                                         \
        g[i] = even + odd;                                                                         \
        g[i + 1] = even - odd;                                                                     \
    }
    LBM_SCALAR_PAIRS(SET)
#undef SET
}

#endif
