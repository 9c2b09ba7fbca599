// Evaluates a field on the GPU at given points.
#pragma once
#include "gpu_test.h"

#include "base/file.h"
#include "field/program.h"
#include "shader/shader.h"
#include <string.h>

enum { PROBE_TEXTURES = 16 };

static inline gpu_image *probe_texture(gpu *g, const field_texture *texture, double time,
                                       gpu_image **made) {
    if (texture->index) return texture->grid->state.index[texture->set][texture->image];
    if (texture->grid) return texture->grid->state.images[texture->set][texture->image];
    uint16_t texels[PALETTE_SIZE * 4];
    palette_bake(texture->palette, time, texels);
    *made = gpu_image_create(g, &(gpu_image_desc){.label = "palette",
                                                  .format = GPU_RGBA16F,
                                                  .width = PALETTE_SIZE,
                                                  .height = 1,
                                                  .use = GPU_USE_SAMPLED});
    gpu_test_ok(*made);
    gpu_test_ok(gpu_image_write(g, *made, 0, texels, sizeof texels));
    return *made;
}

// Compiles the text around `fields` and runs it; `expression` is GLSL for a vec4, of the point p.
// False with a message: it is not accepted.
static inline bool probe_try(gpu *g, const field_program *fields, const char *expression,
                             const shader_define *define, const field_context *context,
                             const float (*points)[4], size_t count, float (*out)[4]) {
    arena memory = {0};
    char root[PATH_CAP], data[PATH_CAP];
    path_join(root, getenv("ROIL_SOURCE_DIR") ? getenv("ROIL_SOURCE_DIR") : "..", "shaders");
    path_join(data, getenv("ROIL_TEST_DATA") ? getenv("ROIL_TEST_DATA") : ".", "gpu/data");
    shader_library *library =
        shader_library_create(&(shader_library_desc){.shader_root = root, .effect_root = data});
    gpu_test_ok(library);
    shader_define defines[2] = {{"PROBE", expression}};
    if (define) defines[1] = *define;
    shader_text text = {"fields.glsl", field_program_text(fields)};
    shader_compile_desc desc = {.name = "field_probe.comp",
                                .stage = SHADER_COMPUTE,
                                .defines = defines,
                                .define_count = define ? 2 : 1,
                                .texts = &text,
                                .text_count = 1};
    shader_binary binary;
    if (!shader_compile(library, &memory, &desc, &binary)) {
        shader_library_destroy(library);
        arena_free(&memory);
        return false;
    }

    gpu_slot slots[GPU_MAX_SLOTS];
    for (size_t i = 0; i < binary.slot_count; i++) slots[i] = binary.slots[i].slot;
    gpu_pipeline *pipeline = gpu_pipeline_create_compute(
        g, &(gpu_compute_desc){
               .label = "probe",
               .code = binary.code,
               .code_size = binary.size,
               .slots = slots,
               .slot_count = binary.slot_count,
               .local_size = {binary.local_size[0], binary.local_size[1], binary.local_size[2]}});
    gpu_test_ok(pipeline);
    gpu_buffer *from =
        gpu_buffer_create(g, &(gpu_buffer_desc){.label = "points", .size = 16 * count});
    gpu_buffer *to =
        gpu_buffer_create(g, &(gpu_buffer_desc){.label = "results", .size = 16 * count});
    gpu_test_ok(from && to);
    gpu_test_ok(gpu_buffer_write(g, from, 0, points, 16 * count));

    size_t block_size = field_program_block_size(fields), bound = 0, made_count = 0;
    void *block = mem_alloc(block_size + 1);
    gpu_test_ok(field_program_fill(fields, context, block));
    const field_texture *textures;
    size_t texture_count = field_program_textures(fields, &textures);
    gpu_image *made[PROBE_TEXTURES] = {NULL};
    gpu_binding bindings[GPU_MAX_SLOTS] = {{0}};
    for (size_t i = 0; i < binary.slot_count; i++) {
        const shader_slot *slot = &binary.slots[i];
        gpu_binding *b = &bindings[bound++];
        b->binding = slot->slot.binding;
        if (strcmp(slot->name, "Points") == 0)
            b->buffer = from;
        else if (strcmp(slot->name, "Results") == 0)
            b->buffer = to;
        else if (strcmp(slot->name, "FieldNumbers") == 0) {
            b->uniform = block;
            b->uniform_size = block_size;
        } else {
            for (size_t t = 0; t < texture_count; t++)
                if (strcmp(textures[t].glsl_name, slot->name) == 0)
                    b->image = probe_texture(g, &textures[t], context->time, &made[made_count++]);
            assert_non_null(b->image);
            if (gpu_image_get_desc(b->image)->format == GPU_R32U) b->sampler = GPU_NEAREST_CLAMP;
        }
    }
    gpu_test_ok(gpu_frame_begin(g));
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = bound,
                                                     .threads = {(uint32_t)count}}));
    gpu_test_ok(gpu_frame_end(g));
    gpu_test_ok(gpu_buffer_read(g, to, 0, out, 16 * count));
    for (size_t i = 0; i < made_count; i++) gpu_image_destroy(g, made[i]);
    gpu_buffer_destroy(g, from);
    gpu_buffer_destroy(g, to);
    gpu_pipeline_destroy(g, pipeline);
    mem_free(block);
    shader_library_destroy(library);
    arena_free(&memory);
    return true;
}

// What is accepted.
static inline void probe_program(gpu *g, const field_program *fields, const char *expression,
                                 const shader_define *define, const field_context *context,
                                 const float (*points)[4], size_t count, float (*out)[4]) {
    if (!probe_try(g, fields, expression, define, context, points, count, out))
        fail_msg("%s\n%s", err_get(), field_program_text(fields));
}

static inline void probe(gpu *g, const field *node, const field_context *context,
                         const float (*points)[4], size_t count, float (*out)[4]) {
    arena memory = {0};
    field_root root = {"probe", node, node->components, ""};
    field_program *fields = field_program_create(&memory, &root, 1);
    gpu_test_ok(fields);
    const char *expression = node->components == 1   ? "vec4(field_probe(p), 0, 0, 0)"
                             : node->components == 3 ? "vec4(field_probe(p), 0)"
                                                     : "field_probe(p)";
    probe_program(g, fields, expression, NULL, context, points, count, out);
    arena_free(&memory);
}
