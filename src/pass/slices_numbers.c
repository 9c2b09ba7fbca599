// What a step of the solver is told, from the uniforms of the pass.
#include "base/memory.h"
#include "pass/slices_parts.h"
#include <string.h>

bool slices_numbers(const pass *p, flow_numbers *out) {
    static const char *const edges[4] = {"left_velocity", "right_velocity", "bottom_velocity",
                                         "top_velocity"};
    static const char *const names[] = {"vorticity",    "buoyancy_density", "buoyancy_heat",
                                        "cooling_rate", "dissolve_rate",    "friction",
                                        "tolerance",    "max_speed",        "force",
                                        "viscosity",    "reynolds",         "speed"};
    enum { VORTICITY, LIFT, HEAT_LIFT, COOL, DISSOLVE, FRICTION, TOLERANCE, MOST_SPEED, FORCE };
    enum { VISCOSITY = FORCE + 1, REYNOLDS, SPEED };
    const slices_flow *f = slices_of(p);
    float v[COUNT_OF(names)][4], edge[4][4];
    for (size_t i = 0; i < COUNT_OF(names); i++)
        if (!pass_evaluate_vector(p, names[i], v[i])) return false;
    for (int i = 0; i < 4; i++)
        if (!pass_evaluate_vector(p, edges[i], edge[i])) return false;
    float viscosity = v[VISCOSITY][0], reynolds = v[REYNOLDS][0];
    if (reynolds > 0) viscosity = v[SPEED][0] * (float)f->desc.height / reynolds;
    *out = (flow_numbers){
        .dt = (float)f->clock.step,
        .cell = (float)f->cell,
        .viscosity = viscosity,
        .vorticity = v[VORTICITY][0],
        .acceleration = {v[FORCE][0], v[FORCE][1]},
        .buoyancy = {v[LIFT][0], v[HEAT_LIFT][0]},
        .decay = {v[DISSOLVE][0], v[COOL][0], v[DISSOLVE][0]},
        .friction = v[FRICTION][0],
        .tolerance = v[TOLERANCE][0],
        .max_speed = v[MOST_SPEED][0],
    };
    for (int i = 0; i < 4; i++) memcpy(out->wall_velocity[i], edge[i], 2 * sizeof(float));
    return true;
}
