// Pictures made small, for people to choose from.
#include "base/error.h"
#include "media/png.h"
#include "roil/roil_impl.h"
#include <math.h>

enum { MOST = 16384 };

// The mean of a rectangle of the file's pixels, as its codes are.
static void take_mean(const png_image *image, const uint32_t from[2], const uint32_t to[2],
                      uint8_t out[4]) {
    uint64_t sums[4] = {0}, count = 0;
    const uint8_t *bytes = image->pixels;
    const uint16_t *words = image->pixels;
    for (uint32_t y = from[1]; y < to[1]; y++)
        for (uint32_t x = from[0]; x < to[0]; x++, count++)
            for (int c = 0; c < 4; c++) {
                size_t at = ((size_t)y * image->width + x) * 4 + (size_t)c;
                sums[c] += image->bits == 16 ? words[at] >> 8 : bytes[at];
            }
    for (int c = 0; c < 4; c++) out[c] = (uint8_t)((sums[c] + count / 2) / count);
}

bool roil_read_thumbnail(const char *png, uint32_t width, uint32_t height, uint8_t *rgba) {
    mem_enter();
    arena memory = {0};
    png_image image;
    if (width < 1 || height < 1 || width > MOST || height > MOST)
        return mem_leave(err_set("size %u x %u; accepted: 1 to %d each", width, height, MOST));
    bool done = png_read(png, NULL, &memory, &image);
    if (done) {
        double scale = fmin((double)image.width / width, (double)image.height / height);
        double left = (image.width - scale * width) / 2, top = (image.height - scale * height) / 2;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) {
                uint32_t from[2] = {(uint32_t)(left + x * scale), (uint32_t)(top + y * scale)};
                uint32_t to[2] = {(uint32_t)(left + (x + 1) * scale),
                                  (uint32_t)(top + (y + 1) * scale)};
                for (int i = 0; i < 2; i++) {
                    uint32_t most = i ? image.height : image.width;
                    from[i] = from[i] < most ? from[i] : most - 1;
                    to[i] = to[i] > from[i] ? to[i] < most ? to[i] : most : from[i] + 1;
                }
                take_mean(&image, from, to, rgba + ((size_t)y * width + x) * 4);
            }
    }
    arena_free(&memory);
    return mem_leave(done);
}
