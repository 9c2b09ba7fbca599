// A panorama of the sky: equirectangular, linear Rec.709, +Z up. The middle column is +Y.
#pragma once
#include "base/arena.h"
#include "gpu/gpu.h"
#include <stdbool.h>

typedef struct sky_image sky_image;

enum {
    SKY_WIDTH_MAX = 8192,
    SKY_HEIGHT_MAX = 4096,
    SKY_CELLS_X = 256, // cells of the table that directions are sampled from
    SKY_CELLS_Y = 128,
};

// Loads an EXR file below `root`. Values are stored as half floats, and clamped to their maximum.
// NULL with a message when the file is no EXR file, is too large, has negative or non-finite
// values, or is all black.
sky_image *sky_image_load(const char *path, const char *root, arena *memory);
// Returns the same picture without device memory, for another effect. `s` must outlive it.
sky_image *sky_image_share(const sky_image *s, arena *memory);
void sky_image_destroy(sky_image *s, gpu *g);                     // what it has on the device
void sky_image_list_memory(const sky_image *s, budget_list *out); // of what is not uploaded
bool sky_image_upload(sky_image *s, gpu *g);                      // again: does nothing
// Exchanges what both have on the device; false when they are not the same picture.
bool sky_image_exchange(sky_image *s, sky_image *other);
gpu_image *sky_image_texture(const sky_image *s); // rgba16f with mips, sampler repeats in x
// r32f, SKY_CELLS_X + 1 by SKY_CELLS_Y + 1: the cumulative distribution of each row's light over
// its cells, and in the last column that of all light over the rows. The last row has nine
// coefficients of red, green and blue for irradiance (lib/sky.glsl).
gpu_image *sky_image_distribution(const sky_image *s);
// Returns the mean radiance around the zenith, and just above the horizon.
void sky_image_means(const sky_image *s, float zenith[3], float horizon[3]);
