#include "pass/fluid.h"
#include "base/error.h"
#include "base/str.h"
#include <string.h>

const pass_fluid_field pass_fluid_fields[PASS_FLUID_NAMES] = {
    [PASS_FLUID_DENSITY] = {"density", 0, 1},   [PASS_FLUID_TEMPERATURE] = {"temperature", 1, 1},
    [PASS_FLUID_DYE] = {"dye", 2, 1},           [PASS_FLUID_PRESSURE] = {"pressure", 3, 1},
    [PASS_FLUID_VELOCITY] = {"velocity", 4, 3},
};

const char *pass_fluid_nearest(const pass_fluid_field *fields, size_t count, const char *name) {
    const char *names[PASS_FLUID_MOST_NAMES];
    for (size_t i = 0; i < count; i++) names[i] = fields[i].name;
    return str_nearest(name, names, count);
}

static void list_names(const pass_fluid_field *fields, size_t count, strbuf *out) {
    for (size_t i = 0; i < count; i++)
        strbuf_add(out, "%s%s", i == 0 ? "" : i + 1 == count ? " and " : ", ", fields[i].name);
}

int pass_fluid_use(const char *label, const pass_fluid_field *fields, size_t count, bool *used,
                   const char *name, int *components) {
    for (size_t i = 0; i < count; i++) {
        if (strcmp(fields[i].name, name) != 0) continue;
        used[i] = true;
        *components = fields[i].components;
        return fields[i].channel;
    }
    const char *near = pass_fluid_nearest(fields, count, name);
    strbuf all = {0};
    list_names(fields, count, &all);
    if (near)
        err_set("%s: no field '%s'; did you mean '%s'?", label, name, near);
    else
        err_set("%s: no field '%s'; it has %s", label, name, strbuf_text(&all));
    strbuf_free(&all);
    return -1;
}
