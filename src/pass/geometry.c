// Geometry: one draw per part of every mesh, then one dispatch for the sky. The linear depth that
// the volume is tested against is a colour target; the depth buffer proper stays in this pass.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

typedef struct part_block { // std140, as shaders/lib/mesh.glsl has it
    float transform[16];
    float color[4];
    uint32_t range[4];
} part_block;

typedef struct geometry_state {
    shader_binary vertex, fragment;
    gpu_pipeline *meshes; // NULL when there is no mesh
    graph_image z;
} geometry_state;

static geometry_state *state_of(pass *p) {
    if (!p->state) p->state = arena_alloc(p->host->memory, sizeof(geometry_state));
    return p->state;
}

static bool add_target(pass *p, const char *output) {
    int index = pass_find_image(p, output);
    p->images[index] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.%s", p->label, output),
                            .format = p->formats[index],
                            .scale = p->scale,
                            .target = true,
                        });
    return p->images[index].id != 0;
}

bool geometry_declare(pass *p) {
    geometry_state *s = state_of(p);
    s->z =
        graph_add_image(p->host->graph, &(graph_image_desc){
                                            .name = arena_format(p->host->memory, "%s.z", p->label),
                                            .format = GPU_D32F,
                                            .scale = p->scale,
                                            .target = true,
                                        });
    return s->z.id && add_target(p, "color") && add_target(p, "sun") && add_target(p, "depth") &&
           pass_declare_images(p) && pass_add_to_graph_with(p, &s->z, 1);
}

static bool compile_mesh(pass *p, geometry_state *s) {
    return pass_compile(p, "pass/geometry.vert", SHADER_VERTEX, NULL, 0, &s->vertex) &&
           pass_compile(p, "pass/geometry.frag", SHADER_FRAGMENT, NULL, 0, &s->fragment);
}

bool geometry_check(pass *p) {
    return compile_mesh(p, state_of(p)) &&
           pass_compile(p, p->shader, SHADER_COMPUTE, NULL, 0, &p->binary);
}

// The two stages share one set: their shaders number the bindings themselves.
static size_t merge_slots(const geometry_state *s, gpu_slot out[GPU_MAX_SLOTS]) {
    size_t count = 0;
    const shader_binary *stages[] = {&s->vertex, &s->fragment};
    for (int stage = 0; stage < 2; stage++) {
        for (size_t i = 0; i < stages[stage]->slot_count; i++) {
            const gpu_slot *slot = &stages[stage]->slots[i].slot;
            bool known = false;
            for (size_t k = 0; k < count; k++) known = known || out[k].binding == slot->binding;
            if (!known && count < GPU_MAX_SLOTS) out[count++] = *slot;
        }
    }
    return count;
}

bool geometry_build(pass *p) {
    geometry_state *s = state_of(p);
    if (!geometry_check(p)) return false;
    p->pipeline = pass_create_compute(p, &p->binary);
    if (!p->pipeline) return false;
    if (!p->mesh_count) return true;
    gpu_slot slots[GPU_MAX_SLOTS];
    size_t slot_count = merge_slots(s, slots);
    s->meshes = gpu_pipeline_create_graphics(
        p->host->device, &(gpu_graphics_desc){
                             .label = p->label,
                             .vertex_code = s->vertex.code,
                             .vertex_size = s->vertex.size,
                             .fragment_code = s->fragment.code,
                             .fragment_size = s->fragment.size,
                             .slots = slots,
                             .slot_count = slot_count,
                             .colors = {p->formats[pass_find_image(p, "color")],
                                        p->formats[pass_find_image(p, "sun")],
                                        p->formats[pass_find_image(p, "depth")]},
                             .depth = GPU_D32F,
                         });
    return s->meshes != NULL;
}

// Slots of both stages, by name; the vertex stage first.
static size_t bind_part(const pass *p, const geometry_state *s, const scene_mesh *mesh,
                        const mesh_part *part, const part_block *block,
                        gpu_binding out[GPU_MAX_SLOTS]) {
    const shader_binary *stages[] = {&s->vertex, &s->fragment};
    size_t count = 0;
    for (int stage = 0; stage < 2; stage++) {
        for (size_t i = 0; i < stages[stage]->slot_count; i++) {
            const shader_slot *slot = &stages[stage]->slots[i];
            bool bound = false;
            for (size_t k = 0; k < count; k++)
                bound = bound || out[k].binding == slot->slot.binding;
            if (bound) continue;
            gpu_binding *binding = &out[count++];
            *binding = (gpu_binding){.binding = slot->slot.binding};
            if (strcmp(slot->name, "Frame") == 0) {
                binding->uniform = p->host->frame;
                binding->uniform_size = sizeof *p->host->frame;
            } else if (strcmp(slot->name, "Part") == 0) {
                binding->uniform = block;
                binding->uniform_size = sizeof *block;
            } else if (strcmp(slot->name, "Vertices") == 0) {
                binding->buffer = mesh->vertices;
            } else if (strcmp(slot->name, "Indices") == 0) {
                binding->buffer = mesh->indices;
            } else {
                binding->image = part->texture >= 0 ? mesh->textures[part->texture] : p->blank[0];
                binding->sampler = GPU_LINEAR_REPEAT;
            }
        }
    }
    return count;
}

static bool draw_mesh(pass *p, const scene_mesh *mesh, gpu_draw_desc *target) {
    geometry_state *s = p->state;
    mat4 transform;
    float tint[4];
    if (!scene_mesh_place(mesh, p->host->context, transform, tint)) return false;
    for (uint32_t i = 0; i < mesh->data.part_count; i++) {
        const mesh_part *part = &mesh->data.parts[i];
        part_block block = {.range = {part->first, part->texture >= 0, 0, 0}};
        memcpy(block.transform, transform, sizeof block.transform);
        for (int c = 0; c < 3; c++) block.color[c] = part->color[c] * tint[c];
        block.color[3] = part->color[3];
        gpu_binding bindings[GPU_MAX_SLOTS];
        gpu_draw draw = {.bindings = bindings, .vertices = part->count};
        draw.binding_count = bind_part(p, s, mesh, part, &block, bindings);
        target->draws = &draw;
        target->draw_count = 1;
        if (!gpu_draw_all(p->host->device, target)) return false;
        target->clear = false;
    }
    return true;
}

bool geometry_record(pass *p) {
    geometry_state *s = p->state;
    graph *g = p->host->graph;
    graph_image color = p->images[pass_find_image(p, "color")];
    graph_image sun = p->images[pass_find_image(p, "sun")];
    graph_image depth = p->images[pass_find_image(p, "depth")];
    if (s->meshes) {
        gpu_draw_desc target = {
            .pipeline = s->meshes,
            .colors = {graph_get_image(g, color), graph_get_image(g, sun),
                       graph_get_image(g, depth)},
            .depth = graph_get_image(g, s->z),
            .clear = true,
            .clear_depth = 1,
        };
        for (size_t i = 0; i < p->mesh_count; i++)
            if (!draw_mesh(p, p->meshes[i], &target)) return false;
    } else {
        gpu_image_clear(p->host->device, graph_get_image(g, depth), (float[4]){0});
    }
    return pass_record(p);
}

void geometry_destroy(pass *p) {
    geometry_state *s = p->state;
    if (s && s->meshes) gpu_pipeline_destroy(p->host->device, s->meshes);
}
