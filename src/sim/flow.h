// Incompressible flow in 2D on the device: air that moves in one or more independent planes
// (slices) of one size, and three scalars that it carries: density, temperature, dye.
//
// A slice has size[0] x size[1] cells, x to the right and y upwards. Scalars and pressure are of
// the middle of cells; velocities are staggered (Harlow and Welch 1965): horizontal ones of the
// left faces of cells, vertical ones of their bottom faces. So divergence and the gradient of
// pressure fit each other exactly: what the projection leaves is the residual of its solver and
// nothing else, no pressure can alternate unseen from cell to cell, and walls lie on faces, where
// the velocity across them is known. Others see velocities of the middle of cells alone.
//
// Units: metres and seconds where numbers say what acts, cells where they say where. Pressure is
// kinematic, over the density of air: m^2/s^2. A steady flow against a pressure p is as fast as
// sqrt(2 p), whatever the cells and steps.
//
// A step (flow_step): advection by the velocity before it, forces, what the sources say; then the
// projection (Chorin 1968), whose pressure the templates are blended into.
//
// Life: flow_create, flow_compile (or not), flow_build, flow_allocate, then in frames flow_reset,
// and for each step whatever fills the three inputs, and flow_step.
#pragma once
#include "base/arena.h"
#include "kernel/kernel.h"

typedef struct flow flow;

typedef enum flow_face { FLOW_CLOSED, FLOW_OPEN, FLOW_PERIODIC } flow_face;
typedef enum flow_advection { FLOW_SEMI_LAGRANGIAN, FLOW_MACCORMACK } flow_advection;
// Conjugate gradients as published, or preconditioned by a multigrid cycle or by a transform along
// x, which alone solves what has neither obstacles nor templates. Auto: that where it does (in
// software up to 128 cells along x), else multigrid.
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
    uint32_t max_iterations; // of the pressure, each step; 0: what suits solver and size
    uint32_t sweeps;         // of multigrid, on each level: 1 or 2; 0: what suits the device
} flow_desc;

typedef struct flow_numbers { // of a step; read anew each step
    float dt;                 // s
    float cell;               // side of a cell, m
    float viscosity;          // m^2/s; any: what is too much for the step is as much as it can take
    float vorticity;          // confinement, 1/s: acceleration by 1 m/s of difference across a cell
    float acceleration[2];    // m/s^2
    float buoyancy[2];        // upwards (+y) by 1 of density, 1 of temperature, m/s^2
    float decay[3];           // of density, temperature, dye: 1/s; to exp(-decay dt) in a step
    float wall_velocity[4][2]; // of closed faces, m/s: what slides, or blows through
    float friction;            // of closed faces and obstacles: 0 air slips along them, 1 it sticks
    float tolerance;           // of the pressure: residual to divergence; 0: 1e-3
    float max_speed;           // m/s; velocities are kept below; 0: 32 cells a step
} flow_numbers;

flow *flow_create(arena *memory, const flow_desc *desc); // NULL with a message
const flow_desc *flow_get_desc(const flow *f);           // after flow_build with what it chose

// Compiles all that flow_build would, without a device. `reader` may be NULL.
bool flow_compile(flow *f, shader_library *library, const shader_reader *reader);
// Shaders and pipelines; any thread. Afterwards flow_defines can be asked.
bool flow_build(flow *f, gpu *g, shader_library *library, const shader_reader *reader);
// State; contents undefined until flow_reset. What is there, of an exchange too, stays.
bool flow_allocate(flow *f, gpu *g);
// After flow_build: adds what flow_allocate, and the first two steps, will take.
void flow_list_memory(const flow *f, budget_list *out);
void flow_destroy(flow *f, gpu *g);

// Inside a frame: air at rest, scalars 0, the inputs 0 (no source, no obstacle, no template).
bool flow_reset(flow *f, gpu *g);
// Inside a frame: records one step. `keep`: the state after it is looked at, see flow_image; of the
// steps of a frame that is the last one, at times the last two.
bool flow_step(flow *f, gpu *g, const flow_numbers *numbers, bool keep);
uint64_t flow_steps(const flow *f); // since the reset

// What the state looked like after the last kept step (0) and the one kept before it (1), as 3D
// images: (x, y, slice), to be sampled linearly along x and y, in the middle of a slice. NULL:
// there is none.
typedef enum flow_look {
    FLOW_SCALARS,  // rgba16f: density, temperature, dye, pressure (m^2/s^2)
    FLOW_VELOCITY, // rg16f: m/s, of the middle of cells
    FLOW_LOOKS
} flow_look;
gpu_image *flow_image(const flow *f, flow_look look, int which);

typedef struct flow_report { // of the state after a step
    uint64_t step;           // flow_steps then
    uint32_t iterations;     // of the pressure: the most that a slice took
    float residual;          // the greatest of a slice, of what it is measured against
    float speed;             // greatest, m/s
    float sum[3], most[3];   // density, temperature, dye: over all cells
} flow_report;

// Inside a frame, once, after its last step.
bool flow_watch(flow *f, gpu *g);
// The newest report of a frame that has finished; false: there is none yet. Never waits.
bool flow_read(const flow *f, gpu *g, flow_report *out);

// What a shader that includes sim/flow/state.glsl must be compiled with; after flow_build. The
// inputs (FlowSources, FlowObstacles, FlowTemplates) are there when desc says so. They keep what
// was written to them: for the next step too.
size_t flow_defines(const flow *f, shader_define out[FLOW_MAX_DEFINES]);
gpu_buffer *flow_find(const flow *f, const char *slot_name); // NULL: not one of its own
// Binds the solver's own buffers to the slots of a kernel, which kernel_find has found by the names
// of flow_kernel_table.
void flow_bind(const flow *f, kernel *k, const kernel_place *places);
extern const kernel_table flow_kernel_table;

// All that a state consists of besides the count of steps and the inputs.
enum { FLOW_STATE_BUFFERS = 3 };
size_t flow_buffers(const flow *f, gpu_buffer *out[FLOW_STATE_BUFFERS]);

// Gives each the state, looks and count of steps of the other; false when size or slices are not
// the same.
bool flow_exchange(flow *a, flow *b);
