// Simulated air as a grid that fields sample: the pass types `lbm` (sim/lbm.h) and `pyro`
// (sim/pyro.h). Their uniforms and options are those of shaders/pass/air/lbm.comp and pyro.comp;
// their sources are passes of the types `lbm_source` and `pyro_source`, which they run themselves.
//
// Time: a step of the solver is a fixed part of a second. The state stands ahead of the time that
// is drawn, so that the states before and after it are mixed: what is drawn, and how often, never
// changes what is simulated. Uniforms and meshes are evaluated at the time of each step, fields of
// sources, the force and the guide at times of their own (air_turn); grids that fields sample, and
// what `update` sets, are those of the frame.
#pragma once
#include "pass/fluid.h"
#include "pass/templates.h"
#include "scene/voxels.h"

typedef struct pass_air_desc {
    uint32_t size[3];  // cells
    double voxel_size; // metres
    float3 position;   // of the middle of the lowest face, metres
    double speed;      // m/s that the air is expected to stay below
    double time_step;  // seconds; 0: by the speed
    double warm_up;    // seconds that are simulated before time 0
    double time_scale; // seconds that are simulated in one of the effect's: 1
} pass_air_desc;

// Before pass_declare; then the grid is the effect's. NULL with a message.
field_grid *pass_lbm_open(pass *p, const pass_air_desc *desc);
field_grid *pass_pyro_open(pass *p, const pass_air_desc *desc);
bool pass_air_check(const pass *p);       // after pass_declare: whether its options go together
double pass_air_time_step(const pass *p); // seconds
const pass_fluid_field *pass_air_fields(const pass *p, size_t *count);
// Before pass_complete: a field of that name is wanted. Its first channel; -1 with a message.
int pass_air_use(pass *p, const char *name, int *components);
bool pass_air_add_source(pass *p, pass *source); // declared before, of the type that goes with it
// A group of `count` templates, declared before, of the type that goes with it; the picture lives
// as long as the effect (pass/templates.h).
bool pass_air_add_templates(pass *p, pass *group, const picture *image, uint32_t count);
void pass_air_add_collider(pass *p, scene_mesh *mesh, voxels_rule rule);
