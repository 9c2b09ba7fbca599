// Places everything that rays can hit in a frame. Things that have not changed are left alone, and
// so are single instances.
#include "scene/bvh_impl.h"
#include "scene/material.h"
#include "scene/runs.h"
#include <math.h>
#include <string.h>

// Transforms the box of a tree's root to the world: all eight corners, enlarged a little for
// rounding.
static void world_box(const struct bvh_node *root, mat4 transform, struct bvh_instance *out) {
    vec3 box[2];
    for (int i = 0; i < 8; i++) {
        vec3 at;
        for (int a = 0; a < 3; a++) at[a] = i >> a & 1 ? root->high.v[a] : root->low.v[a];
        glm_mat4_mulv3(transform, at, 1, at);
        for (int a = 0; a < 3; a++) {
            box[0][a] = i ? fminf(box[0][a], at[a]) : at[a];
            box[1][a] = i ? fmaxf(box[1][a], at[a]) : at[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        float margin = 1e-5f * fmaxf(fabsf(box[0][a]), fabsf(box[1][a]));
        out->low.v[a] = box[0][a] - margin;
        out->high.v[a] = box[1][a] + margin;
    }
}

// False when nothing would be visible: the scale is zero, or a number is not finite.
static bool invert_transform(mat4 transform, struct bvh_instance *out) {
    mat4 inverse;
    float size = glm_mat4_det(transform);
    if (!isfinite(size) || size == 0) return false;
    glm_mat4_inv(transform, inverse);
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            if (!isfinite(inverse[column][row])) return false;
            out->inverse[row].v[column] = inverse[column][row];
        }
    }
    return true;
}

static void item_put(scene_bvh *b, size_t item, const struct bvh_instance *made) {
    struct bvh_instance *now = &b->items[b->item_at[item]];
    if (memcmp(now, made, sizeof *now) == 0) return;
    if (memcmp(&now->low, &made->low, sizeof now->low) != 0 ||
        memcmp(&now->high, &made->high, sizeof now->high) != 0)
        bvh_top_moved(b, b->item_at[item]);
    *now = *made;
    b->version++;
    run_mark(b->changed, b->item_at[item]);
}

// `mesh` is an index among the meshes of the trees.
static void place_item(scene_bvh *b, size_t item, size_t mesh, mat4 transform,
                       struct bvh_instance *made) {
    const tree *t = &b->trees[mesh];
    if (t->root != t->end && invert_transform(transform, made)) {
        made->what.v[2] = b->materials[mesh];
        made->what.v[3] = (uint32_t)mesh;
        made->below = t->below;
        made->root = t->root;
        world_box(&b->forest.nodes[t->root], transform, made);
    } else {
        *made =
            (struct bvh_instance){.low = {{1e30f, 1e30f, 1e30f}}, .high = {{1e30f, 1e30f, 1e30f}}};
    }
    item_put(b, item, made);
}

static void place_mesh(scene_bvh *b, thing *t) {
    struct bvh_instance made = {.what = {{(uint32_t)(t - b->things)}}};
    memcpy(made.color.v, t->tint, 3 * sizeof *t->tint);
    made.color.v[3] = 1;
    place_item(b, t->first, t->first_mesh, t->transform, &made);
}

static void place_instance(scene_bvh *b, thing *t, uint32_t index) {
    const struct instance_entry *entry = &t->entries[index];
    struct bvh_instance made = {.what = {{(uint32_t)(t - b->things), index}}};
    made.color.v[3] = entry->color.v[3];
    mat4 transform = GLM_MAT4_ZERO_INIT; // hidden
    scene_mesh *const *kinds;
    bool shown = entry->kind.v[0] < scene_instances_kinds(t->instances, &kinds);
    if (shown) {
        const float *own = t->tints[entry->kind.v[0]];
        for (int c = 0; c < 3; c++) made.color.v[c] = t->tint[c] * own[c] * entry->color.v[c];
        scene_instances_matrix(entry, transform);
        glm_mat4_mul(t->transform, transform, transform);
    }
    place_item(b, t->first + index, t->first_mesh + (shown ? entry->kind.v[0] : 0), transform,
               &made);
}

static void place_instances(scene_bvh *b, thing *t, bool all) {
    const struct instance_entry *now = scene_instances_entries(t->instances);
    uint64_t version = scene_instances_version(t->instances);
    if (!all && version == t->version) return;
    t->version = version;
    for (uint32_t i = 0; i < t->count; i++) {
        if (!all && memcmp(&now[i], &t->entries[i], sizeof *now) == 0) continue;
        t->entries[i] = now[i];
        place_instance(b, t, i);
    }
}

// Returns the colour factor of each kind. `same` becomes false when one has changed.
static bool tint_kinds(thing *t, const field_context *context, bool *same) {
    scene_mesh *const *kinds;
    size_t count = t->instances ? scene_instances_kinds(t->instances, &kinds) : 0;
    for (size_t i = 0; i < count; i++) {
        scene_look look;
        if (!scene_mesh_look(kinds[i], context, &look)) return false;
        *same = *same && memcmp(t->tints[i], look.tint, sizeof look.tint) == 0;
        memcpy(t->tints[i], look.tint, sizeof look.tint);
    }
    return true;
}

static bool place_thing(scene_bvh *b, thing *t, const field_context *context) {
    mat4 transform;
    float tint[4] = {0};
    if (t->mesh ? !scene_mesh_place(t->mesh, context, transform, tint)
                : !scene_instances_place(t->instances, context, transform, tint))
        return false;
    bool same = t->placed && memcmp(transform, t->transform, sizeof transform) == 0 &&
                memcmp(tint, t->tint, 3 * sizeof *tint) == 0;
    if (!tint_kinds(t, context, &same)) return false;
    t->placed = true;
    memcpy(t->transform, transform, sizeof transform);
    memcpy(t->tint, tint, sizeof tint);
    if (t->instances)
        place_instances(b, t, !same);
    else if (!same)
        place_mesh(b, t);
    return true;
}

bool scene_bvh_place(scene_bvh *b, const field_context *context) {
    for (size_t i = 0; i < b->thing_count; i++)
        if (!place_thing(b, &b->things[i], context)) return false;
    bvh_top_update(b);
    return true;
}

bool scene_bvh_update(scene_bvh *b, gpu *g, const field_context *context) {
    if (!scene_bvh_place(b, context) || !bvh_looks_update(b, g, context)) return false;
    const uint32_t head[4] = {(uint32_t)b->item_count, b->top_below};
    if (!b->headed && !gpu_buffer_write(g, b->buffers[BVH_INSTANCES], 0, head, BVH_HEAD))
        return false;
    b->headed = true;
    if (!runs_write(g, b->buffers[BVH_NODES], 0, b->wide, sizeof *b->wide,
                    bvh_top_wide(b->item_count), b->wide_marks))
        return false;
    return runs_write(g, b->buffers[BVH_INSTANCES], BVH_HEAD, b->items, sizeof *b->items,
                      b->item_count, b->changed);
}
