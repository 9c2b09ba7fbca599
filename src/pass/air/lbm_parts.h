// The inside of the pass type `lbm`, for its own files only.
#pragma once
#include "pass/air/air_parts.h"
#include "sim/lbm.h"
#include "sim/lbm_guard.h"

typedef struct lbm_air {
    air air;          // first
    lbm_body *moving; // colliders, as they go on
    lbm *solver;      // after pass_complete
    lbm_guard *guard;
    lbm_numbers numbers; // of the step being recorded
    bool stops;          // on trouble
    lbm_report report;   // the newest
    double held;         // seconds at which it was first held back; NAN: never
} lbm_air;

static inline lbm_air *lbm_air_of(const pass *p) {
    return p->state;
}

// lbm_numbers.c: values as of the host's context
bool lbm_air_numbers(const pass *p, lbm_numbers *out);
sim_flow lbm_air_flow(const pass *p);
// Cells a step. By `guard` one of them is the greatest that is air, the other out of reach.
float lbm_air_clamp_speed(const lbm_air *a);  // what moves, or is given, is slowed down to it
float lbm_air_spoilt_speed(const lbm_air *a); // faster air is stopped, and not shown

// lbm.c
bool lbm_air_check_options(const pass *p);
double lbm_air_pascals(const lbm_air *a); // of an excess of density of 1

// lbm_step.c
extern const air_kind lbm_kind;

// lbm_readouts.c
extern const pass_simulation lbm_simulation;
bool lbm_air_watch(pass *p); // after steps: what the guard found, and what it is to look at
