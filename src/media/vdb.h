// OpenVDB files. The library works in a process of its own (base/isolate.h), on files that are
// opened here; nothing of it is in this one. Any thread; false comes with a message.
#pragma once
#include "base/arena.h"
#include "base/isolate.h"
#include "base/maths.h"
#include "media/texels.h"
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
    bool sheared;      // its axes are not at right angles
} vdb_grid_info;

typedef struct vdb_info {
    const vdb_grid_info *grids;
    size_t count;
    const char *metadata; // "key = value" lines of the file; of vdb_read_infos perhaps ""
    bool y_up;            // by its "creator": Houdini's files have Y up, those of others Z
} vdb_info;

// Voxels will be read soon: what reads them starts, beside what the caller goes on to do.
void vdb_warm_up(void);

// Metadata only: no voxel is read (where the file lacks a box in its metadata, the grid is read).
bool vdb_read_info(const char *path, arena *memory, vdb_info *out);
// Of many files below `root` (base/file.h), each in the memory of its number: many times as fast as
// one by one. False when one of them cannot be read.
bool vdb_read_infos(const char *root, const char *const *paths, size_t count, arena *const *memory,
                    vdb_info *out);

typedef enum vdb_set { // what a level set of distances to a surface becomes
    VDB_SET_SOLID,     // 1 inside, falling to 0 across the outer half of the narrow band
    VDB_SET_FOG,       // 0 outside, rising to 1 across the inner half
} vdb_set;

typedef struct vdb_sample_desc {
    const char *path;
    const char *grid; // exact name
    box3 box;         // world box to fill, in file units; voxel centres half a voxel inside
    uint32_t size[3];
    int components;   // 1 or 3
    float *out;       // size[0] * size[1] * size[2] * components, x fastest
    const char *root; // that the file must lie in; NULL: the user named it
    vdb_set level_set;
} vdb_sample_desc;

// Resamples (trilinearly; exactly where the lattices coincide) one grid into a dense box. Level
// sets become what `level_set` says. NaN and infinity become 0 and are counted in `*bad` (may be
// NULL). Background is honoured. Staggered vectors are moved to the voxels' centres. Frustum
// transforms are refused, as are types with 0 components.
bool vdb_sample(const vdb_sample_desc *desc, uint64_t *bad);

// Where the values of a grid go in a frame.
typedef struct vdb_source {
    const char *grid; // exact name
    int components;   // 1 or 3, of the grid
    int channels[3];  // of the frame, for each component; all in one texture
    float gains[3];
} vdb_source;

// Several grids of a file, sampled like vdb_sample into one box, as texels.
enum {
    VDB_BRICK = 8,
    VDB_BLOCK = VDB_BRICK + 1,
    VDB_ACROSS = 2048 / VDB_BLOCK, // bricks along a side of an atlas: every device has 2048 texels
    VDB_MOST_BRICKS = VDB_ACROSS * VDB_ACROSS * VDB_ACROSS,
    VDB_SOURCES = 4 * TEXELS_IMAGES
};
typedef struct vdb_frame_desc {
    const char *path;
    const char *root;
    box3 box;
    texels_shape shape;
    // Dense: every voxel. Sparse: bricks of VDB_BRICK^3 voxels, each with the faces that it shares
    // with its neighbours (VDB_BLOCK^3), x fastest; those that hold one value alike are one brick.
    bool sparse;
    uint64_t max_bytes; // of all textures of a sparse frame
    const vdb_source *sources;
    size_t count; // at most VDB_SOURCES
    vdb_set level_set;
} vdb_frame_desc;

typedef struct vdb_frame {
    struct {
        uint16_t *texels; // NULL: there is no such texture
        uint32_t *index;  // of a sparse one, for each brick of the box, x fastest: its number from
        uint32_t bricks;  // 1, at most `bricks`; 0: nothing but zeros
    } images[TEXELS_IMAGES];
    texels_active active;
    uint64_t bad; // values that were not finite and became 0
    isolate_result memory;
} vdb_frame;

uint64_t vdb_brick_count(const texels_shape *s); // of the box
bool vdb_read_frame(const vdb_frame_desc *desc, vdb_frame *out);
void vdb_frame_free(vdb_frame *f);

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
// Sparse: only 8^3 blocks in which something is active are kept, all as leaves. The file is there
// whole or not at all.
bool vdb_write_with(const char *path, const vdb_write_grid *grids, size_t count,
                    const vdb_entry *metadata, size_t entries);
bool vdb_write(const char *path, const vdb_write_grid *grids, size_t count); // without metadata
