// Conversion between physical units and the cells and steps of a lattice, and checks of whether a
// lattice Boltzmann solver can compute what an effect asks for.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct sim_units {
    double cell; // metres
    double step; // seconds
} sim_units;

// Cells per step of the expected speed. Errors of compressibility grow with its square, the number
// of steps per second with its inverse.
#define SIM_SPEED 0.1
#define SIM_MACH_MAX 0.3 // beyond it the result is not air (Krueger et al. 2017, section 7.2)
#define SIM_TAU_MAX 2.0  // beyond it errors grow with its square (section 4.5)

// `speed`: the expected maximum speed of the flow, m/s; `step`: seconds, 0: follows from the speed.
sim_units sim_units_make(double cell, double speed, double step);
double sim_velocity(const sim_units *u, double metres_a_second);      // cells per step
double sim_acceleration(const sim_units *u, double metres_a_second2); // cells per step^2
// Returns the relaxation time for a viscosity or diffusivity (m^2/s). `sound2` is the square of the
// lattice's speed of sound.
double sim_tau(const sim_units *u, double diffusivity, double sound2);
// Returns the part that a rate of decay (1/s) removes in a step.
double sim_decay(const sim_units *u, double rate);

typedef enum sim_operator { SIM_BGK, SIM_TRT, SIM_CENTRAL_MOMENTS } sim_operator;

typedef struct sim_flow {
    double viscosity; // m^2/s
    double speed;     // m/s, expected
    double length;    // m, of the shortest side of the box
    sim_operator collision;
    bool subgrid; // with a subgrid model of turbulence
    bool fixed;   // the step does not follow from `speed`
} sim_flow;

typedef struct sim_readout {
    double tau, mach, reynolds; // reynolds: INFINITY without viscosity
} sim_readout;
sim_readout sim_judge(const sim_units *u, const sim_flow *flow);

// Writes one sentence that names the parameter to change. False: nothing is wrong.
bool sim_advise(const sim_units *u, const sim_flow *flow, char *out, size_t capacity);
// The same for a measured speed.
bool sim_advise_speed(const sim_units *u, const sim_flow *flow, double measured, char *out,
                      size_t capacity);
