// The whole state of a solver in a checkpoint, from which it continues as if it had never stopped:
// buffers as they are in memory, the images of the last two kept states, and a clock. Its inputs
// are not included: whoever fills them must fill them again.
#pragma once
#include "base/str.h"
#include "sim/checkpoint.h"

enum { SIM_STATE_BUFFERS = 4, SIM_STATE_IMAGES = 3 };

typedef struct sim_state { // of one solver, as it is now
    uint64_t *steps, *kept;
    size_t buffer_count, image_count;
    const char *buffer_names[SIM_STATE_BUFFERS], *image_names[SIM_STATE_IMAGES];
    gpu_buffer *buffers[SIM_STATE_BUFFERS];
    gpu_image **images[2][SIM_STATE_IMAGES]; // written in turn, by the count of kept states
    gpu_image_desc image_descs[SIM_STATE_IMAGES];
} sim_state;

typedef struct sim_state_kind {                          // of a solver
    const char *name;                                    // of the part with the lines
    void (*describe)(const void *solver, strbuf *lines); // "key = value", equal when it is loaded
    void (*find)(void *solver, sim_state *out);
    bool (*reset)(void *solver, gpu *g); // inside a frame: goes back to the first of each pair
} sim_state_kind;
extern const sim_state_kind flow_state_kind, pyro_state_kind;

// Adds its parts under "label/...", between frames. `more`: further lines. False with a message.
bool sim_state_list(const sim_state_kind *kind, void *solver, gpu *g, const char *label,
                    const char *more, checkpoint_list *out);
// Loads a state between frames, when the solver is allocated. False with a message. A solver that
// does not match is unchanged; after any other failure it has no state (reset it).
bool sim_state_load(const sim_state_kind *kind, void *solver, gpu *g, const char *label,
                    const char *more, checkpoint *c);
