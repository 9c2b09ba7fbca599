// The pass type `slices`: a few planes of simulated flow (sim/flow.h) round an axis, as a grid that
// fields sample (field/extrude.h). Its uniforms and options are those of
// shaders/pass/slices/slices.comp. What gives it dye, stands in its way or pushes it are passes of
// the types `slices_inflow`, `slices_obstacle` and `slices_force`, which it runs itself before each
// step.
//
// Places in a slice, as fields of those passes are given them: x from 0 at its left edge to 1 at
// its right, y from 0 at its lower edge on in the same unit, the slice's width, so that what is
// round stays round; 1/2 is the axis. z is 0.
//
// Time: a step is a fixed part of a second (pass/steps.h); uniforms and fields are those of the
// step's own time. What is seen at a time is what the step that begins then has made.
#pragma once
#include "pass/fluid.h"
#include "pass/pass.h"

struct picture; // media/picture.h

enum { PASS_SLICES_MOST = 32, PASS_SLICES_LEAST_CELLS = 16, PASS_SLICES_MOST_CELLS = 2048 };

typedef struct pass_slices_desc {
    uint32_t count;          // slices, up to PASS_SLICES_MOST
    uint32_t size[2];        // cells of each, PASS_SLICES_LEAST_CELLS to PASS_SLICES_MOST_CELLS
    double height;           // metres
    float3 position;         // of the middle of the lower edge, metres
    float3 axis;             // that slices stand round; of any length but 0
    double time_step;        // seconds
    double warm_up;          // seconds that are simulated before time 0
    uint32_t max_iterations; // of the pressure, each step; 0: what suits
} pass_slices_desc;

// Before pass_declare; then the grid is the effect's. NULL with a message.
field_grid *pass_slices_open(pass *p, const pass_slices_desc *desc);
// The grid of one slice, 0 to count - 1, whose plane goes on along its normal; it is the pass's.
const field_grid *pass_slices_only(pass *p, uint32_t slice);
// Before pass_complete: a field of that name is wanted. Its first channel; -1 with a message.
int pass_slices_use(pass *p, const char *name, int *components);
// A pass of the types above, declared before. `painted`: of an obstacle, what is dark in it is
// solid; it lives as long as the pass. NULL: there is none.
bool pass_slices_add(pass *p, pass *part, const struct picture *painted);

// ---- for tools, between frames ----------------------------------------------------------------
// What is put into the flow by hand and taken out of it: pass/slices/slices_templates.h.

const pass_slices_desc *pass_slices_get_desc(const pass *p);
const char *pass_slices_variable(const pass *p); // of the script
// The state after the last kept step, of the field of that index in pass_fluid_fields: an image of
// (x, y, slice) and the channel where it lies, of a velocity the first of two. NULL with a message:
// nothing has flowed yet.
gpu_image *pass_slices_look(const pass *p, int index, int *channel);
// The greatest size of such a field in a slice. Waits for the device.
bool pass_slices_greatest(const pass *p, int index, uint32_t slice, float *out);
