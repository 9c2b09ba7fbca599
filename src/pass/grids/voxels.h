// The pass type `voxels`: meshes as cells of a box (scene/voxels.h), as a grid that fields sample.
// What stands still is computed once.
#pragma once
#include "pass/pass.h"

typedef struct pass_voxels_desc {
    box3 box;            // metres; empty: around the meshes of now, with a margin of two cells
    uint32_t size[3];    // cells; 0: cubes by the resolution, and the box grows to whole ones
    uint32_t resolution; // cells along the longest side
} pass_voxels_desc;

enum { // channels of the grid
    PASS_VOXELS_INSIDE = 0,
    PASS_VOXELS_DISTANCE = 4,
    PASS_VOXELS_VELOCITY = 8,
    PASS_VOXELS_CHANNELS = 11,
};

// With its meshes added, before pass_declare; then the grid is the effect's. `context` is that of
// time 0. NULL with a message.
field_grid *pass_voxels_open(pass *p, const pass_voxels_desc *desc, const field_context *context);
// A field by name: "inside", "distance", "velocity"; NULL with a message that suggests. Beyond the
// box the distance goes on as that to the box and from there.
const field *pass_voxels_field(pass *p, const char *name);
const struct voxels *pass_voxels_get(const pass *p); // after pass_declare
