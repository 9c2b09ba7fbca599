// One frame as texels. Grids are sampled into a dense box in the file's own axes, then packed: four
// channels to a texture, halves, axes turned when the file has Y up. Runs on any thread: it reads
// only what does not change after the channels were chosen.
#include "base/error.h"
#include "base/memory.h"
#include "field/sequence_parts.h"
#include <math.h>
#include <string.h>

typedef struct packing {
    const sequence_data *s;
    sequence_texels *out;
    uint32_t low[3], high[3]; // texels that are not zero, in the grid's axes; high exclusive
    uint64_t active;          // of the channel at hand
} packing;

int sequence_image_channels(const sequence_data *s, int image) {
    int count = s->width - 4 * image;
    return count < 0 ? 0 : count > 4 ? 4 : count;
}

int sequence_texel_width(const sequence_data *s, int image) {
    int count = sequence_image_channels(s, image);
    return count == 3 ? 4 : count;
}

static void grow(packing *p, const uint32_t at[3]) {
    for (int i = 0; i < 3; i++) {
        if (at[i] < p->low[i]) p->low[i] = at[i];
        if (at[i] + 1 > p->high[i]) p->high[i] = at[i] + 1;
    }
}

// Writes one component of `values` (x fastest, `stride` floats apart) to a channel of the grid.
static void pack(packing *p, const float *values, int stride, int channel, float gain) {
    const sequence_data *s = p->s;
    int image = channel / 4, width = sequence_texel_width(s, image);
    uint16_t *texels = p->out->images[image];
    const uint32_t *size = s->size;
    uint32_t at[3];
    p->active = 0;
    for (at[2] = 0; at[2] < size[2]; at[2]++)
        for (at[1] = 0; at[1] < size[1]; at[1]++) {
            // With Y up, our Y is the file's -Z and our Z its Y.
            size_t y = s->desc.y_up ? at[2] : at[1];
            size_t z = s->desc.y_up ? size[1] - 1 - at[1] : at[2];
            const float *row =
                values + (z * s->file_size[1] + y) * s->file_size[0] * (size_t)stride;
            size_t texel = ((size_t)at[2] * size[1] + at[1]) * size[0];
            for (at[0] = 0; at[0] < size[0]; at[0]++) {
                float v = clampf(row[at[0] * (size_t)stride] * gain, -SEQUENCE_HALF_MAX,
                                 SEQUENCE_HALF_MAX);
                if (v == 0) continue;
                texels[(texel + at[0]) * (size_t)width + (size_t)(channel % 4)] =
                    half_from_float(v);
                grow(p, at);
                p->active++;
            }
        }
    if (p->active > p->out->voxels) p->out->voxels = p->active;
}

static void pack_vector(packing *p, const float *values, int channel, float gain) {
    bool turned = p->s->desc.y_up;
    pack(p, values, 3, channel, gain);
    pack(p, values + (turned ? 2 : 1), 3, channel + 1, turned ? -gain : gain);
    pack(p, values + (turned ? 1 : 2), 3, channel + 2, gain);
}

static bool sample(const sequence_data *s, uint32_t frame, const vdb_grid_info *grid, float *values,
                   uint64_t *bad) {
    uint64_t some = 0;
    vdb_sample_desc desc = {
        .path = s->files[frame],
        .grid = grid->name,
        .box = s->file_box,
        .size = {s->file_size[0], s->file_size[1], s->file_size[2]},
        .components = grid->components,
        .out = values,
        .root = s->desc.root,
    };
    if (!vdb_sample(&desc, &some)) return false;
    *bad += some;
    return true;
}

static bool is_empty(const vdb_grid_info *grid) {
    return grid->index_min[0] > grid->index_max[0];
}

static bool decode_channel(packing *p, uint32_t frame, const sequence_channel_info *channel,
                           float *values) {
    const sequence_data *s = p->s;
    const vdb_info *info = &s->infos[frame];
    const vdb_grid_info *grid = sequence_find_grid(info, channel->name, 0);
    float gain = channel->gain;
    if (grid && grid->components == 3 && channel->components == 3) {
        if (is_empty(grid)) return true;
        if (!sample(s, frame, grid, values, &p->out->bad)) return false;
        pack_vector(p, values, channel->first, gain);
        return true;
    }
    for (int part = 0; part < channel->components; part++) {
        grid = sequence_find_grid(info, channel->name, part);
        if (!grid || is_empty(grid) || grid->components != 1) continue; // zeros
        if (!sample(s, frame, grid, values, &p->out->bad)) return false;
        int to = part;
        if (s->desc.y_up && part > 0) to = 3 - part;
        bool flipped = s->desc.y_up && part == 2;
        pack(p, values, 1, channel->first + to, flipped ? -gain : gain);
    }
    return true;
}

box3 sequence_active_box(const sequence_data *grid, const uint32_t from[3], const uint32_t to[3]) {
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

static bool decode_dense(const sequence_data *s, uint32_t frame, sequence_texels *out) {
    packing p = {s, out, {UINT32_MAX, UINT32_MAX, UINT32_MAX}, {0, 0, 0}, 0};
    size_t voxels = (size_t)s->file_size[0] * s->file_size[1] * s->file_size[2];
    int widest = 1;
    for (size_t i = 0; i < s->channel_count; i++)
        if (s->channels[i].components > widest) widest = s->channels[i].components;
    float *values = mem_alloc(voxels * (size_t)widest * sizeof *values);
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++)
        out->images[i] = mem_alloc(voxels * (size_t)sequence_texel_width(s, i) * sizeof(uint16_t));
    bool ok = true;
    if (s->raw) {
        ok = sequence_raw_read(s, frame, values, &out->bad);
        if (ok) pack(&p, values, 1, 0, 1);
    } else {
        for (size_t i = 0; ok && i < s->channel_count; i++)
            ok = decode_channel(&p, frame, &s->channels[i], values);
    }
    mem_free(values);
    out->active = sequence_active_box(s, p.low, p.high);
    return ok;
}

static uint64_t texel_bytes(const sequence_data *s) { // of a voxel, in all images
    uint64_t bytes = 0;
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++)
        bytes += (uint64_t)sequence_texel_width(s, i) * sizeof(uint16_t);
    return bytes;
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
    const uint64_t brick = (SEQUENCE_BRICK + 1) * (SEQUENCE_BRICK + 1) * (SEQUENCE_BRICK + 1);
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
    bool ok = s->sparse ? sequence_decode_sparse(s, frame, out) : decode_dense(s, frame, out);
    if (ok) note_kept(s, out);
    if (!ok) sequence_texels_free(out);
    return ok;
}

void sequence_texels_drop(sequence_texels *texels) {
    budget_give(texels->part);
    texels->part = NULL;
    for (int i = 0; i < FIELD_GRID_IMAGES; i++) {
        mem_free(texels->images[i]);
        mem_free(texels->bricks[i].index);
        texels->images[i] = NULL;
        texels->bricks[i].index = NULL;
    }
}

void sequence_texels_free(sequence_texels *texels) {
    sequence_texels_drop(texels);
    memset(texels->bricks, 0, sizeof texels->bricks);
}
