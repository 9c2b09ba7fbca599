// Builds bounding volume hierarchies over anything with a box. Both children of a node are stored
// side by side after it. Each node has a link to the node after its subtree, so that a traversal
// needs no stack. Shaders traverse wider trees (bvh_wide.h).
#pragma once
#include "shared.h"
#include <stdbool.h>
#include <stddef.h>

enum { BVH_DEPTH = 32 };     // nodes on the way to a leaf, at most
#define BVH_DONE 0xffffffffu // there is no next node

struct bvh_node {
    shared_vec3 low; // of its box
    uint32_t next;   // the node after this subtree, or BVH_DONE
    shared_vec3 high;
    uint32_t below; // bvh_leaf, else its first child
};

// The content below a node. A leaf has up to 15 pieces from `first` on. For a node with two
// children the range is empty.
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
// Returns the next node of a traversal in a fixed order, after it enters or skips this node.
static inline uint32_t bvh_next(const struct bvh_node *node, bool enter) {
    return enter && !bvh_is_leaf(node->below) ? node->below : node->next;
}

typedef struct bvh_bounds {
    float low[3], high[3];
} bvh_bounds;

bvh_bounds bvh_bounds_empty(void);
void bvh_bounds_add(bvh_bounds *b, const bvh_bounds *other);
float bvh_bounds_area(const bvh_bounds *b); // half of the surface area; 0 when empty

typedef struct bvh_piece {
    bvh_bounds box;
    float middle[3];      // of the box
    uint32_t first, part; // the caller's
} bvh_piece;

enum { BVH_LEAF_SIZE = 4 };

typedef struct bvh_build {
    struct bvh_node *nodes; // the tree is appended, its root first
    size_t node_count, node_capacity;
    // Stores the pieces of a leaf, at most BVH_LEAF_SIZE. Returns the number of the first.
    uint32_t (*add_leaf)(void *user, const bvh_piece *pieces, size_t count);
    void *user;
    float node_cost; // cost of testing a node's children, relative to testing a piece
} bvh_build;

void bvh_build_tree(bvh_build *b, bvh_piece *pieces, size_t count); // reorders the pieces
