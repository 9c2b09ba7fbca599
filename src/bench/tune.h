// Tuning: finds the settings of an effect's quality that are the cheapest within an error, or the
// best within a time. Every measurement is a row of results, so that a search can be resumed and a
// report shows everything that was tried.
#pragma once
#include "bench/run.h"
#include "bench/search.h"

typedef struct tune_axis { // a control and values to try, from cheap to expensive
    const char *name;
    const char *values[SEARCH_MAX_RUNGS];
    size_t count, start; // start: where the search begins, at the value of now if it is in the list
    bool elsewhere;      // the value of now is not in the list
    size_t reference;    // the value at the effect's highest quality
} tune_axis;

// Finds the axes of a loaded effect. `wanted`: names of controls, "steps" or "steps=16:32:64" with
// values from cheap to expensive; none: all controls that are known to affect quality. False with a
// message.
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
    // earlier: the row was kept from an earlier search
    void (*result)(void *user, const bench_results *r, const bench_row *row, bool earlier);
    bool (*stopped)(void *user);
    void (*steps)(void *user, double done, double whole); // as roil_on_progress
    void *user;
} tune_watcher;

typedef struct tune_order {
    const char *effect, *folder, *device; // folder: of results
    tune_goal goal;
    const char *const *axes; // as in tune_find_axes
    size_t axis_count;
    uint32_t width, height, repeats;
    const double *frames; // NULL: three frames spread over the effect
    size_t frame_count;
    const roil_setting *settings; // settings of all rows
    size_t setting_count;
    uint32_t samples;     // above 0: the reference is path traced
    double budget, limit; // seconds for the search, and for a row; 0: no limit
    bool resume;          // uses the rows in `folder`
    const char *preset;   // name of the preset to write; NULL: none
    tune_watcher watcher;
} tune_order;

typedef struct tune_result {
    tune_axis axes[SEARCH_MAX_AXES];
    size_t axis_count;
    size_t before, best;   // indices of rows
    bool within, complete; // the goal is reached; the search came to its end
} tune_result;

// Runs a search. `out` has all rows, also when it ends early; free it with bench_results_free.
// False with a message when nothing was found.
bool bench_tune(const tune_order *order, bench_results *out, tune_result *result);

double tune_row_ms(const bench_results *r, const bench_row *row); // NAN: not measured
double tune_row_error(const bench_row *row, tune_error error);    // FLIP, or dB; NAN: not compared
