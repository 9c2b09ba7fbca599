// OpenEXR pictures: scanline, ZIP, named channels.
#pragma once
#include "base/arena.h"
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
// Half, float and uint channels of a scanline or tiled single-part file; at most 16384 x 16384.
bool exr_read(const char *path, arena *memory, exr_image *out);
