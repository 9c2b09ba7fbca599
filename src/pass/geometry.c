// Geometry: by rays in a compute shader, or drawn (drawn.h). When drawn, the linear depth that
// volumes are tested against is a colour target; the depth buffer proper stays in this pass.
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/drawn.h"
#include "pass/pass_impl.h"
#include "scene/bvh.h"
#include <string.h>

// When drawn: what is shown of materials, as what is read of it is a target or not.
enum { WITH_SURFACE = 1, WITH_EMISSION = 2, VARIANTS = 4 };

typedef struct geometry_state {
    bool rays;
    drawn *drawn; // when drawn, with
    drawn_stages stages[VARIANTS];
    graph_image z;
} geometry_state;

static geometry_state *state_of(pass *p) {
    if (!p->state) p->state = arena_alloc(p->host->memory, sizeof(geometry_state));
    return p->state;
}

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
    if (!pass_has_word(p, "mode", "auto")) return pass_has_word(p, "mode", "rays");
    return gpu_get_profile(p->host->device)->geometry_traces && surfaces_fit(p);
}

bool pass_traces_levels(const pass *p) {
    return pass_is(p, "geometry") && ((const geometry_state *)p->state)->rays;
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

bool geometry_declare(pass *p) {
    geometry_state *s = state_of(p);
    s->rays = choose_rays(p);
    if (s->rays) return pass_declare_images(p) && pass_add_to_graph(p);
    s->drawn = drawn_create(p);
    s->z = pass_add_target(p, "z", GPU_D32F);
    return s->z.id && declare_targets(p) && pass_add_to_graph_with(p, &s->z, 1);
}

static bool check_variant(pass *p, int variant) {
    const shader_define defines[] = {{"WITH_SURFACE", variant & WITH_SURFACE ? "1" : "0"},
                                     {"WITH_EMISSION", variant & WITH_EMISSION ? "1" : "0"}};
    return drawn_check(p, "pass/geometry.vert", "pass/geometry.frag", defines, COUNT_OF(defines),
                       &state_of(p)->stages[variant]);
}

bool geometry_check(pass *p) {
    geometry_state *s = state_of(p);
    if (s->rays) return pass_compile(p, p->shader, SHADER_COMPUTE, NULL, 0, &p->binary);
    return drawn_check_cull(s->drawn) && check_variant(p, 0) &&
           check_variant(p, WITH_SURFACE | WITH_EMISSION);
}

// One that was not foreseen is made when its targets are first asked for.
static bool build_variant(pass *p, int variant) {
    drawn_stages *stages = &state_of(p)->stages[variant];
    if (stages->pipeline) return true;
    static const char *const names[] = {"albedo", "normal", "depth", "surface", "emission"};
    drawn_target target = {0};
    size_t count = 0;
    for (size_t i = 0; i < COUNT_OF(names); i++)
        if (i < 3 || variant >> (i - 3) & 1)
            target.colors[count++] = p->formats[pass_find_image(p, names[i])];
    return check_variant(p, variant) && drawn_build(p, &target, stages);
}

bool geometry_build(pass *p) {
    geometry_state *s = state_of(p);
    if (s->rays) {
        if (!geometry_check(p)) return false;
        p->pipeline = pass_create_compute(p, &p->binary);
        return p->pipeline != NULL;
    }
    graph *g = p->host->graph;
    int variant = (graph_is_read(g, pass_output(p, "surface")) ? WITH_SURFACE : 0) |
                  (graph_is_read(g, pass_output(p, "emission")) ? WITH_EMISSION : 0);
    if (!drawn_build_cull(s->drawn) || !build_variant(p, variant)) return false;
    p->binary = s->stages[variant].fragment;
    return true;
}

bool geometry_allocate(pass *p) {
    if (state_of(p)->rays) return scene_bvh_allocate_surfaces(p->host->bvh, p->host->device);
    return drawn_allocate(state_of(p)->drawn);
}

void geometry_list_memory(const pass *p, budget_list *out) {
    const geometry_state *s = p->state; // there since it was declared
    if (!s->rays)
        drawn_list_memory(s->drawn, 1, out);
    else if (budget_list_first(out, p->host->bvh))
        scene_bvh_list_surfaces(p->host->bvh, out);
}

void geometry_destroy(pass *p) {
    geometry_state *s = p->state;
    if (!s || s->rays) return;
    drawn_destroy(s->drawn);
    for (int i = 0; i < VARIANTS; i++) drawn_stages_destroy(p, &s->stages[i]);
}

bool geometry_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    uint32_t shown[SCENE_BVH_MAX_MESHES / 32], padded[SCENE_BVH_MAX_MESHES / 32][4] = {0};
    uint32_t placed[SCENE_BVH_MAX_MESHES / 32];
    int32_t holes = scene_bvh_has_holes(p->host->bvh);
    scene_bvh_choose(p->host->bvh, p->meshes, p->mesh_count, p->instances, p->instances_count,
                     shown);
    for (size_t i = 0; i < COUNT_OF(shown); i++) padded[i][0] = shown[i]; // std140
    pass_write_member(binary, block, "shown", padded, sizeof padded);
    scene_bvh_choose(p->host->bvh, NULL, 0, p->instances, p->instances_count, placed);
    for (size_t i = 0; i < COUNT_OF(placed); i++) padded[i][0] = placed[i];
    pass_write_member(binary, block, "placed", padded, sizeof padded);
    pass_write_member(binary, block, "holes", &holes, sizeof holes);
    return true;
}

bool geometry_record(pass *p) {
    geometry_state *s = p->state;
    if (s->rays) return pass_record(p);
    graph *g = p->host->graph;
    gpu_image *surface = graph_get_image(g, pass_output(p, "surface"));
    gpu_image *emission = graph_get_image(g, pass_output(p, "emission"));
    int variant = (surface ? WITH_SURFACE : 0) | (emission ? WITH_EMISSION : 0);
    gpu_draw_desc target = {
        .colors = {graph_get_image(g, pass_output(p, "albedo")),
                   graph_get_image(g, pass_output(p, "normal")),
                   graph_get_image(g, pass_output(p, "depth")), surface ? surface : emission,
                   surface ? emission : NULL},
        .depth = graph_get_image(g, s->z),
        .clear = true,
        .clear_color = {{0}, {0}, {1e9f}},
        .clear_depth = 1,
    };
    uint32_t size[3];
    graph_get_size(g, s->z, size);
    return build_variant(p, variant) && pass_prepare(p) &&
           drawn_cull(s->drawn, NULL, 1, size[1], pass_evaluate(p, "lod"),
                      pass_evaluate(p, "max_distance")) &&
           drawn_record(s->drawn, &s->stages[variant], &target, 0, 1, NULL);
}
