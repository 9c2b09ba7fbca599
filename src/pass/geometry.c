// Geometry: by rays in a compute shader, or drawn, one draw per part of every mesh. When drawn, the
// linear depth that volumes are tested against is a colour target; the depth buffer proper stays in
// this pass.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include "scene/bvh.h"
#include <string.h>

typedef struct part_block { // std140, as shaders/lib/mesh.glsl has it
    float transform[16];
    float color[4];
    uint32_t range[4];
} part_block;

typedef struct geometry_state {
    bool rays;
    shader_binary vertex; // drawn: the pass's own is the fragment stage
    graph_image z;
} geometry_state;

static geometry_state *state_of(pass *p) {
    if (!p->state) p->state = arena_alloc(p->host->memory, sizeof(geometry_state));
    return p->state;
}

static bool surfaces_fit(const pass *p) {
    for (size_t i = 0; i < p->mesh_count; i++)
        if (!scene_bvh_surfaces_fit(p->meshes[i], p->host->device)) return false;
    return true;
}

// A software device draws triangles many times faster than it traces rays. Of the others, those for
// computing have few processors that draw, and none was seen to trace slowly.
static bool choose_rays(const pass *p) {
    size_t index;
    pass_find_key(p, "mode", &index);
    const char *mode = p->face->options[index].words[p->options[index]];
    if (strcmp(mode, "auto") != 0) return strcmp(mode, "rays") == 0;
    return p->host->device && gpu_get_info(p->host->device)->kind != GPU_CPU && surfaces_fit(p);
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
            });
        if (!p->images[i].id) return false;
    }
    return true;
}

bool geometry_declare(pass *p) {
    geometry_state *s = state_of(p);
    s->rays = choose_rays(p);
    if (s->rays) return pass_declare_images(p) && pass_add_to_graph(p);
    s->z =
        graph_add_image(p->host->graph, &(graph_image_desc){
                                            .name = arena_format(p->host->memory, "%s.z", p->label),
                                            .format = GPU_D32F,
                                            .scale = p->scale,
                                            .target = true,
                                        });
    return s->z.id && declare_targets(p) && pass_add_to_graph_with(p, &s->z, 1);
}

bool geometry_check(pass *p) {
    if (state_of(p)->rays) return pass_compile(p, p->shader, SHADER_COMPUTE, NULL, 0, &p->binary);
    return pass_compile(p, "pass/geometry.vert", SHADER_VERTEX, NULL, 0, &state_of(p)->vertex) &&
           pass_compile(p, "pass/geometry.frag", SHADER_FRAGMENT, NULL, 0, &p->binary);
}

// The two stages share one set: their shaders number the bindings themselves.
static size_t merge_slots(pass *p, gpu_slot out[GPU_MAX_SLOTS]) {
    size_t count = 0;
    const shader_binary *stages[] = {&state_of(p)->vertex, &p->binary};
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
    if (!geometry_check(p)) return false;
    if (state_of(p)->rays) {
        p->pipeline = pass_create_compute(p, &p->binary);
        return p->pipeline != NULL;
    }
    const shader_binary *vertex = &state_of(p)->vertex;
    gpu_slot slots[GPU_MAX_SLOTS];
    size_t slot_count = merge_slots(p, slots);
    p->pipeline = gpu_pipeline_create_graphics(
        p->host->device, &(gpu_graphics_desc){
                             .label = p->label,
                             .vertex_code = vertex->code,
                             .vertex_size = vertex->size,
                             .fragment_code = p->binary.code,
                             .fragment_size = p->binary.size,
                             .slots = slots,
                             .slot_count = slot_count,
                             .colors = {p->formats[pass_find_image(p, "albedo")],
                                        p->formats[pass_find_image(p, "normal")],
                                        p->formats[pass_find_image(p, "depth")]},
                             .depth = GPU_D32F,
                         });
    return p->pipeline != NULL;
}

bool geometry_allocate(pass *p) {
    if (state_of(p)->rays) return scene_bvh_allocate_surfaces(p->host->bvh, p->host->device);
    for (size_t i = 0; i < p->mesh_count; i++)
        if (!scene_mesh_upload(p->meshes[i], p->host->device)) return false;
    return true;
}

bool geometry_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    uint32_t shown[SCENE_BVH_MAX_MESHES / 32], padded[SCENE_BVH_MAX_MESHES / 32][4] = {0};
    int32_t holes = scene_bvh_has_holes(p->host->bvh);
    scene_bvh_choose(p->host->bvh, p->meshes, p->mesh_count, shown);
    for (size_t i = 0; i < COUNT_OF(shown); i++) padded[i][0] = shown[i]; // std140
    pass_write_member(binary, block, "shown", padded, sizeof padded);
    pass_write_member(binary, block, "holes", &holes, sizeof holes);
    return true;
}

// Slots of both stages, by name; the vertex stage first.
static size_t bind_part(pass *p, const scene_mesh *mesh, const mesh_part *part,
                        const part_block *block, gpu_binding out[GPU_MAX_SLOTS]) {
    const shader_binary *stages[] = {&state_of(p)->vertex, &p->binary};
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
        draw.binding_count = bind_part(p, mesh, part, &block, bindings);
        target->draws = &draw;
        target->draw_count = 1;
        if (!gpu_draw_all(p->host->device, target)) return false;
    }
    return true;
}

bool geometry_record(pass *p) {
    const geometry_state *s = p->state;
    if (s->rays) return pass_record(p);
    graph *g = p->host->graph;
    gpu_draw_desc target = {
        .pipeline = p->pipeline,
        .colors = {graph_get_image(g, pass_output(p, "albedo")),
                   graph_get_image(g, pass_output(p, "normal")),
                   graph_get_image(g, pass_output(p, "depth"))},
        .depth = graph_get_image(g, s->z),
        .clear = true,
        .clear_color = {{0}, {0}, {1e9f}},
        .clear_depth = 1,
    };
    if (!gpu_draw_all(p->host->device, &target)) return false;
    target.clear = false;
    for (size_t i = 0; i < p->mesh_count; i++)
        if (!draw_mesh(p, p->meshes[i], &target)) return false;
    return true;
}
