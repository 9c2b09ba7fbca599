// The kernels that draw windows, and images that they share.
#include "roil/view.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "pass/blue_noise.h"

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

// Stores the noise of all channels of a pixel in one texel, so that one fetch reads it.
static gpu_image *make_noise(gpu *g) {
    const uint32_t side = BLUE_NOISE_SIZE;
    uint8_t texels[BLUE_NOISE_SIZE * BLUE_NOISE_SIZE][4] = {{0}};
    for (uint32_t i = 0; i < side * side; i++)
        for (int c = 0; c < 3; c++) texels[i][c] = roil_dither_noise(i % side, i / side, c);
    return make_image(g, "noise", GPU_RGBA8, side, side, texels);
}

static bool view_fill(roil *r, view *v) {
    static const uint8_t white[4] = {255, 255, 255, 255};
    char cache[PATH_CAP];
    bool cached = r->cache && path_join(cache, r->cache, "spirv");
    v->library = shader_library_create(
        &(shader_library_desc){.shader_root = r->shaders, .cache_dir = cached ? cache : NULL});
    if (!v->library) return false;
    v->srgb = make_image(r->device, "srgb", GPU_R8, ROIL_SRGB_STEPS + 1, 1, roil_srgb_table());
    v->srgb_fine = make_fine_table(r->shown);
    v->noise = make_noise(r->shown);
    v->white = make_image(r->shown, "white", GPU_RGBA8, 1, 1, white);
    return v->srgb && v->srgb_fine && v->noise && v->white;
}

view *view_get(roil *r) {
    if (r->view) return r->view;
    if (!r->device) return ERR_NULL("no device: nothing can be shown");
    r->view = mem_alloc(sizeof *r->view);
    if (!view_fill(r, r->view)) roil_free_view(r);
    return r->view;
}

static void free_images(gpu *g, gpu_image *const *images, size_t count) {
    for (size_t i = 0; i < count; i++) gpu_image_destroy(g, images[i]);
}

void roil_free_view(roil *r) {
    view *v = r->view;
    if (!v) return;
    gpu_image *shown[] = {v->srgb_fine, v->noise, v->white, v->canvas, v->below};
    gpu_image *drawn[] = {v->srgb, v->probe.texel};
    kernel *looks[] = {&v->slices, &v->inspect[0][0], &v->inspect[0][1], &v->inspect[1][0],
                       &v->inspect[1][1]};
    roil_still_destroy(r, v->own);
    redraw_free(&v->redraw);
    free_images(r->shown, shown, COUNT_OF(shown));
    free_images(r->device, drawn, COUNT_OF(drawn));
    gpu_buffer_destroy(r->shown, v->vertices);
    gpu_buffer_destroy(r->shown, v->indices);
    gpu_buffer_destroy(r->device, v->probe.readback);
    kernel_destroy(&v->compose, r->shown);
    kernel_destroy(&v->overlay, r->shown);
    for (size_t i = 0; i < COUNT_OF(looks); i++) kernel_destroy(looks[i], r->device);
    shader_library_destroy(v->library);
    arena_free(&v->memory);
    mem_free(v);
    r->view = NULL;
}

// ---- kernels ----------------------------------------------------------------------------------

static const char *const names[] = {VIEW_NAMES(KERNEL_NAME_TEXT)};
static const char *const files[] = {"view/compose.comp", "view/inspect.comp", "view/slices.comp",
                                    "view/overlay.vert", "view/overlay.frag"};
const kernel_table view_kernel_table = {{names, COUNT_OF(names)}, files, COUNT_OF(files)};

bool view_make_compute(roil *r, gpu *device, kernel *k, const char *file,
                       const shader_define *defines, size_t define_count) {
    const shader_compile_desc shader = {
        .name = file, .defines = defines, .define_count = define_count};
    return k->pipeline || (kernel_compile_compute(k, r->view->library, &r->view->memory, &shader,
                                                  view_kernel_table.names) &&
                           kernel_build(k, device));
}

bool view_make_overlay(roil *r, kernel *k) {
    static const kernel_source source = {
        .label = "view/overlay",
        .stages = {{.name = "view/overlay.vert", .stage = SHADER_VERTEX},
                   {.name = "view/overlay.frag", .stage = SHADER_FRAGMENT}},
        .stage_count = 2,
        .names = {names, COUNT_OF(names)},
    };
    const gpu_graphics_desc target = {.colors = {GPU_RGBA8}, .blend = true};
    return k->pipeline || (kernel_compile(k, r->view->library, &r->view->memory, &source) &&
                           kernel_build_drawn(k, r->shown, target));
}
