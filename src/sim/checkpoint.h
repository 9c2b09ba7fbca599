// States of simulations, on disk or in memory: named parts, each bytes of the host or a buffer of
// the device.
//
// The file: a head, a table of the parts, then their content in chunks of CHECKPOINT_CHUNK bytes,
// each with its hash and, where that makes it smaller, packed. Numbers are little-endian. It is
// there whole or not at all, and it is read with suspicion: whoever wrote it.
#pragma once
#include "base/arena.h"
#include "gpu/gpu.h"

enum { CHECKPOINT_VERSION = 1, CHECKPOINT_PARTS = 256, CHECKPOINT_CHUNK = 1 << 22 };

typedef struct checkpoint_part {
    const char *name;   // unique, at most 63 letters, digits and _./-
    uint64_t size;      // bytes; 0 to 2^40
    uint32_t width;     // of a number in it: 1, 2, 4 or 8; packs better
    gpu_buffer *buffer; // of at least that size; NULL: `bytes`
    void *bytes;
} checkpoint_part;

typedef struct checkpoint_list { // zero: empty
    checkpoint_part *parts;
    size_t count, capacity;
    arena memory; // for names, and bytes of parts that live no longer than the list
} checkpoint_list;
void checkpoint_add(checkpoint_list *list, const checkpoint_part *part);
void checkpoint_list_free(checkpoint_list *list);

// Between frames. `g` may be NULL when no part is a buffer.
bool checkpoint_save(const char *path, gpu *g, const checkpoint_part *parts, size_t count);

typedef struct checkpoint checkpoint;
// Reads the whole file once and checks all hashes, so that what is damaged is known before anything
// is overwritten.
checkpoint *checkpoint_open(const char *path);
// The parts as they are now, in memory: what is a buffer stays on the device. Between frames.
checkpoint *checkpoint_keep(gpu *g, const checkpoint_part *parts, size_t count);
void checkpoint_close(checkpoint *c); // NULL is fine
bool checkpoint_has(const checkpoint *c, const char *name, uint64_t *size);
// Between frames: fills the part, whose size must be the file's. On failure its content is lost.
bool checkpoint_load(checkpoint *c, gpu *g, const checkpoint_part *part);
// What must be the same in the file, as text: a part of lines "key = value". The message says which
// differs.
bool checkpoint_require(checkpoint *c, const char *name, const char *ours);
