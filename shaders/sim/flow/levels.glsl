// The pressure's equation on the cells of a level, and how levels fit together.
//
// For each cell: sum over faces of a (p - p of the neighbour) + lambda p = r. `a` is 1 between two
// cells of air, 0 where nothing flows, 2 at an open face, beyond which p is 0 on the face itself;
// lambda is what a template holds the cell by. In 2D the same numbers hold on all levels: a of a
// coarse face is the mean of the two faces that it is made of, lambda the sum of four cells, r the
// sum of what is left on the finer level.
//
// A level has half the cells of the one before it, rounded up. A coarse cell's value reaches a fine
// one by linear interpolation: 3/4 from the cell that it lies in, 1/4 from the next one.
#ifndef SIM_FLOW_LEVELS_GLSL
#define SIM_FLOW_LEVELS_GLSL

// ---- coefficients -----------------------------------------------------------------------------

// Of the faces left, right, bottom, top: 64ths, a byte each.
const float FLOW_FACE_UNIT = 1.0 / 64.0;

uint flow_faces_pack(uvec4 faces) {
    return faces.x | faces.y << 8 | faces.z << 16 | faces.w << 24;
}
uvec4 flow_faces_unpack(uint packed) {
    return uvec4(packed, packed >> 8, packed >> 16, packed >> 24) & 255u;
}
vec4 flow_faces_of(uint packed) {
    return vec4(flow_faces_unpack(packed)) * FLOW_FACE_UNIT;
}

// Of a coarse cell, by the four finer ones in it: (0, 0), (1, 0), (0, 1), (1, 1). One that is not
// there has no faces, and what is beyond its place are those of the one before it.
uint flow_faces_coarse(uvec4 children, bvec2 there) {
    uvec4 a = flow_faces_unpack(children.x), b = flow_faces_unpack(children.y);
    uvec4 c = flow_faces_unpack(children.z), d = flow_faces_unpack(children.w);
    uvec2 right = there.x ? uvec2(b.y, d.y) : uvec2(a.y, c.y);
    uvec2 top = there.y ? uvec2(c.w, d.w) : uvec2(a.w, b.w);
    uvec4 sum = uvec4(a.x + c.x, right.x + right.y, a.z + b.z, top.x + top.y);
    return flow_faces_pack((sum + 1u) / 2u);
}

// ---- places -----------------------------------------------------------------------------------

// Where a cell beyond the end goes on: it may still be outside.
ivec2 flow_around(ivec2 cell, ivec2 size) {
    if (FLOW_AROUND_X) cell.x = (cell.x + 4 * size.x) % size.x;
    if (FLOW_AROUND_Y) cell.y = (cell.y + 4 * size.y) % size.y;
    return cell;
}

bool flow_within(ivec2 cell, ivec2 size) {
    return all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, size));
}

// ---- between levels ---------------------------------------------------------------------------

// Which coarse cell besides its own a fine one is interpolated from; -1: none, p is 0 there.
int flow_other(int fine, int coarse_count, bool around, bvec2 open) {
    int other = (fine & 1) == 0 ? (fine >> 1) - 1 : (fine >> 1) + 1;
    if (other >= 0 && other < coarse_count) return other;
    if (around) return (other + coarse_count) % coarse_count;
    return (other < 0 ? open.x : open.y) ? -1 : fine >> 1;
}

ivec2 flow_others(ivec2 fine, ivec2 coarse_size) {
    const bvec2 open_x = bvec2(FLOW_FACE_LEFT == FLOW_OPEN, FLOW_FACE_RIGHT == FLOW_OPEN);
    const bvec2 open_y = bvec2(FLOW_FACE_BOTTOM == FLOW_OPEN, FLOW_FACE_TOP == FLOW_OPEN);
    return ivec2(flow_other(fine.x, coarse_size.x, FLOW_AROUND_X, open_x),
                 flow_other(fine.y, coarse_size.y, FLOW_AROUND_Y, open_y));
}

// What a coarse cell gets of a fine one: the transpose of interpolation, so that a cycle is
// symmetric.
float flow_share(ivec2 fine, ivec2 coarse, ivec2 coarse_size) {
    ivec2 others = flow_others(fine, coarse_size);
    vec2 own = mix(vec2(0.0), vec2(0.75), equal(fine >> 1, coarse));
    vec2 other = mix(vec2(0.0), vec2(0.25), equal(others, coarse));
    return (own.x + other.x) * (own.y + other.y);
}

// Fine cells that a coarse one may get a share of are first + (0 to 3) along each axis; those that
// go around to one that was there already are not asked twice.
bvec2 flow_asked(ivec2 i, ivec2 size) {
    return bvec2(!FLOW_AROUND_X || i.x < size.x, !FLOW_AROUND_Y || i.y < size.y);
}
#endif
