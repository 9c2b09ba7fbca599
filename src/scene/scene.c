// Camera, sun and sky, evaluated once a frame into the block that every shader reads. Z is up.
#include "scene/scene_impl.h"
#include "scene/sky_image.h"
#include <cglm/clipspace/persp_rh_zo.h>
#include <math.h>
#include <string.h>

void scene_init(scene *s, arena *memory) {
    s->camera = (scene_camera){0};
    s->sun = (scene_sun){0};
    s->sky = (scene_sky){0};
    scene_set_defaults(scene_camera_values, SCENE_ALL, &s->camera, memory);
    scene_set_defaults(scene_sun_values, SCENE_ALL, &s->sun, memory);
    scene_set_defaults(scene_sky_values, SCENE_ALL, &s->sky, memory);
}

bool scene_evaluate(const field *node, const field_context *context, float out[4]) {
    if (!field_eval(node, context, (float3){0, 0, 0}, out)) return false;
    for (int i = 1; node->components == 1 && i < 4; i++) out[i] = out[0];
    return true;
}

bool scene_evaluate_scalar(const field *node, const field_context *context, float *out) {
    float value[4];
    if (!scene_evaluate(node, context, value)) return false;
    *out = value[0];
    return true;
}

float scene_limit(float value, float low, float high) {
    return isnan(value) ? low : clampf(value, low, high);
}

float scene_limit_light(float value) {
    return scene_limit(value, 0, 1e12f);
}

static float radians(float degrees) {
    return isfinite(degrees) ? glm_rad(fmodf(degrees, 360)) : 0;
}

void scene_direction(float azimuth, float elevation, vec3 out) {
    float a = radians(azimuth), e = radians(elevation);
    out[0] = cosf(e) * cosf(a);
    out[1] = cosf(e) * sinf(a);
    out[2] = sinf(e);
}

bool scene_camera_eye(const scene_camera *c, const field_context *context, vec3 eye, vec3 target) {
    float value[4], distance, yaw, pitch;
    if (!scene_evaluate(c->target, context, value)) return false;
    glm_vec3_copy(value, target);
    if (c->eye) {
        if (!scene_evaluate(c->eye, context, value)) return false;
        glm_vec3_copy(value, eye);
        return true;
    }
    if (!scene_evaluate_scalar(c->distance, context, &distance) ||
        !scene_evaluate_scalar(c->yaw, context, &yaw) ||
        !scene_evaluate_scalar(c->pitch, context, &pitch))
        return false;
    vec3 back; // from the target to the eye: at yaw 0 the camera looks along +Y
    scene_direction(yaw - 90, clampf(pitch, -89.9f, 89.9f), back);
    glm_vec3_scale(back, distance, back);
    glm_vec3_add(target, back, eye);
    return true;
}

// An orthographic camera is one that stands far behind its place and sees little to the sides. Its
// lines of sight are parallel but for half a thousandth, which moves what is as deep as it is high
// by a quarter of a pixel in a picture of a thousand; and all that draws knows perspective alone.
// Returns by how much the eye has moved (m).
static float step_back(float height, vec3 eye, const vec3 target, const vec3 forward, float *fov,
                       float *near, float *far) {
    const float heights = 1000; // that it stands away from its target
    if (!(height > 0)) return 0;
    float moved = heights * height - glm_vec3_distance(eye, (float *)(uintptr_t)target);
    glm_vec3_muladds((float *)(uintptr_t)forward, -moved, eye);
    *fov = 2 * glm_deg(atanf(0.5f / heights));
    *near += moved;
    *far += moved;
    return moved;
}

static bool fill_camera(const scene_camera *c, const field_context *context, float aspect,
                        struct frame_block *out) {
    vec3 eye, target, forward, up = {0, 0, 1};
    float fov, near, far, height, aperture, focus;
    if (!scene_camera_eye(c, context, eye, target) ||
        !scene_evaluate_scalar(c->fov, context, &fov) ||
        !scene_evaluate_scalar(c->near, context, &near) ||
        !scene_evaluate_scalar(c->far, context, &far) ||
        !scene_evaluate_scalar(c->orthographic, context, &height) ||
        !scene_evaluate_scalar(c->aperture, context, &aperture) ||
        !scene_evaluate_scalar(c->focus, context, &focus))
        return false;
    fov = clampf(fov, 1, 170);
    near = fmaxf(near, 1e-4f);
    far = fmaxf(far, near * 2);
    glm_vec3_sub(target, eye, forward);
    if (glm_vec3_norm(forward) < 1e-6f) glm_vec3_copy((vec3){0, 1, 0}, forward);
    glm_vec3_normalize(forward);
    if (!(focus > 0)) focus = glm_vec3_distance(eye, target);
    const float moved = step_back(height, eye, target, forward, &fov, &near, &far);
    // Straight up or down has no up of its own; an orbit, which ends at 89.9 degrees, keeps its
    // yaw.
    if (hypotf(forward[0], forward[1]) < 1e-4f) glm_vec3_copy((vec3){0, 1, 0}, up);

    // The inverse first, since it is the axes as they are; glm_look would lose digits far away.
    mat4 view, projection, inverse = GLM_MAT4_IDENTITY_INIT;
    glm_vec3_crossn(forward, up, inverse[0]);
    glm_vec3_cross(inverse[0], forward, inverse[1]);
    glm_vec3_negate_to(forward, inverse[2]);
    glm_vec3_copy(eye, inverse[3]);
    glm_mat4_copy(inverse, view);
    glm_inv_tr(view);
    glm_perspective_rh_zo(glm_rad(fov), aspect, near, far, projection);
    projection[1][1] = -projection[1][1]; // Vulkan's y points down
    mat4 last;
    glm_mat4_mul(projection, view, last);
    memcpy(out->last.m, last, sizeof last);
    memcpy(out->view.m, view, sizeof view);
    memcpy(out->projection.m, projection, sizeof projection);
    memcpy(out->view_inverse.m, inverse, sizeof inverse);
    float half = tanf(glm_rad(fov) * 0.5f);
    out->eye = (shared_vec4){{eye[0], eye[1], eye[2], moved}};
    out->lens = (shared_vec4){{half * aspect, half, near, far}};
    out->shift = (shared_vec4){0};
    out->sight =
        (shared_vec4){{0, 0, moved > 0 ? 0 : 0.5f * fmaxf(aperture, 0), fmaxf(focus, near)}};
    return true;
}

// What moves lines of sight by the same slope everywhere is a shear of the camera's space: with it
// in `view`, all that projects places and all that sends rays are moved alike.
void scene_move_sight(struct frame_block *frame, const float picture[2], const float lens[2]) {
    const float radius = frame->sight.v[2], focus = frame->sight.v[3];
    mat4 view, inverse, shear = GLM_MAT4_IDENTITY_INIT;
    memcpy(inverse, frame->view_inverse.m, sizeof inverse);
    float slope[2];
    for (int i = 0; i < 2; i++) {
        const float across = radius * lens[i];
        slope[i] = (i == 0 ? 2 : -2) * picture[i] * frame->lens.v[i] - across / focus;
        glm_vec3_muladds(inverse[i], across, inverse[3]);
    }
    glm_mat4_copy(inverse, view);
    glm_inv_tr(view);
    for (int i = 0; i < 2; i++) shear[2][i] = slope[i];
    glm_mat4_mul(shear, view, view);
    for (int i = 0; i < 2; i++) shear[2][i] = -slope[i];
    glm_mat4_mul(inverse, shear, inverse);
    memcpy(frame->view.m, view, sizeof view);
    memcpy(frame->view_inverse.m, inverse, sizeof inverse);
    memcpy(frame->eye.v, inverse[3], 3 * sizeof(float));
    memcpy(frame->sight.v, slope, sizeof slope);
}

static bool fill_sun(const scene_sun *sun, const field_context *context, struct frame_block *out) {
    float azimuth, elevation, strength, color[4];
    if (!scene_evaluate_scalar(sun->azimuth, context, &azimuth) ||
        !scene_evaluate_scalar(sun->elevation, context, &elevation) ||
        !scene_evaluate(sun->color, context, color) ||
        !scene_evaluate_scalar(sun->strength, context, &strength))
        return false;
    vec3 towards;
    scene_direction(azimuth, elevation, towards);
    out->sun_direction = (shared_vec4){{towards[0], towards[1], towards[2], 0}};
    out->sun_radiance = (shared_vec4){0};
    for (int i = 0; i < 3; i++)
        out->sun_radiance.v[i] = scene_limit_light(color[i] * strength / GLM_PIf);
    return true;
}

// Mixes the sky's two colours between day and night. Shaders mix an image.
static bool fill_night(const scene_sky *sky, const field_context *context,
                       struct frame_block *out) {
    float night, zenith[4], horizon[4], stars, moon;
    out->night_zenith = out->night_horizon = (shared_vec4){0};
    if (!sky->night) return true;
    if (!scene_evaluate_scalar(sky->night, context, &night) ||
        !scene_evaluate(sky->night_zenith, context, zenith) ||
        !scene_evaluate(sky->night_horizon, context, horizon) ||
        !scene_evaluate_scalar(sky->stars, context, &stars) ||
        !scene_evaluate_scalar(sky->moon, context, &moon))
        return false;
    night = scene_limit(night, 0, 1);
    for (int i = 0; i < 3; i++) {
        out->night_zenith.v[i] = scene_limit_light(zenith[i]);
        out->night_horizon.v[i] = scene_limit_light(horizon[i]);
        out->sky_zenith.v[i] = mixf(out->sky_zenith.v[i], out->night_zenith.v[i], night);
        out->sky_horizon.v[i] = mixf(out->sky_horizon.v[i], out->night_horizon.v[i], night);
    }
    out->night_zenith.v[3] = night;
    out->night_horizon.v[3] = scene_limit_light(stars);
    out->sun_direction.v[3] = radians(scene_limit(moon, 0, 90) / 2);
    return true;
}

static bool fill_sky(const scene_sky *sky, const field_context *context, struct frame_block *out) {
    float zenith[4], horizon[4], strength, rotation;
    if (!scene_evaluate(sky->zenith, context, zenith) ||
        !scene_evaluate(sky->horizon, context, horizon) ||
        !scene_evaluate_scalar(sky->strength, context, &strength) ||
        !scene_evaluate_scalar(sky->rotation, context, &rotation))
        return false;
    if (sky->image) {
        sky_image_means(sky->image, zenith, horizon);
        strength = scene_limit_light(strength);
        out->sky_zenith.v[3] = strength;
        out->sky_horizon.v[3] = radians(rotation);
    }
    for (int i = 0; i < 3; i++) {
        out->sky_zenith.v[i] = scene_limit_light(zenith[i] * strength);
        out->sky_horizon.v[i] = scene_limit_light(horizon[i] * strength);
    }
    return fill_night(sky, context, out);
}

bool scene_fill_frame(const scene *s, const field_context *context, float aspect,
                      struct frame_block *out) {
    return fill_camera(&s->camera, context, aspect, out) && fill_sun(&s->sun, context, out) &&
           fill_sky(&s->sky, context, out);
}
