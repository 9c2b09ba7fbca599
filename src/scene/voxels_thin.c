// Measures how much of a body is behind each of its triangles: along a ray from the triangle's
// middle inwards to where it leaves the body.
#include "base/memory.h"
#include "base/worker.h"
#include "scene/bvh_tree.h"
#include "scene/voxels_mesh.h"
#include <math.h>

enum { CHUNK = 512 }; // triangles that a thread takes at once

typedef struct probe {
    voxel_topology *t;
    bvh_forest forest;
    uint32_t *numbers; // of the triangles in the forest's mesh
    size_t count;
    bool inverted; // the mesh as a whole is turned inside out
} probe;

// Returns the length of the part of a ray before it enters a box, in lengths of its direction;
// INFINITY: it misses.
static float enters(const struct bvh_node *n, const vec3 from, const vec3 way) {
    float near = 0, far = INFINITY;
    for (int a = 0; a < 3; a++) {
        float inverse = 1 / (fabsf(way[a]) < 1e-20f ? 1e-20f : way[a]);
        float p = (n->low.v[a] - from[a]) * inverse, q = (n->high.v[a] - from[a]) * inverse;
        near = fmaxf(near, fminf(p, q));
        far = fminf(far, fmaxf(p, q) * 1.0000008f);
    }
    return near <= far ? near : INFINITY;
}

// Returns where a ray leaves through a triangle; INFINITY: it misses, or enters there.
static float leaves(const struct bvh_triangle *t, const vec3 from, const vec3 way, bool inverted) {
    vec3 first, second, corner, across, turned, off;
    glm_vec3_copy((float *)t->first.v, first);
    glm_vec3_copy((float *)t->second.v, second);
    glm_vec3_copy((float *)t->corner.v, corner);
    glm_vec3_cross((float *)way, second, across);
    float facing = glm_vec3_dot(first, across); // below 0: the way is that of the normal
    if (facing == 0 || (facing < 0) == inverted) return INFINITY;
    glm_vec3_sub((float *)from, corner, off);
    float u = glm_vec3_dot(off, across) / facing;
    glm_vec3_cross(off, first, turned);
    float v = glm_vec3_dot((float *)way, turned) / facing;
    float distance = glm_vec3_dot(second, turned) / facing;
    return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : INFINITY;
}

static float thin_walk(const bvh_forest *f, const vec3 from, const vec3 way, bool inverted) {
    float nearest = INFINITY;
    for (uint32_t node = f->node_count ? 0 : BVH_DONE; node != BVH_DONE;) {
        const struct bvh_node *n = &f->nodes[node];
        bool inside = enters(n, from, way) < nearest;
        node = bvh_next(n, inside);
        uint32_t first = bvh_leaf_first(n->below), end = bvh_leaf_end(n->below);
        for (uint32_t i = first; inside && i < end; i++)
            nearest = fminf(nearest, leaves(&f->triangles[i], from, way, inverted));
    }
    return nearest;
}

static bool thin_look(void *user, size_t index) {
    probe *p = user;
    const voxel_topology *t = p->t;
    size_t end = (index + 1) * CHUNK < p->count ? (index + 1) * CHUNK : p->count;
    for (size_t i = index * CHUNK; i < end; i++) {
        voxel_triangle *tri = &t->triangles[p->numbers[i]];
        vec3 corners[3], first, second, inwards, from;
        for (int c = 0; c < 3; c++) glm_vec3_copy(t->points[tri->points[c]], corners[c]);
        glm_vec3_sub(corners[1], corners[0], first);
        glm_vec3_sub(corners[2], corners[0], second);
        glm_vec3_cross(second, first, inwards);
        if (p->inverted) glm_vec3_negate(inwards);
        if (glm_vec3_norm2(inwards) < 1e-30f) continue;
        glm_vec3_normalize(inwards);
        glm_vec3_add(corners[0], corners[1], from);
        glm_vec3_add(from, corners[2], from);
        glm_vec3_scale(from, 1.0f / 3, from);
        tri->behind = thin_walk(&p->forest, from, inwards, p->inverted);
    }
    return true;
}

void voxel_find_thin(voxel_topology *t) {
    if (t->triangle_count > VOXEL_MOST_THIN) return;
    probe p = {.t = t, .numbers = mem_alloc(t->triangle_count * sizeof *p.numbers)};
    double volume = 0;
    for (size_t i = 0; i < t->component_count; i++)
        volume += t->components[i].closed ? t->components[i].volume : 0;
    p.inverted = volume < 0;
    mesh_vertex *vertices = mem_alloc(t->point_count * sizeof *vertices);
    uint32_t *indices = mem_alloc(3 * t->triangle_count * sizeof *indices);
    for (size_t i = 0; i < t->point_count; i++) glm_vec3_copy(t->points[i], vertices[i].position);
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        const voxel_triangle *tri = &t->triangles[i];
        if (tri->wall || !t->components[tri->component].closed) continue;
        for (size_t c = 0; c < 3; c++) indices[3 * p.count + c] = tri->points[c];
        p.numbers[p.count++] = i;
    }
    mesh_part part = {.count = (uint32_t)(3 * p.count), .color = {1, 1, 1, 1}, .texture = -1};
    mesh_data mesh = {.vertices = vertices,
                      .vertex_count = (uint32_t)t->point_count,
                      .indices = indices,
                      .index_count = part.count,
                      .parts = &part,
                      .part_count = 1};
    if (bvh_forest_add(&p.forest, &mesh, 0))
        worker_each((p.count + CHUNK - 1) / CHUNK, thin_look, &p);
    bvh_forest_free(&p.forest);
    mem_free(p.numbers);
    mem_free(vertices);
    mem_free(indices);
}
