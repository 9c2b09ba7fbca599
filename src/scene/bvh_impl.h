// Data of the trees that rays traverse, for bvh*.c only.
#pragma once
#include "base/budget.h"
#include "scene/bvh.h"
#include "scene/bvh_tree.h"
#include "scene/bvh_wide.h"
#include "scene/surfaces.h"

typedef struct tree { // nodes of the forest
    uint32_t root, end;
    uint32_t below;   // its root, as shaders walk it
    size_t triangles; // of the forest, up to those of this tree and its levels
} tree;

// A mesh, or an instances object, with its last placement, which shows what has changed.
typedef struct thing {
    scene_mesh *mesh;           // NULL: instances
    scene_instances *instances; // NULL: a mesh
    size_t first_mesh;          // among those of the trees
    size_t first, count;        // of its items
    bool placed;
    mat4 transform;
    float tint[4];
    float (*tints)[3]; // of instances: those of each kind
    uint64_t version;
    struct instance_entry *entries;
} thing;

// Every placed mesh and instance is an item; the items of a thing are successive. On the device
// they are in the order of the tree over them.
struct scene_bvh {
    scene_mesh **meshes;       // alone, then the kinds of each of the instances
    tree *trees;               // per mesh
    uint32_t *materials;       // per mesh: the first of its own
    struct bvh_levels *levels; // per mesh
    size_t material_count;
    size_t mesh_count;
    thing *things;
    size_t thing_count;
    size_t item_count;
    budget_part *part; // of the host's memory, but for the meshes themselves

    struct bvh_wide *wide; // nodes on the device: none, those over the items, then all others
    size_t wide_count, wide_capacity;
    uint8_t *wide_marks; // of those over the items that have changed (runs.h)

    bvh_forest forest;  // its first nodes are of the tree over the items
    uint32_t top_count; // 0: there is none yet
    uint32_t top_below; // its root, as shaders walk it
    float top_cost;     // as it was when it was made
    uint32_t *parents;  // of these nodes; the root's is 0
    uint8_t *stale;     // whose boxes do not fit
    uint32_t *slots;    // where they are among `wide`
    size_t top_moved;   // boxes of items that have changed since the cost was looked at

    struct bvh_instance *items; // in the order of the tree
    uint32_t *item_at;          // by item: its place there
    uint32_t *leaf_of;          // by place: the node that it is in
    uint8_t *changed;           // marks of items (runs.h)

    struct surface_material *looks; // of all materials, once they are on the device
    bool looked;                    // they have been written
    uint64_t version;               // of all that is placed, and of its looks
    bool holes;
    bool headed; // the device knows how many items and nodes over them there are
    gpu_buffer *buffers[BVH_PARTS];
};

enum { BVH_HEAD = 16 }; // bytes before the items of "BvhInstances": how many, and nodes over them

// The materials of all meshes (bvh_looks.c): counted when all trees are made, then added with the
// surfaces of each mesh, then brought to each frame.
void bvh_looks_count(scene_bvh *b);
void bvh_looks_add(scene_bvh *b, surfaces *s, size_t mesh);
bool bvh_looks_update(scene_bvh *b, gpu *g, const field_context *context);
// The tree over the items is made, where there is none, or follows their boxes (bvh_top.c).
void bvh_top_update(scene_bvh *b);
void bvh_top_moved(scene_bvh *b, size_t place); // the box of the item there has changed
size_t bvh_top_nodes(size_t items);             // that it may take
size_t bvh_top_wide(size_t items);              // on the device, that of none before it
// The box of an item that is not to be seen: nothing meets it.
bool bvh_is_nowhere(const struct bvh_instance *item);
