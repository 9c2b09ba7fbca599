// Second of three dispatches: every item of a part that moved is crossed with the lines through the
// centres of cells along x, y and z. A crossing toggles the bits of all cells whose centre does not
// lie before it: in the end they are those of the cells with an odd number of crossings before. The
// fourth quarter of the threads, where a part has a shell, marks the cells that its triangles touch.
//
// Which lines cross a triangle is decided in whole numbers, of 64 bits; of its edges the left and
// the lower ones are its own. So of two triangles that share an edge a line through it crosses
// exactly one, and both or none where it is a fold (Pineda, "A parallel algorithm for polygon
// rasterization", 1988).
#include "state.glsl"
layout(local_size_x = VOXEL_GROUP) in;
layout(std430) readonly buffer VoxelItems { uvec4 voxel_items[]; };
layout(std430) readonly buffer VoxelPlaced { ivec4 voxel_placed[]; };
layout(std430) buffer VoxelMasks { uint voxel_words[]; };

struct triangle { // from the corner of the part's box, in steps
    ivec3 a, b, c;
    uint strip, strips; // rows of cells that are this item's: strip, strip + strips ...
};

// ---- whole numbers of 64 bits -------------------------------------------------------------------

struct wide {
    int high;
    uint low;
};

wide wide_cross(ivec2 a, ivec2 b) { // a.x * b.y - a.y * b.x
    int high, more, low, less;
    imulExtended(a.x, b.y, high, low);
    imulExtended(a.y, b.x, more, less);
    uint borrow, rest = usubBorrow(uint(low), uint(less), borrow);
    return wide(high - more - int(borrow), rest);
}

float wide_float(wide w) { // of one that is not negative
    return float(w.high) * 4294967296.0 + float(w.low);
}

bool wide_is_zero(wide w) {
    return w.high == 0 && w.low == 0u;
}

// Whether a point lies left of an edge, `side` being cross(edge, point - its begin); on it where the
// edge is a left or lower one.
bool is_left(wide side, ivec2 edge) {
    if (wide_is_zero(side)) return edge.y < 0 || (edge.y == 0 && edge.x > 0);
    return side.high >= 0;
}

// ---- crossings ----------------------------------------------------------------------------------

// The lines along an axis are columns (u, v); the axis itself is z here.
ivec3 turn(ivec3 v, uint axis) {
    return axis == 0u ? v.yzx : axis == 1u ? v.xzy : v;
}
uvec3 turn_back(uvec3 v, uint axis) {
    return axis == 0u ? v.zxy : axis == 1u ? v.xzy : v;
}

// All cells of a column from one on: the rest of its word, and the words behind that.
void toggle(voxel_masks m, uvec3 cell, uint axis) {
    uint word = axis == 0u   ? m.first[0] + voxel_word_x(m, cell)
                : axis == 1u ? voxel_word_y(m, cell)
                             : voxel_word_z(m, cell);
    uint apart = axis == 0u   ? 1u
                 : axis == 1u ? m.size.x * m.size.z
                              : m.size.x * m.size.y;
    atomicXor(voxel_words[word], ~0u << (cell[axis] & 31u));
    for (uint i = (cell[axis] >> 5) + 1u; i < m.words[axis]; i++) {
        word += apart;
        atomicXor(voxel_words[word], ~0u);
    }
}

// First and last cell whose centre lies in a range, of which neither end is negative.
ivec2 centres(int from, int to) {
    const int half_cell = VOXEL_UNIT / 2;
    return ivec2((from + half_cell - 1) / VOXEL_UNIT, (to + half_cell) / VOXEL_UNIT - 1);
}

void cross_along(uint axis, triangle t, voxel_masks m) {
    ivec3 a = turn(t.a, axis), b = turn(t.b, axis), c = turn(t.c, axis);
    ivec3 size = turn(ivec3(m.size), axis);
    wide area = wide_cross(b.xy - a.xy, c.xy - a.xy);
    if (wide_is_zero(area)) return;
    if (area.high < 0) {
        ivec3 swap = b;
        b = c;
        c = swap;
        area = wide_cross(b.xy - a.xy, c.xy - a.xy);
    }
    ivec2 low = max(min(min(a.xy, b.xy), c.xy), ivec2(0));
    ivec2 high = min(max(max(a.xy, b.xy), c.xy), VOXEL_UNIT * size.xy);
    if (any(lessThan(high, low)) || min(min(a.z, b.z), c.z) > VOXEL_UNIT * size.z) return;
    ivec2 us = centres(low.x, high.x), vs = centres(low.y, high.y);
    us.y = min(us.y, size.x - 1);
    vs.y = min(vs.y, size.y - 1);
    float scale = 1.0 / wide_float(area);
    vec2 depth = vec2(b.z - a.z, c.z - a.z) * scale;
    for (int v = vs.x + int(t.strip); v <= vs.y; v += int(t.strips)) {
        for (int u = us.x; u <= us.y; u++) {
            ivec2 at = VOXEL_UNIT * ivec2(u, v) + VOXEL_UNIT / 2;
            wide toward_a = wide_cross(c.xy - b.xy, at - b.xy);
            wide toward_b = wide_cross(a.xy - c.xy, at - c.xy);
            wide toward_c = wide_cross(b.xy - a.xy, at - a.xy);
            if (!is_left(toward_a, c.xy - b.xy) || !is_left(toward_b, a.xy - c.xy) ||
                !is_left(toward_c, b.xy - a.xy))
                continue;
            float z = float(a.z) + wide_float(toward_b) * depth.x + wide_float(toward_c) * depth.y;
            int cell = max(int(ceil((z - float(VOXEL_UNIT / 2)) / float(VOXEL_UNIT))), 0);
            if (cell < size.z) toggle(m, turn_back(uvec3(u, v, cell), axis), axis);
        }
    }
}

// ---- shell --------------------------------------------------------------------------------------

// Whether a square with its lower corner at `at`, 1 wide, lies outside of an edge of a triangle that
// turns left: Schwarz and Seidel, "Fast parallel surface and solid voxelization on GPUs", 2010.
// A little more than touches counts.
bool is_beyond(vec2 from, vec2 to, vec2 at) {
    vec2 inward = vec2(from.y - to.y, to.x - from.x);
    float most = dot(inward, at - from) + max(inward.x, 0.0) + max(inward.y, 0.0);
    return most < -1e-3 * (abs(inward.x) + abs(inward.y));
}

bool meets_square(vec2 a, vec2 b, vec2 c, bool left, vec2 at) {
    if (!left) {
        vec2 swap = b;
        b = c;
        c = swap;
    }
    return !is_beyond(a, b, at) && !is_beyond(b, c, at) && !is_beyond(c, a, at);
}

// Cells of a slab let no line between 26 neighbours through if it is as thick as the sum of its unit
// normal's components: the standard plane of Andres, Acharya and Sibata, "Discrete analytical
// hyperplanes", 1997. `behind`: cells.
void mark_shell(triangle t, float behind, voxel_masks m) {
    const float step = 1.0 / float(VOXEL_UNIT);
    vec3 sharp = cross(vec3(t.b - t.a), vec3(t.c - t.a)), steep = abs(sharp);
    if (behind * length(sharp) > steep.x + steep.y + steep.z) return;
    uint axis = steep.x > steep.y && steep.x > steep.z ? 0u : steep.y > steep.z ? 1u : 2u;
    vec3 a = vec3(turn(t.a, axis)) * step, b = vec3(turn(t.b, axis)) * step;
    vec3 c = vec3(turn(t.c, axis)) * step, normal = cross(b - a, c - a);
    if (normal.z == 0.0) return; // no area
    ivec3 size = turn(ivec3(m.size), axis);
    vec3 low = min(min(a, b), c), high = max(max(a, b), c);
    ivec3 first = max(ivec3(floor(low - 1e-3)), ivec3(0));
    ivec3 last = min(ivec3(floor(high + 1e-3)), size - 1);
    vec2 slope = -normal.xy / normal.z;
    float spread = 0.5 * (abs(slope.x) + abs(slope.y));
    for (int v = first.y + int(t.strip); v <= last.y; v += int(t.strips)) {
        for (int u = first.x; u <= last.x; u++) {
            if (!meets_square(a.xy, b.xy, c.xy, normal.z > 0.0, vec2(u, v))) continue;
            float z = a.z + dot(slope, vec2(u, v) + 0.5 - a.xy);
            int from = max(int(floor(max(z - spread, low.z))), 0);
            int to = min(int(floor(min(z + spread, high.z))), size.z - 1);
            for (int w = from; w <= to; w++) {
                if (!meets_square(a.yz, b.yz, c.yz, normal.x > 0.0, vec2(v, w)) ||
                    !meets_square(a.zx, b.zx, c.zx, normal.y > 0.0, vec2(w, u)))
                    continue;
                uvec3 cell = turn_back(uvec3(u, v, w), axis);
                atomicOr(voxel_words[m.first[3] + voxel_word_x(m, cell)], 1u << (cell.x & 31u));
            }
        }
    }
}

// Of the body behind an item, in cells; 0 of one that is a shell anyway.
float behind_of(uint flags, voxel_part p) {
    return (flags & VOXEL_SHELL) != 0u ? 0.0 : unpackHalf2x16(flags).y * p.scale.x;
}

void main() {
    uint group = voxel_group();
    if (group >= voxel.count.w) return;
    uvec4 work = voxel_find_work(group, 2u);
    voxel_part p = voxel_parts[work.x];
    uint thread = uint(VOXEL_GROUP) * (group - work.z) + gl_LocalInvocationID.x;
    uint axis = thread / p.mesh.w;
    if (axis > 2u + p.size.w) return;
    uvec4 item = voxel_items[p.mesh.z + thread - axis * p.mesh.w];
    float behind = behind_of(item.w, p);
    if (axis < 3u ? (item.w & VOXEL_CROSSES) == 0u : behind > VOXEL_THIN) return;
    triangle t;
    ivec3 corner = VOXEL_UNIT * ivec3(p.low.xyz);
    t.a = voxel_placed[p.place.x + item.x].xyz - corner;
    t.b = voxel_placed[p.place.x + item.y].xyz - corner;
    t.c = voxel_placed[p.place.x + item.z].xyz - corner;
    t.strip = item.w & 63u;
    t.strips = ((item.w >> 6) & 63u) + 1u;
    voxel_masks m = voxel_find_masks(p);
    if (axis < 3u) cross_along(axis, t, m);
    else mark_shell(t, behind, m);
}
