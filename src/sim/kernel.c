#include "sim/kernel.h"
#include "base/error.h"
#include <string.h>

enum { MAX_DEFINES = 64 };

static uint32_t block_size(const shader_binary *binary) {
    for (size_t i = 0; i < binary->slot_count; i++)
        if (strcmp(binary->slots[i].name, "Uniforms") == 0) return binary->slots[i].size;
    return 0;
}

bool sim_kernel_compile(sim_kernel *k, const char *shader, arena *memory, shader_library *library,
                        const shader_reader *reader, sim_defines all, sim_defines own) {
    shader_define defines[MAX_DEFINES];
    size_t count = 0;
    for (size_t i = 0; i < all.count && count < MAX_DEFINES; i++) defines[count++] = all.items[i];
    for (size_t i = 0; i < own.count && count < MAX_DEFINES; i++) defines[count++] = own.items[i];
    shader_compile_desc desc = {.name = shader,
                                .stage = SHADER_COMPUTE,
                                .defines = defines,
                                .define_count = count,
                                .reader = reader};
    if (!shader_compile(library, memory, &desc, &k->binary)) return false;
    k->shader = shader;
    k->block = arena_alloc(memory, block_size(&k->binary) + 16);
    return true;
}

bool sim_kernel_build(sim_kernel *k, gpu *g) {
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

void sim_kernel_destroy(sim_kernel *k, gpu *g) {
    gpu_pipeline_destroy(g, k->pipeline);
    k->pipeline = NULL;
}

void sim_kernel_set(sim_kernel *k, const char *name, const void *data, size_t size) {
    for (size_t i = 0; i < k->binary.member_count; i++) {
        const shader_member *member = &k->binary.members[i];
        if (strcmp(member->name, name) != 0) continue;
        memcpy(k->block + member->offset, data, size < member->size ? size : member->size);
    }
}

static bool bind_slot(const sim_kernel *k, const shader_slot *slot, const sim_slot *slots,
                      size_t count, gpu_binding *out) {
    *out = (gpu_binding){.binding = slot->slot.binding};
    if (strcmp(slot->name, "Uniforms") == 0) {
        out->uniform = k->block;
        out->uniform_size = slot->size;
        return true;
    }
    for (size_t i = 0; i < count; i++) {
        if (strcmp(slots[i].name, slot->name) != 0) continue;
        out->buffer = slots[i].buffer;
        out->image = slots[i].image;
        return true;
    }
    return err_set("%s: nothing is known to bind to '%s'", k->shader, slot->name);
}

bool sim_kernel_run(sim_kernel *k, gpu *g, const sim_slot *slots, size_t count,
                    const uint32_t threads[3]) {
    gpu_binding bindings[GPU_MAX_SLOTS];
    for (size_t i = 0; i < k->binary.slot_count; i++)
        if (!bind_slot(k, &k->binary.slots[i], slots, count, &bindings[i])) return false;
    gpu_dispatch_desc desc = {
        .pipeline = k->pipeline,
        .bindings = bindings,
        .binding_count = k->binary.slot_count,
        .threads = {threads[0], threads[1], threads[2]},
    };
    return gpu_dispatch(g, &desc);
}
