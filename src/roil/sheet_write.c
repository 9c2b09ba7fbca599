// The files of a sheet: what each map holds becomes what engines read. A copy of the map is made
// for each file, so that the next one begins with what was seen.
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/words.h"
#include "media/exr.h"
#include "media/png.h"
#include "media/tga.h"
#include "roil/sheet.h"
#include <math.h>
#include <string.h>

enum { STEP = 4 }; // pixels that the sides of cropped cells are a multiple of

static const float THIN = 1e-3f; // opacity below which a mean is taken from around

void sheet_stem(const char *file, strbuf *out) {
    const char *extension = path_extension(file);
    size_t length = strlen(file) - strlen(extension);
    strbuf_append(out, file, length && *extension ? length - 1 : length);
}

static sheet copy_of(const sheet *s) {
    sheet copy = *s;
    size_t count = (size_t)s->columns * s->width * s->rows * s->height;
    copy.pixels = mem_copy(s->pixels, count * 4 * sizeof(float));
    return copy;
}

static size_t pixels_of(const sheet *s) {
    return (size_t)s->columns * s->width * s->rows * s->height;
}

// ---- one file ---------------------------------------------------------------------------------

static float coded(const sheet_file *f, size_t i, int c) {
    float v = f->pixels->pixels[4 * i + (size_t)c];
    if (c == 3) return f->alpha ? clampf(v, 0, 1) : 1;
    return f->srgb ? roil_srgb(v) : isfinite(v) ? clampf(v, 0, 1) : 0;
}

static bool write_bytes(const char *path, const sheet_file *f, bool tga, const png_text *made) {
    const size_t count = pixels_of(f->pixels), channels = tga || f->alpha ? 4 : 3;
    uint8_t *bytes = mem_alloc(count * channels);
    const uint32_t width = f->pixels->columns * f->pixels->width,
                   height = f->pixels->rows * f->pixels->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < channels; c++)
            bytes[i * channels + c] = (uint8_t)lrintf(coded(f, i, (int)c) * 255);
    bool done =
        tga ? tga_write(path, width, height, bytes)
            : png_write(path, &(png_image){width, height, (int)channels, 8, bytes}, made, 1);
    mem_free(bytes);
    return done;
}

static bool write_words(const char *path, const sheet_file *f, const png_text *made) {
    const size_t count = pixels_of(f->pixels), channels = f->alpha ? 4 : 3;
    uint16_t *words = mem_alloc(count * channels * sizeof *words);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < channels; c++)
            words[i * channels + c] = (uint16_t)lrintf(coded(f, i, (int)c) * 65535);
    bool done =
        png_write(path,
                  &(png_image){f->pixels->columns * f->pixels->width,
                               f->pixels->rows * f->pixels->height, (int)channels, 16, words},
                  made, 1);
    mem_free(words);
    return done;
}

static bool write_planes(const char *path, const sheet_file *f, const char *made) {
    static const char *const names[] = {"R", "G", "B", "A"};
    const size_t count = pixels_of(f->pixels);
    float *planes = mem_alloc(count * 4 * sizeof *planes);
    exr_channel channels[4];
    for (size_t c = 0; c < 4; c++) {
        for (size_t i = 0; i < count; i++) planes[c * count + i] = f->pixels->pixels[4 * i + c];
        channels[c] = (exr_channel){names[c], planes + c * count, true};
    }
    bool done = exr_write_with(path,
                               &(exr_image){f->pixels->columns * f->pixels->width,
                                            f->pixels->rows * f->pixels->height, channels,
                                            f->alpha ? 4 : 3},
                               made);
    mem_free(planes);
    return done;
}

// Writes what was asked for and adds it to `s->files`, whose entry it returns; NULL with a message.
static json_t *sheet_write(roil_sheet *s, const char *file, const char *format,
                           const sheet_file *what) {
    strbuf path = {0};
    const char *extension = strcmp(format, "png16") == 0 ? "png" : format;
    sheet_stem(file, &path);
    strbuf_add(&path, "%s.%s", what->suffix, extension);
    const char *name = strbuf_text(&path);
    char *line = sheet_recipe(s, name);
    const png_text made = {"roil:recipe", line ? line : ""};
    bool done = strcmp(format, "exr") == 0 ? write_planes(name, what, line)
                : strcmp(format, "png16") == 0
                    ? write_words(name, what, &made)
                    : write_bytes(name, what, strcmp(format, "tga") == 0, &made);
    mem_free(line);
    json_t *entry = NULL;
    if (done) {
        entry = json_object();
        json_object_set_new(entry, "map", json_string(what->what));
        json_object_set_new(entry, "file", sheet_text(path_name(name)));
        json_object_set_new(
            entry, "encoding",
            json_string(what->srgb && strcmp(format, "exr") != 0 ? "srgb" : "linear"));
        json_array_append_new(s->files, entry);
        strbuf_add(&s->summary, "%s%s", s->summary.length ? ", " : "", name);
    }
    strbuf_free(&path);
    return entry;
}

// ---- maps -------------------------------------------------------------------------------------

typedef struct job {
    roil_sheet *s;
    const char *file, *format;
    const roil_sheet_options *options;
    const sheet_engine *engine;
    bool floats; // of the format: values as they are
} job;

static float greatest(const sheet *s, int channels) {
    float most = 0;
    for (size_t i = 0; i < pixels_of(s); i++)
        for (int c = 0; c < channels; c++) most = fmaxf(most, fabsf(s->pixels[4 * i + (size_t)c]));
    return most > 0 ? most : 1;
}

static void scale_by(sheet *s, float factor, float offset, int channels) {
    for (size_t i = 0; i < pixels_of(s); i++)
        for (int c = 0; c < channels; c++)
            s->pixels[4 * i + (size_t)c] = s->pixels[4 * i + (size_t)c] * factor + offset;
}

static void set_real(json_t *entry, const char *key, float value) {
    json_object_set_new(entry, key, json_real((double)value));
}

static bool write_color(const job *j, const sheet *map, const char *what, const char *suffix,
                        bool straight) {
    sheet copy = copy_of(map);
    const bool shown = strcmp(what, "color") == 0;
    if (straight) {
        sheet_unpremultiply(&copy);
        sheet_fill(&copy, THIN);
    }
    const float scale = shown || j->floats ? 1 : greatest(&copy, 3);
    if (scale != 1) scale_by(&copy, 1 / scale, 0, 3);
    json_t *entry = sheet_write(
        j->s, j->file, j->format,
        &(sheet_file){
            .suffix = suffix, .what = what, .pixels = &copy, .srgb = !j->floats, .alpha = true});
    if (entry) {
        json_object_set_new(entry, "alpha", json_string(straight ? "straight" : "premultiplied"));
        set_real(entry, "scale", scale);
    }
    sheet_free(&copy);
    return entry;
}

static bool write_colors(const job *j) {
    static const struct {
        sheet_map map;
        const char *what, *suffix, *straight;
    } rows[] = {{SHEET_SHOWN, "color", "", "-straight"},
                {SHEET_SCENE, "scene", "-scene", "-scene-straight"}};
    const char *alpha = j->options->alpha ? j->options->alpha : j->engine->alpha;
    const bool both = strcmp(alpha, "both") == 0, straight = strcmp(alpha, "straight") == 0;
    if (!both && !straight && strcmp(alpha, "premultiplied") != 0)
        return err_set("alpha '%s'; accepted: premultiplied, straight, both", alpha);
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        const sheet *map = &j->s->maps[rows[i].map];
        const char *suffix =
            rows[i].map == SHEET_SCENE && !j->s->maps[SHEET_SHOWN].pixels ? "" : rows[i].suffix;
        if (!map->pixels) continue;
        if (!straight && !write_color(j, map, rows[i].what, suffix, false)) return false;
        if ((straight || both) &&
            !write_color(j, map, rows[i].what, both ? rows[i].straight : suffix, true))
            return false;
    }
    return true;
}

// From heights of the picture a second to cells a step, with the engine's signs.
static bool write_motion(const job *j) {
    sheet copy = copy_of(&j->s->maps[SHEET_MOTION]);
    const float across = (float)j->s->cell / (float)copy.width,
                down = (float)j->s->cell / (float)copy.height;
    const float step = 1 / (float)j->options->fps;
    sheet_unpremultiply(&copy);
    sheet_fill(&copy, THIN);
    for (size_t i = 0; i < pixels_of(&copy); i++) {
        float *p = copy.pixels + 4 * i;
        p[0] *= across * step * j->engine->motion_right;
        p[1] *= down * step * j->engine->motion_up;
        p[2] = 0;
    }
    const float scale = j->floats ? 1 : greatest(&copy, 2);
    if (!j->floats) scale_by(&copy, 0.5f / scale, 0.5f, 2);
    json_t *entry =
        sheet_write(j->s, j->file, j->format,
                    &(sheet_file){.suffix = "-motion", .what = "motion", .pixels = &copy});
    if (entry) {
        set_real(entry, "scale", scale);
        json_object_set_new(entry, "unit", json_string("cells a frame of the sheet"));
        json_object_set_new(
            entry, "from",
            json_string(j->s->passes.moves ? "the medium" : "optical flow of the colours"));
        json_object_set_new(entry, "red",
                            json_string(j->engine->motion_right > 0 ? "right" : "left"));
        json_object_set_new(entry, "green", json_string(j->engine->motion_up > 0 ? "up" : "down"));
        json_object_set_new(entry, "decode",
                            json_string(j->floats ? "value" : "(value * 2 - 1) * scale"));
    }
    sheet_free(&copy);
    return entry;
}

static float luminance(const float *p) {
    return 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
}

static bool write_rig(const job *j, sheet_map map, const char *suffix, float scale, float glow) {
    sheet copy = copy_of(&j->s->maps[map]);
    const sheet *emission = &j->s->maps[SHEET_EMISSION];
    const bool first = map == SHEET_RIGHT_TOP_BACK;
    scale_by(&copy, 1 / scale, 0, 3);
    for (size_t i = 0; !first && i < pixels_of(&copy); i++)
        copy.pixels[4 * i + 3] = luminance(emission->pixels + 4 * i) / glow;
    json_t *entry = sheet_write(
        j->s, j->file, j->format,
        &(sheet_file){.suffix = suffix, .what = suffix + 1, .pixels = &copy, .alpha = true});
    if (entry) {
        set_real(entry, "scale", scale);
        json_object_set_new(entry, "alpha", json_string(first ? "opacity" : "emission"));
        if (!first) set_real(entry, "emission_scale", glow);
    }
    sheet_free(&copy);
    return entry;
}

// All six lights have one scale, 1 unless something is brighter: a white wall would be 1.
static bool write_six(const job *j) {
    const sheet *a = &j->s->maps[SHEET_RIGHT_TOP_BACK], *b = &j->s->maps[SHEET_LEFT_BOTTOM_FRONT];
    const float most = fmaxf(greatest(a, 3), greatest(b, 3));
    const float glow = j->floats ? 1 : greatest(&j->s->maps[SHEET_EMISSION], 3);
    const float scale = !j->floats && most > 1 ? most : 1;
    if (!write_rig(j, SHEET_RIGHT_TOP_BACK, "-right-top-back", scale, glow) ||
        !write_rig(j, SHEET_LEFT_BOTTOM_FRONT, "-left-bottom-front", scale, glow))
        return false;
    sheet copy = copy_of(&j->s->maps[SHEET_EMISSION]);
    scale_by(&copy, 1 / glow, 0, 3);
    json_t *entry = sheet_write(j->s, j->file, j->format,
                                &(sheet_file){.suffix = "-emission",
                                              .what = "emission",
                                              .pixels = &copy,
                                              .srgb = !j->floats,
                                              .alpha = true});
    if (entry) set_real(entry, "scale", glow);
    sheet_free(&copy);
    return entry;
}

static bool write_normal(const job *j) {
    sheet copy = copy_of(&j->s->maps[SHEET_NORMAL]);
    sheet_unpremultiply(&copy);
    sheet_fill(&copy, THIN);
    for (size_t i = 0; i < pixels_of(&copy); i++) {
        float *p = copy.pixels + 4 * i;
        float length = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        for (int c = 0; c < 3; c++) p[c] = length > 1e-6f ? p[c] / length : c == 2;
        p[1] *= j->engine->normal_up;
    }
    if (!j->floats) scale_by(&copy, 0.5f, 0.5f, 3);
    json_t *entry =
        sheet_write(j->s, j->file, j->format,
                    &(sheet_file){.suffix = "-normal", .what = "normal", .pixels = &copy});
    if (entry) {
        json_object_set_new(entry, "green", json_string(j->engine->normal_up > 0 ? "up" : "down"));
        json_object_set_new(entry, "decode", json_string(j->floats ? "value" : "value * 2 - 1"));
    }
    sheet_free(&copy);
    return entry;
}

// A channel of the means, `offset` minus it times `sign`, grey.
static bool write_grey(const job *j, int channel, float offset, float sign, bool centred,
                       const char *suffix, const char *unit) {
    sheet copy = copy_of(&j->s->maps[SHEET_HEAT]);
    sheet_unpremultiply(&copy);
    sheet_fill(&copy, THIN);
    for (size_t i = 0; i < pixels_of(&copy); i++) {
        float *p = copy.pixels + 4 * i, v = offset + sign * p[channel];
        p[0] = p[1] = p[2] = v;
    }
    const float scale = j->floats ? 1 : greatest(&copy, 1);
    if (!j->floats) scale_by(&copy, (centred ? 0.5f : 1) / scale, centred ? 0.5f : 0, 3);
    json_t *entry =
        sheet_write(j->s, j->file, j->format,
                    &(sheet_file){.suffix = suffix, .what = suffix + 1, .pixels = &copy});
    if (entry) {
        set_real(entry, "scale", scale);
        json_object_set_new(entry, "unit", json_string(unit));
        json_object_set_new(entry, "decode",
                            json_string(j->floats ? "value"
                                        : centred ? "(value * 2 - 1) * scale"
                                                  : "value * scale"));
    }
    sheet_free(&copy);
    return entry;
}

// ---- all of them ------------------------------------------------------------------------------

static sheet_area used_area(const roil_sheet *s) {
    sheet_area all = {s->cell, s->cell, 0, 0};
    for (int i = 0; i < SHEET_MAPS; i++) {
        const sheet *map = &s->maps[i];
        if (!map->pixels || i == SHEET_MOTION || i == SHEET_NORMAL || i == SHEET_HEAT) continue;
        sheet_area used = sheet_find_used(map, SHEET_LEAST, 4);
        if (used.left < all.left) all.left = used.left;
        if (used.top < all.top) all.top = used.top;
        if (used.right > all.right) all.right = used.right;
        if (used.bottom > all.bottom) all.bottom = used.bottom;
    }
    return all;
}

// With the gutter around it, and sides that are a multiple of a few pixels.
static void widen(uint32_t *from, uint32_t *to, uint32_t gutter, uint32_t cell) {
    uint32_t low = *from > gutter ? *from - gutter : 0,
             high = *to + gutter < cell ? *to + gutter : cell;
    uint32_t side = (high - low + STEP - 1) / STEP * STEP;
    if (side > cell) side = cell;
    if (low + side > cell) low = cell - side;
    *from = low;
    *to = low + side;
}

static bool find_area(roil_sheet *s, bool crop) {
    sheet_area used = used_area(s);
    const uint32_t inner = s->cell - s->gutter;
    s->area = (sheet_area){0, 0, s->cell, s->cell};
    if (used.left >= used.right) {
        log_write(LOG_WARNING, "the sheet is empty: nothing of the medium of '%s' is seen",
                  s->passes.source);
        return true;
    }
    if (s->gutter && (used.left < s->gutter || used.top < s->gutter || used.right > inner ||
                      used.bottom > inner))
        log_write(LOG_WARNING, "the medium reaches into the gutter of %u pixels", s->gutter);
    if (!crop) return true;
    s->area = used;
    widen(&s->area.left, &s->area.right, s->gutter, s->cell);
    widen(&s->area.top, &s->area.bottom, s->gutter, s->cell);
    for (int i = 0; i < SHEET_MAPS; i++)
        if (s->maps[i].pixels) sheet_crop(&s->maps[i], s->area);
    return true;
}

static const char *format_of(const char *file, const char *asked) {
    const char *format = asked ? asked : path_extension(file);
    static const char *const names[] = {"png", "png16", "exr", "tga"};
    int found = words_find(names, COUNT_OF(names), format);
    if (found >= 0) return names[found];
    if (asked)
        err_set("format '%s'; accepted: png, png16, exr, tga", asked);
    else
        err_set("output '%s'; accepted: .png, .exr, .tga", file);
    return NULL;
}

bool sheet_write_all(roil_sheet *s, const char *file, const roil_sheet_options *options,
                     const sheet_engine *engine) {
    const char *format = format_of(file, options->format);
    if (!format) return false;
    if (options->page && strncmp(format, "png", 3) != 0)
        return err_set("%s: browsers read no .%s; a page needs a .png", options->page, format);
    if (!(options->fps > 0)) return err_set("%g cells a second; accepted: above 0", options->fps);
    const job j = {s, file, format, options, engine, strcmp(format, "exr") == 0};
    return file_make_parent_folders(file) && find_area(s, options->crop) && write_colors(&j) &&
           (!s->maps[SHEET_MOTION].pixels || write_motion(&j)) &&
           (!s->maps[SHEET_RIGHT_TOP_BACK].pixels || write_six(&j)) &&
           (!s->maps[SHEET_NORMAL].pixels || write_normal(&j)) &&
           (!s->depth || write_grey(&j, 1, s->distance, -1, true, "-depth",
                                    "m towards the camera, from the plane of the pivot")) &&
           (!s->temperature || write_grey(&j, 0, 0, 1, false, "-temperature", "K"));
}
