// A small world for tests of passes: a graph, a camera at (0, -5, 0) that looks along +Y, no sun
// and no sky unless the test says so.
#pragma once
#include "effect/effect.h"
#include "gpu_test.h"
#include "media/mesh_levels.h"
#include "pass/pass.h"
#include "scene/bvh.h"
#include <math.h>
#include <string.h>

typedef struct pass_world {
    arena memory;
    pass_host host;
    scene scene;
    field_context context;
    struct frame_block frame;
    struct light_block lights;
    pass *passes[16];
    size_t count;
    scene_mesh meshes[4];
    size_t mesh_count;
    scene_instances *instances[2];
    size_t instances_count;
} pass_world;

static inline const field *number(pass_world *w, float value) {
    return field_constant(&w->memory, 1, (float[4]){value});
}

static inline const field *triple(pass_world *w, float x, float y, float z) {
    return field_constant(&w->memory, 3, (float[4]){x, y, z});
}

// A hard-edged box of half-size `half` around the origin, times `value`.
static inline const field *block(pass_world *w, float half, float value) {
    const field *args[FIELD_MAX_ARGS] = {triple(w, 0, 0, 0),
                                         triple(w, 2 * half, 2 * half, 2 * half), number(w, 0)};
    const field *shape = field_make(&w->memory, "box", args, NULL);
    gpu_test_ok(shape);
    const field *factors[FIELD_MAX_ARGS] = {shape, number(w, value)};
    const field *product = field_make(&w->memory, "mul", factors, NULL);
    gpu_test_ok(product);
    return product;
}

// A kind's row with arguments and options by name:
// row(w, "worley", SET("power", number(w, 2)), WORD("mode", "paper"))
typedef struct pass_named {
    const char *name;
    const field *value;
    const char *word;
} pass_named;

#define SET(NAME, VALUE)                                                                           \
    { NAME, VALUE, NULL }
#define WORD(NAME, CHOICE)                                                                         \
    { NAME, NULL, CHOICE }
#define row(w, kind, ...)                                                                          \
    pass_row(&(w)->memory, kind, (const pass_named[]){__VA_ARGS__},                                \
             sizeof((const pass_named[]){__VA_ARGS__}) / sizeof(pass_named))

static inline const field *pass_row(arena *memory, const char *name, const pass_named *settings,
                                    size_t count) {
    const field_kind *kind = field_kind_find(name);
    gpu_test_ok(kind);
    const field *args[FIELD_MAX_ARGS] = {NULL};
    uint8_t options[FIELD_MAX_OPTIONS] = {0};
    for (size_t s = 0; s < count; s++) {
        bool found = false;
        for (size_t i = 0; settings[s].value && i < FIELD_MAX_ARGS && kind->args[i].desc.name;
             i++) {
            if (strcmp(kind->args[i].desc.name, settings[s].name) != 0) continue;
            args[i] = settings[s].value;
            found = true;
        }
        for (size_t i = 0; settings[s].word && i < FIELD_MAX_OPTIONS; i++) {
            const field_option *option = &kind->options[i];
            if (!option->name || strcmp(option->name, settings[s].name) != 0) continue;
            for (uint8_t w = 0; w < COUNT_OF(option->words) && option->words[w]; w++)
                if (strcmp(option->words[w], settings[s].word) == 0) options[i] = w, found = true;
        }
        if (!found) fail_msg("%s has no '%s'", name, settings[s].name);
    }
    const field *made = field_make(memory, name, args, options);
    gpu_test_ok(made);
    return made;
}

static inline void world_open(pass_world *w, gpu *device) {
    *w = (pass_world){0};
    char shaders[4096], data[4096];
    snprintf(shaders, sizeof shaders, "%s/shaders", getenv("ROIL_SOURCE_DIR"));
    snprintf(data, sizeof data, "%s/tests/gpu/data", getenv("ROIL_SOURCE_DIR"));
    w->host = (pass_host){
        .device = device,
        .library = shader_library_create(
            &(shader_library_desc){.shader_root = shaders, .effect_root = data}),
        .graph = graph_create(),
        .memory = &w->memory,
        .context = &w->context,
        .frame = &w->frame,
        .lights = &w->lights,
        .scene = &w->scene,
    };
    gpu_test_ok(w->host.library);
    scene_init(&w->scene, &w->memory);
    w->scene.camera.eye = triple(w, 0, -5, 0);
    w->scene.camera.target = triple(w, 0, 0, 0);
    w->scene.sun.strength = number(w, 0);
    w->scene.sky.strength = number(w, 0);
}

static inline pass *world_add(pass_world *w, const char *type, const char *shader,
                              const char *label) {
    pass *p = pass_create(&w->host, type ? pass_type_find(type) : NULL, shader, label);
    gpu_test_ok(p);
    w->passes[w->count++] = p;
    return p;
}

// A file of tests/gpu/data, unmoved and white.
static inline scene_mesh *world_mesh(pass_world *w, const char *file) {
    char root[4096], path[4200];
    snprintf(root, sizeof root, "%s/tests/gpu/data", getenv("ROIL_SOURCE_DIR"));
    snprintf(path, sizeof path, "%s/%s", root, file);
    scene_mesh *mesh = &w->meshes[w->mesh_count++];
    *mesh = (scene_mesh){.name = file,
                         .position = triple(w, 0, 0, 0),
                         .rotation = triple(w, 0, 0, 0),
                         .scale = number(w, 1),
                         .color = triple(w, 1, 1, 1)};
    gpu_test_ok(mesh_load(path, root, &w->memory, &mesh->data));
    return mesh;
}

// As they are made when a file is read.
static inline void world_make_levels(pass_world *w, scene_mesh *mesh) {
    mesh_data *data = &mesh->data;
    mesh_levels levels;
    mesh_levels_make(data, &w->memory, &levels);
    size_t own = data->index_count * sizeof *data->indices;
    size_t more = levels.index_count * sizeof *data->indices;
    unsigned char *all = arena_alloc(&w->memory, own + more);
    memcpy(all, data->indices, own);
    memcpy(all + own, levels.indices, more);
    data->indices = (const uint32_t *)(const void *)all;
    data->level_index_count = levels.index_count;
    data->level_count = levels.count;
    for (uint32_t i = 0; i < levels.count; i++)
        data->levels[i] = (mesh_level){levels.errors[i], levels.runs[i]};
}

// One more frame of what world_render built.
static inline void world_frame(pass_world *w, uint32_t width, uint32_t height, uint32_t frame) {
    gpu_test_ok(scene_fill_frame(&w->scene, &w->context, (float)width / (float)height, &w->frame));
    gpu_test_ok(scene_fill_lights(&w->scene, &w->context, &w->lights));
    w->frame.size = (shared_uvec4){{width, height, frame, 0}};
    gpu_test_ok(gpu_frame_begin(w->host.device));
    for (size_t i = 0; i < w->instances_count; i++)
        gpu_test_ok(scene_instances_upload(w->instances[i], w->host.device));
    gpu_test_ok(scene_bvh_update(w->host.bvh, w->host.device, &w->context));
    gpu_test_ok(graph_execute(w->host.graph, w->host.device));
    gpu_test_ok(gpu_frame_end(w->host.device));
}

static inline void world_render(pass_world *w, uint32_t width, uint32_t height,
                                graph_image output) {
    graph_add_output(w->host.graph, output);
    for (size_t i = 0; i < w->count; i++) gpu_test_ok(pass_complete(w->passes[i]));
    gpu_test_ok(graph_compile(w->host.graph, width, height));
    scene_mesh *meshes[COUNT_OF(w->meshes)];
    for (size_t i = 0; i < w->mesh_count; i++) meshes[i] = &w->meshes[i];
    w->host.bvh = scene_bvh_create(meshes, w->mesh_count, w->instances, w->instances_count, true);
    gpu_test_ok(w->host.bvh && scene_bvh_allocate(w->host.bvh, w->host.device));
    for (size_t i = 0; i < w->instances_count; i++)
        gpu_test_ok(scene_instances_allocate(w->instances[i], w->host.device));
    for (size_t i = 0; i < w->count; i++)
        gpu_test_ok(pass_build(w->passes[i]) && pass_allocate(w->passes[i]));
    gpu_test_ok(graph_allocate(w->host.graph, w->host.device));
    world_frame(w, width, height, 1);
}

// RGBA floats of a half-float image; free with mem_free.
static inline float *world_read(pass_world *w, graph_image image) {
    gpu_image *source = graph_get_image(w->host.graph, image);
    const gpu_image_desc *desc = gpu_image_get_desc(source);
    size_t count = (size_t)desc->width * desc->height * 4;
    uint16_t *halves = mem_alloc(count * 2);
    gpu_test_ok(gpu_image_read(w->host.device, source, halves, count * 2));
    float *out = mem_alloc(count * sizeof *out);
    for (size_t i = 0; i < count; i++) out[i] = half_to_float(halves[i]);
    mem_free(halves);
    return out;
}

// Texels of an r32f image, or the first channel of an rg32f one; free with mem_free.
static inline float *world_read_depth(pass_world *w, graph_image image) {
    gpu_image *source = graph_get_image(w->host.graph, image);
    const gpu_image_desc *desc = gpu_image_get_desc(source);
    size_t count = (size_t)desc->width * desc->height;
    size_t channels = desc->format == GPU_RG32F ? 2 : 1;
    float *out = mem_alloc(count * channels * sizeof *out);
    gpu_test_ok(gpu_image_read(w->host.device, source, out, count * channels * sizeof *out));
    for (size_t i = 0; i < count; i++) out[i] = out[channels * i];
    return out;
}

static inline void world_close(pass_world *w) {
    for (size_t i = 0; i < w->count; i++) pass_destroy(w->passes[i]);
    for (size_t i = 0; i < w->mesh_count; i++) scene_mesh_destroy(&w->meshes[i], w->host.device);
    for (size_t i = 0; i < w->instances_count; i++)
        scene_instances_destroy(w->instances[i], w->host.device);
    scene_bvh_destroy(w->host.bvh, w->host.device);
    graph_destroy(w->host.graph, w->host.device);
    pass_host_free(&w->host);
    shader_library_destroy(w->host.library);
    arena_free(&w->memory);
}
