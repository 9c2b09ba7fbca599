// The built-in pass types. A type without hooks is its shader and nothing else.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

extern const pass_type accumulate_type;
extern const pass_type bake_type;
extern const pass_type bloom_type;
extern const pass_type deposit_type;
extern const pass_type lbm_source_type;
extern const pass_type lbm_type;
extern const pass_type lighting_type;
extern const pass_type march_type;
extern const pass_type meter_type;
extern const pass_type particles_type;
extern const pass_type picture_type;
extern const pass_type pieces_type;
extern const pass_type point_lights_type;
extern const pass_type reference_type;
extern const pass_type shell_type;
extern const pass_type slices_type;
extern const pass_type slices_force_type;
extern const pass_type slices_inflow_type;
extern const pass_type slices_obstacle_type;
extern const pass_type slices_templates_type;
extern const pass_type splats_type;
extern const pass_type stack_type;
extern const pass_type voxels_type;

static const pass_type geometry_type = {
    .name = "geometry",
    .shader = "pass/geometry.comp",
    .meshes = PASS_DRAWS_MESHES,
    .declare = geometry_declare,
    .check = geometry_check,
    .build = geometry_build,
    .allocate = geometry_allocate,
    .list_memory = geometry_list_memory,
    .fill = geometry_fill,
    .record = geometry_record,
    .destroy = geometry_destroy,
};

static const pass_type shade_type = {
    .name = "shade",
    .shader = "pass/shade.comp",
    .declare = shade_declare,
    .check = shade_check,
    .build = shade_build,
    .record = shade_record,
    .destroy = shade_destroy,
};

static const pass_type shadow_maps_type = {
    .name = "shadow_maps",
    .shader = "pass/shadow_maps.comp",
    .meshes = PASS_DRAWS_MESHES,
    .unscaled = true,
    .declare = shadow_maps_declare,
    .complete = shadow_maps_complete,
    .check = shadow_maps_check,
    .build = shadow_maps_build,
    .allocate = shadow_maps_allocate,
    .list_memory = shadow_maps_list_memory,
    .fill = shadow_maps_fill,
    .record = shadow_maps_record,
    .destroy = shadow_maps_destroy,
};

static const pass_type lamp_glows_type = {
    .name = "lamp_glows",
    .shader = "pass/lamp_glows.comp",
};

static const pass_type forward_type = {
    .name = "forward",
    .shader = "pass/forward.frag",
    .meshes = PASS_DRAWS_MESHES,
    .declare = forward_declare,
    .check = forward_check,
    .build = forward_build,
    .allocate = forward_allocate,
    .list_memory = forward_list_memory,
    .fill = forward_fill,
    .record = forward_record,
    .destroy = forward_destroy,
};

static const pass_type over_type = {
    .name = "over",
    .shader = "pass/over.comp",
};

static const pass_type outline_type = {
    .name = "outline",
    .shader = "pass/outline.comp",
};

static const pass_type bands_type = {
    .name = "bands",
    .shader = "pass/bands.comp",
};

static const pass_type bright_type = {
    .name = "bright",
    .shader = "pass/bright.comp",
};

static const pass_type final_type = {
    .name = "final",
    .shader = "pass/final.comp",
};

static const pass_type *const types[] = {
    &geometry_type,
    &shade_type,
    &point_lights_type,
    &shadow_maps_type,
    &lamp_glows_type,
    &forward_type,
    &lighting_type,
    &march_type,
    &stack_type,
    &reference_type,
    &over_type,
    &outline_type,
    &bands_type,
    &bright_type,
    &bloom_type,
    &final_type,
    &accumulate_type,
    &meter_type,
    &bake_type,
    &slices_templates_type,
    &voxels_type,
    &particles_type,
    &picture_type,
    &pieces_type,
    &deposit_type,
    &splats_type,
    &shell_type,
    &slices_type,
    &slices_inflow_type,
    &slices_force_type,
    &slices_obstacle_type,
    &lbm_type,
    &lbm_source_type,
};

const pass_type *const *pass_types(size_t *count) {
    *count = COUNT_OF(types);
    return types;
}

const pass_type *pass_type_find(const char *name) {
    const char *names[COUNT_OF(types)];
    for (size_t i = 0; i < COUNT_OF(types); i++) {
        if (strcmp(types[i]->name, name) == 0) return types[i];
        names[i] = types[i]->name;
    }
    const char *near = str_nearest(name, names, COUNT_OF(types));
    if (near)
        err_set("unknown pass '%s'; did you mean '%s'?", name, near);
    else
        err_set("unknown pass '%s'; `roil info passes` lists them", name);
    return NULL;
}
