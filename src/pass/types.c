// The built-in pass types. A type without hooks is its shader and nothing else.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

static const pass_type types[] = {
    {
        .name = "geometry",
        .shader = "pass/geometry.comp",
        .returns = "color: what is solid, and the sky; sun: the sun's part of it; depth: distance "
                   "along the view axis (m)",
        .declare = geometry_declare,
        .check = geometry_check,
        .build = geometry_build,
        .record = geometry_record,
        .destroy = geometry_destroy,
    },
    {
        .name = "march",
        .shader = "pass/march.comp",
        .returns = "color: premultiplied radiance and opacity; shadow: how much sun reaches the "
                   "scene; edge: where each ray was stopped (m)",
        .declare = march_declare,
        .fill = march_fill,
    },
    {
        .name = "over",
        .shader = "pass/over.comp",
        .returns = "color: the volume over the scene",
    },
    {
        .name = "bright",
        .shader = "pass/bright.comp",
        .returns = "color: what is brighter than the threshold",
    },
    {
        .name = "bloom",
        .shader = "pass/bloom.comp",
        .returns = "color: the bright picture, spread",
        .declare = bloom_declare,
        .check = bloom_check,
        .build = bloom_build,
        .record = bloom_record,
        .destroy = bloom_destroy,
    },
    {
        .name = "final",
        .shader = "pass/final.comp",
        .returns = "color: the picture for a display, linear Rec.709 in 0..1; linear: the same "
                   "before exposure and tone mapping",
    },
    {
        .name = "bake",
        .shader = "pass/bake.comp",
        .returns = "a grid: see the field `grid`",
        .declare = bake_declare,
        .fill = bake_fill,
    },
};

const pass_type *pass_types(size_t *count) {
    *count = COUNT_OF(types);
    return types;
}

const pass_type *pass_type_find(const char *name) {
    const char *names[COUNT_OF(types)];
    for (size_t i = 0; i < COUNT_OF(types); i++) {
        if (strcmp(types[i].name, name) == 0) return &types[i];
        names[i] = types[i].name;
    }
    const char *near = str_nearest(name, names, COUNT_OF(types));
    if (near)
        err_set("unknown pass '%s'; did you mean '%s'?", name, near);
    else
        err_set("unknown pass '%s'; `roil info passes` lists them", name);
    return NULL;
}
