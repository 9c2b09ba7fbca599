// The state of a combustion solver (src/sim/pyro.h), for its own shaders and those of others:
// pyro_defines and pyro_bind in src/sim/pyro.h give what this needs.
//
// The gas has PYRO_GAS_NX by PYRO_GAS_NY by PYRO_GAS_NZ cells. Velocity and pressure have as many, or
// half as many along each axis (PYRO_RATIO 2). A shader works on the cells of velocity, or says
// PYRO_ON_GAS before it includes this, and works on those of the gas: PYRO_SIZE and pyro_at are theirs.
//
// Cells lie in bricks of 8^3, bricks along x, then y, then z: what is near in space is near in
// memory. Places are separable: that of a cell is the sum of what its three coordinates give.
//
// Velocities are staggered (Harlow and Welch 1965): component a of cell c is that across the face
// between c and its lower neighbour along a. What crosses the last face of an axis is not stored: it
// is 0 (or the wind's) at a wall, that of the first face at a periodic one, and at an open face that
// of the face one cell inside. The fourth number of a velocity is 0.
#ifndef SIM_PYRO_STATE_GLSL
#define SIM_PYRO_STATE_GLSL
#if PYRO_WIDE
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif

// Four numbers of a cell as they are stored, in full or half precision; one of them.
#if PYRO_HALF
#define PYRO_FOUR uvec2
#define PYRO_X(stored) unpackHalf2x16((stored).x).x
#define PYRO_Y(stored) unpackHalf2x16((stored).x).y
#define PYRO_Z(stored) unpackHalf2x16((stored).y).x
#define PYRO_W(stored) unpackHalf2x16((stored).y).y
vec4 pyro_load(uvec2 stored) {
    return vec4(unpackHalf2x16(stored.x), unpackHalf2x16(stored.y));
}
uvec2 pyro_store(vec4 v) {
    return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw));
}
#elif PYRO_WIDE
// A software driver makes a loop of each load: 16 bytes are two words of 64 bits, not four of 32.
#define PYRO_FOUR u64vec2
#define PYRO_X(stored) uintBitsToFloat(unpackUint2x32((stored).x).x)
#define PYRO_Y(stored) uintBitsToFloat(unpackUint2x32((stored).x).y)
#define PYRO_Z(stored) uintBitsToFloat(unpackUint2x32((stored).y).x)
#define PYRO_W(stored) uintBitsToFloat(unpackUint2x32((stored).y).y)
vec4 pyro_load(u64vec2 stored) {
    return uintBitsToFloat(uvec4(unpackUint2x32(stored.x), unpackUint2x32(stored.y)));
}
u64vec2 pyro_store(vec4 v) {
    uvec4 words = floatBitsToUint(v);
    return u64vec2(packUint2x32(words.xy), packUint2x32(words.zw));
}
#else
#define PYRO_FOUR vec4
#define PYRO_X(stored) (stored).x
#define PYRO_Y(stored) (stored).y
#define PYRO_Z(stored) (stored).z
#define PYRO_W(stored) (stored).w
vec4 pyro_load(vec4 stored) {
    return stored;
}
vec4 pyro_store(vec4 v) {
    return v;
}
#endif

#ifdef PYRO_ON_GAS
#define PYRO_SIDE 1 // of a cell, in cells of the gas
#else
#define PYRO_SIDE PYRO_RATIO
#endif
#define PYRO_NX (PYRO_GAS_NX / PYRO_SIDE) // multiples of 8
#define PYRO_NY (PYRO_GAS_NY / PYRO_SIDE)
#define PYRO_NZ (PYRO_GAS_NZ / PYRO_SIDE)
// PYRO_LOW_X to PYRO_HIGH_Z: faces, one of
#define PYRO_OPEN 0
#define PYRO_WALL 1
#define PYRO_INFLOW 2
#define PYRO_PERIODIC 3

const ivec3 PYRO_SIZE = ivec3(PYRO_NX, PYRO_NY, PYRO_NZ);
const ivec3 PYRO_LOW = ivec3(PYRO_LOW_X, PYRO_LOW_Y, PYRO_LOW_Z);
const ivec3 PYRO_HIGH = ivec3(PYRO_HIGH_X, PYRO_HIGH_Y, PYRO_HIGH_Z);
const bvec3 PYRO_AROUND = bvec3(PYRO_LOW_X == PYRO_PERIODIC, PYRO_LOW_Y == PYRO_PERIODIC,
                                PYRO_LOW_Z == PYRO_PERIODIC);

// ---- where things are -------------------------------------------------------------------------

// What coordinates along each axis give, where there are so many cells along x and y.
ivec3 pyro_places_in(ivec3 i, int nx, int ny) {
    return (i >> 3) * ivec3(512, 64 * nx, 8 * nx * ny) + ((i & 7) << ivec3(0, 3, 6));
}

ivec3 pyro_places(ivec3 i) {
    return pyro_places_in(i, PYRO_NX, PYRO_NY);
}

int pyro_gas_at(ivec3 i) { // of a cell of the gas
    ivec3 p = pyro_places_in(i, PYRO_GAS_NX, PYRO_GAS_NY);
    return p.x + p.y + p.z;
}

int pyro_flow_at(ivec3 i) { // of a cell of the velocity
    ivec3 p = pyro_places_in(i, PYRO_GAS_NX / PYRO_RATIO, PYRO_GAS_NY / PYRO_RATIO);
    return p.x + p.y + p.z;
}

bvec3 both(bvec3 a, bvec3 b) {
    return bvec3(a.x && b.x, a.y && b.y, a.z && b.z);
}

int pyro_at(ivec3 cell) {
    ivec3 p = pyro_places(cell);
    return p.x + p.y + p.z;
}

ivec3 pyro_around(ivec3 i) { // back into the box from less than its size outside
    return i + mix(ivec3(0), PYRO_SIZE, lessThan(i, ivec3(0))) -
           mix(ivec3(0), PYRO_SIZE, greaterThanEqual(i, PYRO_SIZE));
}

ivec3 pyro_into(ivec3 cell) { // or the nearest cell
    return mix(clamp(cell, ivec3(0), PYRO_SIZE - 1), pyro_around(cell), PYRO_AROUND);
}

// ---- numbers ----------------------------------------------------------------------------------

// What is no number, or beyond all reason, is 0. By its bits: compilers may take it that there are
// no such values.
float pyro_clean(float v) {
    return (floatBitsToUint(v) & 0x7fffffffu) < 0x60000000u ? v : 0.0;
}
vec4 pyro_clean(vec4 v) {
    return vec4(pyro_clean(v.x), pyro_clean(v.y), pyro_clean(v.z), pyro_clean(v.w));
}

// ---- faces between cells -----------------------------------------------------------------------

// How easily gas moves across the lower faces of a cell: 0 where a solid closes one, else 1, or, where
// pressure moves light gas farther than heavy gas (PYRO_VARIABLE), the density of the surroundings by that
// of the gas. The fourth number is 0 within solids.
#if PYRO_VARIABLE
#define PYRO_COEFFICIENTS uvec2
vec4 pyro_coefficients(uvec2 stored) {
    return vec4(unpackHalf2x16(stored.x), unpackHalf2x16(stored.y));
}
uvec2 pyro_store_coefficients(vec4 v) {
    return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw));
}
#else
#define PYRO_COEFFICIENTS uint
vec4 pyro_coefficients(uint stored) {
    return unpackUnorm4x8(stored);
}
uint pyro_store_coefficients(vec4 v) {
    return packUnorm4x8(v);
}
#endif

// ---- the gas ----------------------------------------------------------------------------------

// What a cell holds, once unpacked: kelvin above the surroundings, and by mass of air the fuel, the
// fuel that has burnt, and soot.
#define PYRO_WARMTH x
#define PYRO_FUEL y
#define PYRO_BURNT z
#define PYRO_SOOT w

uniform float ambient; // temperature of the surroundings, K
uniform float lightness; // of the fuel's vapour: molar mass of air by that of the fuel
const float PYRO_AIR = 353.0; // density of air times its temperature, kg K/m^3, at 101,325 Pa

float pyro_temperature(vec4 gas) {
    return max(ambient + gas.PYRO_WARMTH, 1.0);
}

// It is packed by volume: how much less air there is than in the surroundings, as a share of theirs, and
// what is in it by mass of theirs. Between cells these are linear, so that mass and heat are kept where
// hot gas meets cold; kelvin are not. Clean air is exactly 0, however a device rounds its divisions.
vec4 pyro_unpack(vec4 packed) {
    float air = max(1.0 - packed.x, 0.01);
    return vec4(ambient * (1.0 - air), packed.yzw) / air;
}
vec4 pyro_pack(vec4 gas) {
    float warm = pyro_temperature(gas), air = ambient / warm;
    return vec4((warm - ambient) / warm, air * gas.yzw);
}

// Density by that of the surroundings: an ideal gas of air and vapour.
float pyro_density(vec4 gas) {
    float vapour = max(gas.PYRO_FUEL, 0.0);
    return ambient / pyro_temperature(gas) * (1.0 + vapour) / (1.0 + lightness * vapour);
}
#endif
