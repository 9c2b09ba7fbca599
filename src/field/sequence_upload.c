// From texels of a frame to its textures: how large they are, where their bytes lie in the memory
// that is copied from.
#include "base/error.h"
#include "field/sequence_parts.h"
#include <string.h>

enum { SIDE = VDB_BRICK + 1 };

static const gpu_format formats[] = {GPU_FORMAT_NONE, GPU_R16F, GPU_RG16F, GPU_RGBA16F,
                                     GPU_RGBA16F};

static uint64_t texel_bytes(const sequence_data *s, int image) {
    return (uint64_t)sequence_texel_width(s, image) * sizeof(uint16_t);
}

static uint64_t index_bytes(const sequence_data *s) {
    return s->sparse ? sequence_brick_count(s) * sizeof(uint32_t) : 0;
}

static uint64_t values_bytes(const sequence_data *s, const sequence_texels *texels, int image) {
    const sequence_bricks *bricks = &texels->bricks[image];
    uint64_t count = (uint64_t)bricks->across * bricks->across * bricks->layers;
    if (!s->sparse) return (uint64_t)s->size[0] * s->size[1] * s->size[2] * texel_bytes(s, image);
    if (count < bricks->count) count = bricks->count; // not placed yet
    return count * SIDE * SIDE * SIDE * texel_bytes(s, image);
}

// ---- textures ---------------------------------------------------------------------------------

static bool fits(const gpu_image *image, uint32_t width, uint32_t least, uint32_t most) {
    if (!image) return false;
    const gpu_image_desc *d = gpu_image_get_desc(image);
    return d->width == width && d->depth >= least && d->depth <= most;
}

static gpu_image *create(const sequence_data *s, gpu *g, gpu_format format, uint32_t width,
                         uint32_t height, uint32_t depth) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = s->name,
                                                             .format = format,
                                                             .width = width,
                                                             .height = height,
                                                             .depth = depth,
                                                             .use = GPU_USE_SAMPLED});
    if (!image) err_prefix("%s: ", s->name);
    return image;
}

// An atlas for one frame has just its size. One that others will follow in is as large as the
// largest so far, and an eighth: making textures anew for every frame would cost more than the
// copy.
static bool fit_sparse(const sequence_data *s, gpu *g, const sequence_bricks *bricks, int image,
                       uint32_t largest, sequence_slot *slot) {
    if (!slot->index[image]) {
        uint32_t size[3];
        for (int i = 0; i < 3; i++) size[i] = (s->size[i] + VDB_BRICK - 1) / VDB_BRICK;
        slot->index[image] = create(s, g, GPU_R32U, size[0], size[1], size[2]);
        if (!slot->index[image]) return false;
    }
    uint32_t width = bricks->across * SIDE, least = bricks->layers * SIDE;
    uint32_t wanted = largest > bricks->layers ? largest * SIDE : least;
    if (fits(slot->images[image], width, least, wanted + wanted / 2)) return true;
    gpu_image_destroy(g, slot->images[image]);
    if (largest > 0) wanted += wanted / SIDE / 8 * SIDE;
    slot->images[image] =
        create(s, g, formats[sequence_image_channels(s, image)], width, width, wanted);
    return slot->images[image] != NULL;
}

bool sequence_slot_fit(const sequence_data *s, gpu *g, const sequence_texels *texels, bool others,
                       sequence_slot *slot) {
    slot->bytes = 0;
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++) {
        gpu_format format = formats[sequence_image_channels(s, i)];
        uint32_t largest = others ? s->cache.layers[i] : 0;
        if (s->sparse && !fit_sparse(s, g, &texels->bricks[i], i, largest, slot)) return false;
        if (!slot->images[i])
            slot->images[i] = create(s, g, format, s->size[0], s->size[1], s->size[2]);
        if (!slot->images[i]) return false;
        const gpu_image_desc *d = gpu_image_get_desc(slot->images[i]);
        slot->bytes += (uint64_t)d->width * d->height * d->depth * gpu_format_size(d->format);
        slot->bytes += index_bytes(s);
    }
    return true;
}

void sequence_slot_free(sequence_slot *slot, gpu *g) {
    for (int i = 0; i < FIELD_GRID_IMAGES; i++) {
        gpu_image_destroy(g, slot->images[i]);
        gpu_image_destroy(g, slot->index[i]);
    }
    memset(slot, 0, sizeof *slot);
}

// ---- memory to copy from ----------------------------------------------------------------------

static uint64_t aligned(uint64_t size) {
    return (size + GPU_TRANSFER_ALIGN - 1) / GPU_TRANSFER_ALIGN * GPU_TRANSFER_ALIGN;
}

uint64_t sequence_upload_bytes(const sequence_data *s, const sequence_texels *texels) {
    uint64_t size = 0;
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++)
        size += aligned(values_bytes(s, texels, i)) + aligned(index_bytes(s));
    return size;
}

size_t sequence_upload_parts(const sequence_data *s, const sequence_texels *texels,
                             const sequence_slot *slot,
                             gpu_transfer_part parts[2 * FIELD_GRID_IMAGES]) {
    uint64_t at = 0;
    size_t count = 0;
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++) {
        uint32_t slices = s->sparse ? texels->bricks[i].layers * SIDE : s->size[2];
        parts[count++] = (gpu_transfer_part){slot->images[i], at, slices};
        at += aligned(values_bytes(s, texels, i));
        if (!s->sparse) continue;
        slices = gpu_image_get_desc(slot->index[i])->depth;
        parts[count++] = (gpu_transfer_part){slot->index[i], at, slices};
        at += aligned(index_bytes(s));
    }
    return count;
}

void sequence_upload_write(const sequence_data *s, const sequence_texels *texels, void *out) {
    char *to = out;
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++) {
        uint64_t size = values_bytes(s, texels, i);
        if (s->sparse)
            sequence_atlas_write(s, texels, i, to);
        else
            memcpy(to, texels->images[i], (size_t)size);
        to += aligned(size);
        if (s->sparse) memcpy(to, texels->bricks[i].index, (size_t)index_bytes(s));
        to += aligned(index_bytes(s));
    }
}
