// Finds the best settings when each measurement is expensive: the cheapest within an error, or the
// best within a cost. It knows only numbers; tune.c knows what they stand for.
#pragma once
#include <stdbool.h>
#include <stddef.h>

enum { SEARCH_MAX_AXES = 16, SEARCH_MAX_RUNGS = 16, SEARCH_MAX_POINTS = 512 };

typedef struct search_axis { // rungs go from the cheapest and worst to the most expensive and best
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
    double noise; // costs with a smaller relative difference count as equal
    // Measures a point and sets its cost and error; each point is measured once. False ends the
    // search.
    bool (*measure)(void *user, search_point *point);
    void *user;
} search_desc;

typedef struct search_result {
    search_point start, best;
    bool within;   // `best` is within the limit; else it is the nearest to it
    bool complete; // neither `measure` nor SEARCH_MAX_POINTS ended the search
    size_t count;  // points that were measured
} search_result;

// Runs the search. False when not even the start could be measured.
bool search_run(const search_desc *desc, search_result *out);
