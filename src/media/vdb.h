// OpenVDB files. The library runs in another process (base/isolate.h), on files that this process
// opens. Functions return false with a message. Any thread.
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
    int components;   // 1 or 3; 0: a type that cannot be read
    vdb_class grid_class;
    float voxel_size[3];                // in the file's units
    int32_t index_min[3], index_max[3]; // active box in index space, inclusive; empty: min > max
    uint64_t active_voxels;             // 0 when the file does not say
    box3 box; // world box of the active voxels, which extend half a voxel around their centres
    float background[3];
    bool saved_half;
    bool linear;       // the transform is affine
    bool axis_aligned; // it is affine without rotation or shear
    bool sheared;      // its axes are not at right angles
} vdb_grid_info;

typedef struct vdb_info {
    const vdb_grid_info *grids;
    size_t count;
    const char *metadata; // "key = value" lines of the file; vdb_read_infos may leave them out ("")
    bool y_up;            // according to "creator": Houdini's files have Y up, others Z
} vdb_info;

// Starts the process that reads voxels, without waiting for it, since voxels will be read soon.
void vdb_warm_up(void);

// Reads the metadata of a file. A grid whose metadata have no box is read for it.
bool vdb_read_info(const char *path, arena *memory, vdb_info *out);
// Reads the metadata of many files below `root` (base/file.h), each into its own memory. This is
// many times as fast as one by one. False when one of them cannot be read.
bool vdb_read_infos(const char *root, const char *const *paths, size_t count, arena *const *memory,
                    vdb_info *out);

typedef enum vdb_set { // how a level set (distances to a surface) is converted
    VDB_SET_SOLID,     // 1 inside, falling to 0 across the outer half of the narrow band
    VDB_SET_FOG,       // 0 outside, rising to 1 across the inner half of the narrow band
} vdb_set;

typedef struct vdb_sample_desc {
    const char *path;
    const char *grid; // exact name
    box3 box;         // world box to fill, in file units; voxel centres half a voxel inside
    uint32_t size[3];
    int components;   // 1 or 3
    float *out;       // size[0] * size[1] * size[2] * components, x fastest
    const char *root; // the folder that the file must lie in; NULL: the user named the file
    vdb_set level_set;
} vdb_sample_desc;

// Resamples one grid into a dense box: trilinearly, and exactly where the lattices coincide. Level
// sets are converted as `level_set` says. NaN and infinity become 0 and are counted in `*bad` (may
// be NULL). Voxels outside of the grid get its background value. Staggered vectors are moved to the
// centres of voxels. Frustum transforms and types with 0 components are refused.
bool vdb_sample(const vdb_sample_desc *desc, uint64_t *bad);

// Maps the components of a grid to channels of a frame.
typedef struct vdb_source {
    const char *grid; // exact name
    int components;   // components of the grid, 1 or 3
    int channels[3];  // channel of the frame for each component; all in one texture
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
    // False: every voxel is stored. True: bricks of VDB_BRICK^3 voxels are stored, each with the
    // faces that it shares with its neighbours (VDB_BLOCK^3), x fastest. Bricks of the same
    // constant value are stored once.
    bool sparse;
    uint64_t max_bytes; // limit for all textures of a sparse frame
    const vdb_source *sources;
    size_t count; // at most VDB_SOURCES
    vdb_set level_set;
} vdb_frame_desc;

typedef struct vdb_frame {
    struct {
        uint16_t *texels; // NULL: there is no such texture
        uint32_t
            *index; // sparse: number of each brick of the box, 1 to `bricks`, x fastest; 0: the
        uint32_t bricks; // brick holds only zeros
    } images[TEXELS_IMAGES];
    texels_active active;
    uint64_t bad; // values that were not finite and became 0
    isolate_result memory;
} vdb_frame;

uint64_t vdb_brick_count(const texels_shape *s); // bricks in the box
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
    const uint16_t *halves; // instead of `values`; `stride` of them per voxel
    int stride;
    bool turns; // its vectors rotate with the grid, as velocities do and colours do not
} vdb_write_grid;
typedef struct vdb_entry { // an entry of a file's metadata
    const char *key;
    const char *text; // NULL: the value is `number`
    double number;
} vdb_entry;
// Writes a sparse file: only 8^3 blocks with an active voxel are stored, all as leaves. The file
// appears complete or not at all.
bool vdb_write_with(const char *path, const vdb_write_grid *grids, size_t count,
                    const vdb_entry *metadata, size_t entries);
bool vdb_write(const char *path, const vdb_write_grid *grids, size_t count); // without metadata
