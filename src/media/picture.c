#include "media/picture.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "media/exr.h"
#include "media/png.h"
#include <math.h>
#include <string.h>

// Missing colour channels are taken from a grey channel, or are 0 if there is another colour.
static bool find_planes(const char *path, const exr_image *image, const float *planes[4]) {
    static const char *const names[4] = {"R", "G", "B", "A"};
    const float *grey = exr_find(image, "Y");
    for (int c = 0; c < 4; c++) planes[c] = exr_find(image, names[c]);
    if (!planes[0] && !planes[1] && !planes[2]) {
        if (!grey)
            return err_set("%s: the picture has no channel R, G, B or Y; one at least is needed",
                           path);
        planes[0] = planes[1] = planes[2] = grey;
    }
    return true;
}

static bool read_exr(const char *root, const char *path, const picture_limits *limits,
                     arena *memory, picture *out) {
    const exr_wish wish = {"RGBAY", *limits};
    exr_image image;
    const float *planes[4];
    arena scratch = {0};
    bool done =
        exr_read_inside(root, path, &wish, &scratch, &image) && find_planes(path, &image, planes);
    if (done) {
        size_t count = (size_t)image.width * image.height;
        float *rgba = arena_alloc(memory, 4 * count * sizeof *rgba);
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < 4; c++)
                rgba[4 * i + c] = planes[c] ? planes[c][i] : c == 3 ? 1 : 0;
        *out = (picture){image.width, image.height, 0, rgba};
    }
    arena_free(&scratch);
    return done;
}

static bool read_png(const char *root, const char *path, const picture_limits *limits,
                     arena *memory, picture *out) {
    png_image image;
    arena scratch = {0};
    bool done = png_read_inside(root, path, limits, &scratch, &image);
    if (done) {
        size_t count = 4 * (size_t)image.width * image.height; // always RGBA
        const uint8_t *bytes = image.pixels;
        const uint16_t *words = image.pixels;
        float *rgba = arena_alloc(memory, count * sizeof *rgba);
        for (size_t i = 0; i < count; i++)
            rgba[i] = image.bits == 8 ? (float)bytes[i] / 255.0f : (float)words[i] / 65535.0f;
        *out = (picture){image.width, image.height, image.bits, rgba};
    }
    arena_free(&scratch);
    return done;
}

static bool is_png(const char *path) {
    size_t length = strlen(path);
    return length >= 4 && strcmp(path + length - 4, ".png") == 0;
}

static bool check_values(const char *path, const picture *p) {
    size_t count = 4 * (size_t)p->width * p->height;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(p->rgba[i]))
            return err_set("%s: the picture holds %g at %zu, %zu; finite numbers are accepted",
                           path, (double)p->rgba[i], i / 4 % p->width, i / 4 / p->width);
    return true;
}

bool picture_read(const char *path, const char *root, uint32_t side_max, arena *memory,
                  picture *out) {
    enum { CHANNELS = 6 }; // R, G, B, A, Y, and a place for all others
    const picture_limits limits = {side_max, side_max,
                                   CHANNELS * sizeof(float) * (uint64_t)side_max * side_max};
    return path_require_inside(root, path) &&
           (is_png(path) ? read_png : read_exr)(root, path, &limits, memory, out) &&
           check_values(path, out);
}

bool picture_write(const char *path, const picture *image) {
    static const char *const names[4] = {"R", "G", "B", "A"};
    size_t count = (size_t)image->width * image->height;
    float *planes = mem_alloc(4 * count * sizeof *planes);
    exr_channel channels[4];
    for (size_t c = 0; c < 4; c++) {
        for (size_t i = 0; i < count; i++) planes[c * count + i] = image->rgba[4 * i + c];
        channels[c] = (exr_channel){names[c], planes + c * count, true};
    }
    bool done = exr_write(path, &(exr_image){image->width, image->height, channels, 4});
    mem_free(planes);
    return done;
}
