// The inside of the pass type `lbm`, for its own files only.
#pragma once
#include "pass/air/lbm.h"
#include "pass/pass_impl.h"
#include "scene/voxels.h"
#include "sim/lbm.h"
#include "sim/lbm_guard.h"
#include "sim/units.h"

typedef struct lbm_meshes { // bodies as cells; zero: none
    voxels_body *bodies;
    size_t count, capacity;
    voxels *cells;
    double updated; // time of the last update; NAN: none
    bool met;       // one of them has been in the air's box
} lbm_meshes;

enum { LBM_SHOW, LBM_FORCE, LBM_KERNELS }; // of the pass; those of steps are the solver's

// Of `lbm` and `lbm_source`. Options of faces in the order of lbm_desc.faces; uniforms in that of
// lbm_air_numbers.
#define LBM_NAMES(NAME)                                                                            \
    NAME(boundary_left), NAME(boundary_right), NAME(boundary_front), NAME(boundary_back),          \
        NAME(boundary_bottom), NAME(boundary_top), NAME(viscosity), NAME(diffusion),               \
        NAME(temperature_diffusion), NAME(buoyancy_density), NAME(buoyancy_heat),                  \
        NAME(dissolve_rate), NAME(cooling_rate), NAME(smagorinsky), NAME(wind),                    \
        NAME(velocity_set), NAME(scalar_set), NAME(collision), NAME(forcing), NAME(beside_bodies), \
        NAME(precision), NAME(guard), NAME(force), NAME(scalars), NAME(velocity), NAME(size),      \
        NAME(blend), NAME(speed), NAME(pressure), NAME(acceleration), NAME(Moments),               \
        NAME(MomentsBefore), NAME(Guard), NAME(shape), NAME(density), NAME(temperature),           \
        NAME(dye), NAME(rate), NAME(velocity_factor), NAME(rule), NAME(cell_size), NAME(first),    \
        NAME(count), NAME(step_speed), NAME(clamp_speed), NAME(pascal), NAME(note), NAME(share),   \
        NAME(lbm_parity), NAME(SourceValues), NAME(SourceIds), NAME(SourceMotions),                \
        NAME(SourceNotes)
enum { LBM_NAMES(KERNEL_NAME_ID), LBM_NAME_COUNT };
extern const char *const lbm_names[LBM_NAME_COUNT];

typedef struct lbm_force { // that varies in space; zero: it does not
    gpu_image *image;
    uint64_t turn; // in which it was baked; UINT64_MAX: never
} lbm_force;

enum { LBM_STEP, LBM_VOXELS, LBM_SOURCES, LBM_FIELDS, LBM_LABELS };

typedef struct lbm_air {
    field_grid grid; // first: the effect has it
    pass *pass;
    pass_lbm_desc desc;
    sim_units units;
    bool used[PASS_FLUID_NAMES]; // by a field or a source

    pass **sources;
    size_t source_count, source_capacity;
    lbm_meshes *givers; // of each source that has some: where two meet, both give
    size_t giver_count, giver_capacity;
    lbm_meshes solids; // of colliders
    lbm_body *moving;  // as these go on
    lbm *solver;       // after pass_complete
    lbm_guard *guard;

    lbm_force force;
    const char *labels[LBM_LABELS]; // of times

    bool fresh; // begins anew with the next record
    bool stops; // on trouble
    bool stopped;
    char trouble[512]; // what it says; "": nothing
    lbm_report report; // the newest
    bool reported;
    double held;          // seconds at which it was first held back; NAN: never
    uint64_t shown_steps; // of the grid's content
    double shown_blend;
    uint64_t last_steps; // that the last record took
} lbm_air;

static inline lbm_air *lbm_air_of(const pass *p) {
    return p->state;
}

// lbm_numbers.c: values as of the host's context
bool lbm_air_numbers(const pass *p, lbm_numbers *out);
sim_flow lbm_air_flow(const pass *p);
// Cells a step. By `guard` one of them is the greatest that is air, the other out of reach.
float lbm_air_clamp_speed(const lbm_air *a);  // what moves, or is given, is slowed down to it
float lbm_air_spoilt_speed(const lbm_air *a); // faster air is stopped, and not shown
bool lbm_air_force_varies(const pass *p);

// lbm_time.c
double lbm_air_step_time(const lbm_air *a, uint64_t step); // of the state before it
// What is dear to find, the force and what sources hold, is found anew so many times a second of
// the simulation, whatever is drawn: in which turn the next step lies, and from when to when it is.
uint64_t lbm_air_turn(const lbm_air *a, double *begin, double *end);
int64_t lbm_air_left(const pass *p, double time);
int64_t lbm_air_most(const pass *p);
double lbm_air_reached(const pass *p);
void lbm_air_restart(pass *p);
bool lbm_air_advance(pass *p); // to the host's time, as far as one submit goes
// How the two kept states are mixed for the host's time.
double lbm_air_blend(const lbm_air *a, double time);

// lbm_build.c
bool lbm_air_check(pass *p);
bool lbm_air_build(pass *p);
bool lbm_air_allocate(pass *p);
void lbm_air_list_memory(const pass *p, budget_list *out);
void lbm_air_destroy(pass *p);

// lbm_frame.c
bool lbm_air_update(pass *p);
bool lbm_air_rehearse(pass *p);
bool lbm_air_record(pass *p);
double lbm_air_pascals(const lbm_air *a); // of an excess of density of 1

// lbm_force.c
bool lbm_air_allocate_force(lbm_air *a);
void lbm_air_list_force(const lbm_air *a, budget_list *out); // its memory
bool lbm_air_push(lbm_air *a); // the force as of the host's time, which is that of a step
void lbm_air_destroy_force(lbm_air *a);

// lbm_source.c
bool lbm_air_run_source(pass *source);         // before a step
void lbm_air_forget_source(pass *source);      // its values are found anew
bool lbm_source_is_away(const pass *source);   // it ran, and was never in the air's box
bool lbm_source_is_buried(const pass *source); // all that it ever held was in solids

// lbm_source_box.c
typedef struct lbm_cells { // whole numbers
    float first[3], count[3];
} lbm_cells;
// With a cell around, since a sheet has no size.
bool lbm_mesh_box(const lbm_air *a, const scene_mesh *mesh, const field_context *context,
                  box3 *out);
// From the host's time to `end`. `most`, which may be NULL: the cells that a box of that size has
// at most, wherever in the air it is.
bool lbm_source_cells(const lbm_air *a, const pass *p, double end, lbm_cells *out, uint64_t *most);

// lbm_bodies.c
lbm_meshes *lbm_air_add_giver(lbm_air *a); // until the next one is added
void lbm_air_add_body(lbm_meshes *m, const scene_mesh *mesh, voxels_rule rule);
bool lbm_air_make_bodies(lbm_air *a); // when all are known
bool lbm_air_check_bodies(lbm_air *a);
bool lbm_air_build_bodies(lbm_air *a);
bool lbm_air_allocate_bodies(lbm_air *a);
void lbm_air_list_bodies(const lbm_air *a, budget_list *out); // their memory
// To the host's time, which is that of a step.
bool lbm_air_move_bodies(lbm_air *a, const lbm_numbers *numbers);
void lbm_air_destroy_bodies(lbm_air *a);

// lbm_state.c
void lbm_air_save(const pass *p, struct checkpoint_list *out);
bool lbm_air_load(pass *p, struct checkpoint *from);

// lbm_readouts.c
extern const pass_simulation lbm_simulation;
bool lbm_air_watch(pass *p); // after steps: what the guard found, and what it is to look at
size_t lbm_air_readouts(const pass *p, pass_readout *out, size_t capacity);
double lbm_air_work(const pass *p);
const char *lbm_air_trouble(const pass *p);
