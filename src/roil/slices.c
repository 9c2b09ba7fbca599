// Flows in slices, shown and changed: the functions of roil_slices.h but for templates.
#include "pass/slices/slices.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/slices/slices_templates.h"
#include "roil/template.h"
#include "roil/view.h"
#include "roil_slices.h"
#include <assert.h>
#include <math.h>

_Static_assert((int)ROIL_SLICES_DENSITY == PASS_FLUID_DENSITY &&
                   (int)ROIL_SLICES_VELOCITY == PASS_FLUID_VELOCITY &&
                   (int)ROIL_SLICES_FIELDS == PASS_FLUID_NAMES,
               "views are those of the pass's fields");
const char *const roil_slices_fields[ROIL_SLICES_FIELDS] = {"density", "temperature", "dye",
                                                            "pressure", "velocity"};

// ---- which ------------------------------------------------------------------------------------

size_t roil_slices_list(const roil_effect *e, roil_slices *out, size_t capacity) {
    size_t count = 0;
    for (size_t i = 0; i < effect_pass_count(e->effect); i++) {
        const pass *p = effect_get_pass(e->effect, i);
        if (!pass_is(p, "slices") || count++ >= capacity) continue;
        const pass_slices_desc *d = pass_slices_get_desc(p);
        out[count - 1] = (roil_slices){
            .name = pass_slices_variable(p),
            .pass = pass_label(p),
            .count = d->count,
            .size = {d->size[0], d->size[1]},
            .width = (float)(d->height / d->size[1] * d->size[0]),
            .height = (float)d->height,
            .time_step = d->time_step,
        };
    }
    return count;
}

pass *roil_slices_find(const roil_effect *e, size_t flow, uint32_t slice) {
    size_t left = flow;
    for (size_t i = 0; i < effect_pass_count(e->effect); i++) {
        pass *p = effect_get_pass(e->effect, i);
        if (!pass_is(p, "slices") || left-- > 0) continue;
        if (slice < pass_slices_get_desc(p)->count) return p;
        return ERR_NULL("%s: there is no slice %u", pass_label(p), slice + 1);
    }
    return ERR_NULL("the effect has no slices number %zu", flow + 1);
}

pass *roil_slices_find_square(const roil_effect *e, const roil_slices_square *where) {
    if (isfinite(where->middle[0]) && isfinite(where->middle[1]) && where->side > 0 &&
        isfinite(where->side))
        return roil_slices_find(e, where->flow, where->slice);
    return ERR_NULL("there is no square of side %g at %g, %g", (double)where->side,
                    (double)where->middle[0], (double)where->middle[1]);
}

// ---- seeing -----------------------------------------------------------------------------------

typedef struct slices_block { // std140, as slices.comp has it
    float scale[4];
    int32_t field[4];
} slices_block;

static bool slices_view_draw(roil *r, gpu_image *image, const slices_block *block,
                             gpu_image *target) {
    const gpu_image_desc *size = gpu_image_get_desc(target);
    kernel *k = &r->view->slices;
    kernel_bind(k, N_View, (gpu_binding){.uniform = block, .uniform_size = sizeof *block});
    kernel_bind_image(k, N_image, image);
    kernel_bind_image(k, N_canvas, target);
    if (!gpu_frame_begin(r->device)) return false;
    gpu_pass_begin(r->device, "slices.view");
    bool done = kernel_run(k, r->device, size->width, size->height, 1);
    gpu_pass_end(r->device);
    bool ended = gpu_frame_end(r->device);
    return done && ended;
}

static bool slices_view_check(const roil_slices_view *v) {
    if (!(v->range > 0 && isfinite(v->range)))
        return err_set("range is %g; accepted: above 0", (double)v->range);
    assert(v->field < ROIL_SLICES_FIELDS);
    return (v->arrows >= 0 && isfinite(v->arrows)) ||
           err_set("arrows is %g; accepted: 0 or more pixels", (double)v->arrows);
}

bool roil_slices_draw(roil_effect *e, const roil_slices_view *how, roil_texture *target) {
    mem_enter();
    roil *r = e->owner;
    int channel;
    const pass *p = roil_slices_find(e, how->flow, how->slice);
    gpu_image *image =
        p && slices_view_check(how) ? pass_slices_look(p, (int)how->field, &channel) : NULL;
    if (!image || !view_get(r) ||
        !view_make_compute(r, r->device, &r->view->slices, "view/slices.comp", NULL, 0))
        return mem_leave(false);
    float count = (float)pass_slices_get_desc(p)->count;
    const slices_block block = {
        .scale = {1 / how->range, ((float)how->slice + 0.5f) / count, how->arrows},
        .field = {(int32_t)how->field, channel},
    };
    gpu_image *drawn = view_drawn(r, target);
    return mem_leave(drawn && slices_view_draw(r, image, &block, drawn) && view_bring(r, target));
}

static bool find_greatest(roil_effect *e, const roil_slices_view *how, float *out) {
    const pass *p = roil_slices_find(e, how->flow, how->slice);
    return p && pass_slices_greatest(p, (int)how->field, how->slice, out);
}

bool roil_slices_greatest(roil_effect *e, const roil_slices_view *how, float *out) {
    return MEM_CALL(find_greatest(e, how, out));
}

// ---- touching ---------------------------------------------------------------------------------

bool roil_slices_push(roil_effect *e, const roil_slices_square *where, const float force[2]) {
    mem_enter();
    pass *p = roil_slices_find_square(e, where);
    const slices_hand push = {
        .pushes = true,
        .slice = (int)where->slice,
        .place = {where->middle[0], where->middle[1]},
        .size = where->side,
        .angle = atan2f(-force[0], force[1]) * 57.2957795f, // from its upper edge
        .strength = hypotf(force[0], force[1]),
    };
    return mem_leave(p && slices_put(p, &push));
}

bool roil_slices_capture(roil_effect *e, const roil_slices_square *where, const char *name,
                         float scale[2]) {
    mem_enter();
    char path[PATH_CAP];
    arena memory = {0};
    picture image;
    const pass *p = roil_slices_find_square(e, where);
    if (!p || !template_new_path(e, name, path)) return mem_leave(false);
    bool done =
        slices_capture(p, where->slice, where->middle, where->side, &memory, &image, scale) &&
        file_make_parent_folders(path) && picture_write(path, &image);
    arena_free(&memory);
    return mem_leave(done);
}
