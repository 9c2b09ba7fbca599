// Voxelisation of meshes on the device: which body contains the centre of each cell of a box, how
// the bodies move, and the distance to their surface.
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
    const scene_mesh *mesh;  // its transform is evaluated in each update
    voxels_rule rule;
} voxels_body;

typedef struct voxels_desc {
    box3 box;                  // metres
    uint32_t size[3];          // cells; x a multiple of 4
    const voxels_body *bodies; // where two overlap, the cell belongs to the later one
    size_t body_count;         // from 0 to what the device has memory for
    bool distances;            // voxels_write_distance will be called
} voxels_desc;

// Prepares the meshes. Needs no device. NULL with a message.
voxels *voxels_create(arena *memory, const voxels_desc *desc);
extern const kernel_table voxels_kernel_table;
// Compiles the shaders, and with a device builds their pipelines. Any thread.
bool voxels_build(voxels *v, gpu *g, shader_library *library, const shader_reader *reader);
bool voxels_allocate(voxels *v, gpu *g); // buffers, all empty; again: does nothing
// Adds what voxels_allocate and the first update will take, and voxels_write_distance. Bodies are
// taken as they are at the context's time, and however they turn from there; one that is scaled up
// later gets its memory in that frame, or is refused it there.
void voxels_list_memory(const voxels *v, const field_context *context, bool distances,
                        budget_list *out);
void voxels_destroy(voxels *v, gpu *g); // g may be NULL when nothing was built

typedef struct voxels_change { // changes since the last update
    bool cells;                // some cells may belong to another body, or to none
    bool motion;               // the motion of some body has changed
} voxels_change;

// Updates cells and motions for the context's time, inside a frame. `dt` is the seconds since the
// last update, from which velocities follow; 0: bodies that have moved are at rest.
bool voxels_update(voxels *v, gpu *g, const field_context *context, double dt, voxels_change *out);

typedef struct voxels_motion { // of a body: a point p moves by linear + cross(angular, p - centre)
                               // + growth * (p - centre)
    float3 centre;             // middle of the mesh's box (m)
    float3 linear;             // m/s
    float3 angular;            // rad/s
    float growth;              // 1/s, of a body that is scaled
} voxels_motion;
void voxels_get_motion(const voxels *v, size_t body, voxels_motion *out);

// One uint for each cell, x fastest: the body's number in the list, from 1; 0: none.
gpu_buffer *voxels_ids(const voxels *v);
// struct voxel_motion of shared.h by id; the one of id 0 is zero.
gpu_buffer *voxels_motions(const voxels *v);

// Writes signed distances (m) from the centres of cells to the nearest body, negative within
// solids, to an r16f image with a texel for each cell. Call it inside a frame after an update;
// needs voxels_desc.distances. The error is 1/100 of a cell within three cells of a surface, else
// 1/20.
bool voxels_write_distance(voxels *v, gpu *g, gpu_image *distance);

// Amount of work done so far, for tests and statistics.
typedef struct voxels_work {
    uint64_t updates; // that found something moved
    uint64_t bodies;  // voxelised, in all
    uint64_t cells;   // composed, in all
} voxels_work;
voxels_work voxels_get_work(const voxels *v);
