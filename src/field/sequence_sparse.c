// One frame in bricks: what of a grid is not empty, and where it lies.
//
// The box is divided into bricks of 8^3 voxels. A brick is stored with the voxels of its neighbours
// that linear filtering reaches, 9^3: neighbours share a face, so one side of each suffices. Bricks
// lie in an atlas, a 3D texture; an index texture says where (shaders/lib/grid.glsl). What does not
// vary inside a brick and on those faces (space outside, the inside of a level set, tiles of a
// constant) is stored once for each value, and not at all where it is zero. The layout is that of
// GigaVoxels (Crassin, Neyret, Lefebvre and Eisemann, I3D 2009) without its tree: the index of a
// box of 512^3 takes 1 MiB.
#include "base/error.h"
#include "base/map.h"
#include "base/memory.h"
#include "field/sequence_parts.h"
#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    SIDE = SEQUENCE_BRICK + 1,
    VOXELS = SIDE * SIDE * SIDE,
    MOST_ACROSS = 2048 / SIDE, // bricks along a side of the atlas: every device has 2048 texels
    STORED = 1 << 30,          // bit of the index: 0 is a brick of zeros
};
static_assert((int)SIDE == (int)VDB_BLOCK && MOST_ACROSS < 1024,
              "a place has ten bits for each axis");

typedef struct source {
    vdb_blocks *blocks;
    int components;
    int channels[3]; // of the texel, for each component
    float gains[3];
} source;

typedef struct builder {
    const sequence_data *s;
    sequence_texels *out;
    vdb_file *file;
    int image, width; // components of a texel
    source sources[4];
    size_t source_count;
    uint32_t across[3]; // bricks of the box
    bool *wanted;       // of bricks: may differ from the background
    map constants;      // value of a texel -> number of a brick
    uint32_t room;      // bricks that there may be
    uint32_t low[3], high[3];
    uint64_t active;
} builder;

uint64_t sequence_brick_count(const sequence_data *s) { // of the box
    uint64_t count = 1;
    for (int i = 0; i < 3; i++) count *= (s->file_size[i] + SEQUENCE_BRICK - 1) / SEQUENCE_BRICK;
    return count;
}

// ---- sources ----------------------------------------------------------------------------------

static bool open_source(builder *b, const vdb_grid_info *grid, uint32_t frame, source made) {
    const sequence_data *s = b->s;
    if (!grid || grid->index_min[0] > grid->index_max[0]) return true; // zeros
    vdb_sample_desc desc = {.root = s->desc.root,
                            .path = s->files[frame],
                            .grid = grid->name,
                            .box = s->file_box,
                            .size = {s->file_size[0], s->file_size[1], s->file_size[2]},
                            .components = grid->components};
    made.blocks = vdb_blocks_open(&desc, b->file);
    if (!made.blocks) return false;
    made.components = grid->components;
    b->sources[b->source_count++] = made;
    return true;
}

// With Y up, our Y is the file's -Z and our Z its Y.
static bool open_channel(builder *b, uint32_t frame, const sequence_channel_info *channel) {
    const vdb_info *info = &b->s->infos[frame];
    bool turned = b->s->desc.y_up;
    int first = channel->first - 4 * b->image;
    float gain = channel->gain;
    const vdb_grid_info *grid = sequence_find_grid(info, channel->name, 0);
    if (grid && grid->components == 3 && channel->components == 3) {
        source all = {.channels = {first, first + (turned ? 2 : 1), first + (turned ? 1 : 2)},
                      .gains = {gain, gain, turned ? -gain : gain}};
        return open_source(b, grid, frame, all);
    }
    for (int part = 0; part < channel->components; part++) {
        grid = sequence_find_grid(info, channel->name, part);
        if (grid && grid->components != 1) continue;
        int to = turned && part > 0 ? 3 - part : part;
        bool flipped = turned && part == 2;
        source one = {.channels = {first + to}, .gains = {flipped ? -gain : gain}};
        if (!open_source(b, grid, frame, one)) return false;
    }
    return true;
}

static bool open_sources(builder *b, uint32_t frame) {
    const sequence_data *s = b->s;
    for (size_t i = 0; i < s->channel_count; i++)
        if (s->channels[i].first / 4 == b->image && !open_channel(b, frame, &s->channels[i]))
            return false;
    return true;
}

// ---- which bricks -----------------------------------------------------------------------------

// Bricks that hold one of the voxels, on their own or on the faces shared with their neighbours.
static void want(void *user, const int32_t file_low[3], const int32_t file_high[3]) {
    builder *b = user;
    const sequence_data *s = b->s;
    uint32_t low[3], high[3], at[3];
    for (int i = 0; i < 3; i++) {
        low[i] = (uint32_t)file_low[i];
        high[i] = (uint32_t)file_high[i];
    }
    if (s->desc.y_up) {
        uint32_t last = s->file_size[2] - 1;
        low[1] = last - (uint32_t)file_high[2];
        high[1] = last - (uint32_t)file_low[2];
        low[2] = (uint32_t)file_low[1];
        high[2] = (uint32_t)file_high[1];
    }
    for (int i = 0; i < 3; i++) {
        low[i] = low[i] > 0 ? (low[i] - 1) / SEQUENCE_BRICK : 0;
        high[i] /= SEQUENCE_BRICK;
    }
    for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++) {
            size_t row = ((size_t)at[2] * b->across[1] + at[1]) * b->across[0];
            memset(b->wanted + row + low[0], 1, high[0] - low[0] + 1);
        }
}

static float valued(const source *from, int component, float value) {
    return clampf(value * from->gains[component], -SEQUENCE_HALF_MAX, SEQUENCE_HALF_MAX);
}

// False when it is nothing at all.
static bool read_background(const builder *b, uint16_t texel[4]) {
    bool any = false;
    for (size_t i = 0; i < b->source_count; i++) {
        const source *from = &b->sources[i];
        float values[3];
        vdb_blocks_background(from->blocks, values);
        for (int c = 0; c < from->components; c++) {
            float v = valued(from, c, values[c]);
            if (v == 0) continue; // also -0
            texel[from->channels[c]] = half_from_float(v);
            any = true;
        }
    }
    return any;
}

// ---- values -----------------------------------------------------------------------------------

// Voxels that are not zero, of values before they are rounded to halves: their count, and their
// box.
static void note_active(builder *b, const uint32_t low[3], const uint32_t high[3], uint64_t count) {
    for (int i = 0; i < 3; i++) {
        if (low[i] < b->low[i]) b->low[i] = low[i];
        if (high[i] > b->high[i]) b->high[i] = high[i];
    }
    b->active += count;
}

// The same, of a brick's own voxels inside the box: a row is eight bytes, which are 0 or 1.
static void note_voxels(builder *b, const uint32_t at[3], const uint8_t *active) {
    uint32_t own[3], low[3], high[3];
    for (int i = 0; i < 3; i++) {
        own[i] = b->s->size[i] - at[i] < SEQUENCE_BRICK ? b->s->size[i] - at[i] : SEQUENCE_BRICK;
        low[i] = UINT32_MAX;
        high[i] = 0;
    }
    uint64_t mask = UINT64_MAX >> 8 * (SEQUENCE_BRICK - own[0]), across = 0, count = 0;
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
    high[0] = at[0] + SEQUENCE_BRICK - (uint32_t)__builtin_clzll(across) / 8;
    note_active(b, low, high, count);
}

static void note_brick(builder *b, const uint32_t brick[3]) {
    uint32_t low[3], high[3];
    uint64_t count = 1;
    for (int i = 0; i < 3; i++) {
        low[i] = brick[i] * SEQUENCE_BRICK;
        high[i] = low[i] + SEQUENCE_BRICK;
        if (high[i] > b->s->size[i]) high[i] = b->s->size[i];
        count *= high[i] - low[i];
    }
    note_active(b, low, high, count);
}

// half_from_float of what is at most SEQUENCE_HALF_MAX, and 0 of -0: without branches, so that the
// compiler makes vectors of it.
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

// One component of a block, `step` floats apart, to halves `width` apart; notes which are not 0.
static void convert(const float *restrict values, int step, float gain, uint16_t *restrict out,
                    int width, uint8_t *restrict active) {
    uint16_t halves[VOXELS];
    for (int i = 0; i < VOXELS; i++) {
        float v = values[i * step] * gain;
        v = v < -SEQUENCE_HALF_MAX ? -SEQUENCE_HALF_MAX : v;
        v = v > SEQUENCE_HALF_MAX ? SEQUENCE_HALF_MAX : v;
        active[i] |= v != 0;
        halves[i] = half_of(v);
    }
    for (int i = 0; i < VOXELS; i++) out[i * width] = halves[i];
}

// With Y up, the rows of the block that was read lie otherwise along our Y and Z.
static void turn(float *block, int components) {
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
    const sequence_data *s = b->s;
    int32_t corner[3] = {(int32_t)at[0], (int32_t)at[1], (int32_t)at[2]};
    if (s->desc.y_up) {
        corner[1] = (int32_t)at[2];
        corner[2] = (int32_t)(s->file_size[2] - 1 - at[1]) - SEQUENCE_BRICK;
    }
    for (size_t i = 0; i < b->source_count; i++) {
        const source *from = &b->sources[i];
        b->out->bad += vdb_blocks_read(from->blocks, corner, block);
        if (s->desc.y_up) turn(block, from->components);
        for (int c = 0; c < from->components; c++)
            convert(block + c, from->components, from->gains[c], texels + from->channels[c],
                    b->width, active);
    }
    note_voxels(b, at, active);
}

// ---- bricks -----------------------------------------------------------------------------------

// There is room for one more than b->room, and one that is about to be given back.
static uint16_t *add_brick(builder *b) {
    sequence_bricks *bricks = &b->out->bricks[b->image];
    return b->out->images[b->image] + bricks->count++ * VOXELS * (size_t)b->width;
}

static bool is_constant(const uint16_t *texels, int width) {
    for (int i = width; i < VOXELS * width; i++)
        if (texels[i] != texels[i - width]) return false;
    return true;
}

// The number of the brick that holds nothing but this texel, from 1; 0: of zeros.
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
    uint32_t number = b->out->bricks[b->image].count;
    map_set(&b->constants, key, rest, number);
    return number;
}

static uint32_t make_brick(builder *b, const uint32_t brick[3]) {
    const uint32_t at[3] = {brick[0] * SEQUENCE_BRICK, brick[1] * SEQUENCE_BRICK,
                            brick[2] * SEQUENCE_BRICK};
    sequence_bricks *bricks = &b->out->bricks[b->image];
    uint16_t *texels = add_brick(b), first[4];
    read_brick(b, at, texels);
    if (!is_constant(texels, b->width)) return bricks->count;
    memcpy(first, texels, (size_t)b->width * sizeof *first);
    bricks->count--;
    return find_constant(b, first);
}

// Memory for all bricks that there may be, within the limit of a frame. What is not written to
// takes none.
static void make_room(builder *b) {
    const sequence_data *s = b->s;
    uint64_t brick = VOXELS * (uint64_t)b->width * sizeof(uint16_t), taken = 0, wanted = 1;
    for (int i = 0; i <= b->image; i++) taken += sequence_image_bytes(s, b->out, i);
    uint64_t most = s->desc.max_frame_bytes > taken ? s->desc.max_frame_bytes - taken : 0;
    for (uint64_t i = 0; i < sequence_brick_count(s); i++) wanted += b->wanted[i];
    b->room = MOST_ACROSS * MOST_ACROSS * MOST_ACROSS;
    if (b->room > wanted) b->room = (uint32_t)wanted;
    if (b->room > most / brick) b->room = (uint32_t)(most / brick);
    b->out->images[b->image] = mem_alloc((size_t)((b->room + 2) * brick));
}

static bool too_large(const builder *b, uint32_t frame) {
    return err_set("%s: what is not empty needs more than %llu MiB, the limit of a frame",
                   b->s->files[frame], (unsigned long long)(b->s->desc.max_frame_bytes >> 20));
}

static bool make_bricks(builder *b, uint32_t frame) {
    sequence_bricks *bricks = &b->out->bricks[b->image];
    uint16_t background[4] = {0};
    bool full = read_background(b, background);
    uint32_t outside = find_constant(b, background), *index = bricks->index, brick[3];
    for (brick[2] = 0; brick[2] < b->across[2]; brick[2]++)
        for (brick[1] = 0; brick[1] < b->across[1]; brick[1]++) {
            for (brick[0] = 0; brick[0] < b->across[0]; brick[0]++, index++) {
                bool wanted = b->wanted[index - bricks->index];
                *index = wanted ? make_brick(b, brick) : outside;
                if (full && !wanted) note_brick(b, brick);
                if (bricks->count > b->room) return too_large(b, frame);
            }
        }
    return true;
}

// From numbers to places: rows and layers of a square, so that the atlas grows by whole layers.
static void place(const builder *b, sequence_bricks *bricks) {
    uint32_t across = b->s->atlas_across;
    while ((uint64_t)across * across * MOST_ACROSS < bricks->count) across++;
    bricks->across = across;
    bricks->layers = (bricks->count + across * across - 1) / (across * across);
    if (bricks->layers == 0) bricks->layers = 1; // an image cannot be empty
    size_t count = (size_t)b->across[0] * b->across[1] * b->across[2];
    for (size_t i = 0; i < count; i++) {
        uint32_t n = bricks->index[i];
        if (n-- == 0) continue;
        uint32_t x = n % across, y = n / across % across, z = n / across / across;
        bricks->index[i] = STORED | x | y << 10 | z << 20;
    }
}

static bool build_image(builder *b, uint32_t frame) {
    size_t count = (size_t)sequence_brick_count(b->s);
    b->wanted = mem_alloc(count);
    b->out->bricks[b->image].index = mem_alloc(count * sizeof(uint32_t));
    bool ok = open_sources(b, frame);
    for (size_t i = 0; ok && i < b->source_count; i++)
        vdb_blocks_visit(b->sources[i].blocks, want, b);
    if (ok) make_room(b);
    ok = ok && make_bricks(b, frame);
    if (ok) place(b, &b->out->bricks[b->image]);
    for (size_t i = 0; i < b->source_count; i++) vdb_blocks_close(b->sources[i].blocks);
    mem_free(b->wanted);
    map_free(&b->constants);
    return ok;
}

static bool decode(const sequence_data *s, uint32_t frame, vdb_file *file, sequence_texels *out) {
    uint32_t low[3] = {UINT32_MAX, UINT32_MAX, UINT32_MAX}, high[3] = {0, 0, 0};
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++) {
        builder b = {.s = s,
                     .out = out,
                     .file = file,
                     .image = i,
                     .width = sequence_texel_width(s, i),
                     .low = {UINT32_MAX, UINT32_MAX, UINT32_MAX}};
        for (int k = 0; k < 3; k++)
            b.across[k] = (s->size[k] + SEQUENCE_BRICK - 1) / SEQUENCE_BRICK;
        if (!build_image(&b, frame)) return false;
        for (int k = 0; k < 3; k++) {
            if (b.low[k] < low[k]) low[k] = b.low[k];
            if (b.high[k] > high[k]) high[k] = b.high[k];
        }
        if (b.active > out->voxels) out->voxels = b.active;
    }
    out->active = sequence_active_box(s, low, high);
    return true;
}

bool sequence_decode_sparse(const sequence_data *s, uint32_t frame, sequence_texels *out) {
    vdb_file *file = vdb_file_open(s->desc.root, s->files[frame]);
    bool ok = file && decode(s, frame, file, out);
    vdb_file_close(file);
    return ok;
}

// ---- atlas ------------------------------------------------------------------------------------

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
