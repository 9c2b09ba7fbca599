// Pictures that effects use as data (templates, obstacles, sprites), from OpenEXR or PNG files. The
// file may be a stranger's: the reader decodes it.
#pragma once
#include "base/arena.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct picture {
    uint32_t width, height;
    int bits;          // bits of a PNG's channels, 8 or 16, which are scaled to 0 to 1; 0: EXR
    const float *rgba; // rows from the top; alpha is 1 where the file has none, grey is repeated
} picture;

// Reads a picture of at most `side_max` pixels a side into `memory`. The file must lie below
// `root`. All values are finite. False with a message.
bool picture_read(const char *path, const char *root, uint32_t side_max, arena *memory,
                  picture *out);

// Writes an OpenEXR file of halves with alpha. Atomic (base/file.h).
bool picture_write(const char *path, const picture *image);
