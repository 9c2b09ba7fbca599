// The skeleton of an OpenVDB file, checked byte by byte. OpenVDB believes every length that it
// reads: a damaged file makes it allocate gigabytes, write past a buffer, or free a pointer that
// it never set. So no byte goes to OpenVDB before this walk has proved that all lengths fit.
#pragma once
#include "base/arena.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum vdb_value { // of one voxel
    VDB_VALUE_OTHER,     // a type that we do not read
    VDB_VALUE_FLOAT,
    VDB_VALUE_DOUBLE,
    VDB_VALUE_INT32,
    VDB_VALUE_INT64,
    VDB_VALUE_BOOL,
    VDB_VALUE_VEC3S,
    VDB_VALUE_VEC3D,
    VDB_VALUE_VEC3I,
} vdb_value;

typedef struct vdb_layout_grid {
    const char *name;      // without the suffix that tells equal names apart
    const char *unique;    // with it
    const char *tree_type; // "Tree_float_5_4_3"
    const char *type;      // "float"
    const char *parent;    // unique name of the grid whose tree this one shares; "" when its own
    vdb_value value;
    bool half;                        // reals are stored with 16 bits
    bool linear;                      // the transform is one that we read (affine)
    uint32_t compression;             // OpenVDB's flags
    size_t start;                     // of compression flags, metadata, transform, tree
    size_t metadata, transform, tree; // starts; tree is 0 when the transform is not linear
    size_t end;
} vdb_layout_grid;

typedef struct vdb_layout {
    const char *path; // for messages
    const uint8_t *bytes;
    size_t size;
    uint32_t version, library_major, library_minor;
    size_t metadata; // of the file
    vdb_layout_grid *grids;
    size_t count;
} vdb_layout;

// Header, table of grids, metadata and transforms; `bytes` and `path` must outlive `out`.
bool vdb_layout_read(const char *path, const void *bytes, size_t size, arena *memory,
                     vdb_layout *out);

// The nodes and voxels of one grid whose value is not VDB_VALUE_OTHER and that has its own tree.
// `*leaves` (may be NULL): how many it has; what else is active lies in tiles.
bool vdb_layout_check_tree(const vdb_layout *layout, const vdb_layout_grid *grid, uint64_t *leaves);

size_t vdb_value_size(vdb_value value);    // bytes in memory
int vdb_value_components(vdb_value value); // 1 or 3; 0 for VDB_VALUE_OTHER
