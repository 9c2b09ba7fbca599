// Instances are stored as the device reads them; changed ones are marked.
#include "scene/instances.h"
#include "base/error.h"
#include "base/memory.h"
#include "scene/instances_grid.h"
#include "scene/runs.h"
#include "scene/scene_impl.h"
#include <math.h>
#include <string.h>

struct scene_instances {
    scene_instances_desc desc; // entries and kinds: copies
    struct instance_entry *now;
    uint8_t *changed;        // marks (runs.h)
    uint64_t version, shape; // of all; of places and kinds alone
    uint64_t uploaded;       // version that the device has; 0: none
    gpu_buffer *buffer;
    instances_grid grid;
};

scene_instances *scene_instances_create(const scene_instances_desc *desc) {
    scene_instances *s = mem_alloc(sizeof *s);
    struct instance_entry *initial = mem_copy(desc->entries, desc->count * sizeof *initial);
    for (size_t i = 0; i < desc->count; i++) initial[i].kind.v[1] = (uint32_t)i;
    *s = (scene_instances){
        .desc = *desc,
        .now = mem_copy(initial, desc->count * sizeof *initial),
        .version = 1,
        .shape = 1,
    };
    s->desc.entries = initial;
    s->desc.kinds = mem_copy(desc->kinds, desc->kind_count * sizeof(scene_mesh *));
    s->changed = mem_alloc(run_marks(desc->count));
    memset(s->changed, 1, run_marks(desc->count));
    return s;
}

void scene_instances_destroy(scene_instances *s, gpu *g) {
    if (!s) return;
    if (s->buffer) gpu_buffer_destroy(g, s->buffer);
    instances_grid_free(&s->grid);
    mem_free((void *)s->desc.entries);
    mem_free((void *)s->desc.kinds);
    mem_free(s->now);
    mem_free(s->changed);
    mem_free(s);
}

const char *scene_instances_name(const scene_instances *s) {
    return s->desc.name;
}

size_t scene_instances_kinds(const scene_instances *s, scene_mesh *const **out) {
    *out = s->desc.kinds;
    return s->desc.kind_count;
}

uint32_t scene_instances_count(const scene_instances *s) {
    return (uint32_t)s->desc.count;
}

const struct instance_entry *scene_instances_entries(const scene_instances *s) {
    return s->now;
}

uint64_t scene_instances_version(const scene_instances *s) {
    return s->version;
}

uint64_t scene_instances_shape(const scene_instances *s) {
    return s->shape;
}

// ---- changes ----------------------------------------------------------------------------------

static void keep_finite(shared_vec4 *value, const shared_vec4 *before) {
    for (int i = 0; i < 4; i++)
        if (!isfinite(value->v[i])) value->v[i] = before->v[i];
}

void scene_instances_set(scene_instances *s, uint32_t index, const struct instance_entry *entry) {
    struct instance_entry *old = &s->now[index], made = *entry;
    keep_finite(&made.place, &old->place);
    keep_finite(&made.turn, &old->turn);
    keep_finite(&made.color, &old->color);
    keep_finite(&made.state, &old->state);
    for (int i = 1; i < 4; i++) made.kind.v[i] = old->kind.v[i];
    if (memcmp(old, &made, sizeof made) == 0) return;
    if (memcmp(old->place.v, made.place.v, 3 * sizeof *made.place.v) != 0)
        instances_grid_forget(&s->grid);
    s->shape += memcmp(&old->place, &made.place, sizeof made.place) != 0 ||
                memcmp(&old->turn, &made.turn, sizeof made.turn) != 0 ||
                old->kind.v[0] != made.kind.v[0];
    *old = made;
    run_mark(s->changed, index);
    s->version++;
}

void scene_instances_reset(scene_instances *s) {
    for (uint32_t i = 0; i < s->desc.count; i++) scene_instances_set(s, i, &s->desc.entries[i]);
}

// ---- places -----------------------------------------------------------------------------------

bool scene_instances_place(const scene_instances *s, const field_context *context, mat4 transform,
                           float tint[4]) {
    const scene_instances_desc *d = &s->desc;
    if (!scene_place_matrix(d->position, d->rotation, d->scale, d->parent, context, transform) ||
        !scene_evaluate(d->color, context, tint))
        return err_prefix("%s: ", d->name);
    for (int i = 0; i < 3; i++) tint[i] = scene_limit_light(tint[i]);
    return true;
}

void scene_instances_matrix(const struct instance_entry *entry, mat4 out) {
    versor turn;
    memcpy(turn, entry->turn.v, sizeof entry->turn.v);
    glm_quat_mat4(turn, out);
    glm_scale_uni(out, entry->place.v[3]);
    memcpy(out[3], entry->place.v, 3 * sizeof(float));
}

bool scene_instances_transform(const scene_instances *s, uint32_t index, uint32_t kind,
                               const field_context *context, mat4 out) {
    const struct instance_entry *entry = &s->now[index];
    float tint[4];
    mat4 own;
    if (!scene_instances_place(s, context, out, tint)) return false;
    scene_instances_matrix(entry, own);
    if (entry->kind.v[0] != kind) glm_scale_uni(own, 0);
    glm_mat4_mul(out, own, out);
    return true;
}

scene_mesh *scene_instances_mesh(const scene_instances *s, uint32_t index, arena *memory) {
    uint32_t kind = s->now[index].kind.v[0];
    if (kind == INSTANCE_HIDDEN) return NULL;
    scene_mesh *mesh = arena_copy(memory, s->desc.kinds[kind], sizeof *mesh);
    mesh->instances = s;
    mesh->index = index;
    mesh->kind = kind;
    return mesh;
}

size_t scene_instances_near(scene_instances *s, const float point[3], float radius, uint32_t *out,
                            size_t capacity) {
    instances_grid_make(&s->grid, s->now, s->desc.count);
    return instances_grid_near(&s->grid, s->now, point, radius, out, capacity);
}

// ---- on the device ----------------------------------------------------------------------------

void scene_instances_list_memory(const scene_instances *s, budget_list *out) {
    if (!s->buffer) budget_list_add(out, s->desc.name, s->desc.count * sizeof *s->now);
}

bool scene_instances_allocate(scene_instances *s, gpu *g) {
    return gpu_buffer_make(g, &s->buffer, s->desc.name, s->desc.count * sizeof *s->now);
}

bool scene_instances_upload(scene_instances *s, gpu *g) {
    if (s->uploaded == s->version) return true;
    s->uploaded = s->version;
    return runs_write(g, s->buffer, 0, s->now, sizeof *s->now, s->desc.count, s->changed);
}

gpu_buffer *scene_instances_buffer(const scene_instances *s) {
    return s->buffer;
}
