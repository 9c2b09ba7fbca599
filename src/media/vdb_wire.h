// What goes into the jobs that read and write OpenVDB files, and what comes back: between
// vdb_read.c on this side, and vdb_work.c and vdb_bricks.c on the reader's.
#pragma once
#include "media/vdb_decode.h"

#define VDB_FILE_BYTES_MAX ((size_t)2 << 30)

// ---- "vdb heads", "vdb info": paths, each with its zero byte; back comes for each file ----------

// "vdb heads" is without OpenVDB, and so without what only it knows: metadata as text, and files
// that do not say where a grid is active.
#define VDB_NO_EXTENTS UINT32_MAX // in place of `count`: such a file, of which no more comes
typedef struct vdb_sent_info {    // then its metadata, with a zero byte, and the grids
    uint32_t count, text, y_up;   // text: bytes of the metadata
} vdb_sent_info;

typedef struct vdb_sent_grid { // then name and type, each with its zero byte
    int32_t components, grid_class;
    uint32_t name, type; // bytes
    uint32_t saved_half, linear, axis_aligned, sheared;
    float voxel_size[3], background[3];
    int32_t index_min[3], index_max[3];
    uint64_t active_voxels;
    box3 box;
} vdb_sent_grid;

// ---- "vdb sample": this, then the grid's name; back come the floats, then the count of bad ones
// --

typedef struct vdb_sent_sample {
    box3 box;
    uint32_t size[3], level_set;
    int32_t components;
} vdb_sent_sample;

// ---- "vdb frame": this, then for each source what follows and its name --------------------------

typedef struct vdb_sent_frame {
    box3 box;
    uint32_t size[3], y_up, sparse, count, level_set;
    int32_t width;
    uint64_t max_bytes;
} vdb_sent_frame;

typedef struct vdb_sent_source { // then the name, with a zero byte
    int32_t components, channels[3];
    float gains[3];
    uint32_t name; // bytes
} vdb_sent_source;

typedef struct vdb_frame_head { // of the result
    texels_active active;
    uint64_t bad;
    struct {
        uint64_t texels, index; // bytes from the beginning of the result; texels 0: none
        uint32_t bricks;
    } images[TEXELS_IMAGES];
} vdb_frame_head;

// ---- "vdb write": this, grids, of each its values and name, entries; back comes the file
// ---------

typedef struct vdb_sent_write { // then so many vdb_write_grid
    uint32_t grids, entries;
} vdb_sent_write;

typedef struct vdb_sent_entry { // then its texts, each with its zero byte
    uint32_t key, text;         // bytes; text 0: it is the number
    double number;
} vdb_sent_entry;

static inline size_t vdb_padded(size_t at) { // where values begin that come next
    return (at + 15) / 16 * 16;
}
static inline size_t vdb_values_size(const vdb_write_grid *g) {
    size_t voxels = (size_t)g->size[0] * g->size[1] * g->size[2];
    return g->halves ? voxels * (size_t)g->stride * sizeof *g->halves
                     : voxels * (size_t)g->components * sizeof *g->values;
}

// ---- in the reader ------------------------------------------------------------------------------

// The frame that is made, in the memory of the result.
typedef struct vdb_build {
    const isolate_call *call;
    const vdb_file *file;
    const vdb_frame_desc *desc;
    vdb_frame_head head;
    size_t used; // bytes of the result
} vdb_build;

// `size` zeroed bytes at the end of the result, from `*at` on; NULL with a message. To be closed
// before others are opened; the first ones are then kept.
void *vdb_build_open(vdb_build *b, size_t size, size_t *at);
bool vdb_build_close(vdb_build *b, void *data, size_t size, size_t at, size_t kept);
bool vdb_build_bricks(vdb_build *b, int image);

bool vdb_put_info(const isolate_call *call, const vdb_info *info);
