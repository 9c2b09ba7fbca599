// OpenEXR pictures: scanline, ZIP, named channels.
#pragma once
#include "base/arena.h"
#include "media/limits.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct exr_channel {
    const char *name;    // "R", "G", "B", "A", "Z", ...
    const float *values; // width * height, rows from the top
    bool half;           // stored as 16-bit; else 32-bit float
} exr_channel;

typedef struct exr_image {
    uint32_t width, height;
    const exr_channel *channels; // any order
    size_t channel_count;
} exr_image;

// Writes a file, atomically. `recipe`: its attribute "roil:recipe"; NULL: none.
bool exr_write_with(const char *path, const exr_image *image, const char *recipe);
bool exr_write(const char *path, const exr_image *image); // without one

typedef struct exr_wish { // what to read of a file
    const char *letters;  // names of channels, each a letter, at most 7: "RGB"; NULL: all channels
    picture_limits limits;
} exr_wish;

// Reads half, float and uint channels of a scanline or tiled single-part file into `memory`. The
// file may be a stranger's: the reader decodes it. `wish` NULL: all channels, default limits.
bool exr_read(const char *path, const exr_wish *wish, arena *memory, exr_image *out);
// Reads a file that must lie below `root` (base/file.h).
bool exr_read_inside(const char *root, const char *path, const exr_wish *wish, arena *memory,
                     exr_image *out);
const float *exr_find(const exr_image *image, const char *channel); // its values; NULL: none

// Decodes the bytes of a file in this process. `name` is for messages. `memory` NULL: reads only
// the size.
bool exr_decode(const void *data, size_t size, const char *name, const exr_wish *wish,
                arena *memory, exr_image *out);
bool exr_work(const isolate_call *call); // this and the next run in a worker
bool exr_size_work(const isolate_call *call);
