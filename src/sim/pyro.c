// A combustion solver: the defines of its shaders, and its state on the device.
#include "sim/pyro.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/swap.h"
#include "sim/pyro_impl.h"
#include <string.h>

// ---- structure --------------------------------------------------------------------------------

const char *const pyro_advection_names[PYRO_ADVECTIONS] = {"upwind", "parabolic", "reflection"};

static bool pyro_check(const pyro_desc *desc) {
    for (int i = 0; i < 3; i++) {
        const uint32_t n = desc->size[i];
        if (n < PYRO_LEAST_SIZE || n > PYRO_MOST_SIZE || n % PYRO_BRICK != 0)
            return err_set(
                "a box of %u x %u x %u cells; multiples of %d from %d to %d are accepted",
                desc->size[0], desc->size[1], desc->size[2], PYRO_BRICK, PYRO_LEAST_SIZE,
                PYRO_MOST_SIZE);
        if (desc->half_velocity && n % (2 * PYRO_BRICK) != 0)
            return err_set("a box of %u x %u x %u cells; multiples of %d are accepted where the "
                           "velocity has half as many",
                           desc->size[0], desc->size[1], desc->size[2], 2 * PYRO_BRICK);
        if (desc->half_velocity && desc->faces[2 * i] == PYRO_PERIODIC)
            return err_set("faces along %c are periodic; not where the velocity has half as many "
                           "cells",
                           "xyz"[i]);
        if ((desc->faces[2 * i] == PYRO_PERIODIC) != (desc->faces[2 * i + 1] == PYRO_PERIODIC))
            return err_set("one face along %c is periodic and the other is not", "xyz"[i]);
    }
    return true;
}

pyro *pyro_create(arena *memory, const pyro_desc *desc) {
    if (!pyro_check(desc)) return NULL;
    pyro *p = arena_alloc(memory, sizeof *p);
    *p = (pyro){.memory = memory, .desc = *desc};
    p->chooses_precision = desc->precision == PYRO_AUTO;
    if (p->desc.cycles == 0)
        p->desc.cycles = pyro_is_weighed(p) ? PYRO_CONJUGATE_CYCLES : PYRO_CYCLES;
    return pyro_find_levels(p) ? p : NULL;
}

const pyro_desc *pyro_get_desc(const pyro *p) {
    return &p->desc;
}

uint64_t pyro_cells(const pyro *p) {
    return (uint64_t)p->desc.size[0] * p->desc.size[1] * p->desc.size[2];
}

uint32_t pyro_ratio(const pyro_desc *desc) {
    return desc->half_velocity ? 2 : 1;
}

void pyro_flow_size(const pyro_desc *desc, uint32_t out[3]) {
    for (int i = 0; i < 3; i++) out[i] = desc->size[i] / pyro_ratio(desc);
}

uint64_t pyro_flow_cells(const pyro *p) {
    uint32_t n[3];
    pyro_flow_size(&p->desc, n);
    return (uint64_t)n[0] * n[1] * n[2];
}

float pyro_flow_cell(const pyro *p, const pyro_numbers *n) {
    return n->cell * (float)pyro_ratio(&p->desc);
}

// ---- shaders ----------------------------------------------------------------------------------

static void define(pyro *p, const char *name, uint32_t value) {
    p->defines[p->define_count++] = (shader_define){name, arena_format(p->memory, "%u", value)};
}

bool pyro_is_weighed(const pyro *p) {
    return p->desc.solids || p->desc.variable_density;
}

bool pyro_is_closed(const pyro_desc *desc) {
    for (int i = 0; i < 6; i++)
        if (desc->faces[i] == PYRO_OPEN) return false;
    return true;
}

static void define_all(pyro *p) {
    static const char *const sizes[3] = {"PYRO_GAS_NX", "PYRO_GAS_NY", "PYRO_GAS_NZ"};
    static const char *const faces[6] = {"PYRO_LOW_X",  "PYRO_HIGH_X", "PYRO_LOW_Y",
                                         "PYRO_HIGH_Y", "PYRO_LOW_Z",  "PYRO_HIGH_Z"};
    p->define_count = 0;
    for (int i = 0; i < 3; i++) define(p, sizes[i], p->desc.size[i]);
    for (int i = 0; i < 6; i++) define(p, faces[i], p->desc.faces[i]);
    define(p, "PYRO_RATIO", pyro_ratio(&p->desc));
    define(p, "PYRO_HALF", p->desc.precision == PYRO_F16);
    define(p, "PYRO_WIDE", p->wide);
    define(p, "PYRO_SIDE_BY_SIDE", p->side_by_side);
    define(p, "PYRO_PARABOLIC", p->desc.advection != PYRO_UPWIND);
    define(p, "PYRO_REFLECTS", p->desc.advection == PYRO_REFLECTION);
    define(p, "PYRO_SMOKE", p->desc.smoke);
    define(p, "PYRO_PREMIXED", p->desc.premixed);
    define(p, "PYRO_CONFINES", p->desc.confinement);
    define(p, "PYRO_TURBULENT", p->desc.turbulence);
    define(p, "PYRO_FORCE", p->desc.force);
    define(p, "PYRO_GUIDED", p->desc.guide);
    define(p, "PYRO_OUTFLOW", p->desc.outflow);
    define(p, "PYRO_SOLIDS", p->desc.solids);
    define(p, "PYRO_VARIABLE", p->desc.variable_density);
    define(p, "PYRO_WEIGHED", pyro_is_weighed(p));
    define(p, "PYRO_CLOSED", pyro_is_closed(&p->desc));
    const uint32_t *coarsest = p->levels[p->level_count - 1].size;
    define(p, "PYRO_COARSEST_CELLS", coarsest[0] * coarsest[1] * coarsest[2]);
}

size_t pyro_defines(const pyro *p, shader_define out[PYRO_MAX_DEFINES]) {
    memcpy(out, p->defines, p->define_count * sizeof *out);
    return p->define_count;
}

static const char *const names[] = {PYRO_NAMES(KERNEL_NAME_TEXT)};

static const char *const shaders[PYRO_KERNELS] = {
    [PYRO_K_RESET] = "sim/pyro/reset.comp",
    [PYRO_K_RESET_FLOW] = "sim/pyro/reset.comp",
    [PYRO_K_SPREAD] = "sim/pyro/spread.comp",
    [PYRO_K_CARRIER] = "sim/pyro/carrier.comp",
    [PYRO_K_CARRY_X] = "sim/pyro/carry.comp",
    [PYRO_K_CARRY_Y] = "sim/pyro/carry.comp",
    [PYRO_K_GAS] = "sim/pyro/gas.comp",
    [PYRO_K_VORTICITY] = "sim/pyro/curl.comp",
    [PYRO_K_CURL] = "sim/pyro/curl.comp",
    [PYRO_K_TURBULENCE] = "sim/pyro/turbulence.comp",
    [PYRO_K_GUIDE] = "sim/pyro/guide.comp",
    [PYRO_K_VELOCITY_X] = "sim/pyro/velocity.comp",
    [PYRO_K_VELOCITY_Y] = "sim/pyro/velocity.comp",
    [PYRO_K_VELOCITY] = "sim/pyro/velocity.comp",
    [PYRO_K_COEFFICIENTS] = "sim/pyro/coefficients.comp",
    [PYRO_K_COEFFICIENTS_NEXT] = "sim/pyro/coefficients.comp",
    [PYRO_K_COEFFICIENTS_COARSE] = "sim/pyro/coefficients.comp",
    [PYRO_K_OBSTRUCT] = "sim/pyro/obstruct.comp",
    [PYRO_K_FILL] = "sim/pyro/fill.comp",
    [PYRO_K_DIVERGENCE] = "sim/pyro/divergence.comp",
    [PYRO_K_SMOOTH_FINEST] = "sim/pyro/smooth.comp",
    [PYRO_K_SMOOTH] = "sim/pyro/smooth.comp",
    [PYRO_K_RESTRICT_FINEST] = "sim/pyro/restrict.comp",
    [PYRO_K_RESTRICT] = "sim/pyro/restrict.comp",
    [PYRO_K_COARSEST] = "sim/pyro/coarsest.comp",
    [PYRO_K_PROLONG] = "sim/pyro/prolong.comp",
    [PYRO_K_PROLONG_FINEST] = "sim/pyro/prolong.comp",
    [PYRO_K_RESIDUAL] = "sim/pyro/conjugate.comp",
    [PYRO_K_ACROSS] = "sim/pyro/conjugate.comp",
    [PYRO_K_TURN] = "sim/pyro/conjugate.comp",
    [PYRO_K_APPLY] = "sim/pyro/conjugate.comp",
    [PYRO_K_MOVE] = "sim/pyro/conjugate.comp",
    [PYRO_K_SUM] = "sim/pyro/sum.comp",
    [PYRO_K_PROJECT] = "sim/pyro/project.comp",
    [PYRO_K_REFLECT] = "sim/pyro/project.comp",
    [PYRO_K_LOOK] = "sim/pyro/look.comp",
    [PYRO_K_LOOK_FLOW] = "sim/pyro/look.comp",
    [PYRO_K_REPORT] = "sim/pyro/report.comp",
    [PYRO_K_REPORT_FLOW] = "sim/pyro/report.comp",
    [PYRO_K_REPORT_LAST] = "sim/pyro/report.comp",
};

const kernel_table pyro_kernel_table = {{names, COUNT_OF(names)}, shaders, COUNT_OF(shaders)};

// The additional defines of a kernel; NULL: none.
static const char *const more_defines[PYRO_KERNELS][2] = {
    [PYRO_K_RESET_FLOW] = {"FLOW"},
    [PYRO_K_CARRY_Y] = {"CARRY_Y"},
    [PYRO_K_CURL] = {"PYRO_CURL_LAST"},
    [PYRO_K_VELOCITY_X] = {"CARRY_X"},
    [PYRO_K_VELOCITY_Y] = {"CARRY_Y"},
    [PYRO_K_SMOOTH_FINEST] = {"PYRO_FINEST"},
    [PYRO_K_RESTRICT_FINEST] = {"PYRO_FINEST"},
    [PYRO_K_PROLONG_FINEST] = {"PYRO_FINEST"},
    [PYRO_K_REFLECT] = {"REFLECT"},
    [PYRO_K_LOOK_FLOW] = {"FLOW"},
    [PYRO_K_REPORT_FLOW] = {"FLOW"},
    [PYRO_K_REPORT_LAST] = {"LAST"},
    [PYRO_K_RESIDUAL] = {"RESIDUAL"},
    [PYRO_K_ACROSS] = {"ACROSS"},
    [PYRO_K_TURN] = {"TURN"},
    [PYRO_K_APPLY] = {"APPLY"},
    [PYRO_K_MOVE] = {"MOVE"},
    [PYRO_K_COEFFICIENTS_NEXT] = {"COARSE", "PYRO_FINEST"},
    [PYRO_K_COEFFICIENTS_COARSE] = {"COARSE"},
};

static bool is_used(const pyro_desc *desc, pyro_kernel which) {
    if (which == PYRO_K_CARRIER) return desc->half_velocity;
    if (which == PYRO_K_VORTICITY || which == PYRO_K_CURL) return desc->confinement;
    if (which == PYRO_K_TURBULENCE) return desc->turbulence;
    if (which == PYRO_K_GUIDE) return desc->guide;
    if (which == PYRO_K_REFLECT) return desc->advection == PYRO_REFLECTION;
    if (which == PYRO_K_OBSTRUCT || which == PYRO_K_FILL) return desc->solids;
    const bool weighed = desc->solids || desc->variable_density;
    if (which >= PYRO_K_COEFFICIENTS && which <= PYRO_K_COEFFICIENTS_COARSE) return weighed;
    if (which >= PYRO_K_RESIDUAL && which <= PYRO_K_SUM) return weighed;
    return true;
}

bool pyro_build(pyro *p, gpu *g, shader_library *library, const shader_reader *reader) {
    const gpu_profile *device = gpu_get_profile(g);
    if (p->chooses_precision) p->desc.precision = device->pyro_half ? PYRO_F16 : PYRO_F32;
    p->side_by_side = device->pyro_side_by_side;
    p->wide = device->pyro_wide_words && p->desc.precision == PYRO_F32;
    define_all(p);
    for (int i = 0; i < PYRO_KERNELS; i++) {
        shader_define defines[PYRO_MAX_DEFINES + 2];
        size_t count = pyro_defines(p, defines);
        if (!is_used(&p->desc, (pyro_kernel)i)) continue;
        for (int k = 0; k < 2; k++)
            if (more_defines[i][k]) defines[count++] = (shader_define){more_defines[i][k], "1"};
        const shader_compile_desc shader = {
            .name = shaders[i], .defines = defines, .define_count = count, .reader = reader};
        if (!kernel_compile_compute(&p->kernels[i], library, p->memory, &shader,
                                    pyro_kernel_table.names) ||
            (g && !kernel_build(&p->kernels[i], g)))
            return false;
    }
    return true;
}

// ---- state ------------------------------------------------------------------------------------

// Returns the bytes of each buffer; 0: it is not needed.
static void find_sizes(const pyro *p, uint64_t out[PYRO_MEM_COUNT]) {
    const uint64_t gas = pyro_cells(p), flow = pyro_flow_cells(p);
    const uint64_t four = p->desc.precision == PYRO_F16 ? 8 : 16;
    memset(out, 0, PYRO_MEM_COUNT * sizeof *out);
    for (int i = 0; i < 2; i++) {
        out[PYRO_MEM_VELOCITY + i] = four * flow;
        out[PYRO_MEM_GAS + i] = four * gas;
    }
    out[PYRO_MEM_ACTIVE] = gas / PYRO_CELLS_A_GROUP * 2 * sizeof(uint32_t);
    out[PYRO_MEM_VELOCITY_BETWEEN] = four * flow;
    out[PYRO_MEM_GAS_BETWEEN] = four * gas;
    for (int i = PYRO_MEM_SMOKE; i <= PYRO_MEM_SMOKE_BETWEEN && p->desc.smoke; i++)
        out[i] = 4 * gas;
    if (p->desc.half_velocity) out[PYRO_MEM_CARRIER] = four * gas;
    if (p->desc.confinement) out[PYRO_MEM_CURL] = four * flow;
    if (p->desc.half_velocity) out[PYRO_MEM_DENSITY] = 4 * flow;
    out[PYRO_MEM_PRESSURE] = out[PYRO_MEM_RIGHT] = out[PYRO_MEM_SPREAD] = 4 * flow;
    if (p->desc.advection == PYRO_REFLECTION)
        out[PYRO_MEM_EXPANSION] = out[PYRO_MEM_MORE_PRESSURE] = 4 * flow;
    out[PYRO_MEM_COARSE_PRESSURE] = out[PYRO_MEM_COARSE_RIGHT] = 4 * pyro_coarse_cells(p);
    out[PYRO_MEM_REPORT] = (gas + flow) / PYRO_CELLS_A_GROUP * 32;
    if (!pyro_is_weighed(p)) return;
    out[PYRO_MEM_SUMS] = PYRO_SUMS * 16;
    const uint64_t faces = p->desc.variable_density ? 8 : 4;
    out[PYRO_MEM_COEFFICIENTS] = faces * flow;
    out[PYRO_MEM_COARSE_COEFFICIENTS] = faces * pyro_coarse_cells(p);
    for (pyro_memory i = PYRO_MEM_FOUND; i <= PYRO_MEM_CHANGE; i++) out[i] = 4 * flow;
}

static const char *const memory_labels[PYRO_MEM_COUNT] = {"velocity of burning gas",
                                                          "velocity of burning gas",
                                                          "burning gas",
                                                          "burning gas",
                                                          "places of burning gas",
                                                          "velocity between sweeps",
                                                          "gas between sweeps",
                                                          "smoke of burning gas",
                                                          "smoke of burning gas",
                                                          "smoke between sweeps",
                                                          "velocity that carries the gas",
                                                          "volumes between sweeps",
                                                          "vorticity",
                                                          "density of burning gas",
                                                          "pressure of burning gas",
                                                          "divergence",
                                                          "expansion of burning gas",
                                                          "pressure of burning gas",
                                                          "coarse pressure",
                                                          "coarse divergence",
                                                          "coefficients of pressure",
                                                          "coefficients of pressure",
                                                          "conjugate gradients",
                                                          "conjugate gradients",
                                                          "conjugate gradients",
                                                          "sums over burning gas",
                                                          "report of burning gas"};

bool pyro_allocate(pyro *p, gpu *g) {
    uint64_t sizes[PYRO_MEM_COUNT];
    find_sizes(p, sizes);
    for (int i = 0; i < PYRO_MEM_COUNT; i++)
        if (!gpu_buffer_make(g, &p->buffers[i], memory_labels[i], sizes[i])) return false;
    return pyro_allocate_guide(p, g) &&
           kernel_readback_make(&p->report, g, "report of burning gas", PYRO_REPORT_WORDS);
}

void pyro_list_memory(const pyro *p, budget_list *out) {
    uint64_t sizes[PYRO_MEM_COUNT];
    find_sizes(p, sizes);
    for (int i = 0; i < PYRO_MEM_COUNT; i++)
        if (!p->buffers[i] && sizes[i]) budget_list_add(out, memory_labels[i], sizes[i]);
    pyro_list_guide(p, out);
    for (int i = 0; i < 2 * PYRO_LOOKS; i++) {
        const gpu_image_desc desc = pyro_describe_image(p, (pyro_look)(i % PYRO_LOOKS));
        if (pyro_has_look(p, (pyro_look)(i % PYRO_LOOKS)) &&
            !p->looks[i / PYRO_LOOKS][i % PYRO_LOOKS])
            budget_list_add(out, desc.label, gpu_image_bytes(&desc));
    }
}

void pyro_destroy(pyro *p, gpu *g) {
    for (int i = 0; i < PYRO_KERNELS; i++) kernel_destroy(&p->kernels[i], g);
    for (int i = 0; i < PYRO_MEM_COUNT; i++) gpu_buffer_destroy(g, p->buffers[i]);
    for (int i = 0; i < 2 * PYRO_LOOKS; i++)
        gpu_image_destroy(g, p->looks[i / PYRO_LOOKS][i % PYRO_LOOKS]);
    gpu_image_destroy(g, p->pull);
    p->pull = NULL;
    kernel_readback_destroy(&p->report, g);
    memset(p->buffers, 0, sizeof p->buffers);
    memset(p->looks, 0, sizeof p->looks);
}

gpu_buffer *pyro_pair(const pyro *p, pyro_memory pair, uint32_t which) {
    return p->buffers[pair + (p->current ^ which)];
}

// ---- what is bound ----------------------------------------------------------------------------

void pyro_bind(const pyro *p, kernel *k, const kernel_place *places) {
    const bool reflects = p->desc.advection == PYRO_REFLECTION;
    gpu_buffer *const own[PYRO_OWN] = {
        [N_PyroGas] = pyro_pair(p, PYRO_MEM_GAS, 0),
        [N_PyroVelocity] = pyro_pair(p, PYRO_MEM_VELOCITY, 0),
        [N_PyroPressure] = p->buffers[p->finds_more ? PYRO_MEM_MORE_PRESSURE : PYRO_MEM_PRESSURE],
        [N_PyroRight] = p->buffers[PYRO_MEM_RIGHT],
        [N_PyroExpansion] = p->buffers[reflects ? PYRO_MEM_EXPANSION : PYRO_MEM_RIGHT],
        [N_PyroGasTo] = pyro_pair(p, PYRO_MEM_GAS, 1),
        [N_PyroVelocityTo] = pyro_pair(p, PYRO_MEM_VELOCITY, 1),
        [N_PyroCarrier] = p->desc.half_velocity ? p->buffers[PYRO_MEM_CARRIER]
                                                : pyro_pair(p, PYRO_MEM_VELOCITY, 0),
        [N_PyroSpread] = p->buffers[PYRO_MEM_SPREAD],
        [N_PyroCurl] = p->buffers[PYRO_MEM_CURL],
        [N_PyroCoarsePressure] = p->buffers[PYRO_MEM_COARSE_PRESSURE],
        [N_PyroCoarseRight] = p->buffers[PYRO_MEM_COARSE_RIGHT],
        [N_PyroCoefficients] = p->buffers[PYRO_MEM_COEFFICIENTS],
        [N_PyroCoarseCoefficients] = p->buffers[PYRO_MEM_COARSE_COEFFICIENTS],
        [N_PyroFound] = p->buffers[PYRO_MEM_FOUND],
        [N_PyroDirection] = p->buffers[PYRO_MEM_DIRECTION],
        [N_PyroChange] = p->buffers[PYRO_MEM_CHANGE],
        [N_PyroSums] = p->buffers[PYRO_MEM_SUMS],
        [N_PyroActive] = p->buffers[PYRO_MEM_ACTIVE],
        [N_PyroDensity] = p->buffers[PYRO_MEM_DENSITY],
        [N_PyroSmoke] = pyro_pair(p, PYRO_MEM_SMOKE, 0),
        [N_PyroSmokeTo] = pyro_pair(p, PYRO_MEM_SMOKE, 1),
        [N_PyroReport] = p->buffers[PYRO_MEM_REPORT],
    };
    for (int i = 0; i < PYRO_OWN; i++)
        if (own[i]) kernel_bind_at(k, &places[i], (gpu_binding){.buffer = own[i]});
}

int32_t pyro_present_from(const pyro *p) {
    return p->current ? (int32_t)(pyro_cells(p) / PYRO_CELLS_A_GROUP) : 0;
}

kernel *pyro_use(pyro *p, pyro_kernel which) {
    kernel *k = &p->kernels[which];
    pyro_bind(p, k, k->places);
    return k;
}

void pyro_stage(const pyro *p, gpu *g, const char *name) {
    if (p->desc.timed) gpu_pass_next(g, name);
}

bool pyro_run(const pyro *p, gpu *g, kernel *k) {
    uint32_t n[3];
    pyro_flow_size(&p->desc, n);
    return kernel_run(k, g, n[0], n[1], n[2]);
}

bool pyro_run_gas(const pyro *p, gpu *g, kernel *k) {
    return kernel_run(k, g, p->desc.size[0], p->desc.size[1], p->desc.size[2]);
}

static bool run_half_bricks(gpu *g, kernel *k, const uint32_t n[3]) {
    return kernel_run(k, g, n[0] / 8 * k->binaries[0].local_size[0], n[1] / 8, n[2] / 4);
}

bool pyro_run_half_bricks(const pyro *p, gpu *g, kernel *k) {
    uint32_t n[3];
    pyro_flow_size(&p->desc, n);
    return run_half_bricks(g, k, n);
}

bool pyro_run_half_bricks_of_gas(const pyro *p, gpu *g, kernel *k) {
    return run_half_bricks(g, k, p->desc.size);
}

size_t pyro_buffers(pyro *p, gpu_buffer *out[PYRO_STATE_BUFFERS]) {
    p->active_known = false;
    out[0] = pyro_pair(p, PYRO_MEM_VELOCITY, 0);
    out[1] = pyro_pair(p, PYRO_MEM_GAS, 0);
    out[2] = p->buffers[PYRO_MEM_PRESSURE];
    out[3] = pyro_pair(p, PYRO_MEM_SMOKE, 0);
    return p->desc.smoke ? 4 : 3;
}

void pyro_set_force(pyro *p, gpu_image *force) {
    p->force = force;
}

uint64_t pyro_steps(const pyro *p) {
    return p->steps;
}

static void swap_state(pyro *a, pyro *b) {
    static const pyro_memory state[] = {PYRO_MEM_VELOCITY, PYRO_MEM_VELOCITY + 1, PYRO_MEM_GAS,
                                        PYRO_MEM_GAS + 1,  PYRO_MEM_ACTIVE,       PYRO_MEM_PRESSURE,
                                        PYRO_MEM_SMOKE,    PYRO_MEM_SMOKE + 1};
    for (size_t i = 0; i < COUNT_OF(state); i++) SWAP(a->buffers[state[i]], b->buffers[state[i]]);
    SWAP(a->looks, b->looks);
    SWAP(a->current, b->current);
    SWAP(a->kept, b->kept);
    SWAP(a->active_known, b->active_known);
    SWAP(a->steps, b->steps);
}

bool pyro_exchange(pyro *a, pyro *b) {
    if (memcmp(a->desc.size, b->desc.size, sizeof a->desc.size) != 0 ||
        a->desc.precision != b->desc.precision || a->desc.half_velocity != b->desc.half_velocity ||
        a->desc.smoke != b->desc.smoke)
        return false;
    swap_state(a, b);
    return true;
}
