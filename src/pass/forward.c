// Forward: what `geometry` shows and `shade` lights, in one pass over the triangles (drawn.h). Then
// the sky, where nothing was drawn.
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/drawn.h"
#include "pass/pass_impl.h"
#include "pass/rays.h"
#include "pass/shadow_maps.h"

typedef struct forward_state {
    drawn *drawn;
    drawn_stages stages[2], sky; // with few and with many rays
    graph_image z;
} forward_state;

bool forward_declare(pass *p) {
    forward_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    if (!pass_choose_shadows(p)) return false;
    s->drawn = drawn_create(p);
    s->z = pass_add_target(p, "z", GPU_D32F);
    return s->z.id && pass_declare_images(p) && pass_add_to_graph_with(p, &s->z, 1);
}

bool forward_check(pass *p) {
    forward_state *s = p->state;
    for (int i = 0; i < 2; i++)
        if (!drawn_check(p, "pass/geometry.vert", p->shader, &pass_rays_variants[i], 1,
                         &s->stages[i]))
            return false;
    return drawn_check_cull(s->drawn) &&
           drawn_check(p, "pass/forward_sky.vert", "pass/forward_sky.frag", NULL, 0, &s->sky);
}

static bool make(pass *p, drawn_stages *stages) {
    drawn_target target = {0};
    size_t count = 0;
    for (size_t i = 0; i < p->face->image_count; i++)
        if (p->face->images[i].output) target.colors[count++] = p->formats[i];
    return stages->pipeline || drawn_build(p, &target, stages);
}

bool forward_build(pass *p) {
    forward_state *s = p->state;
    bool can[2];
    pass_rays_foresee(p, can);
    if (!forward_check(p) || !drawn_build_cull(s->drawn) || !make(p, &s->sky)) return false;
    p->binary = s->stages[1].fragment; // has all that the other has
    return (!can[0] || make(p, &s->stages[0])) && (!can[1] || make(p, &s->stages[1]));
}

bool forward_allocate(pass *p) {
    return drawn_allocate(((forward_state *)p->state)->drawn);
}

void forward_list_memory(const pass *p, budget_list *out) {
    drawn_list_memory(((const forward_state *)p->state)->drawn, 1, out);
}

void forward_destroy(pass *p) {
    forward_state *s = p->state;
    if (!s) return;
    drawn_destroy(s->drawn);
    drawn_stages_destroy(p, &s->sky);
    for (int i = 0; i < 2; i++) drawn_stages_destroy(p, &s->stages[i]);
}

// ---- in a frame -------------------------------------------------------------------------------

static void picture_size(const pass *p, uint32_t size[3]) {
    graph_get_size(p->host->graph, pass_output(p, "color"), size);
}

bool forward_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    uint32_t size[3];
    picture_size(p, size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    pass_write_member(binary, block, "picture", picture, sizeof picture);
    return true;
}

static bool draw_sky(pass *p, gpu_draw_desc *target) {
    drawn_stages *sky = &((forward_state *)p->state)->sky;
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_draw draw = {.bindings = bindings, .vertices = 3};
    target->pipeline = sky->pipeline;
    target->clear = false;
    target->draws = &draw;
    target->draw_count = 1;
    return pass_fill_block(p, &sky->fragment, sky->blocks[1]) &&
           pass_bind(p, &sky->fragment, sky->blocks[1], NULL, 0, bindings, &draw.binding_count) &&
           gpu_draw_all(p->host->device, target);
}

bool forward_record(pass *p) {
    forward_state *s = p->state;
    drawn_stages *stages = &s->stages[pass_rays_many(p)];
    gpu_draw_desc target = {
        .depth = graph_get_image(p->host->graph, s->z), .clear = true, .clear_depth = 1};
    size_t count = 0;
    for (size_t i = 0; i < p->face->image_count; i++)
        if (p->face->images[i].output)
            target.colors[count++] = graph_get_image(p->host->graph, p->images[i]);
    uint32_t size[3];
    picture_size(p, size);
    return make(p, stages) && pass_prepare(p) &&
           drawn_cull(s->drawn, NULL, 1, size[1], pass_evaluate(p, "lod"),
                      pass_evaluate(p, "max_distance")) &&
           drawn_record(s->drawn, stages, &target, 0, 1, NULL) && draw_sky(p, &target);
}
