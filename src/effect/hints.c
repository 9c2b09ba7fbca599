// What a picture does not say to its author: that lengths in it do not fit together, mostly because
// a file's unit is no metre. Told as warnings when an effect has loaded, of its first moment and of
// what has known bounds. Particles, shells and what a user's shader draws may be anywhere: where
// there are any, nothing is said about the whole.
#include "base/log.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "field/range.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const float too_large = 30;    // of all that is drawn, against the camera's distance
static const float too_small = 0.01f; // the same
static const float flat = 1e-3f;      // the shortest side against the longest: a ground
static const float landscape = 100;   // metres: a volume as long as this wants a sky behind it
static const float thick = 50;        // metres along its shortest side, of a volume
static const float solid = 150;       // optical depth of such a one that light does not get into
static const float translucent = 10;  // and of one that it does get into

typedef struct thing { // that is drawn
    const char *name;  // NULL: there is none
    float longest;     // side of its box, metres
} thing;

typedef struct view { // the camera and what it might see
    vec3 eye;
    float distance, near, far; // metres; the first is the target's
    thing smallest, largest;   // of what is not flat
    float nearest, farthest;   // metres from the eye, of all
    size_t volumes, surfaces;
    bool open;   // more may be drawn, which has no known bounds
    bool backed; // there is a sky or a surface behind volumes
} view;

// As pass/uniform.c tells of numbers: a window shows the first warning.
static void PRINTF_LIKE(2, 3) hint_tell(effect *e, const char *format, ...) {
    char text[sizeof e->host.warning];
    size_t length = (size_t)snprintf(text, sizeof text, "%s: ", e->facts.file);
    va_list list;
    va_start(list, format);
    if (length < sizeof text) vsnprintf(text + length, sizeof text - length, format, list);
    va_end(list);
    log_write(LOG_WARNING, "%s", text);
    if (!e->host.warning[0]) memcpy(e->host.warning, text, sizeof text);
}

// ---- what is drawn ----------------------------------------------------------------------------

static void box_sides(box3 box, float *shortest, float *longest) {
    float x = box.max.x - box.min.x, y = box.max.y - box.min.y, z = box.max.z - box.min.z;
    *shortest = fminf(x, fminf(y, z));
    *longest = fmaxf(x, fmaxf(y, z));
}

static void view_add(view *v, const char *name, box3 box) {
    const float low[] = {box.min.x, box.min.y, box.min.z};
    const float high[] = {box.max.x, box.max.y, box.max.z};
    vec3 least, most; // from the eye to the box, along each axis
    for (int a = 0; a < 3; a++) {
        float before = low[a] - v->eye[a], behind = v->eye[a] - high[a];
        least[a] = fmaxf(0, fmaxf(before, behind));
        most[a] = fmaxf(fabsf(before), fabsf(behind));
    }
    v->nearest = fminf(v->nearest, glm_vec3_norm(least));
    v->farthest = fmaxf(v->farthest, glm_vec3_norm(most));
    thing t = {.name = name};
    float shortest;
    box_sides(box, &shortest, &t.longest);
    if (shortest < flat * t.longest) return;
    if (!v->smallest.name || t.longest < v->smallest.longest) v->smallest = t;
    if (!v->largest.name || t.longest > v->largest.longest) v->largest = t;
}

// In the world, around the turned box of its vertices.
static bool mesh_box(const scene_mesh *mesh, const field_context *context, box3 *out) {
    mat4 transform;
    vec3 box[2] = {{mesh->data.box.min.x, mesh->data.box.min.y, mesh->data.box.min.z},
                   {mesh->data.box.max.x, mesh->data.box.max.y, mesh->data.box.max.z}};
    if (!scene_mesh_transform(mesh, context, transform)) return false;
    glm_aabb_transform(box, transform, box);
    *out = (box3){{box[0][0], box[0][1], box[0][2]}, {box[1][0], box[1][1], box[1][2]}};
    return true;
}

static bool view_add_meshes(view *v, const pass *p, const field_context *context) {
    scene_mesh *const *meshes;
    scene_instances *const *instances;
    size_t count = pass_meshes(p, &meshes);
    if (pass_instances(p, &instances) > 0) v->open = true;
    for (size_t i = 0; i < count; i++) {
        box3 box;
        if (meshes[i]->instances) continue;
        if (!mesh_box(meshes[i], context, &box)) return false;
        view_add(v, meshes[i]->name, box);
        v->surfaces++;
    }
    return true;
}

static const field *density_of(const pass *p) {
    size_t index;
    return pass_find_key(p, "density", &index) == PASS_FIELD ? pass_get_field(p, index) : NULL;
}

static bool is_unbounded(const pass *p) {
    static const char *const names[] = {"splats", "pieces", "shell", "point_light_glows", "stack"};
    size_t count, i = 0;
    const pass_type *const *types = pass_types(&count);
    for (size_t k = 0; k < COUNT_OF(names); k++)
        if (pass_is(p, names[k])) return true;
    while (i < count && !pass_is(p, types[i]->name)) i++;
    return i == count; // a shader of the user's
}

static bool view_look(view *v, const effect *e) {
    const scene_camera *camera = &e->scene.camera;
    const float3 nowhere = {0, 0, 0};
    float near[4], far[4];
    vec3 target;
    *v = (view){.nearest = INFINITY};
    if (!scene_camera_eye(camera, &e->context, v->eye, target) ||
        !field_eval(camera->near, &e->context, nowhere, near) ||
        !field_eval(camera->far, &e->context, nowhere, far))
        return false;
    v->distance = glm_vec3_distance(v->eye, target);
    v->near = near[0];
    v->far = far[0];
    for (size_t i = 0; i < e->pass_count; i++) {
        const pass *p = e->passes[i];
        box3 box;
        if (!effect_runs(e, p)) continue;
        if (is_unbounded(p)) v->open = true;
        if (pass_is(p, "shade") || pass_is(p, "forward")) v->backed = true;
        if (pass_draws_meshes(p) && !view_add_meshes(v, p, &e->context)) return false;
        if (!pass_is(p, "march") && !pass_is(p, "reference")) continue;
        v->backed = v->backed || pass_is(p, "reference");
        v->volumes++;
        if (!field_bounds_of_grids(density_of(p), &e->context, &box)) return false;
        if (box3_is_finite(box) && !box3_is_empty(box)) view_add(v, pass_label(p), box);
    }
    return true;
}

// ---- what is said of it -----------------------------------------------------------------------

// Returns whether it has.
static bool tell_of_sizes(effect *e, const view *v) {
    const char *advice = "lengths are metres: scale it, or move the camera";
    if (v->open || !v->smallest.name) return false;
    bool large = v->smallest.longest > too_large * v->distance;
    bool small = v->largest.longest < too_small * v->distance;
    if (large)
        hint_tell(e, "'%s' is %.3g m long, and the camera is only %.3g m away from its target; %s",
                  v->smallest.name, (double)v->smallest.longest, (double)v->distance, advice);
    else if (small)
        hint_tell(e, "'%s' is only %.3g m long, and the camera is %.3g m away from its target; %s",
                  v->largest.name, (double)v->largest.longest, (double)v->distance, advice);
    return large || small;
}

// Volumes are seen at any distance.
static void tell_of_planes(effect *e, const view *v) {
    if (v->open || v->volumes || !v->surfaces) return;
    if (v->nearest > v->far)
        hint_tell(e,
                  "all meshes are at least %.3g m away from the camera, whose 'far' is %.3g m, so "
                  "that none is seen; raise it, or scale or move them",
                  (double)v->nearest, (double)v->far);
    else if (v->farthest < v->near)
        hint_tell(e,
                  "all meshes are within %.3g m of the camera, whose 'near' is %.3g m, so that "
                  "none is seen; lower it, or scale or move them",
                  (double)v->farthest, (double)v->near);
}

// Values of grids are not read yet: those of clouds and smoke go from 0 to 1.
static void tell_of_density(effect *e, const pass *p) {
    const field *density = density_of(p);
    field_context context = e->context;
    float shortest, longest;
    intervals range;
    box3 box;
    context.unread = 1;
    if (!field_bounds_of_grids(density, &context, &box) || !box3_is_finite(box) ||
        !field_ranges(density, &context, box, &range))
        return;
    box_sides(box, &shortest, &longest);
    const float most = range.c[0].high, depth = most * shortest;
    if (shortest < thick || depth < solid || most >= 1e30f) return;
    hint_tell(e,
              "%s: 'density' comes to %.2g per metre in a volume that is %.3g m across: light "
              "gets no farther than %.2g m into it, and it looks solid; make it thinner (%.2g "
              "times as dense is a cloud), or scale it if its unit is not the metre",
              pass_label(p), (double)most, (double)shortest, (double)(3 / most),
              (double)(translucent / depth));
}

static void tell_of_sky(effect *e, const view *v) {
    if (v->open || v->backed || !v->volumes || v->largest.longest < landscape) return;
    hint_tell(e,
              "'%s' is %.3g m long, and nothing draws a sky behind it: the picture is black there; "
              "lay it over one by 'over' and 'shade', whose sky is `fx.sky`",
              v->largest.name, (double)v->largest.longest);
}

void effect_tell_hints(effect *e) {
    view v;
    if (!view_look(&v, e)) return;
    tell_of_planes(e, &v);
    if (!tell_of_sizes(e, &v)) tell_of_sky(e, &v);
    for (size_t i = 0; i < e->pass_count; i++)
        if (effect_runs(e, e->passes[i]) && pass_is(e->passes[i], "march"))
            tell_of_density(e, e->passes[i]);
}
