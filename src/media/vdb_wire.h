// The data of jobs that read and write OpenVDB files, and of their results: between vdb_read.c in
// this process, and vdb_work.c and vdb_bricks.c in the reader.
#pragma once
#include "media/vdb_decode.h"

#define VDB_FILE_BYTES_MAX ((size_t)2 << 30)

// ---- "vdb heads", "vdb info": paths, each with its zero byte; back comes for each file ----------

// "vdb heads" does not use OpenVDB. It returns no metadata as text, and nothing about files whose
// metadata lack the box of a grid's active voxels.
#define VDB_NO_EXTENTS UINT32_MAX // as `count`: such a file; nothing else follows for it
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

static inline size_t vdb_padded(size_t at) { // values begin at multiples of 16 bytes
    return (at + 15) / 16 * 16;
}
static inline size_t vdb_values_size(const vdb_write_grid *g) {
    size_t voxels = (size_t)g->size[0] * g->size[1] * g->size[2];
    return g->halves ? voxels * (size_t)g->stride * sizeof *g->halves
                     : voxels * (size_t)g->components * sizeof *g->values;
}

// ---- the reader ---------------------------------------------------------------------------------

// A frame that is being made, in the memory of the result.
typedef struct vdb_build {
    const isolate_call *call;
    const vdb_file *file;
    const vdb_frame_desc *desc;
    vdb_frame_head head;
    size_t used; // bytes of the result
} vdb_build;

// Appends `size` zeroed bytes to the result, from `*at` on. NULL with a message. They must be
// closed before others are opened; the first `kept` bytes are then kept.
void *vdb_build_open(vdb_build *b, size_t size, size_t *at);
bool vdb_build_close(vdb_build *b, void *data, size_t size, size_t at, size_t kept);
bool vdb_build_bricks(vdb_build *b, int image);

bool vdb_put_info(const isolate_call *call, const vdb_info *info);
