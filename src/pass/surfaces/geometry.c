// Geometry: by rays in a compute shader, or drawn (drawn.h). When drawn, the linear depth that
// volumes are tested against is a colour target; the depth buffer proper stays in this pass.
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "pass/surfaces/drawn.h"
#include "scene/bvh.h"

// When drawn: what is shown of materials, as what is read of it is a target or not.
enum { WITH_SURFACE = 1, WITH_EMISSION = 2, VARIANTS = 4 };
enum {
    GEOMETRY_RAYS,
    GEOMETRY_RAYS_FAR, // rays that choose by distance: what is left out, levels of detail
    GEOMETRY_DRAWN,
    GEOMETRY_CHOOSE = GEOMETRY_DRAWN + VARIANTS,
    GEOMETRY_KERNELS = GEOMETRY_CHOOSE + DRAWN_STEPS
};

#define DRAWN_VARIANT                                                                              \
    { .vertex = "pass/surfaces/geometry.vert", .shader = "pass/surfaces/geometry.frag" }
static const pass_kernel kernels[GEOMETRY_KERNELS] = {
    [GEOMETRY_DRAWN] = DRAWN_VARIANT, DRAWN_VARIANT, DRAWN_VARIANT, DRAWN_VARIANT,
    DRAWN_KERNELS(GEOMETRY_CHOOSE),
};

#define NAMES(NAME)                                                                                \
    NAME(albedo), NAME(normal), NAME(depth), NAME(surface), NAME(emission), NAME(mode), NAME(lod), \
        NAME(max_distance), NAME(shown), NAME(placed), NAME(holes)
KERNEL_NAMES(NAMES);

typedef struct geometry_state {
    bool rays;
    drawn *drawn; // when drawn, with
    graph_image z;
} geometry_state;

static bool surfaces_fit(const pass *p) {
    bool fit = true;
    for (size_t i = 0; i < p->mesh_count; i++)
        fit = fit && scene_bvh_surfaces_fit(p->meshes[i], p->host->device);
    for (size_t i = 0; i < p->instances_count; i++) {
        scene_mesh *const *kinds;
        size_t count = scene_instances_kinds(p->instances[i], &kinds);
        for (size_t k = 0; k < count; k++)
            fit = fit && scene_bvh_surfaces_fit(kinds[k], p->host->device);
    }
    return fit;
}

static bool choose_rays(const pass *p) {
    if (!pass_option_is(p, N_mode, "auto")) return pass_option_is(p, N_mode, "rays");
    return gpu_get_profile(p->host->device)->geometry_traces && surfaces_fit(p);
}

static bool declare_targets(pass *p) {
    for (size_t i = 0; i < p->face->image_count; i++) {
        p->images[i] = graph_add_image(
            p->host->graph,
            &(graph_image_desc){
                .name = arena_format(p->host->memory, "%s.%s", p->label, p->face->images[i].name),
                .format = p->formats[i],
                .scale = p->scale,
                .target = true,
                .optional = p->face->images[i].optional,
            });
        if (!p->images[i].id) return false;
    }
    return true;
}

static bool geometry_declare(pass *p) {
    geometry_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->rays = choose_rays(p);
    if (s->rays) return pass_declare_images(p) && pass_add_to_graph(p);
    s->drawn = drawn_create(p, GEOMETRY_CHOOSE, false);
    s->z = pass_add_target(p, "z", GPU_D32F);
    return s->z.id && declare_targets(p) && pass_add_to_graph_with(p, &s->z, 1);
}

// ---- building ---------------------------------------------------------------------------------

static bool is_variant(size_t index) {
    return index >= GEOMETRY_DRAWN && index < GEOMETRY_CHOOSE;
}

static bool geometry_defines(pass *p, size_t index, pass_defines *out) {
    const geometry_state *s = p->state;
    const size_t variant = index - GEOMETRY_DRAWN;
    if (index < GEOMETRY_DRAWN) pass_define_flag(out, "BY_DISTANCE", index == GEOMETRY_RAYS_FAR);
    if (is_variant(index)) {
        pass_define_flag(out, "WITH_SURFACE", variant & WITH_SURFACE);
        pass_define_flag(out, "WITH_EMISSION", variant & WITH_EMISSION);
    }
    return s->rays == (index < GEOMETRY_DRAWN);
}

static size_t variant_of(bool surface, bool emission) {
    return GEOMETRY_DRAWN + (surface ? WITH_SURFACE : 0) + (emission ? WITH_EMISSION : 0);
}

static bool geometry_foresees(const pass *p, size_t index) {
    const graph *g = p->host->graph;
    if (index == GEOMETRY_RAYS)
        return pass_may_be(p, N_lod, 0, false) && pass_may_be(p, N_max_distance, 0, false);
    if (index == GEOMETRY_RAYS_FAR)
        return pass_may_be(p, N_lod, 0, true) || pass_may_be(p, N_max_distance, 0, true);
    return !is_variant(index) || index == variant_of(graph_is_read(g, *pass_image(p, N_surface)),
                                                     graph_is_read(g, *pass_image(p, N_emission)));
}

static void geometry_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    const size_t variant = index - GEOMETRY_DRAWN;
    size_t count = 0;
    out->depth = GPU_D32F;
    for (int i = N_albedo; i <= N_emission; i++)
        if (i < N_surface || variant >> (i - N_surface) & 1)
            out->colors[count++] = p->formats[p->names[i].image];
}

static bool geometry_allocate(pass *p) {
    const geometry_state *s = p->state;
    if (s->rays) return scene_bvh_allocate_surfaces(p->host->bvh, p->host->device);
    return drawn_allocate(s->drawn);
}

static void geometry_list_memory(const pass *p, budget_list *out) {
    const geometry_state *s = p->state; // there since it was declared
    if (!s->rays)
        drawn_list_memory(s->drawn, 1, out);
    else if (budget_list_first(out, p->host->bvh))
        scene_bvh_list_surfaces(p->host->bvh, out);
}

static void geometry_destroy(pass *p) {
    geometry_state *s = p->state;
    if (s) drawn_destroy(s->drawn);
}

// ---- in a frame -------------------------------------------------------------------------------

static void set_bits(pass *p, int name, scene_mesh *const *meshes, size_t mesh_count) {
    uint32_t bits[SCENE_BVH_MAX_MESHES / 32], padded[COUNT_OF(bits)][4] = {0}; // std140
    scene_bvh_choose(p->host->bvh, meshes, mesh_count, p->instances, p->instances_count, bits);
    for (size_t i = 0; i < COUNT_OF(bits); i++) padded[i][0] = bits[i];
    pass_set(p, name, padded, sizeof padded);
}

static bool geometry_update(pass *p) {
    if (!((const geometry_state *)p->state)->rays) return true;
    set_bits(p, N_shown, p->meshes, p->mesh_count);
    set_bits(p, N_placed, NULL, 0);
    pass_set_int(p, N_holes, scene_bvh_has_holes(p->host->bvh));
    return true;
}

static bool trace(pass *p) {
    uint32_t size[3];
    graph_get_size(p->host->graph, *pass_image(p, N_depth), size);
    if (!pass_prepare(p)) return false;
    const bool far = pass_value(p, N_lod) > 0 || pass_value(p, N_max_distance) > 0;
    const size_t index = far ? GEOMETRY_RAYS_FAR : GEOMETRY_RAYS;
    return pass_make_late(p, index, false) && pass_dispatch(p, index, size[0], size[1], 1);
}

static bool geometry_record(pass *p) {
    const geometry_state *s = p->state;
    if (s->rays) return trace(p);
    gpu_image *surface = pass_get_image(p, N_surface), *emission = pass_get_image(p, N_emission);
    const size_t index = variant_of(surface, emission);
    gpu_draw_desc target = {
        .colors = {pass_get_image(p, N_albedo), pass_get_image(p, N_normal),
                   pass_get_image(p, N_depth), surface ? surface : emission,
                   surface ? emission : NULL},
        .depth = graph_get_image(p->host->graph, s->z),
        .clear = true,
        .clear_color = {{0}, {0}, {1e9f}},
        .clear_depth = 1,
    };
    uint32_t size[3];
    graph_get_size(p->host->graph, s->z, size);
    return pass_prepare(p) && pass_make_late(p, index, false) &&
           drawn_cull(s->drawn, NULL, 1, size[1], pass_value(p, N_lod),
                      pass_value(p, N_max_distance)) &&
           drawn_record(s->drawn, index, &target, 0, 1, NULL);
}

const pass_type geometry_type = {
    .name = "geometry",
    .shader = "pass/surfaces/geometry.comp",
    .meshes = PASS_DRAWS_MESHES,
    PASS_KERNELS,
    .solver = &drawn_kernel_table,
    .declare = geometry_declare,
    .defines = geometry_defines,
    .foresees = geometry_foresees,
    .target = geometry_target,
    .allocate = geometry_allocate,
    .list_memory = geometry_list_memory,
    .update = geometry_update,
    .record = geometry_record,
    .destroy = geometry_destroy,
};

bool pass_traces_levels(const pass *p) {
    return p->type == &geometry_type && ((const geometry_state *)p->state)->rays;
}
