// By meshoptimizer, which collapses edges by quadric errors (Garland and Heckbert 1997, "Surface
// Simplification Using Quadric Error Metrics"). Each part by itself, up to the same error: what is
// thin goes sooner than what is large.
#include "media/mesh_levels.h"
#include "base/memory.h"
#include <math.h>
#include <meshoptimizer.h>
#include <string.h>

// Triangles of a mesh: fewer are drawn as fast as they are chosen, more would hold a load up (0.6 s
// for so many).
enum { LEAST = 96, MOST = 200000 };
// Of the mesh's extent: at a metre's height and a picture of 1080 lines, a pixel from 6, 20 and 50
// m on, about.
static const float errors[] = {0.005f, 0.015f, 0.04f};
// A level that does not leave out this much of the one before it is none.
static const double least_gain = 0.3;

typedef struct simplifier {
    const mesh_data *mesh;
    unsigned *welded;        // indices of a part, its seams closed
    unsigned *made;          // indices of a part, simplified
    uint32_t *heads, *nexts; // vertices at the same place, in lists; NONE ends one
} simplifier;

static const uint32_t NONE = UINT32_MAX;
static const float POSITION_MOST = 1e9f; // metres: beyond, errors overflow

static const float *position(const simplifier *s, uint32_t vertex) {
    return s->mesh->vertices[vertex].position;
}

// A texture's seams must stay where they are. Else a part is simplified as if its corners had no
// normals: one of flat faces is nothing but seams.
static void weld(simplifier *s, const mesh_part *part) {
    const mesh_data *mesh = s->mesh;
    const uint32_t *indices = mesh->indices + part->first;
    if (part->texture >= 0) {
        memcpy(s->welded, indices, part->count * sizeof *indices);
        return;
    }
    meshopt_generateShadowIndexBuffer(s->welded, indices, part->count, mesh->vertices,
                                      mesh->vertex_count, sizeof mesh->vertices->position,
                                      sizeof *mesh->vertices);
    for (uint32_t i = 0; i < part->count; i++) {
        s->heads[s->welded[i]] = NONE;
        s->nexts[indices[i]] = NONE - 1; // in no list
    }
    for (uint32_t i = 0; i < part->count; i++) {
        uint32_t vertex = indices[i], *head = &s->heads[s->welded[i]];
        if (s->nexts[vertex] != NONE - 1) continue;
        s->nexts[vertex] = *head;
        *head = vertex;
    }
}

// Of the vertices at a corner's place, the one whose normal is nearest to the triangle's.
static uint32_t choose_vertex(const simplifier *s, uint32_t corner, const vec3 normal) {
    uint32_t best = corner;
    float most = -INFINITY;
    for (uint32_t v = s->heads[corner]; v != NONE; v = s->nexts[v]) {
        float along = glm_vec3_dot((float *)s->mesh->vertices[v].normal, (float *)normal);
        if (along <= most) continue;
        most = along;
        best = v;
    }
    return best;
}

static void open_seams(const simplifier *s, uint32_t count) {
    for (uint32_t i = 0; i + 2 < count; i += 3) {
        unsigned *corners = s->made + i;
        vec3 a, b, normal;
        glm_vec3_sub((float *)position(s, corners[1]), (float *)position(s, corners[0]), a);
        glm_vec3_sub((float *)position(s, corners[2]), (float *)position(s, corners[0]), b);
        glm_vec3_crossn(a, b, normal);
        for (int k = 0; k < 3; k++) corners[k] = choose_vertex(s, corners[k], normal);
    }
}

// How many indices are left of a part. Parts of many pieces, as leaves, are not simplified by their
// edges: where few of them go the coarsest level merges what lies close together.
static uint32_t simplify(simplifier *s, const mesh_part *part, float error, bool coarsest) {
    const mesh_data *mesh = s->mesh;
    const float *positions = mesh->vertices->position;
    weld(s, part);
    size_t count = meshopt_simplify(s->made, s->welded, part->count, positions, mesh->vertex_count,
                                    sizeof *mesh->vertices, 0, error, 0, NULL);
    if (coarsest && count > part->count / 2)
        count = meshopt_simplifySloppy(s->made, s->welded, part->count, positions,
                                       mesh->vertex_count, sizeof *mesh->vertices, 0, error, NULL);
    if (part->texture < 0) open_seams(s, (uint32_t)count);
    return (uint32_t)count;
}

// Appends the level, or leaves `out` as it was.
static void add_level(simplifier *s, size_t level, uint32_t before, arena *memory,
                      mesh_levels *out) {
    const mesh_data *mesh = s->mesh;
    mesh_run *runs = arena_alloc(memory, mesh->part_count * sizeof *runs);
    uint32_t end = out->index_count;
    for (uint32_t i = 0; i < mesh->part_count; i++) {
        uint32_t count = simplify(s, &mesh->parts[i], errors[level], level + 1 == COUNT_OF(errors));
        runs[i] = (mesh_run){mesh->index_count + end, count};
        memcpy(out->indices + end, s->made, count * sizeof *s->made);
        end += count;
    }
    if (end - out->index_count > (1 - least_gain) * before || end == out->index_count) return;
    out->runs[out->count] = runs;
    out->errors[out->count++] =
        errors[level] *
        meshopt_simplifyScale(mesh->vertices->position, mesh->vertex_count, sizeof *mesh->vertices);
    out->index_count = end;
}

// It comes from a file that nobody has checked yet.
static bool is_usable(const mesh_data *mesh) {
    bool usable = true;
    for (uint32_t i = 0; i < mesh->index_count; i++)
        usable = usable && mesh->indices[i] < mesh->vertex_count;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            usable = usable && fabsf(mesh->vertices[i].position[k]) < POSITION_MOST;
    return usable;
}

void mesh_levels_make(const mesh_data *mesh, arena *memory, mesh_levels *out) {
    *out = (mesh_levels){0};
    uint32_t triangles = mesh->index_count / 3;
    if (triangles < LEAST || triangles > MOST || !is_usable(mesh)) return;
    simplifier s = {
        .mesh = mesh,
        .welded = mem_alloc(mesh->index_count * sizeof *s.welded),
        .made = mem_alloc(mesh->index_count * sizeof *s.made),
        .heads = mem_alloc(mesh->vertex_count * sizeof *s.heads),
        .nexts = mem_alloc(mesh->vertex_count * sizeof *s.nexts),
    };
    out->indices = arena_alloc(memory, COUNT_OF(errors) * mesh->index_count * sizeof *out->indices);
    uint32_t before = mesh->index_count, at = 0;
    for (size_t i = 0; i < COUNT_OF(errors); i++) {
        add_level(&s, i, before, memory, out);
        if (out->index_count > at) before = out->index_count - at;
        at = out->index_count;
    }
    mem_free(s.welded);
    mem_free(s.made);
    mem_free(s.heads);
    mem_free(s.nexts);
}
