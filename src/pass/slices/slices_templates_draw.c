// Drawing templates: their pictures on the device, and the dispatch that puts all of them into all
// slices.
#include "base/maths.h"
#include "base/memory.h"
#include "pass/slices/slices_templates_parts.h"
#include <string.h>

static uint32_t cells_of(const slices_flow *f) {
    return gpu_get_profile(f->pass->host->device)->templates_cells;
}

// ---- building ---------------------------------------------------------------------------------

void slices_templates_define_draw(const slices_flow *f, pass_defines *out) {
    const slices_templates *t = slices_templates_of(f);
    slices_templates_define(f, out);
    pass_define_number(f->pass, out, "TEMPLATES_CELLS", cells_of(f));
    pass_define_number(f->pass, out, "HAND", t->hand.taken ? SLICES_HAND_MOST : 0);
    pass_define_flag(out, "PRESSES", slices_has_pressing(f->pass));
    pass_define_flag(out, "PUSHES", slices_has_pushing(f->pass));
}

void slices_templates_destroy_draw(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    gpu_image_destroy(f->pass->host->device, t->images);
    mem_free(t->tiles);
}

// ---- pictures ---------------------------------------------------------------------------------

static uint32_t tile_count(const slices_templates *t) {
    return t->group_count + (t->hand.taken ? SLICES_HAND_MOST : 0);
}

static bool write_level(gpu *device, gpu_image *image, uint32_t level, const float *values,
                        size_t count) {
    uint16_t *halves = mem_alloc(count * sizeof *halves);
    for (size_t i = 0; i < count; i++) halves[i] = half_from_float(values[i]);
    bool done = gpu_image_write(device, image, level, halves, count * sizeof *halves);
    mem_free(halves);
    return done;
}

static bool write_images(const slices_templates *t, gpu *device) {
    uint32_t side = SLICES_TILE, tiles = tile_count(t);
    size_t values = (size_t)tiles * SLICES_TILE_VALUES;
    float *level = mem_alloc(values * sizeof *level);
    memcpy(level, t->tiles, values * sizeof *level);
    bool done = write_level(device, t->images, 0, level, values);
    for (uint32_t k = 1; k < SLICES_TILE_LEVELS && done; k++, side /= 2, values /= 4) {
        for (uint32_t i = 0; i < tiles; i++) // in place: what is read lies ahead
            slices_tile_half(level + i * 4 * (size_t)side * side, side,
                             level + i * (size_t)side * side);
        done = write_level(device, t->images, k, level, values / 4);
    }
    mem_free(level);
    return done;
}

bool slices_templates_make_images(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    gpu *device = f->pass->host->device;
    uint32_t tiles = tile_count(t);
    if (t->images) return true;
    t->images = gpu_image_create(device, &(gpu_image_desc){.label = "templates",
                                                           .format = GPU_RGBA16F,
                                                           .width = SLICES_TILE,
                                                           .height = SLICES_TILE * tiles,
                                                           .mips = SLICES_TILE_LEVELS,
                                                           .use = GPU_USE_SAMPLED});
    if (!t->images) return false;
    t->tiles = mem_alloc((size_t)tiles * SLICES_TILE_VALUES * sizeof *t->tiles);
    for (uint32_t i = 0; i < t->group_count; i++)
        slices_tile(t->groups[i]->image, t->tiles + (size_t)i * SLICES_TILE_VALUES);
    for (uint32_t i = t->group_count; i < tiles; i++)
        slices_hand_tile(t, i - t->group_count, t->tiles + (size_t)i * SLICES_TILE_VALUES);
    return write_images(t, device);
}

// ---- a step -----------------------------------------------------------------------------------

kernel *slices_templates_use(const slices_flow *f, pass *p, size_t index) {
    const slices_templates *t = slices_templates_of(f);
    kernel *k = pass_use(p, index);
    if (!k) return NULL;
    flow_bind(f->solver, k, pass_solver_places(p, index));
    kernel_bind_buffer(k, N_Templates, t->instances);
    kernel_bind_buffer(k, N_TemplateMasks, t->masks);
    kernel_bind_image(k, N_TemplateImages, t->images);
    return k;
}

// Whether others have written what the flow is given in this step.
static bool has_sources(const slices_flow *f) {
    for (size_t i = 0; i < f->part_count; i++)
        if (!slices_is_template(f->parts[i]) && !slices_is_obstacle(f->parts[i])) return true;
    return false;
}

bool slices_templates_draw(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    const uint32_t *size = f->desc.size, cells = cells_of(f);
    gpu *device = f->pass->host->device;
    if (t->repainted && !write_images(t, device)) return false;
    t->repainted = false;
    kernel *k = slices_templates_use(f, f->pass, SLICES_DRAW);
    if (!k) return false;
    kernel_set_int(k, N_alone, !has_sources(f));
    kernel_set_int(k, N_parity, (int32_t)t->parity);
    kernel_set_float(k, N_time_step, (float)f->clock.step);
    slices_hand_set(f, k);
    return kernel_run(k, device, size[0], (size[1] + cells - 1) / cells, f->desc.count);
}
