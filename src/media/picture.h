// Pictures that effects are made from (templates, obstacles, sprites): OpenEXR or PNG, read as
// numbers. The file may be a stranger's: the reader decodes it.
#pragma once
#include "base/arena.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct picture {
    uint32_t width, height;
    int bits;          // a channel of a PNG, 8 or 16, whose whole numbers became 0 to 1; 0: EXR
    const float *rgba; // rows from the top; without alpha in the file that is 1, grey is all three
} picture;

// At most `side_max` pixels a side; `root` is the folder that the file must lie in. All numbers are
// finite. False with a message.
bool picture_read(const char *path, const char *root, uint32_t side_max, arena *memory,
                  picture *out);

// As OpenEXR of halves with alpha. Atomic.
bool picture_write(const char *path, const picture *image);
