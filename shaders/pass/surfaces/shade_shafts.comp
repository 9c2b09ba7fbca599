// Finds out for each tile of the picture and each light which leaves of the meshes' trees may stand
// between them (shade/shafts.glsl). A work group is a tile, and a thread a light.
uniform sampler2D albedo;
uniform sampler2D normal;
uniform sampler2D depth;
uniform float lod; // px
uniform int width;  // of the picture
uniform int height;
#include "lib/frame.glsl"
#include "lib/bvh.glsl"
#include "lib/lighting.glsl"
#include "shade/surface.glsl"
#include "shade/shafts.glsl"
#define THREADS 64
layout(local_size_x = THREADS) in;

// The box of all points of the tile, by atomic operations on numbers that are ordered as the floats.
shared uint tile_low[3];
shared uint tile_high[3];

uint order_of(float v) {
    uint bits = floatBitsToUint(v);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float float_of(uint order) {
    return uintBitsToFloat((order & 0x80000000u) != 0u ? order & 0x7fffffffu : ~order);
}

void add_points() {
    vec3 low = vec3(1e30), high = vec3(-1e30);
    for (uint k = gl_LocalInvocationIndex; k < SHAFT_TILE * SHAFT_TILE; k += THREADS) {
        uvec2 pixel = gl_WorkGroupID.xy * SHAFT_TILE + uvec2(k % SHAFT_TILE, k / SHAFT_TILE);
        surface_point s = surface_at((vec2(pixel) + 0.5) / vec2(width, height));
        if (pixel.x >= uint(width) || pixel.y >= uint(height) || s.base.a == 0.0) continue;
        low = min(low, s.p);
        high = max(high, s.p);
    }
    if (low.x > high.x) return;
    for (int a = 0; a < 3; a++) {
        atomicMin(tile_low[a], order_of(low[a]));
        atomicMax(tile_high[a], order_of(high[a]));
    }
}

// All lines from a box to another, or into a cone of directions: at s, which runs from 0 to `end`,
// they are between low + s * low_way and high + s * high_way.
struct shaft {
    vec3 low, high, low_way, high_way;
    float end;
};

// s at which a side of the shaft passes one of the box, as the earliest (x) or the latest (y) at
// which they can meet.
bool shaft_meets(shaft f, vec3 low, vec3 high) {
    vec2 range = vec2(0.0, f.end);
    for (int a = 0; a < 3; a++) {
        float leave = (high[a] - f.low[a]) / f.low_way[a], enter = (low[a] - f.high[a]) / f.high_way[a];
        if (f.low_way[a] > 0.0) range.y = min(range.y, leave * 1.00001);
        else range.x = max(range.x, leave * 0.99999);
        if (f.high_way[a] < 0.0) range.y = min(range.y, enter * 1.00001);
        else range.x = max(range.x, enter * 0.99999);
    }
    return range.x <= range.y;
}

vec3 never_zero(vec3 way) {
    return mix(way, vec3(1e-20), lessThan(abs(way), vec3(1e-20)));
}

// From the box with this middle and half size to a sphere, or to the sun's disc, in the space of a
// mesh, or (instance < 0) of the world.
shaft shaft_to(light l, vec3 middle, vec3 extent, int instance) {
    mat3 turn = mat3(1.0);
    vec3 moved = vec3(0.0);
    if (instance >= 0) {
        vec4 x = bvh_instances[instance].inverse[0], y = bvh_instances[instance].inverse[1];
        vec4 z = bvh_instances[instance].inverse[2];
        turn = transpose(mat3(x.xyz, y.xyz, z.xyz));
        moved = vec3(x.w, y.w, z.w);
    }
    mat3 size = mat3(abs(turn[0]), abs(turn[1]), abs(turn[2]));
    vec3 at = turn * middle + moved, half_size = size * extent, wide = size * vec3(l.radius);
    half_size += 1e-6 * (abs(at) + half_size); // rounding
    vec3 low = at - half_size, high = at + half_size, goal = turn * l.position;
    if (l.kind == LIGHT_SUN) return shaft(low, high, never_zero(goal - wide), never_zero(goal + wide), 1e9);
    goal += moved;
    return shaft(low, high, never_zero(goal - wide - low), never_zero(goal + wide - high), 1.0);
}

// The next leaf of a walk that enters all children that the shaft meets; 0: there is none.
uint next_leaf(shaft f, inout bvh_walk w) {
    uint at = w.below;
    w.below = 0u;
    while (at >> 28 == 0u) {
        for (int i = 0; i < 4 && at != 0u; i++) {
            vec3 low = vec3(bvh_nodes[at].low[0][i], bvh_nodes[at].low[1][i], bvh_nodes[at].low[2][i]);
            vec3 high = vec3(bvh_nodes[at].high[0][i], bvh_nodes[at].high[1][i], bvh_nodes[at].high[2][i]);
            if (shaft_meets(f, low, high)) bvh_kept[w.top++] = bvh_nodes[at].below[i];
        }
        if (w.top == w.bottom) return 0u;
        at = bvh_kept[--w.top];
    }
    return at;
}

// Adds leaves of a tree to the list; past its end when there are more than it holds.
void collect(shaft f, uint instance, int outer_top, uint list, inout uint count) {
    bvh_walk w = bvh_begin(bvh_instances[instance].below, outer_top);
    for (uint leaf; count <= SHAFT_LEAVES && (leaf = next_leaf(f, w)) != 0u;) {
        count++;
        if (!shaft_can_hold(instance, leaf)) count = SHAFT_LEAVES + 1u;
        if (count <= SHAFT_LEAVES) shaft_words[list + count] = shaft_pack(instance, leaf);
    }
}

void main() {
    if (gl_LocalInvocationIndex < 3u) {
        tile_low[gl_LocalInvocationIndex] = 0xffffffffu;
        tile_high[gl_LocalInvocationIndex] = 0u;
    }
    barrier();
    add_points();
    barrier();
    int index = int(gl_LocalInvocationIndex);
    if (index >= shaft_lights || tile_low[0] > tile_high[0]) return;
    vec3 low = vec3(float_of(tile_low[0]), float_of(tile_low[1]), float_of(tile_low[2]));
    vec3 high = vec3(float_of(tile_high[0]), float_of(tile_high[1]), float_of(tile_high[2]));
    vec3 middle = 0.5 * (low + high), extent = 0.5 * (high - low);
    light l = light_get(index);
    shaft world = shaft_to(l, middle, extent, -1);
    uint list = shaft_start(index), count = 0u;
    bvh_walk w = bvh_begin(bvh_count.y, 0);
    for (uint leaf; count <= SHAFT_LEAVES && (leaf = next_leaf(world, w)) != 0u;)
        for (uint i = bvh_first(leaf); i < bvh_end(leaf) && count <= SHAFT_LEAVES; i++)
            if (shaft_meets(world, bvh_instances[i].low, bvh_instances[i].high))
                collect(shaft_to(l, middle, extent, int(i)), i, w.top, list, count);
    shaft_words[list] = count;
}
