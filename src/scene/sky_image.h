// A panorama of the sky: equirectangular, linear Rec.709, +Z up; its middle column is +Y.
#pragma once
#include "base/arena.h"
#include "gpu/gpu.h"
#include <stdbool.h>

typedef struct sky_image sky_image;

enum { SKY_CELLS_X = 64, SKY_CELLS_Y = 32 }; // of the table that directions are drawn from

// An EXR file below `root`, at most 8192 x 4096. NULL with a message: no EXR, too large, values
// that are negative or not finite, all black.
sky_image *sky_image_load(const char *path, const char *root, arena *memory);
void sky_image_destroy(sky_image *s, gpu *g);          // what it has on the device
bool sky_image_upload(sky_image *s, gpu *g);           // again: does nothing
gpu_image *sky_image_texture(const sky_image *s);      // rgba16f with mips, sampler repeats in x
gpu_image *sky_image_distribution(const sky_image *s); // r32f, SKY_CELLS_X + 1 by SKY_CELLS_Y:
// cumulative share of each cell in its row's light, and in the last column of each row in all
