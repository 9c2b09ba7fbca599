// Grid: values on a regular lattice in a box, as up to FIELD_GRID_IMAGES 3D textures of four
// half-float channels each, whole or in bricks. What fills it (a VDB or raw sequence, a bake, a
// solver) implements `update`; fields and the generator see only this.
#pragma once
#include "base/maths.h"
#include "field/extrude.h"
#include "gpu/gpu.h"
#include <stdbool.h>
#include <stddef.h>

enum {
    FIELD_GRID_IMAGES = 4,
    GRID_BRICK =
        4, // texels a side, of which the range is known; GRID_SPARSE_BRICK of a sparse grid
    GRID_SPARSE_BRICK = 8,
};

typedef struct field_grid field_grid;

typedef struct field_grid_state {            // at one time
    gpu_image *images[2][FIELD_GRID_IMAGES]; // two neighbouring frames; the second set may be NULL
    gpu_image *index[2][FIELD_GRID_IMAGES];  // of a sparse grid: where the bricks of each image lie
    float blend;                             // 0: first set only, 1: second
    box3 active;                             // outside of it every channel is background (0)
    uint64_t content; // another number whenever the images may hold something else; 0: unknown
} field_grid_state;

typedef struct field_playback { // of data that is read frame by frame, since it was opened
    uint64_t shown, late;       // frames that came on; updates that another one had to stand in for
    uint64_t decoded, uploaded, decoded_bytes,
        uploaded_bytes;      // frames, and their bytes as textures
    double decode_seconds;   // of all threads together
    uint32_t threads;        // how many there are
    uint64_t device_bytes;   // of the textures
    uint64_t largest_bytes;  // of a frame as it was uploaded
    uint64_t largest_voxels; // of a frame, that are not 0
    bool waiting;            // another frame is standing in just now
} field_playback;

typedef struct field_needs { // bytes of memory
    uint64_t host, device;
} field_needs;

struct field_grid {
    const char *name;  // for messages and dumps
    box3 box;          // world box of the texture: texel centres lie half a voxel inside (metres)
    uint32_t size[3];  // texels
    int channel_count; // channel c lies in image c / 4, component c % 4
    float longest;     // greatest length of a vector of its channels, where known; 0: unknown
    bool repeats;      // goes on for ever beyond its box, as it is within, and is sampled linearly
    bool levels;       // has mip levels: sampled at that of `grid_width` (lib/grid.glsl)
    bool sparse;       // images hold bricks where there is something; lib/grid.glsl says how
    bool blends;       // may ever have blend > 0: the shader then samples both sets
    bool never_waits;  // never waits for data: another frame stands in for one that is late
    bool simulated;    // each frame follows from the one before
    float time_scale;  // seconds that pass in it, and that its velocity is by, in one of the
                       // effect's; 0: 1
    const field_extrusion *extruded; // images are slices round an axis; NULL: they fill the box
    const struct field *content;     // of a bake: what it holds; NULL: not known
    const char *label;               // what the script calls it; NULL: it has no name
    field_grid_state state;          // current; set by update
    // Brings `state` to a time, uploading what is needed. Waits for data that is not decoded yet,
    // unless it never waits and has anything to show. NULL: a pass fills the grid.
    bool (*update)(field_grid *grid, gpu *g, double time);
    void (*destroy)(field_grid *grid, gpu *g); // frees all; NULL: its memory is the effect's
    // Gives `other`, a grid with the same hook, all that this one has read and put on the device,
    // and takes what that one has; false when they do not show the same. NULL: nothing to exchange.
    bool (*exchange)(field_grid *grid, field_grid *other);
    // What its first picture takes at least, as far as nothing of it is there yet. NULL: little.
    field_needs (*needs)(const field_grid *grid);
    const field_playback *(*playback)(const field_grid *grid); // NULL: nothing is played
    // What it holds, by canonical names ("density", "velocity"); NULL past the last. And where: the
    // first channel of a name with its components, 1 or 3; -1 with a message. Without these hooks
    // all channels together are one field, called as the grid is.
    const char *(*field_name)(const field_grid *grid, size_t index);
    int (*find_field)(field_grid *grid, const char *name, int *components);
    // Host value of one channel at a point, trilinear; NULL when there is no host data.
    bool (*sample)(const field_grid *grid, float3 p, int channel, float *out);
};
