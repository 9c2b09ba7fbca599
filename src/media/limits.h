// How large a picture from a stranger may be. A file of 4 MB can hold one of gigabytes: its header
// is held against the limits before any memory is taken.
#pragma once
#include "base/isolate.h"
#include <stdbool.h>

typedef struct picture_limits {
    uint32_t width, height; // pixels
    uint64_t bytes;         // of the numbers that are asked for, decoded
} picture_limits;

extern const picture_limits picture_limits_default; // 16384 x 16384, 1 GiB

// False with a message that names the sum.
bool picture_limits_allow(const picture_limits *limits, const char *name, int64_t width,
                          int64_t height, size_t pixel_bytes);

// What a worker of the reader may use that decodes a file of `size` bytes.
isolate_limits picture_limits_of_job(const picture_limits *limits, size_t size);
