// Templates: pictures of pressure or velocity that are put into what flows for a while, again and
// again (Krueger and Westermann 2005, 3). A group is a pass that `slices`, `lbm` or `pyro` runs
// itself before each step; all groups of a flow are a set. Each lives on the device, and depends on
// seeds and steps alone: what is drawn, and how often, changes nothing.
//
// Picture: red and green are velocity to the right and up, blue is pressure, alpha how much of it
// is put there. EXR holds them as they are; in a PNG 128 of 255 (32768 of 65535) is 0. Where alpha
// is 1 everywhere, which is a file without it, the border fades as a Gaussian, from 1 in the middle
// to 0.004.
#pragma once
#include "base/budget.h"
#include "media/picture.h"
#include "pass/pass.h"

enum {
    TEMPLATE_TILE = 64,       // texels a side of a picture as it is on the device
    TEMPLATE_TILE_LEVELS = 4, // 64 to 8
    TEMPLATE_TILE_VALUES = 4 * TEMPLATE_TILE * TEMPLATE_TILE,
    TEMPLATE_GROUPS = 16,  // of a set
    TEMPLATES_MOST = 4096, // of all groups
};

typedef struct template_group {
    pass *pass;
    void *owner; // what flows
    const picture *image;
    uint32_t index, first, count; // in the set
} template_group;

typedef struct template_set { // zero: empty
    template_group *groups[TEMPLATE_GROUPS];
    uint32_t group_count, total;
    float *tiles;                  // of groups, then more; NULL: none yet
    uint32_t more;                 // tiles besides those of groups
    gpu_image *images;             // these, below each other
    gpu_buffer *instances, *masks; // shaders/lib/templates.glsl says how they lie there
    uint32_t parity;               // half of the masks, that the next step writes
    bool fresh;                    // instances begin anew with the next step
    bool unmarked;                 // masks hold nothing that is known
} template_set;

// Adds a group of `count`, whose state becomes `owner`'s template_group. The picture lives as long
// as the effect. False with a message, in which `each` is how often there are as many: "" or " in
// each slice".
bool template_set_add(template_set *t, void *owner, pass *group, const picture *image,
                      uint32_t count, const char *each);
// Calls it for all groups, until one fails.
bool template_set_each(const template_set *t, bool (*call)(pass *group));
// Whether one of them has that word of the option `kind`, which is a name of its type's.
bool template_set_has(const template_set *t, int kind, size_t word);

// ---- on the device ----------------------------------------------------------------------------

// The side of a tile: `least` cells, or as many times that as leave at most 32 along an axis.
uint32_t template_tile_side(uint32_t cells, uint32_t least);
uint64_t template_mask_bytes(const template_set *t, uint64_t tiles);
// Of `rows` of all of them, `sets` times.
uint64_t template_instance_bytes(const template_set *t, uint32_t rows, uint32_t sets);
// What template_set_allocate will take.
void template_set_list_memory(const template_set *t, uint64_t instances, uint64_t masks,
                              budget_list *out);
// Makes the tiles; `fill` makes those besides, and may be NULL where there are none. What is there
// already is kept.
bool template_set_make_images(template_set *t, gpu *device,
                              void (*fill)(const void *from, uint32_t index, float *tile),
                              const void *from);
bool template_set_write_images(const template_set *t, gpu *device); // tiles that have changed
bool template_set_allocate(template_set *t, gpu *device, uint64_t instances, uint64_t masks);
void template_set_destroy(template_set *t, gpu *device);
// Before the groups of a step run.
void template_set_begin(template_set *t, gpu *device);
// Where both have the same groups, each takes over what the other's templates are.
void template_set_exchange(template_set *a, template_set *b);

// A picture as a tile: rows from the top, red, green and blue times alpha, alpha.
void template_tile(const picture *from, float out[TEMPLATE_TILE_VALUES]);
// Gives it alpha that fades to the border, as that of the library's pictures.
void template_tile_fade(float rgba[TEMPLATE_TILE_VALUES]);
// The next level of a tile, of half the size.
void template_tile_half(const float *from, uint32_t side, float *out);
