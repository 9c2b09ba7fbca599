// A tree of boxes over anything that has one, laid out as shaders walk it (bvh_node of shared.h).
#pragma once
#include "shared.h"
#include <stdbool.h>
#include <stddef.h>

// What is below a node. A leaf holds so many, up to 15, from a place on; any other node has two
// children, for which the range is empty.
static inline uint32_t bvh_leaf(uint32_t first, size_t count) {
    return (uint32_t)count << 28 | first;
}
static inline bool bvh_is_leaf(uint32_t below) {
    return below >> 28 != 0;
}
static inline uint32_t bvh_leaf_first(uint32_t below) {
    return below & 0xfffffff;
}
static inline uint32_t bvh_leaf_end(uint32_t below) {
    return bvh_leaf_first(below) + (below >> 28);
}
// The node that a walk in a fixed order goes on with, which enters this one or does not.
static inline uint32_t bvh_next(const struct bvh_node *node, bool enter) {
    return enter && !bvh_is_leaf(node->below) ? node->below : node->next;
}

typedef struct bvh_bounds {
    float low[3], high[3];
} bvh_bounds;

bvh_bounds bvh_bounds_empty(void);
void bvh_bounds_add(bvh_bounds *b, const bvh_bounds *other);
float bvh_bounds_area(const bvh_bounds *b); // half of it; of an empty one 0

typedef struct bvh_piece {
    bvh_bounds box;
    float middle[3];      // of the box
    uint32_t first, part; // the caller's
} bvh_piece;

enum { BVH_LEAF_SIZE = 4 };

typedef struct bvh_build {
    struct bvh_node *nodes; // the tree is added behind those that are there, its root first
    size_t node_count, node_capacity;
    // Takes the pieces of a leaf, at most BVH_LEAF_SIZE; returns the number of the first.
    uint32_t (*add_leaf)(void *user, const bvh_piece *pieces, size_t count);
    void *user;
} bvh_build;

void bvh_build_tree(bvh_build *b, bvh_piece *pieces, size_t count); // orders the pieces anew
