// A solver of incompressible 2D flow on the device: air that moves in one or more independent
// planes (slices) of the same size, and three scalars that it carries: density, temperature, dye.
//
// A slice has size[0] x size[1] cells, x to the right and y upwards. Scalars and pressure are
// located in the middle of cells. Velocities are staggered (Harlow and Welch 1965): horizontal ones
// on the left faces of cells, vertical ones on their bottom faces. Divergence and the gradient of
// pressure then match exactly: the projection leaves only the residual of its solver, pressure
// cannot alternate undetected from cell to cell, and walls are on faces, where the velocity across
// them is known. Other code only sees velocities in the middle of cells.
//
// Units: metres and seconds for physical quantities, cells for positions. Pressure is kinematic,
// divided by the density of air: m^2/s^2. A steady flow against a pressure p has the speed sqrt(2
// p), whatever the cells and steps.
//
// A step (flow_step) is advection by the last velocity, forces and sources, then the projection
// (Chorin 1968), into whose pressure the templates are blended.
//
// Order of calls: flow_create, flow_compile (optional), flow_build, flow_allocate; then in frames
// flow_reset, and for each step whatever fills the three inputs, and flow_step.
#pragma once
#include "base/arena.h"
#include "kernel/kernel.h"

typedef struct flow flow;

typedef enum flow_face { FLOW_CLOSED, FLOW_OPEN, FLOW_PERIODIC } flow_face;
typedef enum flow_advection { FLOW_SEMI_LAGRANGIAN, FLOW_MACCORMACK } flow_advection;
// Conjugate gradients as published, or preconditioned by a multigrid cycle or by a transform along
// x, which by itself solves a flow without obstacles and templates. Auto: the transform for such a
// flow (on software devices up to 128 cells along x), else multigrid.
typedef enum flow_solver { FLOW_CG, FLOW_MULTIGRID, FLOW_TRANSFORM, FLOW_AUTO } flow_solver;

enum {
    FLOW_LEAST_SIZE = 16,
    FLOW_MOST_SIZE = 2048,
    FLOW_MOST_LINE = 1024, // along y, of FLOW_TRANSFORM
    FLOW_MAX_SLICES = 64,
    FLOW_MAX_DEFINES = 32,
};

typedef struct flow_desc { // structure: what shaders are compiled for
    uint32_t size[2];      // cells
    uint32_t slices;
    flow_face faces[4]; // -x +x -y +y; opposite ones are both periodic or neither is
    flow_advection advection;
    flow_solver solver;
    bool sources;            // FlowSources is written
    bool obstacles;          // FlowObstacles is written
    bool templates;          // FlowTemplates is written
    uint32_t max_iterations; // of the pressure, per step; 0: chosen by solver and size
    uint32_t sweeps;         // of multigrid, on each level: 1 or 2; 0: chosen by the device
} flow_desc;

typedef struct flow_numbers { // parameters of a step; they may change with each step
    float dt;                 // s
    float cell;               // side of a cell, m
    float viscosity;          // m^2/s; clamped to the maximum that is stable for the step
    float vorticity;          // confinement, 1/s: acceleration by 1 m/s of difference across a cell
    float acceleration[2];    // m/s^2
    float buoyancy[2];        // upward (+y) acceleration by a density or temperature of 1, m/s^2
    float decay[3];           // of density, temperature, dye: 1/s; factor exp(-decay dt) per step
    float wall_velocity[4][2]; // of closed faces, m/s: along the face, and through it
    float friction;            // of closed faces and obstacles: 0 air slips, 1 it sticks
    float tolerance;           // of the pressure: residual relative to divergence; 0: 1e-3
    float max_speed;           // m/s, limit of velocities; 0: 32 cells per step
} flow_numbers;

flow *flow_create(arena *memory, const flow_desc *desc); // NULL with a message
const flow_desc *flow_get_desc(const flow *f);           // after flow_build with its choices

// Compiles the shaders, and with a device builds their pipelines. Any thread. `reader` may be NULL.
// flow_defines is valid afterwards.
bool flow_build(flow *f, gpu *g, shader_library *library, const shader_reader *reader);
// Allocates the state. Its content is undefined until flow_reset; an existing state is kept.
bool flow_allocate(flow *f, gpu *g);
// After flow_build: adds what flow_allocate, and the first two steps, will take.
void flow_list_memory(const flow *f, budget_list *out);
void flow_destroy(flow *f, gpu *g);

// Sets air at rest, scalars 0 and inputs 0 (no source, no obstacle, no template). Call it inside a
// frame.
bool flow_reset(flow *f, gpu *g);
// Writes the state as it is to images (flow_image), as a step does that is kept. Call it inside a
// frame.
bool flow_keep(flow *f, gpu *g, const flow_numbers *numbers);
// Records one step, inside a frame. `keep`: the state after it is written to images (flow_image),
// which is done for the last step of a frame, and sometimes for the last two.
bool flow_step(flow *f, gpu *g, const flow_numbers *numbers, bool keep);
uint64_t flow_steps(const flow *f); // since flow_reset

// Returns the state that was kept last (0) or the one kept before it (1) as a 3D image (x, y,
// slice). Sample it linearly along x and y, in the middle of a slice. NULL: there is none.
typedef enum flow_look {
    FLOW_SCALARS,  // rgba16f: density, temperature, dye, pressure (m^2/s^2)
    FLOW_VELOCITY, // rg16f: m/s, in the middle of cells
    FLOW_LOOKS
} flow_look;
gpu_image *flow_image(const flow *f, flow_look look, int which);

typedef struct flow_report { // a report on the state after a step
    uint64_t step;           // flow_steps at that time
    uint32_t iterations;     // of the pressure: maximum over the slices
    float residual;          // relative residual: maximum over the slices
    float speed;             // greatest speed, m/s
    float sum[3], most[3];   // sum and maximum of density, temperature, dye over all cells
} flow_report;

// Records a report. Call it once inside a frame, after its last step.
bool flow_watch(flow *f, gpu *g);
// Reads the newest report of a frame that has finished. False: there is none yet. Never waits.
bool flow_read(const flow *f, gpu *g, flow_report *out);

// Returns the defines for a shader that includes sim/flow/state.glsl; after flow_build. The inputs
// (FlowSources, FlowObstacles, FlowTemplates) exist if the desc says so. Their content is kept
// until it is written again.
size_t flow_defines(const flow *f, shader_define out[FLOW_MAX_DEFINES]);
gpu_buffer *flow_find(const flow *f, const char *slot_name); // NULL: not one of the solver's
// Binds the solver's buffers to the slots of a kernel. `places` comes from kernel_find with the
// names of flow_kernel_table.
void flow_bind(const flow *f, kernel *k, const kernel_place *places);
extern const kernel_table flow_kernel_table;

// Returns the buffers of the state, without the count of steps and the inputs.
enum { FLOW_STATE_BUFFERS = 3 };
size_t flow_buffers(const flow *f, gpu_buffer *out[FLOW_STATE_BUFFERS]);

// Exchanges the states, images and counts of steps of two solvers. False when their sizes or slices
// differ.
bool flow_exchange(flow *a, flow *b);
