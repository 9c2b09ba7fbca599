// roil bundle EFFECT.lua: one file with the effect and all that it reads.
#include "app/app.h"
#include "app/device_options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/str.h"
#include <popt.h>
#include <stdio.h>

static void warn_of_rights(const roil_inputs *in) {
    if (!in->info.author || !in->info.licence)
        app_print(stderr,
                  "%s does not say its %s; others will ask: effect { author = \"...\", "
                  "licence = \"...\" }\n",
                  in->effect,
                  in->info.author    ? "licence"
                  : in->info.licence ? "author"
                                     : "author and licence");
}

typedef struct bundle_job {
    const char *effect, *output, **assets, *memory;
} bundle_job;

static int make(roil *r, const char *effect, const char *output) {
    char place[PATH_CAP];
    int length;
    const char *name = path_stem(effect, &length);
    if (!output) {
        snprintf(place, sizeof place, "%.*s.roil", length, name);
        if (!app_may_write_here(place)) return app_fail_input();
    }
    const char *file = output ? output : place;
    if (!app_check_effect(effect) || !file_make_parent_folders(file) || !app_can_write(file))
        return app_fail_input();
    roil_inputs *in = roil_collect(r, effect);
    bool done = in && roil_bundle(r, in, file);
    uint64_t bytes = 0;
    for (size_t i = 0; done && i < in->count; i++) bytes += in->files[i].size;
    if (done) warn_of_rights(in);
    if (done)
        app_print(stdout,
                  "wrote %s: %zu file%s, %.1f %s. `roil live %s` opens it, `tar -xf %s` unpacks "
                  "it.\n",
                  file, in->count, in->count == 1 ? "" : "s",
                  (double)bytes * (bytes < 1000000 ? 1e-3 : 1e-6), bytes < 1000000 ? "kB" : "MB",
                  file, file);
    roil_free_inputs(in);
    return done ? APP_DONE : app_fail_input();
}

static int pack(void *user) {
    const bundle_job *j = user;
    app_progress files = {0};
    roil *r = roil_create(&(roil_desc){.no_device = true,
                                       .assets = j->assets,
                                       .memory = j->memory,
                                       .loading = app_tell_files,
                                       .user = &files});
    int status = r ? make(r, j->effect, j->output) : app_fail_input();
    roil_destroy(r);
    return status;
}

static bool bundle_check(void *user, poptContext arguments) {
    bundle_job *j = user;
    j->effect = poptGetArg(arguments);
    if (!j->effect || poptPeekArg(arguments))
        return err_set("one effect is packed, as in `roil bundle fire.lua -o fire.roil`");
    return !j->output || str_ends_with(j->output, ".roil") ||
           err_set("-o %s; a bundle's name ends with .roil", j->output);
}

int cmd_bundle(int argc, const char **argv) {
    bundle_job j = {0};
    const struct poptOption options[] = {{"output", 'o', POPT_ARG_STRING, &j.output, 0,
                                          "the bundle (default: EFFECT.roil in the current folder)",
                                          "NAME.roil"},
                                         APP_ASSETS_ROW(&j.assets),
                                         APP_MEMORY_ROW(&j.memory),
                                         POPT_AUTOHELP POPT_TABLEEND};
    return app_run(argc, argv, "roil bundle", "EFFECT.lua [-o NAME.roil]", options,
                   &(app_task){.job = &j, .check = bundle_check, .run = pack});
}
