// From one load of an effect to the next: what shows the same files in the same way changes hands,
// with its textures and the thread that decodes ahead.
#include "base/memory.h"
#include "base/swap.h"
#include "field/sequence_parts.h"
#include <string.h>

void sequence_data_free(sequence_data *d, gpu *g) {
    sequence_cache_free(d, g);
    for (size_t i = 0; i < d->held_count; i++) content_cache_release(d->desc.contents, d->held[i]);
    arena_free(&d->memory);
    mem_free(d);
}

static bool same_files(const sequence_data *a, const sequence_data *b) {
    if (a->file_count != b->file_count || a->layout.changed != b->layout.changed) return false;
    if (a->held_count != b->held_count) return false;
    for (size_t i = 0; i < a->file_count; i++)
        if (strcmp(a->files[i], b->files[i]) != 0) return false;
    for (size_t i = 0; i < a->held_count; i++)
        if (a->held[i] != b->held[i]) return false; // read at other times
    return a->raw || a->held_count == a->file_count;
}

static bool same_channels(const sequence_data *a, const sequence_data *b) {
    if (a->channel_count != b->channel_count) return false;
    for (size_t i = 0; i < a->channel_count; i++)
        if (strcmp(a->channels[i].name, b->channels[i].name) != 0) return false;
    return true;
}

static bool same_raw(const sequence_desc *a, const sequence_desc *b) {
    return strcmp(a->raw.axes, b->raw.axes) == 0 && a->raw.padding == b->raw.padding &&
           memcmp(&a->raw.box, &b->raw.box, sizeof a->raw.box) == 0 &&
           strcmp(a->raw.type, b->raw.type) == 0 && strcmp(a->raw.channel, b->raw.channel) == 0 &&
           memcmp(a->raw.size, b->raw.size, sizeof a->raw.size) == 0 &&
           a->raw.frames == b->raw.frames && a->raw.offset == b->raw.offset &&
           a->raw.stride == b->raw.stride && a->raw.voxel_size == b->raw.voxel_size &&
           a->raw.value_scale == b->raw.value_scale;
}

// Of what lies in textures; the timeline may differ.
static bool same_content(const sequence_data *a, const sequence_data *b) {
    const sequence_desc *x = &a->desc, *y = &b->desc;
    return a->raw == b->raw && a->sparse == b->sparse && x->y_up == y->y_up &&
           x->level_set == y->level_set && x->scale == y->scale && x->offset.x == y->offset.x &&
           x->offset.y == y->offset.y && x->offset.z == y->offset.z && same_files(a, b) &&
           same_channels(a, b) && (!a->raw || same_raw(x, y));
}

static void swap_timeline(sequence_desc *a, sequence_desc *b) {
    sequence_desc old = *a;
    a->fps = b->fps;
    a->start = b->start;
    a->speed = b->speed;
    a->loop = b->loop;
    a->blend = b->blend;
    b->fps = old.fps;
    b->start = old.start;
    b->speed = old.speed;
    b->loop = old.loop;
    b->blend = old.blend;
}

bool sequence_exchange(field_grid *grid, field_grid *other) {
    sequence *a = (sequence *)grid, *b = (sequence *)other;
    if (!same_content(a->data, b->data)) return false;
    SWAP(a->data, b->data);
    swap_timeline(&a->data->desc, &b->data->desc); // stays with its effect
    SWAP(grid->state, other->state);
    return true;
}
