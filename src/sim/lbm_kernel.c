// Kernels of a solver: compiled with its structure, and bound to its buffers.
#include "base/memory.h"
#include "sim/lbm_impl.h"

static const char *const names[] = {LBM_NAMES(KERNEL_NAME_TEXT)};
static const char *const shaders[] = {"sim/lbm/reset.comp", "sim/lbm/step.comp",
                                      "sim/lbm/cells.comp"};

const kernel_table lbm_kernel_table = {{names, COUNT_OF(names)}, shaders, COUNT_OF(shaders)};

bool lbm_kernel_compile(lbm *l, lbm_kernel *k, const char *shader, shader_library *library,
                        const shader_reader *reader, const shader_define *more, size_t more_count) {
    shader_define defines[LBM_MAX_DEFINES + 4];
    size_t count = lbm_defines(l, defines);
    for (size_t i = 0; i < more_count; i++) defines[count++] = more[i];
    const shader_compile_desc desc = {
        .name = shader, .defines = defines, .define_count = count, .reader = reader};
    return kernel_compile_compute(&k->base, library, l->memory, &desc, lbm_kernel_table.names);
}

bool lbm_kernel_run(const lbm *l, lbm_kernel *k, gpu *g) {
    const uint32_t each[3] = {l->desc.size[0] * l->desc.size[1], 1, l->layout.layers};
    const uint32_t *threads = k->threads[0] ? k->threads : each;
    kernel_set_int(&k->base, N_lbm_parity, (int32_t)lbm_parity(l));
    lbm_bind(l, &k->base, k->base.places);
    return kernel_run(&k->base, g, threads[0], threads[1], threads[2]);
}
