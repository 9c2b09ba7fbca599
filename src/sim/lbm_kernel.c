// Shaders of a solver: compiled with its structure, bound by the names of their slots.
#include "sim/lbm_impl.h"

bool lbm_kernel_compile(lbm *l, lbm_kernel *k, const char *shader, shader_library *library,
                        const shader_reader *reader, const shader_define *more, size_t more_count) {
    const sim_defines all = {l->defines, l->define_count};
    return sim_kernel_compile(&k->base, shader, l->memory, library, reader, all,
                              (sim_defines){more, more_count});
}

void lbm_kernel_set(lbm_kernel *k, const char *name, const void *data, size_t size) {
    sim_kernel_set(&k->base, name, data, size);
}

bool lbm_kernel_run(const lbm *l, lbm_kernel *k, gpu *g) {
    const shader_binary *binary = &k->base.binary;
    const uint32_t parity = lbm_parity(l);
    sim_slot slots[GPU_MAX_SLOTS];
    size_t count = 0;
    lbm_kernel_set(k, "lbm_parity", &parity, sizeof parity);
    for (size_t i = 0; i < binary->slot_count; i++) {
        gpu_binding own;
        if (lbm_bind(l, binary->slots[i].name, &own))
            slots[count++] = (sim_slot){binary->slots[i].name, own.buffer, own.image};
    }
    const uint32_t each[3] = {l->desc.size[0] * l->desc.size[1], 1, l->layout.layers};
    return sim_kernel_run(&k->base, g, slots, count, k->threads[0] ? k->threads : each);
}
