// What is computed from a panorama once: coarser pictures of it, and what shaders/lib/sky.glsl
// reads from the texture "SkyDistribution".
#pragma once
#include "base/arena.h"
#include "scene/sky_image.h"
#include <stdint.h>

typedef struct panorama {
    uint32_t width, height;
    float *rgb; // rows from the top
} panorama;

// The same picture in another size: means over what each texel covers of the sphere. In `memory`.
panorama panorama_resize(const panorama *from, uint32_t width, uint32_t height, arena *memory);

enum { SKY_TABLE_X = SKY_CELLS_X + 1, SKY_TABLE_Y = SKY_CELLS_Y + 1 };

typedef struct sky_table {
    float values[SKY_TABLE_Y][SKY_TABLE_X]; // sky_image.h says what they are
    float zenith[3], horizon[3];            // mean radiance around the one, and above the other
} sky_table;

void sky_table_fill(const panorama *image, sky_table *out);
