// Meshes as cells of a box, on the device: which body the centre of a cell lies in, how the bodies
// move, how far away their surface is.
//
// Inside is decided per axis by the parity of the crossings before a cell's centre, and by two of
// the three axes: so a hole in a mesh leaves no streak. What decides ties: corners are rounded to
// 1/256 of a cell, edges are exact and half-open (lower ones count), so that a line through
// centres that meets an edge or a corner counts it once; a centre on a face lies inside where the
// body begins in the axis' direction and outside where it ends.
//
// Rules: "solid" is that alone. "shell" marks every cell that a triangle touches, so that no line
// from a cell to one of its 26 neighbours passes through. "auto": parts of the mesh (triangles that
// share corners) that are closed are solid, and where they are so thin that such lines could pass
// (one cell thick, 1.7 across the diagonals) the triangles' shell is added; the others are shells.
//
// Of a mesh duplicate triangles count once. Two that lie on each other back to back: a part made of
// nothing else is a surface with two sides, and one of each pair is left out; elsewhere they are a
// wall within the body, which counts for shells only. Closed parts that overlap are one solid; one
// turned inside out within another is a cavity in it.
#pragma once
#include "kernel/kernel.h"
#include "scene/scene.h"

typedef struct voxels voxels;

typedef enum voxels_rule { VOXELS_AUTO, VOXELS_SOLID, VOXELS_SHELL } voxels_rule;

enum { VOXELS_MAX_SIDE = 1024 };

typedef struct voxels_body { // the same mesh may be several
    const scene_mesh *mesh;  // where it stands is evaluated with each update
    voxels_rule rule;
} voxels_body;

typedef struct voxels_desc {
    box3 box;                  // metres
    uint32_t size[3];          // cells; x a multiple of 4
    const voxels_body *bodies; // where two meet, the cell is the later one's
    size_t body_count;         // 0 is fine, and any number that the device has memory for
    bool distances;            // voxels_write_distance will be called
} voxels_desc;

// Looks at the meshes; needs no device. NULL with a message.
voxels *voxels_create(arena *memory, const voxels_desc *desc);
extern const kernel_table voxels_kernel_table;
bool voxels_compile(voxels *v, shader_library *library, const shader_reader *reader);
bool voxels_build(voxels *v, gpu *g);    // pipelines; any thread
bool voxels_allocate(voxels *v, gpu *g); // buffers, all empty; again: does nothing
// Adds what voxels_allocate will take, and voxels_write_distance. How much the masks of bodies need
// is known when they stand somewhere.
void voxels_list_memory(const voxels *v, bool distances, budget_list *out);
void voxels_destroy(voxels *v, gpu *g); // g may be NULL when nothing was built

typedef struct voxels_change { // against the update before
    bool cells;                // some cells may be another body's, or none's
    bool motion;               // some body moves otherwise
} voxels_change;

// Inside a frame: brings cells and motion to the context's time. `dt`: seconds since the last
// update, by which bodies that stand elsewhere now have moved; 0: they were put there, at rest.
bool voxels_update(voxels *v, gpu *g, const field_context *context, double dt, voxels_change *out);

typedef struct voxels_motion { // of a body: a point p moves by linear + cross(angular, p - centre)
                               // + growth * (p - centre)
    float3 centre;             // of the mesh's box, metres
    float3 linear;             // m/s
    float3 angular;            // rad/s
    float growth;              // 1/s, of a body that is scaled
} voxels_motion;
void voxels_get_motion(const voxels *v, size_t body, voxels_motion *out);

// A uint a cell, x fastest: the body's id, which is its place in the list, from 1; 0: none.
gpu_buffer *voxels_ids(const voxels *v);
// struct voxel_motion of shared.h by id; the one of id 0 is zero.
gpu_buffer *voxels_motions(const voxels *v);

// Inside a frame, after an update, of voxels that were made with `distances`: signed distances in
// metres from the centres of cells to the nearest body, negative within solids, into an image of
// the cells' size, r16f. Within three cells of a surface exact to 1/100 of a cell, beyond to 1/20.
bool voxels_write_distance(voxels *v, gpu *g, gpu_image *distance);

// What was done so far, for tests and statistics.
typedef struct voxels_work {
    uint64_t updates; // that found something moved
    uint64_t bodies;  // voxelised, in all
    uint64_t cells;   // composed, in all
} voxels_work;
voxels_work voxels_get_work(const voxels *v);
