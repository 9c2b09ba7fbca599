// A session: one device that measures all rows.
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/run_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_FRAMES = 100000 };

#define HEX_8 "[0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f]"

// ---- life ---------------------------------------------------------------------------------------

static bool make_cache(bench_session *s) {
    char path[PATH_CAP];
    if (!bench_folder_make(path)) return false;
    const char *earlier = getenv("ROIL_CACHE_DIR");
    if (earlier) s->earlier_cache = mem_copy(earlier, strlen(earlier) + 1);
    s->cache = mem_copy(path, strlen(path) + 1);
    return setenv("ROIL_CACHE_DIR", path, 1) == 0 || err_set("%s: cannot be used", path);
}

// Restores the variable, so that later readers, such as the report of a sweep, do not create the
// folder again.
static void leave_cache(const bench_session *s) {
    if (s->earlier_cache)
        setenv("ROIL_CACHE_DIR", s->earlier_cache, 1);
    else
        unsetenv("ROIL_CACHE_DIR");
    bench_folder_remove(s->cache);
}

// Removes pictures of an earlier run, of other rows or by another program. The folder is the
// user's, so only names that this program gives are removed.
static bool forget_pictures(const bench_session *s) {
    static const char *const patterns[] = {"rows/[0-9][0-9][0-9][0-9].png",
                                           "reference/" HEX_8 HEX_8 HEX_8 HEX_8 "-*.png"};
    for (size_t i = 0; i < COUNT_OF(patterns); i++) {
        char pattern[PATH_CAP], folder[PATH_CAP];
        file_list files;
        if (!path_join(pattern, s->folder, patterns[i])) return false;
        path_folder(folder, pattern);
        if (!file_is_folder(folder)) continue;
        int opened = file_open_folder_inside(s->folder, pattern);
        if (opened < 0) return false;
        bool listed = file_glob(pattern, &files);
        for (size_t k = 0; listed && k < files.count; k++)
            unlinkat(opened, path_name(files.paths[k]), 0);
        close(opened);
        if (!listed) return false;
        file_list_free(&files);
    }
    return true;
}

bool bench_go_on(void *user, double done, double whole) {
    (void)done, (void)whole;
    return !bench_is_stopped(user);
}

bench_session *bench_open(const bench_session_desc *desc) {
    bench_session *s = mem_alloc(sizeof *s);
    s->desc = *desc;
    s->folder = mem_copy(desc->folder, strlen(desc->folder) + 1);
    bool done = file_make_folders(s->folder) && (desc->keep || forget_pictures(s)) &&
                (!desc->own_cache || make_cache(s));
    if (done)
        s->r = roil_create(&(roil_desc){.device = desc->device, .loading = bench_go_on, .user = s});
    if (s->r) return s;
    bench_close(s);
    return NULL;
}

void bench_close(bench_session *s) {
    if (!s) return;
    roil_destroy(s->r);
    if (s->cache) leave_cache(s);
    mem_free(s->cache);
    mem_free(s->earlier_cache);
    mem_free(s->folder);
    mem_free(s);
}

roil *bench_roil(bench_session *s) {
    return s->r;
}

bool bench_is_stopped(const bench_session *s) {
    return s->desc.stopped && s->desc.stopped(s->desc.user);
}

// ---- one row ------------------------------------------------------------------------------------

// Returns the frames whose time is within a range of seconds.
static bool resolve_frames(const bench_drawing *d, const bench_job *job, bench_row *row,
                           arena *memory) {
    roil_effect_info info = roil_get_info(d->effect);
    if (!(job->last > job->first)) return true;
    double first = ceil(job->first * info.fps - 1e-9), last = ceil(job->last * info.fps - 1e-9);
    double count = fmax(1, last - first);
    if (count > MAX_FRAMES)
        return err_set("%g to %g s are %.0f frames; at most %d are accepted", job->first, job->last,
                       count, MAX_FRAMES);
    row->frames = arena_alloc(memory, (size_t)count * sizeof *row->frames);
    row->frame_count = (size_t)count;
    for (size_t i = 0; i < row->frame_count; i++)
        row->frames[i] = info.first_frame + first + (double)i;
    return true;
}

static bool measure_drawing(bench_drawing *d, const bench_job *job, bench_row *row, arena *memory) {
    if (!resolve_frames(d, job, row, memory)) return false;
    if (!row->frame_count) return err_set("no frame is named");
    if (row->limit > 0) d->deadline = clock_seconds() + row->limit;
    return bench_measure_frames(d, job, row, memory);
}

static bool session_measure(bench_drawing *d, const bench_job *job, bench_row *row, arena *memory) {
    bench_session *s = d->session;
    switch (job->measure) {
    case BENCH_FRAMES:
        return bench_drawing_begin(s, row, d) && measure_drawing(d, job, row, memory);
    case BENCH_RELOAD:
        return bench_measure_reload(s, job, row, memory);
    case BENCH_START:
        return bench_measure_start(s, job, row, memory);
    }
    return false;
}

bool bench_measure_row(bench_session *s, const bench_job *job, bench_row *row, arena *memory) {
    bench_drawing d = {.session = s};
    row->message = "";
    bool done = session_measure(&d, job, row, memory);
    bench_drawing_end(&d);
    if (!done && (d.stopped || bench_is_stopped(s))) return err_set("interrupted");
    row->state = done ? BENCH_DONE : BENCH_FAILED;
    if (!done && d.expired) {
        row->state = BENCH_LIMIT;
        row->message = arena_format(memory, "took longer than %g s", row->limit);
    } else if (!done) {
        row->message = arena_string(memory, roil_error());
    }
    return !roil_is_lost(s->r) || err_set("%s: the device is lost", row->label);
}
