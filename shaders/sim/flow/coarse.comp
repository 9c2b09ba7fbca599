// All levels of at most FLOW_COARSE cells along a side, in one group for each slice, in shared memory. The same
// sweeps as in down.comp and up.comp.
layout(local_size_x = FLOW_COARSE_SIDE, local_size_y = FLOW_COARSE_SIDE) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

uniform vec2 level_cells; // of the first of these levels
uniform vec2 fine_cells;  // of the one before it
#define level_size ivec2(level_cells)
#define fine_size ivec2(fine_cells)
uniform int fine_level_at; // where coefficients of the latter begin
uniform int from_at, z_at;
layout(std430) readonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };
layout(std430) readonly buffer FlowFrom { float from[]; };
layout(std430) writeonly buffer FlowZ { float z_out[]; };

const int MOST = FLOW_COARSE * FLOW_COARSE * 4 / 3 + 16;
shared float r[MOST], z[MOST], d[MOST]; // d: the cell's own coefficient
shared float left[MOST];                // of red cells, after the sweeps down
shared uint a[MOST];

// Threads go over a level in square blocks, so that nothing is divided by its size.
const int SIDE = FLOW_COARSE_SIDE;
#define EACH_CELL(l, cell)                                                                         \
    for (ivec2 cell = ivec2(gl_LocalInvocationID.xy); cell.y < (l).size.y; cell.y += SIDE)         \
        for (cell.x = int(gl_LocalInvocationID.x); cell.x < (l).size.x; cell.x += SIDE)

// ---- levels -----------------------------------------------------------------------------------

struct Level {
    ivec2 size;
    int at;
};

Level coarser(Level l) {
    return Level((l.size + 1) / 2, l.at + l.size.x * l.size.y);
}
bool is_last(Level l) {
    return l.size.x <= 2 && l.size.y <= 2;
}

int place(Level l, ivec2 cell) {
    return l.at + cell.y * l.size.x + cell.x;
}

float z_of(Level l, ivec2 cell) {
    cell = flow_around(cell, l.size);
    return flow_within(cell, l.size) ? z[place(l, cell)] : 0.0;
}

float around(Level l, ivec2 cell) {
    vec4 value = vec4(z_of(l, cell - ivec2(1, 0)), z_of(l, cell + ivec2(1, 0)),
                      z_of(l, cell - ivec2(0, 1)), z_of(l, cell + ivec2(0, 1)));
    return dot(flow_faces_of(a[place(l, cell)]), value);
}

// Of a coarse cell, by the four in it.
void put_coefficients(int at, uvec4 faces, vec4 held, bvec2 there) {
    a[at] = flow_faces_coarse(faces, there);
    d[at] = dot(flow_faces_of(a[at]), vec4(1.0)) + dot(held, vec4(1.0));
}

// What the first of these levels is given.
void load(Level l, int slice) {
    EACH_CELL(l, cell) {
        int own = place(l, cell);
        uvec4 faces;
        vec4 held;
        for (int k = 0; k < 4; k++) {
            ivec2 fine = 2 * cell + ivec2(k & 1, k >> 1);
            bool is = flow_within(fine, fine_size);
            uint at = uint(fine_level_at + (slice * fine_size.y + fine.y) * fine_size.x + fine.x);
            uvec2 c = is ? flow_coefficients[at] : uvec2(0u);
            faces[k] = c.x;
            held[k] = uintBitsToFloat(c.y);
        }
        put_coefficients(own, faces, held, lessThan(2 * cell + 1, fine_size));
        r[own] = from[uint(from_at + slice * l.size.x * l.size.y + own)];
    }
    barrier();
}

// ---- sweeps -----------------------------------------------------------------------------------

void sweep(Level l, int color) {
    EACH_CELL(l, cell) {
        int at = place(l, cell);
        if (((cell.x + cell.y) & 1) == color)
            z[at] = d[at] > 0.0 ? (r[at] + around(l, cell)) / d[at] : 0.0;
    }
    barrier();
}

void begin(Level l) {
    EACH_CELL(l, cell) {
        int at = place(l, cell);
        z[at] = ((cell.x + cell.y) & 1) == 0 && d[at] > 0.0 ? r[at] / d[at] : 0.0;
    }
    barrier();
    for (int i = 1; i < 2 * FLOW_SWEEPS; i++) sweep(l, i & 1);
}

void leave(Level l) {
    EACH_CELL(l, cell) {
        int at = place(l, cell);
        float r_left = r[at] - d[at] * z[at] + around(l, cell);
        if (((cell.x + cell.y) & 1) == 0) left[at] = d[at] > 0.0 ? r_left : 0.0;
    }
    barrier();
}

void restrict_(Level fine, Level coarse) {
    EACH_CELL(coarse, cell) {
        int own = place(coarse, cell);
        float sum = 0.0;
        for (int j = 0; j < 8; j++) {
            ivec2 o = ivec2(j % 2 * 2 + (j / 2 & 1), j / 2);
            ivec2 from_ = flow_around(2 * cell - 1 + o, fine.size);
            if (!flow_within(from_, fine.size) || !all(flow_asked(o, fine.size))) continue;
            sum += flow_share(from_, cell, coarse.size) * left[place(fine, from_)];
        }
        uvec4 faces = uvec4(0u);
        vec4 held = vec4(0.0);
        for (int k = 0; k < 4; k++) {
            ivec2 child = 2 * cell + ivec2(k & 1, k >> 1);
            if (!flow_within(child, fine.size)) continue;
            int at = place(fine, child);
            faces[k] = a[at];
            held[k] = d[at] - dot(flow_faces_of(a[at]), vec4(1.0));
        }
        r[own] = sum;
        put_coefficients(own, faces, held, lessThan(2 * cell + 1, fine.size));
    }
    barrier();
}

void add(Level fine, Level coarse) { // to red cells; black ones are made anew
    EACH_CELL(fine, cell) {
        int at = place(fine, cell);
        if (((cell.x + cell.y) & 1) != 0) continue;
        ivec2 own = cell >> 1, other = flow_others(cell, coarse.size);
        float more = 0.5625 * z_of(coarse, own);
        if (other.x >= 0) more += 0.1875 * z_of(coarse, ivec2(other.x, own.y));
        if (other.y >= 0) more += 0.1875 * z_of(coarse, ivec2(own.x, other.y));
        if (other.x >= 0 && other.y >= 0) more += 0.0625 * z_of(coarse, other);
        if (d[at] > 0.0) z[at] += more;
    }
    barrier();
}

void main() {
    int slice = int(gl_WorkGroupID.z);
    if (flow_stopped(slice)) return;
    Level l = Level(level_size, 0);
    int depth = 0;
    load(l, slice);
    for (; !is_last(l); depth++) {
        begin(l);
        leave(l);
        restrict_(l, coarser(l));
        l = coarser(l);
    }
    begin(l);
    for (int i = 2 * FLOW_SWEEPS; i < 7; i++) sweep(l, i & 1); // red first and last
    for (; depth > 0; depth--) {
        Level fine = Level(level_size, 0);
        for (int i = 1; i < depth; i++) fine = coarser(fine);
        add(fine, coarser(fine));
        for (int i = 2 * FLOW_SWEEPS; i > 0; i--) sweep(fine, 1 - (i & 1));
    }
    Level first = Level(level_size, 0);
    EACH_CELL(first, cell) {
        int own = place(first, cell);
        z_out[uint(z_at + slice * level_size.x * level_size.y + own)] = z[own];
    }
}
