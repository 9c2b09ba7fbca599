#include "media/texels.h"
#include "base/maths.h"
#include <string.h>

void texels_size(const texels_shape *s, uint32_t out[3]) {
    memcpy(out, s->size, sizeof s->size);
    if (!s->y_up) return;
    out[1] = s->size[2];
    out[2] = s->size[1];
}

int texels_channels(const texels_shape *s, int image) {
    int count = s->width - 4 * image;
    return count < 0 ? 0 : count > 4 ? 4 : count;
}

int texels_width(const texels_shape *s, int image) {
    int count = texels_channels(s, image);
    return count == 3 ? 4 : count;
}

uint64_t texels_bytes(const texels_shape *s) {
    uint64_t bytes = 0;
    for (int i = 0; i < TEXELS_IMAGES; i++)
        bytes += (uint64_t)texels_width(s, i) * sizeof(uint16_t);
    return bytes;
}

uint64_t texels_image_bytes(const texels_shape *s, int image) {
    uint64_t voxels = (uint64_t)s->size[0] * s->size[1] * s->size[2];
    return voxels * (uint64_t)texels_width(s, image) * sizeof(uint16_t);
}

texels_active texels_nothing(void) {
    return (texels_active){.low = {UINT32_MAX, UINT32_MAX, UINT32_MAX}};
}

static void active_grow(texels_active *a, const uint32_t at[3]) {
    for (int i = 0; i < 3; i++) {
        if (at[i] < a->low[i]) a->low[i] = at[i];
        if (at[i] + 1 > a->high[i]) a->high[i] = at[i] + 1;
    }
}

void texels_pack(const texels_shape *s, const float *values, int stride, float gain,
                 uint16_t *texels, int channel, texels_active *active) {
    int width = texels_width(s, channel / 4);
    uint32_t size[3], at[3];
    uint64_t count = 0;
    texels_size(s, size);
    for (at[2] = 0; at[2] < size[2]; at[2]++)
        for (at[1] = 0; at[1] < size[1]; at[1]++) {
            size_t y = s->y_up ? at[2] : at[1];
            size_t z = s->y_up ? size[1] - 1 - at[1] : at[2];
            const float *row = values + (z * s->size[1] + y) * s->size[0] * (size_t)stride;
            size_t texel = ((size_t)at[2] * size[1] + at[1]) * size[0];
            for (at[0] = 0; at[0] < size[0]; at[0]++) {
                float v =
                    clampf(row[at[0] * (size_t)stride] * gain, -TEXELS_HALF_MAX, TEXELS_HALF_MAX);
                if (v == 0) continue;
                texels[(texel + at[0]) * (size_t)width + (size_t)(channel % 4)] =
                    half_from_float(v);
                active_grow(active, at);
                count++;
            }
        }
    if (count > active->voxels) active->voxels = count;
}
