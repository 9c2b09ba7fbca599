// A thread for each particle: small ones are drawn at once, the others kept and counted for the
// tiles that they touch.
#if defined(STAGE_PROJECT) && BLEND != BLEND_SORTED

// A point of the picture, in the four pixels around it: whatever its place, all of it is in them.
struct point {
    ivec2 corner; // the first of the four
    vec2 part;    // of it that is in the others, by x and y
    float depth;  // m
    vec3 light;
    float opacity;
    uint seed;
};

// Streaks are points no more than a pixel apart.
int count_points(looks l) {
    return max(int(ceil(distance(l.s.at, l.before.xy))), 1);
}

point point_of(looks l, int index, int count) {
    vec4 mean = look_mean(l.s);
    vec3 at = vec3(l.s.at, l.s.depth);
    if (count > 1) at = mix(at, l.before, (float(index) + 0.5) / float(count));
    vec2 corner = floor(at.xy - 0.5);
    float opacity = l.s.opacity * mean.a * l.s.radius * l.s.radius / float(count);
    return point(ivec2(corner), at.xy - 0.5 - corner, at.z, l.s.color * mean.rgb,
                 opacity * splat_visible(ivec2(floor(at.xy)), at.z), l.s.seed);
}

// What of it is in the pixel of that number, 0..3.
splat_sum point_part(point p, int number, out ivec2 pixel) {
    ivec2 side = ivec2(number & 1, number >> 1);
    vec2 share = mix(1.0 - p.part, p.part, vec2(side));
    pixel = p.corner + side;
    bool outside = any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(picture)));
    if (outside || p.opacity <= 0.0) return splat_sum(uvec3(0u), 0u, 0u);
    return splat_part(p.light, p.opacity * share.x * share.y, p.depth, p.seed, pixel);
}

#if GATHERED
// Where threads wait for memory rather than for each other, neighbours add what lies side by side:
// the two pixels of a row, and their channels. The same numbers, in fewer accesses.
const uint PARTS = 4u * CHANNELS;
shared uint gathered[SCANNERS * PARTS], gathered_at[SCANNERS], gathered_most;

void put_part(uint place, splat_sum sum) {
    for (uint i = 0u; i < 3u; i++) gathered[place + i] = sum.color[i];
#if BLEND == BLEND_WEIGHTED
    gathered[place + 3u] = sum.weight;
    gathered[place + 4u] = sum.log;
#endif
}

void put_point(point p) {
    uint thread = gl_LocalInvocationIndex;
    ivec2 pixel;
    gathered_at[thread] = uint(p.corner.y * int(picture.x) + p.corner.x); // beyond an edge all is 0
    for (int k = 0; k < 4; k++) put_part(PARTS * thread + CHANNELS * uint(k), point_part(p, k, pixel));
}

void add_gathered() {
    for (uint i = gl_LocalInvocationIndex; i < SCANNERS * PARTS; i += SCANNERS) {
        uint part = gathered[i], within = i % PARTS, row = within / (2u * CHANNELS);
        if (part == 0u) continue;
        uint pixel = gathered_at[i / PARTS] + row * uint(picture.x);
        atomicAdd(splat_sums[CHANNELS * pixel + within % (2u * CHANNELS)], part);
    }
}

void add_small(looks l, bool small) {
    int count = small ? count_points(l) : 0;
    if (gl_LocalInvocationIndex == 0u) gathered_most = 0u;
    barrier();
    atomicMax(gathered_most, uint(count));
    barrier();
    for (int i = 0; i < int(gathered_most); i++) {
        if (i < count)
            put_point(point_of(l, i, count));
        else
            for (uint k = 0u; k < PARTS; k++) gathered[PARTS * gl_LocalInvocationIndex + k] = 0u;
        barrier();
        add_gathered();
        barrier();
    }
}
#else
void add_small(looks l, bool small) {
    int count = small ? count_points(l) : 0;
    for (int i = 0; i < count; i++) {
        point p = point_of(l, i, count);
        for (int k = 0; k < 4 && p.opacity > 0.0; k++) {
            ivec2 pixel;
            splat_sum part = point_part(p, k, pixel);
            if (part.color != uvec3(0u) || part.log != 0u) splat_add(part, pixel);
        }
    }
}
#endif

void count_tiles(splat s) {
    ivec4 box = splat_tile_box(s);
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++)
            if (splat_meets(s, ivec2(x, y))) atomicAdd(splat_tiles[splat_tile(ivec2(x, y))].y, 1u);
}

void add_tiles(splat s) {
    ivec4 box = splat_tile_box(s);
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++)
            if (splat_meets(s, ivec2(x, y))) splat_add_tile(s, ivec2(x, y));
}

// All pixels of its box, by atomics.
void add_pixels(splat s) {
    vec2 extent = splat_extent(s);
    ivec2 low = ivec2(max(floor(s.at - extent), vec2(0.0))), high = ivec2(min(ceil(s.at + extent), picture));
    for (int y = low.y; y < high.y; y++)
        for (int x = low.x; x < high.x; x++) {
            splat_sum part = splat_part_at(s, ivec2(x, y));
            if (part.color != uvec3(0u) || part.log != 0u) splat_add(part, ivec2(x, y));
        }
}

// The number of one that is kept: a group asks for all of its own at once, where one number that all
// count up is what they would wait for.
#if GATHERED
shared uint kept_here, kept_before;

uint take_number(bool kept) {
    if (gl_LocalInvocationIndex == 0u) kept_here = 0u;
    barrier();
    uint own = kept ? atomicAdd(kept_here, 1u) : 0u;
    barrier();
    if (gl_LocalInvocationIndex == 0u && kept_here > 0u) kept_before = atomicAdd(splat_found, kept_here);
    barrier();
    return kept_before + own;
}
#else
uint take_number(bool kept) {
    return kept ? atomicAdd(splat_found, 1u) : 0u;
}
#endif

void main() {
    looks l = look_at(slot_of_thread());
    bool small = l.seen && l.s.radius <= SMALL && distance(l.s.at, l.before.xy) <= SHORT, kept = false;
    count_small(small ? 1 : 0);
    count_large(l.seen && !small ? 1 : 0);
    add_small(l, small);
    splat s;
    if (l.seen && !small) {
        s = look_spread(l);
        kept = s.radius + s.reach > DIRECT;
        if (!kept) add_pixels(s);
    }
    uint number = take_number(kept);
    if (!kept) return;
    if (number < records_most) {
        splat_keep(number, s);
        count_tiles(s);
    } else {
        add_tiles(s);
    }
}
#endif
