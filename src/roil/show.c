// The picture of a window: the effect's last picture in its area, and the triangles of a user
// interface over it.
//
// Both are drawn into one canvas, encoded as sRGB, which is presented and can be read back. Tests
// and screenshots therefore see what a display gets. Interfaces are blended in encoded space, which
// is what designers of their colours expect.
//
// The canvas is kept, and only where it differs from the last picture (redraw.h) it is drawn anew.
#include "base/error.h"
#include "base/memory.h"
#include "roil/view.h"
#include <math.h>
#include <string.h>

static bool make_image(roil *r, gpu_image **image, const char *label, uint32_t width,
                       uint32_t height, unsigned use) {
    const gpu_image_desc *old = *image ? gpu_image_get_desc(*image) : NULL;
    if (old && old->width == width && old->height == height) return true;
    gpu_image_destroy(r->shown, *image);
    *image = gpu_image_create(r->shown,
                              &(gpu_image_desc){.label = label,
                                                .format = GPU_RGBA8,
                                                .width = width,
                                                .height = height,
                                                .use = use | GPU_USE_SAMPLED | GPU_USE_STORAGE});
    return *image != NULL;
}

// What lies below the interface is kept, for it changes more rarely.
static bool make_canvas(roil *r, view *v, uint32_t width, uint32_t height) {
    const gpu_image *below = v->below, *canvas = v->canvas;
    bool done = make_image(r, &v->below, "window, below", width, height, 0) &&
                make_image(r, &v->canvas, "window", width, height, GPU_USE_TARGET);
    if (v->below != below) v->holds = false;
    if (v->below != below || v->canvas != canvas) redraw_forget(&v->redraw);
    return done;
}

// ---- the picture ------------------------------------------------------------------------------

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

typedef struct shown { // stills, or the effect's own picture; NULL: none
    gpu_image *picture, *other;
    bool kept; // what was made of them holds: they never change, or there is none
} shown;

static bool compose(roil *r, view *v, const roil_picture *p, const shown *what) {
    kernel *k = &v->compose;
    kernel_bind(k, N_View,
                (gpu_binding){.uniform = &v->composed, .uniform_size = sizeof v->composed});
    kernel_bind(k, N_srgb, (gpu_binding){.image = v->srgb_fine, .sampler = GPU_NEAREST_CLAMP});
    kernel_bind(k, N_noise, (gpu_binding){.image = v->noise, .sampler = GPU_NEAREST_CLAMP});
    kernel_bind_image(k, N_picture, what->picture ? what->picture : v->white);
    kernel_bind_image(k, N_other, what->other ? what->other : v->white);
    kernel_bind_image(k, N_canvas, v->below);
    return kernel_run(k, r->shown, p->width, p->height, 1);
}

static compose_block block_of(const roil_picture *p, const shown *what) {
    const float *color = p->background;
    compose_block block = {.background = {color[0], color[1], color[2], 1}, .split = {INT32_MAX}};
    if (what->picture) fit_picture(what->picture, p->view, block.place);
    if (what->other) fit_picture(what->other, p->view, block.beside);
    if (p->beside) block.split[0] = (int32_t)fminf(fmaxf(p->split, 0), 1e6f);
    return block;
}

static bool compose_picture(roil *r, view *v, const roil_picture *p, const shown *what) {
    compose_block block = block_of(p, what);
    bool moved = memcmp(&block, &v->composed, sizeof block) != 0;
    bool same = v->holds && v->picture == what->picture && v->other == what->other;
    if (what->kept && same && !moved) return true;
    v->composed = block;
    v->made.ground += moved;
    v->made.pictures++;
    memcpy(v->made.places[0], block.place, sizeof block.place);
    memcpy(v->made.places[1], block.beside, sizeof block.beside);
    bool done = compose(r, v, p, what);
    v->holds = what->kept && done;
    v->picture = what->picture;
    v->other = what->other;
    return done;
}

// Makes all that is to be drawn anew show what lies below the interface.
static bool lay_ground(roil *r, view *v, const roil_picture *p, const shown *what) {
    gpu_pass_begin(r->shown, "window");
    bool done = compose_picture(r, v, p, what);
    redraw_find(&v->redraw, p, &v->made);
    done = done && gpu_image_copy_areas(r->shown, v->below, v->canvas, v->redraw.areas,
                                        v->redraw.area_count);
    gpu_pass_end(r->shown);
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
    uint64_t most = gpu_get_info(r->shown)->max_storage_range, wanted = size + size / 2 + 65536;
    gpu_buffer_destroy(r->shown, *buffer);
    *buffer = gpu_buffer_create(
        r->shown,
        &(gpu_buffer_desc){.label = label, .size = wanted < most || size > most ? wanted : most});
    return *buffer != NULL;
}

static bool upload_triangles(roil *r, view *v, const roil_picture *p) {
    size_t vertices = p->vertex_count * sizeof *p->vertices;
    size_t indices = v->redraw.index_count * sizeof *v->redraw.indices;
    return reserve_buffer(r, &v->vertices, "vertices of the window", vertices) &&
           reserve_buffer(r, &v->indices, "indices of the window", indices) &&
           gpu_buffer_write(r->shown, v->vertices, 0, p->vertices, vertices) &&
           gpu_buffer_write(r->shown, v->indices, 0, v->redraw.indices, indices);
}

static void make_draws(view *v, const roil_picture *p, const float size[4], gpu_draw *out,
                       gpu_binding (*bindings)[GPU_MAX_SLOTS]) {
    kernel *k = &v->overlay;
    kernel_bind(k, N_View, (gpu_binding){.uniform = size, .uniform_size = 4 * sizeof *size});
    kernel_bind_buffer(k, N_Vertices, v->vertices);
    kernel_bind_buffer(k, N_Indices, v->indices);
    for (size_t i = 0; i < v->redraw.draw_count; i++) {
        const redraw_draw *d = &v->redraw.draws[i];
        const roil_texture *texture = p->draws[d->of].texture;
        kernel_bind_image(k, N_image, texture ? texture->image : v->white);
        out[i] = kernel_draw(k, bindings[i]);
        out[i].vertices = d->count;
        out[i].first_vertex = d->first;
        memcpy(out[i].scissor, &d->area, sizeof d->area);
    }
}

static bool draw_overlay(roil *r, view *v, const roil_picture *p) {
    const size_t count = v->redraw.draw_count;
    if (!count) return true;
    if (!upload_triangles(r, v, p)) return false;
    float size[4] = {(float)p->width, (float)p->height};
    gpu_draw *draws = mem_alloc(count * sizeof *draws);
    gpu_binding(*bindings)[GPU_MAX_SLOTS] = mem_alloc(count * sizeof *bindings);
    make_draws(v, p, size, draws, bindings);
    gpu_pass_begin(r->shown, "interface");
    bool done = gpu_draw_all(r->shown, &(gpu_draw_desc){.pipeline = v->overlay.pipeline,
                                                        .colors = {v->canvas},
                                                        .draws = draws,
                                                        .draw_count = count});
    gpu_pass_end(r->shown);
    mem_free(draws);
    mem_free(bindings);
    return done;
}

// ---- showing ----------------------------------------------------------------------------------

static gpu_image *image_of(roil *r, roil_still *s) {
    return s && roil_still_ready(r, s) ? s->image : NULL;
}

// The effect's own picture, which on another device is waited for.
static bool find_own(roil *r, view *v, roil_effect *e, shown *out) {
    out->picture = view_picture(e);
    out->kept = !out->picture;
    if (out->kept || !roil_shows_apart(r)) return true;
    roil_still_destroy(r, v->own);
    v->own = roil_still_create(e);
    if (!v->own || !view_wait(r, v->own)) return false;
    *out = (shown){.picture = v->own->image, .kept = true};
    return true;
}

static bool find_shown(roil *r, view *v, const roil_picture *p, shown *out) {
    *out = (shown){0};
    if (!p->still && !p->beside) return find_own(r, v, p->effect, out);
    out->picture = image_of(r, p->still);
    out->other = image_of(r, p->beside);
    out->kept = true;
    return !gpu_is_lost(r->device);
}

static bool present(roil *r, const view *v) {
    return !r->window || gpu_present(r->shown, v->canvas, v->redraw.areas, v->redraw.area_count);
}

bool roil_show(roil *r, const roil_picture *p) {
    mem_enter();
    if (p->width == 0 || p->height == 0) return mem_leave(true); // minimised
    view *v = view_get(r);
    shown what;
    if (!v || !check_triangles(p) ||
        !view_make_compute(r, r->shown, &v->compose, "view/compose.comp", NULL, 0) ||
        !view_make_overlay(r, &v->overlay) || !make_canvas(r, v, p->width, p->height) ||
        !find_shown(r, v, p, &what) || !gpu_frame_begin(r->shown))
        return mem_leave(false);
    bool done = lay_ground(r, v, p, &what) && draw_overlay(r, v, p) && present(r, v);
    bool ended = gpu_frame_end(r->shown);
    if (done && ended) redraw_keep(&v->redraw);
    return mem_leave(done && ended);
}

bool roil_read_shown(roil *r, uint8_t *out) {
    mem_enter();
    if (!r->view || !r->view->canvas) return mem_leave(err_set("nothing has been shown yet"));
    const gpu_image_desc *size = gpu_image_get_desc(r->view->canvas);
    return mem_leave(
        gpu_image_read(r->shown, r->view->canvas, out, (size_t)size->width * size->height * 4));
}
