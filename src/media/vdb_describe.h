// Describes a VDB file from its bytes, whose structure has been checked, without OpenVDB, which
// takes 40 ms to load. Nearly all files have enough metadata for that.
#pragma once
#include "media/vdb.h"
#include "media/vdb_layout.h"

typedef struct vdb_affine { // world = origin + axis[0] * i + axis[1] * j + axis[2] * k
    double origin[3], axis[3][3];
} vdb_affine;

// Reads the transform of a linear grid. False with a message when it has no inverse.
bool vdb_affine_read(const vdb_layout *l, const vdb_layout_grid *g, vdb_affine *out);
vdb_class vdb_class_read(const vdb_layout *l, const vdb_layout_grid *g);
// Returns the grid whose tree holds the voxels of `g`: itself, or the one it shares them with. NULL
// with a message.
const vdb_layout_grid *vdb_tree_owner(const vdb_layout *l, const vdb_layout_grid *g);

// Returns whether the metadata of every grid have the box of its active voxels.
bool vdb_tells_extents(const vdb_layout *l);
// Sets index_min, index_max and active_voxels of a grid whose metadata lack them. False with a
// message.
typedef bool vdb_extent_reader(const vdb_layout *l, const vdb_layout_grid *g, vdb_grid_info *out);
// Fills in everything but `metadata`, which becomes "". `read` is not called when vdb_tells_extents
// is true.
bool vdb_describe(const vdb_layout *l, vdb_extent_reader *read, arena *memory, vdb_info *out);
