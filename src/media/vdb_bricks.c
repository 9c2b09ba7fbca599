// Stores one frame in bricks.
//
// The box is divided into bricks of 8^3 voxels. A brick is stored with the voxels of its neighbours
// that linear filtering reaches, 9^3: neighbours share a face, so one side of each is enough.
// Bricks are stored in an atlas, a 3D texture; an index texture gives their positions
// (shaders/lib/grid.glsl). A brick that is constant inside and on those faces (space outside, the
// inside of a level set, constant tiles) is stored once for each value, and not at all when it is
// zero. The layout is that of GigaVoxels (Crassin, Neyret, Lefebvre and Eisemann, I3D 2009) without
// its tree: the index of a box of 512^3 takes 1 MiB.
#include "base/error.h"
#include "base/map.h"
#include "base/maths.h"
#include "base/memory.h"
#include "media/vdb_wire.h"
#include <string.h>

enum { SIDE = VDB_BLOCK, VOXELS = SIDE * SIDE * SIDE };

typedef struct source {
    vdb_blocks *blocks;
    const vdb_source *from;
} source;

typedef struct builder {
    const vdb_frame_desc *desc;
    const vdb_file *file;
    uint64_t *bad;
    int image, width; // components of a texel
    source sources[4];
    size_t source_count;
    uint32_t size[3];   // voxels along our axes
    uint32_t across[3]; // bricks of the box
    uint64_t count;
    bool *wanted;     // of bricks: may differ from the background
    map constants;    // value of a texel -> number of a brick
    uint32_t room;    // bricks that there may be
    uint32_t *index;  // of the result
    uint16_t *texels; // room for two more than that
    uint32_t bricks;  // that there are
    texels_active active;
} builder;

// ---- sources ----------------------------------------------------------------------------------

static bool open_sources(builder *b) {
    const vdb_frame_desc *d = b->desc;
    vdb_sample_desc desc = {.path = d->path, .box = d->box, .level_set = d->level_set};
    memcpy(desc.size, d->shape.size, sizeof desc.size);
    for (size_t i = 0; i < d->count; i++) {
        const vdb_source *from = &d->sources[i];
        if (from->channels[0] / 4 != b->image) continue;
        desc.grid = from->grid;
        desc.components = from->components;
        source made = {.blocks = vdb_blocks_open(b->file, &desc), .from = from};
        if (!made.blocks) return false;
        b->sources[b->source_count++] = made;
    }
    return true;
}

// ---- which bricks -----------------------------------------------------------------------------

// Marks bricks that contain one of the voxels, or have one on a face that they share with a
// neighbour.
static void want(void *user, const int32_t file_low[3], const int32_t file_high[3]) {
    builder *b = user;
    const texels_shape *shape = &b->desc->shape;
    uint32_t low[3], high[3], at[3];
    for (int i = 0; i < 3; i++) {
        low[i] = (uint32_t)file_low[i];
        high[i] = (uint32_t)file_high[i];
    }
    if (shape->y_up) {
        uint32_t last = shape->size[2] - 1;
        low[1] = last - (uint32_t)file_high[2];
        high[1] = last - (uint32_t)file_low[2];
        low[2] = (uint32_t)file_low[1];
        high[2] = (uint32_t)file_high[1];
    }
    for (int i = 0; i < 3; i++) {
        low[i] = low[i] > 0 ? (low[i] - 1) / VDB_BRICK : 0;
        high[i] /= VDB_BRICK;
    }
    for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++) {
            size_t row = ((size_t)at[2] * b->across[1] + at[1]) * b->across[0];
            memset(b->wanted + row + low[0], 1, high[0] - low[0] + 1);
        }
}

static float valued(const vdb_source *from, int component, float value) {
    return clampf(value * from->gains[component], -TEXELS_HALF_MAX, TEXELS_HALF_MAX);
}

// Reads the background. False when it is zero.
static bool read_background(const builder *b, uint16_t texel[4]) {
    bool any = false;
    for (size_t i = 0; i < b->source_count; i++) {
        const vdb_source *from = b->sources[i].from;
        float values[3];
        vdb_blocks_background(b->sources[i].blocks, values);
        for (int c = 0; c < from->components; c++) {
            float v = valued(from, c, values[c]);
            if (v == 0) continue; // also -0
            texel[from->channels[c] % 4] = half_from_float(v);
            any = true;
        }
    }
    return any;
}

// ---- values -----------------------------------------------------------------------------------

// Counts voxels that are not zero, before values are rounded to halves, and extends their box.
static void note_active(builder *b, const uint32_t low[3], const uint32_t high[3], uint64_t count) {
    texels_active *a = &b->active;
    for (int i = 0; i < 3; i++) {
        if (low[i] < a->low[i]) a->low[i] = low[i];
        if (high[i] > a->high[i]) a->high[i] = high[i];
    }
    a->voxels += count;
}

// The same for a brick's own voxels inside of the box. A row is eight bytes of 0 or 1.
static void note_voxels(builder *b, const uint32_t at[3], const uint8_t *active) {
    uint32_t own[3], low[3], high[3];
    for (int i = 0; i < 3; i++) {
        own[i] = b->size[i] - at[i] < VDB_BRICK ? b->size[i] - at[i] : VDB_BRICK;
        low[i] = UINT32_MAX;
        high[i] = 0;
    }
    uint64_t mask = UINT64_MAX >> 8 * (VDB_BRICK - own[0]), across = 0, count = 0;
    for (uint32_t z = 0; z < own[2]; z++)
        for (uint32_t y = 0; y < own[1]; y++) {
            uint64_t row;
            memcpy(&row, active + (z * SIDE + y) * SIDE, sizeof row);
            row &= mask;
            if (row == 0) continue;
            across |= row;
            count += (uint64_t)__builtin_popcountll(row);
            if (low[2] == UINT32_MAX) low[2] = at[2] + z;
            high[2] = at[2] + z + 1;
            if (at[1] + y < low[1]) low[1] = at[1] + y;
            if (at[1] + y + 1 > high[1]) high[1] = at[1] + y + 1;
        }
    if (count == 0) return;
    low[0] = at[0] + (uint32_t)__builtin_ctzll(across) / 8;
    high[0] = at[0] + VDB_BRICK - (uint32_t)__builtin_clzll(across) / 8;
    note_active(b, low, high, count);
}

static void note_brick(builder *b, const uint32_t brick[3]) {
    uint32_t low[3], high[3];
    uint64_t count = 1;
    for (int i = 0; i < 3; i++) {
        low[i] = brick[i] * VDB_BRICK;
        high[i] = low[i] + VDB_BRICK;
        if (high[i] > b->size[i]) high[i] = b->size[i];
        count *= high[i] - low[i];
    }
    note_active(b, low, high, count);
}

// Equals half_from_float for values up to TEXELS_HALF_MAX, and gives 0 for -0. It has no branches,
// so that the compiler vectorises it.
static inline uint16_t half_of(float value) {
    uint32_t bits, rounded;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    float small; // adding 0.5 aligns the mantissa of what will be subnormal
    memcpy(&small, &magnitude, sizeof small);
    small += 0.5f;
    memcpy(&rounded, &small, sizeof rounded);
    uint32_t normal = (magnitude - 0x38000000u + 0xfffu + (magnitude >> 13 & 1u)) >> 13;
    uint32_t half = magnitude < 0x38800000u ? rounded - 0x3f000000u : normal;
    return (uint16_t)(magnitude == 0 ? 0 : sign | half);
}

// Converts one component of a block, `step` floats apart, to halves `width` apart, and notes which
// values are not 0.
static void block_convert(const float *restrict values, int step, float gain,
                          uint16_t *restrict out, int width, uint8_t *restrict active) {
    uint16_t halves[VOXELS];
    for (int i = 0; i < VOXELS; i++) {
        float v = values[i * step] * gain;
        v = v < -TEXELS_HALF_MAX ? -TEXELS_HALF_MAX : v;
        v = v > TEXELS_HALF_MAX ? TEXELS_HALF_MAX : v;
        active[i] |= v != 0;
        halves[i] = half_of(v);
    }
    for (int i = 0; i < VOXELS; i++) out[i * width] = halves[i];
}

// Rotates a block of a file with Y up, whose rows are along other axes than ours.
static void block_turn(float *block, int components) {
    float turned[VOXELS * 3];
    size_t row = SIDE * (size_t)components;
    for (int z = 0; z < SIDE; z++)
        for (int y = 0; y < SIDE; y++)
            memcpy(turned + (size_t)(z * SIDE + y) * row,
                   block + (size_t)((SIDE - 1 - y) * SIDE + z) * row, row * sizeof *block);
    memcpy(block, turned, VOXELS * (size_t)components * sizeof *block);
}

static void read_brick(builder *b, const uint32_t at[3], uint16_t *texels) {
    uint8_t active[VOXELS] = {0};
    float block[VOXELS * 3];
    const texels_shape *shape = &b->desc->shape;
    int32_t corner[3] = {(int32_t)at[0], (int32_t)at[1], (int32_t)at[2]};
    if (shape->y_up) {
        corner[1] = (int32_t)at[2];
        corner[2] = (int32_t)(shape->size[2] - 1 - at[1]) - VDB_BRICK;
    }
    for (size_t i = 0; i < b->source_count; i++) {
        const vdb_source *from = b->sources[i].from;
        *b->bad += vdb_blocks_read(b->sources[i].blocks, corner, block);
        if (shape->y_up) block_turn(block, from->components);
        for (int c = 0; c < from->components; c++)
            block_convert(block + c, from->components, from->gains[c],
                          texels + from->channels[c] % 4, b->width, active);
    }
    note_voxels(b, at, active);
}

// ---- bricks -----------------------------------------------------------------------------------

// Returns room for a brick. There is always room for one more than b->room, for a brick that is
// about to be given back.
static uint16_t *add_brick(builder *b) {
    return b->texels + b->bricks++ * VOXELS * (size_t)b->width;
}

static bool is_constant(const uint16_t *texels, int width) {
    for (int i = width; i < VOXELS * width; i++)
        if (texels[i] != texels[i - width]) return false;
    return true;
}

// Returns the number, from 1, of the brick that holds only this texel; 0: it is zero.
static uint32_t find_constant(builder *b, const uint16_t *texel) {
    uint16_t all[4] = {0};
    memcpy(all, texel, (size_t)b->width * sizeof *texel);
    if ((all[0] | all[1] | all[2] | all[3]) == 0) return 0;
    const void *key = (const void *)(uintptr_t)(1 + ((uint32_t)all[2] | (uint64_t)all[3] << 16));
    uint32_t rest = all[0] | (uint32_t)all[1] << 16;
    const uint32_t *known = map_find(&b->constants, key, rest);
    if (known) return *known;
    uint16_t *made = add_brick(b);
    for (int i = 0; i < VOXELS * b->width; i++) made[i] = all[i % b->width];
    map_set(&b->constants, key, rest, b->bricks);
    return b->bricks;
}

static uint32_t make_brick(builder *b, const uint32_t brick[3]) {
    const uint32_t at[3] = {brick[0] * VDB_BRICK, brick[1] * VDB_BRICK, brick[2] * VDB_BRICK};
    uint16_t *texels = add_brick(b), first[4];
    read_brick(b, at, texels);
    if (!is_constant(texels, b->width)) return b->bricks;
    memcpy(first, texels, (size_t)b->width * sizeof *first);
    b->bricks--;
    return find_constant(b, first);
}

// How many bricks there may be, within the limit of a frame. What is not written to takes no
// memory.
static void count_room(builder *b, const vdb_build *made) {
    uint64_t brick = VOXELS * (uint64_t)b->width * sizeof(uint16_t), wanted = 1;
    uint64_t taken = made->used + b->count * sizeof *b->index;
    uint64_t most = b->desc->max_bytes > taken ? b->desc->max_bytes - taken : 0;
    for (uint64_t i = 0; i < b->count; i++) wanted += b->wanted[i];
    b->room = VDB_MOST_BRICKS;
    if (b->room > wanted) b->room = (uint32_t)wanted;
    if (b->room > most / brick) b->room = (uint32_t)(most / brick);
}

static bool too_large(const vdb_frame_desc *d) {
    return err_set("%s: what is not empty needs more than %llu MiB, the limit of a frame", d->path,
                   (unsigned long long)(d->max_bytes >> 20));
}

static bool make_bricks(builder *b) {
    uint16_t background[4] = {0};
    bool full = read_background(b, background);
    uint32_t outside = find_constant(b, background), *index = b->index, brick[3];
    for (brick[2] = 0; brick[2] < b->across[2]; brick[2]++)
        for (brick[1] = 0; brick[1] < b->across[1]; brick[1]++) {
            for (brick[0] = 0; brick[0] < b->across[0]; brick[0]++, index++) {
                bool wanted = b->wanted[index - b->index];
                *index = wanted ? make_brick(b, brick) : outside;
                if (full && !wanted) note_brick(b, brick);
                if (b->bricks > b->room) return too_large(b->desc);
            }
        }
    return true;
}

// The index, then the bricks.
static bool fill_image(builder *b, vdb_build *made) {
    size_t brick = VOXELS * (size_t)b->width * sizeof *b->texels, at;
    size_t index = (size_t)b->count * sizeof *b->index;
    count_room(b, made);
    size_t size = index + (b->room + 2) * brick;
    b->index = vdb_build_open(made, size, &at);
    if (!b->index) return false;
    b->texels = (uint16_t *)(b->index + b->count);
    bool done = make_bricks(b);
    if (!vdb_build_close(made, b->index, size, at, index + b->bricks * brick)) done = false;
    made->head.images[b->image].index = at;
    made->head.images[b->image].texels = at + index;
    made->head.images[b->image].bricks = b->bricks;
    return done;
}

static void active_join(texels_active *all, const texels_active *one) {
    for (int i = 0; i < 3; i++) {
        if (one->low[i] < all->low[i]) all->low[i] = one->low[i];
        if (one->high[i] > all->high[i]) all->high[i] = one->high[i];
    }
    if (one->voxels > all->voxels) all->voxels = one->voxels;
}

bool vdb_build_bricks(vdb_build *made, int image) {
    const texels_shape *shape = &made->desc->shape;
    builder b = {.desc = made->desc,
                 .file = made->file,
                 .bad = &made->head.bad,
                 .image = image,
                 .width = texels_width(shape, image),
                 .count = vdb_brick_count(shape),
                 .active = texels_nothing()};
    texels_size(shape, b.size);
    for (int i = 0; i < 3; i++) b.across[i] = (b.size[i] + VDB_BRICK - 1) / VDB_BRICK;
    b.wanted = mem_alloc((size_t)b.count);
    bool done = open_sources(&b);
    for (size_t i = 0; done && i < b.source_count; i++)
        vdb_blocks_visit(b.sources[i].blocks, want, &b);
    done = done && fill_image(&b, made);
    active_join(&made->head.active, &b.active);
    for (size_t i = 0; i < b.source_count; i++) vdb_blocks_close(b.sources[i].blocks);
    mem_free(b.wanted);
    map_free(&b.constants);
    return done;
}
