// roil info ...: the reference, from the program's own tables.
#include "app/app.h"
#include "base/str.h"
#include <popt.h>
#include <stdio.h>
#include <string.h>

static int print(char *text) {
    if (!text) return app_fail_input();
    fputs(text, stdout);
    roil_free(text);
    return APP_DONE;
}

static int info_passes(const char *name) {
    roil *r = roil_create(&(roil_desc){.no_device = true});
    int status = r ? print(roil_info_passes(r, name)) : app_fail_input();
    roil_destroy(r);
    return status;
}

static int info_effect(const char *what, const char *file) {
    if (!file) return app_fail(APP_BAD_USAGE, "info %s: of which effect?", what);
    roil *r = roil_create(&(roil_desc){.no_device = true});
    roil_effect *e = r ? roil_load(r, file, NULL, 0) : NULL;
    int status;
    if (!e)
        status = app_fail_input();
    else if (strcmp(what, "params") == 0)
        status = print(roil_info_params(e));
    else
        status = roil_check(e) ? print(roil_info_graph(e)) : app_fail_input();
    roil_unload(e);
    roil_destroy(r);
    return status;
}

static int info(const char *what, const char *name) {
    static const char *const topics[] = {"device", "passes", "fields", "params", "graph"};
    if (!what || strcmp(what, "device") == 0) return print(roil_info_devices());
    if (strcmp(what, "passes") == 0) return info_passes(name);
    if (strcmp(what, "fields") == 0) return print(roil_info_fields(name));
    if (strcmp(what, "params") == 0 || strcmp(what, "graph") == 0) return info_effect(what, name);
    if (str_ends_with(what, ".vdb")) return print(roil_info_vdb(what));
    const char *near = str_nearest(what, topics, 5);
    if (near)
        return app_fail(APP_BAD_USAGE, "info: unknown topic '%s'; did you mean '%s'?", what, near);
    return app_fail(APP_BAD_USAGE,
                    "info: unknown topic '%s'; accepted: device, passes [NAME], fields [NAME], "
                    "params EFFECT.lua, graph EFFECT.lua, FILE.vdb",
                    what);
}

int cmd_info(int argc, const char **argv) {
    const struct poptOption options[] = {POPT_AUTOHELP POPT_TABLEEND};
    poptContext context = poptGetContext("roil info", argc, argv, options, 0);
    poptSetOtherOptionHelp(context, "[device | passes [NAME] | fields [NAME] | params EFFECT.lua | "
                                    "graph EFFECT.lua | FILE.vdb]");
    int code = poptGetNextOpt(context), status;
    if (code < -1) {
        status =
            app_fail(APP_BAD_USAGE, "info: %s: %s", poptBadOption(context, 0), poptStrerror(code));
    } else {
        const char *what = poptGetArg(context);
        status = info(what, poptGetArg(context));
    }
    poptFreeContext(context);
    return status;
}
