// roil info ...: prints the reference from the program's own tables.
#include "app/app.h"
#include "app/device_options.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/words.h"
#include <jansson.h>
#include <popt.h>
#include <stdio.h>
#include <string.h>

typedef struct info_job {
    const char *what, *name;
    app_settings settings;
    const char *memory, *output;
    const char **assets;
    int json, lua_meta;
} info_job;

// Fails with roil_error(), in JSON too where that was asked for.
static int info_fail(const info_job *j, const roil *r, const char *file) {
    int status = app_fail_input();
    if (!j->json) return status;
    json_t *errors = json_pack("[o]", app_error_json(r, file));
    return app_print_json(json_pack("{s:s, s:o}", "roil", roil_version(), "errors", errors),
                          status);
}

static int info_print(const info_job *j, char *text) {
    if (!text) return info_fail(j, NULL, "");
    str_make_printable(text);
    fputs(text, stdout);
    if (j->json) puts("");
    roil_free(text);
    return APP_DONE;
}

// Passes, words or everything, from the tables of the library.
static int info_reference(const info_job *j, const char *list) {
    roil *r = roil_create(&(roil_desc){.no_device = true});
    int status;
    if (!r)
        status = info_fail(j, NULL, "");
    else if (j->lua_meta)
        status = info_print(j, roil_info_lua_meta(r));
    else if (j->json)
        status = info_print(j, roil_info_json(r, list, j->name));
    else
        status = info_print(j, roil_info_passes(r, j->name));
    roil_destroy(r);
    return status;
}

static int info_effect(info_job *j) {
    const char *file = j->name;
    bool graph = strcmp(j->what, "graph") == 0;
    if (!file) return app_fail(APP_BAD_USAGE, "info %s: of which effect?", j->what);
    app_progress files = {0};
    roil *r = roil_create(&(roil_desc){.no_device = true,
                                       .assets = j->assets,
                                       .memory = j->memory,
                                       .loading = app_tell_files,
                                       .user = &files});
    bool collected = r && app_collect_settings(&j->settings, r, file, NULL);
    roil_effect *e = collected ? roil_load(r, file, j->settings.all, j->settings.count) : NULL;
    int status;
    if (!e || (graph && !roil_check(e)))
        status = info_fail(j, r, file);
    else if (graph)
        status = info_print(j, roil_info_graph(e));
    else
        status = info_print(j, j->json ? roil_info_params_json(e) : roil_info_params(e));
    roil_unload(e);
    roil_destroy(r);
    return status;
}

// Tells about an effect or a bundle: whose it is, and what it reads.
static int info_file(const info_job *j) {
    roil *r =
        roil_create(&(roil_desc){.no_device = true, .assets = j->assets, .memory = j->memory});
    int status;
    if (!r || !app_check_effect(j->what))
        status = info_fail(j, r, j->what);
    else
        status = info_print(j, j->json ? roil_info_inputs_json(r, j->what)
                                       : roil_info_inputs(r, j->what));
    roil_destroy(r);
    return status;
}

static int info_devices(const info_job *j) {
    return info_print(j, j->json ? roil_info_devices_json() : roil_info_devices());
}

static int info_effects(const info_job *j) {
    roil *r = roil_create(&(roil_desc){.no_device = true});
    int status;
    if (!r) {
        status = info_fail(j, NULL, "");
    } else if (j->output) {
        char *page = roil_info_effects_page(r);
        bool done = page && file_make_parent_folders(j->output) &&
                    file_write(j->output, page, strlen(page));
        status = done ? APP_DONE : app_fail_input();
        if (done) app_print(stdout, "wrote %s\n", j->output);
        roil_free(page);
    } else {
        status = info_print(j, j->json ? roil_info_effects_json(r) : roil_info_effects(r));
    }
    roil_destroy(r);
    return status;
}

static int info_index(const info_job *j) {
    if (j->json || j->lua_meta) return info_reference(j, NULL);
    puts(
        "roil info device                what devices there are\n"
        "roil info passes [NAME]         the types of passes, or all of one\n"
        "roil info fields [NAME]         the kinds of fields and their operators, or all of one\n"
        "roil info effects               the effects that come with roil; -o FILE.html: with "
        "pictures\n"
        "roil info params EFFECT.lua     what --set, presets and the window can change in an "
        "effect\n"
        "roil info graph EFFECT.lua      its passes in order, their images and memory\n"
        "roil info FILE.vdb              the grids of a volume\n"
        "roil info EFFECT.lua|FILE.roil  whose it is, and what it reads\n"
        "roil info --json                passes and fields, for programs; with a topic that alone\n"
        "roil info --lua-meta            the same for editors, as lua-language-server reads it\n");
    return info_devices(j);
}

static int info(void *user) {
    info_job *j = user;
    static const char *const topics[] = {"device",  "passes", "fields",
                                         "effects", "params", "graph"};
    const char *what = j->what;
    if (!what) return info_index(j);
    if (j->lua_meta) return app_fail(APP_BAD_USAGE, "info: --lua-meta has no topic '%s'", what);
    bool effects = strcmp(what, "effects") == 0;
    if (j->output && !effects)
        return app_fail(APP_BAD_USAGE, "info: -o goes with effects, as in `roil info effects -o "
                                       "effects.html`");
    if (effects) return info_effects(j);
    if (strcmp(what, "device") == 0) return info_devices(j);
    if (strcmp(what, "passes") == 0) return info_reference(j, what);
    if (strcmp(what, "fields") == 0)
        return j->json ? info_reference(j, "words") : info_print(j, roil_info_fields(j->name));
    if (str_ends_with(what, ".lua") || str_ends_with(what, ".roil")) return info_file(j);
    bool plain = strcmp(what, "graph") == 0 || str_ends_with(what, ".vdb");
    if (j->json && plain)
        return app_fail(
            APP_BAD_USAGE,
            "info: --json goes with device, passes, fields, effects and params; a graph is "
            "printed as dot, which programs read");
    if (strcmp(what, "params") == 0 || strcmp(what, "graph") == 0) return info_effect(j);
    if (plain) return info_print(j, roil_info_vdb(what));
    words_refuse(topics, COUNT_OF(topics), what,
                 "accepted: device, passes [NAME], fields [NAME], effects, params EFFECT.lua, "
                 "graph EFFECT.lua, FILE.vdb, EFFECT.lua, FILE.roil",
                 "unknown topic '%s'", what);
    return app_fail(APP_BAD_USAGE, "info: %s", roil_error());
}

static bool info_arguments(void *user, poptContext arguments) {
    info_job *j = user;
    j->what = poptGetArg(arguments);
    j->name = poptGetArg(arguments);
    return true;
}

int cmd_info(int argc, const char **argv) {
    info_job j = {0};
    const struct poptOption options[] = {
        {"preset", '\0', POPT_ARG_STRING, NULL, APP_PRESET,
         "of params, graph: with values kept beside the effect, or in a file", "NAME|FILE.lua"},
        {"set", '\0', POPT_ARG_STRING, NULL, APP_SET, "of params, graph: as render takes it",
         "NAME=VALUE"},
        {"output", 'o', POPT_ARG_STRING, &j.output, 0, "of effects: a page with their pictures",
         "FILE.html"},
        {"lua-meta", '\0', POPT_ARG_NONE, &j.lua_meta, 0,
         "print annotations for lua-language-server: every function, key, unit and word", NULL},
        APP_JSON_ROW(&j.json),
        APP_ASSETS_ROW(&j.assets),
        APP_MEMORY_ROW(&j.memory),
        POPT_AUTOHELP POPT_TABLEEND};
    return app_run(
        argc, argv, "roil info",
        "[device | passes [NAME] | fields [NAME] | effects | params EFFECT.lua | graph "
        "EFFECT.lua | FILE.vdb | EFFECT.lua | FILE.roil]",
        options,
        &(app_task){.job = &j, .check = info_arguments, .run = info, .settings = &j.settings});
}
