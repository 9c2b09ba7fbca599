#include "media/texture.h"
#include "base/error.h"
#include "base/isolate.h"
#include "base/log.h"
#include "media/png.h"
#include <string.h>
#include <turbojpeg.h>

enum { TEXEL = 4 };

// ---- decoding ---------------------------------------------------------------------------------

static mesh_texture texture_from_png(arena *memory, const png_image *image) {
    if (image->bits == 8) return (mesh_texture){image->width, image->height, image->pixels};
    size_t values = (size_t)image->width * image->height * TEXEL;
    const uint16_t *wide = image->pixels;
    uint8_t *pixels = arena_alloc(memory, values);
    for (size_t i = 0; i < values; i++) pixels[i] = (uint8_t)(wide[i] >> 8);
    return (mesh_texture){image->width, image->height, pixels};
}

static bool refuse_jpeg(tjhandle jpeg, const char *name) {
    return err_set("%s: %s", name, tjGetErrorStr2(jpeg));
}

// A warning is no failure: libjpeg warns about files of many cameras and editors.
static bool decode_jpeg(tjhandle jpeg, const void *data, size_t size, const char *name,
                        const picture_limits *limits, arena *memory, mesh_texture *out) {
    int width, height, sampling, space;
    if (tjDecompressHeader3(jpeg, data, size, &width, &height, &sampling, &space) != 0)
        return refuse_jpeg(jpeg, name);
    if (space == TJCS_CMYK || space == TJCS_YCCK)
        return err_set("%s: a JPEG in CMYK; RGB and grey are accepted", name);
    if (!picture_limits_allow(limits, name, width, height, TEXEL)) return false;
    uint8_t *pixels = arena_alloc(memory, (size_t)width * (size_t)height * TEXEL);
    if (tjDecompress2(jpeg, data, size, pixels, width, 0, height, TJPF_RGBA, TJFLAG_LIMITSCANS)) {
        if (tjGetErrorCode(jpeg) != TJERR_WARNING) return refuse_jpeg(jpeg, name);
        log_write(LOG_DEBUG, "%s: %s", name, tjGetErrorStr2(jpeg));
    }
    *out = (mesh_texture){(uint32_t)width, (uint32_t)height, pixels};
    return true;
}

static bool is_jpeg(const void *data, size_t size) {
    return size >= 3 && memcmp(data, "\xff\xd8\xff", 3) == 0;
}

static bool is_png(const void *data, size_t size) {
    return size >= 4 && memcmp(data, "\x89PNG", 4) == 0;
}

bool texture_decode(const void *data, size_t size, const char *name, const picture_limits *limits,
                    arena *memory, mesh_texture *out) {
    if (is_jpeg(data, size)) {
        tjhandle jpeg = tjInitDecompress();
        bool done = jpeg ? decode_jpeg(jpeg, data, size, name, limits, memory, out)
                         : err_set("%s: %s", name, tjGetErrorStr2(NULL));
        tjDestroy(jpeg);
        return done;
    }
    png_image image;
    if (!is_png(data, size)) return err_set("%s: is neither a PNG nor a JPEG file", name);
    if (!png_decode(data, size, name, limits, memory, &image)) return false;
    *out = texture_from_png(memory, &image);
    return true;
}

// ---- by the reader ----------------------------------------------------------------------------

bool texture_work(const isolate_call *call) {
    arena memory = {0};
    mesh_texture texture;
    if (!texture_decode(call->bytes, call->size, call->name, &picture_limits_default, &memory,
                        &texture))
        return false;
    const uint32_t head[2] = {texture.width, texture.height};
    bool done = isolate_put(call, head, sizeof head) &&
                isolate_put(call, texture.pixels, (size_t)texture.width * texture.height * TEXEL);
    arena_free(&memory);
    return done;
}

static bool texture_take(const char *name, isolate_result *r, arena *memory, mesh_texture *out) {
    uint32_t head[2] = {0};
    if (r->size >= sizeof head) memcpy(head, r->data, sizeof head);
    bool whole = picture_limits_allow(&picture_limits_default, name, head[0], head[1], TEXEL) &&
                 r->size == sizeof head + (size_t)head[0] * head[1] * TEXEL;
    if (whole)
        *out = (mesh_texture){
            head[0], head[1],
            arena_copy(memory, (const char *)r->data + sizeof head, r->size - sizeof head)};
    isolate_free(r);
    return whole || err_set("%s: damaged: its reader returned nonsense", name);
}

bool texture_read_inside(const char *root, const char *path, arena *memory, mesh_texture *out) {
    isolate_result r;
    return picture_run_job(root, path, &picture_limits_default, (isolate_job){.kind = "texture"},
                           &r) &&
           texture_take(path, &r, memory, out);
}

bool texture_read_memory(const void *data, size_t size, const char *name, arena *memory,
                         mesh_texture *out) {
    const isolate_job job = {.kind = "texture",
                             .name = name,
                             .bytes = size ? data : "",
                             .size = size,
                             .limits = picture_limits_of_job(&picture_limits_default, size)};
    isolate_result r;
    return isolate_run(&job, &r) && texture_take(name, &r, memory, out);
}
