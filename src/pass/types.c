// The built-in pass types. A type without hooks is its shader and nothing else.
#include "base/memory.h"
#include "base/words.h"
#include "pass/pass_impl.h"
#include <string.h>

extern const pass_type accumulate_type;
extern const pass_type bake_type;
extern const pass_type bloom_type;
extern const pass_type deposit_type;
extern const pass_type forward_type;
extern const pass_type geometry_type;
extern const pass_type host_depth_type;
extern const pass_type lbm_source_type;
extern const pass_type lbm_templates_type;
extern const pass_type lbm_type;
extern const pass_type lighting_type;
extern const pass_type maps_type;
extern const pass_type march_type;
extern const pass_type meter_type;
extern const pass_type particles_type;
extern const pass_type picture_type;
extern const pass_type pieces_type;
extern const pass_type point_lights_type;
extern const pass_type pyro_source_type;
extern const pass_type pyro_templates_type;
extern const pass_type pyro_type;
extern const pass_type reference_type;
extern const pass_type shell_type;
extern const pass_type shade_type;
extern const pass_type shadow_maps_type;
extern const pass_type slices_type;
extern const pass_type slices_force_type;
extern const pass_type slices_inflow_type;
extern const pass_type slices_obstacle_type;
extern const pass_type slices_templates_type;
extern const pass_type splats_type;
extern const pass_type stack_type;
extern const pass_type voxels_type;

static const pass_type point_light_glows_type = {
    .name = "point_light_glows",
    .shader = "pass/light/point_light_glows.comp",
};

static const pass_type over_type = {
    .name = "over",
    .shader = "pass/picture/over.comp",
};

static const pass_type layer_type = {
    .name = "layer",
    .constructed = true,
    .shader = "pass/host/layer.comp",
};

static const pass_type media_type = {
    .name = "media",
    .constructed = true,
    .shader = "pass/host/media.comp",
};

static const pass_type outline_type = {
    .name = "outline",
    .shader = "pass/picture/outline.comp",
};

static const pass_type bands_type = {
    .name = "bands",
    .shader = "pass/picture/bands.comp",
};

static const pass_type bright_type = {
    .name = "bright",
    .shader = "pass/picture/bright.comp",
};

static const pass_type final_type = {
    .name = "final",
    .shader = "pass/picture/final.comp",
};

static const pass_type mean_type = {
    .name = "mean",
    .shader = "pass/picture/mean.comp",
    .constructed = true,
};

static const pass_type *const types[] = {
    &geometry_type,
    &shade_type,
    &point_lights_type,
    &shadow_maps_type,
    &point_light_glows_type,
    &forward_type,
    &lighting_type,
    &march_type,
    &maps_type,
    &stack_type,
    &host_depth_type,
    &layer_type,
    &media_type,
    &reference_type,
    &over_type,
    &outline_type,
    &bands_type,
    &bright_type,
    &bloom_type,
    &final_type,
    &accumulate_type,
    &mean_type,
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
    &lbm_templates_type,
    &pyro_source_type,
    &pyro_templates_type,
    &pyro_type,
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
    words_refuse(names, COUNT_OF(types), name, "`roil info passes` lists them", "unknown pass '%s'",
                 name);
    return NULL;
}
