// The pressure of a step: conjugate gradients, preconditioned by a multigrid cycle, by a transform
// or by nothing. The host only decides how many iterations are recorded; the device decides whether
// they still do anything (flow_begin in shaders/sim/flow/solve.glsl).
#include "sim/flow_impl.h"
#include <string.h>

// ---- levels -----------------------------------------------------------------------------------

void flow_levels_find(flow *f) {
    // Seven levels are possible, of which the first six have coefficients of their own.
    const uint32_t side = f->desc.size[0] > f->desc.size[1] ? f->desc.size[0] : f->desc.size[1];
    if (f->coarse << (FLOW_MAX_LEVELS - 1) < side)
        f->coarse = (side + (1u << (FLOW_MAX_LEVELS - 1)) - 1) >> (FLOW_MAX_LEVELS - 1);
    flow_level l = {.size = {f->desc.size[0], f->desc.size[1]}};
    f->level_count = 0;
    do {
        const uint32_t cells = l.size[0] * l.size[1] * f->desc.slices;
        f->levels[f->level_count++] = l;
        l.size[0] = (l.size[0] + 1) / 2;
        l.size[1] = (l.size[1] + 1) / 2;
        l.coefficients_at += cells;
        if (f->level_count > 1) l.r_at += cells; // those of the finest lie apart
        l.z_at += cells;
    } while (f->levels[f->level_count - 1].size[0] > f->coarse ||
             f->levels[f->level_count - 1].size[1] > f->coarse || f->level_count == 1);
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

static void set_size(kernel *k, int name, const uint32_t size[2]) {
    const float cells[2] = {(float)size[0], (float)size[1]};
    kernel_set(k, name, cells, sizeof cells);
}

static bool pressure_build(flow *f, gpu *g, float unit) {
    kernel *k = flow_use(f, FLOW_BUILD);
    const bool changes = f->desc.obstacles || f->desc.templates || !f->built;
    int32_t levels[6][4] = {0};
    for (uint32_t i = 0; i + 1 < f->level_count && i < 6; i++) {
        const flow_level *l = &f->levels[i];
        const int32_t level[4] = {(int32_t)l->size[0], (int32_t)l->size[1],
                                  (int32_t)l->coefficients_at, 1};
        memcpy(levels[i], level, sizeof level);
    }
    kernel_set(k, N_level_bits, levels, sizeof levels);
    kernel_set_int(k, N_coefficients, changes);
    kernel_set_float(k, N_pressure_unit, unit);
    kernel_bind_buffer(k, N_FlowVelocity, f->buffers[FLOW_MEM_VELOCITY_NEXT]);
    kernel_bind_buffer(k, N_FlowResidual, f->buffers[FLOW_MEM_RESIDUAL]);
    uint32_t threads[2];
    for (int i = 0; i < 2; i++)
        threads[i] = (f->desc.size[i] + FLOW_BUILD_TILE - 1) / FLOW_BUILD_TILE * 16;
    f->built = true;
    return kernel_run(k, g, threads[0], threads[1], f->desc.slices);
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

static void set_level(const flow *f, kernel *k, uint32_t level) {
    const flow_level *l = &f->levels[level], *next = l + 1;
    set_size(k, N_level_cells, l->size);
    kernel_set_int(k, N_level_at, (int32_t)l->coefficients_at);
    set_size(k, N_coarse_cells, next->size);
    kernel_set_int(k, N_from_at, level == 0 ? 0 : (int32_t)l->r_at);
    kernel_set_int(k, N_to_at, (int32_t)next->r_at);
    kernel_set_int(k, N_z_at, (int32_t)l->z_at);
    kernel_set_int(k, N_coarse_z_at, (int32_t)next->z_at);
}

static bool go_down(flow *f, gpu *g, uint32_t level, uint32_t iteration, float tolerance) {
    const turn t = turn_of(f, iteration);
    gpu_buffer *coarse = f->buffers[FLOW_MEM_COARSE_RESIDUAL];
    kernel *k = flow_use(f, level == 0 ? FLOW_DOWN_FINEST : FLOW_DOWN);
    kernel_bind_buffer(k, N_FlowFrom, level == 0 ? t.from : coarse);
    kernel_bind_buffer(k, N_FlowTo, coarse);
    kernel_bind_buffer(k, N_FlowResidual, t.residual);
    kernel_bind_buffer(k, N_FlowDirection, t.last);
    set_level(f, k, level);
    kernel_set_int(k, N_iteration, (int32_t)iteration);
    kernel_set_float(k, N_tolerance, tolerance);
    return flow_run_tiles(f, g, k, f->levels[level].size);
}

static bool go_up(flow *f, gpu *g, uint32_t level, uint32_t iteration) {
    kernel *k = flow_use(f, level == 0 ? FLOW_UP_FINEST : FLOW_UP);
    gpu_buffer *coarse = f->buffers[FLOW_MEM_COARSE_RESIDUAL];
    kernel_bind_buffer(k, N_FlowFrom, level == 0 ? turn_of(f, iteration).residual : coarse);
    set_level(f, k, level);
    return flow_run_tiles(f, g, k, f->levels[level].size);
}

static bool do_coarse(flow *f, gpu *g) {
    kernel *k = flow_use(f, FLOW_COARSEST);
    const flow_level *l = &f->levels[f->level_count - 1], *fine = l - 1;
    kernel_bind_buffer(k, N_FlowFrom, f->buffers[FLOW_MEM_COARSE_RESIDUAL]);
    set_size(k, N_level_cells, l->size);
    set_size(k, N_fine_cells, fine->size);
    kernel_set_int(k, N_fine_level_at, (int32_t)fine->coefficients_at);
    kernel_set_int(k, N_from_at, (int32_t)l->r_at);
    kernel_set_int(k, N_z_at, (int32_t)l->z_at);
    return kernel_run(k, g, f->coarse_side, f->coarse_side, f->desc.slices);
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

static bool pressure_follow(flow *f, gpu *g, uint32_t iteration, float tolerance) {
    const turn t = turn_of(f, iteration);
    kernel *k = flow_use(f, FLOW_FOLLOW);
    kernel_bind_buffer(k, N_FlowFrom, t.from);
    kernel_bind_buffer(k, N_FlowResidual, t.residual);
    kernel_bind_buffer(k, N_FlowDirection, t.last);
    kernel_set_int(k, N_iteration, (int32_t)iteration);
    kernel_set_float(k, N_tolerance, tolerance);
    return flow_run_tiles(f, g, k, f->desc.size);
}

static bool pressure_iterate(flow *f, gpu *g, uint32_t iteration, float tolerance) {
    const turn t = turn_of(f, iteration);
    const flow_solver solver = f->desc.solver;
    if (!(solver == FLOW_MULTIGRID ? do_levels(f, g, iteration, tolerance)
                                   : pressure_follow(f, g, iteration, tolerance)) ||
        (solver == FLOW_TRANSFORM && !flow_transform(f, g, t.residual)))
        return false;
    kernel *k = flow_use(f, FLOW_TURN);
    kernel_bind_buffer(k, N_FlowBefore, t.last);
    kernel_bind_buffer(k, N_FlowResidual, t.residual);
    kernel_bind_buffer(k, N_FlowDirection, t.direction);
    if (solver == FLOW_CG) kernel_bind_buffer(k, N_FlowZ, t.residual);
    kernel_set_int(k, N_iteration, (int32_t)iteration);
    return flow_run_tiles(f, g, k, f->desc.size);
}

bool flow_project(flow *f, gpu *g, const flow_numbers *numbers) {
    const float tolerance = numbers->tolerance > 0 ? numbers->tolerance : 1e-3f;
    const uint32_t iterations = f->desc.max_iterations;
    if (!pressure_build(f, g, numbers->dt / numbers->cell)) return false;
    for (uint32_t i = 0; i < iterations; i++)
        if (!pressure_iterate(f, g, i, tolerance)) return false;
    kernel *k = flow_use(f, FLOW_PROJECT);
    kernel_bind_buffer(k, N_FlowDirection, turn_of(f, iterations).last);
    kernel_bind_buffer(k, N_FlowPressureTo, flow_pair(f, FLOW_MEM_PRESSURE, 1));
    kernel_bind_buffer(k, N_FlowVelocityFrom, f->buffers[FLOW_MEM_VELOCITY_NEXT]);
    kernel_bind_buffer(k, N_FlowVelocityTo, f->buffers[FLOW_MEM_VELOCITY]);
    kernel_set_int(k, N_iteration, (int32_t)iterations);
    return flow_run_tiles(f, g, k, f->desc.size);
}
