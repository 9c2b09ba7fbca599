// Makes levels by meshoptimizer: edges are collapsed by quadric errors (Garland and Heckbert 1997,
// "Surface Simplification Using Quadric Error Metrics"). Where that leaves too many triangles, as
// for leaves and other loose pieces, vertices in one cell of a grid are merged (Rossignac and
// Borrel 1993).
//
// Parts without a texture are simplified together, with their corners welded, because meshes of
// flat faces consist of seams, and materials may differ from face to face. Each remaining triangle
// then chooses the vertices and the part whose normals fit its own. A textured part is simplified
// by itself, with its seams. Where areas of clearly different colours have grown or shrunk, the
// error of a level is how far their edges have moved, whatever its shape.
#include "media/mesh_levels.h"
#include "base/memory.h"
#include <math.h>
#include <meshoptimizer.h>
#include <string.h>

// Limits on the triangles of a mesh: a smaller one is drawn as fast as a level is chosen, a larger
// one would delay a load.
enum { LEAST = 96, MOST = 1000000, MOST_PARTS = 256 };
static const double shares[] = {0.5, 0.2, 0.08}; // of the triangles, that levels aim at
static const double least_gain = 0.3;    // a level leaves out this much of the one before it
static const double missed = 1.25;       // of what was aimed at: then vertices are merged
static const float error_most = 0.1f;    // of the mesh's extent
static const float cell_most = 0.2f;     // in which vertices are merged, of the extent
static const float POSITION_MOST = 1e9f; // metres: beyond, errors overflow
static const uint32_t NONE = UINT32_MAX;
static const float same_shade = 0.35f; // of roots of colours: more is another shade
enum { NEIGHBOURS = 64 }; // that are looked at, of a corner: a fan may have all triangles

typedef struct simplifier {
    const mesh_data *mesh;
    uint32_t *owners;          // of each triangle: its part
    uint32_t *shades;          // of each part: the first of nearly its colour
    float *areas, *areas_made; // of each shade, in the mesh and in the level
    float extent;
    // Of the group that is simplified: parts without a texture, or one with a texture.
    uint32_t *slots;  // its indices, as places in those of the mesh
    unsigned *welded; // the same, as vertices that stand for all at their place
    uint32_t count;
    uint32_t *heads, *nexts; // by such a vertex: slots there, in lists; NONE ends one
    unsigned *merged;        // by the second way
    // Of the level that is made: triangles in any order.
    unsigned *made;
    uint32_t *made_owners, made_count;
    float error; // of the extent
} simplifier;

// ---- groups -----------------------------------------------------------------------------------

static void add_slots(simplifier *s, const mesh_part *part) {
    for (uint32_t i = 0; i < part->count; i++) s->slots[s->count++] = part->first + i;
}

// Begins the group of a part: the part alone if it has a texture, else all parts without one.
static void begin_group(simplifier *s, uint32_t index) {
    const mesh_data *mesh = s->mesh;
    bool textured = mesh->parts[index].texture >= 0;
    s->count = 0;
    for (uint32_t i = index; i < (textured ? index + 1 : mesh->part_count); i++)
        if (textured || mesh->parts[i].texture < 0) add_slots(s, &mesh->parts[i]);
    for (uint32_t i = 0; i < s->count; i++) s->merged[i] = mesh->indices[s->slots[i]];
    size_t same = textured ? sizeof *mesh->vertices : sizeof mesh->vertices->position;
    meshopt_generateShadowIndexBuffer(s->welded, s->merged, s->count, mesh->vertices,
                                      mesh->vertex_count, same, sizeof *mesh->vertices);
    for (uint32_t i = 0; i < s->count; i++) s->heads[s->welded[i]] = NONE;
    for (uint32_t i = s->count; i-- > 0;) {
        s->nexts[s->slots[i]] = s->heads[s->welded[i]];
        s->heads[s->welded[i]] = s->slots[i];
    }
}

// Returns whether a group begins with this part: it has a texture, or is the first without one.
static bool begins_group(const mesh_data *mesh, uint32_t index) {
    for (uint32_t i = 0; i < index; i++)
        if (mesh->parts[i].texture < 0 && mesh->parts[index].texture < 0) return false;
    return true;
}

// ---- triangles --------------------------------------------------------------------------------

// Returns the normal, whose length is twice the triangle's area.
static void face_normal(const mesh_data *mesh, const uint32_t corners[3], vec3 out) {
    const mesh_vertex *v = mesh->vertices;
    vec3 a, b;
    glm_vec3_sub((float *)v[corners[1]].position, (float *)v[corners[0]].position, a);
    glm_vec3_sub((float *)v[corners[2]].position, (float *)v[corners[0]].position, b);
    glm_vec3_cross(a, b, out);
}

// Of the slots at a corner's position, chooses the one whose vertex has the nearest normal. Also
// finds the owner of the triangle there with the most similar normal, if it exceeds `*most`; among
// merged vertices, of the one that covers most of the area seen along the normal.
static uint32_t choose_vertex(const simplifier *s, uint32_t corner, const vec3 normal, bool merged,
                              float *most, uint32_t *owner) {
    const mesh_data *mesh = s->mesh;
    uint32_t best = corner;
    float nearest = -INFINITY;
    uint32_t slot = s->heads[corner];
    for (int i = 0; slot != NONE && i < NEIGHBOURS; i++, slot = s->nexts[slot]) {
        uint32_t vertex = mesh->indices[slot];
        vec3 face;
        face_normal(mesh, mesh->indices + slot / 3 * 3, face);
        if (!merged) glm_vec3_normalize(face);
        float along = glm_vec3_dot((float *)mesh->vertices[vertex].normal, (float *)normal);
        float alike = glm_vec3_dot(face, (float *)normal);
        if (along > nearest) best = vertex;
        if (alike > *most) *owner = s->owners[slot / 3];
        nearest = fmaxf(along, nearest);
        *most = fmaxf(alike, *most);
    }
    return best;
}

// Returns the mean direction that the surface at the corners of a triangle faces.
static void find_outward(const simplifier *s, const unsigned corners[3], vec3 out) {
    glm_vec3_zero(out);
    for (int k = 0; k < 3; k++) {
        vec3 mean = {0};
        uint32_t slot = s->heads[corners[k]];
        for (int i = 0; slot != NONE && i < NEIGHBOURS; i++, slot = s->nexts[slot])
            glm_vec3_add(mean, (float *)s->mesh->vertices[s->mesh->indices[slot]].normal, mean);
        glm_vec3_normalize(mean);
        glm_vec3_add(out, mean, out);
    }
}

// Adds a triangle. Merged vertices may leave it facing either way, so it is turned outwards.
static void add_triangle(simplifier *s, const unsigned corners[3], bool merged) {
    unsigned *out = s->made + 3 * s->made_count;
    uint32_t owner = s->owners[s->heads[corners[0]] / 3];
    unsigned order[3] = {corners[0], corners[1], corners[2]};
    float most = -INFINITY;
    vec3 normal, outward = {0};
    face_normal(s->mesh, order, normal);
    if (glm_vec3_dot(normal, normal) == 0) return; // without area
    if (merged) find_outward(s, corners, outward);
    if (glm_vec3_dot(normal, outward) < 0) {
        glm_vec3_negate(normal);
        order[1] = corners[2];
        order[2] = corners[1];
    }
    for (int k = 0; k < 3; k++) out[k] = choose_vertex(s, order[k], normal, merged, &most, &owner);
    s->made_owners[s->made_count++] = owner;
}

static void simplify_group(simplifier *s, double share) {
    const mesh_data *mesh = s->mesh;
    const float *positions = mesh->vertices->position;
    size_t stride = sizeof *mesh->vertices, target = (size_t)(share * (s->count / 3)) * 3;
    float error = 0, other = 0;
    bool merged = false;
    unsigned *result = s->made + 3 * s->made_count; // read as it is overwritten, at the same place
    size_t count = meshopt_simplify(result, s->welded, s->count, positions, mesh->vertex_count,
                                    stride, target, error_most, 0, &error);
    if ((double)count > missed * (double)target) {
        size_t fewer =
            meshopt_simplifySloppy(s->merged, s->welded, s->count, positions, mesh->vertex_count,
                                   stride, target, cell_most, &other);
        if (fewer > 0 && fewer < count) {
            memcpy(result, s->merged, fewer * sizeof *result);
            count = fewer;
            error = other;
            merged = true;
        }
    }
    s->error = fmaxf(s->error, error);
    for (size_t i = 0; i + 2 < count; i += 3) {
        const unsigned corners[3] = {result[i], result[i + 1], result[i + 2]};
        add_triangle(s, corners, merged);
    }
}

// ---- colours ----------------------------------------------------------------------------------

static bool is_same_shade(const mesh_part *a, const mesh_part *b) {
    float most = 0;
    for (int k = 0; k < 3; k++)
        most = fmaxf(most, fabsf(sqrtf(fmaxf(a->color[k], 0)) - sqrtf(fmaxf(b->color[k], 0))));
    return a->texture == b->texture && most < same_shade;
}

static void find_shades(simplifier *s) {
    const mesh_part *parts = s->mesh->parts;
    for (uint32_t i = 0; i < s->mesh->part_count; i++) {
        s->shades[i] = i;
        for (uint32_t k = 0; k < i && s->shades[i] == i; k++)
            if (s->shades[k] == k && is_same_shade(&parts[k], &parts[i])) s->shades[i] = k;
    }
}

static void add_areas(const simplifier *s, const uint32_t *indices, const uint32_t *owners,
                      uint32_t triangles, float *areas) {
    memset(areas, 0, s->mesh->part_count * sizeof *areas);
    for (uint32_t i = 0; i < triangles; i++) {
        vec3 normal;
        face_normal(s->mesh, indices + 3 * (size_t)i, normal);
        areas[s->shades[owners[i]]] += glm_vec3_norm(normal) / 2;
    }
}

// Estimates how far the edges of colours have moved, as if each area was round: its gain or loss,
// divided by its circumference. The result is relative to the extent; 0: there is one colour.
static float color_error(simplifier *s) {
    float most = 0;
    uint32_t shades = 0;
    add_areas(s, s->made, s->made_owners, s->made_count, s->areas_made);
    for (uint32_t i = 0; i < s->mesh->part_count; i++) {
        shades += s->shades[i] == i;
        if (s->areas[i] > 0)
            most = fmaxf(most, fabsf(s->areas_made[i] - s->areas[i]) /
                                   (2 * sqrtf((float)M_PI * s->areas[i])));
    }
    return shades > 1 && s->extent > 0 ? most / s->extent : 0;
}

// ---- levels -----------------------------------------------------------------------------------

static void make_level(simplifier *s, double share) {
    s->made_count = 0;
    s->error = 0;
    for (uint32_t i = 0; i < s->mesh->part_count; i++) {
        if (!begins_group(s->mesh, i)) continue;
        begin_group(s, i);
        simplify_group(s, share);
    }
    s->error = fmaxf(s->error, color_error(s));
}

// Appends a level, sorted by parts, if it is worth it. An earlier level that is no better is
// removed.
static void keep_level(const simplifier *s, arena *memory, mesh_levels *out) {
    const mesh_data *mesh = s->mesh;
    uint32_t at = out->count;
    while (at > 0 && out->errors[at - 1] >= s->error) at--;
    uint32_t end = at > 0 ? out->ends[at - 1] : 0, begin = at > 1 ? out->ends[at - 2] : 0;
    double before = at > 0 ? end - begin : mesh->index_count;
    if (s->made_count == 0 || s->error > error_most ||
        3 * s->made_count > (1 - least_gain) * before)
        return;
    mesh_run *runs = arena_alloc(memory, mesh->part_count * sizeof *runs);
    for (uint32_t p = 0; p < mesh->part_count; p++) {
        runs[p].first = mesh->index_count + end;
        for (uint32_t i = 0; i < s->made_count; i++) {
            if (s->made_owners[i] != p) continue;
            memcpy(out->indices + end, s->made + 3 * i, 3 * sizeof *s->made);
            end += 3;
        }
        runs[p].count = mesh->index_count + end - runs[p].first;
    }
    out->runs[at] = runs;
    out->ends[at] = end;
    out->errors[at] = s->error;
    out->count = at + 1;
    out->index_count = end;
}

// Checks the mesh, which comes from a file that nobody has checked yet.
static bool is_usable(const mesh_data *mesh) {
    uint32_t triangles = mesh->index_count / 3;
    bool usable = triangles >= LEAST && triangles <= MOST && mesh->part_count <= MOST_PARTS;
    for (uint32_t i = 0; usable && i < mesh->index_count; i++)
        usable = mesh->indices[i] < mesh->vertex_count;
    for (uint32_t i = 0; usable && i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            usable = usable && fabsf(mesh->vertices[i].position[k]) < POSITION_MOST;
    return usable;
}

void mesh_levels_make(const mesh_data *mesh, arena *memory, mesh_levels *out) {
    *out = (mesh_levels){0};
    if (!is_usable(mesh)) return;
    arena scratch = {0};
    size_t words = (size_t)mesh->index_count * sizeof(uint32_t);
    simplifier s = {
        .mesh = mesh,
        .owners = arena_alloc(&scratch, words / 3),
        .shades = arena_alloc(&scratch, mesh->part_count * sizeof *s.shades),
        .areas = arena_alloc(&scratch, mesh->part_count * sizeof *s.areas),
        .areas_made = arena_alloc(&scratch, mesh->part_count * sizeof *s.areas_made),
        .extent = meshopt_simplifyScale(mesh->vertices->position, mesh->vertex_count,
                                        sizeof *mesh->vertices),
        .slots = arena_alloc(&scratch, words),
        .welded = arena_alloc(&scratch, words),
        .heads = arena_alloc(&scratch, mesh->vertex_count * sizeof *s.heads),
        .nexts = arena_alloc(&scratch, words),
        .merged = arena_alloc(&scratch, words),
        .made = arena_alloc(&scratch, words),
        .made_owners = arena_alloc(&scratch, words / 3),
    };
    for (uint32_t p = 0; p < mesh->part_count; p++)
        for (uint32_t i = 0; i < mesh->parts[p].count; i++)
            s.owners[(mesh->parts[p].first + i) / 3] = p;
    find_shades(&s);
    add_areas(&s, mesh->indices, s.owners, mesh->index_count / 3, s.areas);
    out->indices = arena_alloc(memory, words * COUNT_OF(shares));
    for (size_t i = 0; i < COUNT_OF(shares); i++) {
        make_level(&s, shares[i]);
        keep_level(&s, memory, out);
    }
    for (uint32_t i = 0; i < out->count; i++) out->errors[i] *= s.extent;
    arena_free(&scratch);
}
