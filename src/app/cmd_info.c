// roil info ...: prints the reference from the program's own tables.
#include "app/app.h"
#include "app/device_options.h"
#include "base/str.h"
#include <popt.h>
#include <stdio.h>
#include <string.h>

static int info_print(char *text) {
    if (!text) return app_fail_input();
    str_make_printable(text);
    fputs(text, stdout);
    roil_free(text);
    return APP_DONE;
}

static int info_passes(const char *name) {
    roil *r = roil_create(&(roil_desc){.no_device = true});
    int status = r ? info_print(roil_info_passes(r, name)) : app_fail_input();
    roil_destroy(r);
    return status;
}

static int info_effect(const char *what, const char *file, app_settings *settings,
                       const char *memory) {
    if (!file) return app_fail(APP_BAD_USAGE, "info %s: of which effect?", what);
    app_progress files = {0};
    roil *r = roil_create(&(roil_desc){
        .no_device = true, .memory = memory, .loading = app_tell_files, .user = &files});
    bool collected = r && app_collect_settings(settings, r, file, NULL);
    roil_effect *e = collected ? roil_load(r, file, settings->all, settings->count) : NULL;
    int status;
    if (!e)
        status = app_fail_input();
    else if (strcmp(what, "params") == 0)
        status = info_print(roil_info_params(e));
    else
        status = roil_check(e) ? info_print(roil_info_graph(e)) : app_fail_input();
    roil_unload(e);
    roil_destroy(r);
    return status;
}

static int info_index(void) {
    puts("roil info device                what devices there are\n"
         "roil info passes [NAME]         the types of passes, or all of one\n"
         "roil info fields [NAME]         the kinds of fields and their operators, or all of one\n"
         "roil info params EFFECT.lua     what --set, presets and the window can change in an "
         "effect\n"
         "roil info graph EFFECT.lua      its passes in order, their images and memory\n"
         "roil info FILE.vdb              the grids of a volume\n");
    return info_print(roil_info_devices());
}

static int info(const char *what, const char *name, app_settings *settings, const char *memory) {
    static const char *const topics[] = {"device", "passes", "fields", "params", "graph"};
    if (!what) return info_index();
    if (strcmp(what, "device") == 0) return info_print(roil_info_devices());
    if (strcmp(what, "passes") == 0) return info_passes(name);
    if (strcmp(what, "fields") == 0) return info_print(roil_info_fields(name));
    if (strcmp(what, "params") == 0 || strcmp(what, "graph") == 0)
        return info_effect(what, name, settings, memory);
    if (str_ends_with(what, ".vdb")) return info_print(roil_info_vdb(what));
    const char *near = str_nearest(what, topics, 5);
    if (near)
        return app_fail(APP_BAD_USAGE, "info: unknown topic '%s'; did you mean '%s'?", what, near);
    return app_fail(APP_BAD_USAGE,
                    "info: unknown topic '%s'; accepted: device, passes [NAME], fields [NAME], "
                    "params EFFECT.lua, graph EFFECT.lua, FILE.vdb",
                    what);
}

int cmd_info(int argc, const char **argv) {
    enum { OPTION_PRESET = 1, OPTION_SET };
    const char *memory = NULL;
    const struct poptOption options[] = {
        {"preset", '\0', POPT_ARG_STRING, NULL, OPTION_PRESET,
         "of params, graph: with values kept beside the effect, or in a file", "NAME|FILE.lua"},
        {"set", '\0', POPT_ARG_STRING, NULL, OPTION_SET, "of params, graph: as render takes it",
         "NAME=VALUE"},
        APP_MEMORY_ROW(&memory),
        POPT_AUTOHELP POPT_TABLEEND};
    app_settings settings = {0};
    poptContext context = poptGetContext("roil info", argc, argv, options, 0);
    poptSetOtherOptionHelp(context, "[device | passes [NAME] | fields [NAME] | params EFFECT.lua | "
                                    "graph EFFECT.lua | FILE.vdb]");
    int code, status;
    bool right = true;
    while (right && (code = poptGetNextOpt(context)) > 0) {
        char *text = poptGetOptArg(context);
        if (code == OPTION_PRESET)
            app_add_preset(&settings, text);
        else
            right = app_add_set(&settings, text);
    }
    if (!right) {
        status = app_fail(APP_BAD_USAGE, "info: %s", roil_error());
    } else if (code < -1) {
        app_refuse_option(context, options, code);
        status = app_fail(APP_BAD_USAGE, "info: %s", roil_error());
    } else {
        const char *what = poptGetArg(context);
        status = info(what, poptGetArg(context), &settings, memory);
    }
    app_free_settings(&settings);
    poptFreeContext(context);
    return status;
}
