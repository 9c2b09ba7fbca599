// Compares two picture files, and draws a picture of their differences.
#include "media/compare.h"
#include "base/arena.h"
#include "base/budget.h"
#include "base/file.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/srgb.h"
#include "base/str.h"
#include "media/exr.h"
#include "media/png.h"
#include "roil.h"
#include <math.h>
#include <string.h>

static float encode_srgb(float v) {
    return srgb_from_linear(clampf(v, 0, 1));
}

// ---- files ------------------------------------------------------------------------------------

static bool read_png(const char *path, arena *memory, compare_picture *out) {
    png_image image;
    arena scratch = {0};
    if (!png_read(path, NULL, &scratch, &image)) return false;
    size_t count = (size_t)image.width * image.height;
    float *rgb = arena_alloc(memory, count * 3 * sizeof *rgb);
    for (size_t i = 0; i < count; i++) {
        float value[4];
        for (size_t c = 0; c < 4; c++)
            value[c] = image.bits == 16 ? (float)((const uint16_t *)image.pixels)[i * 4 + c] / 65535
                                        : (float)((const uint8_t *)image.pixels)[i * 4 + c] / 255;
        for (size_t c = 0; c < 3; c++)
            rgb[i * 3 + c] =
                value[3] < 1 ? encode_srgb(linear_from_srgb(value[c]) * value[3]) : value[c];
    }
    arena_free(&scratch);
    *out = (compare_picture){image.width, image.height, rgb};
    return true;
}

static bool find_planes(const char *path, const exr_image *image, const float *planes[3]) {
    static const char *const names[3] = {"R", "G", "B"};
    for (size_t c = 0; c < 3; c++) {
        planes[c] = exr_find(image, names[c]);
        if (!planes[c])
            return err_set("%s: no channel '%s'; R, G and B are compared", path, names[c]);
        for (size_t i = 0; i < (size_t)image->width * image->height; i++)
            if (isnan(planes[c][i]))
                return err_set("%s: pixel %zu, %zu is not a number in channel '%s'", path,
                               i % image->width, i / image->width, names[c]);
    }
    return true;
}

static bool read_exr(const char *path, float gain, arena *memory, compare_picture *out) {
    const exr_wish wish = {"RGB", picture_limits_default};
    exr_image image;
    const float *planes[3];
    arena scratch = {0};
    bool done = exr_read(path, &wish, &scratch, &image) && find_planes(path, &image, planes);
    if (done) {
        size_t count = (size_t)image.width * image.height;
        float *rgb = arena_alloc(memory, count * 3 * sizeof *rgb);
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < 3; c++) rgb[i * 3 + c] = encode_srgb(planes[c][i] * gain);
        *out = (compare_picture){image.width, image.height, rgb};
    }
    arena_free(&scratch);
    return done;
}

static bool read_picture(const char *path, float gain, arena *memory, compare_picture *out) {
    return str_ends_with(path, ".png") ? read_png(path, memory, out)
                                       : read_exr(path, gain, memory, out);
}

// ---- memory -----------------------------------------------------------------------------------

// Bytes per pixel: of a picture that is kept; and at most while one is read (in the reader, on the
// way to this process, as decoded), which exceeds what the comparison of two needs.
enum { KEPT_BYTES = 12, WORK_BYTES = 48, PARTS = 3 };

static bool take_parts(const roil_comparison *how, const uint64_t pixels[2],
                       budget_part *parts[PARTS]) {
    const uint64_t most = pixels[0] > pixels[1] ? pixels[0] : pixels[1];
    budget_row rows[PARTS] = {{.bytes = KEPT_BYTES * pixels[0]},
                              {.bytes = KEPT_BYTES * pixels[1]},
                              {.label = "pictures read and compared", .bytes = WORK_BYTES * most}};
    str_copy(rows[0].label, sizeof rows[0].label, path_name(how->a));
    str_copy(rows[1].label, sizeof rows[1].label, path_name(how->b));
    bool fit = budget_ask(budget_host(), rows, PARTS, 0);
    for (int i = 0; fit && i < PARTS; i++) {
        parts[i] = budget_take(budget_host(), rows[i].bytes, rows[i].label);
        fit = parts[i] != NULL;
    }
    return fit;
}

// Takes the memory of the whole comparison; the headers of both files give their sizes.
static bool take_memory(const roil_comparison *how, budget_part *parts[PARTS]) {
    const char *const paths[2] = {how->a, how->b};
    uint64_t pixels[2];
    for (int i = 0; i < 2; i++) {
        picture_size size;
        bool png = str_ends_with(paths[i], ".png");
        if (!png && !str_ends_with(paths[i], ".exr"))
            return err_set("%s: cannot be compared; accepted: .png, .exr", paths[i]);
        if (!picture_read_size(paths[i], png ? "png size" : "exr size", &size)) return false;
        pixels[i] = (uint64_t)size.width * size.height;
    }
    return take_parts(how, pixels, parts);
}

// ---- difference picture -----------------------------------------------------------------------

// Returns the colour of an error of 0 to 1. The ramp's lightness rises evenly, from black over
// purple and orange to pale yellow.
static void ramp(float error, uint8_t out[3]) {
    static const float stops[][3] = {{0, 0, 4},      {28, 16, 68},    {79, 18, 123},
                                     {129, 37, 129}, {181, 54, 122},  {229, 80, 100},
                                     {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
    float at = clampf(error, 0, 1) * (float)(COUNT_OF(stops) - 1);
    size_t low = (size_t)at;
    if (low > COUNT_OF(stops) - 2) low = COUNT_OF(stops) - 2;
    for (size_t c = 0; c < 3; c++)
        out[c] = (uint8_t)lrintf(mixf(stops[low][c], stops[low + 1][c], at - (float)low));
}

static bool write_difference(const char *path, const compare_picture *shape, const float *map,
                             arena *memory) {
    size_t count = (size_t)shape->width * shape->height;
    uint8_t *pixels = arena_alloc(memory, count * 3);
    for (size_t i = 0; i < count; i++) ramp(map[i], pixels + i * 3);
    return file_make_parent_folders(path) &&
           png_write(path, &(png_image){shape->width, shape->height, 3, 8, pixels}, NULL, 0);
}

// Writes A, B and the errors side by side.
static bool write_beside(const char *path, const compare_picture *a, const compare_picture *b,
                         const float *map, arena *memory) {
    uint32_t width = a->width, height = a->height;
    uint8_t *pixels = arena_alloc(memory, (size_t)width * height * 9);
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            size_t from = y * width + x;
            uint8_t *row = pixels + y * width * 9;
            for (size_t c = 0; c < 3; c++) {
                row[x * 3 + c] = (uint8_t)lrintf(clampf(a->rgb[from * 3 + c], 0, 1) * 255);
                row[(width + x) * 3 + c] =
                    (uint8_t)lrintf(clampf(b->rgb[from * 3 + c], 0, 1) * 255);
            }
            ramp(map[from], row + (2 * width + x) * 3);
        }
    return file_make_parent_folders(path) &&
           png_write(path, &(png_image){width * 3, height, 3, 8, pixels}, NULL, 0);
}

// ---- comparison -------------------------------------------------------------------------------

static bool compare_pictures(const roil_comparison *how, arena *memory, roil_difference *out) {
    compare_picture a, b;
    float gain = exp2f(how->exposure);
    if (!read_picture(how->a, gain, memory, &a) || !read_picture(how->b, gain, memory, &b))
        return false;
    if (a.width != b.width || a.height != b.height)
        return err_set("%s is %ux%u, %s is %ux%u; pictures of one size are compared", how->a,
                       a.width, a.height, how->b, b.width, b.height);
    float *map = arena_alloc(memory, (size_t)a.width * a.height * sizeof *map);
    *out = (roil_difference){
        .width = a.width,
        .height = a.height,
        .psnr = compare_psnr(&a, &b),
        .ssim = compare_ssim(&a, &b),
        .flip =
            compare_flip(&a, &b, how->pixels_per_degree > 0 ? how->pixels_per_degree : 67, map)};
    return (!how->difference || write_difference(how->difference, &a, map, memory)) &&
           (!how->beside || write_beside(how->beside, &a, &b, map, memory));
}

bool roil_compare(const roil_comparison *how, roil_difference *out) {
    mem_enter();
    double ppd = how->pixels_per_degree;
    *out = (roil_difference){0};
    if (ppd != 0 && !(ppd >= 1 && ppd <= 1000))
        return mem_leave(err_set("%g pixels per degree; 1 to 1000 are accepted", ppd));
    if (!(fabsf(how->exposure) <= 64))
        return mem_leave(
            err_set("exposure of %g stops; -64 to 64 are accepted", (double)how->exposure));
    const char *const pictures[] = {how->difference, how->beside};
    for (size_t i = 0; i < COUNT_OF(pictures); i++)
        if (pictures[i] && !str_ends_with(pictures[i], ".png"))
            return mem_leave(
                err_set("%s: a difference cannot be written; accepted: .png", pictures[i]));
    arena memory = {0};
    budget_part *parts[PARTS] = {0};
    bool done = take_memory(how, parts) && compare_pictures(how, &memory, out);
    arena_free(&memory);
    for (int i = 0; i < PARTS; i++) budget_give(parts[i]);
    return mem_leave(done);
}
