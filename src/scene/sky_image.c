// Panoramas of the sky. The reader decodes the file, since it may be a stranger's; this side checks
// the result.
#include "scene/sky_image.h"
#include "base/error.h"
#include "base/file.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/swap.h"
#include "media/exr.h"
#include "scene/sky_table.h"
#include <math.h>
#include <string.h>

enum { LEVELS_MAX = 14 };
static const float half_max = 65504, half_min = 6e-8f;

typedef struct sky_level {
    uint32_t width, height;
    uint16_t *texels; // rgba
} sky_level;

typedef struct sky_content {
    sky_level levels[LEVELS_MAX];
    uint32_t level_count;
    sky_table table;
} sky_content;

struct sky_image {
    const sky_content *content;
    gpu_image *texture, *distribution;
};

// ---- reading ----------------------------------------------------------------------------------

// Finds red, green and blue; a grey picture gives its channel three times.
static bool find_planes(const char *path, const exr_image *image, const float *planes[3]) {
    static const char *const names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) {
        planes[c] = exr_find(image, names[c]);
        if (!planes[c]) planes[c] = exr_find(image, "Y");
        if (!planes[c])
            return err_set("%s: the picture has no channel '%s'; R, G and B, or Y are accepted",
                           path, names[c]);
    }
    return true;
}

static bool check_values(const char *path, const panorama *image) {
    bool light = false;
    size_t count = 3 * (size_t)image->width * image->height;
    for (size_t i = 0; i < count; i++) {
        float *value = &image->rgb[i];
        if (!(isfinite(*value) && *value >= 0))
            return err_set("%s: the panorama holds %g at %zu, %zu; finite numbers from 0 are "
                           "accepted",
                           path, (double)*value, i / 3 % image->width, i / 3 / image->width);
        if (*value > half_max) *value = half_max;
        light = light || *value >= half_min;
    }
    return light || err_set("%s: the panorama is all black", path);
}

// Reads rows from the top. Free the numbers with mem_free.
static bool read_panorama(const char *root, const char *path, panorama *out) {
    enum { CHANNELS = 5 }; // R, G, B, Y, and a place for all others
    static const exr_wish wish = {
        "RGBY",
        {SKY_WIDTH_MAX, SKY_HEIGHT_MAX, CHANNELS * sizeof(float) * SKY_WIDTH_MAX * SKY_HEIGHT_MAX}};
    arena scratch = {0};
    exr_image image;
    const float *planes[3];
    bool done =
        exr_read_inside(root, path, &wish, &scratch, &image) && find_planes(path, &image, planes);
    if (done) {
        size_t count = (size_t)image.width * image.height;
        *out = (panorama){image.width, image.height, mem_alloc(3 * count * sizeof *out->rgb)};
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < 3; c++) out->rgb[3 * i + c] = planes[c][i];
    }
    arena_free(&scratch);
    if (!done || check_values(path, out)) return done;
    mem_free(out->rgb);
    return false;
}

// ---- levels -----------------------------------------------------------------------------------

static void add_level(sky_content *s, const panorama *image, arena *memory) {
    sky_level *level = &s->levels[s->level_count++];
    size_t count = (size_t)image->width * image->height;
    *level = (sky_level){image->width, image->height,
                         arena_alloc(memory, 4 * count * sizeof *level->texels)};
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < 3; c++)
            level->texels[4 * i + c] = half_from_float(image->rgb[3 * i + c]);
        level->texels[4 * i + 3] = half_from_float(1);
    }
}

static void make_levels(sky_content *s, const panorama *image, arena *memory) {
    arena coarse = {0};
    panorama level = *image;
    add_level(s, &level, memory);
    while (level.width > 1 || level.height > 1) {
        uint32_t width = level.width > 1 ? level.width / 2 : 1;
        uint32_t height = level.height > 1 ? level.height / 2 : 1;
        level = panorama_resize(&level, width, height, &coarse);
        add_level(s, &level, memory);
    }
    arena_free(&coarse);
}

sky_image *sky_image_load(const char *path, const char *root, arena *memory) {
    panorama image;
    if (!path_require_inside(root, path) || !read_panorama(root, path, &image)) return NULL;
    sky_content *content = arena_alloc(memory, sizeof *content);
    make_levels(content, &image, memory);
    sky_table_fill(&image, &content->table);
    mem_free(image.rgb);
    sky_image *s = arena_alloc(memory, sizeof *s);
    s->content = content;
    return s;
}

sky_image *sky_image_share(const sky_image *s, arena *memory) {
    sky_image *other = arena_alloc(memory, sizeof *other);
    other->content = s->content;
    return other;
}

void sky_image_means(const sky_image *s, float zenith[3], float horizon[3]) {
    memcpy(zenith, s->content->table.zenith, sizeof s->content->table.zenith);
    memcpy(horizon, s->content->table.horizon, sizeof s->content->table.horizon);
}

// ---- on the device ----------------------------------------------------------------------------

static gpu_image_desc describe_texture(const sky_image *s) {
    const sky_content *content = s->content;
    return (gpu_image_desc){
        .label = "sky",
        .format = GPU_RGBA16F,
        .width = content->levels[0].width,
        .height = content->levels[0].height,
        .mips = content->level_count,
        .use = GPU_USE_SAMPLED,
    };
}

void sky_image_list_memory(const sky_image *s, budget_list *out) {
    const gpu_image_desc desc = describe_texture(s);
    if (!s->texture) budget_list_add(out, desc.label, gpu_image_bytes(&desc));
}

static bool upload_texture(sky_image *s, gpu *g) {
    const sky_content *content = s->content;
    const gpu_image_desc desc = describe_texture(s);
    s->texture = gpu_image_create(g, &desc);
    bool done = s->texture != NULL;
    for (uint32_t i = 0; done && i < content->level_count; i++) {
        const sky_level *level = &content->levels[i];
        size_t size = 4 * (size_t)level->width * level->height * sizeof *level->texels;
        done = gpu_image_write(g, s->texture, i, level->texels, size);
    }
    return done;
}

static bool upload_distribution(sky_image *s, gpu *g) {
    const sky_table *table = &s->content->table;
    s->distribution = gpu_image_create(g, &(gpu_image_desc){
                                              .label = "light of the sky",
                                              .format = GPU_R32F,
                                              .width = SKY_TABLE_X,
                                              .height = SKY_TABLE_Y,
                                              .use = GPU_USE_SAMPLED,
                                          });
    return s->distribution &&
           gpu_image_write(g, s->distribution, 0, table->values, sizeof table->values);
}

bool sky_image_upload(sky_image *s, gpu *g) {
    if (s->texture) return true;
    if (upload_texture(s, g) && upload_distribution(s, g)) return true;
    sky_image_destroy(s, g);
    return false;
}

void sky_image_destroy(sky_image *s, gpu *g) {
    gpu_image_destroy(g, s->texture);
    gpu_image_destroy(g, s->distribution);
    s->texture = s->distribution = NULL;
}

bool sky_image_exchange(sky_image *s, sky_image *other) {
    if (s->content != other->content) return false;
    SWAP(*s, *other);
    return true;
}

gpu_image *sky_image_texture(const sky_image *s) {
    return s->texture;
}

gpu_image *sky_image_distribution(const sky_image *s) {
    return s->distribution;
}
