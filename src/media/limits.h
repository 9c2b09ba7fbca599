// Limits on the size of pictures from strangers. A file of 4 MB can hold a picture of gigabytes, so
// its header is checked against the limits before any memory is taken.
#pragma once
#include "base/isolate.h"
#include <stdbool.h>

typedef struct picture_limits {
    uint32_t width, height; // pixels
    uint64_t bytes;         // of the decoded channels that are asked for
} picture_limits;

extern const picture_limits picture_limits_default; // 16384 x 16384, 1 GiB

// Returns whether a picture is within the limits. False with a message that names its bytes.
bool picture_limits_allow(const picture_limits *limits, const char *name, int64_t width,
                          int64_t height, size_t pixel_bytes);

// Returns the limits of a worker that decodes a file of `size` bytes.
isolate_limits picture_limits_of_job(const picture_limits *limits, size_t size);

// Opens a file below `root` (base/file.h; NULL: anywhere) and has the reader do `job` on it. The
// caller sets the kind and the arguments of the job.
bool picture_run_job(const char *root, const char *path, const picture_limits *limits,
                     isolate_job job, isolate_result *out);
// The size of a picture according to its header.
typedef struct picture_size {
    uint32_t width, height;
} picture_size;
// Reads the size of the user's file `path`. `kind` is the job: "png size" or "exr size".
bool picture_read_size(const char *path, const char *kind, picture_size *out);
bool picture_put_size(const isolate_call *call, uint32_t width, uint32_t height); // in a worker

// Returns the job's argument, in a worker. False with a message when its size is not `size`.
bool picture_take_argument(const isolate_call *call, void *out, size_t size);
