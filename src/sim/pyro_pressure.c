// The pressure of a combustion solver: V-cycles of multigrid, red-black Gauss-Seidel on each level.
#include "base/error.h"
#include "sim/pyro_impl.h"

// Sweeps on the coarsest level: as many as bring news from one end to the other twice.
static uint32_t coarsest_sweeps(const pyro_level *l) {
    uint32_t longest = l->size[0];
    for (int i = 1; i < 3; i++)
        if (l->size[i] > longest) longest = l->size[i];
    return 2 * longest + 8;
}

static float coarsest_relaxation(const pyro_level *l) {
    const float n = (float)(coarsest_sweeps(l) - 8) / 2;
    return 2 / (1 + 3.14159265f / (n + 1)); // of Young (1954), for so many cells along an axis
}

// ---- levels -----------------------------------------------------------------------------------

// Axes of an even number of cells are halved, down to 2. Where some are odd, the others go on alone
// only until what is left is few, of which one group soon makes all the sweeps.
static bool level_coarsen(const pyro_level *l, pyro_level *next) {
    bool any = false;
    const uint64_t cells = (uint64_t)l->size[0] * l->size[1] * l->size[2];
    uint32_t odd = 0;
    for (int i = 0; i < 3; i++) odd += l->size[i] % 2;
    *next = (pyro_level){.first = l->first};
    for (int i = 0; i < 3; i++) {
        const bool halves = l->size[i] % 2 == 0 && l->size[i] > 2;
        next->size[i] = halves ? l->size[i] / 2 : l->size[i];
        next->weights[i] = halves ? l->weights[i] / 4 : l->weights[i];
        any |= halves;
    }
    return any && !(odd > 0 && cells <= PYRO_FEW);
}

bool pyro_find_levels(pyro *p) {
    pyro_level *l = p->levels;
    uint32_t first = 0;
    *l = (pyro_level){.weights = {1, 1, 1}};
    pyro_flow_size(&p->desc, l->size);
    p->level_count = 1;
    for (pyro_level next; p->level_count < PYRO_MAX_LEVELS && level_coarsen(l, &next); l++) {
        for (int i = 0; i < 3; i++) l->coarser[i] = l->size[i] / next.size[i];
        next.first = first;
        first += next.size[0] * next.size[1] * next.size[2];
        p->levels[p->level_count++] = next;
    }
    const uint64_t cells = (uint64_t)l->size[0] * l->size[1] * l->size[2];
    return cells <= PYRO_COARSEST ||
           err_set(
               "a box of %u x %u x %u cells cannot be halved often enough; take multiples of 16 "
               "or 32",
               p->desc.size[0], p->desc.size[1], p->desc.size[2]);
}

uint64_t pyro_coarse_cells(const pyro *p) {
    const pyro_level *last = &p->levels[p->level_count - 1];
    return last->first + (uint64_t)last->size[0] * last->size[1] * last->size[2];
}

static void set_size(kernel *k, int name, const uint32_t size[3]) {
    const float value[3] = {(float)size[0], (float)size[1], (float)size[2]};
    kernel_set(k, name, value, sizeof value);
}

static void pyro_set_level(const pyro *p, kernel *k, uint32_t level) {
    const pyro_level *l = &p->levels[level];
    kernel_set(k, N_weights, l->weights, sizeof l->weights);
    set_size(k, N_level_size, l->size);
    kernel_set_int(k, N_level_first, (int32_t)l->first);
    if (level + 1 == p->level_count) return;
    set_size(k, N_coarse_size, l[1].size);
    set_size(k, N_coarser, l->coarser);
    kernel_set_int(k, N_coarse_first, (int32_t)l[1].first);
}

// ---- coefficients of faces ------------------------------------------------------------------

bool pyro_find_coefficients(pyro *p, gpu *g, const pyro_numbers *n) {
    if (p->desc.solids && !p->solids.ids) return err_set("solids are wanted, and none were given");
    pyro_stage(p, g, "pyro.coefficients");
    kernel *k = pyro_use(p, PYRO_K_COEFFICIENTS);
    pyro_set_gas(k, n);
    if (p->desc.solids) kernel_bind_buffer(k, N_SolidIds, p->solids.ids);
    if (!pyro_run(p, g, k)) return false;
    for (uint32_t level = 0; level + 1 < p->level_count; level++) {
        const uint32_t *size = p->levels[level + 1].size;
        k = pyro_use(p, level == 0 ? PYRO_K_COEFFICIENTS_NEXT : PYRO_K_COEFFICIENTS_COARSE);
        pyro_set_level(p, k, level);
        if (level > 0)
            kernel_bind_buffer(k, N_PyroCoefficients, p->buffers[PYRO_MEM_COARSE_COEFFICIENTS]);
        if (!kernel_run(k, g, size[0], size[1], size[2])) return false;
    }
    return p->coefficients_known = true;
}

// ---- a cycle ----------------------------------------------------------------------------------

// A kernel of a level: the finest has its own, whose pressure lies in bricks.
static kernel *use_level(pyro *p, pyro_kernel finest, pyro_kernel coarse, uint32_t level) {
    kernel *k = pyro_use(p, level == 0 ? finest : coarse);
    pyro_set_level(p, k, level);
    if (level == 0 && pyro_is_weighed(p)) // a step of conjugate gradients
        kernel_bind_buffer(k, N_PyroPressure, p->buffers[PYRO_MEM_FOUND]);
    if (level > 0) {
        kernel_bind_buffer(k, N_PyroPressure, p->buffers[PYRO_MEM_COARSE_PRESSURE]);
        kernel_bind_buffer(k, N_PyroRight, p->buffers[PYRO_MEM_COARSE_RIGHT]);
        if (pyro_is_weighed(p))
            kernel_bind_buffer(k, N_PyroCoefficients, p->buffers[PYRO_MEM_COARSE_COEFFICIENTS]);
    }
    return k;
}

// A level that the next one has halved along some axes only is smoothed twice: errors along the
// others are as fine there.
static int level_sweeps(const pyro_level *l) {
    return l->coarser[0] * l->coarser[1] * l->coarser[2] < 8 ? 2 : 1;
}

static bool pressure_smooth(pyro *p, gpu *g, uint32_t level) {
    pyro_stage(p, g, level == 0 ? "pyro.smooth" : "pyro.coarse");
    const uint32_t *size = p->levels[level].size;
    const int halves = 2 * level_sweeps(&p->levels[level]);
    for (int half = 0; half < halves; half++) {
        kernel *k = use_level(p, PYRO_K_SMOOTH_FINEST, PYRO_K_SMOOTH, level);
        kernel_set_int(k, N_colour, half % 2);
        if (!kernel_run(k, g, (size[0] + 1) / 2, size[1], size[2])) return false;
    }
    return true;
}

static bool pressure_restrict(pyro *p, gpu *g, uint32_t level) {
    const uint32_t *size = p->levels[level + 1].size;
    if (level == 0) pyro_stage(p, g, "pyro.restrict");
    kernel *k = use_level(p, PYRO_K_RESTRICT_FINEST, PYRO_K_RESTRICT, level);
    return kernel_run(k, g, size[0], size[1], size[2]);
}

static bool pressure_prolong(pyro *p, gpu *g, uint32_t level) {
    const uint32_t *size = p->levels[level].size;
    if (level == 0) pyro_stage(p, g, "pyro.prolong");
    kernel *k = use_level(p, PYRO_K_PROLONG_FINEST, PYRO_K_PROLONG, level);
    return kernel_run(k, g, (size[0] + 1) / 2, size[1], size[2]);
}

static bool pressure_end(pyro *p, gpu *g) {
    const uint32_t last = p->level_count - 1;
    kernel *k = pyro_use(p, PYRO_K_COARSEST);
    pyro_set_level(p, k, last);
    if (pyro_is_weighed(p))
        kernel_bind_buffer(k, N_PyroCoefficients, p->buffers[PYRO_MEM_COARSE_COEFFICIENTS]);
    kernel_set_int(k, N_sweeps, (int32_t)coarsest_sweeps(&p->levels[last]));
    kernel_set_float(k, N_relaxation, coarsest_relaxation(&p->levels[last]));
    return kernel_run(k, g, k->binaries[0].local_size[0], 1, 1);
}

static bool pressure_cycle(pyro *p, gpu *g) {
    const uint32_t last = p->level_count - 1;
    for (uint32_t i = 0; i < last; i++)
        if (!pressure_smooth(p, g, i) || !pressure_restrict(p, g, i)) return false;
    if (!pressure_end(p, g)) return false;
    for (uint32_t i = last; i-- > 0;)
        if (!pressure_prolong(p, g, i) || !pressure_smooth(p, g, i)) return false;
    return true;
}

// Adds up what the groups of a kernel have written to PyroReport.
static bool sum_up(pyro *p, gpu *g, int place) {
    kernel *k = pyro_use(p, PYRO_K_SUM);
    kernel_set_int(k, N_groups, (int32_t)(pyro_flow_cells(p) / PYRO_CELLS_A_GROUP));
    kernel_set_int(k, N_place, place);
    return kernel_run(k, g, PYRO_CELLS_A_GROUP, 1, 1);
}

// ---- conjugate gradients ----------------------------------------------------------------------

// Runs one of their parts, and sums what its groups have summed.
static bool conjugate_run(pyro *p, gpu *g, pyro_kernel part, bool begins) {
    enum { NONE = -1 };
    const int places[PYRO_KERNELS] = {[PYRO_K_RESIDUAL] = pyro_is_closed(&p->desc) ? 0 : NONE,
                                      [PYRO_K_ACROSS] = 1,
                                      [PYRO_K_TURN] = NONE,
                                      [PYRO_K_APPLY] = 2,
                                      [PYRO_K_MOVE] = NONE};
    const float weights[3] = {1, 1, 1};
    pyro_stage(p, g, "pyro.conjugate");
    kernel *k = pyro_use(p, part);
    kernel_set(k, N_weights, weights, sizeof weights);
    kernel_set_int(k, N_begins, begins);
    if (!pyro_run(p, g, k)) return false;
    return places[part] == NONE || sum_up(p, g, places[part]);
}

static bool conjugate_step(pyro *p, gpu *g, bool begins) {
    return pressure_cycle(p, g) && (begins || conjugate_run(p, g, PYRO_K_ACROSS, false)) &&
           conjugate_run(p, g, PYRO_K_TURN, begins) && conjugate_run(p, g, PYRO_K_APPLY, false) &&
           conjugate_run(p, g, PYRO_K_MOVE, false);
}

// Finds the pressure of the next velocity. `draws`: air that is drawn in through open faces is held
// back by its own pressure.
static bool pressure_find(pyro *p, gpu *g, const pyro_numbers *n, bool draws) {
    pyro_stage(p, g, "pyro.divergence");
    kernel *divergence = pyro_use(p, PYRO_K_DIVERGENCE);
    kernel_set(divergence, N_inflow, n->inflow, sizeof n->inflow);
    kernel_set_float(divergence, N_reach, draws ? n->dt / pyro_flow_cell(p, n) : 0);
    if (!pyro_run(p, g, divergence)) return false;
    if (pyro_is_weighed(p) && !conjugate_run(p, g, PYRO_K_RESIDUAL, false)) return false;
    for (uint32_t i = 0; i < p->desc.cycles; i++)
        if (!(pyro_is_weighed(p) ? conjugate_step(p, g, i == 0) : pressure_cycle(p, g)))
            return false;
    pyro_stage(p, g, "pyro.project");
    return true;
}

bool pyro_project(pyro *p, gpu *g, const pyro_numbers *n) {
    return pressure_find(p, g, n, true) && pyro_run(p, g, pyro_use(p, PYRO_K_PROJECT));
}

bool pyro_project_half(pyro *p, gpu *g, const pyro_numbers *n) {
    if (!pressure_find(p, g, n, true)) return false;
    kernel *k = pyro_use(p, PYRO_K_REFLECT);
    kernel_bind_buffer(k, N_PyroFlowInto, pyro_pair(p, PYRO_MEM_VELOCITY, 0));
    kernel_bind_buffer(k, N_PyroOtherPressure, p->buffers[PYRO_MEM_MORE_PRESSURE]);
    return pyro_run(p, g, k);
}

bool pyro_project_again(pyro *p, gpu *g, const pyro_numbers *n) {
    p->finds_more = true;
    bool done = pressure_find(p, g, n, false);
    kernel *k = pyro_use(p, PYRO_K_PROJECT);
    p->finds_more = false;
    kernel_bind_buffer(k, N_PyroOtherPressure, p->buffers[PYRO_MEM_PRESSURE]);
    return done && pyro_run(p, g, k);
}
