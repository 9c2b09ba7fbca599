// Forward: what `geometry` shows and `shade` lights, in one pass over the triangles (drawn.h). Then
// the sky, where nothing was drawn.
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "pass/surfaces/drawn.h"
#include "pass/surfaces/rays.h"

enum {
    FORWARD_SKY = RAYS_VARIANTS,
    FORWARD_CHOOSE,
    FORWARD_KERNELS = FORWARD_CHOOSE + DRAWN_STEPS
};

static const pass_kernel kernels[FORWARD_KERNELS] = {
    [RAYS_FEW] = {.vertex = "pass/surfaces/geometry.vert"},
    [RAYS_MANY] = {.vertex = "pass/surfaces/geometry.vert"},
    [FORWARD_SKY] = {.vertex = "pass/surfaces/forward_sky.vert",
                     .shader = "pass/surfaces/forward_sky.frag"},
    DRAWN_KERNELS(FORWARD_CHOOSE),
};

#define NAMES(NAME)                                                                                \
    RAYS_NAMES(NAME), NAME(lod), NAME(max_distance), NAME(color), NAME(normal), NAME(depth),       \
        NAME(picture)
KERNEL_NAMES(NAMES);

typedef struct forward_state {
    drawn *drawn;
    graph_image z;
} forward_state;

static bool forward_declare(pass *p) {
    forward_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->drawn = drawn_create(p, FORWARD_CHOOSE, false);
    s->z = pass_add_target(p, "z", GPU_D32F);
    return s->z.id && pass_declare_images(p) && pass_add_to_graph_with(p, &s->z, 1);
}

static bool forward_defines(pass *p, size_t index, pass_defines *out) {
    (void)p;
    if (index < RAYS_VARIANTS) pass_rays_define(out, index);
    return true;
}

static bool forward_foresees(const pass *p, size_t index) {
    return index >= RAYS_VARIANTS || pass_rays_foresee(p, index);
}

static void forward_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    (void)index;
    out->depth = GPU_D32F;
    for (int i = N_color; i <= N_depth; i++)
        out->colors[i - N_color] = p->formats[p->names[i].image];
}

static bool forward_allocate(pass *p) {
    return drawn_allocate(((forward_state *)p->state)->drawn);
}

static void forward_list_memory(const pass *p, budget_list *out) {
    drawn_list_memory(((const forward_state *)p->state)->drawn, 1, out);
}

static void forward_destroy(pass *p) {
    forward_state *s = p->state;
    if (s) drawn_destroy(s->drawn);
}

// ---- in a frame -------------------------------------------------------------------------------

static bool forward_update(pass *p) {
    uint32_t size[3];
    graph_get_size(p->host->graph, *pass_image(p, N_color), size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    pass_set(p, N_picture, picture, sizeof picture);
    return true;
}

static bool draw_sky(pass *p, gpu_draw_desc *target) {
    gpu_binding kept[GPU_MAX_SLOTS];
    const kernel *k = pass_use(p, FORWARD_SKY);
    if (!k) return false;
    gpu_draw draw = kernel_draw(k, kept);
    draw.vertices = 3;
    target->pipeline = k->pipeline;
    target->clear = false;
    target->draws = &draw;
    target->draw_count = 1;
    return gpu_draw_all(p->host->device, target);
}

static bool forward_record(pass *p) {
    const forward_state *s = p->state;
    gpu_draw_desc target = {
        .colors = {pass_get_image(p, N_color), pass_get_image(p, N_normal),
                   pass_get_image(p, N_depth)},
        .depth = graph_get_image(p->host->graph, s->z),
        .clear = true,
        .clear_depth = 1,
    };
    uint32_t size[3];
    graph_get_size(p->host->graph, *pass_image(p, N_color), size);
    if (!pass_prepare(p)) return false;
    const size_t index = pass_rays_choose(p);
    return pass_make_late(p, index, false) &&
           drawn_cull(s->drawn, NULL, 1, size[1], pass_value(p, N_lod),
                      pass_value(p, N_max_distance)) &&
           drawn_record(s->drawn, index, &target, 0, 1, NULL) && draw_sky(p, &target);
}

const pass_type forward_type = {
    .name = "forward",
    .shader = "pass/surfaces/forward.frag",
    .meshes = PASS_DRAWS_MESHES,
    PASS_KERNELS,
    .solver = &drawn_kernel_table,
    .declare = forward_declare,
    .defines = forward_defines,
    .foresees = forward_foresees,
    .target = forward_target,
    .allocate = forward_allocate,
    .list_memory = forward_list_memory,
    .update = forward_update,
    .record = forward_record,
    .destroy = forward_destroy,
};
