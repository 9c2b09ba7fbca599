#include "pass/fluid.h"
#include "base/error.h"
#include "base/str.h"
#include <string.h>

const char *const pass_fluid_names[PASS_FLUID_NAMES] = {"density", "temperature", "dye", "pressure",
                                                        "velocity"};

int pass_fluid_use(const char *label, bool used[PASS_FLUID_NAMES], const char *name,
                   int *components) {
    for (int i = 0; i < PASS_FLUID_NAMES; i++) {
        if (strcmp(pass_fluid_names[i], name) != 0) continue;
        used[i] = true;
        *components = i == PASS_FLUID_VELOCITY ? 3 : 1;
        return i;
    }
    const char *near = str_nearest(name, pass_fluid_names, PASS_FLUID_NAMES);
    err_set("%s: no field '%s'; %s%s%s", label, name, near ? "did you mean '" : "",
            near ? near : "it has density, temperature, dye, velocity and pressure",
            near ? "'?" : "");
    return -1;
}
