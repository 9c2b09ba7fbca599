// Measures one row: frames are drawn and timed, and their pictures compared with a reference.
#pragma once
#include "bench/results.h"

typedef struct bench_session bench_session; // a device, and the references that were drawn

typedef enum bench_measure {
    BENCH_FRAMES, // of an effect, drawn one after the other
    BENCH_RELOAD, // from the edit of a file to the first frame that shows it
    BENCH_START,  // of a new process of this program
} bench_measure;

typedef struct bench_session_desc {
    const char *device; // as in roil_desc
    const char *folder; // for thumbnails and pictures of references
    bool keep;          // pictures in the folder belong to this sweep; else they are removed
    double settle;      // seconds that a row is drawn before it is timed, so that clocks rise
    bool counters;      // draws another frame in which samples are counted
    uint32_t compared;  // frames of a row that are compared, evenly spaced; 0: the last one
    bool own_cache;     // uses an empty cache, so that each run compiles the same
    bool (*stopped)(void *user); // called between frames, files and steps; NULL: never
    void (*steps)(void *user, double done, double whole); // as roil_on_progress; may be NULL
    void *user;
} bench_session_desc;

bench_session *bench_open(const bench_session_desc *desc); // NULL with a message
void bench_close(bench_session *s);                        // NULL is allowed
roil *bench_roil(bench_session *s);

typedef struct bench_job { // what to measure, in addition to the row's own fields
    bench_measure measure;
    // The row that its pictures are compared with, with the same frames and size. NULL: none.
    const bench_row *reference;
    uint32_t samples;   // above 0: the reference is path traced
    double first, last; // seconds; last > first: the frames from `first` up to `last`
    // BENCH_RELOAD: a text in a copy of the effect's file, and the texts that replace it in turn.
    const char **edits;
    size_t edit_count; // including the first text
    // BENCH_START
    const char *command; // "check", "render"
    bool empty_cache;
} bench_job;

// Measures `row` and fills in its result, in `memory`. An effect that fails or takes too long is a
// result too: false only when the session cannot continue (the device is lost, or `stopped`
// returned true).
bool bench_measure_row(bench_session *s, const bench_job *job, bench_row *row, arena *memory);
bool bench_is_stopped(const bench_session *s); // by desc->stopped
