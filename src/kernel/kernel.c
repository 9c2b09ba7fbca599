#include "kernel/kernel.h"
#include "base/error.h"
#include <assert.h>
#include <string.h>

// ---- building ---------------------------------------------------------------------------------

static kernel_place find_place(const kernel *k, const char *name) {
    kernel_place out = {{-1, -1}, {-1, -1}};
    for (int s = 0; s < k->stages; s++)
        for (size_t i = 0; i < k->binaries[s].member_count; i++)
            if (strcmp(k->binaries[s].members[i].name, name) == 0) out.member[s] = (int16_t)i;
    for (size_t i = 0; i < k->slot_count; i++)
        if (strcmp(k->slots[i]->name, name) == 0)
            out.slot[i >= k->binaries[0].slot_count] = (int16_t)i;
    return out;
}

const kernel_place *kernel_find(const kernel *k, arena *memory, kernel_names names) {
    kernel_place *places = arena_alloc(memory, (names.count + 1) * sizeof *places);
    for (size_t i = 0; i < names.count; i++) places[i] = find_place(k, names.items[i]);
    return places;
}

static bool add_slots(kernel *k, int stage, arena *memory) {
    const shader_binary *binary = &k->binaries[stage];
    if (k->slot_count + binary->slot_count > GPU_MAX_SLOTS)
        return err_set("%s: %zu bindings; at most %d are possible", k->label,
                       k->slot_count + binary->slot_count, GPU_MAX_SLOTS);
    for (size_t i = 0; i < binary->slot_count; i++) {
        const shader_slot *slot = &binary->slots[i];
        gpu_binding *binding = &k->bindings[k->slot_count];
        k->slots[k->slot_count++] = slot;
        *binding = (gpu_binding){.binding = slot->slot.binding};
        if (slot->slot.kind != GPU_SLOT_UNIFORM || strcmp(slot->name, "Uniforms") != 0) continue;
        k->blocks[stage] = arena_alloc(memory, slot->size);
        k->block_sizes[stage] = slot->size;
        binding->uniform = k->blocks[stage];
        binding->uniform_size = slot->size;
    }
    return true;
}

bool kernel_compile(kernel *k, shader_library *library, arena *memory,
                    const kernel_source *source) {
    kernel made = {.label = source->label, .stages = source->stage_count, .pipeline = k->pipeline};
    for (int s = 0; s < made.stages; s++)
        if (!shader_compile(library, memory, &source->stages[s], &made.binaries[s])) return false;
    for (int s = 0; s < made.stages; s++)
        if (!add_slots(&made, s, memory)) return false;
    made.places = kernel_find(&made, memory, source->names);
    *k = made;
    return true;
}

bool kernel_compile_compute(kernel *k, shader_library *library, arena *memory,
                            const shader_compile_desc *shader, kernel_names names) {
    const kernel_source source = {
        .label = shader->name, .stages = {*shader}, .stage_count = 1, .names = names};
    assert(shader->stage == SHADER_COMPUTE);
    return kernel_compile(k, library, memory, &source);
}

static bool kernel_replace(kernel *k, gpu *g, gpu_pipeline *pipeline) {
    if (!pipeline) return false;
    kernel_destroy(k, g);
    k->pipeline = pipeline;
    return true;
}

static void list_slots(const kernel *k, gpu_slot out[GPU_MAX_SLOTS]) {
    static const gpu_stage drawn[KERNEL_STAGES] = {GPU_STAGE_VERTEX, GPU_STAGE_FRAGMENT};
    for (size_t i = 0; i < k->slot_count; i++) {
        out[i] = k->slots[i]->slot;
        if (k->stages == 2) out[i].stage = drawn[i >= k->binaries[0].slot_count];
    }
}

bool kernel_build(kernel *k, gpu *g) {
    const shader_binary *binary = &k->binaries[0];
    gpu_slot slots[GPU_MAX_SLOTS];
    list_slots(k, slots);
    gpu_compute_desc desc = {.label = k->label,
                             .code = binary->code,
                             .code_size = binary->size,
                             .slots = slots,
                             .slot_count = k->slot_count};
    memcpy(desc.local_size, binary->local_size, sizeof desc.local_size);
    return kernel_replace(k, g, gpu_pipeline_create_compute(g, &desc));
}

bool kernel_build_drawn(kernel *k, gpu *g, gpu_graphics_desc desc) {
    gpu_slot slots[GPU_MAX_SLOTS];
    list_slots(k, slots);
    desc.label = k->label;
    desc.vertex_code = k->binaries[0].code;
    desc.vertex_size = k->binaries[0].size;
    desc.fragment_code = k->binaries[1].code;
    desc.fragment_size = k->binaries[1].size;
    desc.slots = slots;
    desc.slot_count = k->slot_count;
    return kernel_replace(k, g, gpu_pipeline_create_graphics(g, &desc));
}

void kernel_destroy(kernel *k, gpu *g) {
    gpu_pipeline_destroy(g, k->pipeline);
    k->pipeline = NULL;
}

// ---- in a frame -------------------------------------------------------------------------------

enum { GROUPS_ACROSS = 1024 };

void kernel_set_at(kernel *k, const kernel_place *place, const void *data, size_t size) {
    for (int s = 0; s < k->stages; s++) {
        if (place->member[s] < 0) continue;
        const shader_member *member = &k->binaries[s].members[place->member[s]];
        memcpy(k->blocks[s] + member->offset, data, size < member->size ? size : member->size);
    }
}

void kernel_set(kernel *k, int name, const void *data, size_t size) {
    if (k->stages) kernel_set_at(k, &k->places[name], data, size);
}

void kernel_set_float(kernel *k, int name, float value) {
    kernel_set(k, name, &value, sizeof value);
}

void kernel_set_int(kernel *k, int name, int32_t value) {
    kernel_set(k, name, &value, sizeof value);
}

void kernel_bind_at(kernel *k, const kernel_place *place, gpu_binding what) {
    for (int s = 0; s < k->stages; s++) {
        if (place->slot[s] < 0) continue;
        gpu_binding *binding = &k->bindings[place->slot[s]];
        what.binding = binding->binding;
        *binding = what;
    }
}

void kernel_bind(kernel *k, int name, gpu_binding what) {
    if (k->stages) kernel_bind_at(k, &k->places[name], what);
}

void kernel_bind_buffer(kernel *k, int name, gpu_buffer *buffer) {
    kernel_bind(k, name, (gpu_binding){.buffer = buffer});
}

void kernel_bind_image(kernel *k, int name, gpu_image *image) {
    kernel_bind(k, name, (gpu_binding){.image = image});
}

bool kernel_is_bound(const kernel *k) {
    for (size_t i = 0; i < k->slot_count; i++) {
        const gpu_binding *b = &k->bindings[i];
        if (!b->buffer && !b->image && !b->uniform)
            return err_set("%s: nothing is bound to '%s'", k->label, k->slots[i]->name);
    }
    return true;
}

bool kernel_run(kernel *k, gpu *g, uint32_t x, uint32_t y, uint32_t z) {
    return kernel_is_bound(k) &&
           gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = k->pipeline,
                                                .bindings = k->bindings,
                                                .binding_count = k->slot_count,
                                                .threads = {x, y, z}});
}

bool kernel_run_each(kernel *k, gpu *g, uint64_t count) {
    const uint32_t threads = k->binaries[0].local_size[0];
    const uint64_t groups = (count + threads - 1) / threads;
    const uint64_t across = groups < GROUPS_ACROSS ? groups : GROUPS_ACROSS;
    return groups == 0 || kernel_run(k, g, (uint32_t)across * threads,
                                     (uint32_t)((groups + across - 1) / across), 1);
}

gpu_draw kernel_draw(const kernel *k, gpu_binding *kept) {
    memcpy(kept, k->bindings, k->slot_count * sizeof *kept);
    return (gpu_draw){.bindings = kept, .binding_count = k->slot_count};
}

// ---- names ------------------------------------------------------------------------------------

const char *kernel_undeclared(shader_library *library, const kernel_table *table) {
    for (size_t i = 0; i < table->names.count; i++) {
        const char *name = table->names.items[i];
        bool found = false;
        for (size_t f = 0; f < table->file_count && !found; f++)
            found = shader_mentions(library, table->files[f], name);
        if (!found) return name;
    }
    return NULL;
}
