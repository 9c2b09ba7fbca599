// roil export raw 'FILES*.vdb' -o FILE.raw: writes a VDB sequence as plain voxels. `roil export
// vdb` is in export_vdb.c, `roil export sheet` in export_sheet.c.
#include "app/app.h"
#include "app/device_options.h"
#include "base/error.h"
#include <popt.h>
#include <stdio.h>
#include <string.h>

static bool usage(const char *message) {
    return err_set(
        "%s; usage: roil export raw 'FILES*.vdb' -o FILE.raw, roil export vdb EFFECT.lua "
        "-o DIR/%%04d.vdb, or roil export sheet EFFECT.lua -o fire.png",
        message);
}

static bool raw_check(void *user, poptContext arguments) {
    roil_export *job = user;
    const char *format = poptGetArg(arguments);
    job->pattern = poptGetArg(arguments);
    if (!format) return usage("which format?");
    if (strcmp(format, "raw") != 0) return usage("the first word is the format, raw, vdb or sheet");
    if (!job->pattern) return usage("which files?");
    if (poptPeekArg(arguments)) return usage("quote the pattern of the files");
    return job->file || usage("-o is missing");
}

static int raw_write(void *user) {
    const roil_export *job = user;
    char *text = app_can_write(job->file) ? roil_export_raw(job) : NULL;
    if (!text) return app_fail_input();
    fputs(text, stdout);
    roil_free(text);
    return APP_DONE;
}

static int export_raw(int argc, const char **argv) {
    app_progress progress = {0};
    roil_export job = {.progress = app_tell_frames, .user = &progress};
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, &job.file, 0, "one file of all frames", "FILE.raw"},
        {"grid", 'g', POPT_ARG_STRING, &job.grid, 0, "which grid (default: density)", "NAME"},
        {"type", 't', POPT_ARG_STRING, &job.type, 0, "u8, u16, f16 or f32 (default: u8)", "TYPE"},
        POPT_AUTOHELP POPT_TABLEEND};
    return app_run(argc, argv, "roil export",
                   "raw 'FILES*.vdb' -o FILE.raw (see also: roil export vdb "
                   "--help, roil export sheet --help)",
                   options, &(app_task){.job = &job, .check = raw_check, .run = raw_write});
}

// Loads the effect anew after a look at it.
static bool look_first(const app_export *x, roil *r, roil_effect **e) {
    if (!x->look) return true;
    if (!x->look(x->job, *e)) return false;
    roil_unload(*e);
    *e = roil_load(r, x->file, x->settings->all, x->settings->count);
    return *e != NULL;
}

int app_export_effect(const app_export *x) {
    roil_desc desc = app_device_desc(x->device);
    app_progress files = {0};
    desc.loading = app_tell_files;
    desc.user = &files;
    roil *r = roil_create(&desc);
    bool collected = r && app_collect_settings(x->settings, r, x->file, NULL);
    roil_effect *e = collected ? roil_load(r, x->file, x->settings->all, x->settings->count) : NULL;
    int status = APP_DONE;
    if (!e)
        status = app_fail_input();
    else if (!x->plan(x->job, e))
        status = app_fail(APP_BAD_USAGE, "export: %s", roil_error());
    else if (!look_first(x, r, &e) || !x->make(x->job, e))
        status = app_fail_input();
    roil_unload(e);
    return app_close(r, status);
}

int cmd_export(int argc, const char **argv) {
    if (argc > 1 && strcmp(argv[1], "vdb") == 0) return export_vdb(argc - 1, argv + 1);
    if (argc > 1 && strcmp(argv[1], "sheet") == 0) return export_sheet(argc - 1, argv + 1);
    return export_raw(argc, argv);
}
