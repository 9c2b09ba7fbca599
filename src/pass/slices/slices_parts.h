// The inside of the pass type `slices`, for its own files only.
#pragma once
#include "pass/pass_impl.h"
#include "pass/slices/slices.h"
#include "pass/steps.h"
#include "sim/flow.h"

typedef struct slices_flow slices_flow;
typedef struct slices_templates slices_templates;

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

    slices_templates *templates; // NULL: there are none

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
// templates too, but what it does in a step is in slices_templates.c.
void slices_add_part(slices_flow *f, pass *part);
bool slices_is_obstacle(const pass *part);
bool slices_is_template(const pass *part);
bool slices_run_parts(slices_flow *f, bool obstacles); // those alone, or the others
void slices_forget_part(pass *part);                   // what it wrote is gone

// slices_readouts.c
extern const pass_simulation slices_simulation;

// slices_time.c
uint32_t slices_seed(const slices_flow *f); // of all that is random, as of the host's time
bool slices_numbers(const pass *p, flow_numbers *out); // as of the host's context
int64_t slices_left(const pass *p, double time);
int64_t slices_most(const pass *p);
double slices_reached(const pass *p);
void slices_restart(pass *p);
void slices_forget(slices_flow *f); // another state has come
bool slices_advance(pass *p);       // to the host's time, as far as one submit goes
double slices_blend(const slices_flow *f, double time);
