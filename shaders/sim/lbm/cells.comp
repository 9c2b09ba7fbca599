// What the cells are, anew: solid, or beside a body that moves. What a body has left is filled: its
// velocity, the mean density and scalars of the air around. What it covers needs nothing done: what
// is under way between the cell and air comes back, the rest is lost, and that much the wall has
// pushed out before it (bodies.glsl). Not a pass of its own: see src/sim/lbm_walls.c.
layout(local_size_x = LBM_GROUP) in;
#include "sim/lbm/bodies.glsl"

// In three dispatches, so that what one thread reads no other writes, nor the other half of a word
// that it writes: then the same comes out each time.
const uint PLAN = 0u;       // says what cells are; what cells are filled with is left in them, in places
                            // that are read for these cells alone
const uint NEIGHBOURS = 1u; // fills what lies at neighbours: each place is reached from one side
const uint HOME = 2u;       // fills what lies in the cells themselves
uniform uint stage;

uniform uint any_moves; // any body does

layout(std430) readonly buffer LbmCellsBefore { uint cells_before[]; };

const int REACH = 4; // cells, to where air is looked for

struct Cell { // one, and where it lies
    uint element, home, lane;
};

Cell find(ivec3 at) {
    Cell c;
    ivec3 inside = lbm_wrap(at);
    c.element = lbm_element_of(inside, c.lane);
    c.home = lbm_home(uvec3(inside.xy, uint(inside.z) - c.lane * LBM_LAYERS));
    return c;
}

// ---- what a cell is ---------------------------------------------------------------------------

bool counts(uvec3 ids) { // one is of a body that moves, or, with routes, of any
    if (ids == uvec3(0u)) return false;
    return LBM_ROUTES || lbm_body_moves(ids.x) || lbm_body_moves(ids.y) || lbm_body_moves(ids.z);
}

bool beside_body(bool inside, ivec3 at) {
    for (int k = 0; k < 9; k++)
        if (counts(lbm_three_ids(inside, at + ivec3(0, k % 3 - 1, k / 3 - 1)))) return true;
    return false;
}

// Whether a neighbour along an axis is beside a body.
bool one_beyond(bool inside, ivec3 at) {
    for (int k = 0; k < 6; k++) {
        int side = 2 * (k & 1) - 1, across = (k >> 1) - 1;
        uvec3 ids = lbm_three_ids(inside, at + ivec3(0, 2 * side, across)) |
                    lbm_three_ids(inside, at + ivec3(0, across, 2 * side));
        for (int z = -1; z <= 1; z++) ids |= lbm_three_ids(inside, at + ivec3(side, across, z));
        if (ids != uvec3(0u)) return true;
    }
    return false;
}

uint find_kind(ivec3 at) {
    const ivec3 last = ivec3(LBM_NX, LBM_NY, LBM_NZ) - 1;
    bool inside = all(greaterThan(at, ivec3(1))) && all(lessThan(at, last - 1));
    if (lbm_id_at(at) != 0u) return LBM_CELL_SOLID;
    if ((LBM_ROUTES || any_moves != 0u) && beside_body(inside, at)) return LBM_CELL_NEAR | LBM_CELL_REACHED;
    return LBM_ROUTES && one_beyond(inside, at) ? LBM_CELL_REACHED : 0u;
}

// ---- what a body has left ---------------------------------------------------------------------

float air[LBM_Q], part[LBM_SCALAR_Q]; // of one cell

float pick(lbm_element e, uint lane, const float scale) {
    return lbm_unpack(e, scale)[lane];
}

void store(const int slot, uint side, Cell c, const float scale, float value) {
    uint at = lbm_memory_at(slot, side, c.home);
#if LBM_HALF
    uint bits = packHalf2x16(vec2(value * scale, 0.0)) & 0xffffu;
    uint shift = 16u * (c.lane & 1u), others = 0xffff0000u >> shift;
#if LBM_LANES == 2
#define WORD(array) array[at]
#else
#define WORD(array) array[at][c.lane >> 1]
#endif
#define LBM_BUFFER(k, block, array)                                                                \
    if (slot / LBM_RUN == k) WORD(array) = WORD(array) & others | bits << shift;
#else
#define LBM_BUFFER(k, block, array) if (slot / LBM_RUN == k) array[at][c.lane] = value;
#endif
    LBM_EACH_BUFFER
#undef LBM_BUFFER
}

bool is_solid(ivec3 at) {
    if (lbm_id_at(at) != 0u) return true;
    ivec3 c = lbm_wrap(at);
    uint lane, element = lbm_element_of(c, lane);
    return (lbm_wall_lanes(uvec3(c.xy, uint(c.z) - lane * LBM_LAYERS)) >> lane & 1u) != 0u;
}

bool was_solid(Cell c) {
    return (cells_before[c.element] >> 8u * c.lane & LBM_CELL_SOLID) != 0u;
}

struct Around { // sums over cells of air
    float count, excess;
    vec3 velocity, scalars;
};

// What arrives at a cell that was air and is it still.
void add_cell(ivec3 at, Cell c, inout Around sum) {
    ivec3 around = lbm_wrap(at);
    lbm_place p = lbm_place_at(uvec3(around.xy, uint(around.z) - c.lane * LBM_LAYERS));
    float excess = pick(lbm_load(LBM_AIR_AT_REST, 0u, p.home), c.lane, LBM_AIR_SCALE);
    vec3 momentum = vec3(0.0);
#define ADD(i, x, y, z)                                                                            \
    {                                                                                              \
        float a = pick(lbm_load(LBM_AIR_PAIR(i), 1u - lbm_parity, p.home), c.lane, LBM_AIR_SCALE);  \
        float b = pick(lbm_load_there(LBM_AIR_PAIR(i), lbm_parity, p, x, y, z), c.lane,            \
                       LBM_AIR_SCALE);                                                             \
        excess += a + b;                                                                           \
        momentum += (a - b) * vec3(x, y, z);                                                       \
    }
    LBM_PAIRS(ADD)
#undef ADD
    sum.count += 1.0;
    sum.excess += excess;
    sum.velocity += momentum / (1.0 + excess);
#define SCALAR(s)                                                                                  \
    {                                                                                              \
        lbm_element q[LBM_SCALAR_Q];                                                               \
        lbm_load_scalar(s, p, q);                                                                  \
        for (int i = 0; i < LBM_SCALAR_Q; i++)                                                     \
            sum.scalars[s] += pick(q[i], c.lane, LBM_SCALAR_SCALE);                                \
    }
    LBM_EACH_SCALAR(SCALAR)
#undef SCALAR
}

// Along the axes, no farther than to where there is some.
Around look_around(ivec3 at) {
    Around sum = Around(0.0, 0.0, vec3(0.0), vec3(0.0));
    for (int k = 0; k < 6 * REACH && (k % 6 > 0 || sum.count == 0.0); k++) {
        ivec3 step_ = ivec3(0);
        step_[k / 2 % 3] = (1 - 2 * (k & 1)) * (1 + k / 6);
        ivec3 there = at + step_;
        if (!lbm_is_inside(there) || is_solid(there)) continue;
        Cell c = find(there);
        if (!was_solid(c)) add_cell(there, c, sum);
    }
    return sum;
}

uint body_beside(ivec3 at) { // the greatest id
    uint id = 0u;
    for (int k = 0; k < 27; k++) id = max(id, lbm_id_at(at + ivec3(k % 3, k / 3 % 3, k / 9) - 1));
    return id;
}

// What arrives, and what the cell would have sent: to air, and into solids, from where it comes back
// a step later. Others that a body has left are filled themselves.
bool takes(ivec3 at) {
    return is_solid(at) || !was_solid(find(at));
}

void fill_air(ivec3 at, float excess, vec3 u) {
    Cell own = find(at);
    float density = 1.0 + excess, same = excess - density * 1.5 * dot(u, u);
    if (stage == HOME) store(LBM_AIR_AT_REST, 0u, own, LBM_AIR_SCALE, LBM_REST * same);
#define FILL(i, x, y, z)                                                                           \
    {                                                                                              \
        Cell there = find(at + ivec3(x, y, z));                                                    \
        float along = dot(u, vec3(x, y, z));                                                       \
        float even = LBM_WEIGHT(x, y, z) * (same + density * 4.5 * along * along);                 \
        float odd = LBM_WEIGHT(x, y, z) * 3.0 * density * along;                                   \
        if (stage == HOME) {                                                                       \
            store(LBM_AIR_PAIR(i), 1u - lbm_parity, own, LBM_AIR_SCALE, even + odd);               \
            if (takes(at - ivec3(x, y, z)))                                                        \
                store(LBM_AIR_PAIR(i), lbm_parity, own, LBM_AIR_SCALE, even - odd);                \
        } else {                                                                                   \
            store(LBM_AIR_PAIR(i), lbm_parity, there, LBM_AIR_SCALE, even - odd);                  \
            if (takes(at + ivec3(x, y, z)))                                                        \
                store(LBM_AIR_PAIR(i), 1u - lbm_parity, there, LBM_AIR_SCALE, even + odd);         \
        }                                                                                          \
    }
    LBM_PAIRS(FILL)
#undef FILL
}

void fill_scalar(const int s, ivec3 at, float value, vec3 u) {
    Cell own = find(at);
    if (stage == HOME)
        store(LBM_SCALAR_AT_REST(s), 0u, own, LBM_SCALAR_SCALE, LBM_SCALAR_REST * value);
#define FILL(i, x, y, z)                                                                           \
    {                                                                                              \
        Cell there = find(at + ivec3(x, y, z));                                                    \
        float even = LBM_SCALAR_WEIGHT(x, y, z) * value;                                           \
        float odd = even * dot(u, vec3(x, y, z)) * (1.0 / LBM_SCALAR_SPEED);                       \
        if (stage == HOME) {                                                                       \
            store(LBM_SCALAR_PAIR(s, i), 1u - lbm_parity, own, LBM_SCALAR_SCALE, even + odd);      \
            if (takes(at - ivec3(x, y, z)))                                                        \
                store(LBM_SCALAR_PAIR(s, i), lbm_parity, own, LBM_SCALAR_SCALE, even - odd);       \
        } else {                                                                                   \
            store(LBM_SCALAR_PAIR(s, i), lbm_parity, there, LBM_SCALAR_SCALE, even - odd);         \
            if (takes(at + ivec3(x, y, z)))                                                        \
                store(LBM_SCALAR_PAIR(s, i), 1u - lbm_parity, there, LBM_SCALAR_SCALE, even + odd); \
        }                                                                                          \
    }
    LBM_SCALAR_PAIRS(FILL)
#undef FILL
}

uniform vec3 ambient; // of scalars, where there is no air around

// Numbers of a cell between the dispatches: in place of what arrives, as large as that may be.
void leave(const int slot, Cell c, const float scale, float value) {
    store(slot, 1u - lbm_parity, c, scale, value);
}

float left_in(const int slot, Cell c, const float scale) {
    return pick(lbm_load(slot, 1u - lbm_parity, c.home), c.lane, scale);
}

void plan(ivec3 at) {
    Around around = look_around(at);
    uint body = body_beside(at);
    float share = 1.0 / max(around.count, 1.0);
    vec3 u = around.velocity * share;
    if (body != 0u) u = lbm_body_velocity(body, vec3(at) + 0.5);
    Cell own = find(at);
    leave(LBM_AIR_PAIR(1), own, LBM_AIR_SCALE, around.excess * share);
    leave(LBM_AIR_PAIR(3), own, LBM_AIR_SCALE, u.x);
    leave(LBM_AIR_PAIR(5), own, LBM_AIR_SCALE, u.y);
    leave(LBM_AIR_PAIR(7), own, LBM_AIR_SCALE, u.z);
    vec3 scalars = around.count > 0.0 ? around.scalars * share : ambient;
#define SCALAR(s) leave(LBM_SCALAR_PAIR(s, 1), own, LBM_SCALAR_SCALE, LBM_SCALAR_REST * scalars[s]);
    LBM_EACH_SCALAR(SCALAR)
#undef SCALAR
}

void fill(ivec3 at) {
    Cell own = find(at);
    float excess = left_in(LBM_AIR_PAIR(1), own, LBM_AIR_SCALE);
    vec3 u = vec3(left_in(LBM_AIR_PAIR(3), own, LBM_AIR_SCALE), left_in(LBM_AIR_PAIR(5), own, LBM_AIR_SCALE),
                  left_in(LBM_AIR_PAIR(7), own, LBM_AIR_SCALE));
#define SCALAR(s)                                                                                  \
    fill_scalar(s, at, left_in(LBM_SCALAR_PAIR(s, 1), own, LBM_SCALAR_SCALE) / LBM_SCALAR_REST, u);
    LBM_EACH_SCALAR(SCALAR)
#undef SCALAR
    fill_air(at, excess, u);
}

// ---- an element -------------------------------------------------------------------------------

void main() {
    uint column = gl_GlobalInvocationID.x;
    if (column >= LBM_LAYER) return;
    uvec3 at = uvec3(column % LBM_NX, column / LBM_NX, gl_GlobalInvocationID.z);
    uint element = column + LBM_LAYER * at.z;
    uint bytes = 0u;
    if (stage == PLAN) {
        for (uint k = 0u; k < LBM_LANES; k++) bytes |= find_kind(lbm_cell_at(at, k)) << 8u * k;
        uint changed = (cells_before[element] ^ bytes) & LBM_CELL_SOLID * 0x01010101u;
        bytes |= changed * (LBM_CELL_NEW / LBM_CELL_SOLID);
        lbm_cells[element] = bytes;
    } else {
        bytes = lbm_cells[element];
    }
    for (uint k = 0u; bytes != 0u && k < LBM_LANES; k++) {
        if ((bytes >> 8u * k & (LBM_CELL_NEW | LBM_CELL_SOLID)) != LBM_CELL_NEW) continue;
        ivec3 cell = lbm_cell_at(at, k);
        if (stage == PLAN)
            plan(cell);
        else
            fill(cell);
    }
}
