// Prepares a mesh for voxelisation: points and triangles for the shaders, without duplicates, in
// groups that are voxelised separately.
#pragma once
#include "media/mesh.h"
#include "scene/voxels.h"

enum { VOXEL_GROUPS = 8 }; // maximum per mesh

typedef struct voxel_group { // closed parts that do not overlap, or all open parts
    size_t first_item, item_count;
    box3 box;
    float thinnest; // of its triangles: how much of the body is behind them, as part of the mesh's
                    // size; 0: some are shells
} voxel_group;

typedef struct voxel_surface {
    shared_vec4 *points; // welded
    size_t point_count;
    shared_uvec4 *items; // three points and flags, as VOXEL_CROSSES of shared.h and those below
    size_t item_count;
    voxel_group groups[VOXEL_GROUPS];
    size_t group_count;
    box3 box;
    float size; // longest side of the box
} voxel_surface;

// `cells`: along the longest side of the box. A mesh may be without triangles that count.
void voxel_surface_create(voxel_surface *out, const mesh_data *mesh, voxels_rule rule,
                          uint32_t cells);
void voxel_surface_free(voxel_surface *s);

// ---- between its files --------------------------------------------------------------------------

typedef struct voxel_triangle {
    uint32_t points[3];
    uint32_t component; // triangles that are joined by points
    bool wall;          // its twin, back to back, was left out: it bounds nothing
    float behind;       // of the body, in units of the mesh; INFINITY: much, or not known
} voxel_triangle;

typedef struct voxel_component {
    bool closed;
    double volume; // negative: turned inside out
    box3 box;
    uint32_t group;
} voxel_component;

typedef struct voxel_topology {
    float (*points)[3];
    size_t point_count;
    voxel_triangle *triangles;
    size_t triangle_count;
    voxel_component *components;
    size_t component_count;
    box3 box;   // of all, which may be flat
    float size; // its longest side, above 0
} voxel_topology;

box3 voxel_no_box(void); // to be added to
void voxel_add_box(box3 *to, box3 box);

void voxel_topology_create(voxel_topology *out, const mesh_data *mesh);
void voxel_topology_free(voxel_topology *t);
// Sets `behind` of the triangles of closed parts. Not looked for in meshes of more than
// VOXEL_MOST_THIN triangles: theirs are smaller than cells.
enum { VOXEL_MOST_THIN = 1 << 18 };
void voxel_find_thin(voxel_topology *t);
