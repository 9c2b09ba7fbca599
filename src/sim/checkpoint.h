// States of simulations, on disk or in memory: named parts, each bytes on the host or a buffer on
// the device.
//
// A file has a header, a table of the parts, then their content in chunks of CHECKPOINT_CHUNK
// bytes, each with its hash, and compressed where that makes it smaller. Numbers are little-endian.
// A file appears complete or not at all. A stranger may have written it, so all of it is checked.
#pragma once
#include "base/arena.h"
#include "gpu/gpu.h"

enum { CHECKPOINT_VERSION = 1, CHECKPOINT_PARTS = 256, CHECKPOINT_CHUNK = 1 << 22 };

typedef struct checkpoint_part {
    const char *name;   // unique, at most 63 letters, digits and _./-
    uint64_t size;      // bytes; 0 to 2^40
    uint32_t width;     // bytes of a number in it: 1, 2, 4 or 8; improves compression
    gpu_buffer *buffer; // of at least that size; NULL: the content is `bytes`
    void *bytes;
} checkpoint_part;

typedef struct checkpoint_list { // zero: empty
    checkpoint_part *parts;
    size_t count, capacity;
    arena memory; // for names, and bytes of parts that live no longer than the list
} checkpoint_list;
void checkpoint_add(checkpoint_list *list, const checkpoint_part *part);
// Add "label/part", a text or the numbers of a clock, which are copied.
void checkpoint_add_text(checkpoint_list *list, const char *label, const char *part,
                         const char *text);
void checkpoint_add_clock(checkpoint_list *list, const char *label, const void *clock, size_t size);
void checkpoint_list_free(checkpoint_list *list);

// Saves the parts. Call it between frames. `g` may be NULL when no part is a buffer.
bool checkpoint_save(const char *path, gpu *g, const checkpoint_part *parts, size_t count);

typedef struct checkpoint checkpoint;
// Opens a file, reads all of it and checks all hashes, so that damage is found before anything is
// overwritten. NULL with a message.
checkpoint *checkpoint_open(const char *path);
// Copies the parts in memory; copies of buffers stay on the device. Call it between frames.
checkpoint *checkpoint_keep(gpu *g, const checkpoint_part *parts, size_t count);
void checkpoint_close(checkpoint *c); // NULL is allowed
bool checkpoint_has(const checkpoint *c, const char *name, uint64_t *size);
// Loads a part, whose size must be the file's. Call it between frames. On failure the part's
// content is undefined.
bool checkpoint_load(checkpoint *c, gpu *g, const checkpoint_part *part);
bool checkpoint_load_clock(checkpoint *c, const char *label, void *clock, size_t size);
// Compares a part of lines "key = value" with `ours`. False with a message that names the key that
// differs.
bool checkpoint_require(checkpoint *c, const char *name, const char *ours);
