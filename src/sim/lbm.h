// A lattice Boltzmann solver on the device: air that moves on a regular lattice, and up to three
// scalars that it carries. All units are lattice units: a cell has length 1, a step takes time 1,
// air at rest has density 1.
//
// Layout, which shaders/sim/lbm/state.glsl reads: an element is n = 4 cells that lie nz / n apart
// along z, so that cell (x, y, z) is lane z / (nz / n) of element x + nx * (y + ny * (z % (nz /
// n))): a vec4 (LBM_F32) or a uvec2 of four halves in order (LBM_F16). The neighbours of a whole
// element are a whole element again; where z goes round, its lanes rotate by one. On GPUs n is 2
// in half precision, and four elements that lie nz / 8 apart are side by side in memory, if nz is
// a multiple of 8: a bundle of 16 bytes, whose neighbours are whole bundles. Populations of
// the air are stored minus their weights, and streamed in place.
//
// Order of calls: lbm_create, lbm_compile (optional), lbm_build, lbm_allocate; then in frames
// lbm_reset and lbm_step.
#pragma once
#include "base/arena.h"
#include "kernel/kernel.h"

typedef struct lbm lbm;

typedef enum lbm_set { LBM_D3Q19, LBM_D3Q27 } lbm_set;
typedef enum lbm_scalar_set { LBM_SCALAR_D3Q7, LBM_SCALAR_D3Q27 } lbm_scalar_set;
typedef enum lbm_collision { LBM_BGK, LBM_TRT, LBM_CENTRAL_MOMENTS } lbm_collision;
typedef enum lbm_forcing { LBM_GUO, LBM_WEIGHTS_ONLY } lbm_forcing; // the latter as published
typedef enum lbm_beside { LBM_BY_LINKS, LBM_BY_VELOCITY } lbm_beside;
typedef enum lbm_precision { LBM_F32, LBM_F16 } lbm_precision; // of what is stored
typedef enum lbm_order {                                       // of the state in memory
    LBM_ORDER_AUTO,
    LBM_BLOCKS,
    LBM_WHOLE
} lbm_order;
typedef enum lbm_face { LBM_PERIODIC, LBM_WALL, LBM_SLIP, LBM_OPEN, LBM_INFLOW } lbm_face;

enum {
    LBM_ALONG_Z = 4, // the number of cells along z is a multiple of this
    LBM_MAX_SCALARS = 3,
    LBM_MAX_DEFINES = 32,
    LBM_MAX_BUFFERS = 16
};

typedef struct lbm_desc { // structure: what shaders are compiled for
    // Cells, at least 4 x 4 x 16; z a multiple of 4. The outermost layer of a face that is not
    // periodic is the boundary. Opposite faces are both periodic or neither is.
    uint32_t size[3];
    lbm_set set;
    lbm_scalar_set scalar_set;
    lbm_collision collision;
    lbm_forcing forcing;      // LBM_WEIGHTS_ONLY requires LBM_BGK
    lbm_beside beside_bodies; // how scalars on D3Q7 are carried beside bodies
    lbm_precision precision;
    lbm_face faces[6]; // -x +x -y +y -z +z
    uint32_t scalars;  // smoke, temperature, second species: in this order
    bool subgrid;      // Smagorinsky
    bool force;        // an image gives a force that varies in space: lbm_set_force
    bool outflow;      // and how much air comes from nowhere
    bool bodies;       // there are solids, which may move
    // Layout of the state in memory. 0: chosen by the device.
    uint32_t lanes;  // cells of an element, 4; or 2, with LBM_F16
    lbm_order order; // directions by turns, in blocks of a few elements, or each as a whole
} lbm_desc;

typedef struct lbm_numbers { // parameters of a step; they may change with each step
    float tau;               // relaxation time of the air, above 1/2: viscosity (tau - 1/2) / 3
    float scalar_tau[LBM_MAX_SCALARS]; // diffusion (tau - 1/2) * lbm_scalar_speed
    float smagorinsky;                 // constant of the subgrid term, about 0.1 to 0.2
    float acceleration[3];
    float buoyancy[LBM_MAX_SCALARS][3]; // acceleration by a scalar that is 1 above ambient
    float inflow[6][3];                 // velocity at faces LBM_INFLOW and LBM_OPEN
    float inflow_scalar[6][LBM_MAX_SCALARS];
    float ambient[LBM_MAX_SCALARS]; // initial value of scalars, to which they decay
    float decay[LBM_MAX_SCALARS];   // part of the difference to ambient that is lost in a step
    float max_speed;                // limit of velocities; 0: none
} lbm_numbers;

lbm *lbm_create(arena *memory, const lbm_desc *desc); // NULL with a message
const lbm_desc *lbm_get_desc(const lbm *l);
uint32_t lbm_depth(const lbm *l); // elements, or bundles of them, along z; after lbm_build
// Returns the square of the speed of sound of a scalar set: 1/4 (D3Q7) or 1/3.
float lbm_scalar_speed(lbm_scalar_set set);

// Compiles the shaders, and with a device builds their pipelines. Any thread. `reader` may be NULL.
// lbm_defines and lbm_bind are valid afterwards.
bool lbm_build(lbm *l, gpu *g, shader_library *library, const shader_reader *reader);
// Allocates the state. Its content is undefined until lbm_reset; an existing state is kept.
bool lbm_allocate(lbm *l, gpu *g);
// After lbm_build: adds what lbm_allocate, and the first two steps that are kept, will take.
void lbm_list_memory(const lbm *l, budget_list *out);
void lbm_destroy(lbm *l, gpu *g);

// Sets air at rest, scalars at ambient, and step 0. Call it inside a frame.
bool lbm_reset(lbm *l, gpu *g, const lbm_numbers *numbers);
// Records one step, inside a frame. `keep`: writes the moments of the state before the step.
bool lbm_step(lbm *l, gpu *g, const lbm_numbers *numbers, bool keep);
uint64_t lbm_steps(const lbm *l); // since lbm_reset

// Returns the moments of the last kept state (0) or of the one kept before it (1). NULL: there is
// none. Each cell, x fastest, then y, then z, has a uvec4 of eight halves: velocity, density - 1,
// scalars, then 1 for a body or a wall, else 0.
gpu_buffer *lbm_moments(const lbm *l, int which);

typedef struct lbm_body { // a rigid motion
    float centre[3];      // cells from the lattice's corner: the point that moves with `linear`
    float linear[3];      // per step
    float angular[3];     // radians per step
} lbm_body;

typedef struct lbm_bodies {
    gpu_buffer *ids;        // one uint for each cell, x fastest: the body in it, or 0
    bool changed;           // the ids differ from those of the last call
    const lbm_body *bodies; // indexed by id - 1
    uint32_t count;         // the greatest possible id
} lbm_bodies;

// With desc.bodies, inside a frame, before the first step after a reset and whenever bodies move:
// where they are and how they go on. Cells that they left are filled from around. The ids are read
// by all steps up to the next call, and may not change in between. Bodies that move by more than a
// cell at once jump over air: smoke gets through.
bool lbm_set_bodies(lbm *l, gpu *g, const lbm_numbers *numbers, const lbm_bodies *bodies);

// With desc.force: acceleration is `scale` times the first three channels of a 3D image over the
// whole lattice, sampled linearly. With desc.outflow, so much of the air that is there comes
// besides in a step as `outflow` times the fourth channel, or goes, with what it carries. It must
// be set before the first step.
void lbm_set_force(lbm *l, gpu_image *image, float scale, float outflow);

// Return the defines for a shader that includes sim/lbm/state.glsl, and the value of its uniform
// "lbm_parity"; after lbm_build.
size_t lbm_defines(const lbm *l, shader_define out[LBM_MAX_DEFINES]);
uint32_t lbm_parity(const lbm *l);
// Binds the solver's buffers to the slots of a kernel. `places` comes from kernel_find with the
// names of lbm_kernel_table.
void lbm_bind(const lbm *l, kernel *k, const kernel_place *places);
extern const kernel_table lbm_kernel_table;
// Lists the buffers of the populations, in order. sim/lbm_state.h has the whole state.
size_t lbm_buffers(const lbm *l, gpu_buffer **out, size_t capacity);

// Exchanges the states, moments and counts of steps of two solvers. False when their structures
// differ.
bool lbm_exchange(lbm *a, lbm *b);
