// roil check EFFECT.lua...: load, compile, validate; render nothing.
#include "app/app.h"
#include "app/device_options.h"
#include <jansson.h>
#include <popt.h>
#include <stdio.h>

static int check_files(const char **files, app_settings *settings, const roil_desc *desc,
                       bool json) {
    int status = APP_DONE;
    roil *r = roil_create(desc);
    if (!r) return app_fail_input();
    json_t *good = json_array(), *errors = json_array();
    for (; *files; files++) {
        bool collected = app_collect_settings(settings, r, *files, NULL);
        roil_effect *e = collected ? roil_load(r, *files, settings->all, settings->count) : NULL;
        if (!e || !roil_check(e)) {
            status = app_fail_input();
            json_array_append_new(errors, app_error_json(r, *files));
        } else if (json) {
            json_array_append_new(good, json_string(*files));
        } else {
            app_print(stdout, "%s: good\n", *files);
        }
        roil_unload(e);
    }
    roil_destroy(r);
    json_t *root =
        json_pack("{s:s, s:o, s:o}", "roil", roil_version(), "good", good, "errors", errors);
    if (json) return app_print_json(root, status);
    json_decref(root);
    return status;
}

int cmd_check(int argc, const char **argv) {
    enum { OPTION_PRESET = 1 };
    app_progress progress = {0};
    int json = 0;
    const char **assets = NULL;
    roil_desc desc = {.no_device = true, .loading = app_tell_files, .user = &progress};
    const struct poptOption options[] = {{"preset", '\0', POPT_ARG_STRING, NULL, OPTION_PRESET,
                                          "with values kept beside the effect, or in a file",
                                          "NAME|FILE.lua"},
                                         APP_JSON_ROW(&json),
                                         APP_ASSETS_ROW(&assets),
                                         APP_MEMORY_ROW(&desc.memory),
                                         APP_TIME_ROW(&desc.time_limit),
                                         POPT_AUTOHELP POPT_TABLEEND};
    app_settings settings = {0};
    poptContext context = app_options("roil check", argc, argv, options, "EFFECT.lua...");
    int code, status;
    while ((code = poptGetNextOpt(context)) > 0) app_add_preset(&settings, poptGetOptArg(context));
    const char **files = poptGetArgs(context);
    if (code < -1) {
        app_refuse_option(context, options, code);
        status = app_fail(APP_BAD_USAGE, "check: %s", roil_error());
    } else if (!files || !files[0]) {
        status = app_fail(APP_BAD_USAGE, "check: which effect? usage: roil check EFFECT.lua...");
    } else {
        desc.assets = assets;
        status = check_files(files, &settings, &desc, json);
    }
    app_free_settings(&settings);
    poptFreeContext(context);
    return status;
}
