// The inside of a solver of 2D flow, for the files of this layer only.
#pragma once
#include "gpu/profile.h"
#include "kernel/kernel.h"
#include "kernel/readback.h"
#include "sim/flow.h"

// ---- to be measured on a device ---------------------------------------------------------------

enum {
    // Cells along a side of what a group does of the pressure's finer levels. Smaller tiles are
    // more
    // groups, and more cells that are computed in two: for slices that have fewer of the large ones
    // than the device has processors.
    FLOW_LARGE_TILE = 32,
    FLOW_SMALL_TILE = 16,
    FLOW_FEW_TILES = 128,
    // Defaults of max_iterations, by sweeps: those that are not needed still cost what a dispatch
    // costs. With obstacles, whose shapes coarse levels cannot see, more.
    FLOW_ITERATIONS = 6,
    FLOW_ITERATIONS_OF_TWO = 3,
    FLOW_OBSTACLE_ITERATIONS = 4,
    FLOW_CG_ITERATIONS = 3, // by cells along the longer side
    // Of a transform: the second is for what rounding leaves of large slices. What obstacles and
    // templates change takes it many.
    FLOW_TRANSFORM_ITERATIONS = 2,
    FLOW_TRANSFORM_ITERATIONS_AROUND = 32,
};

// ---- memory -----------------------------------------------------------------------------------

// Pairs: [current] and the other.
typedef enum flow_memory {
    FLOW_MEM_VELOCITY, // of the state
    FLOW_MEM_VELOCITY_NEXT,
    FLOW_MEM_VELOCITY_HAT,
    FLOW_MEM_TRACED,  // where what the predictor traced back was
    FLOW_MEM_SCALARS, // two
    FLOW_MEM_SCALARS_HAT = FLOW_MEM_SCALARS + 2,
    FLOW_MEM_PRESSURE,                        // two: times dt / cell
    FLOW_MEM_SOURCES = FLOW_MEM_PRESSURE + 2, // the inputs
    FLOW_MEM_OBSTACLES,
    FLOW_MEM_TEMPLATES,
    FLOW_MEM_COEFFICIENTS,                            // of all levels but the coarsest
    FLOW_MEM_RESIDUAL,                                // two: of the finest level
    FLOW_MEM_COARSE_RESIDUAL = FLOW_MEM_RESIDUAL + 2, // of the others
    FLOW_MEM_Z,                                       // of all levels
    FLOW_MEM_SWEPT,     // with more than one sweep: the same before the coarser levels are known
    FLOW_MEM_LINES,     // with a transform: of modes, along y
    FLOW_MEM_DIRECTION, // two, each with its image under the equation
    FLOW_MEM_KNOWN = FLOW_MEM_DIRECTION + 2,
    FLOW_MEM_PARTS,
    FLOW_MEM_REPORT,
    FLOW_MEM_COUNT
} flow_memory;

// Of src/sim/flow_pressure.c and shaders/sim/flow/solve.glsl.
enum { FLOW_KNOWN_WORDS = 8, FLOW_PART_KINDS = 4, FLOW_BUILD_TILE = 32 };

// ---- levels -----------------------------------------------------------------------------------

// The last one, and those after it, are done by one group (shaders/sim/flow/coarse.comp).
enum { FLOW_MAX_LEVELS = 7 };

typedef struct flow_level {
    uint32_t size[2];
    uint32_t coefficients_at, r_at, z_at; // where those of the first slice begin
} flow_level;

// ---- the solver -------------------------------------------------------------------------------

enum { FLOW_REPORT_WORDS = 9 };

typedef enum flow_kernel {
    FLOW_DIFFUSE, // flow_step.c
    FLOW_PREDICT,
    FLOW_ADVANCE,
    FLOW_LOOK_AT,
    FLOW_BUILD, // flow_pressure.c
    FLOW_FOLLOW,
    FLOW_TURN,
    FLOW_PROJECT,
    FLOW_DOWN_FINEST, // with multigrid
    FLOW_DOWN,
    FLOW_COARSEST,
    FLOW_UP,
    FLOW_UP_FINEST,
    FLOW_TO_MODES, // flow_transform.c
    FLOW_SOLVE_LINES,
    FLOW_FROM_MODES,
    FLOW_REPORT, // flow_report.c
    FLOW_REPORT_LAST,
    FLOW_KERNELS
} flow_kernel;

// Buffers that are always the same come first: flow_use binds them.
#define FLOW_OWN_NAMES(NAME)                                                                       \
    NAME(FlowScalars), NAME(FlowVelocity), NAME(FlowSources), NAME(FlowObstacles),                 \
        NAME(FlowTemplates), NAME(FlowPressure), NAME(FlowCoefficients), NAME(FlowKnown),          \
        NAME(FlowParts), NAME(FlowZ), NAME(FlowSwept), NAME(FlowReport), NAME(FlowHatVelocity),    \
        NAME(FlowTraced), NAME(FlowHatScalars)
#define FLOW_NAMES(NAME)                                                                           \
    FLOW_OWN_NAMES(NAME), NAME(FlowResidual), NAME(FlowFrom), NAME(FlowTo), NAME(FlowDirection),   \
        NAME(FlowBefore), NAME(FlowPressureTo), NAME(FlowVelocityFrom), NAME(FlowVelocityLast),    \
        NAME(FlowVelocityTo), NAME(FlowScalarsTo), NAME(FlowModes), NAME(FlowLines),               \
        NAME(scalars), NAME(velocity), NAME(result), NAME(level_bits), NAME(coefficients),         \
        NAME(pressure_unit), NAME(level_cells), NAME(level_at), NAME(coarse_cells), NAME(from_at), \
        NAME(to_at), NAME(z_at), NAME(coarse_z_at), NAME(iteration), NAME(tolerance),              \
        NAME(fine_cells), NAME(fine_level_at), NAME(wall_velocity), NAME(friction), NAME(weights), \
        NAME(fresh), NAME(reach), NAME(dt), NAME(acceleration), NAME(buoyancy), NAME(vorticity),   \
        NAME(kept), NAME(max_speed), NAME(iterations)
enum { FLOW_NAMES(KERNEL_NAME_ID), FLOW_OWN = N_FlowHatScalars + 1 };

struct flow {
    arena *memory;
    flow_desc desc;
    bool chooses_iterations, chooses_sweeps, chooses_solver; // the desc gave none
    shader_define defines[FLOW_MAX_DEFINES];
    size_t define_count;
    flow_level levels[FLOW_MAX_LEVELS];
    uint32_t level_count;
    uint32_t group, coarse_side;  // threads
    uint32_t coarse;              // cells along a side of the first level of that group, at most
    uint32_t tile;                // cells along a side
    kernel kernels[FLOW_KERNELS]; // what its structure does not need is not compiled
    gpu_buffer *buffers[FLOW_MEM_COUNT];
    gpu_buffer *modes; // along x, each of size[0]; then what the equation makes of each
    gpu_image *looks[2][FLOW_LOOKS]; // [kept % 2] is written next
    uint32_t current;                // of pairs that are the state's
    bool built;                      // coefficients are there
    uint64_t kept, steps;
    kernel_readback report;
};

// A buffer of a pair: the current one (0), the other (1).
gpu_buffer *flow_pair(const flow *f, flow_memory pair, uint32_t which);

// A kernel with the buffers bound that are always the same.
kernel *flow_use(flow *f, flow_kernel which);
// A group for each tile of a level of `size` cells.
bool flow_run_tiles(const flow *f, gpu *g, kernel *k, const uint32_t size[2]);

// The image that kept states of an even or odd number are looked at in, unless it is there.
gpu_image_desc flow_describe_look(const flow *f, flow_look look);

// ---- pressure: flow_pressure.c ----------------------------------------------------------------

void flow_levels_find(flow *f);
void flow_choose_iterations(flow *f);
// From the velocity next, to that of the state.
bool flow_project(flow *f, gpu *g, const flow_numbers *numbers);

// ---- a transform: flow_transform.c ------------------------------------------------------------

// Whether products are of halves of rows; then modes that look the same from both ends come first.
bool flow_transform_folds(const flow_desc *desc, uint32_t tile);
uint64_t flow_transform_bytes(const flow *f); // of the modes
bool flow_transform_allocate(flow *f, gpu *g);
// From a residual to z, and the product of both.
bool flow_transform(flow *f, gpu *g, gpu_buffer *residual);
