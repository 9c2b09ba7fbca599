// Trees as shaders walk them: nodes with up to four children (bvh_wide of shared.h), which take
// half of the looks that nodes with two do (Wald et al., "Getting rid of packets", 2008; Dammertz
// et al., "Shallow bounding volume hierarchies for fast SIMD ray tracing of incoherent rays",
// 2008).
#pragma once
#include "scene/bvh_build.h"

typedef struct bvh_widening {
    const struct bvh_node *nodes; // of trees with two children
    struct bvh_wide *out;         // there is room for half as many as the tree has nodes
    uint32_t count;               // of those that are there, above 0: shaders take 0 for nothing
    uint32_t *slots;              // NULL, or by node of the tree: 4 x place in `out` + lane
} bvh_widening;

#define BVH_NO_SLOT 0xffffffffu // of a node that is not a child of any in `out`

// Adds what a tree is as shaders walk it; returns what its root has below it. A walk never keeps
// BVH_KEPT nodes for later.
uint32_t bvh_widen(bvh_widening *w, uint32_t root);
void bvh_wide_set_box(struct bvh_wide *out, uint32_t slot, const struct bvh_node *node);
