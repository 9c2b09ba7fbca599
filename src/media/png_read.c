// PNG by the reader: the data of its jobs and of their results.
#include "base/error.h"
#include "media/png.h"
#include <string.h>

// ---- pictures ---------------------------------------------------------------------------------

typedef struct head { // of the result, before the pixels
    uint32_t width, height;
    int bits;
} head;

bool png_work(const isolate_call *call) {
    picture_limits limits;
    arena memory = {0};
    png_image image;
    if (!picture_take_argument(call, &limits, sizeof limits)) return false;
    if (!png_decode(call->bytes, call->size, call->name, &limits, &memory, &image)) return false;
    const head h = {image.width, image.height, image.bits};
    size_t pixel = 4 * (size_t)image.bits / 8;
    bool done = isolate_put(call, &h, sizeof h) &&
                isolate_put(call, image.pixels, (size_t)h.width * h.height * pixel);
    arena_free(&memory);
    return done;
}

bool png_size_work(const isolate_call *call) {
    picture_limits limits;
    png_image image;
    return picture_take_argument(call, &limits, sizeof limits) &&
           png_decode(call->bytes, call->size, call->name, &limits, NULL, &image) &&
           picture_put_size(call, image.width, image.height);
}

static bool take_image(const char *name, const picture_limits *limits, isolate_result *r,
                       arena *memory, png_image *out) {
    head h = {0};
    if (r->size >= sizeof h) memcpy(&h, r->data, sizeof h);
    size_t pixel = 4 * (size_t)h.bits / 8;
    bool whole = (h.bits == 8 || h.bits == 16) &&
                 picture_limits_allow(limits, name, h.width, h.height, pixel) &&
                 r->size == sizeof h + (size_t)h.width * h.height * pixel;
    if (whole) {
        const char *pixels = (const char *)r->data + sizeof h;
        *out = (png_image){h.width, h.height, 4, h.bits,
                           arena_copy(memory, pixels, r->size - sizeof h)};
    }
    isolate_free(r);
    return whole || err_set("%s: damaged: its reader returned nonsense", name);
}

bool png_read(const char *path, const picture_limits *limits, arena *memory, png_image *out) {
    return png_read_inside(NULL, path, limits, memory, out);
}

bool png_read_inside(const char *root, const char *path, const picture_limits *limits,
                     arena *memory, png_image *out) {
    isolate_result r;
    if (!limits) limits = &picture_limits_default;
    const isolate_job job = {.kind = "png", .arguments = limits, .argument_size = sizeof *limits};
    *out = (png_image){0};
    return picture_run_job(root, path, limits, job, &r) &&
           take_image(path, limits, &r, memory, out);
}

// ---- texts ------------------------------------------------------------------------------------

// The result is each key and each value, with its zero byte.
bool png_texts_work(const isolate_call *call) {
    png_text texts[PNG_MAX_TEXTS];
    arena memory = {0};
    size_t count;
    bool done = png_decode_texts(call->bytes, call->size, call->name, &memory, texts, &count);
    for (size_t i = 0; done && i < count; i++)
        done = isolate_put(call, texts[i].key, strlen(texts[i].key) + 1) &&
               isolate_put(call, texts[i].value, strlen(texts[i].value) + 1);
    arena_free(&memory);
    return done;
}

// Returns the next string; NULL when there is none that is terminated.
static const char *take_string(const isolate_result *r, size_t *at) {
    const char *text = (const char *)r->data + *at;
    const char *end = *at < r->size ? memchr(text, '\0', r->size - *at) : NULL;
    if (end) *at += (size_t)(end - text) + 1;
    return end ? text : NULL;
}

bool png_read_texts(const char *path, arena *memory, png_text out[PNG_MAX_TEXTS], size_t *count) {
    isolate_result r;
    size_t at = 0;
    *count = 0;
    if (!picture_run_job(NULL, path, &picture_limits_default, (isolate_job){.kind = "png texts"},
                         &r))
        return false;
    while (*count < PNG_MAX_TEXTS) {
        const char *key = take_string(&r, &at), *value = key ? take_string(&r, &at) : NULL;
        if (!value) break;
        out[(*count)++] = (png_text){arena_string(memory, key), arena_string(memory, value)};
    }
    isolate_free(&r);
    return true;
}
