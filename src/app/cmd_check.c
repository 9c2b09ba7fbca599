// roil check EFFECT.lua...: load, compile, validate; render nothing.
#include "app/app.h"
#include "app/device_options.h"
#include "base/error.h"
#include <jansson.h>
#include <popt.h>
#include <stdio.h>

typedef struct check_job {
    const char **files;
    app_settings settings;
    roil_desc desc;
    const char **assets;
    int json;
} check_job;

static int check_files(void *user) {
    check_job *j = user;
    int status = APP_DONE;
    j->desc.assets = j->assets;
    roil *r = roil_create(&j->desc);
    if (!r) return app_fail_input();
    json_t *good = json_array(), *errors = json_array();
    for (const char **file = j->files; *file; file++) {
        bool collected = app_collect_settings(&j->settings, r, *file, NULL);
        roil_effect *e = collected ? roil_load(r, *file, j->settings.all, j->settings.count) : NULL;
        if (!e || !roil_check(e)) {
            status = app_fail_input();
            json_array_append_new(errors, app_error_json(r, *file));
        } else if (j->json) {
            json_array_append_new(good, json_string(*file));
        } else {
            app_print(stdout, "%s: good\n", *file);
        }
        roil_unload(e);
    }
    roil_destroy(r);
    json_t *root =
        json_pack("{s:s, s:o, s:o}", "roil", roil_version(), "good", good, "errors", errors);
    if (j->json) return app_print_json(root, status);
    json_decref(root);
    return status;
}

static bool check_arguments(void *user, poptContext arguments) {
    check_job *j = user;
    j->files = poptGetArgs(arguments);
    return (j->files && j->files[0]) || err_set("which effect? usage: roil check EFFECT.lua...");
}

int cmd_check(int argc, const char **argv) {
    app_progress progress = {0};
    check_job j = {.desc = {.no_device = true, .loading = app_tell_files, .user = &progress}};
    const struct poptOption options[] = {{"preset", '\0', POPT_ARG_STRING, NULL, APP_PRESET,
                                          "with values kept beside the effect, or in a file",
                                          "NAME|FILE.lua"},
                                         APP_JSON_ROW(&j.json),
                                         APP_ASSETS_ROW(&j.assets),
                                         APP_MEMORY_ROW(&j.desc.memory),
                                         APP_TIME_ROW(&j.desc.time_limit),
                                         POPT_AUTOHELP POPT_TABLEEND};
    return app_run(
        argc, argv, "roil check", "EFFECT.lua...", options,
        &(app_task){
            .job = &j, .check = check_arguments, .run = check_files, .settings = &j.settings});
}
