// A camera that a host's renderer gives as matrices.
#pragma once
#include "shared.h"
#include <stdbool.h>

typedef struct scene_view { // column-major
    float view[16];         // from the effect's space (m, z up) to the camera's
    float projection[16];   // to clip space, with depths from 0 to 1
    float jitter[2];        // pixels to the right and down by which the picture is moved
} scene_view;

// What follows from a projection. The camera of roil looks along -z, with y up.
typedef struct scene_lens {
    float across[2]; // tangents of half the angles of view
    float shift[2];  // of the middle of the picture to the right and up, in halves of it
    float depths[2]; // a depth d of the host's buffer is depths[1] / (d + depths[0]) metres
    float near, far; // metres
    float z;         // -1: the host's camera looks along +z
} scene_lens;
// False with a message: it is no perspective, or no matrix of numbers.
bool scene_view_lens(const scene_view *v, scene_lens *out);
// Replaces the camera of the block, for a picture of so many pixels. The view must have a lens.
void scene_view_fill(const scene_view *v, const uint32_t size[2], struct frame_block *out);
