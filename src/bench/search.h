// Finding the best settings where each measurement is dear: the cheapest within an error, or the
// best within a cost. Knows numbers only; what they stand for is tune.c's.
#pragma once
#include <stdbool.h>
#include <stddef.h>

enum { SEARCH_MAX_AXES = 16, SEARCH_MAX_RUNGS = 16, SEARCH_MAX_POINTS = 512 };

typedef struct search_axis { // rungs go from the cheapest and worst to the dearest and best
    size_t count, start;
} search_axis;

typedef struct search_point {
    size_t rungs[SEARCH_MAX_AXES];
    double cost, error; // INFINITY: it could not be measured
} search_point;

typedef struct search_desc {
    search_axis axes[SEARCH_MAX_AXES];
    size_t axis_count;
    bool by_error; // the cheapest with an error up to `limit`; else the best with a cost up to it
    double limit;
    double noise; // costs nearer to each other than this part count as equal
    // Fills cost and error of a point that was not asked for before; false ends the search.
    bool (*measure)(void *user, search_point *point);
    void *user;
} search_desc;

typedef struct search_result {
    search_point start, best;
    bool within;   // `best` keeps the limit; else it is the nearest to that
    bool complete; // not ended by `measure` or by SEARCH_MAX_POINTS
    size_t count;  // points that were measured
} search_result;

// False when not even the start could be asked for.
bool search_run(const search_desc *desc, search_result *out);
