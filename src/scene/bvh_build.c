// Splits by the surface area heuristic over bins: Wald, "On fast construction of SAH-based bounding
// volume hierarchies", 2007. Each node has a link past its subtree, so that a walk in a
// fixed order needs no stack: Smits, "Efficiency issues for ray tracing", 1998.
#include "scene/bvh_build.h"
#include "base/maths.h"
#include "base/memory.h"
#include <math.h>

enum { BINS = 16 };

bvh_bounds bvh_bounds_empty(void) {
    return (bvh_bounds){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}

void bvh_bounds_add(bvh_bounds *b, const bvh_bounds *other) {
    for (int a = 0; a < 3; a++) { // fminf would call a function
        b->low[a] = other->low[a] < b->low[a] ? other->low[a] : b->low[a];
        b->high[a] = other->high[a] > b->high[a] ? other->high[a] : b->high[a];
    }
}

float bvh_bounds_area(const bvh_bounds *b) {
    float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

// ---- splitting --------------------------------------------------------------------------------

typedef struct plane { // between two bins of an axis
    int axis, bin;
    float low, scale; // bin of a middle: (middle - low) * scale
    float cost;       // of a ray, in pieces that it meets
} plane;

static int bin_of(const bvh_piece *p, const plane *at) {
    int bin = (int)((p->middle[at->axis] - at->low) * at->scale);
    return bin < BINS - 1 ? bin : BINS - 1;
}

static void try_axis(const bvh_build *b, const bvh_piece *pieces, size_t count, plane at,
                     float area, plane *best) {
    struct {
        bvh_bounds box;
        size_t count;
    } bins[BINS];
    for (int i = 0; i < BINS; i++) {
        bins[i].box = bvh_bounds_empty();
        bins[i].count = 0;
    }
    for (size_t i = 0; i < count; i++) {
        int bin = bin_of(&pieces[i], &at);
        bvh_bounds_add(&bins[bin].box, &pieces[i].box);
        bins[bin].count++;
    }
    float before[BINS]; // area times count of what lies left of each plane
    bvh_bounds box = bvh_bounds_empty();
    size_t sum = 0;
    for (int i = 0; i < BINS - 1; i++) {
        bvh_bounds_add(&box, &bins[i].box);
        sum += bins[i].count;
        before[i] = bvh_bounds_area(&box) * (float)sum;
    }
    box = bvh_bounds_empty();
    sum = 0;
    for (int i = BINS - 2; i >= 0; i--) {
        bvh_bounds_add(&box, &bins[i + 1].box);
        sum += bins[i + 1].count;
        at.bin = i;
        at.cost = b->node_cost + (before[i] + bvh_bounds_area(&box) * (float)sum) / area;
        if (sum > 0 && sum < count && at.cost < best->cost) *best = at;
    }
}

static plane best_plane(const bvh_build *b, const bvh_piece *pieces, size_t count, float area) {
    plane best = {.axis = -1, .cost = INFINITY};
    bvh_bounds middles = bvh_bounds_empty();
    for (size_t i = 0; i < count; i++) {
        bvh_bounds point;
        for (int a = 0; a < 3; a++) point.low[a] = point.high[a] = pieces[i].middle[a];
        bvh_bounds_add(&middles, &point);
    }
    for (int a = 0; a < 3; a++) {
        plane at = {.axis = a, .low = middles.low[a]};
        at.scale = BINS / (middles.high[a] - middles.low[a]);
        if (isfinite(at.scale) && at.scale > 0) try_axis(b, pieces, count, at, area, &best);
    }
    return best;
}

static size_t partition(bvh_piece *pieces, size_t count, const plane *at) {
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        if (bin_of(&pieces[i], at) > at->bin) continue;
        bvh_piece swap = pieces[left];
        pieces[left++] = pieces[i];
        pieces[i] = swap;
    }
    return left;
}

// Whether a tree over so many pieces still fits below a node at this depth when they are only
// halved from there on.
static bool is_free(size_t count, int depth) {
    return depth + 1 < BVH_DEPTH && count >> (BVH_DEPTH - 1 - depth) == 0;
}

// How many of the pieces, then the first ones, go to the first child; 0: they are a leaf.
static size_t bvh_split(const bvh_build *b, bvh_piece *pieces, size_t count, const bvh_bounds *box,
                        int depth) {
    if (count == 1) return 0;
    plane best = {.axis = -1, .cost = INFINITY};
    if (is_free(count, depth)) best = best_plane(b, pieces, count, bvh_bounds_area(box));
    if (count <= BVH_LEAF_SIZE && !(best.cost < (float)count)) return 0;
    return best.axis < 0 ? count / 2 : partition(pieces, count, &best);
}

// ---- nodes ------------------------------------------------------------------------------------

static void fill_node(bvh_build *b, size_t index, bvh_piece *pieces, size_t count, int depth,
                      uint32_t next) {
    bvh_bounds box = bvh_bounds_empty();
    for (size_t i = 0; i < count; i++) bvh_bounds_add(&box, &pieces[i].box);
    struct bvh_node node = {.next = next};
    glm_vec3_copy(box.low, node.low.v);
    glm_vec3_copy(box.high, node.high.v);
    size_t left = bvh_split(b, pieces, count, &box, depth), first = b->node_count;
    if (left == 0) {
        node.below = bvh_leaf(b->add_leaf(b->user, pieces, count), count);
    } else {
        MEM_RESERVE(b->nodes, first + 2, b->node_capacity);
        b->node_count += 2;
        node.below = (uint32_t)first;
        fill_node(b, first, pieces, left, depth + 1, (uint32_t)first + 1);
        fill_node(b, first + 1, pieces + left, count - left, depth + 1, next);
    }
    b->nodes[index] = node;
}

void bvh_build_tree(bvh_build *b, bvh_piece *pieces, size_t count) {
    if (count == 0) return;
    MEM_RESERVE(b->nodes, b->node_count + 1, b->node_capacity);
    fill_node(b, b->node_count++, pieces, count, 0, BVH_DONE);
}
