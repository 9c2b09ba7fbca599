// A material's colour and texture become those of the mesh's parts, which are copied for it, so
// that everything that reads parts sees them. The colour is then white there, and the field
// multiplies all of it.
#include "scene/material.h"
#include "base/error.h"
#include "scene/scene_impl.h"

static const float emission_max = 1e4f; // that a half float holds several times over

void scene_mesh_set_material(scene_mesh *mesh, const scene_material *material, arena *memory) {
    mesh_data *data = &mesh->data;
    mesh->material = material;
    if (!material->color && !material->texture) return;
    mesh_part *parts = arena_copy(memory, data->parts, data->part_count * sizeof *parts);
    for (uint32_t i = 0; i < data->part_count; i++) {
        for (int c = 0; c < 4; c++) parts[i].color[c] = 1;
        parts[i].texture = material->texture ? 0 : -1;
    }
    data->parts = parts;
    data->textures = material->texture;
    data->texture_count = material->texture ? 1 : 0;
}

// Returns whether a number is zero at all times. A number with a name can be set at any time.
static bool is_none(const scene_material *m, const field *node) {
    if (m->name) return false;
    if (!field_is_constant(node)) return false;
    for (int i = 0; i < node->components; i++)
        if (node->value[i] != 0) return false;
    return true;
}

static bool glows(const scene_material *m, const mesh_part *part) {
    if (m && m->emission) return !is_none(m, m->emission);
    return part->emission[0] + part->emission[1] + part->emission[2] > 0;
}

bool scene_mesh_glows(const scene_mesh *mesh) {
    for (uint32_t i = 0; i < mesh->data.part_count; i++)
        if (glows(mesh->material, &mesh->data.parts[i])) return true;
    return false;
}

static bool is_matte(const scene_material *m, const mesh_part *part) {
    bool specular = m && m->specular ? !is_none(m, m->specular) : part->specular > 0;
    bool metallic = m && m->metallic ? !is_none(m, m->metallic) : part->metallic > 0;
    return !specular && !metallic && !glows(m, part);
}

bool scene_mesh_is_matte(const scene_mesh *mesh) {
    if (mesh->material && mesh->material->no_toon) return false;
    for (uint32_t i = 0; i < mesh->data.part_count; i++)
        if (!is_matte(mesh->material, &mesh->data.parts[i])) return false;
    return true;
}

static bool evaluate_share(const field *node, const field_context *context, float *out) {
    *out = -1;
    if (!node) return true;
    if (!scene_evaluate_scalar(node, context, out)) return false;
    *out = scene_limit(*out, 0, 1);
    return true;
}

static bool material_evaluate(const scene_material *m, const field_context *context,
                              scene_look *out) {
    float color[4] = {1, 1, 1, 1}, emission[4] = {-1, -1, -1, -1};
    if ((m->color && !scene_evaluate(m->color, context, color)) ||
        (m->emission && !scene_evaluate(m->emission, context, emission)) ||
        !evaluate_share(m->specular, context, &out->specular) ||
        !evaluate_share(m->roughness, context, &out->roughness) ||
        !evaluate_share(m->metallic, context, &out->metallic))
        return false;
    for (int i = 0; i < 3; i++) {
        out->tint[i] = scene_limit_light(out->tint[i] * color[i]);
        out->emission[i] = m->emission ? scene_limit(emission[i], 0, emission_max) : -1;
    }
    out->toon = m->no_toon ? 0 : 1;
    return true;
}

bool scene_mesh_look(const scene_mesh *mesh, const field_context *context, scene_look *out) {
    float tint[4];
    *out = (scene_look){
        .specular = -1, .roughness = -1, .metallic = -1, .emission = {-1, -1, -1}, .toon = 1};
    if (!scene_evaluate(mesh->color, context, tint)) return err_prefix("%s: ", mesh->name);
    for (int i = 0; i < 3; i++) out->tint[i] = scene_limit_light(tint[i]);
    return !mesh->material || material_evaluate(mesh->material, context, out) ||
           err_prefix("%s: material: ", mesh->name);
}

static float chosen(float said, float otherwise) {
    return said < 0 ? otherwise : said;
}

void scene_look_part(const scene_look *look, const mesh_part *part, float surface[4],
                     float emission[4]) {
    surface[0] = chosen(look->specular, part->specular);
    surface[1] = chosen(look->roughness, part->roughness);
    surface[2] = chosen(look->metallic, part->metallic);
    surface[3] = look->toon;
    for (int i = 0; i < 3; i++) emission[i] = chosen(look->emission[i], part->emission[i]);
    emission[3] = 0;
}
