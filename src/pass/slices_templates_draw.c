// Drawing templates: their pictures on the device, and the dispatch that puts all of them into all
// slices.
#include "base/maths.h"
#include "base/memory.h"
#include "pass/slices_templates_parts.h"
#include <string.h>

static const char shader[] = "pass/slices/templates_draw.comp";

// Cells above each other that a thread draws: more look at each template less often, fewer wait for
// fewer pictures one after the other. The second is for a processor.
enum { CELLS = 1, SOFTWARE_CELLS = 4 };

static uint32_t cells_of(const slices_flow *f) {
    gpu *device = f->pass->host->device;
    return device && gpu_get_info(device)->kind == GPU_CPU ? SOFTWARE_CELLS : CELLS;
}

// ---- building ---------------------------------------------------------------------------------

bool slices_templates_compile_draw(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    arena *memory = f->pass->host->memory;
    shader_define defines[FLOW_MAX_DEFINES + SLICES_TEMPLATES_DEFINES + 5];
    size_t count = flow_defines(f->solver, defines);
    count += slices_templates_defines(f, defines + count);
    int hand = t->hand.taken ? SLICES_HAND_MOST : 0;
    defines[count++] = (shader_define){"TEMPLATES_CELLS", arena_format(memory, "%u", cells_of(f))};
    defines[count++] = (shader_define){"HAND", arena_format(memory, "%d", hand)};
    defines[count++] = (shader_define){"PRESSES", slices_has_pressing(f->pass) ? "1" : "0"};
    defines[count++] = (shader_define){"PUSHES", slices_has_pushing(f->pass) ? "1" : "0"};
    defines[count++] = (shader_define){"WITHOUT_FIELDS", ""};
    return pass_compile(f->pass, shader, SHADER_COMPUTE, defines, count, &t->draw);
}

bool slices_templates_build_draw(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    if (!slices_templates_compile_draw(f)) return false;
    t->block = arena_alloc(f->pass->host->memory, pass_block_size(&t->draw) + 16);
    t->pipeline = pass_create_compute(f->pass, &t->draw);
    return t->pipeline != NULL;
}

void slices_templates_destroy_draw(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    gpu *device = f->pass->host->device;
    if (t->pipeline) gpu_pipeline_destroy(device, t->pipeline);
    gpu_image_destroy(device, t->images);
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

static size_t override(const slices_flow *f, const shader_binary *binary,
                       pass_override out[GPU_MAX_SLOTS]) {
    const slices_templates *t = slices_templates_of(f);
    size_t count = 0;
    for (size_t i = 0; i < binary->slot_count; i++) {
        const char *name = binary->slots[i].name;
        gpu_binding *binding = &out[count].binding;
        *binding = (gpu_binding){0};
        if (strcmp(name, "Templates") == 0)
            binding->buffer = t->instances;
        else if (strcmp(name, "TemplateMasks") == 0)
            binding->buffer = t->masks;
        else if (strcmp(name, "TemplateImages") == 0)
            *binding = (gpu_binding){.image = t->images, .sampler = GPU_LINEAR_CLAMP};
        else
            flow_bind(f->solver, name, binding);
        out[count].name = name;
        count += binding->buffer || binding->image;
    }
    return count;
}

bool slices_templates_dispatch(const slices_flow *f, pass *p, const shader_binary *binary,
                               const unsigned char *block, gpu_dispatch_desc *desc) {
    pass_override overrides[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS];
    size_t count = override(f, binary, overrides);
    desc->bindings = bindings;
    return pass_bind(p, binary, block, overrides, count, bindings, &desc->binding_count) &&
           gpu_dispatch(p->host->device, desc);
}

// Whether others have written what the flow is given in this step.
static bool has_sources(const slices_flow *f) {
    for (size_t i = 0; i < f->part_count; i++)
        if (pass_is(f->parts[i], "slices_inflow") || pass_is(f->parts[i], "slices_force"))
            return true;
    return false;
}

bool slices_templates_draw(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    const uint32_t *size = f->desc.size, cells = cells_of(f), alone = !has_sources(f);
    const float step = (float)f->clock.step;
    if (t->repainted && !write_images(t, f->pass->host->device)) return false;
    t->repainted = false;
    pass_write_member(&t->draw, t->block, "alone", &alone, sizeof alone);
    pass_write_member(&t->draw, t->block, "parity", &t->parity, sizeof t->parity);
    pass_write_member(&t->draw, t->block, "time_step", &step, sizeof step);
    slices_hand_fill(f, &t->draw, t->block);
    gpu_dispatch_desc desc = {.pipeline = t->pipeline,
                              .threads = {size[0], (size[1] + cells - 1) / cells, f->desc.count}};
    return slices_templates_dispatch(f, f->pass, &t->draw, t->block, &desc);
}
