// What a step of the solver is told, from the uniforms of the pass.
#include "pass/slices/slices_parts.h"
#include <string.h>

uint32_t slices_seed(const slices_flow *f) {
    float seed[4];
    return pass_evaluate_now(f->pass, N_seed, seed) ? (uint32_t)seed[0] : 0;
}

bool slices_numbers(const pass *p, flow_numbers *out) {
    const slices_flow *f = slices_of(p);
    float v[N_top_velocity + 1][4];
    for (int i = 0; i <= N_top_velocity; i++)
        if (!pass_evaluate_now(p, i, v[i])) return false;
    float viscosity = v[N_viscosity][0], reynolds = v[N_reynolds][0];
    if (reynolds > 0) viscosity = v[N_speed][0] * (float)f->desc.height / reynolds;
    *out = (flow_numbers){
        .dt = (float)f->clock.step,
        .cell = (float)f->cell,
        .viscosity = viscosity,
        .vorticity = v[N_vorticity][0],
        .acceleration = {v[N_force][0], v[N_force][1]},
        .buoyancy = {v[N_buoyancy_density][0], v[N_buoyancy_heat][0]},
        .decay = {v[N_dissolve_rate][0], v[N_cooling_rate][0], v[N_dissolve_rate][0]},
        .friction = v[N_friction][0],
        .tolerance = v[N_tolerance][0],
        .max_speed = v[N_max_speed][0],
    };
    for (int i = 0; i < 4; i++)
        memcpy(out->wall_velocity[i], v[N_left_velocity + i], 2 * sizeof(float));
    return true;
}
