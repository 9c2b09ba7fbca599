// Shared by the parts of a session.
#pragma once
#include "base/file.h"
#include "bench/run.h"

struct bench_session {
    bench_session_desc desc;
    char *folder, *cache; // cache: a temporary folder, or NULL
    char *earlier_cache;  // ROIL_CACHE_DIR before it; NULL: unset
    roil *r;
    bool stopped;
};

// Callback for roil_desc.loading and roil_on_progress. `user` is the session.
bool bench_go_on(void *user, double done, double whole);

// ---- series.c: collects values by name ----------------------------------------------------------

typedef struct bench_series {
    char name[64];
    double *values;
    size_t count, capacity;
} bench_series;
typedef struct bench_collection {
    bench_series *items;
    size_t count, capacity;
} bench_collection;
void bench_collect(bench_collection *c, const char *name, double value);
bench_times bench_summarise(const bench_collection *c, arena *memory);
void bench_collection_free(bench_collection *c);

// ---- picture.c ----------------------------------------------------------------------------------

typedef struct bench_picture { // RGBA, sRGB
    uint32_t width, height;
    uint8_t *pixels; // mem_free
} bench_picture;
bool bench_picture_read(roil_effect *e, uint32_t width, uint32_t height, bench_picture *out);
// Save to `file` below `folder`, that of the results, out of which no link may lead. A small
// picture is at most 320 pixels wide.
bool bench_picture_save_small(const bench_picture *p, const char *folder, const char *file);
bool bench_picture_save(const bench_picture *p, const char *folder, const char *file);
bool bench_picture_load(const char *folder, const char *file, bench_picture *out);
// Compares two pictures, and updates the row's figures, which are those of the worst frame.
bool bench_picture_compare(const bench_picture *a, const bench_picture *b, bench_row *row);

// ---- folder.c -----------------------------------------------------------------------------------

bool bench_folder_make(char out[PATH_CAP]); // creates a temporary folder
void bench_folder_remove(const char *folder);
// What is in the folder of `file`, which lies in `inside`, to another folder; links stay links.
bool bench_folder_copy(const char *inside, const char *file, const char *to);
// Runs a program to its end; what it says as errors goes to the file `log`.
bool bench_spawn(const char *const *arguments, const char *log, int *status);

// ---- draw.c -------------------------------------------------------------------------------------

typedef struct bench_drawing { // an effect that is being drawn
    bench_session *session;
    const bench_row *row;
    roil_effect *effect;
    double deadline;       // by clock_seconds; 0: none
    bool stopped, expired; // why a function returned false without a message
} bench_drawing;

bool bench_drawing_begin(bench_session *s, const bench_row *row, bench_drawing *out);
void bench_drawing_end(bench_drawing *d);
bool bench_draw(bench_drawing *d, double frame); // false also when it must stop
bool bench_draw_warmup(bench_drawing *d);        // draws the frames before the row's first frame
// Returns whether number `i` of the row's frames is compared.
bool bench_is_compared(const bench_session *s, const bench_row *row, size_t i);

// ---- the measures -------------------------------------------------------------------------------

// Measure a row and fill in its result. False with a message, or when the drawing stopped or
// expired.
bool bench_measure_frames(bench_drawing *d, const bench_job *job, bench_row *row, arena *memory);
bool bench_measure_reload(bench_session *s, const bench_job *job, bench_row *row, arena *memory);
bool bench_measure_start(bench_session *s, const bench_job *job, bench_row *row, arena *memory);
// Compares `pictures` (of the compared frames, in order) with those of the reference, which is
// drawn if it was not drawn before.
bool bench_compare_row(bench_session *s, const bench_job *job, bench_row *row,
                       const bench_picture *pictures, size_t count);
