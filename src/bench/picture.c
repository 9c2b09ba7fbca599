// Pictures of rows: thumbnails, and their difference from other pictures.
#include "base/error.h"
#include "base/memory.h"
#include "bench/run_parts.h"
#include "media/compare.h"
#include "media/png.h"
#include <math.h>

enum { SMALL_WIDTH = 320 };
static const double PIXELS_PER_DEGREE = 67; // as roil_compare has it

bool bench_picture_read(roil_effect *e, uint32_t width, uint32_t height, bench_picture *out) {
    *out = (bench_picture){width, height, mem_alloc((size_t)width * height * 4)};
    if (roil_read(e, false, out->pixels)) return true;
    mem_free(out->pixels);
    *out = (bench_picture){0};
    return false;
}

bool bench_picture_save(const bench_picture *p, const char *folder, const char *file) {
    png_image image = {p->width, p->height, 4, 8, p->pixels};
    return png_write_inside(folder, file, &image);
}

bool bench_picture_load(const char *folder, const char *file, bench_picture *out) {
    arena memory = {0};
    png_image image;
    bool done = png_read_inside(folder, file, NULL, &memory, &image);
    if (done && image.bits != 8) done = err_set("%s: 8 bits a channel are expected", file);
    if (done)
        *out = (bench_picture){image.width, image.height,
                               mem_copy(image.pixels, (size_t)image.width * image.height * 4)};
    arena_free(&memory);
    return done;
}

// Averages the pixels that a small one covers. It averages sRGB values, since thumbnails are looked
// at and not measured.
static void picture_shrink(const bench_picture *p, uint32_t width, uint32_t height, uint8_t *out) {
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint32_t sum[3] = {0}, count = 0;
            uint32_t top = (uint32_t)((uint64_t)y * p->height / height);
            uint32_t left = (uint32_t)((uint64_t)x * p->width / width);
            uint32_t bottom = (uint32_t)((uint64_t)(y + 1) * p->height / height);
            uint32_t right = (uint32_t)((uint64_t)(x + 1) * p->width / width);
            for (uint32_t v = top; v < bottom; v++)
                for (uint32_t u = left; u < right; u++, count++)
                    for (size_t c = 0; c < 3; c++)
                        sum[c] += p->pixels[((size_t)v * p->width + u) * 4 + c];
            for (size_t c = 0; c < 3; c++)
                out[((size_t)y * width + x) * 3 + c] = (uint8_t)((sum[c] + count / 2) / count);
        }
}

bool bench_picture_save_small(const bench_picture *p, const char *folder, const char *file) {
    uint32_t width = p->width < SMALL_WIDTH ? p->width : SMALL_WIDTH;
    uint32_t height = (uint32_t)fmax(1, round((double)p->height * width / p->width));
    if (height > p->height) height = p->height;
    uint8_t *pixels = mem_alloc((size_t)width * height * 3);
    picture_shrink(p, width, height, pixels);
    png_image image = {width, height, 3, 8, pixels};
    bool done = png_write_inside(folder, file, &image);
    mem_free(pixels);
    return done;
}

static float *to_floats(const bench_picture *p) {
    size_t count = (size_t)p->width * p->height;
    float *rgb = mem_alloc(count * 3 * sizeof *rgb);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) rgb[i * 3 + c] = (float)p->pixels[i * 4 + c] / 255;
    return rgb;
}

bool bench_picture_compare(const bench_picture *a, const bench_picture *b, bench_row *row) {
    if (a->width != b->width || a->height != b->height)
        return err_set("the reference is %ux%u, the picture %ux%u", b->width, b->height, a->width,
                       a->height);
    float *x = to_floats(a), *y = to_floats(b);
    float *map = mem_alloc((size_t)a->width * a->height * sizeof *map);
    compare_picture one = {a->width, a->height, x}, other = {b->width, b->height, y};
    double psnr = compare_psnr(&one, &other), ssim = compare_ssim(&one, &other);
    double flip = compare_flip(&one, &other, PIXELS_PER_DEGREE, map);
    row->psnr = row->compared ? fmin(row->psnr, psnr) : psnr;
    row->ssim = row->compared ? fmin(row->ssim, ssim) : ssim;
    row->flip = row->compared ? fmax(row->flip, flip) : flip;
    row->compared = true;
    mem_free(x);
    mem_free(y);
    mem_free(map);
    return true;
}
