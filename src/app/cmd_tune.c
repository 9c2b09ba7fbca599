// roil tune EFFECT.lua: searches settings of quality that are fast enough, and writes them as a
// preset.
#include "app/app.h"
#include "app/device_options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/tune.h"
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_SIZE = 1, OPTION_AXES, OPTION_REFERENCE };

typedef struct tune_options {
    tune_order order;
    app_settings settings;
    app_frames frames;
    const char *error, *preset, *memory;
    double max_ms, max_error;
    const char **axes;
    size_t axis_count, axis_capacity;
    char folder[PATH_CAP]; // where results go by default
    int resume, repeats;
    app_progress steps;
    const tune_axis *shown; // columns of what is printed
    size_t shown_count, measured;
} tune_options;

// ---- options ------------------------------------------------------------------------------------

static bool add_axes(tune_options *o, char *text) {
    for (char *at = strtok(text, ","); at; at = strtok(NULL, ",")) {
        *MEM_ADD(o->axes, o->axis_count, o->axis_capacity) = at;
    }
    return o->axis_count > 0 || err_set("--axes names no axis");
}

static bool take_option(void *user, int option, char *text) {
    tune_options *o = user;
    switch (option) {
    case OPTION_SIZE:
        return app_parse_size(text, &o->order.width, &o->order.height);
    case OPTION_AXES:
        return add_axes(o, text);
    }
    return app_parse_samples("--reference", text, &o->order.samples);
}

static bool take_goal(tune_options *o) {
    tune_goal *g = &o->order.goal;
    if (o->error && strcmp(o->error, "psnr") == 0)
        g->error = TUNE_PSNR;
    else if (o->error && strcmp(o->error, "flip") != 0)
        return err_set("--error '%s'; accepted: flip, psnr", o->error);
    bool time = o->max_ms >= 0, error = o->max_error >= 0;
    if (time == error)
        return err_set("a limit is missing: --max-ms MS for the best picture within a time, or "
                       "--max-error E for the least time within an error");
    g->by_error = error;
    g->limit = error ? o->max_error : o->max_ms;
    if (error && g->error == TUNE_FLIP && g->limit > 1)
        return err_set("--max-error %g; accepted: 0 to 1, as FLIP is", g->limit);
    return true;
}

static bool take_effect(tune_options *o, poptContext arguments) {
    tune_order *order = &o->order;
    if (!app_take_effect(arguments, &order->effect,
                         "which effect? usage: roil tune EFFECT.lua --max-ms MS | --max-error E"))
        return false;
    int length;
    const char *name = path_stem(order->effect, &length);
    snprintf(o->folder, sizeof o->folder, "out/tune/%.*s", length, name);
    if (!order->folder) order->folder = o->folder;
    return true;
}

static bool take_numbers(tune_options *o) {
    if (o->repeats < 1 || o->repeats > 1000)
        return err_set("--repeats %d; accepted: 1 to 1000", o->repeats);
    o->order.repeats = (uint32_t)o->repeats;
    o->order.resume = o->resume;
    o->order.axes = o->axes;
    o->order.axis_count = o->axis_count;
    o->order.preset = o->preset;
    o->order.frames = o->frames.numbers;
    o->order.frame_count = o->frames.count;
    return true;
}

static bool tune_check(void *user, poptContext arguments) {
    tune_options *o = user;
    return take_effect(o, arguments) && take_goal(o) && take_numbers(o);
}

// ---- what is said -------------------------------------------------------------------------------

static const char *short_name(const tune_axis *a) { // "steps" of "march.steps"
    const char *dot = strrchr(a->name, '.');
    return dot ? dot + 1 : a->name;
}

static int width_of(const tune_axis *a) {
    size_t width = strlen(short_name(a));
    for (size_t i = 0; i < a->count; i++)
        if (strlen(a->values[i]) > width) width = strlen(a->values[i]);
    return (int)width + 2;
}

static void on_begin(void *user, const bench_results *r, const tune_axis *axes, size_t count) {
    tune_options *o = user;
    double all = 1;
    o->shown = axes;
    o->shown_count = count;
    app_print(stdout, "%s\n%s\n", r->title, r->device);
    for (size_t i = 0; i < count; i++) {
        app_print(stdout, "  %s:", axes[i].name);
        for (size_t k = 0; k < axes[i].count; k++)
            app_print(stdout, k == axes[i].start ? " [%s]" : " %s", axes[i].values[k]);
        app_print(stdout, "\n");
        all *= (double)axes[i].count;
    }
    if (r->by_process)
        app_print(stdout, "times are processor time by core, since the device is the processor\n");
    app_print(stdout, "%.0f combinations, of which few are measured:\n\n", all);
    for (size_t i = 0; i < count; i++)
        app_print(stdout, "%*s", width_of(&axes[i]), short_name(&axes[i]));
    app_print(stdout, "%10s %10s\n", "ms", o->order.goal.error == TUNE_FLIP ? "FLIP" : "PSNR dB");
    fflush(stdout);
}

static void on_result(void *user, const bench_results *r, const bench_row *row, bool earlier) {
    tune_options *o = user;
    double ms = tune_row_ms(r, row);
    double error = tune_row_error(row, o->order.goal.error);
    o->measured += !earlier;
    for (size_t i = 0; i < o->shown_count; i++)
        app_print(stdout, "%*s", width_of(&o->shown[i]), bench_axis_value(row, o->shown[i].name));
    if (!isnan(ms))
        app_print(stdout, "%10.4g %10.4f%s\n", ms, error, earlier ? "  kept" : "");
    else
        app_print(stdout, "  %s: %s\n", bench_state_name(row->state), row->message);
    fflush(stdout);
}

static void print_line(const char *name, int width, double before, double after) {
    app_print(stdout, "%-*s %12.4g %12.4g\n", width, name, before, after);
}

static void print_result(const tune_options *o, const bench_results *r, const tune_result *t) {
    const bench_row *before = bench_find(r, t->before), *best = bench_find(r, t->best);
    const tune_error kind = o->order.goal.error;
    int width = 8;
    for (size_t i = 0; i < t->axis_count; i++)
        if ((int)strlen(t->axes[i].name) > width) width = (int)strlen(t->axes[i].name);
    app_print(stdout, "\n%-*s %12s %12s\n", width, "", "before", "tuned");
    for (size_t i = 0; i < t->axis_count; i++)
        app_print(stdout, "%-*s %12s %12s\n", width, t->axes[i].name,
                  bench_axis_value(before, t->axes[i].name),
                  bench_axis_value(best, t->axes[i].name));
    print_line("ms", width, tune_row_ms(r, before), tune_row_ms(r, best));
    print_line(kind == TUNE_FLIP ? "FLIP" : "PSNR dB", width, tune_row_error(before, kind),
               tune_row_error(best, kind));
    app_print(stdout, "\n%zu rows measured%s\n", o->measured,
              t->complete ? "" : "; the search was ended early, and --resume goes on");
}

static int tune_finish(const tune_options *o, const bench_results *r, const tune_result *t) {
    print_result(o, r, t);
    app_print(stdout, "wrote %s/results.json, results.csv, report.html\n", o->order.folder);
    if (!t->within)
        return app_fail(APP_DIFFERS, "%s %g cannot be kept with these axes%s; no preset is written",
                        o->order.goal.by_error ? "--max-error" : "--max-ms", o->order.goal.limit,
                        t->complete ? "" : ", as far as was searched");
    arena memory = {0};
    app_print(stdout, "wrote the preset: roil render %s --preset %s\n",
              app_quoted(&memory, o->order.effect), app_quoted(&memory, o->preset));
    arena_free(&memory);
    return APP_DONE;
}

static void on_steps(void *user, double done, double whole) {
    app_tell_steps(&((tune_options *)user)->steps, done, whole);
}

static int tune_search(void *user) {
    tune_options *o = user;
    if (o->order.folder == o->folder && !app_may_write_here(o->folder)) return app_fail_input();
    roil *r = roil_create(&(roil_desc){.no_device = true, .memory = o->memory});
    if (!r || !app_collect_settings(&o->settings, r, o->order.effect, NULL)) {
        roil_destroy(r);
        return app_fail_input();
    }
    roil_destroy(r);
    o->order.settings = o->settings.all;
    o->order.setting_count = o->settings.count;
    o->order.watcher = (tune_watcher){on_begin, on_result, app_is_interrupted, on_steps, o};
    app_hear_interrupts();
    bench_results results;
    tune_result result;
    int status = bench_tune(&o->order, &results, &result) ? tune_finish(o, &results, &result)
                                                          : app_fail_input();
    bench_results_free(&results);
    return status;
}

int cmd_tune(int argc, const char **argv) {
    tune_options o = {.max_ms = -1, .max_error = -1, .preset = "tuned", .repeats = 2};
    o.order.width = 960;
    o.order.height = 540;
    o.order.limit = 120;
    const struct poptOption options[] = {
        {"max-ms", 0, POPT_ARG_DOUBLE, &o.max_ms, 0,
         "find the best picture whose median frame takes no longer on the device", "MS"},
        {"max-error", 0, POPT_ARG_DOUBLE, &o.max_error, 0,
         "find the least time whose worst frame has no greater error", "E"},
        {"error", 0, POPT_ARG_STRING, &o.error, 0,
         "measure of error: flip (default), or psnr in dB, of which E is the minimum", "KIND"},
        {"axes", 0, POPT_ARG_STRING, NULL, OPTION_AXES,
         "controls to vary, or controls and their values from cheap to expensive "
         "(default: the effect's steps, resolutions, octaves, ...)",
         "NAME[=V:V...],..."},
        {"reference", 0, POPT_ARG_STRING, NULL, OPTION_REFERENCE,
         "compare with a path tracer with so many samples per pixel (default: the effect with all "
         "axes at their best)",
         "SPP"},
        {"name", 0, POPT_ARG_STRING, &o.preset, 0, "name of the preset (default: tuned)", "NAME"},
        {"output", 'o', POPT_ARG_STRING, &o.order.folder, 0,
         "folder of the results and the report (default: out/tune/EFFECT)", "DIR"},
        {"resume", 0, POPT_ARG_NONE, &o.resume, 0,
         "keep what was measured in DIR, for this goal or another", NULL},
        {"budget", 0, POPT_ARG_DOUBLE, &o.order.budget, 0,
         "time limit of the search; the best result until then counts", "SECONDS"},
        {"frames", 'f', POPT_ARG_STRING, NULL, APP_FRAMES,
         "30, or 10,30,50, or 1-100:20 (default: three places spread over the effect)", "FRAMES"},
        {"size", 's', POPT_ARG_STRING, NULL, OPTION_SIZE, "size of pictures (default: 960x540)",
         "WxH"},
        {"repeats", 0, POPT_ARG_INT, &o.repeats, 0, "how often each row is measured (default: 2)",
         "N"},
        {"limit", 0, POPT_ARG_DOUBLE, &o.order.limit, 0, "time limit of a row (default: 120)",
         "SECONDS"},
        {"set", 0, POPT_ARG_STRING, NULL, APP_SET, "applies to everything that is measured",
         "NAME=VALUE"},
        {"preset", 0, POPT_ARG_STRING, NULL, APP_PRESET, "applies to everything that is measured",
         "NAME|FILE.lua"},
        APP_DEVICE_ROW(&o.order.device),
        APP_MEMORY_ROW(&o.memory),
        POPT_AUTOHELP POPT_TABLEEND};
    int status = app_run(argc, argv, "roil tune",
                         "EFFECT.lua --max-ms MS | --max-error E [options]", options,
                         &(app_task){.job = &o,
                                     .check = tune_check,
                                     .run = tune_search,
                                     .take = take_option,
                                     .settings = &o.settings,
                                     .frames = &o.frames});
    mem_free(o.axes);
    return status;
}
