// Shaders of a solver: compiled with its structure, bound by the names of their slots.
#include "base/error.h"
#include "sim/lbm_impl.h"
#include <string.h>

static uint32_t block_size(const shader_binary *binary) {
    for (size_t i = 0; i < binary->slot_count; i++)
        if (strcmp(binary->slots[i].name, "Uniforms") == 0) return binary->slots[i].size;
    return 0;
}

bool lbm_kernel_compile(lbm *l, lbm_kernel *k, const char *shader, shader_library *library,
                        const shader_reader *reader, const shader_define *more, size_t more_count) {
    shader_define defines[2 * LBM_MAX_DEFINES];
    memcpy(defines, l->defines, l->define_count * sizeof *defines);
    if (more_count) memcpy(defines + l->define_count, more, more_count * sizeof *defines);
    shader_compile_desc desc = {.name = shader,
                                .stage = SHADER_COMPUTE,
                                .defines = defines,
                                .define_count = l->define_count + more_count,
                                .reader = reader};
    if (!shader_compile(library, l->memory, &desc, &k->binary)) return false;
    k->shader = shader;
    k->block = arena_alloc(l->memory, block_size(&k->binary) + 16);
    return true;
}

bool lbm_kernel_build(lbm_kernel *k, gpu *g) {
    gpu_slot slots[GPU_MAX_SLOTS];
    if (k->binary.slot_count > GPU_MAX_SLOTS)
        return err_set("%s: %zu slots; at most %d are accepted", k->shader, k->binary.slot_count,
                       GPU_MAX_SLOTS);
    for (size_t i = 0; i < k->binary.slot_count; i++) slots[i] = k->binary.slots[i].slot;
    gpu_compute_desc desc = {.label = k->shader,
                             .code = k->binary.code,
                             .code_size = k->binary.size,
                             .slots = slots,
                             .slot_count = k->binary.slot_count};
    memcpy(desc.local_size, k->binary.local_size, sizeof desc.local_size);
    gpu_pipeline_destroy(g, k->pipeline);
    k->pipeline = gpu_pipeline_create_compute(g, &desc);
    return k->pipeline != NULL;
}

void lbm_kernel_destroy(lbm_kernel *k, gpu *g) {
    gpu_pipeline_destroy(g, k->pipeline);
    k->pipeline = NULL;
}

void lbm_kernel_set(lbm_kernel *k, const char *name, const void *data, size_t size) {
    for (size_t i = 0; i < k->binary.member_count; i++) {
        const shader_member *member = &k->binary.members[i];
        if (strcmp(member->name, name) != 0) continue;
        memcpy(k->block + member->offset, data, size < member->size ? size : member->size);
    }
}

static bool bind_slot(const lbm *l, const lbm_kernel *k, const shader_slot *slot,
                      const lbm_slot *more, size_t more_count, gpu_binding *out) {
    *out = (gpu_binding){0};
    if (strcmp(slot->name, "Uniforms") == 0) {
        out->uniform = k->block;
        out->uniform_size = slot->size;
        return true;
    }
    for (size_t i = 0; i < more_count; i++) {
        if (strcmp(more[i].name, slot->name) != 0) continue;
        *out = more[i].binding;
        return true;
    }
    return lbm_bind(l, slot->name, out) ||
           err_set("%s: nothing is known to bind to '%s'", k->shader, slot->name);
}

bool lbm_kernel_run(const lbm *l, lbm_kernel *k, gpu *g, const lbm_slot *more, size_t more_count) {
    gpu_binding bindings[GPU_MAX_SLOTS];
    const uint32_t parity = lbm_parity(l);
    lbm_kernel_set(k, "lbm_parity", &parity, sizeof parity);
    for (size_t i = 0; i < k->binary.slot_count; i++) {
        const shader_slot *slot = &k->binary.slots[i];
        if (!bind_slot(l, k, slot, more, more_count, &bindings[i])) return false;
        bindings[i].binding = slot->slot.binding;
    }
    gpu_dispatch_desc desc = {
        .pipeline = k->pipeline,
        .bindings = bindings,
        .binding_count = k->binary.slot_count,
        .threads = {k->threads, 1, 1},
    };
    if (!k->threads) {
        desc.threads[0] = l->desc.size[0] * l->desc.size[1];
        desc.threads[2] = l->layout.layers;
    }
    return gpu_dispatch(g, &desc);
}
