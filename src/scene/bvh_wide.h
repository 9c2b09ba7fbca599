// Trees for shaders: nodes with up to four children (bvh_wide of shared.h), which need half of the
// visits of nodes with two (Wald et al., "Getting rid of packets", 2008; Dammertz
// et al., "Shallow bounding volume hierarchies for fast SIMD ray tracing of incoherent rays",
// 2008).
#pragma once
#include "scene/bvh_build.h"

typedef struct bvh_widening {
    const struct bvh_node *nodes; // nodes with two children
    struct bvh_wide *out;         // has room for half as many nodes as the tree has
    uint32_t count;               // number of nodes in `out`, above 0: shaders take 0 for nothing
    uint32_t *slots;              // NULL, or for each node of the tree: 4 x index in `out` + lane
} bvh_widening;

#define BVH_NO_SLOT 0xffffffffu // slot of a node that is no child of a node in `out`

// Appends a tree for shaders and returns the content below its root. A traversal never keeps
// BVH_KEPT nodes for later.
uint32_t bvh_widen(bvh_widening *w, uint32_t root);
void bvh_wide_set_box(struct bvh_wide *out, uint32_t slot, const struct bvh_node *node);
