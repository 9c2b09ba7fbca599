// Panoramas. The file is decoded in a child process, for it may be a stranger's; this side checks
// what comes back.
#include "scene/sky_image.h"
#include "base/error.h"
#include "base/file.h"
#include "base/maths.h"
#include "base/memory.h"
#include "media/exr.h"
#include "media/isolate.h"
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

typedef struct decoded { // what the child sends, before the picture
    uint32_t width, height;
} decoded;

static const float *find_channel(const exr_image *image, const char *name) {
    for (size_t c = 0; c < image->channel_count; c++)
        if (strcmp(image->channels[c].name, name) == 0) return image->channels[c].values;
    return NULL;
}

static bool fits(const char *path, uint32_t width, uint32_t height) {
    if (width >= 1 && height >= 1 && width <= SKY_WIDTH_MAX && height <= SKY_HEIGHT_MAX)
        return true;
    return err_set("%s: panorama of %ux%u; up to %dx%d is accepted", path, width, height,
                   SKY_WIDTH_MAX, SKY_HEIGHT_MAX);
}

// In the child. Rows from the top, red, green and blue; of a grey picture three times the same.
static bool decode(void *user, int out) {
    static const char *const names[3] = {"R", "G", "B"};
    const char *path = user;
    arena memory = {0};
    exr_image image;
    const float *planes[3];
    if (!exr_read(path, &memory, &image) || !fits(path, image.width, image.height)) return false;
    for (int c = 0; c < 3; c++) {
        planes[c] = find_channel(&image, names[c]);
        if (!planes[c]) planes[c] = find_channel(&image, "Y");
        if (!planes[c])
            return err_set("%s: the picture has no channel '%s'; R, G and B, or Y are accepted",
                           path, names[c]);
    }
    size_t count = (size_t)image.width * image.height;
    float *rgb = arena_alloc(&memory, 3 * count * sizeof *rgb);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) rgb[3 * i + c] = planes[c][i];
    decoded head = {image.width, image.height};
    return isolate_put(out, &head, sizeof head) && isolate_put(out, rgb, 3 * count * sizeof *rgb);
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

// In `data`, which is the child's.
static bool read_panorama(const char *path, void **data, panorama *out) {
    size_t size;
    if (!isolate_run(&(isolate_job){.name = path, .work = decode, .user = (void *)(uintptr_t)path},
                     data, &size))
        return false;
    decoded head = {0};
    if (size >= sizeof head) memcpy(&head, *data, sizeof head);
    *out = (panorama){head.width, head.height, (float *)((char *)*data + sizeof head)};
    size_t texels = (size_t)head.width * head.height;
    bool whole = fits(path, head.width, head.height) &&
                 (size == sizeof head + 3 * texels * sizeof *out->rgb ||
                  err_set("%s: damaged: its reader returned nonsense", path));
    if (whole && check_values(path, out)) return true;
    mem_free(*data);
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
    void *data;
    panorama image;
    if (!path_require_inside(root, path) || !read_panorama(path, &data, &image)) return NULL;
    sky_content *content = arena_alloc(memory, sizeof *content);
    make_levels(content, &image, memory);
    sky_table_fill(&image, &content->table);
    mem_free(data);
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

static bool upload_texture(sky_image *s, gpu *g) {
    const sky_content *content = s->content;
    s->texture = gpu_image_create(g, &(gpu_image_desc){
                                         .label = "sky",
                                         .format = GPU_RGBA16F,
                                         .width = content->levels[0].width,
                                         .height = content->levels[0].height,
                                         .mips = content->level_count,
                                         .use = GPU_USE_SAMPLED,
                                     });
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
    sky_image own = *s;
    *s = *other;
    *other = own;
    return true;
}

gpu_image *sky_image_texture(const sky_image *s) {
    return s->texture;
}

gpu_image *sky_image_distribution(const sky_image *s) {
    return s->distribution;
}
