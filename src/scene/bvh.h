// Rays against the meshes of an effect: a tree of boxes for each mesh, made once on the host, and a
// list of placed meshes, written every frame. Shaders trace it with lib/bvh.glsl.
#pragma once
#include "scene/scene.h"

typedef struct scene_bvh scene_bvh;

enum { SCENE_BVH_MAX_MESHES = 256 };

// The trees of these meshes, in order; a mesh with the same data has the same tree. Needs no
// device.
scene_bvh *scene_bvh_create(scene_mesh *const *meshes, size_t count);
void scene_bvh_destroy(scene_bvh *b, gpu *g);
bool scene_bvh_allocate(scene_bvh *b, gpu *g); // trees to the device; again: does nothing
// Places the meshes as of now. Inside a frame; once a frame.
bool scene_bvh_update(scene_bvh *b, gpu *g, const field_context *context);

// What the triangles look like, for passes that show them by rays. A mesh whose surfaces are larger
// than the device can read must be drawn instead.
bool scene_bvh_surfaces_fit(const scene_mesh *mesh, gpu *g);
bool scene_bvh_allocate_surfaces(scene_bvh *b, gpu *g); // again: does nothing
bool scene_bvh_has_holes(const scene_bvh *b);           // textures that are clear in places
// A bit for each mesh of `b` that is among these.
void scene_bvh_choose(const scene_bvh *b, scene_mesh *const *meshes, size_t count,
                      uint32_t bits[SCENE_BVH_MAX_MESHES / 32]);

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
    BVH_PARTS
} scene_bvh_part;
gpu_buffer *scene_bvh_buffer(const scene_bvh *b, scene_bvh_part part);
