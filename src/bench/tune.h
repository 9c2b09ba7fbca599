// Tuning: which settings of an effect's quality are the cheapest within an error, or the best
// within a time. Every measurement is a row of results, so that a search goes on where it ended,
// and a report shows all that was tried.
#pragma once
#include "bench/run.h"
#include "bench/search.h"

typedef struct tune_axis { // a control and the values that it is tried with, cheap to dear
    const char *name;
    const char *values[SEARCH_MAX_RUNGS];
    size_t count, start; // start: where the search begins; what it is now, if that is there
    bool elsewhere;      // what it is now is not among the values
    size_t reference;    // what the effect at its highest quality has
} tune_axis;

// The axes of a loaded effect. `wanted`: names of controls, "steps" or "steps=16:32:64" with values
// from cheap to dear; none: all that are known to be of quality. False with a message.
bool tune_find_axes(roil_effect *e, const char *const *wanted, size_t wanted_count, arena *memory,
                    tune_axis out[SEARCH_MAX_AXES], size_t *count);

typedef enum tune_error { TUNE_FLIP, TUNE_PSNR } tune_error;

typedef struct tune_goal {
    bool by_error; // the cheapest with an error up to `limit` (FLIP; PSNR: from it on); else the
                   // best with a time up to it, milliseconds on the device
    double limit;
    tune_error error;
} tune_goal;

typedef struct tune_watcher { // all may be NULL
    void (*begin)(void *user, const bench_results *r, const tune_axis *axes, size_t count);
    // earlier: it was kept
    void (*result)(void *user, const bench_results *r, const bench_row *row, bool earlier);
    bool (*stopped)(void *user);
    void (*steps)(void *user, double done, double whole); // as roil_on_progress tells of them
    void *user;
} tune_watcher;

typedef struct tune_order {
    const char *effect, *folder, *device; // folder: of results
    tune_goal goal;
    const char *const *axes; // as tune_find_axes takes them
    size_t axis_count;
    uint32_t width, height, repeats;
    const double *frames; // NULL: three places spread over the effect
    size_t frame_count;
    const roil_setting *settings; // that all rows have
    size_t setting_count;
    uint32_t samples;     // above 0: errors are against path tracing
    double budget, limit; // seconds: of the search, of a row; 0: none
    bool resume;          // takes over the rows that `folder` has
    const char *preset;   // name; NULL: none is written
    tune_watcher watcher;
} tune_order;

typedef struct tune_result {
    tune_axis axes[SEARCH_MAX_AXES];
    size_t axis_count;
    size_t before, best;   // indices of rows
    bool within, complete; // the goal is kept; the search came to its end
} tune_result;

// `out` holds all rows, also when it ends early; bench_results_free it. False with a message when
// nothing was found.
bool bench_tune(const tune_order *order, bench_results *out, tune_result *result);

double tune_row_ms(const bench_results *r, const bench_row *row); // NAN: it was not measured
double tune_row_error(const bench_row *row, tune_error error);    // FLIP, or dB; NAN: not compared
