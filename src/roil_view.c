// The shaders of windows, and images that they share.
#include "roil_view.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "pass/blue_noise.h"
#include <assert.h>
#include <string.h>

static gpu_image *make_image(gpu *g, const char *label, gpu_format format, uint32_t width,
                             uint32_t height, const void *texels) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = label,
                                                             .format = format,
                                                             .width = width,
                                                             .height = height,
                                                             .use = GPU_USE_SAMPLED});
    size_t size = (size_t)width * height * gpu_format_size(format);
    if (image && gpu_image_write(g, image, 0, texels, size)) return image;
    gpu_image_destroy(g, image);
    return NULL;
}

static gpu_image *make_fine_table(gpu *g) {
    const uint16_t *table = roil_srgb_fine_table();
    float values[ROIL_SRGB_STEPS + 1];
    for (int i = 0; i <= ROIL_SRGB_STEPS; i++) values[i] = (float)table[i] / ROIL_SRGB_FINE;
    return make_image(g, "srgb, fine", GPU_R32F, COUNT_OF(values), 1, values);
}

// The channels of a pixel side by side, for one fetch.
static gpu_image *make_noise(gpu *g) {
    const uint32_t side = BLUE_NOISE_SIZE;
    uint8_t texels[BLUE_NOISE_SIZE * BLUE_NOISE_SIZE][4] = {{0}};
    for (uint32_t i = 0; i < side * side; i++)
        for (int c = 0; c < 3; c++) texels[i][c] = roil_dither_noise(i % side, i / side, c);
    return make_image(g, "noise", GPU_RGBA8, side, side, texels);
}

static bool fill(roil *r, view *v) {
    static const uint8_t white[4] = {255, 255, 255, 255};
    char cache[PATH_CAP];
    bool cached = r->cache && path_join(cache, r->cache, "spirv");
    v->library = shader_library_create(
        &(shader_library_desc){.shader_root = r->shaders, .cache_dir = cached ? cache : NULL});
    if (!v->library) return false;
    v->srgb = make_image(r->device, "srgb", GPU_R8, ROIL_SRGB_STEPS + 1, 1, roil_srgb_table());
    v->srgb_fine = make_fine_table(r->device);
    v->noise = make_noise(r->device);
    v->white = make_image(r->device, "white", GPU_RGBA8, 1, 1, white);
    return v->srgb && v->srgb_fine && v->noise && v->white;
}

view *view_get(roil *r) {
    if (r->view) return r->view;
    if (!r->device) {
        err_set("no device: nothing can be shown");
        return NULL;
    }
    r->view = mem_alloc(sizeof *r->view);
    if (!fill(r, r->view)) roil_free_view(r);
    return r->view;
}

void roil_free_view(roil *r) {
    view *v = r->view;
    if (!v) return;
    gpu_image *images[] = {v->srgb, v->srgb_fine, v->noise, v->white, v->canvas, v->probe.texel};
    gpu_buffer *buffers[] = {v->vertices, v->indices, v->probe.readback};
    view_shader *shaders[] = {&v->compose,       &v->overlay,       &v->slices,
                              &v->inspect[0][0], &v->inspect[0][1], &v->inspect[1][0],
                              &v->inspect[1][1]};
    for (size_t i = 0; i < COUNT_OF(images); i++) gpu_image_destroy(r->device, images[i]);
    for (size_t i = 0; i < COUNT_OF(buffers); i++) gpu_buffer_destroy(r->device, buffers[i]);
    for (size_t i = 0; i < COUNT_OF(shaders); i++)
        gpu_pipeline_destroy(r->device, shaders[i]->pipeline);
    shader_library_destroy(v->library);
    arena_free(&v->memory);
    mem_free(v);
    r->view = NULL;
}

// ---- pipelines --------------------------------------------------------------------------------

static void add_slots(view_shader *s, const shader_binary *binary, gpu_slot *slots) {
    for (size_t i = 0; i < binary->slot_count; i++) {
        assert(s->slot_count < VIEW_MAX_SLOTS);
        slots[s->slot_count] = binary->slots[i].slot;
        s->names[s->slot_count] = binary->slots[i].name;
        s->bindings[s->slot_count++] = binary->slots[i].slot.binding;
    }
}

bool view_make_compute(roil *r, view_shader *s, const char *file, const shader_define *defines,
                       size_t define_count) {
    view *v = r->view;
    shader_binary binary;
    gpu_slot slots[VIEW_MAX_SLOTS];
    if (s->pipeline) return true;
    s->slot_count = 0;
    if (!shader_compile(v->library, &v->memory,
                        &(shader_compile_desc){.name = file,
                                               .stage = SHADER_COMPUTE,
                                               .defines = defines,
                                               .define_count = define_count},
                        &binary))
        return false;
    add_slots(s, &binary, slots);
    gpu_compute_desc desc = {.label = file,
                             .code = binary.code,
                             .code_size = binary.size,
                             .slots = slots,
                             .slot_count = s->slot_count};
    memcpy(desc.local_size, binary.local_size, sizeof desc.local_size);
    s->pipeline = gpu_pipeline_create_compute(r->device, &desc);
    return s->pipeline != NULL;
}

bool view_make_overlay(roil *r, view_shader *s, const char *file) {
    view *v = r->view;
    shader_binary vertex, fragment;
    gpu_slot slots[VIEW_MAX_SLOTS];
    if (s->pipeline) return true;
    s->slot_count = 0;
    shader_compile_desc first = {.name = arena_format(&v->memory, "%s.vert", file),
                                 .stage = SHADER_VERTEX};
    shader_compile_desc second = {.name = arena_format(&v->memory, "%s.frag", file),
                                  .stage = SHADER_FRAGMENT};
    if (!shader_compile(v->library, &v->memory, &first, &vertex) ||
        !shader_compile(v->library, &v->memory, &second, &fragment))
        return false;
    add_slots(s, &vertex, slots);
    add_slots(s, &fragment, slots);
    s->pipeline =
        gpu_pipeline_create_graphics(r->device, &(gpu_graphics_desc){.label = file,
                                                                     .vertex_code = vertex.code,
                                                                     .vertex_size = vertex.size,
                                                                     .fragment_code = fragment.code,
                                                                     .fragment_size = fragment.size,
                                                                     .slots = slots,
                                                                     .slot_count = s->slot_count,
                                                                     .colors = {GPU_RGBA8},
                                                                     .blend = true});
    return s->pipeline != NULL;
}

size_t view_bind(const view_shader *s, const view_value *values, size_t count,
                 gpu_binding out[VIEW_MAX_SLOTS]) {
    for (size_t i = 0; i < s->slot_count; i++) {
        size_t k = 0;
        while (k < count && strcmp(values[k].name, s->names[i]) != 0) k++;
        assert(k < count);
        out[i] = values[k].binding;
        out[i].binding = s->bindings[i];
    }
    return s->slot_count;
}
