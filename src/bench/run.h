// Measuring one row: frames drawn and timed, their pictures compared with a reference.
#pragma once
#include "bench/results.h"

typedef struct bench_session bench_session; // a device, and the references that were made

typedef enum bench_measure {
    BENCH_FRAMES, // of an effect, drawn one after the other
    BENCH_RELOAD, // from the edit of a file to the first frame that shows it
    BENCH_START,  // of a new process of this program
} bench_measure;

typedef struct bench_session_desc {
    const char *device; // as roil_desc has it
    const char *folder; // where thumbnails and pictures of references go
    bool keep;          // pictures that lie there are of this sweep; else they are removed
    double settle;      // seconds that a row is drawn before it is timed, so that clocks rise
    bool counters;      // draws one more frame in which samples are counted
    uint32_t compared;  // frames of a row that are compared, spread evenly; 0: the last
    bool own_cache;     // an empty cache, so that what is new is new in every run
    bool (*stopped)(void *user); // asked between frames, files and steps; NULL: never
    void (*steps)(void *user, double done, double whole); // as roil_on_progress tells; may be NULL
    void *user;
} bench_session_desc;

bench_session *bench_open(const bench_session_desc *desc); // NULL with a message
void bench_close(bench_session *s);                        // NULL is fine
roil *bench_roil(bench_session *s);

typedef struct bench_job { // beside the row's own fields
    bench_measure measure;
    // What its pictures are compared with: a row of the same frames and size. NULL: not compared.
    const bench_row *reference;
    uint32_t samples;   // above 0: the reference is path traced
    double first, last; // seconds; last > first: the frames from `first` up to `last`
    // BENCH_RELOAD: the text that is replaced in a copy of the effect's file, and in turn by what.
    const char **edits;
    size_t edit_count; // the text itself included
    // BENCH_START
    const char *command; // "check", "render"
    bool empty_cache;
} bench_job;

// Fills what came out of `row`, in `memory`. An effect that fails or takes too long is a result,
// too: false only when the session cannot go on (the device is lost, or `stopped` said so).
bool bench_measure_row(bench_session *s, const bench_job *job, bench_row *row, arena *memory);
bool bench_is_stopped(const bench_session *s); // by desc->stopped
