// Diffusive and convective scaling: Krueger, Kusumaatmaja, Kuzmin, Shardt, Silva, Viggen, "The
// Lattice Boltzmann Method" (2017), chapter 7.
#include "sim/units.h"
#include <math.h>
#include <stdio.h>

static const double sound2 = 1.0 / 3.0; // of the lattices of the air

// About the least tau at which operators hold shear layers of the speed that steps are chosen for
// (src/sim/README.md): on their own, and with the subgrid model.
static const struct {
    const char *name;
    double least[2];
} operators[] = {
    [SIM_BGK] = {"bgk", {0.51, 0.502}},
    [SIM_TRT] = {"trt", {0.505, 0.501}},
    [SIM_CENTRAL_MOMENTS] = {"central_moments", {0.502, 0.5}},
};

sim_units sim_units_make(double cell, double speed, double step) {
    return (sim_units){.cell = cell, .step = step > 0 ? step : SIM_SPEED * cell / speed};
}

double sim_velocity(const sim_units *u, double metres_a_second) {
    return metres_a_second * u->step / u->cell;
}

double sim_acceleration(const sim_units *u, double metres_a_second2) {
    return metres_a_second2 * u->step * u->step / u->cell;
}

double sim_tau(const sim_units *u, double diffusivity, double square) {
    return diffusivity * u->step / (u->cell * u->cell * square) + 0.5;
}

double sim_decay(const sim_units *u, double rate) {
    return -expm1(-rate * u->step);
}

static double mach(const sim_units *u, double speed) {
    return sim_velocity(u, speed) / sqrt(sound2);
}

sim_readout sim_judge(const sim_units *u, const sim_flow *flow) {
    return (sim_readout){
        .tau = sim_tau(u, flow->viscosity, sound2),
        .mach = mach(u, flow->speed),
        .reynolds =
            flow->viscosity > 0 ? flow->speed * flow->length / flow->viscosity : (double)INFINITY,
    };
}

bool sim_advise_speed(const sim_units *u, const sim_flow *flow, double measured, char *out,
                      size_t capacity) {
    double now = mach(u, measured), step = u->step * SIM_MACH_MAX / now;
    if (now <= SIM_MACH_MAX) return false;
    int said =
        snprintf(out, capacity,
                 "air of %.3g m/s is Mach %.2g on the lattice, which must stay below %g: set ",
                 measured, now, SIM_MACH_MAX);
    if (said < 0 || (size_t)said >= capacity) return true;
    out += said, capacity -= (size_t)said;
    if (flow->fixed)
        snprintf(out, capacity, "'time_step' below %.3g s (it is %.3g)%s", step, u->step,
                 measured > flow->speed ? "" : ", or 'speed' to less if it will not be so fast");
    else
        snprintf(out, capacity,
                 "'speed' to %.3g m/s (it is %.3g), or 'time_step' below %.3g s (it is %.3g)",
                 measured, flow->speed, step, u->step);
    return true;
}

bool sim_advise(const sim_units *u, const sim_flow *flow, char *out, size_t capacity) {
    if (sim_advise_speed(u, flow, flow->speed, out, capacity)) return true;
    double tau = sim_judge(u, flow).tau;
    double least = operators[flow->collision].least[flow->subgrid];
    double square = u->cell * u->cell * sound2 / u->step; // m^2/s of each 1 of tau
    if (tau < least) {
        snprintf(
            out, capacity,
            "tau is %.5f, and collision = \"%s\" is stable above %g: set 'viscosity' above "
            "%.2g m^2/s (it is %.2g)%s%s",
            tau, operators[flow->collision].name, least, (least - 0.5) * square, flow->viscosity,
            flow->collision == SIM_CENTRAL_MOMENTS ? "" : ", 'collision' to \"central_moments\"",
            flow->subgrid ? "" : ", or 'smagorinsky' to 0.1");
        return true;
    }
    if (tau <= SIM_TAU_MAX) return false;
    snprintf(
        out, capacity,
        "tau is %.2f, above %g, where the air is no longer what 'viscosity' says (%.2g m^2/s): "
        "set 'time_step' below %.2g s (it is %.2g), or 'voxel_size' to a larger one",
        tau, SIM_TAU_MAX, flow->viscosity, u->step * (SIM_TAU_MAX - 0.5) / (tau - 0.5), u->step);
    return true;
}
