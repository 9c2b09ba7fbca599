#include "app/lens.h"
#include "base/maths.h"
#include <math.h>

static const float NEAR = 1e-3f; // of what is drawn, in units of the eye's distance from the target
static const float HEIGHTS = 1000; // as scene/scene.c has it: how far without perspective

typedef float *vector; // cglm takes no const

static vector of(const float *v) {
    return (vector)(uintptr_t)v;
}

lens lens_make(const roil_camera *camera, ui_rect view, float aspect) {
    lens l = {.picture = view};
    vec3 up = {0, 0, 1};
    glm_vec3_copy(of(camera->eye), l.eye);
    glm_vec3_sub(of(camera->target), of(camera->eye), l.forward);
    if (glm_vec3_norm(l.forward) < 1e-6f) glm_vec3_copy((vec3){0, 1, 0}, l.forward);
    glm_vec3_normalize(l.forward);
    if (hypotf(l.forward[0], l.forward[1]) < 1e-4f) // as scene/scene.c has it
        glm_vec3_copy((vec3){0, 1, 0}, up);
    glm_vec3_crossn(l.forward, up, l.right);
    glm_vec3_cross(l.right, l.forward, l.up);
    l.half[1] = tanf(glm_rad(camera->fov) / 2);
    if (camera->orthographic > 0) {
        float distance = HEIGHTS * camera->orthographic;
        glm_vec3_copy(of(camera->target), l.eye);
        glm_vec3_muladds(l.forward, -distance, l.eye);
        l.half[1] = 0.5f / HEIGHTS;
    }
    l.half[0] = l.half[1] * aspect;
    float width = view.right - view.left, height = view.bottom - view.top;
    float less = width - fminf(width, height * aspect);
    float lower = height - fminf(height, width / fmaxf(aspect, 1e-6f));
    l.picture.left += less / 2;
    l.picture.right -= less / 2;
    l.picture.top += lower / 2;
    l.picture.bottom -= lower / 2;
    return l;
}

static void seen_from(const lens *l, const float p[3], float out[3]) {
    vec3 from;
    glm_vec3_sub(of(p), of(l->eye), from);
    out[0] = glm_vec3_dot(from, of(l->right));
    out[1] = glm_vec3_dot(from, of(l->up));
    out[2] = glm_vec3_dot(from, of(l->forward));
}

static void place(const lens *l, const float seen[3], float out[2]) {
    const ui_rect *r = &l->picture;
    float x = seen[0] / (seen[2] * l->half[0]), y = seen[1] / (seen[2] * l->half[1]);
    out[0] = r->left + (r->right - r->left) * (0.5f + 0.5f * x);
    out[1] = r->top + (r->bottom - r->top) * (0.5f - 0.5f * y);
}

bool lens_project(const lens *l, const float p[3], float out[2]) {
    vec3 seen;
    seen_from(l, p, seen);
    if (seen[2] < NEAR) return false;
    place(l, seen, out);
    return true;
}

bool lens_project_line(const lens *l, const float a[3], const float b[3], float out[4]) {
    vec3 from, to;
    seen_from(l, a, from);
    seen_from(l, b, to);
    if (from[2] < NEAR && to[2] < NEAR) return false;
    if (from[2] < NEAR) glm_vec3_lerp(from, to, (NEAR - from[2]) / (to[2] - from[2]), from);
    if (to[2] < NEAR) glm_vec3_lerp(to, from, (NEAR - to[2]) / (from[2] - to[2]), to);
    from[2] = fmaxf(from[2], NEAR);
    to[2] = fmaxf(to[2], NEAR);
    place(l, from, out);
    place(l, to, out + 2);
    return true;
}

void lens_ray(const lens *l, float x, float y, float out[3]) {
    const ui_rect *r = &l->picture;
    float across = 2 * (x - r->left) / fmaxf(r->right - r->left, 1) - 1;
    float along = 1 - 2 * (y - r->top) / fmaxf(r->bottom - r->top, 1);
    glm_vec3_copy(of(l->forward), out);
    glm_vec3_muladds(of(l->right), across * l->half[0], out);
    glm_vec3_muladds(of(l->up), along * l->half[1], out);
    glm_vec3_normalize(out);
}

float lens_depth(const lens *l, const float p[3]) {
    vec3 seen;
    seen_from(l, p, seen);
    return seen[2];
}

float lens_pixels(const lens *l, const float p[3]) {
    float high = l->picture.bottom - l->picture.top;
    return high / (2 * fmaxf(lens_depth(l, p), NEAR) * l->half[1]);
}

bool lens_on_plane(const lens *l, float x, float y, const float p[3], const float normal[3],
                   float out[3]) {
    vec3 ray, to;
    lens_ray(l, x, y, ray);
    glm_vec3_sub(of(p), of(l->eye), to);
    float steep = glm_vec3_dot(ray, of(normal));
    float far = glm_vec3_dot(to, of(normal)) / steep;
    if (fabsf(steep) < 1e-3f || !(far > 0)) return false;
    glm_vec3_copy(of(l->eye), out);
    glm_vec3_muladds(ray, far, out);
    return true;
}

bool lens_on_line(const lens *l, float x, float y, const float p[3], const float way[3],
                  float out[3]) {
    vec3 ray, from;
    lens_ray(l, x, y, ray);
    glm_vec3_sub(of(p), of(l->eye), from);
    float same = glm_vec3_dot(ray, of(way)), less = 1 - same * same;
    if (less < 1e-4f) return false; // seen from its end
    float ahead = glm_vec3_dot(ray, from), along = glm_vec3_dot(of(way), from);
    glm_vec3_copy(of(p), out);
    glm_vec3_muladds(of(way), (same * ahead - along) / less, out);
    return true;
}

void lens_on_sphere(const lens *l, float x, float y, const float centre[3], float radius, bool far,
                    float out[3]) {
    vec3 ray, from, aside;
    lens_ray(l, x, y, ray);
    glm_vec3_sub(of(centre), of(l->eye), from);
    float middle = glm_vec3_dot(ray, from);
    glm_vec3_copy(from, aside); // squares of a long way would leave nothing of a short one
    glm_vec3_muladds(ray, -middle, aside);
    float half = sqrtf(fmaxf(radius * radius - glm_vec3_norm2(aside), 0));
    glm_vec3_copy(of(l->eye), out);
    glm_vec3_muladds(ray, middle + (far ? half : -half), out);
}
