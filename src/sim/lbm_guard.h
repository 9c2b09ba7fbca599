// Monitoring of a simulation: once per frame the device checks the moments of the whole state, and
// some frames later the host reads the result, without ever waiting.
#pragma once
#include "shared.h"
#include "sim/lbm.h"

typedef struct lbm_guard lbm_guard;

typedef struct lbm_guard_limits { // beyond these a state is spoilt: it is not air any more
    float speed;                  // cells per step
    float drift;                  // relative change of the mass, up or down
} lbm_guard_limits;

enum { LBM_NOTES = 2 };
extern const kernel_table lbm_guard_kernel_table;

typedef struct lbm_report { // a report on one kept state; lattice units
    uint64_t step;          // lbm_steps when it was recorded
    uint32_t cells;         // cells of air
    uint32_t bad;           // cells whose moments are not finite; they are left out below
    uint32_t spoilt;        // flags LBM_SPOILT_* of shared.h; 0: the state is good
    float speed;            // greatest speed; times sqrt(3) it is the Mach number
    uint32_t where[3];      // the cell with this speed
    // Density - 1: its mean, which is the drift of the mass, and its extremes.
    float drift, least_density, most_density;
    float sum[LBM_MAX_SCALARS], least[LBM_MAX_SCALARS], most[LBM_MAX_SCALARS];
    uint32_t notes[LBM_NOTES]; // lbm_guard_notes at that time
} lbm_report;

lbm_guard *lbm_guard_create(arena *memory, const uint32_t size[3]);
bool lbm_guard_compile(lbm_guard *guard, shader_library *library, const shader_reader *reader);
bool lbm_guard_allocate(lbm_guard *guard, gpu *g); // makes pipelines and memory, once
void lbm_guard_destroy(lbm_guard *guard, gpu *g);

// Checks the newest moments that `l` has kept, if there are any. Call it once, inside a frame.
bool lbm_guard_record(lbm_guard *guard, gpu *g, const lbm *l, lbm_guard_limits limits);
// Reads the newest report of a frame that has finished. False: there is none yet.
bool lbm_guard_read(lbm_guard *guard, gpu *g, lbm_report *out);
// Returns the newest record on the device, whose first word is `spoilt`. NULL: none was recorded.
gpu_buffer *lbm_guard_newest(const lbm_guard *guard);
// Returns LBM_NOTES words on the device, 0 at first, which other code may write. Reports contain
// them.
gpu_buffer *lbm_guard_notes(const lbm_guard *guard);
void lbm_guard_forget(lbm_guard *guard); // drops all records, after a reset
