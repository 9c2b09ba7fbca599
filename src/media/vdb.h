// OpenVDB files, behind a C interface. All functions are thread-safe.
#pragma once
#include "base/arena.h"
#include "base/maths.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum vdb_class { VDB_UNKNOWN, VDB_FOG, VDB_LEVEL_SET, VDB_STAGGERED } vdb_class;

typedef struct vdb_grid_info {
    const char *name;
    const char *type; // "float", "half", "double", "vec3s", ... as the file says
    int components;   // 1 or 3; 0: a type we cannot read
    vdb_class grid_class;
    float voxel_size[3];                // metres in file units
    int32_t index_min[3], index_max[3]; // active box in index space, inclusive; empty: min > max
    uint64_t active_voxels;             // 0 when the file does not say
    box3 box; // world box of the active voxels, half-voxel border included
    float background[3];
    bool saved_half;
    bool linear;       // the transform is affine
    bool axis_aligned; // and without rotation or shear
} vdb_grid_info;

typedef struct vdb_info {
    const vdb_grid_info *grids;
    size_t count;
    const char *metadata; // "key = value" lines of the file, "" when none
} vdb_info;

// Metadata only: no voxel is read (where the file lacks a box in its metadata, the grid is read).
bool vdb_read_info(const char *path, arena *memory, vdb_info *out);
// Of a file below `root` (base/file.h).
bool vdb_read_info_inside(const char *root, const char *path, arena *memory, vdb_info *out);

typedef struct vdb_sample_desc {
    const char *path;
    const char *grid; // exact name
    box3 box;         // world box to fill, in file units; voxel centres half a voxel inside
    uint32_t size[3];
    int components;   // 1 or 3
    float *out;       // size[0] * size[1] * size[2] * components, x fastest
    const char *root; // that the file must lie in; NULL: the user named it
} vdb_sample_desc;

// Resamples (trilinearly; exactly where the lattices coincide) one grid into a dense box. Level
// sets become fog: 1 inside, falling to 0 across the narrow band's outer half. NaN and infinity
// become 0 and are counted in `*bad` (may be NULL). Background is honoured. Staggered vectors are
// moved to the voxels' centres. Frustum transforms are refused, as are types with 0 components.
bool vdb_sample(const vdb_sample_desc *desc, uint64_t *bad);

// One grid of a file, kept as the file has it and read in blocks; values are those of vdb_sample.
// For one thread at a time.
enum { VDB_BLOCK = 9 };           // voxels a side: 8, and those that linear filtering needs beyond
typedef struct vdb_file vdb_file; // several grids of which are wanted: read once
typedef struct vdb_blocks vdb_blocks;
vdb_file *vdb_file_open(const char *root, const char *path); // `root`: as of a vdb_sample_desc
void vdb_file_close(vdb_file *f);                            // NULL is fine
// `desc` may have any size, and its `out` is not used. `opened` is its file, or NULL.
vdb_blocks *vdb_blocks_open(const vdb_sample_desc *desc, const vdb_file *opened);
void vdb_blocks_close(vdb_blocks *b); // NULL is fine
// Names boxes of voxels (inclusive, within the size) outside of which all is background.
typedef void vdb_block_found(void *user, const int32_t low[3], const int32_t high[3]);
void vdb_blocks_visit(const vdb_blocks *b, vdb_block_found *found, void *user);
void vdb_blocks_background(const vdb_blocks *b, float out[3]); // its components
// VDB_BLOCK^3 voxels from `at` on, x fastest; it may lie outside. Returns how many of its first
// 8^3 values were not finite and became 0.
uint64_t vdb_blocks_read(vdb_blocks *b, const int32_t at[3], float *out);

typedef struct vdb_write_grid {
    const char *name;
    uint32_t size[3];
    const float *values; // x fastest
    int components;      // 1 or 3
    float voxel_size;
    float3 origin;    // world position of the centre of voxel 0
    float background; // values that differ from it by `tolerance` or less become inactive
    bool half;
    vdb_class grid_class;
    float tolerance;
    const uint16_t *halves; // instead of `values`, `stride` of them a voxel
    int stride;
    bool turns; // its vectors turn with the grid, as velocities do and colours do not
} vdb_write_grid;
typedef struct vdb_entry { // of a file's metadata
    const char *key;
    const char *text; // NULL: it is the number
    double number;
} vdb_entry;
// Sparse: only 8^3 blocks in which something is active are kept, as one value where it is the same
// everywhere. The file is there whole or not at all.
bool vdb_write_with(const char *path, const vdb_write_grid *grids, size_t count,
                    const vdb_entry *metadata, size_t entries);
bool vdb_write(const char *path, const vdb_write_grid *grids, size_t count); // without metadata
