// Inspection of an effect: lists the images of its graph, keeps some of them, and draws one for a
// person to read.
//
// The value under the cursor is read without waiting. The shader writes it to two texels, which are
// copied to the next of VIEW_READS places of a readback buffer. When a frame begins, all frames but
// the last GPU_FRAMES_IN_FLIGHT - 1 have finished, so an older place can be read. There are more
// places than frames in flight.
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "roil/view.h"
#include <math.h>
#include <string.h>

enum { PROBE_SIZE = 8 * sizeof(float) };

// ---- keeping ----------------------------------------------------------------------------------

bool roil_keep(roil_effect *e, const char *image) {
    mem_enter();
    if (!roil_find_image(e, image).id) return mem_leave(false);
    for (size_t i = 0; i < e->kept_count; i++)
        if (strcmp(e->kept[i], image) == 0) return mem_leave(true);
    *MEM_ADD(e->kept, e->kept_count, e->kept_capacity) = mem_copy(image, strlen(image) + 1);
    return mem_leave(true);
}

void roil_keep_only(roil_effect *e, const char *image) {
    char *copy = image ? mem_copy(image, strlen(image) + 1) : NULL; // may be one of those freed
    for (size_t i = 0; i < e->kept_count; i++) mem_free(e->kept[i]);
    e->kept_count = 0;
    if (copy) roil_keep(e, copy);
    mem_free(copy);
}

static graph_image *list_images(roil_effect *e, size_t *count) {
    graph *g = effect_graph(e->effect);
    *count = graph_images(g, NULL, 0);
    graph_image *images = mem_alloc(*count * sizeof *images);
    graph_images(g, images, *count);
    return images;
}

void roil_apply_kept(roil_effect *e) {
    graph *g = effect_graph(e->effect);
    size_t count;
    graph_image *images = list_images(e, &count);
    for (size_t i = 0; i < count; i++) graph_remove_output(g, images[i]);
    mem_free(images);
    for (int i = 0; i <= EFFECT_DEPTH; i++) {
        graph_image picture = effect_get_picture(e->effect, (effect_picture)i);
        if (picture.id) graph_add_output(g, picture);
    }
    for (size_t i = 0; i < e->kept_count; i++) {
        graph_image image = roil_find_image(e, e->kept[i]);
        if (image.id) graph_add_output(g, image);
    }
}

static size_t describe_images(roil_effect *e, roil_image_info *out, size_t capacity) {
    graph *g = effect_graph(e->effect);
    if (!graph_order(g, NULL, 0)) return 0; // not compiled
    size_t count;
    graph_image *images = list_images(e, &count);
    for (size_t i = 0; i < count && i < capacity; i++) {
        const graph_image_desc *desc = graph_get_desc(g, images[i]);
        out[i] = (roil_image_info){.format = gpu_format_name(desc->format),
                                   .mips = desc->mips,
                                   .volume = desc->depth > 0,
                                   .culled = !graph_get_image(g, images[i])};
        str_copy(out[i].name, sizeof out[i].name, desc->name);
        graph_get_size(g, images[i], out[i].size);
    }
    mem_free(images);
    return count;
}

size_t roil_images(roil_effect *e, roil_image_info *out, size_t capacity) {
    mem_enter();
    return roil_leave_count(describe_images(e, out, capacity));
}

// ---- the value under the cursor ---------------------------------------------------------------

static bool make_probe(roil *r, view_probe *probe, const roil_effect *e, graph_image image) {
    if (probe->effect != e || probe->image.id != image.id) {
        memset(probe->frames, 0, sizeof probe->frames); // what comes back is another image's
        probe->effect = e;
        probe->image = image;
    }
    if (!probe->texel)
        probe->texel = gpu_image_create(r->device, &(gpu_image_desc){.label = "inspected texel",
                                                                     .format = GPU_RGBA32F,
                                                                     .width = 2,
                                                                     .height = 1,
                                                                     .use = GPU_USE_STORAGE});
    if (!probe->readback)
        probe->readback = gpu_buffer_create(
            r->device, &(gpu_buffer_desc){.label = "inspected texels",
                                          .size = (uint64_t)VIEW_READS * PROBE_SIZE,
                                          .kind = GPU_BUFFER_READBACK});
    return probe->texel && probe->readback;
}

// Reads the newest value whose frame has finished. `frame` has just begun.
static void read_probe(view_probe *probe, uint64_t frame, roil_texel *out) {
    uint64_t newest = 0;
    uint32_t place = 0;
    for (uint32_t i = 0; i < VIEW_READS; i++) {
        bool finished = probe->frames[i] && probe->frames[i] + GPU_FRAMES_IN_FLIGHT <= frame;
        if (!finished || probe->frames[i] < newest) continue;
        newest = probe->frames[i];
        place = i;
    }
    if (!newest) return;
    float values[8];
    const unsigned char *bytes = gpu_buffer_map(probe->readback);
    memcpy(values, bytes + place * PROBE_SIZE, PROBE_SIZE);
    out->valid = values[7] != 0;
    for (int i = 0; i < 3; i++) out->at[i] = (uint32_t)values[4 + i];
    memcpy(out->value, values, sizeof out->value);
}

static bool send_probe(roil *r, view_probe *probe, uint64_t frame) {
    uint32_t place = probe->next;
    probe->frames[place] = frame;
    probe->next = (place + 1) % VIEW_READS;
    return gpu_image_copy_to_buffer(r->device, probe->texel, probe->readback,
                                    (uint64_t)place * PROBE_SIZE);
}

// ---- drawing ----------------------------------------------------------------------------------

typedef struct inspect_block { // std140, as inspect.comp has it
    float center_zoom[4];
    int32_t slice[4], cursor[4];
} inspect_block;

typedef struct job {
    gpu_image *image, *target;
    kernel *inspector;
    inspect_block block;
    bool cursor; // is on the target
} job;

static gpu_image *find_image(roil_effect *e, const roil_inspection *how, graph_image *found) {
    graph *g = effect_graph(e->effect);
    *found = roil_find_image(e, how->image);
    if (!found->id) return NULL;
    gpu_image *image = graph_get_image(g, *found);
    if (!image || !graph_is_alone(g, *found))
        return ERR_NULL("image '%s' %s: it must be kept (roil_keep) to be inspected", how->image,
                        image ? "shares its memory" : "is not drawn");
    if (!e->frame) return ERR_NULL("image '%s' is empty yet: render a frame first", how->image);
    return image;
}

static bool inspection_check(const roil_inspection *how, const gpu_image_desc *desc) {
    if (how->mip >= desc->mips)
        return err_set("image '%s' has no level %u, only %u levels", how->image, how->mip,
                       desc->mips);
    if (desc->depth && (how->axis < 0 || how->axis > 2))
        return err_set("axis is %d; accepted: 0 (x), 1 (y), 2 (z)", how->axis);
    if (!(how->zoom > 0 && isfinite(how->zoom)))
        return err_set("zoom is %g; accepted: above 0", (double)how->zoom);
    if (!isfinite(how->center[0]) || !isfinite(how->center[1]) || !isfinite(how->exposure) ||
        !isfinite(how->slice))
        return err_set("center, exposure and slice must be finite");
    return true;
}

// Returns the slice of a volume's mip level at the position `at`, 0 to 1.
static int32_t slice_at(const gpu_image_desc *desc, uint32_t mip, int axis, float at) {
    uint32_t size = (axis == 0 ? desc->width : axis == 1 ? desc->height : desc->depth) >> mip;
    float last = (float)(size ? size - 1 : 0);
    return (int32_t)clampf(floorf(at * (float)size), 0, last);
}

// Leaves out channels that the image does not have; an image with a single channel is then shown in
// grey.
static int32_t channels_of(const gpu_image_desc *desc, unsigned wanted) {
    unsigned there = (1u << gpu_format_channels(desc->format)) - 1;
    return (int32_t)(wanted & there ? wanted & there : wanted & 15);
}

static void fill_block(job *j, const roil_inspection *how) {
    const gpu_image_desc *desc = gpu_image_get_desc(j->image);
    const gpu_image_desc *target = gpu_image_get_desc(j->target);
    const float *at = how->cursor;
    j->cursor =
        at[0] >= 0 && at[1] >= 0 && at[0] < (float)target->width && at[1] < (float)target->height;
    j->block = (inspect_block){
        .center_zoom = {how->center[0], how->center[1], how->zoom, exp2f(how->exposure)},
        .slice = {how->axis, slice_at(desc, how->mip, how->axis, how->slice),
                  channels_of(desc, how->channels), how->negative},
        .cursor = {-1, -1},
    };
    if (!j->cursor) return;
    j->block.cursor[0] = (int32_t)at[0];
    j->block.cursor[1] = (int32_t)at[1];
}

static bool inspection_draw(roil *r, const job *j, uint32_t mip) {
    const gpu_image_desc *target = gpu_image_get_desc(j->target);
    view *v = r->view;
    kernel *k = j->inspector;
    kernel_bind(k, N_View, (gpu_binding){.uniform = &j->block, .uniform_size = sizeof j->block});
    kernel_bind(k, N_srgb, (gpu_binding){.image = v->srgb, .sampler = GPU_NEAREST_CLAMP});
    kernel_bind(k, N_image,
                (gpu_binding){
                    .image = j->image, .mip = mip, .one_mip = true, .sampler = GPU_NEAREST_CLAMP});
    kernel_bind_image(k, N_canvas, j->target);
    kernel_bind_image(k, N_texel, v->probe.texel);
    gpu_pass_begin(r->device, "inspect");
    bool done = kernel_run(k, r->device, target->width, target->height, 1);
    gpu_pass_end(r->device);
    return done;
}

static bool make_kernel(roil *r, job *j) {
    const gpu_image_desc *desc = gpu_image_get_desc(j->image);
    bool volume = desc->depth > 0, whole = desc->format == GPU_R32U;
    const shader_define defines[] = {{"VOLUME", volume ? "1" : "0"}, {"WHOLE", whole ? "1" : "0"}};
    j->inspector = &r->view->inspect[volume][whole];
    return view_make_compute(r, r->device, j->inspector, "view/inspect.comp", defines,
                             COUNT_OF(defines));
}

bool roil_inspect(roil_effect *e, const roil_inspection *how, roil_texture *target,
                  roil_texel *texel) {
    mem_enter();
    roil *r = e->owner;
    view *v = view_get(r);
    graph_image image;
    job j = {.target = view_drawn(r, target)};
    *texel = (roil_texel){0};
    if (!v || !j.target) return mem_leave(false);
    j.image = find_image(e, how, &image);
    if (!j.image || !inspection_check(how, gpu_image_get_desc(j.image)) || !make_kernel(r, &j) ||
        !make_probe(r, &v->probe, e, image))
        return mem_leave(false);
    fill_block(&j, how);
    uint64_t frame = gpu_frame_begin(r->device);
    if (!frame) return mem_leave(false);
    if (j.cursor) read_probe(&v->probe, frame, texel);
    bool done = inspection_draw(r, &j, how->mip) && (!j.cursor || send_probe(r, &v->probe, frame));
    bool ended = gpu_frame_end(r->device);
    return mem_leave(done && ended && view_bring(r, target));
}
