// The inside of a lattice Boltzmann solver, for the files of this layer only.
#pragma once
#include "gpu/profile.h"
#include "kernel/kernel.h"
#include "sim/lbm.h"

// ---- one shader -------------------------------------------------------------------------------

// Buffers, which lbm_bind knows, come first.
#define LBM_NAMES(NAME)                                                                            \
    NAME(LbmWaves), NAME(LbmIds), NAME(LbmBodies), NAME(LbmCells), NAME(LbmCellsBefore),           \
        NAME(LbmSkin), NAME(LbmMoments), NAME(LbmState0), NAME(LbmState1), NAME(LbmState2),        \
        NAME(LbmState3), NAME(LbmState4), NAME(LbmState5), NAME(LbmState6), NAME(LbmState7),       \
        NAME(LbmState8), NAME(LbmState9), NAME(LbmState10), NAME(LbmState11), NAME(LbmState12),    \
        NAME(LbmState13), NAME(LbmState14), NAME(LbmState15), NAME(force), NAME(lbm_parity),       \
        NAME(lbm_face_velocity), NAME(lbm_face_scalar), NAME(lbm_moved), NAME(lbm_body_speed),     \
        NAME(any_moves), NAME(ambient), NAME(stage), NAME(tau), NAME(scalar_tau),                  \
        NAME(smagorinsky), NAME(acceleration), NAME(buoyancy), NAME(decay), NAME(max_speed),       \
        NAME(force_scale), NAME(outflow_scale), NAME(skin_layers), NAME(skin_count)
enum { LBM_NAMES(KERNEL_NAME_ID), LBM_OWN = N_LbmState0 + LBM_MAX_BUFFERS };

typedef struct lbm_kernel {
    kernel base;
    uint32_t threads[3]; // of a dispatch; 0: one for each element, in layers
} lbm_kernel;

// Compiles with the defines of the solver and `more`; again: replaces what was compiled.
bool lbm_kernel_compile(lbm *l, lbm_kernel *k, const char *shader, shader_library *library,
                        const shader_reader *reader, const shader_define *more, size_t more_count);
// A dispatch; of a thread for each element x is column x + nx * y, z the layer.
bool lbm_kernel_run(const lbm *l, lbm_kernel *k, gpu *g);

// ---- layout -----------------------------------------------------------------------------------

typedef struct lbm_layout {
    uint32_t lanes, element;      // cells of an element, its bytes
    uint32_t bundle;              // elements side by side
    uint32_t layers, elements;    // along z, in all
    uint32_t block, places;       // elements of a block, 0: none; elements that there is room for
    uint32_t slots, run, buffers; // places of directions, those of one buffer, buffers
} lbm_layout;

// How the state lies where one binding is at most `range` bytes. False with a message.
bool lbm_layout_find(const lbm_desc *desc, uint64_t range, lbm_layout *out);

// ---- boundaries -------------------------------------------------------------------------------

typedef struct lbm_motion { // LbmBody of bodies.glsl
    float centre[3], moves, linear[4], angular[4];
} lbm_motion;

typedef struct lbm_walls {
    lbm_kernel kernel;           // says what cells are
    gpu_buffer *cells[2];        // what they are, and were: [current], and the other
    bool current, known, filled; // filled: the cells hold something
    bool restored;               // the cells are what they were when a checkpoint was made
    gpu_buffer *waves, *ids;
    gpu_buffer *bodies;
    lbm_motion *motions; // what is in `bodies`, by id
    size_t motion_count, motion_capacity;
    uint32_t moves;   // any body does
    uint64_t updated; // the step before which it was said last what cells are
} lbm_walls;

void lbm_walls_define(lbm *l, void (*define)(lbm *l, const char *name, uint32_t value));
bool lbm_walls_compile(lbm *l, shader_library *library, const shader_reader *reader);
bool lbm_walls_build(lbm *l, gpu *g);
bool lbm_walls_allocate(lbm *l, gpu *g);
void lbm_walls_list_memory(const lbm *l, budget_list *out);
void lbm_walls_destroy(lbm *l, gpu *g);
void lbm_walls_reset(lbm *l, gpu *g);
void lbm_walls_exchange(lbm *a, lbm *b);
void lbm_walls_list(const lbm *l, gpu_buffer *out[LBM_OWN]); // its buffers, by their names
void lbm_walls_set(const lbm *l, lbm_kernel *k, const lbm_numbers *numbers);
bool lbm_walls_ready(const lbm *l); // false with a message

// ---- steps ------------------------------------------------------------------------------------

typedef enum lbm_skin_order { LBM_NO_SKIN, LBM_SKIN_FIRST, LBM_SKIN_APART } lbm_skin_order;

typedef struct lbm_stepper {
    lbm_skin_order order;
    int parts;                // dispatches of a step
    lbm_kernel kernels[2][2]; // [part][moments are kept]
    gpu_buffer *skin;         // a list of the elements, or bundles, at faces
    uint32_t skin_count, skin_layers;
} lbm_stepper;

bool lbm_step_compile(lbm *l, const gpu_profile *device, shader_library *library,
                      const shader_reader *reader);
bool lbm_step_build(lbm *l, gpu *g);
bool lbm_step_allocate(lbm *l, gpu *g);
void lbm_step_list_memory(const lbm *l, budget_list *out);
void lbm_step_destroy(lbm *l, gpu *g);

// ---- moments ----------------------------------------------------------------------------------

bool lbm_make_moments(lbm *l, gpu *g, uint32_t which); // the buffer, unless it is there

// ---- the solver -------------------------------------------------------------------------------

struct lbm {
    arena *memory;
    lbm_desc desc;
    bool chooses_lanes, chooses_order; // the desc gave none
    lbm_layout layout;
    shader_define defines[LBM_MAX_DEFINES];
    size_t define_count;
    lbm_kernel reset;
    lbm_stepper stepper;
    gpu_buffer *state[LBM_MAX_BUFFERS];
    gpu_buffer *moments[2]; // [kept % 2] is written next
    uint64_t kept;
    lbm_walls walls;
    gpu_image *force;
    float force_scale, outflow_scale;
    uint64_t steps;
};
