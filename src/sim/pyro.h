// A solver of gas that burns, on the device: fuel burns where it is hot and finds oxygen, what
// burns becomes warmer and expands, what is warm rises, and soot and radiation take their part. Low
// Mach number: no sound, no shock.
//
// The gas is in a box of cells. Velocities are staggered (Harlow and Welch 1965), all else is in
// the middle of cells. A step (pyro_step) carries what the gas holds (by volumes that move: Colella
// and Woodward 1984, Easter 1993), burns it, carries the velocity in the same way and pushes it,
// then makes it as divergent as the expansion wants (Chorin 1968; pressure by multigrid, a fixed
// number of cycles that begin with the last step's pressure).
//
// Units: metres, seconds, kelvin, kilograms. Fuel, what has burnt, and soot are by mass of air
// where they burn, and by volume where they are carried; pyro_image has kg/m^3.
//
// Order of calls: pyro_create, pyro_compile (optional), pyro_build, pyro_allocate; then in frames
// pyro_reset, and pyro_step.
#pragma once
#include "base/arena.h"
#include "kernel/kernel.h"

typedef struct pyro pyro;

// Open air; a wall that air slips along; a face through which air comes in; around to the other
// side.
typedef enum pyro_face { PYRO_OPEN, PYRO_WALL, PYRO_INFLOW, PYRO_PERIODIC } pyro_face;
// What is taken to lie within a cell, of which a part flows into the next one.
typedef enum pyro_advection {
    PYRO_UPWIND,    // the same all over
    PYRO_PARABOLIC, // a parabola
    PYRO_REFLECTION // the same; and the velocity goes half a step, is reflected by its projection,
                    // and goes the other half (Zehnder, Narain and Thomaszewski 2018)
} pyro_advection;
enum { PYRO_ADVECTIONS = 3 };
extern const char *const pyro_advection_names[PYRO_ADVECTIONS]; // as scripts have them
typedef enum pyro_precision { PYRO_F32, PYRO_F16, PYRO_AUTO } pyro_precision;

enum {
    PYRO_LEAST_SIZE = 16,
    PYRO_MOST_SIZE = 1024,
    PYRO_BRICK = 8,
    PYRO_MAX_DEFINES = 32,
};

typedef struct pyro_desc { // structure: what shaders are compiled for
    uint32_t size[3];      // cells of the gas, multiples of PYRO_BRICK
    pyro_face faces[6];    // -x +x -y +y -z +z; opposite ones are both periodic or neither is
    pyro_advection advection;
    pyro_precision precision; // of velocities and the gas; auto: by the device
    bool half_velocity;    // velocity and pressure have half as many cells along each axis, which
                           // are multiples of 16 then, and no face is periodic
    bool smoke;            // the gas carries some that does not glow or burn
    bool premixed;         // fuel burns where a flame passes, not where it is hot
    bool confinement;      // numbers may have some
    bool turbulence;       // numbers may have some
    bool force;            // pyro_set_force is called before the first step
    bool outflow;          // its image says how much gas comes from nowhere, too
    bool guide;            // pyro_set_guide is called before the first step
    bool variable_density; // pressure moves light gas farther than heavy gas
    bool solids;           // pyro_set_solids is called before each step
    uint32_t cycles;       // of multigrid, per step; 0: 2, with solids or variable density 3
    bool timed;            // stages of a step have GPU times of their own
} pyro_desc;

typedef struct pyro_numbers { // parameters of a step; they may change with each step
    float dt;                 // s
    float cell;               // side of a cell of the gas, m
    float ambient;            // temperature of the surroundings, K
    float gravity;            // m/s^2, downwards along z
    float acceleration[3];    // m/s^2
    float guide_rate;         // at which large eddies become those of the guide, 1/s
    float guide_size;         // side of the cells that tell large eddies from small ones, m
    float inflow[3];          // velocity across faces that are PYRO_INFLOW, m/s
    float confinement;        // acceleration by 1 m/s of difference across a cell, 1/s
    float turbulence;         // how much eddies below the cells push: 1 by their own shear
    float max_speed;          // limit of each component, m/s; 0: 7 cells of the gas per step
    float ignition;           // temperature above which fuel burns, K
    float flame_speed;        // of a flame into mixture at rest, m/s, with pyro_desc.premixed
    float burn_time;          // that fuel and oxygen in a cell take to mix, s; 0: at once
    float heat;               // of combustion, less what the flame radiates, J/kg
    float oxygen;             // kg that 1 kg of fuel takes
    float molar_mass;         // of the fuel's vapour, kg/kmol
    float soot_yield;         // kg of 1 kg of fuel
    float soot_burn_time;     // of soot in hot fresh air, s; 0: soot does not burn
    float dissolve;           // share of the soot that goes, 1/s
    float smoke_yield;        // kg of 1 kg of fuel, with pyro_desc.smoke
    float smoke_dissolve;     // share of the smoke that goes, 1/s
    float cooling;            // by which gas of 1500 K cools at first, K/s; as T^4
    float expansion;          // share of what gases do; 1
} pyro_numbers;

pyro *pyro_create(arena *memory, const pyro_desc *desc); // NULL with a message
const pyro_desc *pyro_get_desc(const pyro *p);           // after pyro_build with its choices

// Compiles the shaders, and with a device builds their pipelines. Any thread. `reader` may be NULL.
// pyro_defines is valid afterwards.
bool pyro_build(pyro *p, gpu *g, shader_library *library, const shader_reader *reader);
// Allocates the state. Its content is undefined until pyro_reset; an existing state is kept.
bool pyro_allocate(pyro *p, gpu *g);
// After pyro_build: adds what pyro_allocate, and the first two steps, will take.
void pyro_list_memory(const pyro *p, budget_list *out);
void pyro_destroy(pyro *p, gpu *g);

// Sets air of the surroundings, as fast as the inflow. Call it inside a frame.
bool pyro_reset(pyro *p, gpu *g, const pyro_numbers *numbers);
// Writes the state as it is to images (pyro_image), as a step does that is kept. Call it inside a
// frame.
bool pyro_keep(pyro *p, gpu *g, const pyro_numbers *numbers);
// Records one step, inside a frame. `keep`: the state after it is written to images (pyro_image),
// which is done for the last step of a frame, and sometimes for the last two.
bool pyro_step(pyro *p, gpu *g, const pyro_numbers *numbers, bool keep);
uint64_t pyro_steps(const pyro *p); // since pyro_reset

// An image of the whole box, of accelerations in m/s^2, which steps sample from now on. With
// pyro_desc.outflow its fourth channel is how much gas comes out of a place in a second, as a
// multiple of its volume (1/s): more of the gas that is there. Below 0 it goes.
void pyro_set_force(pyro *p, gpu_image *force);

// A guide: what the velocity shall be on the scale of cells of `guide_size`. The difference between
// it and the mean velocity of such a cell is taken back at `guide_rate`, linearly between cells;
// eddies that are smaller stay free (Thuerey, Keiser, Pauly and Ruede 2006; for weather von Storch,
// Langenberg and Feser 2000). Cells are those of the level of multigrid that comes nearest.
void pyro_find_guide_cells(const pyro *p, const pyro_numbers *numbers, uint32_t out[3]);
void pyro_find_most_guide_cells(const pyro *p, uint32_t out[3]); // for any numbers
// An image of as many texels as that, of velocities in m/s, of which steps read the first ones: as
// many as there are cells along each axis.
void pyro_set_guide(pyro *p, gpu_image *guide);

typedef struct pyro_solids {
    gpu_buffer *ids;     // an uint for each cell, x fastest: its solid, from 1; 0: gas
    gpu_buffer *motions; // struct voxel_motion of shared.h by id (m, m/s)
    float corner[3];     // of the box, m
    bool changed;        // ids are other than in the last step
} pyro_solids;
// The buffers are read until the next call.
void pyro_set_solids(pyro *p, const pyro_solids *solids);

// Returns how many cells of the gas lie along the side of one of the velocity: 1 or 2.
uint32_t pyro_ratio(const pyro_desc *desc);

// Returns the state that was kept last (0) or the one kept before it (1) as a 3D image of half
// floats. NULL: there is none.
typedef enum pyro_look {
    PYRO_GAS,   // temperature (K), and density (kg/m^3) of fuel, soot, fuel that has burnt
    PYRO_FLOW,  // velocity in the middle of cells (m/s), pressure (Pa)
    PYRO_SMOKE, // kg/m^3, with pyro_desc.smoke
    PYRO_LOOKS
} pyro_look;
gpu_image *pyro_image(const pyro *p, pyro_look look, int which);
gpu_image_desc pyro_describe_image(const pyro *p, pyro_look look);

typedef struct pyro_report { // a report on the state after a step
    uint64_t step;           // pyro_steps at that time
    uint32_t bad;            // cells that hold what is no number
    float speed;             // greatest, m/s
    float residual; // greatest divergence that is not wanted, times the side of its cell, m/s
    float hottest;  // K
    float fuel, burnt, soot; // sums over all cells of the air's mass times what it holds, kg
    float power;             // heat that burning gives, W, radiation left out
} pyro_report;

// Records a report. Call it once inside a frame, after its last step.
bool pyro_watch(pyro *p, gpu *g, const pyro_numbers *numbers);
// Reads the newest report of a frame that has finished. False: there is none yet. Never waits.
bool pyro_read(const pyro *p, gpu *g, pyro_report *out);

// Returns the defines for a shader that includes sim/pyro/state.glsl; after pyro_build.
size_t pyro_defines(const pyro *p, shader_define out[PYRO_MAX_DEFINES]);
// Binds the state's buffers (PyroGas, PyroVelocity, PyroPressure, PyroRight, PyroSmoke) to the
// slots of a kernel. `places` comes from kernel_find with the names of pyro_kernel_table.
void pyro_bind(const pyro *p, kernel *k, const kernel_place *places);
// Returns where the marks of the state begin in PyroActive, for present_from.
int32_t pyro_present_from(const pyro *p);
extern const kernel_table pyro_kernel_table;

// Returns the buffers of the state, without the count of steps: velocity, gas, pressure, and with
// pyro_desc.smoke that, of floats: kg by those of the air of the surroundings. The caller may
// change what they hold.
enum { PYRO_STATE_BUFFERS = 4 }; // at most
size_t pyro_buffers(pyro *p, gpu_buffer *out[PYRO_STATE_BUFFERS]);

// Exchanges the states, images and counts of steps of two solvers. False when their cells or
// precisions differ.
bool pyro_exchange(pyro *a, pyro *b);
