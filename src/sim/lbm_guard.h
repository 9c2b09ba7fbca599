// The guard of a simulation: once per frame the device looks over the moments of a whole state, and
// some frames later the host reads what they came to, without ever waiting.
#pragma once
#include "shared.h"
#include "sim/lbm.h"

typedef struct lbm_guard lbm_guard;

typedef struct lbm_guard_limits { // beyond these a state is spoilt: it is no air any more
    float speed;                  // cells a step
    float drift;                  // of the mass, either way, as a part of it
} lbm_guard_limits;

enum { LBM_NOTES = 2 };
extern const kernel_table lbm_guard_kernel_table;

typedef struct lbm_report { // of one kept state; lattice units
    uint64_t step;          // lbm_steps when it was recorded
    uint32_t cells;         // of air
    uint32_t bad;           // of these, whose moments are no numbers; they are left out below
    uint32_t spoilt;        // LBM_SPOILT_NUMBERS and others of shared.h; 0: it is not
    float speed;            // greatest; Mach number: times sqrt(3)
    uint32_t where[3];      // the cell in which it is that
    // Density - 1: how far the mass has drifted, and how much it is pressed together.
    float drift, least_density, most_density;
    float sum[LBM_MAX_SCALARS], least[LBM_MAX_SCALARS], most[LBM_MAX_SCALARS];
    uint32_t notes[LBM_NOTES]; // as they were then
} lbm_report;

lbm_guard *lbm_guard_create(arena *memory, const uint32_t size[3]);
bool lbm_guard_compile(lbm_guard *guard, shader_library *library, const shader_reader *reader);
bool lbm_guard_allocate(lbm_guard *guard, gpu *g); // pipelines and memory; again: does nothing
void lbm_guard_destroy(lbm_guard *guard, gpu *g);

// Inside a frame, once: looks at the newest moments that `l` has kept; if none, at nothing.
bool lbm_guard_record(lbm_guard *guard, gpu *g, const lbm *l, lbm_guard_limits limits);
// The newest report of a frame that has finished; false: there is none yet.
bool lbm_guard_read(lbm_guard *guard, gpu *g, lbm_report *out);
// On the device: the newest record, whose first word is `spoilt`. NULL: none was recorded.
gpu_buffer *lbm_guard_newest(const lbm_guard *guard);
// On the device: LBM_NOTES words, 0 at first, that others may write, and that come back with
// reports.
gpu_buffer *lbm_guard_notes(const lbm_guard *guard);
void lbm_guard_forget(lbm_guard *guard); // what was recorded so far: after a reset
