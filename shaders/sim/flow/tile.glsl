// A tile of a level with what surrounds it, in shared memory, and sweeps of Gauss-Seidel over it:
// r, and the pressure z. Red cells are those whose x + y is even.
#ifndef SIM_FLOW_TILE_GLSL
#define SIM_FLOW_TILE_GLSL

// FLOW_HALO: cells around the tile, before the include
const int FLOW_WIDE = FLOW_TILE + 2 * FLOW_HALO; // even
const int FLOW_TILE_CELLS = FLOW_WIDE * FLOW_WIDE;
shared float flow_tile_r[FLOW_TILE_CELLS];
shared float flow_tile_z[FLOW_TILE_CELLS];

uniform vec2 level_cells;
#define level_size ivec2(level_cells)
uniform int level_at; // where those of the first slice begin, in coefficients
layout(std430) readonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };

// From the tile's first own cell.
int flow_tile_at(ivec2 p) {
    return (p.y + FLOW_HALO) * FLOW_WIDE + p.x + FLOW_HALO;
}

ivec2 flow_tile_first() {
    return ivec2(gl_WorkGroupID.xy) * FLOW_TILE;
}

uint flow_level_cell(ivec2 cell, int slice) {
    return uint((slice * level_size.y + cell.y) * level_size.x + cell.x);
}

uvec2 flow_coefficients_of(ivec2 cell, int slice) {
    return flow_coefficients[uint(level_at) + flow_level_cell(cell, slice)];
}

// The cell's own coefficient; 0: it is no air. And 1 / that.
float flow_diagonal(uvec2 c) {
    return dot(flow_faces_of(c.x), vec4(1.0)) + uintBitsToFloat(c.y);
}
float flow_own(uvec2 c) {
    float d = flow_diagonal(c);
    return d > 0.0 ? 1.0 / d : 0.0;
}

// The tile's own, and in the level.
bool flow_tile_owns(ivec2 p) {
    return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, ivec2(FLOW_TILE))) &&
           flow_within(flow_tile_first() + p, level_size);
}

// The k-th cell of a colour, 0 red, among those at most `border` around the tile.
ivec2 flow_tile_cell(int k, int border, int color) {
    const int half_ = (FLOW_TILE + 2 * border) / 2;
    int y = k / half_ - border, x = k % half_ * 2 - border;
    return ivec2(x + ((x + y + color) & 1), y);
}
int flow_tile_count(int border) {
    return (FLOW_TILE + 2 * border) * (FLOW_TILE + 2 * border) / 2;
}

// Sum over faces of a times z of the neighbour.
float flow_tile_around(int i, uint faces) {
    vec4 z = vec4(flow_tile_z[i - 1], flow_tile_z[i + 1], flow_tile_z[i - FLOW_WIDE],
                  flow_tile_z[i + FLOW_WIDE]);
    return dot(flow_faces_of(faces), z);
}

// The k-th cell of a colour at most `border` around the tile, where it lies in the tile and in the
// level; false: it is not in the level.
bool flow_tile_find(int k, int border, int color, out ivec2 p, out ivec2 cell) {
    p = flow_tile_cell(k, border, color);
    cell = flow_around(flow_tile_first() + p, level_size);
    return flow_within(cell, level_size);
}

// Cells of one colour, with what surrounds the tile.
void flow_tile_sweep(int border, int color, int slice) {
    ivec2 p, cell;
    for (int k = int(gl_LocalInvocationIndex); k < flow_tile_count(border); k += FLOW_GROUP) {
        if (!flow_tile_find(k, border, color, p, cell)) continue;
        int i = flow_tile_at(p);
        uvec2 c = flow_coefficients_of(cell, slice);
        flow_tile_z[i] = (flow_tile_r[i] + flow_tile_around(i, c.x)) * flow_own(c);
    }
    barrier();
}
#endif
