// Bounding volume hierarchies over the triangles of meshes, one after the other.
#pragma once
#include "media/mesh.h"
#include "scene/bvh_build.h"
#include "shared.h"

typedef struct bvh_origin { // of a triangle, in its mesh
    uint32_t first;         // of its indices
    uint32_t part;
} bvh_origin;

typedef struct bvh_forest { // zero: empty
    struct bvh_node *nodes;
    size_t node_count, node_capacity;
    struct bvh_triangle *triangles;
    size_t triangle_count, triangle_capacity;
    bvh_origin *origins; // of each triangle
    size_t origin_capacity;
} bvh_forest;

enum { BVH_MAX_TRIANGLES = (1 << 28) - 1 };

// Appends a tree of the triangles of a level (mesh_get_run), without those that have no area or are
// transparent; when none is left there are no nodes. False with a message when there are too many.
bool bvh_forest_add(bvh_forest *f, const mesh_data *mesh, uint32_t level);
void bvh_forest_free(bvh_forest *f);
