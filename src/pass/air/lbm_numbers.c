// What a step of the solver is told, from the uniforms of the pass: physical units become those of
// the lattice.
#include "pass/air/lbm_parts.h"
#include <math.h>

// The solver's own limit: at 1/2 exactly nothing would ever settle.
static const double least_tau = 0.5 + 1e-5;

static float tau(const lbm_air *a, double diffusivity, double square) {
    return (float)fmax(sim_tau(&a->air.units, diffusivity, square), least_tau);
}

static bool add_force(const pass *p, const lbm_air *a, float out[3]) {
    float force[3];
    if (!air_constant_force(p, force)) return false;
    for (int i = 0; i < 3; i++) out[i] = (float)sim_acceleration(&a->air.units, (double)force[i]);
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
    double k = sim_velocity(&a->air.units, 1), most = (double)lbm_air_clamp_speed(a);
    if (speed * k > most) k = most / speed;
    for (int i = 0; i < 3; i++) out[i] = (float)((double)wind[i] * k);
}

bool lbm_air_numbers(const pass *p, lbm_numbers *out) {
    const lbm_air *a = lbm_air_of(p);
    const lbm_desc *structure = lbm_get_desc(a->solver);
    const sim_units *u = &a->air.units;
    float values[N_wind + 1][4];
    for (int i = N_viscosity; i <= N_wind; i++)
        if (!pass_evaluate_now(p, i, values[i])) return false;
#define VALUE(NAME) ((double)values[N_##NAME][0])
    double square = (double)lbm_scalar_speed(structure->scalar_set);
    *out = (lbm_numbers){.tau = tau(a, VALUE(viscosity), 1.0 / 3.0),
                         .smagorinsky = values[N_smagorinsky][0]};
    for (int s = 0; s < LBM_MAX_SCALARS; s++) {
        bool heat = s == PASS_FLUID_TEMPERATURE;
        out->scalar_tau[s] = tau(a, heat ? VALUE(temperature_diffusion) : VALUE(diffusion), square);
        out->decay[s] = (float)sim_decay(u, heat ? VALUE(cooling_rate) : VALUE(dissolve_rate));
    }
    out->buoyancy[PASS_FLUID_DENSITY][2] = (float)sim_acceleration(u, VALUE(buoyancy_density));
    out->buoyancy[PASS_FLUID_TEMPERATURE][2] = (float)sim_acceleration(u, VALUE(buoyancy_heat));
    for (int face = 0; face < 6; face++) find_inflow(a, values[N_wind], out->inflow[face]);
    if (!a->stops) out->max_speed = lbm_air_clamp_speed(a);
#undef VALUE
    return add_force(p, a, out->acceleration);
}

sim_flow lbm_air_flow(const pass *p) {
    const lbm_air *a = lbm_air_of(p);
    const lbm_desc *structure = lbm_get_desc(a->solver);
    float viscosity[4], smagorinsky[4];
    pass_evaluate_now(p, N_viscosity, viscosity);
    pass_evaluate_now(p, N_smagorinsky, smagorinsky);
    double length = a->air.desc.voxel_size;
    uint32_t least = a->air.desc.size[0];
    for (int i = 1; i < 3; i++)
        if (a->air.desc.size[i] < least) least = a->air.desc.size[i];
    return (sim_flow){
        .viscosity = (double)viscosity[0],
        .speed = a->air.desc.speed,
        .length = length * least,
        .collision = (sim_operator)structure->collision,
        .subgrid = structure->subgrid && smagorinsky[0] > 0,
        .fixed = a->air.desc.time_step > 0,
    };
}
