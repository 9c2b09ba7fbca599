// The picture of a window: the effect's last picture in its area, and the triangles of a user
// interface over it.
//
// Both are drawn into one canvas, encoded as sRGB, which is presented and can be read back. Tests
// and screenshots therefore see what a display gets. Interfaces are blended in encoded space, which
// is what designers of their colours expect.
#include "base/error.h"
#include "base/memory.h"
#include "roil/view.h"
#include <math.h>
#include <string.h>

// ---- textures ---------------------------------------------------------------------------------

roil_texture *roil_texture_create(roil *r, uint32_t width, uint32_t height, const uint8_t *rgba) {
    if (!r->device) {
        err_set("no device: there are no textures");
        return NULL;
    }
    gpu_image *image =
        gpu_image_create(r->device, &(gpu_image_desc){.label = "texture",
                                                      .format = GPU_RGBA8,
                                                      .width = width,
                                                      .height = height,
                                                      .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
    if (!image) return NULL;
    size_t size = (size_t)width * height * 4;
    uint8_t *none = rgba ? NULL : mem_alloc(size);
    bool done = gpu_image_write(r->device, image, 0, rgba ? rgba : none, size);
    mem_free(none);
    if (!done) {
        gpu_image_destroy(r->device, image);
        return NULL;
    }
    roil_texture *t = mem_alloc(sizeof *t);
    t->image = image;
    return t;
}

void roil_texture_destroy(roil *r, roil_texture *t) {
    if (!t) return;
    gpu_image_destroy(r->device, t->image);
    mem_free(t);
}

// ---- the effect -------------------------------------------------------------------------------

static bool make_canvas(roil *r, view *v, uint32_t width, uint32_t height) {
    const gpu_image_desc *old = v->canvas ? gpu_image_get_desc(v->canvas) : NULL;
    if (old && old->width == width && old->height == height) return true;
    gpu_image_destroy(r->device, v->canvas);
    v->canvas = gpu_image_create(
        r->device, &(gpu_image_desc){.label = "window",
                                     .format = GPU_RGBA8,
                                     .width = width,
                                     .height = height,
                                     .use = GPU_USE_SAMPLED | GPU_USE_STORAGE | GPU_USE_TARGET});
    return v->canvas != NULL;
}

// Returns the picture of the effect. NULL when none was rendered, or when its texels are integers.
static gpu_image *find_picture(roil_effect *e) {
    if (!e || !e->frame) return NULL;
    graph_image output = effect_get_picture(e->effect, EFFECT_OUTPUT);
    gpu_image *picture = graph_get_image(effect_graph(e->effect), output);
    return picture && gpu_image_get_desc(picture)->format != GPU_R32U ? picture : NULL;
}

// Fits the picture into the middle of the view with its aspect ratio: left, top, width, height in
// whole pixels. The width is 0 when there is no room.
static void fit_picture(const gpu_image *picture, const float space[4], int32_t out[4]) {
    const gpu_image_desc *size = gpu_image_get_desc(picture);
    float width = space[2] - space[0], height = space[3] - space[1];
    float scale = fminf(width / (float)size->width, height / (float)size->height);
    memset(out, 0, 4 * sizeof *out);
    if (!(scale > 0) || !(fabsf(space[0]) < 1e6f && fabsf(space[1]) < 1e6f && scale < 1e6f)) return;
    out[2] = (int32_t)fmaxf(1, rintf((float)size->width * scale));
    out[3] = (int32_t)fmaxf(1, rintf((float)size->height * scale));
    out[0] = (int32_t)floorf(space[0] + (width - (float)out[2]) / 2);
    out[1] = (int32_t)floorf(space[1] + (height - (float)out[3]) / 2);
}

typedef struct compose_block { // std140, as compose.comp has it
    float background[4];
    int32_t place[4];
} compose_block;

static bool compose_picture(roil *r, view *v, const roil_picture *p) {
    const float *color = p->background;
    compose_block block = {.background = {color[0], color[1], color[2], 1}};
    gpu_image *picture = find_picture(p->effect);
    if (picture) fit_picture(picture, p->view, block.place);
    kernel *k = &v->compose;
    kernel_bind(k, N_View, (gpu_binding){.uniform = &block, .uniform_size = sizeof block});
    kernel_bind(k, N_srgb, (gpu_binding){.image = v->srgb_fine, .sampler = GPU_NEAREST_CLAMP});
    kernel_bind(k, N_noise, (gpu_binding){.image = v->noise, .sampler = GPU_NEAREST_CLAMP});
    kernel_bind_image(k, N_picture, picture ? picture : v->white);
    kernel_bind_image(k, N_canvas, v->canvas);
    gpu_pass_begin(r->device, "window");
    bool done = kernel_run(k, r->device, p->width, p->height, 1);
    gpu_pass_end(r->device);
    return done;
}

// ---- the overlay ------------------------------------------------------------------------------

// Checks all indices, since the device would read outside of the buffers.
static bool check_triangles(const roil_picture *p) {
    for (size_t i = 0; i < p->draw_count; i++) {
        const roil_draw *d = &p->draws[i];
        if (d->first > p->index_count || d->count > p->index_count - d->first)
            return err_set("draw %zu has %u indices from %u on; there are %zu", i, d->count,
                           d->first, p->index_count);
    }
    for (size_t i = 0; i < p->index_count; i++)
        if (p->indices[i] >= p->vertex_count)
            return err_set("index %zu is vertex %u; there are %zu", i, p->indices[i],
                           p->vertex_count);
    return true;
}

// Makes the buffer at least `size` bytes. It gets more than that, so that a growing interface does
// not allocate in every frame.
static bool reserve_buffer(roil *r, gpu_buffer **buffer, const char *label, size_t size) {
    if (*buffer && gpu_buffer_size(*buffer) >= size) return true;
    uint64_t most = gpu_get_info(r->device)->max_storage_range, wanted = size + size / 2 + 65536;
    gpu_buffer_destroy(r->device, *buffer);
    *buffer = gpu_buffer_create(
        r->device,
        &(gpu_buffer_desc){.label = label, .size = wanted < most || size > most ? wanted : most});
    return *buffer != NULL;
}

static bool upload_triangles(roil *r, view *v, const roil_picture *p) {
    size_t vertices = p->vertex_count * sizeof *p->vertices;
    size_t indices = p->index_count * sizeof *p->indices;
    return reserve_buffer(r, &v->vertices, "vertices of the window", vertices) &&
           reserve_buffer(r, &v->indices, "indices of the window", indices) &&
           gpu_buffer_write(r->device, v->vertices, 0, p->vertices, vertices) &&
           gpu_buffer_write(r->device, v->indices, 0, p->indices, indices);
}

// Clips a rectangle to the canvas in whole pixels. False when nothing is left.
static bool scissor(const roil_picture *p, const float clip[4], uint32_t out[4]) {
    float right = fminf(rintf(clip[2]), (float)p->width), left = fmaxf(rintf(clip[0]), 0);
    float bottom = fminf(rintf(clip[3]), (float)p->height), top = fmaxf(rintf(clip[1]), 0);
    if (!(left < right && top < bottom)) return false;
    out[0] = (uint32_t)left;
    out[1] = (uint32_t)top;
    out[2] = (uint32_t)(right - left);
    out[3] = (uint32_t)(bottom - top);
    return true;
}

static size_t make_draws(view *v, const roil_picture *p, const float size[4], gpu_draw *out,
                         gpu_binding (*bindings)[GPU_MAX_SLOTS]) {
    kernel *k = &v->overlay;
    size_t count = 0;
    kernel_bind(k, N_View, (gpu_binding){.uniform = size, .uniform_size = 4 * sizeof *size});
    kernel_bind_buffer(k, N_Vertices, v->vertices);
    kernel_bind_buffer(k, N_Indices, v->indices);
    for (size_t i = 0; i < p->draw_count; i++) {
        const roil_draw *d = &p->draws[i];
        uint32_t area[4];
        if (!d->count || !scissor(p, d->clip, area)) continue;
        kernel_bind_image(k, N_image, d->texture ? d->texture->image : v->white);
        gpu_draw *draw = &out[count];
        *draw = kernel_draw(k, bindings[count++]);
        draw->vertices = d->count;
        draw->first_vertex = d->first;
        memcpy(draw->scissor, area, sizeof area);
    }
    return count;
}

static bool draw_overlay(roil *r, view *v, const roil_picture *p) {
    if (!p->draw_count || !p->index_count) return true;
    if (!upload_triangles(r, v, p)) return false;
    float size[4] = {(float)p->width, (float)p->height};
    gpu_draw *draws = mem_alloc(p->draw_count * sizeof *draws);
    gpu_binding(*bindings)[GPU_MAX_SLOTS] = mem_alloc(p->draw_count * sizeof *bindings);
    size_t count = make_draws(v, p, size, draws, bindings);
    gpu_pass_begin(r->device, "interface");
    bool done = !count || gpu_draw_all(r->device, &(gpu_draw_desc){.pipeline = v->overlay.pipeline,
                                                                   .colors = {v->canvas},
                                                                   .draws = draws,
                                                                   .draw_count = count});
    gpu_pass_end(r->device);
    mem_free(draws);
    mem_free(bindings);
    return done;
}

// ---- showing ----------------------------------------------------------------------------------

bool roil_show(roil *r, const roil_picture *p) {
    if (p->width == 0 || p->height == 0) return true; // minimised
    view *v = view_get(r);
    if (!v || !check_triangles(p) ||
        !view_make_compute(r, &v->compose, "view/compose.comp", NULL, 0) ||
        !view_make_overlay(r, &v->overlay) || !make_canvas(r, v, p->width, p->height) ||
        !gpu_frame_begin(r->device))
        return false;
    bool done = compose_picture(r, v, p) && draw_overlay(r, v, p) &&
                (!r->window || gpu_present(r->device, v->canvas));
    bool ended = gpu_frame_end(r->device);
    return done && ended;
}

bool roil_read_shown(roil *r, uint8_t *out) {
    if (!r->view || !r->view->canvas) return err_set("nothing has been shown yet");
    const gpu_image_desc *size = gpu_image_get_desc(r->view->canvas);
    return gpu_image_read(r->device, r->view->canvas, out, (size_t)size->width * size->height * 4);
}
