// Sun and lights, evaluated once a frame into the block that shaders read.
#include "base/error.h"
#include "scene/scene_impl.h"
#include <math.h>
#include <string.h>

static const float place_max = 1e9f;

static bool evaluate_place(const field *node, const field_context *context, vec3 out) {
    float value[4];
    if (!scene_evaluate(node, context, value)) return false;
    for (int i = 0; i < 3; i++) out[i] = scene_limit(value[i], -place_max, place_max);
    return true;
}

// Evaluates a colour times a number.
static bool evaluate_color(const field *color, const field *factor, float scale,
                           const field_context *context, struct light_entry *out) {
    float value[4], strength;
    if (!scene_evaluate(color, context, value) ||
        !scene_evaluate_scalar(factor, context, &strength))
        return false;
    for (int i = 0; i < 3; i++) out->color.v[i] = scene_limit_light(value[i] * strength * scale);
    return true;
}

static bool fill_sun(const scene_sun *sun, const field_context *context, struct light_entry *out) {
    float azimuth, elevation, angle;
    if (!scene_evaluate_scalar(sun->azimuth, context, &azimuth) ||
        !scene_evaluate_scalar(sun->elevation, context, &elevation) ||
        !scene_evaluate_scalar(sun->angle, context, &angle) ||
        !evaluate_color(sun->color, sun->strength, 1, context, out))
        return false;
    scene_direction(azimuth, elevation, out->position.v);
    out->position.v[3] = sinf(glm_rad(scene_limit(angle, 0, 180)) / 2);
    out->color.v[3] = LIGHT_SUN;
    return true;
}

// The edge of the cone is smoothed in the cosine, as Blender's spot lights are.
static bool fill_spot(const scene_light *light, const field_context *context,
                      struct light_entry *out) {
    vec3 target, axis;
    float angle, softness;
    if (!evaluate_place(light->target, context, target) ||
        !scene_evaluate_scalar(light->angle, context, &angle) ||
        !scene_evaluate_scalar(light->softness, context, &softness))
        return false;
    glm_vec3_sub(target, out->position.v, axis);
    if (!(glm_vec3_norm(axis) > 1e-6f)) glm_vec3_copy((vec3){0, 0, -1}, axis);
    glm_vec3_normalize(axis);
    float outer = cosf(glm_rad(scene_limit(angle, 0.1f, 360)) / 2);
    glm_vec3_copy(axis, out->axis.v);
    out->axis.v[3] = outer;
    out->spread.v[0] = mixf(outer, 1, scene_limit(softness, 0, 1));
    return true;
}

static bool fill_light(const scene_light *light, const field_context *context,
                       struct light_entry *out) {
    float radius, range = 0;
    const float sphere = 4 * GLM_PIf; // W to W/sr
    if (!evaluate_place(light->position, context, out->position.v) ||
        !scene_evaluate_scalar(light->radius, context, &radius) ||
        (light->range && !scene_evaluate_scalar(light->range, context, &range)) ||
        !evaluate_color(light->color, light->power, 1 / sphere, context, out))
        return false;
    out->position.v[3] = scene_limit(radius, 0, place_max);
    out->color.v[3] = (float)light->kind;
    out->spread.v[1] = scene_limit(range, 0, place_max);
    out->spread.v[2] = light->linear && range > 0;
    return light->kind != SCENE_SPOT || fill_spot(light, context, out);
}

bool scene_fill_lights(const scene *s, const field_context *context, struct light_block *out) {
    memset(out, 0, sizeof *out);
    out->count.v[0] = (uint32_t)s->light_count + 1;
    if (!fill_sun(&s->sun, context, &out->lights[0])) return err_prefix("sun: ");
    for (size_t i = 0; i < s->light_count; i++)
        if (!fill_light(&s->lights[i], context, &out->lights[i + 1]))
            return err_prefix("light %zu: ", i + 1);
    return true;
}
