// What a step of the solver is told, from the uniforms of the pass: physical units become those of
// the lattice.
#include "base/memory.h"
#include "pass/lbm_parts.h"
#include <math.h>
#include <string.h>

// The solver's own limit: at 1/2 exactly nothing would ever settle.
static const double least_tau = 0.5 + 1e-5;

static float tau(const lbm_air *a, double diffusivity, double square) {
    return (float)fmax(sim_tau(&a->units, diffusivity, square), least_tau);
}

static const field *force_of(const pass *p) {
    size_t index;
    return pass_find_key(p, "force", &index) == PASS_FIELD ? p->fields[index] : NULL;
}

bool lbm_air_force_varies(const pass *p) {
    const field *force = force_of(p);
    return force && !force->uniform;
}

static bool add_force(const pass *p, const lbm_air *a, float out[3]) {
    const field *force = force_of(p);
    float value[4] = {0};
    if (!force || !force->uniform) return true;
    if (!field_eval(force, p->host->context, (float3){0, 0, 0}, value)) return false;
    for (int i = 0; i < 3; i++) {
        float v = value[force->components == 1 ? 0 : i];
        if (isfinite(v)) out[i] = (float)sim_acceleration(&a->units, (double)v);
    }
    return true;
}

static const float out_of_reach = 1e6f; // also of halves, which moments are

static float greatest(void) {
    return (float)(SIM_MACH_MAX / sqrt(3.0));
}

float lbm_air_clamp_speed(const lbm_air *a) {
    return a->stops ? out_of_reach : greatest();
}

float lbm_air_spoilt_speed(const lbm_air *a) {
    return a->stops ? greatest() : out_of_reach;
}

// In cells a step; faster wind than the air may be is slowed down, as the air is.
static void find_inflow(const lbm_air *a, const float wind[3], float out[3]) {
    const double speed = sqrt((double)glm_dot((float *)wind, (float *)wind));
    double k = sim_velocity(&a->units, 1), most = (double)lbm_air_clamp_speed(a);
    if (speed * k > most) k = most / speed;
    for (int i = 0; i < 3; i++) out[i] = (float)((double)wind[i] * k);
}

bool lbm_air_numbers(const pass *p, lbm_numbers *out) {
    static const char *const names[] = {
        "viscosity",        "diffusion",     "temperature_diffusion",
        "buoyancy_density", "buoyancy_heat", "dissolve_rate",
        "cooling_rate",     "smagorinsky",   "wind"};
    enum { VISCOSITY, DIFFUSION, HEAT_DIFFUSION, LIFT, HEAT_LIFT, DISSOLVE, COOL, SUBGRID, WIND };
    const lbm_air *a = lbm_air_of(p);
    const lbm_desc *structure = lbm_get_desc(a->solver);
    const sim_units *u = &a->units;
    float values[COUNT_OF(names)][4];
    for (size_t i = 0; i < COUNT_OF(names); i++)
        if (!pass_evaluate_vector(p, names[i], values[i])) return false;
#define VALUE(NAME) ((double)values[NAME][0])
    double square = (double)lbm_scalar_speed(structure->scalar_set);
    *out = (lbm_numbers){.tau = tau(a, VALUE(VISCOSITY), 1.0 / 3.0),
                         .smagorinsky = values[SUBGRID][0]};
    for (int s = 0; s < LBM_MAX_SCALARS; s++) {
        bool heat = s == PASS_LBM_TEMPERATURE;
        out->scalar_tau[s] = tau(a, VALUE(heat ? HEAT_DIFFUSION : DIFFUSION), square);
        out->decay[s] = (float)sim_decay(u, VALUE(heat ? COOL : DISSOLVE));
    }
    out->buoyancy[PASS_LBM_DENSITY][2] = (float)sim_acceleration(u, VALUE(LIFT));
    out->buoyancy[PASS_LBM_TEMPERATURE][2] = (float)sim_acceleration(u, VALUE(HEAT_LIFT));
    for (int face = 0; face < 6; face++) find_inflow(a, values[WIND], out->inflow[face]);
    if (!a->stops) out->max_speed = lbm_air_clamp_speed(a);
#undef VALUE
    return add_force(p, a, out->acceleration);
}

sim_flow lbm_air_flow(const pass *p) {
    const lbm_air *a = lbm_air_of(p);
    const lbm_desc *structure = lbm_get_desc(a->solver);
    double length = a->desc.voxel_size;
    uint32_t least = a->desc.size[0];
    for (int i = 1; i < 3; i++)
        if (a->desc.size[i] < least) least = a->desc.size[i];
    return (sim_flow){
        .viscosity = (double)pass_evaluate(p, "viscosity"),
        .speed = a->desc.speed,
        .length = length * least,
        .collision = (sim_operator)structure->collision,
        .subgrid = structure->subgrid && pass_evaluate(p, "smagorinsky") > 0,
        .fixed = a->desc.time_step > 0,
    };
}
