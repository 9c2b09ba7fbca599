#include "app/orbit.h"
#include "base/maths.h"
#include <math.h>

static const float MAX_PITCH = 89, ZOOM_STEP = 0.88f; // share of the distance that a step leaves
static const float MIN_DISTANCE = 1e-3f, MAX_DISTANCE = 1e6f;
static const float MARGIN = 1.08f; // around a framed box

// The camera's axes, as in the renderer: at yaw 0 it looks along +Y, and Z is up.
typedef struct axes {
    vec3 right, up, back;
} axes;

static axes axes_of(const orbit *o) {
    float yaw = glm_rad(o->yaw - 90), pitch = glm_rad(o->pitch);
    axes a = {.back = {cosf(pitch) * cosf(yaw), cosf(pitch) * sinf(yaw), sinf(pitch)},
              .right = {-sinf(yaw), cosf(yaw), 0}};
    glm_vec3_cross(a.back, a.right, a.up);
    return a;
}

void orbit_from(orbit *o, const roil_camera *camera) {
    float distance;
    *o = (orbit){.fov = camera->fov, .orthographic = camera->orthographic};
    orbit_angles(camera->eye, camera->target, &distance, &o->yaw, &o->pitch);
    o->distance = clampf(distance, MIN_DISTANCE, MAX_DISTANCE);
    glm_vec3_copy((float *)camera->target, o->target);
}

void orbit_to(const orbit *o, roil_camera *out) {
    axes a = axes_of(o);
    *out = (roil_camera){.fov = o->fov, .orthographic = o->orthographic};
    glm_vec3_copy((float *)o->target, out->target);
    glm_vec3_scale(a.back, o->distance, a.back);
    glm_vec3_add((float *)o->target, a.back, out->eye);
}

void orbit_turn(orbit *o, float dx, float dy) {
    o->yaw = fmodf(o->yaw + dx, 360);
    o->pitch = clampf(o->pitch + dy, -MAX_PITCH, MAX_PITCH);
}

float orbit_height(const orbit *o) {
    return o->orthographic > 0 ? o->orthographic : 2 * o->distance * tanf(glm_rad(o->fov) / 2);
}

void orbit_flatten(orbit *o) {
    o->orthographic = orbit_height(o);
}

void orbit_deepen(orbit *o) {
    if (o->orthographic > 0) o->distance = o->orthographic / (2 * tanf(glm_rad(o->fov) / 2));
    o->orthographic = 0;
}

void orbit_pan(orbit *o, float dx, float dy) {
    axes a = axes_of(o);
    float height = orbit_height(o);
    glm_vec3_muladds(a.right, -dx * height, o->target);
    glm_vec3_muladds(a.up, dy * height, o->target);
}

// Without perspective less is seen, and the eye stays: what is before it would be cut off.
void orbit_zoom(orbit *o, float steps) {
    float *size = o->orthographic > 0 ? &o->orthographic : &o->distance;
    *size = clampf(*size * powf(ZOOM_STEP, steps), MIN_DISTANCE, MAX_DISTANCE);
}

void orbit_raise(orbit *o, float height, bool shift) {
    float rise = (height - o->target[2]) / o->distance; // of the eye above the target
    float pitch = glm_deg(asinf(clampf(rise, -1, 1)));
    if (!shift) o->pitch = clampf(fmaxf(o->pitch, pitch), -MAX_PITCH, MAX_PITCH);
    float eye = o->target[2] + o->distance * sinf(glm_rad(o->pitch));
    o->target[2] += fmaxf(height - eye, 0);
}

void orbit_frame(orbit *o, const float low[3], const float high[3], float aspect) {
    float vertical = tanf(glm_rad(o->fov) / 2), horizontal = vertical * fmaxf(aspect, 1e-3f);
    axes a = axes_of(o);
    for (int i = 0; i < 3; i++) o->target[i] = (low[i] + high[i]) / 2;
    float distance = MIN_DISTANCE, height = 0;
    for (int corner = 0; corner < 8; corner++) { // each must lie within the four sides
        vec3 p;
        for (int i = 0; i < 3; i++) p[i] = (corner >> i & 1 ? high[i] : low[i]) - o->target[i];
        float nearer = glm_vec3_dot(p, a.back);
        float across = fabsf(glm_vec3_dot(p, a.right)) * MARGIN / horizontal;
        float along = fabsf(glm_vec3_dot(p, a.up)) * MARGIN / vertical;
        distance = fmaxf(distance, nearer + fmaxf(across, along));
        height = fmaxf(height, 2 * vertical * fmaxf(across, along));
    }
    if (o->orthographic > 0) o->orthographic = height;
    o->distance = clampf(distance, MIN_DISTANCE, MAX_DISTANCE);
}
