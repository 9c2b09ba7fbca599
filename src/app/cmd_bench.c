// roil bench SWEEP.lua: measures a sweep, row by row.
#include "app/app.h"
#include "app/bench_print.h"
#include "app/device_options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/report.h"
#include "bench/sweep.h"
#include <popt.h>
#include <stdio.h>
#include <string.h>

enum { OPTION_SIZE = 1, OPTION_ONLY, OPTION_SHARD };

typedef struct bench_options {
    bench_order order;
    app_frames frames;
    const char *baseline;
    const char *report; // folder of results that only get a new report
    roil_setting *only;
    size_t only_count, only_capacity;
    const char **inputs; // a sweep, or folders to be merged
    size_t input_count, input_capacity;
    char folder[PATH_CAP]; // where results go by default
    double margin;         // percent
    int resume, list, merge, strict, no_reference;
    app_progress progress, steps;
    int label_width;
} bench_options;

// ---- options ------------------------------------------------------------------------------------

static bool add_only(bench_options *o, char *text) {
    char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return err_set("--only '%s'; accepted: AXIS=VALUE, as noise=perlin", text);
    *equals = '\0';
    *MEM_ADD(o->only, o->only_count, o->only_capacity) = (roil_setting){text, equals + 1};
    return true;
}

static bool take_option(void *user, int option, char *text) {
    bench_options *o = user;
    switch (option) {
    case OPTION_SIZE:
        return app_parse_size(text, &o->order.options.width, &o->order.options.height);
    case OPTION_ONLY:
        return add_only(o, text);
    case OPTION_SHARD:
        return app_parse_shard(text, &o->order.choice.shard, &o->order.choice.shards);
    }
    return true;
}

static bool take_numbers(bench_options *o) {
    sweep_options *s = &o->order.options;
    if (s->warmup > 1000) return err_set("--warmup %d; accepted: 0 to 1000 frames", s->warmup);
    if (s->repeats == 0 || s->repeats > 100000)
        return err_set("--repeats %d; accepted: 1 to 100000", s->repeats);
    if (!(o->margin >= 0 && o->margin <= 1000))
        return err_set("--margin %g; accepted: 0 to 1000 percent", o->margin);
    if (!o->frames.count) return true;
    if (o->frames.count > SWEEP_MAX_FRAMES)
        return err_set("--frames: %zu frames; at most %d are accepted", o->frames.count,
                       SWEEP_MAX_FRAMES);
    s->frames = o->frames.numbers;
    s->frame_count = o->frames.count;
    return true;
}

static bool take_inputs(bench_options *o, poptContext context) {
    const char *input;
    while ((input = poptGetArg(context))) {
        *MEM_ADD(o->inputs, o->input_count, o->input_capacity) = input;
    }
    if (o->merge && (!o->input_count || !o->order.folder))
        return err_set("usage: roil bench --merge DIR... -o DIR");
    if (o->report && o->input_count) return err_set("'%s': --report takes no sweep", o->inputs[0]);
    if (o->merge || o->report) return true;
    if (!o->input_count)
        return err_set(
            "which sweep? usage: roil bench SWEEP.lua [options]; scripts/bench has some");
    if (o->input_count > 1) return err_set("'%s': one sweep at a time", o->inputs[1]);
    o->order.file = o->inputs[0];
    int length;
    const char *name = path_stem(o->order.file, &length);
    snprintf(o->folder, sizeof o->folder, "out/bench/%.*s", length, name);
    if (!o->order.folder) o->order.folder = o->folder;
    return true;
}

static bool bench_check(void *user, poptContext arguments) {
    bench_options *o = user;
    o->order.resume = o->resume;
    o->order.options.no_reference = o->no_reference;
    o->order.choice.only = o->only;
    o->order.choice.only_count = o->only_count;
    return take_numbers(o) && take_inputs(o, arguments);
}

// ---- progress -----------------------------------------------------------------------------------

static void on_begin(void *user, const sweep *s, size_t total) {
    bench_options *o = user;
    app_print(stdout, "%s: %zu of %zu rows\n", s->title, total, s->row_count);
    app_progress_begin(&o->progress, total, "rows");
    o->label_width = bench_label_width(s->rows, s->row_count);
}

static void on_row(void *user, const bench_row *row, size_t done) {
    bench_options *o = user;
    app_progress_step(&o->progress, done);
    if (o->progress.terminal) app_print(stderr, "  %.40s", row->label);
}

static void on_result(void *user, const bench_row *row, size_t done) {
    (void)done;
    bench_options *o = user;
    app_progress_clear(&o->progress);
    bench_print_line(row, o->label_width);
    fflush(stdout);
}

// ---- work ---------------------------------------------------------------------------------------

static int bench_list_rows(const bench_options *o) {
    arena memory = {0};
    sweep s;
    bool *chosen = NULL;
    if (bench_read_sweep(&o->order, &memory, &s)) chosen = bench_choose(&s, &o->order.choice);
    for (size_t i = 0; chosen && i < s.row_count; i++)
        if (chosen[i]) app_print(stdout, "%s\n", s.rows[i].label);
    int status = chosen ? APP_DONE : app_fail_input();
    mem_free(chosen);
    arena_free(&memory);
    return status;
}

// `*slower` receives how many rows became slower than the baseline, if there is one.
static bool compare_with_baseline(const bench_options *o, const bench_results *now,
                                  size_t *slower) {
    bench_results before;
    *slower = 0;
    if (!o->baseline) return true;
    bool folder = file_is_folder(o->baseline);
    if (!(folder ? bench_read(o->baseline, &before) : bench_read_file(o->baseline, &before)))
        return false;
    *slower = bench_print_changes(&before, now, o->margin / 100);
    bench_results_free(&before);
    return true;
}

static size_t count_failed(const bench_results *r) {
    size_t count = 0;
    for (size_t i = 0; i < r->row_count; i++) count += r->rows[i].state == BENCH_FAILED;
    return count;
}

static bool write_report(const bench_results *results, const char *folder) {
    roil *r = roil_create(&(roil_desc){.no_device = true});
    bool done = r && bench_report(results, folder, roil_home(r));
    roil_destroy(r);
    return done;
}

static int bench_finish(const bench_options *o, const bench_results *r) {
    size_t failed = count_failed(r), slower;
    bench_print_table(r);
    if (!compare_with_baseline(o, r, &slower) || !write_report(r, o->order.folder))
        return app_fail_input();
    app_print(stdout, "\nwrote %s/results.json, results.csv, report.html\n", o->order.folder);
    if (failed) return app_fail(APP_BAD_INPUT, "%zu of %zu rows failed", failed, r->row_count);
    if (slower && o->strict)
        return app_fail(APP_DIFFERS, "%zu rows are slower than in %s", slower, o->baseline);
    return APP_DONE;
}

static void on_steps(void *user, double done, double whole) {
    app_tell_steps(&((bench_options *)user)->steps, done, whole);
}

static int bench_run_sweep(bench_options *o) {
    bench_results results;
    if (o->order.folder == o->folder && !app_may_write_here(o->folder)) return app_fail_input();
    o->order.watcher =
        (bench_watcher){on_begin, on_row, on_result, app_is_interrupted, on_steps, o};
    app_hear_interrupts();
    bool done = bench_run(&o->order, &results);
    if (o->progress.total) app_progress_clear(&o->progress);
    int status;
    if (done)
        status = bench_finish(o, &results);
    else if (app_is_interrupted(NULL) && results.content)
        status = app_fail(APP_BAD_INPUT, "interrupted; %s has %zu rows, and --resume goes on",
                          o->order.folder, results.row_count);
    else
        status = app_fail_input();
    bench_results_free(&results);
    return status;
}

static int bench_merge_files(const bench_options *o) {
    bench_results results;
    bool done = bench_merge(o->inputs, o->input_count, o->order.folder, &results);
    int status = done ? bench_finish(o, &results) : app_fail_input();
    bench_results_free(&results);
    return status;
}

static int bench_write_report(const bench_options *o) {
    bench_results results;
    if (!bench_read(o->report, &results)) return app_fail_input();
    int status = write_report(&results, o->report) ? APP_DONE : app_fail_input();
    bench_results_free(&results);
    if (status == APP_DONE) app_print(stdout, "wrote %s/report.html\n", o->report);
    return status;
}

static int bench_do(void *user) {
    bench_options *o = user;
    return o->report  ? bench_write_report(o)
           : o->merge ? bench_merge_files(o)
           : o->list  ? bench_list_rows(o)
                      : bench_run_sweep(o);
}

int cmd_bench(int argc, const char **argv) {
    bench_options o = {.margin = 3};
    sweep_options *s = &o.order.options;
    *s = (sweep_options){.warmup = -1, .repeats = -1, .limit = -1, .settle = -1};
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, &o.order.folder, 0,
         "folder of the results (default: out/bench/NAME)", "DIR"},
        {"list", 0, POPT_ARG_NONE, &o.list, 0, "list the rows and measure nothing", NULL},
        {"rows", 0, POPT_ARG_STRING, &o.order.choice.rows, 0,
         "only rows whose label matches ('steps 16*')", "PATTERN"},
        {"only", 0, POPT_ARG_STRING, NULL, OPTION_ONLY,
         "only rows with this value of an axis; may be given several times", "AXIS=VALUE"},
        {"shard", 0, POPT_ARG_STRING, NULL, OPTION_SHARD, "only every N-th row, from the I-th",
         "I/N"},
        {"merge", 0, POPT_ARG_NONE, &o.merge, 0, "combine the results of shards", NULL},
        {"resume", 0, POPT_ARG_NONE, &o.resume, 0, "keep the rows that are in DIR already", NULL},
        {"baseline", 0, POPT_ARG_STRING, &o.baseline, 0,
         "report what is faster or slower than in these results", "DIR|FILE.json"},
        {"report", 0, POPT_ARG_STRING, &o.report, 0,
         "write the report of these results again, and measure nothing", "DIR"},
        {"margin", 0, POPT_ARG_DOUBLE, &o.margin, 0,
         "changes up to this are noise, whatever statistics say (default: 3)", "PERCENT"},
        {"strict", 0, POPT_ARG_NONE, &o.strict, 0,
         "end with status 3 when a row is slower than its baseline", NULL},
        {"size", 's', POPT_ARG_STRING, NULL, OPTION_SIZE,
         "size of pictures instead of the sweep's; an axis of sizes is scaled to it", "WxH"},
        {"frames", 'f', POPT_ARG_STRING, NULL, APP_FRAMES, "frames instead of the sweep's",
         "FRAMES"},
        {"warmup", 0, POPT_ARG_INT, &s->warmup, 0, "frames that are drawn before the first one",
         "N"},
        {"repeats", 0, POPT_ARG_INT, &s->repeats, 0, "how often each row is measured", "N"},
        {"limit", 0, POPT_ARG_DOUBLE, &s->limit, 0, "time limit of a row; 0: none", "SECONDS"},
        {"settle", 0, POPT_ARG_DOUBLE, &s->settle, 0,
         "how long a row is drawn before it is timed, so that clocks rise", "SECONDS"},
        {"no-reference", 0, POPT_ARG_NONE, &o.no_reference, 0,
         "draw no references, and compare no pictures", NULL},
        APP_DEVICE_ROW(&o.order.device),
        APP_MEMORY_ROW(&o.order.memory),
        POPT_AUTOHELP POPT_TABLEEND};
    int status = app_run(argc, argv, "roil bench", "SWEEP.lua [options]", options,
                         &(app_task){.job = &o,
                                     .check = bench_check,
                                     .run = bench_do,
                                     .take = take_option,
                                     .frames = &o.frames});
    mem_free(o.only);
    mem_free(o.inputs);
    return status;
}
