// Shells as meshes: the vertices of a sphere are pushed out in compute, then drawn. Shells are laid
// over each other from the farthest centre to the nearest, of each the far side first, so that what
// shines through one is behind it.
#include "base/memory.h"
#include "pass/shell/shell_parts.h"

enum { FACES = 6, SIDES = 2, CORNERS_OF_SQUARE = 6 }; // a square is two triangles

static uint32_t vertex_count(const shell_state *s) { // that are pushed out
    return FACES * s->corners * s->corners;
}

static uint32_t drawn_count(const shell_state *s) {
    return FACES * CORNERS_OF_SQUARE * (s->corners - 1) * (s->corners - 1);
}

// ---- declaring and building -------------------------------------------------------------------

bool shell_declare_mesh(pass *p) {
    shell_state *s = shell_state_of(p);
    graph_image *image = pass_image(p, N_image);
    *image = pass_add_target(p, "image", p->formats[p->names[N_image].image]);
    s->z = pass_add_target(p, "z", GPU_D32F);
    s->drawn_front = pass_add_target(p, "drawn_front", GPU_R32F);
    const graph_image own[] = {s->z, s->drawn_front};
    return image->id && s->z.id && s->drawn_front.id && pass_declare_images(p) &&
           pass_add_to_graph_with(p, own, COUNT_OF(own));
}

void shell_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    (void)index;
    *out = (gpu_graphics_desc){
        .colors = {p->formats[p->names[N_image].image], p->formats[p->names[N_front].image]},
        .depth = GPU_D32F,
        .blend = true,
    };
}

uint64_t shell_vertices_bytes(const shell_state *s) {
    const uint64_t most = s->list ? PASS_SHELL_MOST : 1;
    return s->drawn ? most * vertex_count(s) * SHELL_VERTEX : 0;
}

// ---- a frame ----------------------------------------------------------------------------------

static float distance_of(const pass *p, const float place[3]) {
    return glm_vec3_distance2((float *)(uintptr_t)place, (float *)(uintptr_t)p->host->frame->eye.v);
}

// Numbers of the shells, the farthest first.
static void sort(pass *p, uint32_t out[PASS_SHELL_MOST]) {
    const shell_state *s = shell_state_of(p);
    for (uint32_t i = 0; i < s->count; i++) {
        uint32_t at = i;
        float distance = distance_of(p, s->places[i]);
        for (; at > 0 && distance_of(p, s->places[out[at - 1]]) < distance; at--)
            out[at] = out[at - 1];
        out[at] = i;
    }
}

static bool draw_side(pass *p, kernel *k, gpu_draw_desc *target, uint32_t shell, int32_t far_side) {
    gpu_binding kept[GPU_MAX_SLOTS];
    kernel_set_int(k, N_shell_at, (int32_t)shell);
    kernel_set_int(k, N_far_side, far_side);
    gpu_draw draw = kernel_draw(k, kept);
    draw.vertices = drawn_count(shell_state_of(p));
    target->draws = &draw;
    target->draw_count = 1;
    return gpu_draw_all(p->host->device, target);
}

static bool draw_shells(pass *p, gpu_draw_desc *target) {
    const shell_state *s = shell_state_of(p);
    uint32_t order[PASS_SHELL_MOST];
    const int32_t first = s->both_sides ? 1 : 0;
    kernel *k = shell_use(p, SHELL_DRAW);
    if (!k) return false;
    sort(p, order);
    for (uint32_t i = 0; i < s->count; i++)
        for (int32_t side = first; side >= 0; side--)
            if (!draw_side(p, k, target, order[i], side)) return false;
    return true;
}

bool shell_record_mesh(pass *p) {
    const shell_state *s = shell_state_of(p);
    graph *g = p->host->graph;
    uint32_t size[3];
    kernel *k = shell_use(p, SHELL_DRAW);
    if (!k) return false;
    gpu_draw_desc target = {
        .pipeline = k->pipeline,
        .colors = {pass_get_image(p, N_image), graph_get_image(g, s->drawn_front)},
        .depth = graph_get_image(g, s->z),
        .clear = true,
        .clear_color = {{0}, {1e9f}},
        .clear_depth = 1,
    };
    if (!gpu_draw_all(p->host->device, &target)) return false;
    target.clear = false;
    if (s->count > 0 &&
        !(shell_run(p, SHELL_VERTICES, vertex_count(s), s->count) && draw_shells(p, &target)))
        return false;
    graph_get_size(g, *pass_image(p, N_image), size);
    return !pass_get_image(p, N_front) || shell_run(p, SHELL_FRONT, size[0], size[1]);
}
