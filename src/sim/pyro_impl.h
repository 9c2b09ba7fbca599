// The inside of a combustion solver, for the files of this layer only.
#pragma once
#include "gpu/profile.h"
#include "kernel/kernel.h"
#include "kernel/readback.h"
#include "sim/pyro.h"

enum {
    PYRO_CYCLES = 2,
    PYRO_CONJUGATE_CYCLES = 3, // coarse levels see solids, and thin flames, in part
    PYRO_CELLS_A_GROUP = 256,  // of kernels that sum
    PYRO_MAX_LEVELS = 10,
    PYRO_COARSEST = 8192, // cells at most of the level that one group solves
    PYRO_FEW = 1024,      // of that level, where it could still be halved along some axes
};

typedef enum pyro_memory {
    PYRO_MEM_VELOCITY,                    // two: of the state, and the next
    PYRO_MEM_GAS = PYRO_MEM_VELOCITY + 2, // two
    PYRO_MEM_ACTIVE =
        PYRO_MEM_GAS + 2,      // which half bricks hold more than clean air, of both states
    PYRO_MEM_VELOCITY_BETWEEN, // two sweeps
    PYRO_MEM_GAS_BETWEEN,      // and vorticity, and the potential of turbulence
    PYRO_MEM_SMOKE,            // two
    PYRO_MEM_SMOKE_BETWEEN = PYRO_MEM_SMOKE + 2,
    PYRO_MEM_CARRIER, // where cells of the velocity are larger
    PYRO_MEM_SPREAD,  // of volumes, along y and z
    PYRO_MEM_CURL,    // with confinement
    PYRO_MEM_DENSITY, // of the gas in cells of the velocity, where these are larger
    PYRO_MEM_PRESSURE,
    PYRO_MEM_RIGHT,
    PYRO_MEM_EXPANSION,       // with reflection; else it is in RIGHT until the projection
    PYRO_MEM_MORE_PRESSURE,   // with reflection: what the second projection adds
    PYRO_MEM_COARSE_PRESSURE, // of all levels but the finest
    PYRO_MEM_COARSE_RIGHT,
    PYRO_MEM_COEFFICIENTS, // of faces, with solids or variable density
    PYRO_MEM_COARSE_COEFFICIENTS,
    PYRO_MEM_FOUND, // with conjugate gradients, of which these are the vectors
    PYRO_MEM_DIRECTION,
    PYRO_MEM_CHANGE,
    PYRO_MEM_SUMS,
    PYRO_MEM_REPORT,
    PYRO_MEM_COUNT
} pyro_memory;

typedef struct pyro_level {
    uint32_t size[3];
    uint32_t coarser[3]; // cells along each axis for one of the next level: 1 or 2
    uint32_t first;      // of its cells in the coarse buffers
    float weights[3];    // of differences along each axis
} pyro_level;

enum { PYRO_SUMS = 3 }; // of conjugate gradients
enum { PYRO_REPORT_WORDS = 8 };

typedef enum pyro_kernel {
    PYRO_K_RESET, // of the gas
    PYRO_K_RESET_FLOW,
    PYRO_K_SPREAD,
    PYRO_K_CARRIER,
    PYRO_K_CARRY_X,
    PYRO_K_CARRY_Y,
    PYRO_K_GAS, // carried along z, burnt
    PYRO_K_VORTICITY,
    PYRO_K_CURL,
    PYRO_K_TURBULENCE,
    PYRO_K_GUIDE,
    PYRO_K_VELOCITY_X,
    PYRO_K_VELOCITY_Y,
    PYRO_K_VELOCITY, // carried along z, pushed
    PYRO_K_COEFFICIENTS,
    PYRO_K_COEFFICIENTS_NEXT, // from the finest level to the next
    PYRO_K_COEFFICIENTS_COARSE,
    PYRO_K_OBSTRUCT,
    PYRO_K_FILL,
    PYRO_K_DIVERGENCE,
    PYRO_K_SMOOTH_FINEST,
    PYRO_K_SMOOTH,
    PYRO_K_RESTRICT_FINEST,
    PYRO_K_RESTRICT,
    PYRO_K_COARSEST,
    PYRO_K_PROLONG,
    PYRO_K_PROLONG_FINEST,
    PYRO_K_RESIDUAL, // of conjugate gradients
    PYRO_K_ACROSS,
    PYRO_K_TURN,
    PYRO_K_APPLY,
    PYRO_K_MOVE,
    PYRO_K_SUM,
    PYRO_K_PROJECT,
    PYRO_K_REFLECT,
    PYRO_K_LOOK, // at the gas
    PYRO_K_LOOK_FLOW,
    PYRO_K_REPORT,
    PYRO_K_REPORT_FLOW,
    PYRO_K_REPORT_LAST,
    PYRO_KERNELS
} pyro_kernel;

// Buffers that are always the same come first: pyro_use binds them.
#define PYRO_OWN_NAMES(NAME)                                                                       \
    NAME(PyroGas), NAME(PyroVelocity), NAME(PyroPressure), NAME(PyroRight), NAME(PyroExpansion),   \
        NAME(PyroGasTo), NAME(PyroVelocityTo), NAME(PyroCarrier), NAME(PyroSpread),                \
        NAME(PyroCurl), NAME(PyroCoarsePressure), NAME(PyroCoarseRight), NAME(PyroCoefficients),   \
        NAME(PyroCoarseCoefficients), NAME(PyroFound), NAME(PyroDirection), NAME(PyroChange),      \
        NAME(PyroSums), NAME(PyroDensity), NAME(PyroActive), NAME(PyroSmoke), NAME(PyroSmokeTo),   \
        NAME(PyroReport)
#define PYRO_NAMES(NAME)                                                                           \
    PYRO_OWN_NAMES(NAME), NAME(PyroGasFrom), NAME(PyroGasInto), NAME(PyroFlowFrom),                \
        NAME(PyroFlowInto), NAME(PyroOtherPressure), NAME(PyroVorticity), NAME(scalars),           \
        NAME(flow), NAME(result), NAME(dt), NAME(cell), NAME(reach), NAME(ambient),                \
        NAME(lightness), NAME(inflow), NAME(gravity), NAME(acceleration), NAME(confinement),       \
        NAME(max_speed), NAME(ignition), NAME(burn_share), NAME(oxygen_need), NAME(heat),          \
        NAME(soot_yield), NAME(soot_share), NAME(soot_heat), NAME(soot_kept), NAME(cooling),       \
        NAME(expansion), NAME(weights), NAME(level_size), NAME(level_first), NAME(colour),         \
        NAME(coarse_size), NAME(coarser), NAME(coarse_first), NAME(sweeps), NAME(relaxation),      \
        NAME(pressure_unit), NAME(groups), NAME(mass), NAME(SolidIds), NAME(SolidMotions),         \
        NAME(box_min), NAME(force), NAME(begins), NAME(place), NAME(first), NAME(flame_reach),     \
        NAME(everywhere), NAME(present_from), NAME(present_to), NAME(guide), NAME(pull),           \
        NAME(guide_cells), NAME(guide_share), NAME(PyroSmokeFrom), NAME(PyroSmokeInto),            \
        NAME(smokes), NAME(smoke_yield), NAME(smoke_kept), NAME(PyroPotential), NAME(kick),        \
        NAME(turn)
enum { PYRO_NAMES(KERNEL_NAME_ID), PYRO_OWN = N_PyroReport + 1 };

struct pyro {
    arena *memory;
    pyro_desc desc;
    bool chooses_precision, wide; // what is stored are words of 64 bits
    bool side_by_side;            // gpu_profile's pyro_side_by_side
    shader_define defines[PYRO_MAX_DEFINES];
    size_t define_count;
    pyro_level levels[PYRO_MAX_LEVELS];
    uint32_t level_count;
    kernel kernels[PYRO_KERNELS]; // what its structure does not need is not compiled
    gpu_buffer *buffers[PYRO_MEM_COUNT];
    gpu_image *looks[2][PYRO_LOOKS]; // [kept % 2] is written next
    uint32_t current;                // of pairs that are the state's
    uint64_t kept, steps;
    kernel_readback report;
    gpu_image *force, *guide;
    gpu_image *pull; // what the guide adds to the velocity
    pyro_solids solids;
    bool finds_more;         // the projection finds what is to be added to the pressure
    bool coefficients_known; // they are those of `solids`; by density, of the last step
    bool active_known;       // where there is gas; false: the host may have set it
};

uint64_t pyro_cells(const pyro *p);      // of the gas
uint64_t pyro_flow_cells(const pyro *p); // of the velocity
void pyro_flow_size(const pyro_desc *desc, uint32_t out[3]);
float pyro_flow_cell(const pyro *p, const pyro_numbers *n); // its side, m
// Faces differ in how easily gas crosses them: conjugate gradients find the pressure.
bool pyro_is_weighed(const pyro *p);
bool pyro_is_closed(const pyro_desc *desc); // no face is open
gpu_buffer *pyro_pair(const pyro *p, pyro_memory pair,
                      uint32_t which); // the current one (0), the other
// A kernel with the buffers bound that are always the same.
kernel *pyro_use(pyro *p, pyro_kernel which);
bool pyro_run(const pyro *p, gpu *g, kernel *k);     // a thread for each cell of the velocity
bool pyro_run_gas(const pyro *p, gpu *g, kernel *k); // of the gas
bool pyro_has_look(const pyro *p, pyro_look look);
// A group for each 8 x 8 x 4 cells of the gas.
bool pyro_run_half_bricks_of_gas(const pyro *p, gpu *g, kernel *k);
bool pyro_run_half_bricks(const pyro *p, gpu *g, kernel *k); // of the velocity
void pyro_stage(const pyro *p, gpu *g, const char *name);    // begins, for GPU times

// pyro_step.c
void pyro_set_gas(kernel *k, const pyro_numbers *n); // what all that reads the gas is told
void pyro_set_burning(kernel *k, const pyro_numbers *n);

// pyro_pressure.c
bool pyro_find_levels(pyro *p); // false with a message
uint64_t pyro_coarse_cells(const pyro *p);
// Of the next velocity, whose expansion is in PyroRight.
bool pyro_project(pyro *p, gpu *g, const pyro_numbers *numbers);
// After half a step: the state's velocity becomes that of its middle, and the next one what lies as
// far beyond that as it lay before it.
bool pyro_project_half(pyro *p, gpu *g, const pyro_numbers *half);
// After the other half. The pressure that the first half found is in the next velocity already.
bool pyro_project_again(pyro *p, gpu *g, const pyro_numbers *half);

// pyro_guide.c
bool pyro_allocate_guide(pyro *p, gpu *g);
void pyro_list_guide(const pyro *p, budget_list *out);
// What the guide adds to the velocity of the state in this step, in `pull`.
bool pyro_find_pull(pyro *p, gpu *g, const pyro_numbers *numbers);
void pyro_set_pull(const pyro *p, kernel *k, const pyro_numbers *numbers); // of who adds it

// pyro_solids.c
// Of pressure, from the gas after the step and the solids.
bool pyro_find_coefficients(pyro *p, gpu *g, const pyro_numbers *numbers);
bool pyro_obstruct(pyro *p, gpu *g, const pyro_numbers *numbers); // the next state
