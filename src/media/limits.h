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

// Opens a file below `root` (base/file.h; NULL: anywhere) for the reader and lets it do `job`, of
// which its kind and arguments are given.
bool picture_run_job(const char *root, const char *path, const picture_limits *limits,
                     isolate_job job, isolate_result *out);
// How large a picture says it is, by the job `kind`: "png size", "exr size".
// Of the user's file `path`.
typedef struct picture_size {
    uint32_t width, height;
} picture_size;
bool picture_read_size(const char *path, const char *kind, picture_size *out);
bool picture_put_size(const isolate_call *call, uint32_t width, uint32_t height); // in a worker

// In a worker: the job's argument. False with a message when it is of another size.
bool picture_take_argument(const isolate_call *call, void *out, size_t size);
