// Where things are in space, and which controls move them.
#include "base/error.h"
#include "base/memory.h"
#include "effect/things.h"
#include "roil/roil_impl.h"
#include <math.h>
#include <string.h>

static const float FINE = 1e5f; // what is set is rounded to parts of a metre, or of a degree

const char *const roil_things[ROIL_THINGS] = {
    "camera", "sun", "light", "shape", "particles", "mesh", "node", "volume",
};

typedef struct point { // a handle, and how it follows from fields
    roil_handle face;
    const field *node;        // NULL: it follows from nothing that moves
    const scene_node *parent; // whose space the field is in
    float axes[3][3];         // what one unit of each component of the control is in the world
} point;

typedef struct points {
    roil_effect *e;
    const field_context *context;
    point *list;
    size_t count, capacity;
} points;

// ---- evaluating ---------------------------------------------------------------------------------

static bool evaluate(const field *node, const field_context *context, float out[3]) {
    float value[4];
    if (!node || !node->uniform || !field_eval(node, context, (float3){0, 0, 0}, value))
        return false;
    for (int i = 0; i < 3; i++) {
        out[i] = value[node->components == 1 ? 0 : i];
        if (!isfinite(out[i])) return false;
    }
    return true;
}

static bool evaluate_place(const point *p, const field_context *context, float out[3]) {
    mat4 outer;
    vec3 own;
    if (!evaluate(p->node, context, own) || !scene_node_transform(p->parent, context, outer))
        return false;
    glm_mat4_mulv3(outer, own, 1, out);
    return true;
}

static bool evaluate_camera(roil_effect *e, const field_context *context, float out[3]) {
    scene_camera camera = effect_scene(e->effect)->camera;
    const struct {
        const char *name;
        const field **slot;
    } parts[] = {{"eye", &camera.eye},
                 {"target", &camera.target},
                 {"distance", &camera.distance},
                 {"yaw", &camera.yaw},
                 {"pitch", &camera.pitch}};
    for (size_t i = 0; i < COUNT_OF(parts); i++) {
        const effect_control *c = effect_control_named(e->effect, "camera", parts[i].name);
        if (c && c->moved) *parts[i].slot = effect_control_original(c);
    }
    vec3 target;
    return scene_camera_eye(&camera, context, out, target);
}

// ---- the list -----------------------------------------------------------------------------------

static point *add(points *all, const point *p) {
    MEM_RESERVE(all->list, all->count + 1, all->capacity);
    all->list[all->count] = *p;
    return &all->list[all->count++];
}

static point point_of(roil_thing thing, const char *name, const char *part, const field *node) {
    return (point){
        .face = {.thing = thing, .name = name, .part = part, .key = SIZE_MAX},
        .node = node,
        .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    };
}

static void find_control(points *all, point *p, int components) {
    const effect_control *c = effect_control_behind(all->e->effect, p->node);
    if (!c || c->kind == EFFECT_CONTROL_CURVE || c->desc->components != components) return;
    size_t index;
    roil_control face;
    if (!roil_find_control(all->e, c->name, &index)) return;
    roil_get_control(all->e, index, &face);
    p->face.control = c->name;
    p->face.structural = face.structural;
}

// Adds the keys of a curve that a place follows.
static void add_keys(points *all, const point *whole) {
    const effect_control *c = effect_control_behind(all->e->effect, whole->node);
    if (!c || c->kind != EFFECT_CONTROL_CURVE) return;
    const curve *way = effect_control_curve(c);
    if (way->components != 3 || way->count > ROIL_MAX_STOPS) return;
    point p = *whole;
    mat4 outer;
    if (!scene_node_transform(p.parent, all->context, outer)) return;
    p.face.part = "key";
    p.face.control = c->name;
    p.face.moves = false;
    p.face.radius = 0;
    memset(p.face.high, 0, sizeof p.face.high);
    memset(p.face.low, 0, sizeof p.face.low);
    for (p.face.key = 0; p.face.key < way->count; p.face.key++) {
        glm_mat4_mulv3(outer, (float *)(uintptr_t)way->keys[p.face.key].value, 1, p.face.at);
        add(all, &p);
    }
}

// Adds a place: three components in metres. False: it is nowhere.
static bool add_place(points *all, point *p) {
    mat4 outer;
    if (!evaluate_place(p, all->context, p->face.at) ||
        !scene_node_transform(p->parent, all->context, outer))
        return false;
    for (int i = 0; i < 3; i++) glm_vec3_copy(outer[i], p->axes[i]);
    find_control(all, p, 3);
    p->face.moves = !p->face.control && !field_is_constant(p->node);
    const point added = *add(all, p);
    if (p->face.moves) add_keys(all, &added);
    return true;
}

// Adds a length from a place that was added, such as a radius, where a control sets it.
static void add_length(points *all, const point *from, const char *part, const field *node,
                       const float line[3]) {
    point p = point_of(from->face.thing, from->face.name, part, node);
    float length[3];
    if (!evaluate(node, all->context, length) || !(length[0] > 0)) return;
    find_control(all, &p, 1);
    if (!p.face.control) return;
    p.face.along = true;
    p.face.radius = length[0];
    glm_vec3_copy((float *)(uintptr_t)line, p.axes[0]);
    glm_vec3_copy((float *)(uintptr_t)line, p.face.line);
    glm_vec3_copy((float *)(uintptr_t)from->face.at, p.face.at);
    glm_vec3_muladds((float *)(uintptr_t)line, length[0], p.face.at);
    add(all, &p);
}

static const float across[3] = {1, 0, 0};

// ---- things -------------------------------------------------------------------------------------

// What the script has it look at, where keys say that.
static void add_camera_target(points *all) {
    effect *e = all->e->effect;
    const effect_control *target = effect_control_named(e, "camera", "target");
    if (!target) return;
    const field *own =
        target->moved ? effect_control_original(target) : effect_control_field(e, target);
    const effect_control *way = own ? effect_control_behind(e, own) : NULL;
    point p = point_of(ROIL_CAMERA, "camera", "target", own);
    if (way && way->kind == EFFECT_CONTROL_CURVE && way->desc->components != 1) add_place(all, &p);
}

static void add_camera(points *all) {
    const effect_control *eye = effect_control_named(all->e->effect, "camera", "eye");
    point p = point_of(ROIL_CAMERA, "camera", "position", NULL);
    if (!eye || !evaluate_camera(all->e, all->context, p.face.at)) return;
    const field *own =
        eye->moved ? effect_control_original(eye) : effect_control_field(all->e->effect, eye);
    p.face.moves = true;
    add(all, &p);
    p.node = own;
    if (own) add_keys(all, &p);
    add_camera_target(all);
}

static void add_sun(points *all) {
    const scene_sun *sun = &effect_scene(all->e->effect)->sun;
    point p = point_of(ROIL_SUN, "sun", "direction", sun->azimuth);
    point up = point_of(ROIL_SUN, "sun", "direction", sun->elevation);
    float azimuth[3], elevation[3];
    if (!evaluate(sun->azimuth, all->context, azimuth) ||
        !evaluate(sun->elevation, all->context, elevation))
        return;
    scene_direction(azimuth[0], elevation[0], p.face.at);
    find_control(all, &p, 1);
    find_control(all, &up, 1);
    p.face.second = p.face.control ? up.face.control : NULL;
    if (!p.face.second) p.face.control = NULL;
    add(all, &p);
}

static void add_light(points *all, const scene_light *light) {
    const char *name = light->name ? light->name : "light";
    point p = point_of(ROIL_LIGHT, name, "position", light->position);
    float radius[3];
    if (evaluate(light->radius, all->context, radius)) p.face.radius = radius[0];
    if (!add_place(all, &p)) return;
    add_length(all, &p, "radius", light->radius, across);
    if (light->range) add_length(all, &p, "range", light->range, across);
    if (light->kind != SCENE_SPOT) return;
    point target = point_of(ROIL_LIGHT, name, "target", light->target);
    add_place(all, &target);
}

static void add_ball(points *all, const effect_shape *s, const field *radius) {
    point p = point_of(ROIL_SHAPE, s->name, s->node->kind->args[0].desc.name, s->node->args[0]);
    float r[3];
    if (evaluate(radius, all->context, r)) p.face.radius = r[0];
    if (add_place(all, &p)) add_length(all, &p, "radius", radius, across);
}

static void add_box(points *all, const effect_shape *s) {
    point p = point_of(ROIL_SHAPE, s->name, "position", s->node->args[0]);
    float at[3], size[3];
    if (!evaluate(p.node, all->context, at) || !evaluate(s->node->args[1], all->context, size))
        return;
    for (int i = 0; i < 3; i++) {
        p.face.low[i] = at[i] - size[i] / 2;
        p.face.high[i] = at[i] + size[i] / 2;
    }
    if (!add_place(all, &p)) return;
    point corner = point_of(ROIL_SHAPE, s->name, "size", s->node->args[1]);
    find_control(all, &corner, 3);
    if (!corner.face.control) return;
    glm_vec3_copy(p.face.high, corner.face.at);
    for (int i = 0; i < 3; i++) corner.axes[i][i] = 0.5f;
    add(all, &corner);
}

static void add_shape(points *all, const effect_shape *s) {
    const char *kind = s->node->kind->name;
    if (strcmp(kind, "sphere") == 0 || strcmp(kind, "torus") == 0) {
        add_ball(all, s, s->node->args[1]);
    } else if (strcmp(kind, "box") == 0) {
        add_box(all, s);
    } else if (strcmp(kind, "capsule") == 0) {
        add_ball(all, s, s->node->args[2]);
        point to = point_of(ROIL_SHAPE, s->name, "to", s->node->args[1]);
        add_place(all, &to);
    }
}

static void add_particles(points *all, pass *p) {
    size_t shape, position, radius;
    scene_mesh *const *meshes;
    if (pass_find_key(p, "shape", &shape) != PASS_FIELD || pass_meshes(p, &meshes) > 0 ||
        pass_find_key(p, "position", &position) != PASS_UNIFORM ||
        pass_find_key(p, "radius", &radius) != PASS_UNIFORM)
        return;
    const field *within = pass_get_field(p, shape), *at = *pass_uniform_slot(p, position);
    if (!at || (within && !field_is_constant(within))) return;
    point born = point_of(ROIL_PARTICLES, pass_label(p), "position", at);
    const field *far = *pass_uniform_slot(p, radius);
    float r[3];
    if (evaluate(far, all->context, r)) born.face.radius = r[0];
    if (add_place(all, &born) && far) add_length(all, &born, "radius", far, across);
}

// Finds the box around a box that is turned.
static void turn_box(box3 box, mat4 by, float low[3], float high[3]) {
    for (int corner = 0; corner < 8; corner++) {
        vec3 p = {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                  corner & 4 ? box.max.z : box.min.z};
        glm_mat4_mulv3(by, p, 1, p);
        for (int i = 0; i < 3; i++) {
            low[i] = corner ? fminf(low[i], p[i]) : p[i];
            high[i] = corner ? fmaxf(high[i], p[i]) : p[i];
        }
    }
}

static void add_mesh(points *all, const scene_mesh *mesh) {
    point p = point_of(ROIL_MESH, mesh->called, "position", mesh->position);
    mat4 transform;
    if (mesh->repeated || !mesh->called || !scene_mesh_transform(mesh, all->context, transform))
        return;
    p.parent = mesh->parent;
    turn_box(mesh->data.box, transform, p.face.low, p.face.high);
    if (!add_place(all, &p) || !p.face.control) return;
    for (int i = 0; i < 3; i++) // several often share an origin
        all->list[all->count - 1].face.at[i] = (p.face.low[i] + p.face.high[i]) / 2;
}

static void add_node(points *all, const scene_node *node) {
    point p = point_of(ROIL_NODE, node->name, "position", node->position);
    p.parent = node->parent;
    add_place(all, &p);
}

// A grid is where it was when it was loaded.
static void add_volume(points *all, const field_grid *grid) {
    effect *e = all->e->effect;
    if (!grid->label) return;
    const effect_control *c = effect_control_named(e, grid->label, "position");
    if (!c || c->kind != EFFECT_CONTROL_LOADED) c = effect_control_named(e, grid->label, "offset");
    if (!c || c->kind != EFFECT_CONTROL_LOADED || !box3_is_finite(grid->box)) return;
    point p = point_of(ROIL_VOLUME, grid->label, c->desc->name, NULL);
    memcpy(p.face.low, &grid->box.min, sizeof p.face.low);
    memcpy(p.face.high, &grid->box.max, sizeof p.face.high);
    for (int i = 0; i < 2; i++) p.face.at[i] = (p.face.low[i] + p.face.high[i]) / 2;
    p.face.at[2] = p.face.low[2];
    p.face.control = c->name;
    p.face.structural = true;
    add(all, &p);
}

static points gather(roil_effect *e) {
    effect *own = e->effect;
    points all = {.e = e, .context = effect_pass_host(own)->context};
    const scene *s = effect_scene(own);
    const effect_shape *shapes;
    scene_mesh *const *meshes;
    scene_node *const *nodes;
    field_grid *const *grids;
    size_t shape_count = effect_shapes(own, &shapes), mesh_count = effect_meshes(own, &meshes);
    size_t node_count = effect_nodes(own, &nodes), grid_count = effect_grids(own, &grids);
    add_camera(&all);
    add_sun(&all);
    for (size_t i = 0; i < s->light_count; i++) add_light(&all, &s->lights[i]);
    for (size_t i = 0; i < shape_count; i++) add_shape(&all, &shapes[i]);
    for (size_t i = 0; i < effect_pass_count(own); i++)
        add_particles(&all, effect_get_pass(own, i));
    for (size_t i = 0; i < mesh_count; i++) add_mesh(&all, meshes[i]);
    for (size_t i = 0; i < node_count; i++) add_node(&all, nodes[i]);
    for (size_t i = 0; i < grid_count; i++) add_volume(&all, grids[i]);
    return all;
}

static size_t list_handles(roil_effect *e, roil_handle *out, size_t capacity) {
    points all = gather(e);
    for (size_t i = 0; i < all.count && i < capacity; i++) out[i] = all.list[i].face;
    mem_free(all.list);
    return all.count;
}

size_t roil_handles(roil_effect *e, roil_handle *out, size_t capacity) {
    mem_enter();
    return roil_leave_count(list_handles(e, out, capacity));
}

// ---- one of them --------------------------------------------------------------------------------

static bool find(roil_effect *e, size_t handle, point *out) {
    points all = gather(e);
    *out = (point){.node = NULL};
    bool found = handle < all.count;
    if (found) *out = all.list[handle];
    mem_free(all.list);
    return found || err_set("there is no handle %zu; there are %zu", handle, all.count);
}

static float round_fine(float value) {
    float rounded = roundf(value * FINE) / FINE;
    return isfinite(rounded) ? rounded + 0.0f : value; // no -0
}

// Returns by how much each component of the control is to change.
static void find_change(const point *p, const float at[3], float out[3]) {
    vec3 by;
    glm_vec3_sub((float *)(uintptr_t)at, (float *)(uintptr_t)p->face.at, by);
    glm_vec3_zero(out);
    if (p->face.along) {
        out[0] = glm_vec3_dot(by, (float *)(uintptr_t)p->axes[0]);
        return;
    }
    mat3 axes, inverse;
    memcpy(axes, p->axes, sizeof axes);
    if (fabsf(glm_mat3_det(axes)) < 1e-12f) return; // scaled to nothing
    glm_mat3_inv(axes, inverse);
    glm_mat3_mulv(inverse, by, out);
}

static char *curve_with(roil_effect *e, const point *p, const float change[3]) {
    roil_curve c;
    if (!roil_get_curve(e, p->face.control, &c)) return NULL;
    for (int i = 0; i < 3; i++)
        c.keys[p->face.key].value[i] = round_fine(c.keys[p->face.key].value[i] + change[i]);
    return roil_curve_text(&c);
}

char *roil_handle_text(roil_effect *e, size_t handle, bool second, const float at[3]) {
    mem_enter();
    point p;
    roil_control c;
    size_t index;
    if (!find(e, handle, &p)) return roil_leave_text(NULL);
    const char *name = second ? p.face.second : p.face.control;
    if (!name)
        return roil_leave_text(ERR_NULL("%s.%s: no control moves it", p.face.name, p.face.part));
    if (!roil_find_control(e, name, &index)) return roil_leave_text(NULL);
    roil_get_control(e, index, &c);
    float change[3], distance, yaw, pitch;
    if (p.face.thing == ROIL_SUN) {
        orbit_angles(at, (float[3]){0}, &distance, &yaw, &pitch);
        float turn = yaw - 90 - c.value[0]; // the shorter way round: 359 degrees stay near 360
        c.value[0] = second ? pitch : c.value[0] + turn - 360 * roundf(turn / 360);
        glm_vec3_zero(change);
    } else {
        find_change(&p, at, change);
    }
    if (p.face.key != SIZE_MAX) return roil_leave_text(curve_with(e, &p, change));
    strbuf text = {0};
    for (int i = 0; i < c.components; i++) {
        float value = round_fine(clampf(c.value[i] + change[i], c.min, c.max));
        strbuf_add(&text, "%s", i ? "," : "");
        strbuf_add_float(&text, value);
    }
    return roil_leave_text(text.text);
}

bool roil_handle_path(roil_effect *e, size_t handle, const double *times, float (*out)[3],
                      size_t count) {
    mem_enter();
    point p;
    if (!find(e, handle, &p)) return mem_leave(false);
    field_context context = *effect_pass_host(e->effect)->context;
    for (size_t i = 0; i < count; i++) {
        context.time = times[i];
        bool done = p.face.thing == ROIL_CAMERA && !p.node ? evaluate_camera(e, &context, out[i])
                    : p.node                               ? evaluate_place(&p, &context, out[i])
                             : (memcpy(out[i], p.face.at, sizeof p.face.at), true);
        if (!done)
            return mem_leave(
                err_set("%s.%s has no place at %g s", p.face.name, p.face.part, times[i]));
    }
    return mem_leave(true);
}

// ---- what fills space ---------------------------------------------------------------------------

bool roil_probe(roil_effect *e, float x, float y, roil_probed *out) {
    mem_enter();
    effect_probed found;
    time_limit time = roil_time_limit(e->owner), *before = time_limit_enter(&time);
    bool done = effect_probe(e->effect, x, y, &found);
    time_limit_leave(before);
    *out = (roil_probed){.found = found.found, .density = found.density, .count = found.count};
    memcpy(out->at, found.at, sizeof out->at);
    for (size_t i = 0; i < found.count; i++) {
        out->values[i].name = found.values[i].name;
        out->values[i].components = found.values[i].components;
        memcpy(out->values[i].value, found.values[i].value, sizeof out->values[i].value);
    }
    return mem_leave(done);
}
