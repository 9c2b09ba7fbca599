// The pressure of a step: conjugate gradients, preconditioned by a cycle of multigrid, by a
// transform or by nothing. All that the host decides is how many iterations are recorded; whether
// they still do anything is decided on the device (flow_begin in shaders/sim/flow/solve.glsl).
#include "sim/flow_impl.h"
#include <string.h>

// ---- levels -----------------------------------------------------------------------------------

void flow_levels_find(flow *f) {
    flow_level l = {.size = {f->desc.size[0], f->desc.size[1]}};
    do {
        const uint32_t cells = l.size[0] * l.size[1] * f->desc.slices;
        f->levels[f->level_count++] = l;
        l.size[0] = (l.size[0] + 1) / 2;
        l.size[1] = (l.size[1] + 1) / 2;
        l.coefficients_at += cells;
        if (f->level_count > 1) l.r_at += cells; // those of the finest lie apart
        l.z_at += cells;
    } while (f->levels[f->level_count - 1].size[0] > FLOW_COARSE ||
             f->levels[f->level_count - 1].size[1] > FLOW_COARSE || f->level_count == 1);
}

void flow_choose_iterations(flow *f) {
    flow_desc *d = &f->desc;
    const uint32_t side = d->size[0] > d->size[1] ? d->size[0] : d->size[1];
    if (d->solver == FLOW_CG)
        d->max_iterations = FLOW_CG_ITERATIONS * side;
    else if (d->solver == FLOW_TRANSFORM)
        d->max_iterations = d->obstacles || d->templates ? FLOW_TRANSFORM_ITERATIONS_AROUND
                                                         : FLOW_TRANSFORM_ITERATIONS;
    else
        d->max_iterations = d->sweeps == 2 ? FLOW_ITERATIONS_OF_TWO : FLOW_ITERATIONS;
    if (d->solver == FLOW_MULTIGRID && d->obstacles) d->max_iterations += FLOW_OBSTACLE_ITERATIONS;
}

// ---- dispatches -------------------------------------------------------------------------------

static void set_int(sim_kernel *k, const char *name, uint32_t value) {
    sim_kernel_set(k, name, &value, sizeof value);
}

static void set_float(sim_kernel *k, const char *name, float value) {
    sim_kernel_set(k, name, &value, sizeof value);
}

static void set_size(sim_kernel *k, const char *name, const uint32_t size[2]) {
    const float cells[2] = {(float)size[0], (float)size[1]};
    sim_kernel_set(k, name, cells, sizeof cells);
}

static bool build(flow *f, gpu *g, float unit) {
    sim_kernel *k = &f->kernels.build;
    const bool changes = f->desc.obstacles || f->desc.templates || !f->built;
    int32_t levels[6][4] = {0};
    for (uint32_t i = 0; i + 1 < f->level_count && i < 6; i++) {
        const flow_level *l = &f->levels[i];
        const int32_t level[4] = {(int32_t)l->size[0], (int32_t)l->size[1],
                                  (int32_t)l->coefficients_at, 1};
        memcpy(levels[i], level, sizeof level);
    }
    sim_kernel_set(k, "level_bits", levels, sizeof levels);
    set_int(k, "coefficients", changes);
    set_float(k, "pressure_unit", unit);
    const sim_slot more[] = {{"FlowVelocity", f->buffers[FLOW_MEM_VELOCITY_NEXT], NULL},
                             {"FlowResidual", f->buffers[FLOW_MEM_RESIDUAL], NULL}};
    flow_call call = {k, more, 2, {1, 1, f->desc.slices}};
    for (int i = 0; i < 2; i++)
        call.threads[i] = (f->desc.size[i] + FLOW_BUILD_TILE - 1) / FLOW_BUILD_TILE * 16;
    f->built = true;
    return flow_run(f, g, &call);
}

// ---- one iteration ----------------------------------------------------------------------------

typedef struct turn { // buffers of an iteration
    gpu_buffer *from, *residual, *last, *direction;
} turn;

static turn turn_of(const flow *f, uint32_t iteration) {
    gpu_buffer *const *r = &f->buffers[FLOW_MEM_RESIDUAL], *const *p =
                                                               &f->buffers[FLOW_MEM_DIRECTION];
    const uint32_t even = iteration % 2, odd = 1 - even;
    return (turn){r[even], r[odd], p[odd], p[even]};
}

static void set_level(const flow *f, sim_kernel *k, uint32_t level) {
    const flow_level *l = &f->levels[level], *next = l + 1;
    set_size(k, "level_cells", l->size);
    set_int(k, "level_at", l->coefficients_at);
    set_size(k, "coarse_cells", next->size);
    set_int(k, "from_at", level == 0 ? 0 : l->r_at);
    set_int(k, "to_at", next->r_at);
    set_int(k, "z_at", l->z_at);
    set_int(k, "coarse_z_at", next->z_at);
}

static bool go_down(flow *f, gpu *g, uint32_t level, uint32_t iteration, float tolerance) {
    const turn t = turn_of(f, iteration);
    gpu_buffer *coarse = f->buffers[FLOW_MEM_COARSE_RESIDUAL];
    sim_kernel *k = level == 0 ? &f->kernels.down_finest : &f->kernels.down;
    const sim_slot more[] = {{"FlowFrom", level == 0 ? t.from : coarse, NULL},
                             {"FlowTo", coarse, NULL},
                             {"FlowResidual", t.residual, NULL},
                             {"FlowDirection", t.last, NULL}};
    set_level(f, k, level);
    set_int(k, "iteration", iteration);
    set_float(k, "tolerance", tolerance);
    return flow_run_tiles(f, g, k, more, 4, f->levels[level].size);
}

static bool go_up(flow *f, gpu *g, uint32_t level, uint32_t iteration) {
    sim_kernel *k = level == 0 ? &f->kernels.up_finest : &f->kernels.up;
    gpu_buffer *coarse = f->buffers[FLOW_MEM_COARSE_RESIDUAL];
    const sim_slot more[] = {
        {"FlowFrom", level == 0 ? turn_of(f, iteration).residual : coarse, NULL}};
    set_level(f, k, level);
    return flow_run_tiles(f, g, k, more, 1, f->levels[level].size);
}

static bool do_coarse(flow *f, gpu *g) {
    sim_kernel *k = &f->kernels.coarse;
    const flow_level *l = &f->levels[f->level_count - 1], *fine = l - 1;
    const sim_slot more[] = {{"FlowFrom", f->buffers[FLOW_MEM_COARSE_RESIDUAL], NULL}};
    set_size(k, "level_cells", l->size);
    set_size(k, "fine_cells", fine->size);
    set_int(k, "fine_level_at", fine->coefficients_at);
    set_int(k, "from_at", l->r_at);
    set_int(k, "z_at", l->z_at);
    return flow_run(f, g,
                    &(flow_call){k, more, 1, {f->coarse_side, f->coarse_side, f->desc.slices}});
}

// The residual of the last direction, and what multigrid makes of it.
static bool do_levels(flow *f, gpu *g, uint32_t iteration, float tolerance) {
    const uint32_t last = f->level_count - 1;
    for (uint32_t i = 0; i < last; i++)
        if (!go_down(f, g, i, iteration, tolerance)) return false;
    if (!do_coarse(f, g)) return false;
    for (uint32_t i = last; i > 0; i--)
        if (!go_up(f, g, i - 1, iteration)) return false;
    return true;
}

static bool follow(flow *f, gpu *g, uint32_t iteration, float tolerance) {
    const turn t = turn_of(f, iteration);
    const sim_slot more[] = {{"FlowFrom", t.from, NULL},
                             {"FlowResidual", t.residual, NULL},
                             {"FlowDirection", t.last, NULL}};
    set_int(&f->kernels.follow, "iteration", iteration);
    set_float(&f->kernels.follow, "tolerance", tolerance);
    return flow_run_tiles(f, g, &f->kernels.follow, more, 3, f->desc.size);
}

static bool iterate(flow *f, gpu *g, uint32_t iteration, float tolerance) {
    const turn t = turn_of(f, iteration);
    sim_kernel *k = &f->kernels.direction;
    const flow_solver solver = f->desc.solver;
    const sim_slot more[] = {
        {"FlowBefore", t.last, NULL},
        {"FlowResidual", t.residual, NULL},
        {"FlowDirection", t.direction, NULL},
        {"FlowZ", solver == FLOW_CG ? t.residual : f->buffers[FLOW_MEM_Z], NULL}};
    if (!(solver == FLOW_MULTIGRID ? do_levels(f, g, iteration, tolerance)
                                   : follow(f, g, iteration, tolerance)) ||
        (solver == FLOW_TRANSFORM && !flow_transform(f, g, t.residual)))
        return false;
    set_int(k, "iteration", iteration);
    return flow_run_tiles(f, g, k, more, 4, f->desc.size);
}

bool flow_project(flow *f, gpu *g, const flow_numbers *numbers) {
    const float tolerance = numbers->tolerance > 0 ? numbers->tolerance : 1e-3f;
    const uint32_t iterations = f->desc.max_iterations;
    if (!build(f, g, numbers->dt / numbers->cell)) return false;
    for (uint32_t i = 0; i < iterations; i++)
        if (!iterate(f, g, i, tolerance)) return false;
    const turn t = turn_of(f, iterations);
    const sim_slot more[] = {{"FlowDirection", t.last, NULL},
                             {"FlowPressureTo", flow_pair(f, FLOW_MEM_PRESSURE, 1), NULL},
                             {"FlowVelocityFrom", f->buffers[FLOW_MEM_VELOCITY_NEXT], NULL},
                             {"FlowVelocityTo", f->buffers[FLOW_MEM_VELOCITY], NULL}};
    set_int(&f->kernels.project, "iteration", iterations);
    return flow_run_tiles(f, g, &f->kernels.project, more, 4, f->desc.size);
}
