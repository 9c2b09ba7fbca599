// Shells as meshes: the vertices of a sphere are pushed out in compute, then drawn. Shells are laid
// over each other from the farthest centre to the nearest, of each the far side first, so that what
// shines through one is behind it.
#include "base/error.h"
#include "base/memory.h"
#include "pass/shell_parts.h"
#include <string.h>

enum { FACES = 6, SIDES = 2, CORNERS_OF_SQUARE = 6 }; // a square is two triangles

static uint32_t corners(const pass *p) {
    return pass_number(p, "corners");
}

static uint32_t vertex_count(const pass *p) { // that are pushed out
    return FACES * corners(p) * corners(p);
}

static uint32_t drawn_count(const pass *p) {
    return FACES * CORNERS_OF_SQUARE * (corners(p) - 1) * (corners(p) - 1);
}

shader_define shell_corners_define(const pass *p) {
    return (shader_define){"SHELL_CORNERS", pass_word(p, "corners")};
}

// ---- declaring and building -------------------------------------------------------------------

bool shell_declare_mesh(pass *p) {
    shell_state *s = shell_state_of(p);
    int image = pass_find_image(p, "image");
    p->images[image] = pass_add_target(p, "image", p->formats[image]);
    s->z = pass_add_target(p, "z", GPU_D32F);
    s->drawn_front = pass_add_target(p, "drawn_front", GPU_R32F);
    const graph_image own[] = {s->z, s->drawn_front};
    return p->images[image].id && s->z.id && s->drawn_front.id && pass_declare_images(p) &&
           pass_add_to_graph_with(p, own, COUNT_OF(own));
}

bool shell_check_mesh(pass *p) {
    shell_state *s = shell_state_of(p);
    const shader_define define = shell_corners_define(p);
    return pass_compile(p, "pass/shell.vert", SHADER_VERTEX, &define, 1, &s->vertex) &&
           pass_compile(p, "pass/shell.frag", SHADER_FRAGMENT, &define, 1, &s->fragment);
}

bool shell_build_mesh(pass *p) {
    shell_state *s = shell_state_of(p);
    if (!shell_check_mesh(p)) return false;
    s->vertex_block = arena_alloc(p->host->memory, pass_block_size(&s->vertex) + 16);
    s->fragment_block = arena_alloc(p->host->memory, pass_block_size(&s->fragment) + 16);
    s->draw = pass_create_graphics(p, &s->vertex, &s->fragment,
                                   (gpu_graphics_desc){
                                       .colors = {p->formats[pass_find_image(p, "image")],
                                                  p->formats[pass_find_image(p, "front")]},
                                       .depth = GPU_D32F,
                                       .blend = true,
                                   });
    return s->draw != NULL;
}

// ---- a frame ----------------------------------------------------------------------------------

static bool make_vertices(pass *p) {
    shell_state *s = shell_state_of(p);
    gpu *device = p->host->device;
    uint64_t size = (uint64_t)s->count * vertex_count(p) * SHELL_VERTEX;
    if (s->vertices && gpu_buffer_size(s->vertices) >= size) return true;
    if (s->vertices) gpu_buffer_destroy(device, s->vertices);
    s->vertices =
        gpu_buffer_create(device, &(gpu_buffer_desc){.label = "ShellVertices", .size = size});
    return s->vertices || err_prefix("%s: ", p->label);
}

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

typedef struct drawing { // of one side of one shell
    uint32_t shell;
    int32_t far_side;
} drawing;

static bool fill_stage(pass *p, const shader_binary *binary, unsigned char *block) {
    uint32_t size[3];
    graph_get_size(p->host->graph, pass_output(p, "image"), size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    if (!pass_fill_block(p, binary, block)) return false;
    pass_write_member(binary, block, "picture", picture, sizeof picture);
    return true;
}

static bool bind_stage(pass *p, const shader_binary *binary, unsigned char *block,
                       const drawing *what, gpu_binding *out, size_t *count) {
    const shell_state *s = shell_state_of(p);
    const pass_override overrides[] = {{"ShellRecords", {.buffer = s->records}},
                                       {"ShellVertices", {.buffer = s->vertices}}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    size_t added;
    pass_write_member(binary, block, "shell_at", &what->shell, sizeof what->shell);
    pass_write_member(binary, block, "far_side", &what->far_side, sizeof what->far_side);
    if (!pass_bind(p, binary, block, overrides, COUNT_OF(overrides), bindings, &added))
        return false;
    memcpy(out + *count, bindings, added * sizeof *bindings);
    *count += added;
    return true;
}

static bool draw_side(pass *p, gpu_draw_desc *target, const drawing *what) {
    const shell_state *s = shell_state_of(p);
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_draw draw = {.bindings = bindings, .vertices = drawn_count(p)};
    if (!bind_stage(p, &s->vertex, s->vertex_block, what, bindings, &draw.binding_count) ||
        !bind_stage(p, &s->fragment, s->fragment_block, what, bindings, &draw.binding_count))
        return false;
    target->draws = &draw;
    target->draw_count = 1;
    return gpu_draw_all(p->host->device, target);
}

static bool draw_shells(pass *p, gpu_draw_desc *target) {
    const shell_state *s = shell_state_of(p);
    uint32_t order[PASS_SHELL_MOST];
    int32_t first = pass_has_word(p, "sides", "front") ? 0 : 1;
    if (!fill_stage(p, &s->vertex, s->vertex_block) ||
        !fill_stage(p, &s->fragment, s->fragment_block))
        return false;
    sort(p, order);
    for (uint32_t i = 0; i < s->count; i++)
        for (int32_t side = first; side >= 0; side--)
            if (!draw_side(p, target, &(drawing){order[i], side})) return false;
    return true;
}

bool shell_record_mesh(pass *p) {
    const shell_state *s = shell_state_of(p);
    graph *g = p->host->graph;
    uint32_t size[3];
    gpu_draw_desc target = {
        .pipeline = s->draw,
        .colors = {graph_get_image(g, pass_output(p, "image")), graph_get_image(g, s->drawn_front)},
        .depth = graph_get_image(g, s->z),
        .clear = true,
        .clear_color = {{0}, {1e9f}},
        .clear_depth = 1,
    };
    if (!gpu_draw_all(p->host->device, &target)) return false;
    target.clear = false;
    if (s->count > 0 &&
        !(make_vertices(p) && shell_run(p, SHELL_VERTICES, vertex_count(p), s->count) &&
          draw_shells(p, &target)))
        return false;
    graph_get_size(g, pass_output(p, "image"), size);
    return !graph_get_image(g, pass_output(p, "front")) ||
           shell_run(p, SHELL_FRONT, size[0], size[1]);
}
