// Kernels are what the device runs. A kernel is one compute shader, or a vertex and a fragment
// shader that draw together, with its pipeline, the block of its loose uniforms and the bindings of
// its slots. All code that compiles, builds, fills, binds and runs shaders uses this header.
//
// The host refers to uniforms and slots by number: an index into a table of names that is common to
// the kernels of one user. Names are looked up once, when a kernel is compiled. A name that the
// compiler removed from a kernel as unused is ignored there. A name that no shader of the table's
// user declares is a bug, which kernel_undeclared finds.
//
//     #define NAMES(NAME) NAME(size), NAME(weights), NAME(FlowVelocity)
//     KERNEL_NAMES(NAMES); // N_size, N_weights, ... and the table `names`
//     ...
//     kernel_set(&k, N_weights, weights, sizeof weights);
//     kernel_bind_buffer(&k, N_FlowVelocity, velocity);
//     kernel_run(&k, g, width, height, 1);
#pragma once
#include "base/arena.h"
#include "shader/shader.h"

#define KERNEL_NAME_ID(NAME) N_##NAME
#define KERNEL_NAME_TEXT(NAME) #NAME
#define KERNEL_NAMES(NAMES)                                                                        \
    enum { NAMES(KERNEL_NAME_ID) };                                                                \
    static const char *const names[] = {NAMES(KERNEL_NAME_TEXT)}

enum { KERNEL_STAGES = 2 }; // vertex and fragment; a compute shader uses the first

typedef struct kernel_names { // names in the shaders; a block is found by the block's name
    const char *const *items;
    size_t count;
} kernel_names;

typedef struct kernel_table { // names and shader files of a user's kernels
    kernel_names names;
    const char *const *files;
    size_t file_count;
} kernel_table;

typedef struct kernel_place { // where a name is in each stage; -1: the stage does not have it
    int16_t member[KERNEL_STAGES], slot[KERNEL_STAGES];
} kernel_place;

typedef struct kernel kernel;
struct kernel {
    const char *label; // used in messages and GPU times
    int stages;        // 0: not compiled
    shader_binary binaries[KERNEL_STAGES];
    unsigned char *blocks[KERNEL_STAGES]; // data of block "Uniforms"; NULL: the stage has none
    size_t block_sizes[KERNEL_STAGES];    // bytes
    const kernel_place *places;           // one for each name
    const shader_slot *slots[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS]; // of the slots; a binding stays until it is replaced
    size_t slot_count;
    gpu_pipeline *pipeline; // NULL: not built
};

typedef struct kernel_source {
    const char *label;
    shader_compile_desc stages[KERNEL_STAGES];
    int stage_count;
    kernel_names names;
} kernel_source;

// Compiles the shaders. Needs no device. The results live in `memory`. A second call replaces them;
// the pipeline stays until the next kernel_build. False with a message, and nothing has changed.
bool kernel_compile(kernel *k, shader_library *library, arena *memory, const kernel_source *source);
// Does the same for a compute shader, by whose name the kernel goes.
bool kernel_compile_compute(kernel *k, shader_library *library, arena *memory,
                            const shader_compile_desc *shader, kernel_names names);
// Builds the pipeline of a compute shader.
bool kernel_build(kernel *k, gpu *g);
// Builds the pipeline of a vertex and a fragment shader. The kernel sets the label, the code and
// the slots of `desc`.
bool kernel_build_drawn(kernel *k, gpu *g, gpu_graphics_desc desc);
void kernel_destroy(kernel *k, gpu *g); // destroys the pipeline, if there is one

// Looks up names that are not in the kernel's table. The result lives in `memory`.
const kernel_place *kernel_find(const kernel *k, arena *memory, kernel_names names);

// ---- in a frame -------------------------------------------------------------------------------

// Set a uniform in each stage that has it. Arrays are std140: each element takes 16 bytes.
void kernel_set(kernel *k, int name, const void *data, size_t size);
void kernel_set_float(kernel *k, int name, float value);
void kernel_set_int(kernel *k, int name, int32_t value);
void kernel_set_at(kernel *k, const kernel_place *place, const void *data, size_t size);

// Bind a slot. The number of `what` is ignored.
void kernel_bind(kernel *k, int name, gpu_binding what);
void kernel_bind_at(kernel *k, const kernel_place *place, gpu_binding what);
void kernel_bind_buffer(kernel *k, int name, gpu_buffer *buffer);
void kernel_bind_image(kernel *k, int name, gpu_image *image); // mip 0, GPU_LINEAR_CLAMP

// Returns false with a message when a slot has no binding.
bool kernel_is_bound(const kernel *k);
bool kernel_run(kernel *k, gpu *g, uint32_t x, uint32_t y, uint32_t z); // threads
// A thread for each of `count`; 0: does nothing. Groups stand in rows, since a device takes 65535
// along a side: the shader's is gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x, and some
// threads of the last ones are beyond `count`.
bool kernel_run_each(kernel *k, gpu *g, uint64_t count);
// A draw, still without numbers, of what is bound now, which is copied to `kept` (k->slot_count).
gpu_draw kernel_draw(const kernel *k, gpu_binding *kept);

// ---- names ------------------------------------------------------------------------------------

// Returns the first name that none of the table's shader files mentions, which is a bug. NULL: all
// are mentioned.
const char *kernel_undeclared(shader_library *library, const kernel_table *table);
