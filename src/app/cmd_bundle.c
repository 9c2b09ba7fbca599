// roil bundle EFFECT.lua: one file with the effect and all that it reads.
#include "app/app.h"
#include "app/device_options.h"
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

static int pack(const char *effect, const char *output, const roil_desc *desc) {
    roil *r = roil_create(desc);
    int status = r ? make(r, effect, output) : app_fail_input();
    roil_destroy(r);
    return status;
}

int cmd_bundle(int argc, const char **argv) {
    const char *output = NULL, **assets = NULL, *memory = NULL;
    app_progress files = {0};
    const struct poptOption options[] = {{"output", 'o', POPT_ARG_STRING, &output, 0,
                                          "the bundle (default: EFFECT.roil in the current folder)",
                                          "NAME.roil"},
                                         APP_ASSETS_ROW(&assets),
                                         APP_MEMORY_ROW(&memory),
                                         POPT_AUTOHELP POPT_TABLEEND};
    poptContext context =
        app_options("roil bundle", argc, argv, options, "EFFECT.lua [-o NAME.roil]");
    int code = poptGetNextOpt(context), status;
    const char *effect = poptGetArg(context), *more = poptGetArg(context);
    if (code < -1) {
        app_refuse_option(context, options, code);
        status = app_fail(APP_BAD_USAGE, "bundle: %s", roil_error());
    } else if (!effect || more) {
        status = app_fail(APP_BAD_USAGE, "bundle: one effect is packed, as in `roil bundle "
                                         "fire.lua -o fire.roil`");
    } else if (output && !str_ends_with(output, ".roil")) {
        status = app_fail(APP_BAD_USAGE, "bundle: -o %s; a bundle's name ends with .roil", output);
    } else {
        status = pack(effect, output,
                      &(roil_desc){.no_device = true,
                                   .assets = assets,
                                   .memory = memory,
                                   .loading = app_tell_files,
                                   .user = &files});
    }
    poptFreeContext(context);
    return status;
}
