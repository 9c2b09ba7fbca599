// Traces a single ray on the host, through the trees that shaders trace; the twin of lib/bvh.glsl.
#include "scene/bvh_impl.h"
#include <math.h>
#include <string.h>

typedef struct ray {
    vec3 origin, way, inverse;
    float far;
} ray;

static ray make_ray(const float origin[3], const float way[3], float far) {
    ray r = {.far = far};
    for (int a = 0; a < 3; a++) {
        r.origin[a] = origin[a];
        r.way[a] = way[a];
        r.inverse[a] = 1 / (fabsf(way[a]) < 1e-20f ? 1e-20f : way[a]);
    }
    return r;
}

static bool meets_box(const ray *r, const shared_vec3 *low, const shared_vec3 *high) {
    float near = 0, far = r->far;
    for (int a = 0; a < 3; a++) {
        float x = (low->v[a] - r->origin[a]) * r->inverse[a];
        float y = (high->v[a] - r->origin[a]) * r->inverse[a];
        near = fmaxf(near, fminf(x, y));
        far = fminf(far, fmaxf(x, y) * 1.0000008f);
    }
    return near <= far;
}

static bool meet_triangle(ray *r, const struct bvh_triangle *t) {
    vec3 first, second, from, across, turned;
    for (int a = 0; a < 3; a++) {
        first[a] = t->first.v[a];
        second[a] = t->second.v[a];
        from[a] = r->origin[a] - t->corner.v[a];
    }
    glm_vec3_cross(r->way, second, across);
    glm_vec3_cross(from, first, turned);
    float scale = 1 / glm_vec3_dot(first, across);
    float u = glm_vec3_dot(from, across) * scale, v = glm_vec3_dot(r->way, turned) * scale;
    float distance = glm_vec3_dot(second, turned) * scale;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && distance >= 0 && distance < r->far)) return false;
    r->far = distance;
    return true;
}

// Returns the first triangle of an item that the ray hits; -1: none.
static int64_t walk_item(const scene_bvh *b, const struct bvh_instance *item, ray *r) {
    int64_t found = -1;
    for (uint32_t i = item->root; i != BVH_DONE;) {
        const struct bvh_node *node = &b->forest.nodes[i];
        bool inside = meets_box(r, &node->low, &node->high);
        i = bvh_next(node, inside);
        uint32_t first = bvh_leaf_first(node->below), end = bvh_leaf_end(node->below);
        for (uint32_t k = first; inside && k < end; k++)
            if (meet_triangle(r, &b->forest.triangles[k])) found = k;
    }
    return found;
}

// Transforms a ray to the space of an item. Its direction is not normalised again.
static ray to_item(const ray *r, const struct bvh_instance *item) {
    vec3 origin, way;
    for (int row = 0; row < 3; row++) {
        const float *m = item->inverse[row].v;
        origin[row] = m[3];
        way[row] = 0;
        for (int a = 0; a < 3; a++) {
            origin[row] += m[a] * r->origin[a];
            way[row] += m[a] * r->way[a];
        }
    }
    return make_ray(origin, way, r->far);
}

static void pick_report(const scene_bvh *b, const ray *r, const struct bvh_instance *item,
                        const struct bvh_triangle *t, scene_hit *out) {
    const thing *what = &b->things[item->what.v[0]];
    *out = (scene_hit){.distance = r->far, .mesh = what->mesh, .instances = what->instances};
    if (what->instances) {
        scene_mesh *const *kinds;
        scene_instances_kinds(what->instances, &kinds);
        out->index = item->what.v[1];
        out->mesh = kinds[what->entries[out->index].kind.v[0]];
    }
    vec3 face, first, second;
    memcpy(first, t->first.v, sizeof first);
    memcpy(second, t->second.v, sizeof second);
    glm_vec3_crossn(first, second, face);
    for (int a = 0; a < 3; a++) {
        out->position[a] = r->origin[a] + r->far * r->way[a];
        for (int row = 0; row < 3; row++) // by the transpose of what turns points back
            out->normal[a] += item->inverse[row].v[a] * face[row];
    }
    glm_vec3_normalize(out->normal);
    out->behind = glm_vec3_dot(out->normal, (float *)r->way) > 0;
    if (out->behind) glm_vec3_negate(out->normal);
}

bool scene_pick(const scene_bvh *b, const float origin[3], const float direction[3],
                const scene_mesh *only, scene_hit *out) {
    ray r = make_ray(origin, direction, INFINITY);
    const struct bvh_instance *hit = NULL;
    int64_t triangle = -1;
    for (uint32_t i = b->top_count ? 0 : BVH_DONE; i != BVH_DONE;) {
        const struct bvh_node *node = &b->forest.nodes[i];
        bool inside = meets_box(&r, &node->low, &node->high);
        i = bvh_next(node, inside);
        uint32_t first = bvh_leaf_first(node->below), end = bvh_leaf_end(node->below);
        for (uint32_t k = first; inside && k < end; k++) {
            const struct bvh_instance *item = &b->items[k];
            if (only && b->things[item->what.v[0]].mesh != only) continue;
            if (bvh_is_nowhere(item) || !meets_box(&r, &item->low, &item->high)) continue;
            ray inner = to_item(&r, item);
            int64_t found = walk_item(b, item, &inner);
            if (found < 0) continue;
            hit = item;
            triangle = found;
            r.far = inner.far;
        }
    }
    if (hit) pick_report(b, &r, hit, &b->forest.triangles[triangle], out);
    return hit != NULL;
}
