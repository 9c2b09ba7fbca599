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
        .meshes = PASS_DRAWS_MESHES,
        .declare = geometry_declare,
        .check = geometry_check,
        .build = geometry_build,
        .allocate = geometry_allocate,
        .fill = geometry_fill,
        .record = geometry_record,
    },
    {
        .name = "shade",
        .shader = "pass/shade.comp",
        .check = shade_check,
        .build = shade_build,
        .record = shade_record,
        .destroy = shade_destroy,
    },
    {
        .name = "lighting",
        .shader = "pass/lighting.comp",
        .declare = lighting_declare,
        .check = lighting_check,
        .build = lighting_build,
        .fill = lighting_fill,
        .destroy = lighting_destroy,
    },
    {
        .name = "march",
        .shader = "pass/march.comp",
        .declare = march_declare,
        .check = march_check,
        .build = march_build,
        .fill = march_fill,
        .record = march_record,
        .destroy = march_destroy,
    },
    {
        .name = "stack",
        .shader = "pass/stack.comp",
        .declare = stack_declare,
        .fill = stack_fill,
    },
    {
        .name = "reference",
        .shader = "pass/reference.comp",
        .declare = reference_declare,
        .check = reference_check,
        .build = reference_build,
        .fill = reference_fill,
        .record = reference_record,
        .destroy = reference_destroy,
    },
    {
        .name = "over",
        .shader = "pass/over.comp",
    },
    {
        .name = "bright",
        .shader = "pass/bright.comp",
    },
    {
        .name = "bloom",
        .shader = "pass/bloom.comp",
        .declare = bloom_declare,
        .check = bloom_check,
        .build = bloom_build,
        .record = bloom_record,
        .destroy = bloom_destroy,
    },
    {
        .name = "final",
        .shader = "pass/final.comp",
    },
    {
        .name = "accumulate",
        .shader = "pass/accumulate.comp",
        .declare = accumulate_declare,
    },
    {
        .name = "meter",
        .shader = "pass/meter.comp",
        .declare = meter_declare,
    },
    {
        .name = "bake",
        .shader = "pass/bake.comp",
        .declare = bake_declare,
        .check = bake_check,
        .build = bake_build,
        .fill = bake_fill,
        .record = bake_record,
        .destroy = bake_destroy,
    },
    {
        .name = "slices_templates",
        .shader = "pass/slices_templates.comp",
        .declare = slices_templates_declare_group,
        .check = slices_templates_check_group,
        .build = slices_templates_build_group,
        .fill = slices_templates_fill_group,
        .unscaled = true,
    },
    {
        .name = "voxels",
        .shader = "pass/voxels.comp",
        .meshes = PASS_USES_MESHES,
        .declare = voxels_declare,
        .check = voxels_check_pass,
        .build = voxels_build_pass,
        .allocate = voxels_allocate_pass,
        .fill = voxels_fill,
        .record = voxels_record,
        .destroy = voxels_destroy_pass,
    },
    {
        .name = "particles",
        .shader = "pass/particles.comp",
        .meshes = PASS_USES_MESHES,
        .unscaled = true,
        .simulation = &particles_simulation,
        .declare = particles_declare,
        .check = particles_check,
        .build = particles_build,
        .allocate = particles_allocate,
        .fill = particles_fill,
        .rehearse = particles_rehearse,
        .record = particles_record,
        .destroy = particles_destroy,
    },
    {
        .name = "picture",
        .shader = "pass/picture.comp",
        .unscaled = true,
        .declare = picture_declare,
        .check = picture_check,
        .build = picture_build,
        .record = picture_record,
    },
    {
        .name = "pieces",
        .shader = "pass/pieces.comp",
        .meshes = PASS_USES_MESHES,
        .declare = pieces_declare,
        .check = pieces_check,
        .build = pieces_build,
        .allocate = pieces_allocate,
        .fill = pieces_fill,
        .record = pieces_record,
        .destroy = pieces_destroy,
    },
    {
        .name = "deposit",
        .shader = "pass/deposit.comp",
        .unscaled = true,
        .declare = deposit_declare,
        .check = deposit_check,
        .build = deposit_build,
        .allocate = deposit_allocate,
        .fill = deposit_fill,
        .record = deposit_record,
        .destroy = deposit_destroy,
    },
    {
        .name = "splats",
        .shader = "pass/splats.comp",
        .declare = splats_declare,
        .check = splats_check,
        .build = splats_build,
        .fill = splats_fill,
        .record = splats_record,
        .destroy = splats_destroy,
    },
    {
        .name = "slices",
        .shader = "pass/slices.comp",
        .unscaled = true,
        .simulation = &slices_simulation,
        .declare = slices_declare,
        .complete = slices_complete,
        .check = slices_check,
        .build = slices_build,
        .allocate = slices_allocate,
        .fill = slices_fill,
        .rehearse = slices_rehearse,
        .record = slices_record,
        .destroy = slices_destroy,
    },
    {
        .name = "slices_inflow",
        .shader = "pass/slices_inflow.comp",
        .unscaled = true,
        .declare = slices_part_declare,
        .check = slices_part_check,
        .build = slices_part_build,
        .fill = slices_part_fill,
    },
    {
        .name = "slices_force",
        .shader = "pass/slices_force.comp",
        .unscaled = true,
        .declare = slices_part_declare,
        .check = slices_part_check,
        .build = slices_part_build,
        .fill = slices_part_fill,
    },
    {
        .name = "slices_obstacle",
        .shader = "pass/slices_obstacle.comp",
        .unscaled = true,
        .declare = slices_part_declare,
        .check = slices_part_check,
        .build = slices_part_build,
        .allocate = slices_part_allocate,
        .fill = slices_part_fill,
        .destroy = slices_part_destroy,
    },
    {
        .name = "lbm",
        .shader = "pass/lbm.comp",
        .unscaled = true,
        .simulation = &lbm_simulation,
        .declare = lbm_declare,
        .complete = lbm_complete,
        .check = lbm_check,
        .build = lbm_build_pass,
        .allocate = lbm_allocate_pass,
        .fill = lbm_fill,
        .rehearse = lbm_rehearse,
        .record = lbm_record,
        .destroy = lbm_destroy_pass,
    },
    {
        .name = "lbm_source",
        .shader = "pass/lbm_source.comp",
        .unscaled = true,
        .meshes = PASS_USES_MESHES,
        .declare = lbm_source_declare,
        .check = lbm_source_check,
        .build = lbm_source_build,
        .fill = lbm_source_fill,
        .destroy = lbm_source_destroy,
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
