// Effects through roil.h, without a device.
#pragma once
#include "script_helper.h"

#include "base/memory.h"
#include "roil.h"
#include <math.h>

static roil *helper_roil;

static inline int roil_setup(void **state) {
    char home[PATH_CAP];
    helper_source(home, ".");
    helper_roil = roil_create(&(roil_desc){.home = home, .no_device = true, .no_cache = true});
    return helper_roil ? helper_setup(state) : 1;
}

static inline int roil_teardown(void **state) {
    roil_destroy(helper_roil);
    return helper_teardown(state);
}

static inline void helper_path(char out[PATH_CAP], const char *name) {
    assert_true(path_join(out, helper_folder, name));
}

static inline roil_effect *roil_open(const char *text, const roil_setting *settings, size_t count) {
    char path[PATH_CAP];
    helper_put("e.lua", text);
    helper_path(path, "e.lua");
    roil_effect *e = roil_load(helper_roil, path, settings, count);
    if (!e) fail_msg("%s", roil_error());
    return e;
}

#define need(result)                                                                               \
    do {                                                                                           \
        if (!(result)) fail_msg("%s: %s", #result, roil_error());                                  \
    } while (0)
#define refused(result, part)                                                                      \
    do {                                                                                           \
        if (result) fail_msg("%s was taken", #result);                                             \
        if (!strstr(roil_error(), part)) fail_msg("\"%s\" is not in: %s", part, roil_error());     \
    } while (0)
