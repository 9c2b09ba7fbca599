// roil check EFFECT.lua...: load, compile, validate; render nothing.
#include "app/app.h"
#include <popt.h>
#include <stdio.h>

int cmd_check(int argc, const char **argv) {
    const struct poptOption options[] = {POPT_AUTOHELP POPT_TABLEEND};
    poptContext context = poptGetContext("roil check", argc, argv, options, 0);
    poptSetOtherOptionHelp(context, "EFFECT.lua...");
    int code = poptGetNextOpt(context);
    if (code < -1) {
        app_fail(APP_BAD_USAGE, "check: %s: %s", poptBadOption(context, 0), poptStrerror(code));
        poptFreeContext(context);
        return APP_BAD_USAGE;
    }
    const char **files = poptGetArgs(context);
    int status = files && files[0] ? APP_DONE
                                   : app_fail(APP_BAD_USAGE, "check: which effect? "
                                                             "usage: roil check EFFECT.lua...");
    roil *r = status == APP_DONE ? roil_create(&(roil_desc){.no_device = true}) : NULL;
    if (status == APP_DONE && !r) status = app_fail_input();
    for (; r && *files; files++) {
        roil_effect *e = roil_load(r, *files, NULL, 0);
        if (e && roil_check(e))
            printf("%s: good\n", *files);
        else
            status = app_fail_input();
        roil_unload(e);
    }
    roil_destroy(r);
    poptFreeContext(context);
    return status;
}
