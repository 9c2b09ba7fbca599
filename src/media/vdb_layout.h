// The structure of an OpenVDB file, checked byte by byte. OpenVDB trusts every length that it
// reads: a damaged file makes it allocate gigabytes, write past a buffer, or free a pointer that it
// never set. No byte is therefore passed to OpenVDB before this check has shown that all lengths
// fit.
#pragma once
#include "base/arena.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum vdb_value { // type of a voxel
    VDB_VALUE_OTHER,     // a type that is not read
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
    const char *name;      // without the suffix that makes equal names unique
    const char *unique;    // with that suffix
    const char *tree_type; // "Tree_float_5_4_3"
    const char *type;      // "float"
    const char *parent;    // unique name of the grid whose tree this one shares; "": it has its own
    vdb_value value;
    bool half;                        // reals are stored with 16 bits
    bool linear;                      // the transform is affine
    uint32_t compression;             // OpenVDB's flags
    size_t start;                     // offset of the compression flags, with which it begins
    size_t metadata, transform, tree; // offsets; tree is 0 when the transform is not linear
    size_t end;
} vdb_layout_grid;

typedef struct vdb_layout {
    const char *path; // for messages
    const uint8_t *bytes;
    size_t size;
    uint32_t version, library_major, library_minor;
    size_t metadata; // offset of the file's metadata
    vdb_layout_grid *grids;
    size_t count;
} vdb_layout;

// Checks the header, the table of grids, metadata and transforms. `bytes` and `path` must outlive
// `out`.
bool vdb_layout_read(const char *path, const void *bytes, size_t size, arena *memory,
                     vdb_layout *out);

// Checks the nodes and voxels of one grid whose value is not VDB_VALUE_OTHER and that has its own
// tree. `*leaves` (may be NULL) receives the number of its leaves; other active voxels are in
// tiles.
bool vdb_layout_check_tree(const vdb_layout *layout, const vdb_layout_grid *grid, uint64_t *leaves);

size_t vdb_value_size(vdb_value value);    // bytes in memory
int vdb_value_components(vdb_value value); // 1 or 3; 0 for VDB_VALUE_OTHER
