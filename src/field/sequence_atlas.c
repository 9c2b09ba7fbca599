// Where the bricks of a frame (media/vdb_bricks.c) lie on the device: in an atlas, a 3D texture; an
// index texture says which is where (shaders/lib/grid.glsl).
#include "field/sequence_parts.h"
#include <assert.h>
#include <string.h>

enum {
    SIDE = VDB_BLOCK,
    STORED = 1 << 30, // bit of the index: 0 is a brick of zeros
};
static_assert(VDB_ACROSS < 1024, "a place has ten bits for each axis");

// From numbers to places: rows and layers of a square, so that the atlas grows by whole layers.
void sequence_atlas_place(const sequence_data *s, sequence_bricks *bricks) {
    uint32_t across = s->atlas_across;
    while ((uint64_t)across * across * VDB_ACROSS < bricks->count) across++;
    bricks->across = across;
    bricks->layers = (bricks->count + across * across - 1) / (across * across);
    if (bricks->layers == 0) bricks->layers = 1; // an image cannot be empty
    size_t count = (size_t)sequence_brick_count(s);
    for (size_t i = 0; i < count; i++) {
        uint32_t n = bricks->index[i];
        if (n-- == 0) continue;
        uint32_t x = n % across, y = n / across % across, z = n / across / across;
        bricks->index[i] = STORED | x | y << 10 | z << 20;
    }
}

void sequence_atlas_write(const sequence_data *s, const sequence_texels *texels, int image,
                          void *out) {
    const sequence_bricks *bricks = &texels->bricks[image];
    uint32_t across = bricks->across;
    size_t row = SIDE * (size_t)sequence_texel_width(s, image) * sizeof(uint16_t);
    const char *from = (const char *)texels->images[image];
    char *to = out;
    for (uint32_t z = 0; z < bricks->layers * SIDE; z++)
        for (uint32_t y = 0; y < across * SIDE; y++)
            for (uint32_t x = 0; x < across; x++, to += row) {
                uint64_t brick = ((uint64_t)(z / SIDE) * across + y / SIDE) * across + x;
                size_t in = z % SIDE * SIDE + y % SIDE;
                if (brick < bricks->count)
                    memcpy(to, from + (brick * SIDE * SIDE + in) * row, row);
                else
                    memset(to, 0, row);
            }
}
