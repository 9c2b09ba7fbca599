// Pictures of the last frame: read back, encoded and saved.
#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/jobs.h"
#include "base/memory.h"
#include "base/srgb.h"
#include "base/worker.h"
#include "effect/recipe.h"
#include "media/exr.h"
#include "media/png.h"
#include "media/video.h"
#include "pass/blue_noise.h"
#include "roil/roil_impl.h"
#include <math.h>
#include <string.h>

// ---- reading back -----------------------------------------------------------------------------

// Formats of the graph differ only in the bytes of a channel.
static float channel_value(const unsigned char *at, uint32_t bytes) {
    uint16_t half;
    float full;
    switch (bytes) {
    case 1:
        return (float)*at / 255.0f;
    case 2:
        memcpy(&half, at, sizeof half);
        return half_to_float(half);
    default:
        memcpy(&full, at, sizeof full);
        return full;
    }
}

// Converts a texel to four floats. Missing channels are 0, and alpha 1.
static void expand_texel(const unsigned char *texel, gpu_format format, float out[4]) {
    uint32_t channels = gpu_format_channels(format);
    uint32_t bytes = gpu_format_size(format) / channels;
    out[0] = out[1] = out[2] = 0;
    out[3] = 1;
    for (uint32_t c = 0; c < channels; c++) out[c] = channel_value(texel + c * bytes, bytes);
}

typedef struct raw_image { // as it lies on the device
    unsigned char *texels; // NULL: none
    budget_part *part;     // of these, and of what becomes of them
    gpu_format format;
    uint32_t width, height;
} raw_image;

enum {
    WORK_BYTES = 32
}; // a pixel, at most: as numbers, and these by channels or as they are written

static void free_raw(raw_image *raw) {
    mem_free(raw->texels);
    budget_give(raw->part);
    *raw = (raw_image){0};
}

static bool read_raw(roil_effect *e, graph_image image, raw_image *out) {
    gpu_image *source = graph_get_image(effect_graph(e->effect), image);
    if (!source || !e->frame) return err_set("there is no picture yet: render a frame first");
    const gpu_image_desc *desc = gpu_image_get_desc(source);
    if (desc->depth > 1 || desc->format == GPU_R32U)
        return err_set("%s: only two-dimensional pictures can be saved", desc->label);
    size_t size = (size_t)desc->width * desc->height * gpu_format_size(desc->format);
    uint64_t work = (uint64_t)desc->width * desc->height * WORK_BYTES;
    budget_part *part = budget_take(budget_host(), size + work, "pictures read back and written");
    if (!part) return err_prefix("%s: ", desc->label);
    *out = (raw_image){mem_alloc(size), part, desc->format, desc->width, desc->height};
    if (gpu_image_read(e->owner->device, source, out->texels, size)) return true;
    free_raw(out);
    return false;
}

typedef struct linear_image {
    float *pixels; // red, green, blue, alpha
    size_t width, height;
} linear_image;

void roil_expand(const void *texels, gpu_format format, size_t count, float *out) {
    size_t texel = gpu_format_size(format);
    for (size_t i = 0; i < count; i++)
        expand_texel((const unsigned char *)texels + i * texel, format, out + i * 4);
}

static linear_image expand_all(const raw_image *raw) {
    size_t count = (size_t)raw->width * raw->height;
    float *pixels = mem_alloc(count * 4 * sizeof *pixels);
    roil_expand(raw->texels, raw->format, count, pixels);
    return (linear_image){pixels, raw->width, raw->height};
}

float *roil_read_linear(roil_effect *e, graph_image image, uint32_t *width, uint32_t *height) {
    raw_image raw = {0};
    if (!read_raw(e, image, &raw)) return NULL;
    linear_image all = expand_all(&raw);
    *width = raw.width;
    *height = raw.height;
    free_raw(&raw);
    return all.pixels;
}

// ---- display encoding -------------------------------------------------------------------------

float roil_srgb(float linear) {
    return srgb_from_linear(linear > 0 ? fminf(linear, 1) : 0); // NaN becomes 0
}

// Linear values 0 to 1 are encoded by tables over the square root, which have most entries where
// sRGB is steep. They are within half a code of the formula.
static float table_value(int index) {
    float root = (float)index / ROIL_SRGB_STEPS;
    return roil_srgb(root * root);
}

const uint8_t *roil_srgb_table(void) {
    static uint8_t table[ROIL_SRGB_STEPS + 1];
    static bool filled;
    for (int i = 0; !filled && i <= ROIL_SRGB_STEPS; i++)
        table[i] = (uint8_t)lrintf(table_value(i) * 255);
    filled = true;
    return table;
}

const uint16_t *roil_srgb_fine_table(void) {
    static uint16_t table[ROIL_SRGB_STEPS + 1];
    static bool filled;
    for (int i = 0; !filled && i <= ROIL_SRGB_STEPS; i++)
        table[i] = (uint16_t)lrintf(table_value(i) * ROIL_SRGB_FINE);
    filled = true;
    return table;
}

static size_t table_index(float linear) {
    linear = linear > 0 ? fminf(linear, 1) : 0;
    return (size_t)lrintf(sqrtf(linear) * ROIL_SRGB_STEPS);
}

uint8_t roil_dither_noise(size_t x, size_t y, int channel) {
    const size_t side = BLUE_NOISE_SIZE, step = side / 3; // channels do not err together
    return blue_noise_texels[(x + step * (size_t)channel) % side + side * (y % side)];
}

// Chooses between the two nearest codes by blue noise, so that the mean is right and dark skies
// have no bands (Ulichney, "Dithering with blue noise", Proc. IEEE 76, 1988). A value that is a
// code already stays the same.
static uint8_t dithered_byte(float linear, size_t x, size_t y, int channel) {
    uint16_t fine = roil_srgb_fine_table()[table_index(linear)];
    return (uint8_t)((fine + roil_dither_noise(x, y, channel)) >> 8);
}

typedef enum alpha_kind { OPAQUE, STRAIGHT, PREMULTIPLIED } alpha_kind;

// Colours are premultiplied, as they appear on black. Straight colours are divided by alpha.
static float color_of(const float *pixel, int c, alpha_kind alpha) {
    return alpha == STRAIGHT && pixel[3] > 1e-6f ? pixel[c] / pixel[3] : pixel[c];
}

static uint8_t alpha_byte(const float *pixel, alpha_kind alpha) {
    return alpha != OPAQUE ? (uint8_t)lrintf(clampf(pixel[3], 0, 1) * 255) : 255;
}

// Encodes a picture for viewing.
static void encode8_dithered(const linear_image *image, alpha_kind alpha, size_t channels,
                             uint8_t *out) {
    const float *pixel = image->pixels;
    for (size_t y = 0; y < image->height; y++)
        for (size_t x = 0; x < image->width; x++, pixel += 4, out += channels) {
            for (int c = 0; c < 3; c++) out[c] = dithered_byte(color_of(pixel, c, alpha), x, y, c);
            if (channels == 4) out[3] = alpha_byte(pixel, alpha);
        }
}

// Encodes a picture for measurements: each value becomes the nearest code.
static void encode8_nearest(const linear_image *image, alpha_kind alpha, uint8_t *out) {
    const uint8_t *table = roil_srgb_table();
    const float *end = image->pixels + image->width * image->height * 4;
    for (const float *pixel = image->pixels; pixel < end; pixel += 4, out += 4) {
        for (int c = 0; c < 3; c++) out[c] = table[table_index(color_of(pixel, c, alpha))];
        out[3] = alpha_byte(pixel, alpha);
    }
}

static void encode16(const linear_image *image, alpha_kind alpha, size_t channels, uint16_t *out) {
    const float *end = image->pixels + image->width * image->height * 4;
    for (const float *pixel = image->pixels; pixel < end; pixel += 4, out += channels) {
        for (int c = 0; c < 3; c++)
            out[c] = (uint16_t)lrintf(roil_srgb(color_of(pixel, c, alpha)) * 65535);
        if (channels == 4) out[3] = (uint16_t)lrintf(clampf(pixel[3], 0, 1) * 65535);
    }
}

// Reads the effect's picture. False when it does not have the size that was asked for.
static bool read_output(roil_effect *e, raw_image *out) {
    if (!read_raw(e, effect_get_picture(e->effect, EFFECT_OUTPUT), out)) return false;
    if (out->width == e->width && out->height == e->height) return true;
    err_set("the effect's output is %u x %u, not %u x %u: its last pass has a resolution below 1",
            out->width, out->height, e->width, e->height);
    free_raw(out);
    return false;
}

bool roil_read(roil_effect *e, bool alpha, uint8_t *out) {
    mem_enter();
    raw_image raw = {0};
    if (!read_output(e, &raw)) return mem_leave(false);
    linear_image image = expand_all(&raw);
    encode8_nearest(&image, alpha ? STRAIGHT : OPAQUE, out);
    mem_free(image.pixels);
    free_raw(&raw);
    return mem_leave(true);
}

// ---- files ------------------------------------------------------------------------------------

typedef struct picture { // all that its file needs, away from the effect and its device
    char file[PATH_CAP];
    bool exr;
    roil_save_options options;
    raw_image color, depth;
    arena memory;
    png_text texts[RECIPE_TEXTS + 1]; // the last holds `recipe`
    char *recipe;                     // NULL: none
} picture;

static bool write_png(const picture *p, const linear_image *image) {
    const bool sixteen = p->options.sixteen;
    const alpha_kind alpha = p->options.premultiplied ? PREMULTIPLIED
                             : p->options.alpha       ? STRAIGHT
                                                      : OPAQUE;
    const size_t channels = alpha != OPAQUE ? 4 : 3;
    void *encoded = mem_alloc(image->width * image->height * channels * (sixteen ? 2 : 1));
    if (sixteen)
        encode16(image, alpha, channels, encoded);
    else
        encode8_dithered(image, alpha, channels, encoded);
    bool done = png_write(p->file,
                          &(png_image){.width = p->color.width,
                                       .height = p->color.height,
                                       .channels = (int)channels,
                                       .bits = sixteen ? 16 : 8,
                                       .pixels = encoded},
                          p->texts, RECIPE_TEXTS + (p->recipe ? 1 : 0));
    mem_free(encoded);
    return done;
}

// Separates the channels into planes, as EXR stores them.
static float *split_channels(const linear_image *image) {
    const size_t count = image->width * image->height;
    float *planes = mem_alloc(count * 4 * sizeof *planes);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 4; c++) planes[c * count + i] = image->pixels[i * 4 + c];
    return planes;
}

static float *split_raw(const raw_image *raw) {
    linear_image image = expand_all(raw);
    float *planes = split_channels(&image);
    mem_free(image.pixels);
    return planes;
}

static bool write_exr(const picture *p, const linear_image *image) {
    const size_t count = image->width * image->height;
    const bool half = !p->options.full;
    float *planes = split_channels(image), *depth = p->depth.texels ? split_raw(&p->depth) : NULL;
    const exr_channel channels[] = {
        {"R", planes, half},
        {"G", planes + count, half},
        {"B", planes + 2 * count, half},
        {"A", planes + 3 * count, half},
        {"Z", depth, false}, // half has too few digits
    };
    bool done = exr_write_with(p->file,
                               &(exr_image){p->color.width, p->color.height, channels,
                                            COUNT_OF(channels) - (depth ? 0 : 1)},
                               p->recipe);
    mem_free(planes);
    mem_free(depth);
    return done;
}

static bool write_picture(void *user) {
    const picture *p = user;
    if (!file_make_parent_folders(p->file)) return false;
    linear_image image = expand_all(&p->color);
    bool done = p->exr ? write_exr(p, &image) : write_png(p, &image);
    mem_free(image.pixels);
    return done;
}

static void free_picture(void *user) {
    picture *p = user;
    free_raw(&p->color);
    free_raw(&p->depth);
    mem_free(p->recipe);
    arena_free(&p->memory);
    mem_free(p);
}

enum { DRAWING_OPTIONS = 4 };

// Adds the options of `roil render` that a picture depends on and its saving does not say.
static size_t describe_drawing(const roil_effect *e, uint32_t before, const char **options,
                               char texts[DRAWING_OPTIONS][48]) {
    size_t count = 0;
    snprintf(texts[0], sizeof *texts, "--reference=%u", e->owner->reference);
    snprintf(texts[1], sizeof *texts, "--warmup=%u", before);
    snprintf(texts[2], sizeof *texts, "--samples=%u", e->averaged);
    snprintf(texts[3], sizeof *texts, "--shutter=%.17g", e->shutter);
    if (e->owner->reference) options[count++] = texts[0];
    if (before) options[count++] = texts[1];
    for (int i = 2; i < DRAWING_OPTIONS && e->averaged; i++) options[count++] = texts[i];
    return count;
}

// Reads the depth of the scene for the effect's own picture, if it has the same size.
static bool take_depth(roil_effect *e, picture *p) {
    graph_image z = effect_get_picture(e->effect, EFFECT_DEPTH);
    if (!p->exr || !z.id || p->options.image) return true;
    if (!read_raw(e, z, &p->depth)) return false;
    if (p->depth.width == p->color.width && p->depth.height == p->color.height) return true;
    free_raw(&p->depth);
    return true;
}

static char *describe_picture(roil_effect *e, const roil_save_options *o) {
    char dump[128], drawing[DRAWING_OPTIONS][48];
    const char *options[7 + DRAWING_OPTIONS];
    size_t count = 0;
    if (o->alpha) options[count++] = "--alpha";
    if (o->premultiplied) options[count++] = "--premultiplied";
    if (o->sixteen) options[count++] = "--16";
    if (o->full) options[count++] = "--float";
    if (o->shown) options[count++] = "--shown";
    if (o->image && snprintf(dump, sizeof dump, "--dump-pass=%s", o->image) < (int)sizeof dump)
        options[count++] = dump;
    count += describe_drawing(e, effect_frames_before(e->effect), options + count, drawing);
    options[count] = NULL;
    return roil_describe(
        e,
        &(roil_making){
            .kind = "picture", .first = e->shown, .last = e->shown, .step = 1, .options = options});
}

static picture *take_picture(roil_effect *e, const char *file, const roil_save_options *options) {
    static const roil_save_options defaults;
    bool exr = strcmp(path_extension(file), "exr") == 0;
    if (!exr && strcmp(path_extension(file), "png") != 0)
        return ERR_NULL("%s: pictures are .png or .exr", file);
    picture *p = mem_alloc(sizeof *p);
    p->exr = exr;
    p->options = options ? *options : defaults;
    str_copy(p->file, sizeof p->file, file);
    graph_image linear = effect_get_picture(e->effect, EFFECT_LINEAR);
    graph_image image = exr && linear.id && !p->options.shown
                            ? linear
                            : effect_get_picture(e->effect, EFFECT_OUTPUT);
    if (p->options.image) image = roil_find_image(e, p->options.image);
    if (!image.id || !read_raw(e, image, &p->color) || !take_depth(e, p)) {
        free_picture(p);
        return NULL;
    }
    p->recipe = describe_picture(e, &p->options);
    if (!exr) recipe_write(e->effect, e->shown, e->width, e->height, &p->memory, p->texts);
    p->texts[RECIPE_TEXTS] = (png_text){"roil:recipe", p->recipe};
    return p;
}

bool roil_save(roil_effect *e, const char *file, const roil_save_options *options) {
    mem_enter();
    picture *p = take_picture(e, file, options);
    if (!p) return mem_leave(false);
    bool done = write_picture(p);
    free_picture(p);
    return mem_leave(done);
}

bool roil_is_whole(const char *file) {
    mem_enter();
    arena memory = {0};
    png_image png;
    exr_image exr;
    bool done = strcmp(path_extension(file), "exr") == 0 ? exr_read(file, NULL, &memory, &exr)
                                                         : png_read(file, NULL, &memory, &png);
    arena_free(&memory);
    return mem_leave(done);
}

// ---- files beside the frames ------------------------------------------------------------------

enum { MAX_THREADS = 16, QUEUED = 2 }; // of a writer; pictures that wait besides those at work

struct roil_writer {
    jobs *files;
};

static roil_writer *create_writer(void) {
    size_t threads = worker_cores() > MAX_THREADS ? MAX_THREADS : worker_cores();
    roil_writer *w = mem_alloc(sizeof *w);
    roil_srgb_fine_table(); // filled before several threads read it
    w->files = jobs_create(threads, threads + QUEUED);
    if (w->files) return w;
    mem_free(w);
    return NULL;
}

roil_writer *roil_writer_create(void) {
    RETURN_MADE(roil_writer, create_writer(), roil_writer_finish(made));
}

bool roil_writer_save(roil_writer *w, roil_effect *e, const char *file,
                      const roil_save_options *options) {
    mem_enter();
    picture *p = take_picture(e, file, options);
    // Memory that earlier pictures hold comes back once they are written.
    if (!p && jobs_wait(w->files)) p = take_picture(e, file, options);
    return mem_leave(p && jobs_add(w->files, write_picture, free_picture, p));
}

bool roil_writer_finish(roil_writer *w) {
    mem_enter();
    if (!w) return mem_leave(true);
    bool done = jobs_finish(w->files);
    mem_free(w);
    return mem_leave(done);
}

// ---- video ------------------------------------------------------------------------------------

struct roil_video {
    roil_effect *effect;
    video *video;
    bool alpha;
    jobs *frames; // encoded one after the other
    uint8_t *pixels;
    double fps, first, second, last; // frames
    size_t count;
    uint32_t before; // frames that were drawn before the first
};

typedef struct video_frame {
    roil_video *of;
    raw_image raw;
} video_frame;

static void video_free(roil_video *v) {
    mem_free(v->pixels);
    mem_free(v);
}

bool roil_is_film(const char *file) {
    return video_is_film(file);
}

static roil_video *create_video(roil_effect *e, const char *file, double fps, bool alpha) {
    if (!file_make_parent_folders(file)) return NULL;
    video *out = video_create(file, e->width, e->height, fps, alpha);
    if (!out) return NULL;
    roil_video *v = mem_alloc(sizeof *v);
    roil_srgb_fine_table(); // filled before another thread reads it
    *v = (roil_video){.effect = e,
                      .alpha = alpha,
                      .video = out,
                      .frames = jobs_create(1, 1 + QUEUED),
                      .pixels = mem_alloc((size_t)e->width * e->height * 4),
                      .fps = fps};
    if (v->frames) return v;
    video_abandon(out);
    video_free(v);
    return NULL;
}

roil_video *roil_video_create(roil_effect *e, const char *file, double fps, bool alpha) {
    RETURN_MADE(roil_video, create_video(e, file, fps, alpha), roil_video_abandon(made));
}

static bool encode_frame(void *user) {
    const video_frame *frame = user;
    linear_image image = expand_all(&frame->raw);
    encode8_dithered(&image, frame->of->alpha ? STRAIGHT : OPAQUE, 4, frame->of->pixels);
    mem_free(image.pixels);
    return video_add(frame->of->video, frame->of->pixels);
}

static void free_frame(void *user) {
    video_frame *frame = user;
    free_raw(&frame->raw);
    mem_free(frame);
}

bool roil_video_add(roil_video *v) {
    mem_enter();
    video_frame frame = {.of = v};
    bool read = read_output(v->effect, &frame.raw) ||
                (jobs_wait(v->frames) && read_output(v->effect, &frame.raw)); // as roil_writer_save
    v->last = v->effect->shown;
    if (v->count == 0) v->first = v->last;
    if (v->count == 0) v->before = effect_frames_before(v->effect->effect);
    if (v->count == 1) v->second = v->last;
    v->count++;
    return mem_leave(read &&
                     jobs_add(v->frames, encode_frame, free_frame, mem_copy(&frame, sizeof frame)));
}

// Returns the recipe of a film whose frames are evenly spaced; else NULL.
static char *describe_film(const roil_video *v) {
    const double step = v->count > 1 ? v->second - v->first : 1;
    if (!v->count || v->last != v->first + step * (double)(v->count - 1)) return NULL;
    char fps[48], drawing[DRAWING_OPTIONS][48];
    const char *options[3 + DRAWING_OPTIONS] = {fps};
    snprintf(fps, sizeof fps, "--fps=%.17g", v->fps);
    size_t count = 1 + describe_drawing(v->effect, v->before, options + 1, drawing);
    if (v->alpha) options[count++] = "--alpha";
    options[count] = NULL;
    return roil_describe(
        v->effect,
        &(roil_making){
            .kind = "film", .first = v->first, .last = v->last, .step = step, .options = options});
}

bool roil_video_finish(roil_video *v) {
    mem_enter();
    bool done = jobs_finish(v->frames);
    char *line = describe_film(v);
    if (line) video_set_comment(v->video, line);
    if (done)
        done = video_finish(v->video);
    else
        video_abandon(v->video);
    mem_free(line);
    video_free(v);
    return mem_leave(done);
}

void roil_video_abandon(roil_video *v) {
    if (!v) return;
    jobs_finish(v->frames);
    video_abandon(v->video);
    video_free(v);
}
