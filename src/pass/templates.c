// What templates of slices and of simulated air share: groups, their pictures, and what lies on the
// device.
#include "pass/templates.h"
#include "base/error.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/swap.h"
#include "pass/pass_impl.h"
#include <string.h>

// ---- groups -----------------------------------------------------------------------------------

bool template_set_add(template_set *t, void *owner, pass *group, const picture *image,
                      uint32_t count, const char *each) {
    if (t->group_count == TEMPLATE_GROUPS)
        return err_set("%s: a flow has at most %d groups of templates", group->label,
                       TEMPLATE_GROUPS);
    if (count < 1 || count > TEMPLATES_MOST - t->total)
        return err_set("%s: 'count' is %u; a flow has 1 to %d templates%s, and %u are in other "
                       "groups",
                       group->label, count, TEMPLATES_MOST, each, t->total);
    template_group *g = group->state = arena_alloc(group->host->memory, sizeof *g);
    *g = (template_group){group, owner, image, t->group_count, t->total, count};
    t->groups[t->group_count++] = g;
    t->total += count;
    return true;
}

bool template_set_each(const template_set *t, bool (*call)(pass *group)) {
    for (uint32_t i = 0; i < t->group_count; i++)
        if (!call(t->groups[i]->pass)) return false;
    return true;
}

bool template_set_has(const template_set *t, int kind, size_t word) {
    for (uint32_t i = 0; i < t->group_count; i++)
        if (pass_option(t->groups[i]->pass, kind) == word) return true;
    return false;
}

// ---- pictures ---------------------------------------------------------------------------------

static bool write_level(gpu *device, gpu_image *image, uint32_t level, const float *values,
                        size_t count) {
    uint16_t *halves = mem_alloc(count * sizeof *halves);
    for (size_t i = 0; i < count; i++) halves[i] = half_from_float(values[i]);
    bool done = gpu_image_write(device, image, level, halves, count * sizeof *halves);
    mem_free(halves);
    return done;
}

bool template_set_write_images(const template_set *t, gpu *device) {
    uint32_t side = TEMPLATE_TILE, tiles = t->group_count + t->more;
    size_t values = (size_t)tiles * TEMPLATE_TILE_VALUES;
    float *level = mem_alloc(values * sizeof *level);
    memcpy(level, t->tiles, values * sizeof *level);
    bool done = write_level(device, t->images, 0, level, values);
    for (uint32_t k = 1; k < TEMPLATE_TILE_LEVELS && done; k++, side /= 2, values /= 4) {
        for (uint32_t i = 0; i < tiles; i++) // in place: what is read lies ahead
            template_tile_half(level + i * 4 * (size_t)side * side, side,
                               level + i * (size_t)side * side);
        done = write_level(device, t->images, k, level, values / 4);
    }
    mem_free(level);
    return done;
}

bool template_set_make_images(template_set *t, gpu *device,
                              void (*fill)(const void *from, uint32_t index, float *tile),
                              const void *from) {
    const uint32_t tiles = t->group_count + t->more;
    if (t->images) return true;
    t->images = gpu_image_create(device, &(gpu_image_desc){.label = "templates",
                                                           .format = GPU_RGBA16F,
                                                           .width = TEMPLATE_TILE,
                                                           .height = TEMPLATE_TILE * tiles,
                                                           .mips = TEMPLATE_TILE_LEVELS,
                                                           .use = GPU_USE_SAMPLED});
    if (!t->images) return false;
    t->tiles = mem_alloc((size_t)tiles * TEMPLATE_TILE_VALUES * sizeof *t->tiles);
    for (uint32_t i = 0; i < t->group_count; i++)
        template_tile(t->groups[i]->image, t->tiles + (size_t)i * TEMPLATE_TILE_VALUES);
    for (uint32_t i = 0; i < t->more; i++)
        fill(from, i, t->tiles + (size_t)(t->group_count + i) * TEMPLATE_TILE_VALUES);
    return template_set_write_images(t, device);
}

// ---- instances --------------------------------------------------------------------------------

uint32_t template_tile_side(uint32_t cells, uint32_t least) {
    return least * ((cells + 32 * least - 1) / (32 * least));
}

uint64_t template_mask_bytes(const template_set *t, uint64_t tiles) {
    const uint64_t words = (t->total + 31) / 32;
    return 2 * 4 * tiles * (words ? words : 1);
}

uint64_t template_instance_bytes(const template_set *t, uint32_t rows, uint32_t sets) {
    const uint64_t total = t->total;
    return 16 * (uint64_t)rows * (total ? total : 1) * sets; // there may be none but by hand
}

void template_set_list_memory(const template_set *t, uint64_t instances, uint64_t masks,
                              budget_list *out) {
    if (!t->masks) budget_list_add(out, "tiles of templates", masks);
    if (!t->instances) budget_list_add(out, "templates", instances);
}

bool template_set_allocate(template_set *t, gpu *device, uint64_t instances, uint64_t masks) {
    t->unmarked = true;
    t->fresh = t->fresh || !t->instances;
    return gpu_buffer_make(device, &t->masks, "tiles of templates", masks) &&
           gpu_buffer_make(device, &t->instances, "templates", instances);
}

void template_set_destroy(template_set *t, gpu *device) {
    gpu_image_destroy(device, t->images);
    mem_free(t->tiles);
    gpu_buffer_destroy(device, t->instances);
    gpu_buffer_destroy(device, t->masks);
    *t = (template_set){0};
}

void template_set_begin(template_set *t, gpu *device) {
    if (t->fresh) gpu_buffer_fill(device, t->instances, 0);
    if (t->unmarked) gpu_buffer_fill(device, t->masks, 0);
    t->fresh = t->unmarked = false;
    t->parity = 1 - t->parity;
}

void template_set_exchange(template_set *a, template_set *b) {
    bool same = a->total == b->total && a->group_count == b->group_count;
    for (uint32_t i = 0; i < a->group_count && same; i++)
        same = a->groups[i]->count == b->groups[i]->count;
    if (!same) return;
    SWAP(a->instances, b->instances);
    SWAP(a->fresh, b->fresh);
}
