// One frame as texels. Those of OpenVDB files are made by the reader (media/vdb.h), which is told
// which grid goes where. Runs on any thread: it reads only what does not change after the channels
// were chosen.
#include "base/error.h"
#include "base/memory.h"
#include "field/sequence_parts.h"
#include <assert.h>
#include <string.h>

static_assert((int)FIELD_GRID_IMAGES == (int)TEXELS_IMAGES, "a frame has the images of a grid");

static texels_shape sequence_shape(const sequence_data *s) {
    texels_shape shape = {.y_up = s->desc.y_up, .width = s->width};
    memcpy(shape.size, s->file_size, sizeof shape.size);
    return shape;
}

int sequence_image_channels(const sequence_data *s, int image) {
    const texels_shape shape = sequence_shape(s);
    return texels_channels(&shape, image);
}

int sequence_texel_width(const sequence_data *s, int image) {
    const texels_shape shape = sequence_shape(s);
    return texels_width(&shape, image);
}

uint64_t sequence_brick_count(const sequence_data *s) {
    const texels_shape shape = sequence_shape(s);
    return vdb_brick_count(&shape);
}

// Returns the world box of the voxels that are not zero (`from` inclusive, `to` exclusive, in the
// grid's axes), as far as linear filtering spreads them.
static box3 sequence_active_box(const sequence_data *grid, const uint32_t from[3],
                                const uint32_t to[3]) {
    if (from[0] >= to[0]) return box3_empty();
    const float min[3] = {grid->box.min.x, grid->box.min.y, grid->box.min.z};
    const float max[3] = {grid->box.max.x, grid->box.max.y, grid->box.max.z};
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
        float voxel = (max[i] - min[i]) / (float)grid->size[i];
        low[i] = min[i] + voxel * ((float)from[i] - 0.5f);
        high[i] = min[i] + voxel * ((float)to[i] + 0.5f);
    }
    return box3_intersect(grid->box, (box3){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}});
}

// ---- OpenVDB ----------------------------------------------------------------------------------

typedef struct sources {
    vdb_source list[VDB_SOURCES];
    size_t count;
} sources;

static void add_source(sources *out, const vdb_grid_info *grid, vdb_source made) {
    if (grid->index_min[0] > grid->index_max[0]) return; // zeros
    made.grid = grid->name;
    made.components = grid->components;
    out->list[out->count++] = made;
}

// With Y up, our Y is the file's -Z and our Z its Y.
static void add_channel(const sequence_data *s, uint32_t frame,
                        const sequence_channel_info *channel, sources *out) {
    const vdb_info *info = &s->infos[frame];
    bool turned = s->desc.y_up;
    int first = channel->first;
    float gain = channel->gain;
    const vdb_grid_info *grid = sequence_find_grid(info, channel->name, 0);
    if (grid && grid->components == 3 && channel->components == 3) {
        add_source(
            out, grid,
            (vdb_source){.channels = {first, first + (turned ? 2 : 1), first + (turned ? 1 : 2)},
                         .gains = {gain, gain, turned ? -gain : gain}});
        return;
    }
    for (int part = 0; part < channel->components; part++) {
        grid = sequence_find_grid(info, channel->name, part);
        if (!grid || grid->components != 1) continue; // zeros
        int to = turned && part > 0 ? 3 - part : part;
        bool flipped = turned && part == 2;
        add_source(out, grid,
                   (vdb_source){.channels = {first + to}, .gains = {flipped ? -gain : gain}});
    }
}

static bool decode_vdb(const sequence_data *s, uint32_t frame, sequence_texels *out) {
    sources from = {.count = 0};
    for (size_t i = 0; i < s->channel_count; i++) add_channel(s, frame, &s->channels[i], &from);
    const vdb_frame_desc desc = {.path = s->files[frame],
                                 .root = s->desc.root,
                                 .box = s->file_box,
                                 .shape = sequence_shape(s),
                                 .sparse = s->sparse,
                                 .max_bytes = s->desc.max_frame_bytes,
                                 .sources = from.list,
                                 .count = from.count,
                                 .level_set = s->desc.level_set};
    if (!vdb_read_frame(&desc, &out->read)) return false;
    const vdb_frame *read = &out->read;
    for (int i = 0; i < FIELD_GRID_IMAGES; i++) {
        out->images[i] = read->images[i].texels;
        out->bricks[i] = (sequence_bricks){read->images[i].index, read->images[i].bricks, 0, 0};
        if (s->sparse && out->images[i]) sequence_atlas_place(s, &out->bricks[i]);
    }
    out->voxels = read->active.voxels;
    out->bad = read->bad;
    out->active = sequence_active_box(s, read->active.low, read->active.high);
    return true;
}

// ---- raw files --------------------------------------------------------------------------------

static bool decode_raw(const sequence_data *s, uint32_t frame, sequence_texels *out) {
    const texels_shape shape = sequence_shape(s);
    texels_active active = texels_nothing();
    size_t voxels = (size_t)s->file_size[0] * s->file_size[1] * s->file_size[2];
    float *values = mem_alloc(voxels * sizeof *values);
    out->own = mem_alloc((size_t)texels_image_bytes(&shape, 0));
    out->images[0] = out->own;
    bool ok = sequence_raw_read(s, frame, values, &out->bad);
    if (ok) texels_pack(&shape, values, 1, 1, out->own, 0, &active);
    mem_free(values);
    out->voxels = active.voxels;
    out->active = sequence_active_box(s, active.low, active.high);
    return ok;
}

// ---- both -------------------------------------------------------------------------------------

static uint64_t texel_bytes(const sequence_data *s) { // of a voxel, in all images
    const texels_shape shape = sequence_shape(s);
    return texels_bytes(&shape);
}

uint64_t sequence_frame_bytes(const sequence_data *s, uint32_t frame) {
    uint64_t voxels = (uint64_t)s->size[0] * s->size[1] * s->size[2];
    if (s->sparse) voxels = (uint64_t)((double)s->most_active / (double)sequence_growth(s, frame));
    return voxels * texel_bytes(s);
}

uint64_t sequence_decode_bytes(const sequence_data *s, uint32_t frame) {
    uint64_t voxels = (uint64_t)s->file_size[0] * s->file_size[1] * s->file_size[2];
    if (!s->sparse) { // by way of numbers, and of the bytes of the file
        uint64_t widest = 1;
        for (size_t i = 0; i < s->channel_count; i++)
            if (s->channels[i].components > (int)widest)
                widest = (uint64_t)s->channels[i].components;
        return voxels * (widest * sizeof(float) + texel_bytes(s)) + s->layout.frame_bytes;
    }
    const uint64_t border = 2; // a brick has at most so much more than its voxels
    uint64_t active = (uint64_t)((double)s->most_active / (double)sequence_growth(s, frame));
    uint64_t bytes = border * active * texel_bytes(s);
    if (bytes > s->desc.max_frame_bytes) bytes = s->desc.max_frame_bytes;
    return bytes + sequence_brick_count(s) * (1 + sizeof(uint32_t));
}

static void note_kept(const sequence_data *s, const sequence_texels *texels) {
    const uint64_t brick = (VDB_BRICK + 1) * (VDB_BRICK + 1) * (VDB_BRICK + 1);
    uint64_t bytes = 0, voxels = (uint64_t)s->size[0] * s->size[1] * s->size[2];
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++) {
        uint64_t count = s->sparse ? texels->bricks[i].count * brick : voxels;
        bytes += count * (uint64_t)sequence_texel_width(s, i) * sizeof(uint16_t);
        if (s->sparse) bytes += sequence_brick_count(s) * sizeof(uint32_t);
    }
    budget_note(texels->part, bytes);
}

bool sequence_decode(const sequence_data *s, uint32_t frame, sequence_texels *out) {
    memset(out, 0, sizeof *out);
    out->part = budget_take(budget_host(), sequence_decode_bytes(s, frame), s->label);
    if (!out->part) return err_prefix("%s: ", s->name);
    bool ok = s->raw ? decode_raw(s, frame, out) : decode_vdb(s, frame, out);
    if (ok) note_kept(s, out);
    if (!ok) sequence_texels_free(out);
    return ok;
}

void sequence_texels_drop(sequence_texels *texels) {
    budget_give(texels->part);
    texels->part = NULL;
    mem_free(texels->own);
    texels->own = NULL;
    vdb_frame_free(&texels->read);
    for (int i = 0; i < FIELD_GRID_IMAGES; i++) {
        texels->images[i] = NULL;
        texels->bricks[i].index = NULL;
    }
}

void sequence_texels_free(sequence_texels *texels) {
    sequence_texels_drop(texels);
    memset(texels->bricks, 0, sizeof texels->bricks);
}
