// How the triangles of a mesh hang together: points that several vertices share, triangles that lie
// on each other, components, and which of these are closed.
#include "base/memory.h"
#include "scene/voxels_mesh.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- points -----------------------------------------------------------------------------------

typedef struct corner {
    float at[3];
    uint32_t vertex;
} corner;

static int by_place(const void *a, const void *b) {
    return memcmp(((const corner *)a)->at, ((const corner *)b)->at, sizeof((corner *)0)->at);
}

// What files write of one place differs in the last digits: so much of the mesh's size is no gap.
static float find_step(const mesh_data *mesh) {
    float longest = 0;
    for (int a = 0; a < 3; a++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < mesh->vertex_count; i++) {
            low = fminf(low, mesh->vertices[i].position[a]);
            high = fmaxf(high, mesh->vertices[i].position[a]);
        }
        longest = fmaxf(longest, high - low);
    }
    return isfinite(longest) ? 1e-6f * longest : 0;
}

// Vertices at the same place are one point; `out` has that of each vertex.
static void weld(voxel_topology *t, const mesh_data *mesh, uint32_t *out) {
    corner *corners = mem_alloc(mesh->vertex_count * sizeof *corners);
    const float step = find_step(mesh);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        for (int a = 0; a < 3; a++) {
            const float at = mesh->vertices[i].position[a];
            corners[i].at[a] = (step > 0 ? roundf(at / step) * step : at) + 0.0f; // no -0
        }
        corners[i].vertex = i;
    }
    qsort(corners, mesh->vertex_count, sizeof *corners, by_place);
    t->points = mem_alloc(mesh->vertex_count * sizeof *t->points);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        if (i == 0 || by_place(&corners[i - 1], &corners[i]) != 0)
            memcpy(t->points[t->point_count++], corners[i].at, sizeof corners[i].at);
        out[corners[i].vertex] = (uint32_t)t->point_count - 1;
    }
    mem_free(corners);
}

// ---- triangles --------------------------------------------------------------------------------

typedef struct face {
    uint32_t key[3]; // points, sorted
    bool odd;        // by how many swaps
    uint32_t order;  // in the mesh
    uint32_t points[3];
} face;

static void swap_if(face *f, int a, int b) {
    if (f->key[a] <= f->key[b]) return;
    uint32_t key = f->key[a];
    f->key[a] = f->key[b];
    f->key[b] = key;
    f->odd = !f->odd;
}

static int by_key(const void *a, const void *b) {
    const face *x = a, *y = b;
    for (int i = 0; i < 3; i++)
        if (x->key[i] != y->key[i]) return x->key[i] < y->key[i] ? -1 : 1;
    return x->order < y->order ? -1 : 1;
}

static int by_order(const void *a, const void *b) {
    return ((const face *)a)->order < ((const face *)b)->order ? -1 : 1;
}

static size_t list_faces(const mesh_data *mesh, const uint32_t *points, face *out) {
    size_t count = 0;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        face f = {.order = i};
        for (int c = 0; c < 3; c++) f.points[c] = f.key[c] = points[mesh->indices[i + (uint32_t)c]];
        swap_if(&f, 0, 1);
        swap_if(&f, 1, 2);
        swap_if(&f, 0, 1);
        if (f.key[0] != f.key[1] && f.key[1] != f.key[2]) out[count++] = f;
    }
    return count;
}

// One of each run of faces with the same points. Where some of them look the other way, `odd` is
// set: it has a twin.
static size_t drop_duplicates(face *faces, size_t count) {
    size_t kept = 0;
    qsort(faces, count, sizeof *faces, by_key);
    for (size_t i = 0; i < count;) {
        size_t first = i;
        bool twin = false;
        for (; i < count && memcmp(faces[i].key, faces[first].key, sizeof faces->key) == 0; i++)
            twin = twin || faces[i].odd != faces[first].odd;
        faces[kept] = faces[first];
        faces[kept++].odd = twin;
    }
    qsort(faces, kept, sizeof *faces, by_order);
    return kept;
}

// ---- components -------------------------------------------------------------------------------

static uint32_t find_root(uint32_t *parents, uint32_t point) {
    while (parents[point] != point) point = parents[point] = parents[parents[point]];
    return point;
}

// Triangles that share points are of one component; numbered in the order of the mesh.
static void topology_join(voxel_topology *t) {
    uint32_t *parents = mem_alloc(t->point_count * sizeof *parents);
    uint32_t *numbers = mem_alloc(t->point_count * sizeof *numbers); // from 1
    for (uint32_t i = 0; i < t->point_count; i++) parents[i] = i;
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t *points = t->triangles[i].points;
        for (int c = 1; c < 3; c++)
            parents[find_root(parents, points[c])] = find_root(parents, points[0]);
    }
    for (size_t i = 0; i < t->triangle_count; i++) {
        uint32_t root = find_root(parents, t->triangles[i].points[0]);
        if (!numbers[root]) numbers[root] = (uint32_t)++t->component_count;
        t->triangles[i].component = numbers[root] - 1;
    }
    mem_free(parents);
    mem_free(numbers);
}

// A component of nothing but twins is a surface with two sides; elsewhere twins are walls.
static void find_walls(voxel_topology *t) {
    bool *other = mem_alloc(t->component_count * sizeof *other);
    for (size_t i = 0; i < t->triangle_count; i++)
        if (!t->triangles[i].wall) other[t->triangles[i].component] = true;
    for (size_t i = 0; i < t->triangle_count; i++)
        t->triangles[i].wall = t->triangles[i].wall && other[t->triangles[i].component];
    mem_free(other);
}

typedef struct edge {
    uint32_t low, high, component;
} edge;

static int by_ends(const void *a, const void *b) {
    const edge *x = a, *y = b;
    if (x->low != y->low) return x->low < y->low ? -1 : 1;
    return x->high < y->high ? -1 : x->high > y->high;
}

// Closed is what has an even number of triangles at every edge.
static void find_closed(voxel_topology *t) {
    edge *edges = mem_alloc(3 * t->triangle_count * sizeof *edges);
    size_t count = 0;
    for (size_t i = 0; i < t->triangle_count; i++) {
        const voxel_triangle *tri = &t->triangles[i];
        for (int c = 0; c < 3 && !tri->wall; c++) {
            uint32_t a = tri->points[c], b = tri->points[(c + 1) % 3];
            edges[count++] = (edge){a < b ? a : b, a < b ? b : a, tri->component};
        }
    }
    qsort(edges, count, sizeof *edges, by_ends);
    for (size_t i = 0; i < t->component_count; i++) t->components[i].closed = true;
    for (size_t i = 0; i < count;) {
        size_t first = i;
        while (i < count && by_ends(&edges[i], &edges[first]) == 0) i++;
        if ((i - first) % 2) t->components[edges[first].component].closed = false;
    }
    mem_free(edges);
}

// Six times the volume between a triangle and the origin.
static double volume_below(const voxel_topology *t, const voxel_triangle *tri) {
    double p[3][3];
    for (int c = 0; c < 3; c++)
        for (int a = 0; a < 3; a++) p[c][a] = (double)t->points[tri->points[c]][a];
    return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
           p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

// Unlike those of maths.h these may be flat.
box3 voxel_no_box(void) {
    return (box3){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

void voxel_add_box(box3 *to, box3 box) {
    to->min = (float3){fminf(to->min.x, box.min.x), fminf(to->min.y, box.min.y),
                       fminf(to->min.z, box.min.z)};
    to->max = (float3){fmaxf(to->max.x, box.max.x), fmaxf(to->max.y, box.max.y),
                       fmaxf(to->max.z, box.max.z)};
}

static void topology_measure(voxel_topology *t) {
    t->box = voxel_no_box();
    for (size_t i = 0; i < t->component_count; i++) t->components[i].box = voxel_no_box();
    for (size_t i = 0; i < t->triangle_count; i++) {
        const voxel_triangle *tri = &t->triangles[i];
        voxel_component *c = &t->components[tri->component];
        if (!tri->wall) c->volume += volume_below(t, tri) / 6;
        for (int k = 0; k < 3; k++) {
            const float *p = t->points[tri->points[k]];
            float3 at = {p[0], p[1], p[2]};
            voxel_add_box(&c->box, (box3){at, at});
        }
    }
    for (size_t i = 0; i < t->component_count; i++) voxel_add_box(&t->box, t->components[i].box);
    t->size = fmaxf(fmaxf(t->box.max.x - t->box.min.x, t->box.max.y - t->box.min.y),
                    fmaxf(t->box.max.z - t->box.min.z, 1e-30f));
}

void voxel_topology_create(voxel_topology *out, const mesh_data *mesh) {
    voxel_topology *t = out;
    *t = (voxel_topology){0};
    uint32_t *points = mem_alloc(mesh->vertex_count * sizeof *points);
    weld(t, mesh, points);
    face *faces = mem_alloc(mesh->index_count / 3 * sizeof *faces);
    t->triangle_count = drop_duplicates(faces, list_faces(mesh, points, faces));
    t->triangles = mem_alloc(t->triangle_count * sizeof *t->triangles);
    for (size_t i = 0; i < t->triangle_count; i++) {
        memcpy(t->triangles[i].points, faces[i].points, sizeof faces[i].points);
        t->triangles[i].wall = faces[i].odd;
        t->triangles[i].behind = INFINITY;
    }
    mem_free(faces);
    mem_free(points);
    topology_join(t);
    find_walls(t);
    t->components = mem_alloc(t->component_count * sizeof *t->components);
    find_closed(t);
    topology_measure(t);
}

void voxel_topology_free(voxel_topology *t) {
    mem_free(t->points);
    mem_free(t->triangles);
    mem_free(t->components);
    *t = (voxel_topology){0};
}
