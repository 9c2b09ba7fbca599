// Ray tracing against a scene: a bounding volume hierarchy for each mesh, built once on the host,
// and one over all placed meshes and instances, which is updated when they move. Shaders trace rays
// with lib/bvh.glsl.
#pragma once
#include "scene/instances.h"

typedef struct scene_bvh scene_bvh;

enum { SCENE_BVH_MAX_MESHES = 256 }; // with the kinds of instances

// Builds the trees of these meshes, and of the kinds of these instances, in order. Meshes with the
// same data share a tree. `levels`: also builds trees of the meshes' levels of detail. Needs no
// device. NULL with a message.
scene_bvh *scene_bvh_create(scene_mesh *const *meshes, size_t count,
                            scene_instances *const *instances, size_t instances_count, bool levels);
void scene_bvh_destroy(scene_bvh *b, gpu *g);
void scene_bvh_list_memory(const scene_bvh *b, budget_list *out); // of scene_bvh_allocate
bool scene_bvh_allocate(scene_bvh *b, gpu *g); // trees to the device; again: does nothing
// Place everything as it stands now: the first on the host, the second on the device too, inside a
// frame and once a frame.
bool scene_bvh_place(scene_bvh *b, const field_context *context);
bool scene_bvh_update(scene_bvh *b, gpu *g, const field_context *context);

typedef struct scene_hit {
    float distance;               // in lengths of the direction
    float position[3], normal[3]; // in the world; the normal has length 1 and faces the origin
    bool behind;                  // the triangle's back was hit
    const scene_mesh *mesh;       // the mesh that was hit
    scene_instances *instances;   // the instances that it belongs to; NULL: a single mesh
    uint32_t index;               // number of the instance
} scene_hit;

// Returns the first triangle that a ray hits, at the last placement. False: none. `only`: hits only
// this mesh, which is no instance; NULL: everything.
bool scene_pick(const scene_bvh *b, const float origin[3], const float direction[3],
                const scene_mesh *only, scene_hit *out);

// Surfaces of the triangles, for passes that show them by rays. A mesh whose surfaces are larger
// than the device can read must be rasterised instead.
bool scene_bvh_surfaces_fit(const scene_mesh *mesh, gpu *g);
void scene_bvh_list_surfaces(const scene_bvh *b, budget_list *out); // memory of the next
bool scene_bvh_allocate_surfaces(scene_bvh *b, gpu *g);             // again: does nothing
// Returns a number that changes when something has moved or looks different.
uint64_t scene_bvh_version(const scene_bvh *b);
bool scene_bvh_glows(const scene_bvh *b);     // materials may emit light
bool scene_bvh_has_holes(const scene_bvh *b); // textures are transparent in places
// Sets a bit for each mesh and instances object of `b` (bvh_instance.what.x) that is in the lists.
void scene_bvh_choose(const scene_bvh *b, scene_mesh *const *meshes, size_t count,
                      scene_instances *const *instances, size_t instances_count,
                      uint32_t bits[SCENE_BVH_MAX_MESHES / 32]);
size_t scene_bvh_count(const scene_bvh *b); // number of placed meshes and single instances

// Storage buffers of lib/bvh.glsl ("BvhNodes", "BvhTriangles", "BvhInstances"), then those of
// lib/surface.glsl. They are never empty.
typedef enum scene_bvh_part {
    BVH_NODES,
    BVH_TRIANGLES,
    BVH_INSTANCES,
    BVH_SURFACES,
    BVH_VERTICES,
    BVH_MATERIALS,
    BVH_TEXELS,
    BVH_LEVELS,
    BVH_PARTS
} scene_bvh_part;
gpu_buffer *scene_bvh_buffer(const scene_bvh *b, scene_bvh_part part);
