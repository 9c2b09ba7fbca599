// A compute shader of a simulation: compiled with what the simulation is made for, bound by the
// names of its slots.
#pragma once
#include "base/arena.h"
#include "shader/shader.h"

typedef struct sim_kernel {
    const char *shader;
    shader_binary binary;
    gpu_pipeline *pipeline;
    unsigned char *block; // of its uniforms
} sim_kernel;

typedef struct sim_defines {
    const shader_define *items;
    size_t count;
} sim_defines;

// Compiles with both lists; again: replaces what was compiled. `reader` may be NULL.
bool sim_kernel_compile(sim_kernel *k, const char *shader, arena *memory, shader_library *library,
                        const shader_reader *reader, sim_defines all, sim_defines own);
bool sim_kernel_build(sim_kernel *k, gpu *g);
void sim_kernel_destroy(sim_kernel *k, gpu *g);

// Sets a uniform; one that the shader does not use is passed over. Arrays are std140: each element
// of 16 bytes.
void sim_kernel_set(sim_kernel *k, const char *name, const void *data, size_t size);

typedef struct sim_slot {
    const char *name;
    gpu_buffer *buffer; // or
    gpu_image *image;
} sim_slot;
// A dispatch; each slot of the shader must be among `slots`, which may be more.
bool sim_kernel_run(sim_kernel *k, gpu *g, const sim_slot *slots, size_t count,
                    const uint32_t threads[3]);
