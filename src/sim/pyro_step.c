// A step of a combustion solver: what the gas carries and burns, its velocity, the projection; then
// the images of the state.
#include "base/error.h"
#include "sim/pyro_impl.h"
#include <math.h>
#include <string.h>

static const float air_molar_mass = 28.97f;  // kg/kmol
static const float air_heat_capacity = 1150; // J/(kg K), between the surroundings and a flame
static const float soot_heat = 32.8e6f;      // of combustion, J/kg
static const float least_oxygen = 1e-4f;     // that fuel takes, by mass: powder brings its own
static const float cooling_at = 1500;        // K, at which `cooling` is given

enum { MOST_CELLS_A_STEP = 7 }; // of the gas: shaders/sim/pyro/present.glsl looks so far

static float share(float dt, float time, float at_zero) {
    return time > 0 ? 1 - expf(-dt / time) : at_zero;
}

// ---- numbers ----------------------------------------------------------------------------------

void pyro_set_gas(kernel *k, const pyro_numbers *n) {
    kernel_set_float(k, N_ambient, n->ambient);
    kernel_set_float(k, N_lightness, air_molar_mass / fmaxf(n->molar_mass, 1));
}

void pyro_set_burning(kernel *k, const pyro_numbers *n) {
    pyro_set_gas(k, n);
    kernel_set_float(k, N_dt, n->dt);
    kernel_set_float(k, N_ignition, n->ignition);
    kernel_set_float(k, N_flame_reach, n->flame_speed * n->dt / n->cell);
    kernel_set_float(k, N_burn_share, share(n->dt, n->burn_time, 1));
    kernel_set_float(k, N_oxygen_need, fmaxf(n->oxygen, least_oxygen));
    kernel_set_float(k, N_heat, n->heat / air_heat_capacity);
    kernel_set_float(k, N_soot_yield, n->soot_yield);
    kernel_set_float(k, N_soot_share, share(n->dt, n->soot_burn_time, 0));
    kernel_set_float(k, N_soot_kept, expf(-n->dissolve * n->dt));
    kernel_set_float(k, N_smoke_yield, n->smoke_yield);
    kernel_set_float(k, N_smoke_kept, expf(-n->smoke_dissolve * n->dt));
    kernel_set_float(k, N_soot_heat, soot_heat / air_heat_capacity);
    kernel_set_float(k, N_cooling, 3 * n->cooling * n->dt / powf(cooling_at, 4));
    kernel_set_float(k, N_expansion, n->expansion);
}

static void set_inflow(kernel *k, const pyro_numbers *n) {
    kernel_set(k, N_inflow, n->inflow, sizeof n->inflow);
}

// Of a kernel whose cells have this side.
static void set_carrying(kernel *k, const pyro_numbers *n, float cell) {
    kernel_set_float(k, N_reach, n->dt / cell);
    set_inflow(k, n);
}

// ---- a step -----------------------------------------------------------------------------------

static bool look_at_flow(pyro *p, gpu *g, const pyro_numbers *n, gpu_image *to) {
    kernel *k = pyro_use(p, PYRO_K_LOOK_FLOW);
    const float density = 353 / n->ambient, cell = pyro_flow_cell(p, n); // of the surroundings
    kernel_bind_image(k, N_flow, to);
    set_inflow(k, n);
    const float halves = p->desc.advection == PYRO_REFLECTION ? 2 : 1; // pressure is of half a step
    kernel_set_float(k, N_pressure_unit, halves * density * cell / n->dt);
    return pyro_run(p, g, k);
}

// The gas, and its smoke, is in the state, goes to the next one, or lies between sweeps.
typedef enum place { IS, GOES, BETWEEN } place;

static void bind_gas(const pyro *p, kernel *k, int gas, int smoke, place at) {
    const bool between = at == BETWEEN;
    kernel_bind_buffer(k, gas,
                       between ? p->buffers[PYRO_MEM_GAS_BETWEEN]
                               : pyro_pair(p, PYRO_MEM_GAS, (uint32_t)at));
    kernel_bind_buffer(k, smoke,
                       between ? p->buffers[PYRO_MEM_SMOKE_BETWEEN]
                               : pyro_pair(p, PYRO_MEM_SMOKE, (uint32_t)at));
}

// A kernel of groups that look where there is gas.
static kernel *use_carrying(pyro *p, pyro_kernel which, const pyro_numbers *n, place from) {
    kernel *k = pyro_use(p, which);
    set_carrying(k, n, n->cell);
    kernel_set_int(k, N_everywhere, !p->active_known);
    kernel_set_int(k, N_present_from, pyro_present_from(p));
    bind_gas(p, k, N_PyroGasFrom, N_PyroSmokeFrom, from);
    return k;
}

// What volumes are between sweeps.
static bool spread_find(pyro *p, gpu *g, const pyro_numbers *n) {
    pyro_stage(p, g, "pyro.volumes");
    kernel *spread = pyro_use(p, PYRO_K_SPREAD);
    set_inflow(spread, n);
    return pyro_run(p, g, spread);
}

// The same, and the velocities that carry the gas.
static bool find_volumes(pyro *p, gpu *g, const pyro_numbers *n) {
    if (!spread_find(p, g, n)) return false;
    if (!p->desc.half_velocity) return true;
    kernel *carrier = pyro_use(p, PYRO_K_CARRIER);
    set_inflow(carrier, n);
    return pyro_run(p, g, carrier);
}

// From the state to the next one, to what is between, and back.
static bool gas_carry(pyro *p, gpu *g, const pyro_numbers *n) {
    pyro_stage(p, g, "pyro.carry_x");
    kernel *x = use_carrying(p, PYRO_K_CARRY_X, n, IS);
    bind_gas(p, x, N_PyroGasInto, N_PyroSmokeInto, GOES);
    if (!pyro_run_half_bricks_of_gas(p, g, x)) return false;
    pyro_stage(p, g, "pyro.carry_y");
    kernel *y = use_carrying(p, PYRO_K_CARRY_Y, n, GOES);
    bind_gas(p, y, N_PyroGasInto, N_PyroSmokeInto, BETWEEN);
    return pyro_run_half_bricks_of_gas(p, g, y);
}

static bool gas_advance(pyro *p, gpu *g, const pyro_numbers *n) {
    if (!gas_carry(p, g, n)) return false;
    pyro_stage(p, g, "pyro.gas");
    kernel *k = use_carrying(p, PYRO_K_GAS, n, BETWEEN);
    const int32_t groups = (int32_t)(pyro_cells(p) / PYRO_CELLS_A_GROUP);
    pyro_set_burning(k, n);
    kernel_set_float(k, N_cell, pyro_flow_cell(p, n));
    kernel_set_int(k, N_present_to, groups - pyro_present_from(p));
    if (p->desc.outflow) kernel_bind_image(k, N_force, p->force);
    return pyro_run_half_bricks_of_gas(p, g, k);
}

// Of the velocity before the step: where vorticity is confined. What was between sweeps is not
// needed any more, and vorticity stands in its place.
static bool curl_find(pyro *p, gpu *g, const pyro_numbers *n) {
    pyro_stage(p, g, "pyro.confine");
    for (pyro_kernel i = PYRO_K_VORTICITY; i <= PYRO_K_CURL; i++) {
        kernel *k = pyro_use(p, i);
        set_inflow(k, n);
        kernel_bind_buffer(k, N_PyroVorticity, p->buffers[PYRO_MEM_GAS_BETWEEN]);
        if (!pyro_run(p, g, k)) return false;
    }
    return true;
}

// The same, and what was vorticity is not needed any more.
static bool turbulence_find(pyro *p, gpu *g, const pyro_numbers *n) {
    const float halves = p->desc.advection == PYRO_REFLECTION ? 2 : 1; // each of which pushes
    pyro_stage(p, g, "pyro.turbulence");
    kernel *k = pyro_use(p, PYRO_K_TURBULENCE);
    set_carrying(k, n, pyro_flow_cell(p, n));
    kernel_set_float(k, N_kick, n->turbulence / halves);
    kernel_set_int(k, N_turn, (int32_t)(p->steps & INT32_MAX));
    kernel_bind_buffer(k, N_PyroPotential, p->buffers[PYRO_MEM_GAS_BETWEEN]);
    return pyro_run(p, g, k);
}

static kernel *use_stirring(pyro *p, pyro_kernel which, const pyro_numbers *n, gpu_buffer *from,
                            gpu_buffer *into) {
    kernel *k = pyro_use(p, which);
    set_carrying(k, n, pyro_flow_cell(p, n));
    kernel_bind_buffer(k, N_PyroCarrier, pyro_pair(p, PYRO_MEM_VELOCITY, 0));
    kernel_bind_buffer(k, N_PyroFlowFrom, from);
    kernel_bind_buffer(k, N_PyroFlowInto, into);
    return k;
}

static void set_forces(const pyro *p, kernel *k, const pyro_numbers *n) {
    pyro_set_gas(k, n);
    kernel_set_float(k, N_dt, n->dt);
    kernel_set_float(k, N_gravity, n->gravity);
    kernel_set(k, N_acceleration, n->acceleration, sizeof n->acceleration);
    kernel_set_float(k, N_confinement, n->confinement * n->dt);
    kernel_set_float(k, N_max_speed, n->max_speed);
    if (p->force) kernel_bind_image(k, N_force, p->force);
    if (p->desc.guide) pyro_set_pull(p, k, n);
    kernel_bind_buffer(k, N_PyroPotential, p->buffers[PYRO_MEM_GAS_BETWEEN]);
}

// Carries a velocity by that of the state, and pushes it. `path`: where it is, and
// where it lies after each sweep.
static bool flow_advance(pyro *p, gpu *g, const pyro_numbers *n, gpu_buffer *const path[4]) {
    static const pyro_kernel sweeps[] = {PYRO_K_VELOCITY_X, PYRO_K_VELOCITY_Y, PYRO_K_VELOCITY};
    static const char *const stages[] = {"pyro.velocity_x", "pyro.velocity_y", "pyro.velocity"};
    for (int i = 0; i < 3; i++) {
        pyro_stage(p, g, stages[i]);
        kernel *k = use_stirring(p, sweeps[i], n, path[i], path[i + 1]);
        if (i == 2) set_forces(p, k, n);
        if (!pyro_run_half_bricks(p, g, k)) return false;
    }
    return pyro_obstruct(p, g, n);
}

// What the gas did to its velocity in half a step is reflected by what the projection did, so that
// the other half begins beyond it: what one projection takes from the energy the next one gives
// back.
static bool velocity_reflect(pyro *p, gpu *g, const pyro_numbers *n) {
    gpu_buffer *own = pyro_pair(p, PYRO_MEM_VELOCITY, 0),
               *next = pyro_pair(p, PYRO_MEM_VELOCITY, 1);
    gpu_buffer *between = p->buffers[PYRO_MEM_VELOCITY_BETWEEN];
    pyro_numbers half = *n;
    half.dt /= 2;
    if (!flow_advance(p, g, &half, (gpu_buffer *[]){own, next, between, next}) ||
        !pyro_project_half(p, g, &half) || !spread_find(p, g, n))
        return false;
    p->buffers[PYRO_MEM_VELOCITY_BETWEEN] = next; // the three sweeps end in the other buffer
    p->buffers[PYRO_MEM_VELOCITY + (p->current ^ 1)] = between;
    return flow_advance(p, g, &half, (gpu_buffer *[]){next, between, next, between}) &&
           pyro_project_again(p, g, &half);
}

static bool velocity_advance(pyro *p, gpu *g, const pyro_numbers *numbers) {
    pyro_numbers n = *numbers;
    const float most = MOST_CELLS_A_STEP * n.cell / n.dt;
    n.max_speed = n.max_speed > 0 && n.max_speed < most ? n.max_speed : most;
    if (p->desc.confinement && !curl_find(p, g, &n)) return false;
    if (p->desc.turbulence && !turbulence_find(p, g, &n)) return false;
    if (p->desc.guide && !pyro_find_pull(p, g, &n)) return false;
    if (p->desc.variable_density && !pyro_find_coefficients(p, g, &n)) return false;
    if (p->desc.advection == PYRO_REFLECTION) return velocity_reflect(p, g, &n);
    gpu_buffer *next = pyro_pair(p, PYRO_MEM_VELOCITY, 1);
    gpu_buffer *const path[] = {pyro_pair(p, PYRO_MEM_VELOCITY, 0), next,
                                p->buffers[PYRO_MEM_VELOCITY_BETWEEN], next};
    return flow_advance(p, g, &n, path) && pyro_project(p, g, &n);
}

static bool check_numbers(const pyro_numbers *n) {
    return (n->dt > 0 && n->cell > 0 && n->ambient > 0) ||
           err_set("a step of %g s on cells of %g m in air of %g K; each must be more than 0",
                   (double)n->dt, (double)n->cell, (double)n->ambient);
}

bool pyro_step(pyro *p, gpu *g, const pyro_numbers *n, bool keep) {
    if (!check_numbers(n) ||
        (pyro_is_weighed(p) && !p->coefficients_known && !pyro_find_coefficients(p, g, n)) ||
        !find_volumes(p, g, n) || !gas_advance(p, g, n) || !velocity_advance(p, g, n))
        return false;
    p->current ^= 1;
    p->active_known = true;
    p->steps++;
    return !keep || pyro_keep(p, g, n);
}

bool pyro_reset(pyro *p, gpu *g, const pyro_numbers *n) {
    p->active_known = false;
    p->kept = p->steps = 0;
    p->current = 0;
    kernel_readback_forget(&p->report);
    for (int which = 0; which < 2; which++) {
        kernel *gas = pyro_use(p, PYRO_K_RESET);
        bind_gas(p, gas, N_PyroGasTo, N_PyroSmokeTo, (place)which);
        kernel *flow = pyro_use(p, PYRO_K_RESET_FLOW);
        kernel_set(flow, N_inflow, n->inflow, sizeof n->inflow);
        kernel_bind_buffer(flow, N_PyroVelocityTo, p->buffers[PYRO_MEM_VELOCITY + which]);
        if (!pyro_run_gas(p, g, gas) || !pyro_run(p, g, flow)) return false;
    }
    return true;
}

// ---- looks ------------------------------------------------------------------------------------

gpu_image *pyro_image(const pyro *p, pyro_look look, int which) {
    return p->kept > (uint64_t)which ? p->looks[(p->kept + 1 + (uint64_t)which) % 2][look] : NULL;
}

bool pyro_has_look(const pyro *p, pyro_look look) {
    return look != PYRO_SMOKE || p->desc.smoke;
}

gpu_image_desc pyro_describe_image(const pyro *p, pyro_look look) {
    static const char *const labels[PYRO_LOOKS] = {"burning gas", "its flow", "its smoke"};
    uint32_t n[3];
    pyro_flow_size(&p->desc, n);
    if (look != PYRO_FLOW) memcpy(n, p->desc.size, sizeof n);
    return (gpu_image_desc){.label = labels[look],
                            .format = look == PYRO_SMOKE ? GPU_R16F : GPU_RGBA16F,
                            .width = n[0],
                            .height = n[1],
                            .depth = n[2],
                            .use = GPU_USE_SAMPLED | GPU_USE_STORAGE};
}

bool pyro_keep(pyro *p, gpu *g, const pyro_numbers *n) {
    gpu_image **images = p->looks[p->kept % 2];
    for (pyro_look i = 0; i < PYRO_LOOKS && pyro_has_look(p, i); i++) {
        const gpu_image_desc desc = pyro_describe_image(p, i);
        if (!images[i]) images[i] = gpu_image_create(g, &desc);
        if (!images[i]) return false;
    }
    kernel *k = pyro_use(p, PYRO_K_LOOK);
    kernel_bind_image(k, N_scalars, images[PYRO_GAS]);
    kernel_bind_image(k, N_smokes, images[PYRO_SMOKE]);
    pyro_set_gas(k, n);
    p->kept++;
    return pyro_run_gas(p, g, k) && look_at_flow(p, g, n, images[PYRO_FLOW]);
}
