#include "pass/slices/slices_paint.h"
#include "base/maths.h"
#include "base/memory.h"
#include "media/picture.h"

// Texels that become one, so that four samples of a cell miss none.
static uint32_t count_merged(uint32_t pixels, uint32_t cells) {
    uint32_t merged = pixels / (2 * cells);
    return merged < 1 ? 1 : merged;
}

static void merge(const picture *p, uint32_t x, uint32_t y, const uint32_t merged[2],
                  uint16_t out[4]) {
    double sum[4] = {0};
    for (uint32_t dy = 0; dy < merged[1]; dy++)
        for (uint32_t dx = 0; dx < merged[0]; dx++) {
            size_t at = (size_t)(y * merged[1] + dy) * p->width + (x * merged[0] + dx);
            for (int c = 0; c < 4; c++) sum[c] += (double)p->rgba[4 * at + (size_t)c];
        }
    for (int c = 0; c < 4; c++)
        out[c] = half_from_float((float)(sum[c] / ((double)merged[0] * merged[1])));
}

gpu_image *slices_paint(gpu *g, const picture *painted, const uint32_t cells[2]) {
    const uint32_t merged[2] = {count_merged(painted->width, cells[0]),
                                count_merged(painted->height, cells[1])};
    const uint32_t width = painted->width / merged[0], height = painted->height / merged[1];
    size_t size = (size_t)width * height * 4 * sizeof(uint16_t);
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = "painted obstacle",
                                                             .format = GPU_RGBA16F,
                                                             .width = width,
                                                             .height = height,
                                                             .use = GPU_USE_SAMPLED});
    if (!image) return NULL;
    uint16_t *texels = mem_alloc(size);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            merge(painted, x, y, merged, texels + 4 * ((size_t)y * width + x));
    bool done = gpu_image_write(g, image, 0, texels, size);
    mem_free(texels);
    if (done) return image;
    gpu_image_destroy(g, image);
    return NULL;
}
