// Rays against what a scene is made of: a tree of boxes for each mesh, made once on the host, and
// one over all that is placed, meshes and instances, which follows what moves. Shaders trace them
// with lib/bvh.glsl.
#pragma once
#include "scene/instances.h"

typedef struct scene_bvh scene_bvh;

enum { SCENE_BVH_MAX_MESHES = 256 }; // with the kinds of instances

// The trees of these meshes, and of the kinds of these instances, in order; a mesh with the same
// data has the same tree. With `levels` of meshes as they are simplified, too. Needs no device.
scene_bvh *scene_bvh_create(scene_mesh *const *meshes, size_t count,
                            scene_instances *const *instances, size_t instances_count, bool levels);
void scene_bvh_destroy(scene_bvh *b, gpu *g);
void scene_bvh_list_memory(const scene_bvh *b, budget_list *out); // of scene_bvh_allocate
bool scene_bvh_allocate(scene_bvh *b, gpu *g); // trees to the device; again: does nothing
// Places all as of now, on the host; then, inside a frame and once a frame, on the device.
bool scene_bvh_place(scene_bvh *b, const field_context *context);
bool scene_bvh_update(scene_bvh *b, gpu *g, const field_context *context);

typedef struct scene_hit {
    float distance;               // in lengths of the direction
    float position[3], normal[3]; // in the world; the normal is a unit vector, towards the origin
    bool behind;                  // its corners turn to the right there: it is met from behind
    const scene_mesh *mesh;       // whose triangle it is
    scene_instances *instances;   // that it is one of; NULL: a mesh alone
    uint32_t index;               // and its number among these
} scene_hit;

// The first triangle that a ray meets, as all was placed last; false: none. `only`: of this mesh,
// which stands by itself; NULL: of all that is placed.
bool scene_pick(const scene_bvh *b, const float origin[3], const float direction[3],
                const scene_mesh *only, scene_hit *out);

// What the triangles look like, for passes that show them by rays. A mesh whose surfaces are larger
// than the device can read must be drawn instead.
bool scene_bvh_surfaces_fit(const scene_mesh *mesh, gpu *g);
void scene_bvh_list_surfaces(const scene_bvh *b, budget_list *out); // memory of the next
bool scene_bvh_allocate_surfaces(scene_bvh *b, gpu *g);             // again: does nothing
// Another one when something has moved or looks different.
uint64_t scene_bvh_version(const scene_bvh *b);
bool scene_bvh_glows(const scene_bvh *b);     // materials may give off light
bool scene_bvh_has_holes(const scene_bvh *b); // textures that are clear in places
// A bit for each of the meshes and instances of `b` (bvh_instance.what.x) that is among these.
void scene_bvh_choose(const scene_bvh *b, scene_mesh *const *meshes, size_t count,
                      scene_instances *const *instances, size_t instances_count,
                      uint32_t bits[SCENE_BVH_MAX_MESHES / 32]);
size_t scene_bvh_count(const scene_bvh *b); // all that is placed: meshes, and instances one by one

// Storage buffers "BvhNodes", "BvhTriangles" and "BvhInstances" of lib/bvh.glsl, then those of
// lib/surface.glsl; never empty.
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
