// Light through the volume in a few directions, by the method of discrete ordinates with short
// characteristics: Kunasz and Auer, "Short characteristic integration of radiative transfer
// problems", 1988; on grids for pictures: Fattal, "Participating media illumination using light
// propagation maps", 2009.
//
// SWEEP: one workgroup for a direction and a colour takes slice after slice across it, each from the
// one before; a thread has two cells beside each other, or several such pairs where the device's
// groups are too small for a slice. RESTRICT and REDUCE (lighting/level.glsl) find the mean of all
// directions and the first moment, which the next sweep scatters.

#if defined(STAGE_SWEEP) || defined(STAGE_RESTRICT) || defined(STAGE_REDUCE)
// The axis that slices of a direction follow each other on.
int axis_of(vec3 way) {
    vec3 a = abs(way) / max(box_max - box_min, vec3(1e-6));
    return a.x >= max(a.y, a.z) ? 0 : a.y >= a.z ? 1 : 2;
}
#endif

#if defined(STAGE_RESTRICT) || defined(STAGE_REDUCE)
layout(std430) readonly buffer Ways { uint ways[]; };

// Of the light from all directions, as the last sweep found it.
vec4 moments_of(ivec3 voxel, int color) {
    vec4 moments = vec4(0.0);
    for (int turn = 0; turn < TURNS; turn++) {
        int place = place_along(axis_of(turn_of(turn)), voxel);
        vec4 sums = vec4(0.0);
        for (int i = 0; i < SIGNS; i++) {
            int way = turn * SIGNS + i;
            vec2 two = unpackHalf2x16(ways[((way * 3 + color) * VOXELS + place) / 2]);
            float light = (place & 1) == 0 ? two.x : two.y;
            sums += vec4(light, mix(vec3(light), vec3(-light), signs_of(i)));
        }
        moments += sums * vec4(1.0, turn_of(turn));
    }
    return moments / float(WAYS);
}
#endif

#if defined(STAGE_SWEEP)
const int ACROSS = LEVEL_SIZE / 2, PAIRS = ACROSS * LEVEL_SIZE; // of cells
const int ROUNDS = (PAIRS + MOST_THREADS - 1) / MOST_THREADS, THREADS = PAIRS / ROUNDS;
const bool CORRECTS = LEVEL_SIZE < GLOW_SIZE; // what it sweeps is a difference (lighting/level.glsl)
layout(local_size_x = THREADS) in;
layout(std430) readonly buffer Source { uvec4 source_slices[]; };
layout(std430) readonly buffer Medium { uvec2 medium_slices[]; };
layout(std430) writeonly buffer Ways { uint ways[]; };

// What leaves the cells of the slice before, and of the one at hand; around it a border of nothing.
// With SLICES_KEPT 1 the latter takes the place of the former once nobody reads that any more.
const int ROW = ACROSS + 2;
shared vec2 leaving[SLICES_KEPT][(LEVEL_SIZE + 2) * ROW];
// Of both cells the source function, light per part of the light that is taken, and the part of the
// light that half a voxel takes; of more than a half that it lets through, below 0.
shared uvec2 halves[SLICES_KEPT][(LEVEL_SIZE + 2) * ROW];

struct path { // of a direction through the grid
    vec3 way;
    int axis;        // the one slices follow each other on
    bvec2 side;      // whether the way comes from lower cells, on the other two
    vec2 weight;     // of the cell there, one slice before
    float half_step; // from slice to slice: half of it, in widths of a voxel
    float outside;   // light that enters the box
};

path make_path(int index, int color) {
    vec3 way = way_of(index);
    vec3 cells = way / max(voxel_size(), vec3(1e-6));
    int axis = axis_of(way);
    cells = axis == 0 ? cells.yzx : axis == 1 ? cells.zxy : cells;
    float outside = 0.0;
    for (int part = 0; part < LOOK_PARTS && !CORRECTS; part++)
        outside += texelFetch(around_made, ivec3(index, part, 0), 0)[color];
    return path(way, axis, greaterThan(cells.xy, vec2(0.0)), min(abs(cells.xy / cells.z), vec2(1.0)),
                0.5 / (abs(cells.z) * voxel_width()), outside);
}

// Mean of exp(-t) from 0 to t, where that is `through` at t.
vec2 mean_through(vec2 t, vec2 through) {
    return mix((1.0 - through) / max(t, vec2(1e-6)), 1.0 - 0.5 * t, lessThan(t, vec2(1e-2)));
}

uvec2 to_halves(vec2 scattered, vec2 passed) {
    vec2 kept = mix(1.0 - passed, -passed, lessThan(passed, vec2(0.5)));
    return uvec2(half_pair(scattered.x, kept.x), half_pair(scattered.y, kept.y));
}

// Scattered and taken, of one cell and the other.
vec4 from_halves(uvec2 two) {
    vec4 found = vec4(unpackHalf2x16(two.x), unpackHalf2x16(two.y));
    found.yw += vec2(lessThan(found.yw, vec2(0.0)));
    return found;
}

// Of a row of the slice before: between each of two cells and the one to its side.
vec2 leaving_of(path on, int before, int at) {
    vec2 own = leaving[before][at];
    return mix(own, on.side.x ? vec2(leaving[before][at - 1].y, own.x) : vec2(own.y, leaving[before][at + 1].x),
               on.weight.x);
}

vec4 halves_of(path on, int before, int at) {
    uvec2 own = halves[before][at];
    uvec2 side = on.side.x ? uvec2(halves[before][at - 1].y, own.x) : uvec2(own.y, halves[before][at + 1].x);
    return mix(from_halves(own), from_halves(side), on.weight.x);
}

// What a slice has for a pair of cells, and the part of what comes from the slice before that comes
// from inside of the box.
struct pair {
    int here, beside; // in shared memory
    vec2 inside;
};

pair make_pair(path on, int index) {
    ivec2 cell = ivec2(index % ACROSS * 2, index / ACROSS);
    int here = (cell.y + 1) * ROW + cell.x / 2 + 1;
    bvec2 in_x = on.side.x ? bvec2(cell.x > 0, true) : bvec2(true, cell.x < LEVEL_SIZE - 2);
    bool in_y = on.side.y ? cell.y > 0 : cell.y < LEVEL_SIZE - 1;
    return pair(here, here + (on.side.y ? -ROW : ROW),
                (1.0 - on.weight.x * vec2(not(in_x))) * (in_y ? 1.0 : 1.0 - on.weight.y));
}

void main() {
    int index = int(gl_WorkGroupID.x) / 3, color = int(gl_WorkGroupID.x) % 3;
    int thread = int(gl_LocalInvocationIndex);
    path on = make_path(index, color);
    bool forward = on.way[on.axis] > 0.0;

    for (int i = thread; i < ROW * (LEVEL_SIZE + 2); i += THREADS)
        for (int k = 0; k < SLICES_KEPT; k++) {
            leaving[k][i] = vec2(0.0);
            halves[k][i] = uvec2(0);
        }

    vec3 factor = medium_extinction();
    float grey = max(factor.r, max(factor.g, factor.b)), power = factor[color] / max(grey, 1e-9);
    vec4 asked = vec4(1.0, on.way); // of the moments
    int slices = (on.axis * 3 + color) * LEVEL_SIZE, kept = int(gl_WorkGroupID.x) * LEVEL_SIZE;
    int slice = forward ? 0 : LEVEL_SIZE - 1, before = 0;
    uvec4 next_source[ROUNDS];
    uvec2 next_medium[ROUNDS];
    pair pairs[ROUNDS];
#if SLICES_KEPT == 1
    vec2 own_leaving[ROUNDS];
    uvec2 own_halves[ROUNDS];
#endif
    for (int r = 0; r < ROUNDS; r++) {
        int own = r * THREADS + thread;
        pairs[r] = make_pair(on, own);
        next_source[r] = source_slices[(slices + slice) * PAIRS + own];
        next_medium[r] = medium_slices[(slices + slice) * PAIRS + own];
    }
    barrier();

    for (int k = 0; k < LEVEL_SIZE; k++) {
        int after = clamp(slice + (forward ? 1 : -1), 0, LEVEL_SIZE - 1);
        for (int r = 0; r < ROUNDS; r++) {
            pair p = pairs[r];
            uvec4 source = next_source[r];
            vec2 first = unpackHalf2x16(next_medium[r].x), second = unpackHalf2x16(next_medium[r].y);
            next_source[r] = source_slices[(slices + after) * PAIRS + r * THREADS + thread];
            next_medium[r] = medium_slices[(slices + after) * PAIRS + r * THREADS + thread];

            vec2 own = vec2(dot(asked, vec4(unpackHalf2x16(source.x), unpackHalf2x16(source.y))),
                            dot(asked, vec4(unpackHalf2x16(source.z), unpackHalf2x16(source.w))));
            if (!CORRECTS) own = max(own, vec2(0.0));
            vec2 known = k > 0 ? p.inside : vec2(0.0);
            vec2 from_light = mix(leaving_of(on, before, p.here), leaving_of(on, before, p.beside), on.weight.y);
            vec4 from = mix(halves_of(on, before, p.here), halves_of(on, before, p.beside), on.weight.y);
            from_light += (1.0 - known) * on.outside;
            from.xz += (1.0 - known) * own;

            // From centre to centre the source changes linearly with what is taken, which keeps the limit
            // of thick voxels, diffusion; emission is constant in each of the halves.
            vec2 thickness = on.half_step * vec2(first.x, second.x);
            vec2 half_depth = thickness * factor[color], through = exp(-half_depth);
            vec2 given = on.half_step * vec2(first.y, second.y) * mean_through(half_depth, through);
            // Of the half before only the colour that loses most is known; the others are powers of it.
            vec2 depth = half_depth - log(max(1.0 - from.yw, vec2(1e-6))) * power, left = exp(-depth);
            vec2 early = mix(mean_through(depth, left) - left, 0.5 * depth, lessThan(depth, vec2(1e-2)));
            vec2 late = max(1.0 - left - early, vec2(0.0));
            vec2 made = from_light * through + given + from.xz * early + own * late;
            ways[(kept + slice) * PAIRS + r * THREADS + thread] = half_pair(made.x, made.y);

#if SLICES_KEPT == 1
            own_leaving[r] = made * through + given;
            own_halves[r] = to_halves(own, exp(-thickness * grey));
        }
        barrier();
        for (int r = 0; r < ROUNDS; r++) {
            leaving[0][pairs[r].here] = own_leaving[r];
            halves[0][pairs[r].here] = own_halves[r];
        }
#else
            leaving[1 - before][p.here] = made * through + given;
            halves[1 - before][p.here] = to_halves(own, exp(-thickness * grey));
        }
        before = 1 - before;
#endif
        slice = after;
        barrier();
    }
}
#endif
