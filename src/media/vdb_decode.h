// The part of vdb.h that uses OpenVDB, for the reader and for fuzzers: it reads files in memory.
// Any thread may call it, but a vdb_blocks belongs to one thread at a time.
#pragma once
#include "base/isolate.h"
#include "media/vdb.h"

void vdb_work_alone(void); // from now on OpenVDB starts no threads

typedef struct vdb_file vdb_file;
// Opens a file in memory. `name` (for messages) and `bytes` must outlive it. NULL with a message.
vdb_file *vdb_file_open(const char *name, const void *bytes, size_t size);
void vdb_file_close(vdb_file *f); // NULL is allowed
// Reads the metadata. A grid whose metadata have no box is read for it.
bool vdb_file_info(const vdb_file *f, arena *memory, vdb_info *out);
bool vdb_file_sample(const vdb_file *f, const vdb_sample_desc *desc, uint64_t *bad);

// One grid of a file, which stays sparse and is read in blocks. The values are those of vdb_sample.
typedef struct vdb_blocks vdb_blocks;
vdb_blocks *vdb_blocks_open(const vdb_file *f, const vdb_sample_desc *desc); // of any size
void vdb_blocks_close(vdb_blocks *b);                                        // NULL is allowed
// Called with boxes of voxels (inclusive, within the size); all voxels outside of these boxes have
// the background value.
typedef void vdb_block_found(void *user, const int32_t low[3], const int32_t high[3]);
void vdb_blocks_visit(const vdb_blocks *b, vdb_block_found *found, void *user);
void vdb_blocks_background(const vdb_blocks *b, float out[3]); // background value
// Reads VDB_BLOCK^3 voxels from `at` on, x fastest; they may lie outside. Returns how many of the
// first 8^3 values were not finite and became 0.
uint64_t vdb_blocks_read(vdb_blocks *b, const int32_t at[3], float *out);

// Encodes a file with these grids. Free `*data` with mem_free. `name` is for messages.
bool vdb_encode(const char *name, const vdb_write_grid *grids, size_t count,
                const vdb_entry *metadata, size_t entries, void **data, size_t *size);

// Prepares OpenVDB once, in the process that workers are forked from: it disables threads and does
// what the first file would cost (resolving 100 symbols, making tables).
void vdb_get_ready(void);

// Do the jobs "vdb heads", "vdb info", "vdb sample", "vdb frame" and "vdb write", in a worker. The
// first one does not use OpenVDB.
bool vdb_heads_work(const isolate_call *call);
bool vdb_info_work(const isolate_call *call);
bool vdb_sample_work(const isolate_call *call);
bool vdb_frame_work(const isolate_call *call);
bool vdb_write_work(const isolate_call *call);
