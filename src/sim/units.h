// What a metre and a second are to a solver on a lattice: physical units outside, cells and steps
// inside. And whether what an effect asks for is what such a solver can do.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct sim_units {
    double cell; // metres
    double step; // seconds
} sim_units;

// Cells a step that the expected speed becomes. Errors of compressibility grow with its square, the
// steps that a second takes with its inverse.
#define SIM_SPEED 0.1
#define SIM_MACH_MAX 0.3 // beyond it the solver is no longer air (Krueger et al. 2017, section 7.2)
#define SIM_TAU_MAX 2.0  // beyond it errors grow with its square (section 4.5)

// `speed`: m/s that the flow is expected to stay below; `step`: seconds, 0: by the speed.
sim_units sim_units_make(double cell, double speed, double step);
double sim_velocity(const sim_units *u, double metres_a_second);      // in cells a step
double sim_acceleration(const sim_units *u, double metres_a_second2); // in cells a step^2
// Of a viscosity or diffusivity (m^2/s) on a lattice whose speed of sound has this square.
double sim_tau(const sim_units *u, double diffusivity, double sound2);
// Share of something that a rate (1/s) takes away in a step.
double sim_decay(const sim_units *u, double rate);

typedef enum sim_operator { SIM_BGK, SIM_TRT, SIM_CENTRAL_MOMENTS } sim_operator;

typedef struct sim_flow {
    double viscosity; // m^2/s
    double speed;     // m/s, expected
    double length;    // m, of the shortest side of the box
    sim_operator collision;
    bool subgrid; // with a model of what is finer than a cell
    bool fixed;   // the step does not follow from `speed`
} sim_flow;

typedef struct sim_readout {
    double tau, mach, reynolds; // reynolds: INFINITY without viscosity
} sim_readout;
sim_readout sim_judge(const sim_units *u, const sim_flow *flow);

// Which parameter to change, as one sentence; false: nothing is wrong.
bool sim_advise(const sim_units *u, const sim_flow *flow, char *out, size_t capacity);
// The same of a speed that was measured.
bool sim_advise_speed(const sim_units *u, const sim_flow *flow, double measured, char *out,
                      size_t capacity);
