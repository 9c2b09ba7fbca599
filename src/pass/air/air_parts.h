// The inside of simulated air, for the files of this family only. What `lbm` and `pyro` share is
// here: the grid, the clock, sources, bodies and the force. What differs is in `air_kind`.
#pragma once
#include "pass/air/air.h"
#include "pass/pass_impl.h"
#include "pass/steps.h"
#include "pass/templates.h"
#include "scene/voxels.h"
#include "sim/units.h"

typedef struct air air;
struct checkpoint;
struct checkpoint_list;

typedef struct air_meshes { // bodies as cells; zero: none
    voxels_body *bodies;
    size_t count, capacity;
    voxels *cells;
    double updated; // time of the last update; NAN: none
    bool met;       // one of them has been in the air's box
} air_meshes;

typedef struct air_baked { // a field that steps sample; without an image: there is none
    gpu_image *image;
    uint64_t turn; // in which it was baked; UINT64_MAX: never
} air_baked;

typedef struct air_templates { // zero: none
    template_set set;
    gpu_image *image; // what they do, with the force
} air_templates;

enum { AIR_COARSER = 2 }; // cells along a side of one of the images of forces and templates
enum {
    AIR_SHOW,
    AIR_FORCE,
    AIR_GUIDE,
    AIR_TEMPLATES,
    AIR_KERNELS
}; // of the passes; those of steps are the solvers'
enum { AIR_STEP, AIR_VOXELS, AIR_SOURCES, AIR_FIELDS, AIR_LABELS };

// Of all types of the family. Options of faces in the order of lbm_desc.faces and pyro_desc.faces;
// uniforms of `lbm` from viscosity to wind in that of lbm_air_numbers.
#define AIR_NAMES(NAME)                                                                            \
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
        NAME(SourceNotes), NAME(fuel), NAME(burning), NAME(advection), NAME(gravity),              \
        NAME(ambient_temperature), NAME(ignition_temperature), NAME(burn_time),                    \
        NAME(heat_of_combustion), NAME(soot_yield), NAME(soot_burn_time), NAME(cooling),           \
        NAME(expansion), NAME(vorticity), NAME(soot), NAME(during), NAME(gas_now),                 \
        NAME(gas_before), NAME(flow_now), NAME(flow_before), NAME(burn_power), NAME(oxygen_need),  \
        NAME(burns_above), NAME(rates), NAME(ambient), NAME(velocity_cells), NAME(combustion),     \
        NAME(flame_speed), NAME(flame_power), NAME(present_from), NAME(particles), NAME(radius),   \
        NAME(step_seconds), NAME(time_scale), NAME(SourceMarks), NAME(guide), NAME(guide_rate),    \
        NAME(guide_size), NAME(smoke), NAME(smoke_yield), NAME(smoke_dissolve_rate),               \
        NAME(smoke_now), NAME(smoke_before), NAME(turbulence), NAME(kind), NAME(align),            \
        NAME(region), NAME(direction), NAME(seed), NAME(key), NAME(parity), NAME(tile),            \
        NAME(time_step), NAME(corner), NAME(own_force), NAME(outflow), NAME(Templates),            \
        NAME(TemplateMasks), NAME(TemplateImages)
enum { AIR_NAMES(KERNEL_NAME_ID), AIR_NAME_COUNT };
extern const char *const air_names[AIR_NAME_COUNT];

// What one kind of air does where they differ. Numbers are as of the host's context.
typedef struct air_kind {
    const pass_fluid_field *fields;
    size_t field_count;
    const int *outputs; // names of the images that it writes, four channels each
    size_t output_count;
    size_t periodic;              // the word of a face that is
    bool (*check)(const pass *p); // whether its other options go together; may be NULL
    int64_t late;                 // of its clock (pass/steps.h)
    bool burns;                   // a step costs as much as one of burning gas
    const int *source_fields;     // names of what sources may give
    size_t source_field_count;
    uint64_t (*steps)(const air *a);           // that the solver has done
    bool (*evaluate)(air *a);                  // its numbers, before all else of a step
    bool (*reset)(air *a);                     // the state at the beginning
    bool (*step)(air *a, bool keep);           // after bodies and sources
    bool (*move_solids)(air *a, bool changed); // cells are of other bodies than before
    // Binds and sets what a kernel that reads the air's state takes of the solver.
    void (*bind)(const air *a, const pass *p, size_t index, kernel *k);
    // Sets what else the kernel that gives the air a source's values takes of the solver, and
    // says how many threads it has for the cells of the source's box.
    bool (*give)(const air *a, pass *source, kernel *k, uint32_t threads[3]);
    size_t (*source_defines)(const air *a, shader_define *out);
    bool (*exchange)(air *a, air *other); // the solvers' states
    void (*restart)(air *a);              // NULL: nothing more is to forget
    // The image of the force, or what templates make of it, NULL without; and the guide's is there.
    void (*take_force)(air *a, gpu_image *image);
    // Cells of the guide along each axis, for any numbers or by those of the step. NULL: it has
    // none.
    void (*guide_cells)(const air *a, bool most, uint32_t out[3]);
} air_kind;

struct air {
    field_grid grid; // first: the effect has it
    const air_kind *kind;
    pass *pass;
    pass_air_desc desc;
    sim_units units;
    bool used[PASS_FLUID_MOST_NAMES]; // by a field or a source

    pass **sources;
    size_t source_count, source_capacity;
    air_meshes *givers; // of each source that has some: where two meet, both give
    size_t giver_count, giver_capacity;
    air_meshes solids;      // of colliders
    air_baked force, guide; // the force when it varies in space
    air_templates templates;
    const char *labels[AIR_LABELS]; // of times

    bool fresh;           // begins anew with the next record
    bool stopped;         // on trouble
    char trouble[512];    // what it says; "": nothing
    bool reported;        // the kind has a report of it
    uint64_t shown_steps; // of the grid's content
    double shown_blend;
    uint64_t last_steps; // that the last record took
};

static inline air *air_of(const pass *p) {
    return p->state;
}

// air.c
// Makes `a`, which is the first member of what the kind has, the air of `p`. NULL with a message.
field_grid *air_open(air *a, const air_kind *kind, pass *p, const pass_air_desc *desc,
                     sim_units units);
bool air_check_desc(const pass *p, const pass_air_desc *desc); // false with a message
bool air_declare(pass *p);
bool air_add_part(pass *p, bool (*record)(pass *p));
void air_destroy(pass *p);
extern const pass_kernel air_kernels[AIR_KERNELS];
bool air_defines(pass *p, size_t index, pass_defines *out);

bool air_each_source(const air *a, bool (*call)(pass *source));
bool air_rehearse_sources(const air *a);
void air_describe(const air *a, struct strbuf *out); // for checkpoints: time and place

// air_time.c
double air_step_seconds(const air *a);             // of the effect's time that a step takes
double air_step_time(const air *a, uint64_t step); // of the state before it
// What is dear to find, the force and what sources hold, is found anew so many times a second of
// the simulation, whatever is drawn: in which turn the next step lies, and from when to when it is.
uint64_t air_turn(const air *a, double *begin, double *end);
int64_t air_left(const pass *p, double time);
int64_t air_most(const pass *p);
double air_reached(const pass *p);
void air_restart(pass *p);
bool air_advance(pass *p); // to the host's time, as far as one submit goes
double air_work(const pass *p);
// Whether the grid is that of the host's time already. If not, it is about to be.
bool air_is_shown(pass *p, air *a);
void air_set_frame(pass *p, const air *a); // numbers of the kernel that shows it
bool air_tell_absent(air *a); // as trouble: what was never in the air's box; false: nothing

// air_force.c
bool air_force_varies(const pass *p);
bool air_is_guided(const pass *p);
bool air_constant_force(const pass *p, float out[3]); // m/s^2; 0 where it varies
gpu_image_desc air_describe_force(const air *a, const char *label);
bool air_allocate_force(air *a);                     // and the guide; after the templates' image
void air_list_force(const air *a, budget_list *out); // its memory
// Force and guide as of the host's time, which is that of a step.
bool air_push(air *a);
void air_destroy_force(air *a);

// air_templates.c
bool air_has_templates(const air *a);
bool air_has_outflow(const air *a); // templates of pressure
bool air_allocate_templates(air *a);
void air_list_templates(const air *a, budget_list *out); // their memory
bool air_run_templates(air *a);                          // before a step
void air_destroy_templates(air *a);
void air_save_templates(const air *a, struct checkpoint_list *out);
bool air_load_templates(air *a, struct checkpoint *from);
void air_define_templates(const air *a, pass_defines *out); // of the kernel that draws them

// air_source.c
typedef struct air_cells { // whole numbers
    float first[3], count[3];
} air_cells;
typedef struct air_source {
    air *air;
    uint32_t note;       // its bit of the guard's notes; 0: there was none left
    size_t giver;        // which of the air's are its meshes, from 1; 0: it has none
    uint64_t turn;       // in which the values were found; UINT64_MAX: never
    air_cells cells;     // of its box in this turn
    uint64_t most;       // cells that the box has, wherever it is
    gpu_buffer *values;  // of as many; NULL: none yet
    gpu_buffer *marks;   // of particles that are near; NULL: none yet, or none needed
    unsigned char *last; // the numbers that they were found with
    air_cells last_cells;
    bool known;   // these two
    bool met;     // it has been in the air's box
    bool coupled; // the air carries its particles
} air_source;
static inline air_source *air_source_of(const pass *source) {
    return source->state;
}
enum { AIR_EVALUATE, AIR_GIVE, AIR_MARK, AIR_SOURCE_KERNELS };
// Whether a field of the pass samples the air, with a message that ends with `instead`: what it
// holds is known when a step is done, and the pass runs before.
bool air_is_read_by(const air *a, const pass *p, const char *instead);
bool air_run_source(pass *source);                // before a step
void air_forget_source(pass *source);             // its values are found anew
bool air_source_waits(const pass *source);        // its particles have not come to the host's time
graph_image air_source_reads(const pass *source); // zero: nothing but what its fields sample
bool air_source_is_away(const pass *source);      // it ran, and was never in the air's box

// air_source_box.c
// With a cell around, since a sheet has no size.
bool air_mesh_box(const air *a, const scene_mesh *mesh, const field_context *context, box3 *out);
// From the host's time to `end`. `most`, which may be NULL: the cells that a box of that size has
// at most, wherever in the air it is.
bool air_source_cells(const air *a, const pass *p, double end, air_cells *out, uint64_t *most);

// air_bodies.c
air_meshes *air_add_giver(air *a); // until the next one is added
void air_add_body(air_meshes *m, const scene_mesh *mesh, voxels_rule rule);
bool air_make_bodies(air *a); // when all are known
bool air_build_bodies(air *a);
bool air_allocate_bodies(air *a);
void air_list_bodies(const air *a, budget_list *out); // their memory
bool air_move_bodies(air *a);                         // to the host's time, which is that of a step
void air_destroy_bodies(air *a);
