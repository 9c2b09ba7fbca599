// Results that are computed from a panorama once: smaller pictures, and the texture
// "SkyDistribution" of shaders/lib/sky.glsl.
#pragma once
#include "base/arena.h"
#include "scene/sky_image.h"
#include <stdint.h>

typedef struct panorama {
    uint32_t width, height;
    float *rgb; // rows from the top
} panorama;

// Resizes a picture, by means over the part of the sphere that each texel covers. In `memory`.
panorama panorama_resize(const panorama *from, uint32_t width, uint32_t height, arena *memory);

enum { SKY_TABLE_X = SKY_CELLS_X + 1, SKY_TABLE_Y = SKY_CELLS_Y + 1 };

typedef struct sky_table {
    float values[SKY_TABLE_Y][SKY_TABLE_X]; // described in sky_image.h
    float zenith[3], horizon[3];            // mean radiance around the zenith, above the horizon
} sky_table;

void sky_table_fill(const panorama *image, sky_table *out);
