// Draws an effect for a row: times of passes and frames, counted samples, pictures.
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/run_parts.h"
#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { MAX_PASSES = 256, MAX_COUNTERS = 64, MAX_SETTLING = 10000 };

// ---- frames -------------------------------------------------------------------------------------

static bool may_go_on(bench_drawing *d) {
    d->stopped = d->stopped || bench_is_stopped(d->session);
    d->expired = d->deadline > 0 && clock_seconds() > d->deadline;
    return !d->stopped && !d->expired;
}

static bool on_progress(void *user, double done, double whole) {
    const bench_session_desc *desc = &((bench_drawing *)user)->session->desc;
    if (desc->steps) desc->steps(desc->user, done, whole);
    return may_go_on(user);
}

bool bench_drawing_begin(bench_session *s, const bench_row *row, bench_drawing *out) {
    *out = (bench_drawing){.session = s, .row = row};
    out->effect =
        roil_load_inside(s->r, row->inside, row->effect, row->settings.items, row->settings.count);
    if (!out->effect) return false;
    roil_on_progress(out->effect, on_progress, out);
    return roil_prepare(out->effect, row->width, row->height);
}

void bench_drawing_end(bench_drawing *d) {
    roil_unload(d->effect);
    d->effect = NULL;
}

bool bench_draw(bench_drawing *d, double frame) {
    return may_go_on(d) && roil_render(d->effect, frame);
}

// Waits for the frame, because an unlimited queue of frames would run long after a time limit.
static bool draw_and_wait(bench_drawing *d, double frame) {
    roil_time times[MAX_PASSES];
    if (!bench_draw(d, frame)) return false;
    roil_times(d->effect, times, MAX_PASSES);
    return true;
}

bool bench_draw_warmup(bench_drawing *d) {
    double first = d->row->frames[0], begin = roil_get_info(d->effect).first_frame;
    for (double frame = first - d->row->warmup; frame < first; frame++)
        if (frame >= begin && !draw_and_wait(d, frame)) return false;
    return true;
}

// Draws the row's frames again and again, at least one: the first frame of an effect uploads data
// and compiles what the driver has postponed, and clocks rise only under load.
static bool drawing_settle(bench_drawing *d) {
    double end = clock_seconds() + d->session->desc.settle;
    size_t drawn = 0;
    do {
        if (!draw_and_wait(d, d->row->frames[drawn % d->row->frame_count])) return false;
        drawn++;
    } while (clock_seconds() < end && drawn < MAX_SETTLING);
    return true;
}

bool bench_is_compared(const bench_session *s, const bench_row *row, size_t i) {
    size_t count = row->frame_count, wanted = s->desc.compared ? s->desc.compared : 1;
    if (wanted > count) wanted = count;
    for (size_t k = 0; k < wanted; k++)
        if ((k + 1) * count / wanted - 1 == i) return true;
    return false;
}

// ---- one frame ----------------------------------------------------------------------------------

typedef struct record { // of the whole row
    bench_collection gpu, cpu;
    bench_picture *pictures; // of the frames that are compared; the last is that of the last frame
    size_t picture_count, picture_capacity;
} record;

static void free_pictures(record *r) {
    for (size_t i = 0; i < r->picture_count; i++) mem_free(r->pictures[i].pixels);
    r->picture_count = 0;
}

static void record_free(record *r) {
    free_pictures(r);
    mem_free(r->pictures);
    bench_collection_free(&r->gpu);
    bench_collection_free(&r->cpu);
}

static void record_passes(record *r, const roil_time *times, size_t count) {
    double all = 0;
    for (size_t i = 0; i < count; i++) {
        all += times[i].milliseconds;
        bench_collect(&r->gpu, times[i].pass, times[i].milliseconds);
    }
    bench_collect(&r->gpu, "all", all);
}

// Processor time of all threads, or of this one: on a busy machine steadier than the clock. That of
// all includes the device where the processor is the device.
static double processor_seconds(clockid_t threads) {
    struct timespec used;
    clock_gettime(threads, &used);
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

static bool record_frame(bench_drawing *d, double frame, record *r) {
    roil_time times[MAX_PASSES];
    double start = clock_seconds(), used = processor_seconds(CLOCK_PROCESS_CPUTIME_ID);
    double host = processor_seconds(CLOCK_THREAD_CPUTIME_ID);
    if (!bench_draw(d, frame)) return false;
    host = processor_seconds(CLOCK_THREAD_CPUTIME_ID) - host;
    double submitted = clock_seconds();
    size_t count = roil_times(d->effect, times, MAX_PASSES);
    double drawn = clock_seconds();
    if (!count) return roil_is_lost(d->session->r) ? err_set("the device is lost") : true;
    record_passes(r, times, count < MAX_PASSES ? count : MAX_PASSES);
    bench_collect(&r->cpu, "host", 1e3 * host);
    bench_collect(&r->cpu, "submit", 1e3 * (submitted - start));
    bench_collect(&r->cpu, "frame", 1e3 * (drawn - start));
    bench_collect(&r->cpu, "process", 1e3 * (processor_seconds(CLOCK_PROCESS_CPUTIME_ID) - used));
    return true;
}

static bool keep_picture(bench_drawing *d, record *r) {
    bench_picture p;
    if (!bench_picture_read(d->effect, d->row->width, d->row->height, &p)) return false;
    *MEM_ADD(r->pictures, r->picture_count, r->picture_capacity) = p;
    return true;
}

static bool record_frames(bench_drawing *d, record *r) {
    const bench_row *row = d->row;
    bool done = drawing_settle(d);
    for (uint32_t repeat = 0; done && repeat < row->repeats; repeat++) {
        done = bench_draw_warmup(d);
        free_pictures(r);
        for (size_t i = 0; done && i < row->frame_count; i++)
            done = record_frame(d, row->frames[i], r) &&
                   (!bench_is_compared(d->session, row, i) || keep_picture(d, r));
    }
    return done;
}

// ---- the row ------------------------------------------------------------------------------------

static uint64_t resident_bytes(void) {
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file) return 0;
    if (fscanf(file, "%*u %llu", &pages) != 1) pages = 0;
    fclose(file);
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

static void measure_memory(bench_session *s, bench_row *row) {
    roil_memory m = roil_get_memory(s->r);
    row->device_bytes = m.device;
    row->reserved_bytes = m.reserved;
    row->host_bytes = resident_bytes();
}

static bool read_counters(bench_drawing *d, bench_row *row, arena *memory) {
    roil_time times[1];
    roil_counter counters[MAX_COUNTERS];
    if (!bench_draw(d, row->frames[row->frame_count - 1])) return false;
    roil_times(d->effect, times, 1);
    size_t count = roil_counters(d->effect, counters, MAX_COUNTERS);
    if (count > MAX_COUNTERS) count = MAX_COUNTERS;
    row->counters.items = arena_alloc(memory, count * sizeof *row->counters.items);
    row->counters.count = count;
    for (size_t i = 0; i < count; i++)
        row->counters.items[i] =
            (sweep_number){arena_format(memory, "%s.%s", counters[i].pass, counters[i].name),
                           (double)counters[i].value};
    return true;
}

// Counts in a frame of its own, since counting takes time.
static bool count_samples(bench_drawing *timed, bench_row *row, arena *memory) {
    bench_session *s = timed->session;
    bench_drawing d;
    roil_set_counters(s->r, true);
    bool done = bench_drawing_begin(s, row, &d) && read_counters(&d, row, memory);
    timed->stopped = timed->stopped || d.stopped;
    bench_drawing_end(&d);
    roil_set_counters(s->r, false);
    return done;
}

static bool save_thumbnail(bench_session *s, bench_row *row, const bench_picture *p,
                           arena *memory) {
    char file[PATH_CAP];
    const char *name = arena_format(memory, "rows/%04zu.png", row->index);
    if (!path_join(file, s->folder, name) || !bench_picture_save_small(p, s->folder, file))
        return false;
    row->thumbnail = name;
    return true;
}

bool bench_measure_frames(bench_drawing *d, const bench_job *job, bench_row *row, arena *memory) {
    record r = {0};
    bool done = record_frames(d, &r);
    row->gpu = bench_summarise(&r.gpu, memory);
    row->cpu = bench_summarise(&r.cpu, memory);
    measure_memory(d->session, row);
    row->inputs = arena_string(memory, roil_hash_inputs(d->effect));
    if (d->expired && row->gpu.count && !r.picture_count) keep_picture(d, &r);
    bench_drawing_end(d);
    if (r.picture_count && (done || d->expired))
        done = save_thumbnail(d->session, row, &r.pictures[r.picture_count - 1], memory) && done;
    if (done && d->session->desc.counters) done = count_samples(d, row, memory);
    if (done && job->reference)
        done = bench_compare_row(d->session, job, row, r.pictures, r.picture_count);
    record_free(&r);
    return done;
}
