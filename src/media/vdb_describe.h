// What a VDB file says of itself, by its bytes alone, whose skeleton is known to be sound: nearly
// all say enough to be laid out in a box, and OpenVDB takes 40 ms to load.
#pragma once
#include "media/vdb.h"
#include "media/vdb_layout.h"

typedef struct vdb_affine { // world = origin + axis[0] * i + axis[1] * j + axis[2] * k, of an index
    double origin[3], axis[3][3];
} vdb_affine;

// Of a grid that is linear. False with a message when it has no inverse.
bool vdb_affine_read(const vdb_layout *l, const vdb_layout_grid *g, vdb_affine *out);
vdb_class vdb_class_read(const vdb_layout *l, const vdb_layout_grid *g);
// The grid whose tree holds the voxels of `g`: itself, or the one it shares them with; NULL with a
// message.
const vdb_layout_grid *vdb_tree_owner(const vdb_layout *l, const vdb_layout_grid *g);

// Whether its metadata say of every grid where it is active.
bool vdb_tells_extents(const vdb_layout *l);
// Sets index_min, index_max and active_voxels of a grid whose metadata do not say it. False with a
// message.
typedef bool vdb_extent_reader(const vdb_layout *l, const vdb_layout_grid *g, vdb_grid_info *out);
// All but `metadata`, which becomes "". `read` is not called where vdb_tells_extents.
bool vdb_describe(const vdb_layout *l, vdb_extent_reader *read, arena *memory, vdb_info *out);
