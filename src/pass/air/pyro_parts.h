// The inside of the pass type `pyro`, for its own files only.
#pragma once
#include "pass/air/air_parts.h"
#include "sim/fuels.h"
#include "sim/pyro.h"

typedef struct pyro_air {
    air air;      // first
    pyro *solver; // after pass_complete
    const sim_fuel *fuel;
    float guide_cell;     // the largest side of a cell that its guide reads, m; 0: it reads none
    pyro_numbers numbers; // of the step being recorded
    pyro_report report;   // the newest
} pyro_air;

static inline pyro_air *pyro_air_of(const pass *p) {
    return p->state;
}

extern const pass_type pyro_type;

// pyro_step.c
extern const air_kind pyro_kind;
bool pyro_air_numbers(const pass *p, pyro_numbers *out); // as of the host's context

// pyro_readouts.c
extern const pass_simulation pyro_simulation;
void pyro_air_look(pyro_air *a); // at what has come back from the device by now
