// The inside of the pass type `slices`, for its own files only.
#pragma once
#include "pass/pass_impl.h"
#include "pass/slices/slices.h"
#include "pass/steps.h"
#include "sim/flow.h"

typedef struct slices_flow slices_flow;

// What a file of its own adds to the flow: templates (slices_templates.c). Called by the hooks of
// the pass of the same name; NULL: nothing to do.
typedef struct slices_extra {
    bool (*complete)(slices_flow *f); // all has been declared; the solver is made next
    bool (*check)(slices_flow *f);    // the solver has been compiled
    bool (*build)(slices_flow *f);    // the solver has been built
    bool (*allocate)(slices_flow *f);
    void (*list_memory)(const slices_flow *f, budget_list *out);
    bool (*rehearse)(slices_flow *f);
    void (*restart)(slices_flow *f); // the flow begins anew
    void (*loaded)(slices_flow *f);  // slices_templates_buffer holds what a checkpoint did
    // Both have templates, and the solvers have been exchanged: those that match are, too.
    void (*exchange)(slices_flow *f, slices_flow *other);
    // Before a step, when inflow and forces are in the solver's buffers, which are written anew for
    // every step then. The host's context has the time of the step, flow_steps is its number, and
    // f->clock.step how long it takes.
    bool (*run)(slices_flow *f);
    void (*destroy)(slices_flow *f);
} slices_extra;

enum { SLICES_SHOW, SLICES_DRAW, SLICES_KERNELS }; // of the pass; those of steps are the solver's

// Of all types of the family. Uniforms in the order of slices_numbers.
#define SLICES_NAMES(NAME)                                                                         \
    NAME(vorticity), NAME(buoyancy_density), NAME(buoyancy_heat), NAME(cooling_rate),              \
        NAME(dissolve_rate), NAME(friction), NAME(tolerance), NAME(max_speed), NAME(force),        \
        NAME(viscosity), NAME(reynolds), NAME(speed), NAME(left_velocity), NAME(right_velocity),   \
        NAME(bottom_velocity), NAME(top_velocity), NAME(seed), NAME(variation), NAME(advection),   \
        NAME(solver), NAME(sides), NAME(bottom), NAME(top), NAME(scalars), NAME(velocity),         \
        NAME(size), NAME(blend), NAME(scalars_now), NAME(scalars_before), NAME(velocity_now),      \
        NAME(velocity_before), NAME(now), NAME(duration), NAME(is_first), NAME(variety),           \
        NAME(Picture), NAME(kind), NAME(region), NAME(key), NAME(first), NAME(count),              \
        NAME(parity), NAME(tile), NAME(time_step), NAME(box_min), NAME(box_max), NAME(alone),      \
        NAME(hand), NAME(hand_count), NAME(Templates), NAME(TemplateMasks), NAME(TemplateImages),  \
        NAME(shape), NAME(density), NAME(temperature), NAME(dye)
enum { SLICES_NAMES(KERNEL_NAME_ID), SLICES_NAME_COUNT };
extern const char *const slices_names[SLICES_NAME_COUNT];
extern const pass_type slices_obstacle_type, slices_templates_type;

enum { SLICES_STEP, SLICES_SOURCES, SLICES_TEMPLATES, SLICES_FIELDS, SLICES_LABELS };

struct slices_flow {
    field_grid grid;                    // first: the effect has it
    field_grid *only[PASS_SLICES_MOST]; // grids of single slices that were asked for
    field_extrusion extrusion, only_extrusion[PASS_SLICES_MOST];
    pass *pass;
    pass_slices_desc desc;
    double width, cell; // of a slice, of a cell; metres
    pass_steps clock;
    bool used[PASS_FLUID_NAMES]; // by a field or a part

    pass **parts; // inflow, obstacles, forces, templates, in the order of their declaration
    size_t part_count, part_capacity;
    flow *solver; // after pass_complete

    const slices_extra *templates; // NULL: there are none
    void *templates_state;         // theirs

    const char *labels[SLICES_LABELS]; // of times
    bool fresh;                        // begins anew with the next record
    uint64_t shown_steps;              // of the grid's content
    double shown_blend;
    uint64_t last_steps; // that the last record took
    flow_report report;  // the newest
    bool reported;
    char trouble[256]; // what it says; "": nothing
};

static inline slices_flow *slices_of(const pass *p) {
    return p->state;
}

// slices_part.c: a pass that runs in the slices' own, after what its fields sample. A group of
// templates too, but all else that is to do with it is for f->templates.
void slices_add_part(slices_flow *f, pass *part);
bool slices_is_obstacle(const pass *part);
bool slices_is_template(const pass *part);
bool slices_run_parts(slices_flow *f, bool obstacles); // those alone, or the others
void slices_forget_part(pass *part);                   // what it wrote is gone

// slices_state.c
struct checkpoint;
struct checkpoint_list;
void slices_save(const pass *p, struct checkpoint_list *out);
bool slices_load(pass *p, struct checkpoint *from);

// slices_build.c
bool slices_check(pass *p);
bool slices_build(pass *p);
bool slices_allocate(pass *p);
void slices_list_memory(const pass *p, budget_list *out);
void slices_destroy(pass *p);

// slices_frame.c
bool slices_update(pass *p);
bool slices_rehearse(pass *p);
bool slices_record(pass *p);

// slices_readouts.c
extern const pass_simulation slices_simulation;

// slices_numbers.c
uint32_t slices_seed(const slices_flow *f); // of all that is random, as of the host's time
bool slices_numbers(const pass *p, flow_numbers *out); // as of the host's context

// slices_time.c
int64_t slices_left(const pass *p, double time);
int64_t slices_most(const pass *p);
double slices_reached(const pass *p);
void slices_restart(pass *p);
void slices_forget(slices_flow *f); // another state has come
bool slices_advance(pass *p);       // to the host's time, as far as one submit goes
double slices_blend(const slices_flow *f, double time);
