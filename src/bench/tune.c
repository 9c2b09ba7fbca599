// A search (search.h) whose points are rows: settings are measured as those of a sweep, against the
// effect at its highest quality or path traced.
//
// The hash of what is measured does not include the goal, so a second search for another goal takes
// over what the first has measured.
#include "bench/tune.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "bench/report.h"
#include "bench/sweep.h"
#include <math.h>
#include <string.h>

enum { PLACES = 3, RUN = 1, LONG_RUN = 8, MOST_COMPARED = 8, EFFECT_MAX = 16 << 20 };
// Limits of the measured relative noise of times.
static const double LEAST_NOISE = 0.01, MOST_NOISE = 0.2;
static const double SURE = 2.5;    // two rows are apart by so many times that by chance, rarely
static const double SETTLE = 0.25; // seconds that a row is drawn before it is timed

typedef struct tuning {
    const tune_order *order;
    tune_result *result;
    bench_results *results;
    bench_session *session;
    arena memory;
    search_desc search;
    bench_row reference;
    const double *frames;
    size_t frame_count;
    uint32_t compared;
    double start; // by clock_seconds
    size_t good;  // rows that were measured
    double noise; // sum of theirs
    bool failed;
} tuning;

// Where the device is the processor, uses its time per core, which is what a frame takes when
// nothing else runs. The clock would also measure other programs.
static const bench_figure *figure_of(const bench_results *r, const bench_row *row) {
    const bench_time *time = bench_main_time(row);
    return r->by_process ? bench_get_time(&row->cpu, "process") : time ? &time->ms : NULL;
}

double tune_row_ms(const bench_results *r, const bench_row *row) {
    const bench_figure *ms = row->state == BENCH_DONE ? figure_of(r, row) : NULL;
    if (!ms) return (double)NAN;
    return r->by_process && r->cores ? ms->median / r->cores : ms->median;
}

double tune_row_error(const bench_row *row, tune_error error) {
    if (!row->compared) return (double)NAN;
    return error == TUNE_FLIP ? row->flip : row->psnr;
}

// Converts PSNR to an error that falls to 0.
static double error_size(double value, tune_error error) {
    return error == TUNE_FLIP ? value : pow(10, -value / 20);
}

// ---- rows ---------------------------------------------------------------------------------------

static void add_setting(bench_settings *s, const char *name, const char *value) {
    s->items[s->count++] = (roil_setting){name, value};
}

// Returns the settings of all rows, then those of the axes that differ from the effect's.
static bench_settings settings_at(const tuning *t, const size_t *rungs, arena *memory) {
    const tune_order *o = t->order;
    bench_settings s = {arena_alloc(memory, (o->setting_count + SEARCH_MAX_AXES) * sizeof *s.items),
                        0};
    for (size_t i = 0; i < o->setting_count; i++)
        add_setting(&s, o->settings[i].name, o->settings[i].value);
    for (size_t i = 0; i < t->result->axis_count; i++) {
        const tune_axis *a = &t->result->axes[i];
        if (rungs[i] != a->start || a->elsewhere) add_setting(&s, a->name, a->values[rungs[i]]);
    }
    return s;
}

static const char *label_at(const tuning *t, const size_t *rungs, arena *memory) {
    const char *label = "";
    for (size_t i = 0; i < t->result->axis_count; i++)
        label = arena_format(memory, "%s%s%s %s", label, i ? ", " : "", t->result->axes[i].name,
                             t->result->axes[i].values[rungs[i]]);
    return label;
}

static bench_row plan_row(const tuning *t, const size_t *rungs, arena *memory) {
    const tune_order *o = t->order;
    bench_row row = {
        .index = t->results->row_count,
        .label = label_at(t, rungs, memory),
        .effect = o->effect,
        .width = o->width,
        .height = o->height,
        .frames = arena_copy(memory, t->frames, t->frame_count * sizeof *t->frames),
        .frame_count = t->frame_count,
        .repeats = o->repeats,
        .limit = o->limit,
        .settings = settings_at(t, rungs, memory),
        .message = "",
    };
    row.axes.items = arena_alloc(memory, t->result->axis_count * sizeof *row.axes.items);
    for (size_t i = 0; i < t->result->axis_count; i++)
        add_setting(&row.axes, t->result->axes[i].name, t->result->axes[i].values[rungs[i]]);
    return row;
}

static const bench_row *find_row(const tuning *t, const size_t *rungs) {
    for (size_t i = 0; i < t->results->row_count; i++) {
        const bench_row *row = &t->results->rows[i];
        bool same = true;
        for (size_t k = 0; same && k < t->result->axis_count; k++) {
            const char *value = bench_axis_value(row, t->result->axes[k].name);
            same = value && strcmp(value, t->result->axes[k].values[rungs[k]]) == 0;
        }
        if (same) return row;
    }
    return NULL;
}

static bool may_go_on(tuning *t) {
    const tune_order *o = t->order;
    bool late = t->good && o->budget > 0 && clock_seconds() - t->start > o->budget;
    return !late && !bench_is_stopped(t->session);
}

static bool measure_row(tuning *t, const size_t *rungs) {
    arena memory = {0};
    bench_row row = plan_row(t, rungs, &memory);
    bench_job job = {
        .measure = BENCH_FRAMES, .reference = &t->reference, .samples = t->order->samples};
    bool done = bench_measure_row(t->session, &job, &row, &memory);
    if (done) {
        bench_add(t->results, &row);
        done = bench_write(t->results, t->order->folder);
    }
    t->failed = t->failed || (!done && !bench_is_stopped(t->session));
    arena_free(&memory);
    return done;
}

// Returns how much the time of one frame differs between repeats, as the median of all frames; 0:
// unknown.
static double noise_of(const bench_results *r, const bench_row *row) {
    const bench_figure *ms = figure_of(r, row);
    size_t frames = row->frame_count;
    if (!ms || !ms->values || row->repeats < 2 || ms->count != frames * row->repeats) return 0;
    double sum = 0;
    for (size_t i = 0; i < frames; i++) {
        double a = ms->values[i], b = ms->values[i + frames];
        sum += fabs(a - b) / fmax(0.5 * (a + b), 1e-9);
    }
    return sum / (double)frames / sqrt((double)ms->count);
}

// Every row shows how noisy times are; the first one shows whether there is anything to search.
static bool tuning_learn(tuning *t, const bench_row *row) {
    bool good = row->compared && !isnan(tune_row_ms(t->results, row));
    if (good) {
        t->noise += noise_of(t->results, row);
        t->good++;
        double apart = SURE * t->noise / (double)t->good;
        t->search.noise = fmin(fmax(apart, LEAST_NOISE), MOST_NOISE);
    }
    if (t->good) return true;
    t->failed = true;
    return err_set("%s", row->message[0] ? row->message : "the device does not tell times");
}

static bool tuning_measure(void *user, search_point *p) {
    tuning *t = user;
    const tune_watcher *w = &t->order->watcher;
    const tune_error kind = t->order->goal.error;
    const bench_row *row = find_row(t, p->rungs);
    bool earlier = row != NULL;
    if (!row && (!may_go_on(t) || !measure_row(t, p->rungs))) return false;
    if (!row) row = find_row(t, p->rungs);
    double ms = tune_row_ms(t->results, row);
    p->cost = p->error = (double)INFINITY;
    if (row->compared && !isnan(ms)) {
        p->cost = ms;
        p->error = error_size(tune_row_error(row, kind), kind);
    }
    if (w->result) w->result(w->user, t->results, row, earlier);
    return tuning_learn(t, row);
}

// ---- what is measured ---------------------------------------------------------------------------

static bool has_memory(roil_effect *e) { // passes that need the frames before
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        if (!c.parameter && strncmp(c.group, "accumulate", 10) == 0) return true;
    }
    return false;
}

// Chooses runs of frames that end at frames spread over the effect; the last frame of each is
// compared.
static void choose_frames(tuning *t, roil_effect *e) {
    const tune_order *o = t->order;
    t->frames = o->frames;
    t->frame_count = o->frame_count;
    t->compared = (uint32_t)(o->frame_count < MOST_COMPARED ? o->frame_count : MOST_COMPARED);
    if (o->frame_count) return;
    roil_effect_info info = roil_get_info(e);
    uint32_t run = has_memory(e) ? LONG_RUN : RUN, places = PLACES;
    if (info.frames < PLACES * run) {
        run = info.frames < LONG_RUN ? info.frames : LONG_RUN;
        places = 1;
    }
    double *all = arena_alloc(&t->memory, (size_t)run * places * sizeof *all);
    for (uint32_t i = 0; i < places; i++) {
        double part = (i + 0.5 + 0.3) / places; // somewhat late: at first there is little to see
        double last = fmax(floor(part * (info.frames - 1)), run - 1);
        for (uint32_t k = 0; k < run; k++)
            all[t->frame_count++] = info.first_frame + last - (run - 1 - k);
    }
    t->frames = all;
    t->compared = places;
}

static void plan_reference(tuning *t) {
    size_t rungs[SEARCH_MAX_AXES];
    for (size_t i = 0; i < t->result->axis_count; i++)
        rungs[i] = t->order->samples ? t->result->axes[i].start : t->result->axes[i].reference;
    t->reference = plan_row(t, rungs, &t->memory);
}

static bool tuning_plan(tuning *t) {
    const tune_order *o = t->order;
    roil *r = roil_create(&(roil_desc){.no_device = true});
    roil_effect *e = r ? roil_load(r, o->effect, o->settings, o->setting_count) : NULL;
    bool done = e && tune_find_axes(e, o->axes, o->axis_count, &t->memory, t->result->axes,
                                    &t->result->axis_count);
    if (done) choose_frames(t, e);
    roil_unload(e);
    roil_destroy(r);
    if (!done) return false;
    plan_reference(t);
    t->search = (search_desc){.axis_count = t->result->axis_count,
                              .by_error = o->goal.by_error,
                              .limit = o->goal.limit,
                              .noise = LEAST_NOISE,
                              .measure = tuning_measure,
                              .user = t};
    if (o->goal.by_error) t->search.limit = error_size(o->goal.limit, o->goal.error);
    for (size_t i = 0; i < t->result->axis_count; i++)
        t->search.axes[i] = (search_axis){t->result->axes[i].count, t->result->axes[i].start};
    return true;
}

// ---- results ------------------------------------------------------------------------------------

static const char *content_of(const tuning *t) {
    const tune_order *o = t->order;
    void *data;
    size_t size;
    double numbers[] = {o->width, o->height, o->repeats, o->samples, t->compared};
    hash128 h = hash_combine(hash_bytes(numbers, sizeof numbers),
                             hash_bytes(t->frames, t->frame_count * sizeof *t->frames));
    if (file_read(o->effect, EFFECT_MAX, &data, &size)) {
        h = hash_combine(h, hash_bytes(data, size));
        mem_free(data);
    }
    for (size_t i = 0; i < o->setting_count; i++)
        h = hash_add_text(hash_add_text(h, o->settings[i].name), o->settings[i].value);
    for (size_t i = 0; i < t->reference.axes.count; i++)
        h = hash_add_text(hash_add_text(h, t->reference.axes.items[i].name),
                          t->reference.axes.items[i].value);
    char hex[33];
    hash_to_hex(h, hex);
    return arena_string(&t->results->memory, hex);
}

static const char *goal_text(const tune_goal *g, arena *memory) {
    if (!g->by_error) return arena_format(memory, "the least error in %g ms", g->limit);
    return g->error == TUNE_FLIP
               ? arena_format(memory, "the least time within FLIP %g", g->limit)
               : arena_format(memory, "the least time from PSNR %g dB on", g->limit);
}

static void tuning_describe(tuning *t) {
    bench_results *r = t->results;
    roil *device = bench_roil(t->session);
    arena *memory = &r->memory;
    r->version = arena_string(memory, roil_version());
    r->commit = bench_commit(roil_home(device), memory);
    r->sweep = "tune";
    r->title = arena_format(memory, "%s: %s", path_name(t->order->effect),
                            goal_text(&t->order->goal, memory));
    r->file = arena_string(memory, t->order->effect);
    r->content = content_of(t);
    r->device = arena_string(memory, roil_device_name(device));
    r->driver = arena_string(memory, roil_device_driver(device));
    r->by_process = roil_is_software(device);
    bench_describe_machine(r);
    r->axes = arena_alloc(memory, t->result->axis_count * sizeof *r->axes);
    for (size_t i = 0; i < t->result->axis_count; i++) {
        tune_axis *a = &t->result->axes[i];
        bench_add_axis(r, &(sweep_axis){a->name, a->name, a->values, a->count});
    }
    r->has_reference = true;
    r->reference.traced = t->order->samples > 0;
    r->reference.samples = t->order->samples;
    r->reference.settings.items =
        arena_alloc(memory, t->reference.axes.count * sizeof(roil_setting));
    for (size_t i = 0; !t->order->samples && i < t->reference.axes.count; i++)
        add_setting(&r->reference.settings, arena_string(memory, t->reference.axes.items[i].name),
                    arena_string(memory, t->reference.axes.items[i].value));
}

// ---- the search ---------------------------------------------------------------------------------

static bool write_preset(tuning *t, const size_t *rungs) {
    const tune_order *o = t->order;
    if (!o->preset) return true;
    arena memory = {0};
    bench_settings s = settings_at(t, rungs, &memory);
    roil_effect *e = roil_load(bench_roil(t->session), o->effect, s.items, s.count);
    bool done = e && roil_write_preset(e, o->preset);
    roil_unload(e);
    arena_free(&memory);
    return done;
}

static bool tuning_search(tuning *t) {
    const tune_watcher *w = &t->order->watcher;
    tune_result *result = t->result;
    if (w->begin) w->begin(w->user, t->results, result->axes, result->axis_count);
    search_result found;
    if (!search_run(&t->search, &found) || t->failed)
        return t->failed ? false : err_set("nothing was measured: interrupted, or out of time");
    result->before = find_row(t, found.start.rungs)->index;
    result->best = find_row(t, found.best.rungs)->index;
    result->within = found.within;
    result->complete = found.complete;
    t->results->tuned = true;
    t->results->before = result->before;
    t->results->chosen = result->best;
    return bench_write(t->results, t->order->folder) &&
           bench_report(t->results, t->order->folder, roil_home(bench_roil(t->session))) &&
           (!result->within || write_preset(t, found.best.rungs));
}

bool bench_tune(const tune_order *order, bench_results *out, tune_result *result) {
    tuning t = {.order = order, .result = result, .results = out, .start = clock_seconds()};
    *out = (bench_results){0};
    *result = (tune_result){0};
    bool done = tuning_plan(&t);
    if (done)
        t.session = bench_open(&(bench_session_desc){.device = order->device,
                                                     .folder = order->folder,
                                                     .keep = order->resume,
                                                     .settle = SETTLE,
                                                     .compared = t.compared,
                                                     .stopped = order->watcher.stopped,
                                                     .steps = order->watcher.steps,
                                                     .user = order->watcher.user});
    done = t.session != NULL;
    if (done) {
        tuning_describe(&t);
        done = (!order->resume ||
                bench_take_earlier(out, order->folder,
                                   "another effect, or of other options; search again without "
                                   "--resume, or into another folder",
                                   false)) &&
               bench_write(out, order->folder) && tuning_search(&t);
    }
    bench_close(t.session);
    arena_free(&t.memory);
    return done;
}
