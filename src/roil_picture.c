// Pictures of the last frame: read back, encoded, saved.
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "effect/recipe.h"
#include "media/exr.h"
#include "media/png.h"
#include "media/video.h"
#include "roil_impl.h"
#include <math.h>
#include <string.h>

// ---- reading back -----------------------------------------------------------------------------

// Every format of the graph as four floats; missing channels are 0, alpha 1.
static void expand(const unsigned char *texel, gpu_format format, float out[4]) {
    uint32_t channels = gpu_format_channels(format);
    uint32_t bytes = gpu_format_size(format) / channels;
    out[0] = out[1] = out[2] = 0;
    out[3] = 1;
    for (uint32_t c = 0; c < channels; c++) {
        uint16_t half;
        memcpy(&half, texel + c * bytes, bytes == 2 ? 2 : 0);
        if (bytes == 2)
            out[c] = half_to_float(half);
        else if (bytes == 4)
            memcpy(&out[c], texel + c * 4, 4);
        else
            out[c] = (float)texel[c] / 255.0f;
    }
}

float *roil_read_image(roil_effect *e, graph_image image, uint32_t *width, uint32_t *height) {
    gpu_image *source = graph_get_image(effect_graph(e->effect), image);
    if (!source || !e->frame) {
        err_set("there is no picture yet: render a frame first");
        return NULL;
    }
    const gpu_image_desc *desc = gpu_image_get_desc(source);
    if (desc->depth > 1 || desc->format == GPU_R32U) {
        err_set("%s: only two-dimensional pictures can be saved", desc->label);
        return NULL;
    }
    size_t count = (size_t)desc->width * desc->height, texel = gpu_format_size(desc->format);
    unsigned char *raw = mem_alloc(count * texel);
    float *pixels = NULL;
    if (gpu_image_read(e->owner->device, source, raw, count * texel)) {
        pixels = mem_alloc(count * 4 * sizeof *pixels);
        for (size_t i = 0; i < count; i++) expand(raw + i * texel, desc->format, pixels + i * 4);
        *width = desc->width;
        *height = desc->height;
    }
    mem_free(raw);
    return pixels;
}

// ---- display encoding -------------------------------------------------------------------------

static float srgb_encode(float linear) {        // IEC 61966-2-1
    linear = linear > 0 ? fminf(linear, 1) : 0; // NaN becomes 0
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

// Linear 0..1 to 8 bits by a table over the square root, which spends its entries where sRGB is
// steep: within half a code of the formula.
const uint8_t *roil_srgb_table(void) {
    static uint8_t table[ROIL_SRGB_STEPS + 1];
    static bool filled;
    if (!filled) {
        for (int i = 0; i <= ROIL_SRGB_STEPS; i++) {
            float root = (float)i / ROIL_SRGB_STEPS;
            table[i] = (uint8_t)lrintf(srgb_encode(root * root) * 255);
        }
        filled = true;
    }
    return table;
}

static uint8_t srgb_byte(float linear) {
    linear = linear > 0 ? fminf(linear, 1) : 0;
    return roil_srgb_table()[lrintf(sqrtf(linear) * ROIL_SRGB_STEPS)];
}

// Colours are premultiplied: without alpha they lie on black, with it they are divided by it.
static float straight(const float *pixel, int c, bool alpha) {
    return alpha && pixel[3] > 1e-6f ? pixel[c] / pixel[3] : pixel[c];
}

static void encode8(const float *pixels, size_t count, bool alpha, int channels, uint8_t *out) {
    for (size_t i = 0; i < count; i++) {
        const float *pixel = pixels + i * 4;
        for (int c = 0; c < 3; c++)
            out[i * (size_t)channels + (size_t)c] = srgb_byte(straight(pixel, c, alpha));
        if (channels == 4)
            out[i * 4 + 3] = alpha ? (uint8_t)lrintf(clampf(pixel[3], 0, 1) * 255) : 255;
    }
}

static void encode16(const float *pixels, size_t count, bool alpha, int channels, uint16_t *out) {
    for (size_t i = 0; i < count; i++) {
        const float *pixel = pixels + i * 4;
        for (int c = 0; c < 3; c++)
            out[i * (size_t)channels + (size_t)c] =
                (uint16_t)lrintf(srgb_encode(straight(pixel, c, alpha)) * 65535);
        if (channels == 4) out[i * 4 + 3] = (uint16_t)lrintf(clampf(pixel[3], 0, 1) * 65535);
    }
}

bool roil_read(roil_effect *e, bool alpha, uint8_t *out) {
    uint32_t width, height;
    float *pixels =
        roil_read_image(e, effect_get_picture(e->effect, EFFECT_OUTPUT), &width, &height);
    if (!pixels) return false;
    if (width != e->width || height != e->height) {
        mem_free(pixels);
        return err_set("the effect's output is %u x %u, not %u x %u: its last pass has a "
                       "resolution below 1",
                       width, height, e->width, e->height);
    }
    encode8(pixels, (size_t)width * height, alpha, 4, out);
    mem_free(pixels);
    return true;
}

// ---- files ------------------------------------------------------------------------------------

static bool save_png(const roil_effect *e, const char *file, const float *pixels, uint32_t width,
                     uint32_t height, const roil_save_options *options) {
    size_t count = (size_t)width * height;
    int channels = options->alpha ? 4 : 3;
    void *encoded = mem_alloc(count * (size_t)channels * (options->sixteen ? 2 : 1));
    if (options->sixteen)
        encode16(pixels, count, options->alpha, channels, encoded);
    else
        encode8(pixels, count, options->alpha, channels, encoded);
    arena memory = {0};
    png_text texts[RECIPE_TEXTS];
    recipe_write(e->effect, e->shown, e->width, e->height, &memory, texts);
    bool done = png_write(file,
                          &(png_image){.width = width,
                                       .height = height,
                                       .channels = channels,
                                       .bits = options->sixteen ? 16 : 8,
                                       .pixels = encoded},
                          texts, RECIPE_TEXTS);
    arena_free(&memory);
    mem_free(encoded);
    return done;
}

// Channels one after the other, as EXR wants them.
static float *split(const float *pixels, size_t count) {
    float *planes = mem_alloc(count * 4 * sizeof *planes);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 4; c++) planes[c * count + i] = pixels[i * 4 + c];
    return planes;
}

static bool save_exr(roil_effect *e, const char *file, const float *pixels, uint32_t width,
                     uint32_t height, const roil_save_options *options) {
    size_t count = (size_t)width * height;
    float *planes = split(pixels, count), *depth = NULL;
    bool half = !options->full;
    exr_channel channels[5] = {{"R", planes, half},
                               {"G", planes + count, half},
                               {"B", planes + 2 * count, half},
                               {"A", planes + 3 * count, half}};
    size_t channel_count = 4;
    graph_image z = effect_get_picture(e->effect, EFFECT_DEPTH);
    uint32_t z_width = 0, z_height = 0;
    if (z.id && !options->image) {
        float *values = roil_read_image(e, z, &z_width, &z_height);
        if (values && z_width == width && z_height == height) {
            depth = split(values, count);
            channels[channel_count++] = (exr_channel){"Z", depth, false}; // half has too few digits
        }
        mem_free(values);
    }
    bool done = exr_write(file, &(exr_image){width, height, channels, channel_count});
    mem_free(planes);
    mem_free(depth);
    return done;
}

bool roil_save(roil_effect *e, const char *file, const roil_save_options *options) {
    static const roil_save_options defaults;
    if (!options) options = &defaults;
    bool exr = strcmp(path_extension(file), "exr") == 0;
    if (!exr && strcmp(path_extension(file), "png") != 0)
        return err_set("%s: pictures are .png or .exr", file);
    graph_image linear = effect_get_picture(e->effect, EFFECT_LINEAR);
    graph_image image = exr && linear.id ? linear : effect_get_picture(e->effect, EFFECT_OUTPUT);
    if (options->image) image = roil_find_image(e, options->image);
    uint32_t width, height;
    float *pixels = image.id ? roil_read_image(e, image, &width, &height) : NULL;
    if (!pixels) return false;
    bool done =
        file_make_parent_folders(file) && (exr ? save_exr(e, file, pixels, width, height, options)
                                               : save_png(e, file, pixels, width, height, options));
    mem_free(pixels);
    return done;
}

// ---- video ------------------------------------------------------------------------------------

struct roil_video {
    roil_effect *effect;
    video *video;
    uint8_t *pixels;
};

roil_video *roil_video_create(roil_effect *e, const char *file, double fps) {
    if (!file_make_parent_folders(file)) return NULL;
    video *out = video_create(file, e->width, e->height, fps);
    if (!out) return NULL;
    roil_video *v = mem_alloc(sizeof *v);
    *v = (roil_video){e, out, mem_alloc((size_t)e->width * e->height * 4)};
    return v;
}

static void release(roil_video *v) {
    mem_free(v->pixels);
    mem_free(v);
}

bool roil_video_add(roil_video *v) {
    return roil_read(v->effect, false, v->pixels) && video_add(v->video, v->pixels);
}

bool roil_video_finish(roil_video *v) {
    bool done = video_finish(v->video);
    release(v);
    return done;
}

void roil_video_abandon(roil_video *v) {
    if (!v) return;
    video_abandon(v->video);
    release(v);
}
