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

bool exr_write(const char *path, const exr_image *image); // atomic

// Of all channels those whose name is one of these letters, "RGB"; NULL: all.
typedef struct exr_wish {
    const char *letters; // at most 7
    picture_limits limits;
} exr_wish;

// Half, float and uint channels of a scanline or tiled single-part file, which may be a stranger's:
// the reader decodes it. `wish` NULL: all channels within the usual limits.
bool exr_read(const char *path, const exr_wish *wish, arena *memory, exr_image *out);
// Below `root` (base/file.h).
bool exr_read_inside(const char *root, const char *path, const exr_wish *wish, arena *memory,
                     exr_image *out);
const float *exr_find(const exr_image *image, const char *channel); // its values, or NULL

// Here and now, the file's bytes; `name` is for messages. Without `memory` its size alone.
bool exr_decode(const void *data, size_t size, const char *name, const exr_wish *wish,
                arena *memory, exr_image *out);
bool exr_work(const isolate_call *call); // in a worker
bool exr_size_work(const isolate_call *call);
