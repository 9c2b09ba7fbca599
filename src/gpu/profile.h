// What is decided by the device, in one place: how large the parts are into which work is cut,
// which of two ways is taken, what a pipeline may ask for. Each field says what it decides;
// profile.c says of each row which devices get which value, and what was measured. No other layer
// asks what kind of device it runs on.
#pragma once
#include "gpu/gpu.h"

// What one pipeline may ask for. A pipeline that asks for more is refused with the limit's name.
typedef struct gpu_limits {
    uint32_t group_threads;   // of a work group
    uint32_t shared_bytes;    // of a work group
    uint32_t storage_buffers; // of a shader stage
    uint32_t storage_images;  // of a shader stage
    bool first_instance;      // commands in buffers may count instances from another than 0
} gpu_limits;

typedef struct gpu_profile {
    gpu_limits limits;

    // ---- the driver (src/gpu) ----
    bool clamps_indices;    // SPIR-V is rewritten so that indices into variables stay in bounds
    bool hoists_uniforms;   // ... so that uniforms are read once (hoist.c)
    bool hides_uniforms;    // ... so that the driver cannot tell which uniforms are read (hide.c)
    bool slices_dispatches; // a dispatch goes in several (dispatch.c)
    bool waits_in_calls;    // calls that should only ask or hand over wait without a limit
    bool keeps_shown;       // images of a window are filled only where they are to change
    bool shows_apart;       // a window is drawn by a device of its own beside the effects
    bool shares_memory;     // the device's memory is taken from the host's budget
    double timeout;         // seconds of work until the device counts as lost

    // ---- what one submit may hold ----
    double lattice_updates;      // cells times steps
    double burning_cost;         // updates of a lattice that one of a cell of burning gas is worth
    double least_updates;        // what the smallest step counts for
    double brief_updates;        // in a live picture: the part that is left, 1 / this
    double particle_moves;       // particles times steps
    uint64_t sequence_bytes;     // of the frames of a grid's sequence that are kept on the device
    bool reference_single_paths; // a thread of the path tracer has one path, else a pixel's

    // ---- which way is taken ----
    bool geometry_traces;    // `geometry` with mode auto: rays, else triangles are drawn
    bool shadow_maps_win;    // a look into shadow maps takes less time than a ray
    bool march_by_sides;     // the march computes both sides of a branch: it has code without them,
                             // and a kernel of its own for rays that miss the box
    float bricks_dear;       // blocks along the longest side where densities are dear; 0: none
    float bricks_cheap;      // where they are cheap
    float bricks_many;       // ... but where samples are many
    bool draws_by_groups;    // several threads draw a splat together, and a triangle of a piece
    float splats_direct;     // pixels to each side up to which a splat's own thread draws it
    bool previews;           // a live picture begins at less than its full size
    uint32_t lighting_parts; // that a ray to a light is cut into; 0: a quarter of its cells
    uint32_t lighting_apart; // threads that lie between two rays of the look around
    uint32_t templates_cells; // cells above each other that a thread draws templates into
    uint32_t sort_threads;    // of a group that sorts

    // ---- flow in slices (src/sim/flow.h) ----
    uint32_t flow_group;       // threads of a group
    uint32_t flow_coarse_side; // threads along a side of the group that does all coarser levels
    uint32_t flow_coarse;      // cells along a side of the levels that one group does
    uint32_t flow_sweeps;      // default of sweeps
    uint32_t flow_transform;   // cells along x up to which transforms take less time than multigrid
    bool flow_small_tiles;     // where large tiles are few

    // ---- lattices (src/sim/lbm.h) ----
    uint32_t lbm_half_lanes; // cells of an element in half precision
    bool lbm_whole;          // each direction lies in memory as a whole, else in blocks
    bool lbm_software_step;  // the step's skin is a dispatch of its own, and so written that a
                             // processor's wide registers are filled

    // ---- gas that burns (src/sim/pyro.h) ----
    bool pyro_half;         // its state is in half precision by default
    bool pyro_side_by_side; // threads that are neighbours along x share what flows between them
    bool pyro_wide_words;   // in full precision it lies in words of 64 bits
} gpu_profile;

// NULL: of no device in particular, for what is compiled to be checked. Any thread.
const gpu_profile *gpu_get_profile(const gpu *g);

// A stage that counts more of one kind than `limits` allow: false with a message that names the
// limit, what is wanted and what there is. `threads` and `shared_bytes` are 0 where there are no
// work groups.
typedef struct gpu_demand {
    uint32_t threads, shared_bytes, storage_buffers, storage_images;
} gpu_demand;
bool gpu_meets_limits(const gpu_limits *limits, const char *label, const gpu_demand *demand);
