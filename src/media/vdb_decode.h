// OpenVDB's side of vdb.h, for the reader and for fuzzers: files that lie in memory, read by the
// library itself. Any thread, but for vdb_blocks, which is for one at a time.
#pragma once
#include "base/isolate.h"
#include "media/vdb.h"

void vdb_work_alone(void); // from now on OpenVDB starts no threads

typedef struct vdb_file vdb_file;
// `name`, for messages, and `bytes` must outlive it. NULL with a message.
vdb_file *vdb_file_open(const char *name, const void *bytes, size_t size);
void vdb_file_close(vdb_file *f); // NULL is fine
// Metadata only, but where the file lacks a box in them: there the grid is read.
bool vdb_file_info(const vdb_file *f, arena *memory, vdb_info *out);
bool vdb_file_sample(const vdb_file *f, const vdb_sample_desc *desc, uint64_t *bad);

// One grid of a file, kept as the file has it and read in blocks; values are those of vdb_sample.
typedef struct vdb_blocks vdb_blocks;
vdb_blocks *vdb_blocks_open(const vdb_file *f, const vdb_sample_desc *desc); // of any size
void vdb_blocks_close(vdb_blocks *b);                                        // NULL is fine
// Names boxes of voxels (inclusive, within the size) outside of which all is background.
typedef void vdb_block_found(void *user, const int32_t low[3], const int32_t high[3]);
void vdb_blocks_visit(const vdb_blocks *b, vdb_block_found *found, void *user);
void vdb_blocks_background(const vdb_blocks *b, float out[3]); // its components
// VDB_BLOCK^3 voxels from `at` on, x fastest; it may lie outside. Returns how many of its first
// 8^3 values were not finite and became 0.
uint64_t vdb_blocks_read(vdb_blocks *b, const int32_t at[3], float *out);

// The bytes of a file with these grids; free `*data` with mem_free. `name` is for messages.
bool vdb_encode(const char *name, const vdb_write_grid *grids, size_t count,
                const vdb_entry *metadata, size_t entries, void **data, size_t *size);

// Once, in the process that workers are forked from: no threads, and what a first file costs (100
// symbols to be found, tables to be made) is done.
void vdb_get_ready(void);

// The work of the jobs "vdb heads", "vdb info", "vdb sample", "vdb frame" and "vdb write". The
// first one is done without OpenVDB.
bool vdb_heads_work(const isolate_call *call);
bool vdb_info_work(const isolate_call *call);
bool vdb_sample_work(const isolate_call *call);
bool vdb_frame_work(const isolate_call *call);
bool vdb_write_work(const isolate_call *call);
