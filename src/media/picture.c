#include "media/picture.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "media/exr.h"
#include "media/isolate.h"
#include "media/png.h"
#include <math.h>
#include <string.h>

typedef struct task {
    const char *path;
    uint32_t side_max;
} task;

typedef struct head { // what the child sends, before the pixels
    uint32_t width, height;
    int bits;
} head;

static bool fits(const task *t, uint32_t width, uint32_t height) {
    if (width >= 1 && height >= 1 && width <= t->side_max && height <= t->side_max) return true;
    return err_set("%s: a picture of %ux%u; up to %ux%u is accepted", t->path, width, height,
                   t->side_max, t->side_max);
}

static const float *find_channel(const exr_image *image, const char *name) {
    for (size_t c = 0; c < image->channel_count; c++)
        if (strcmp(image->channels[c].name, name) == 0) return image->channels[c].values;
    return NULL;
}

// Red, green and blue that are missing are grey, or nothing if there is another colour.
static bool find_planes(const char *path, const exr_image *image, const float *planes[4]) {
    static const char *const names[4] = {"R", "G", "B", "A"};
    const float *grey = find_channel(image, "Y");
    for (int c = 0; c < 4; c++) planes[c] = find_channel(image, names[c]);
    if (!planes[0] && !planes[1] && !planes[2]) {
        if (!grey)
            return err_set("%s: the picture has no channel R, G, B or Y; one at least is needed",
                           path);
        planes[0] = planes[1] = planes[2] = grey;
    }
    return true;
}

static bool decode_exr(const task *t, arena *memory, head *out, float **rgba) {
    exr_image image;
    const float *planes[4];
    if (!exr_read(t->path, memory, &image) || !fits(t, image.width, image.height) ||
        !find_planes(t->path, &image, planes))
        return false;
    size_t count = (size_t)image.width * image.height;
    *out = (head){image.width, image.height, 0};
    *rgba = arena_alloc(memory, 4 * count * sizeof **rgba);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 4; c++)
            (*rgba)[4 * i + c] = planes[c] ? planes[c][i] : c == 3 ? 1 : 0;
    return true;
}

static bool decode_png(const task *t, arena *memory, head *out, float **rgba) {
    png_image image;
    if (!png_read(t->path, memory, &image) || !fits(t, image.width, image.height)) return false;
    size_t count = 4 * (size_t)image.width * image.height; // always RGBA
    const uint8_t *bytes = image.pixels;
    const uint16_t *words = image.pixels;
    *out = (head){image.width, image.height, image.bits};
    *rgba = arena_alloc(memory, count * sizeof **rgba);
    for (size_t i = 0; i < count; i++)
        (*rgba)[i] = image.bits == 8 ? (float)bytes[i] / 255.0f : (float)words[i] / 65535.0f;
    return true;
}

static bool is_png(const char *path) {
    size_t length = strlen(path);
    return length >= 4 && strcmp(path + length - 4, ".png") == 0;
}

static bool decode(void *user, int out) { // in the child
    const task *t = user;
    arena memory = {0};
    head h;
    float *rgba;
    if (!(is_png(t->path) ? decode_png : decode_exr)(t, &memory, &h, &rgba)) return false;
    return isolate_put(out, &h, sizeof h) &&
           isolate_put(out, rgba, 4 * (size_t)h.width * h.height * sizeof *rgba);
}

static bool check_values(const task *t, const head *h, const float *rgba) {
    size_t count = 4 * (size_t)h->width * h->height;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(rgba[i]))
            return err_set("%s: the picture holds %g at %zu, %zu; finite numbers are accepted",
                           t->path, (double)rgba[i], i / 4 % h->width, i / 4 / h->width);
    return true;
}

bool picture_read(const char *path, const char *root, uint32_t side_max, arena *memory,
                  picture *out) {
    task t = {path, side_max};
    void *data;
    size_t size;
    if (!path_require_inside(root, path) ||
        !isolate_run(&(isolate_job){.name = path, .work = decode, .user = &t}, &data, &size))
        return false;
    head h = {0};
    if (size >= sizeof h) memcpy(&h, data, sizeof h);
    size_t bytes = 4 * (size_t)h.width * h.height * sizeof(float);
    const float *sent = (const float *)((const char *)data + sizeof h);
    bool done =
        fits(&t, h.width, h.height) &&
        (size == sizeof h + bytes || err_set("%s: damaged: its reader returned nonsense", path)) &&
        check_values(&t, &h, sent);
    if (done) {
        float *rgba = arena_alloc(memory, bytes);
        memcpy(rgba, sent, bytes);
        *out = (picture){h.width, h.height, h.bits, rgba};
    }
    mem_free(data);
    return done;
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
