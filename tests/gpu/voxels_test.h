// Meshes made of formulas, and an exact answer to what is inside of them, for tests of voxels.
#pragma once
#include "gpu_test.h"
#include "scene/voxels.h"
#include <math.h>
#include <string.h>

typedef struct voxels_world {
    gpu *device;
    arena memory;
    shader_library *library;
    field_context context;
} voxels_world;

static inline const field *number(voxels_world *w, float value) {
    return field_constant(&w->memory, 1, (float[4]){value});
}

static inline const field *triple(voxels_world *w, float x, float y, float z) {
    return field_constant(&w->memory, 3, (float[4]){x, y, z});
}

static inline void voxels_open(voxels_world *w, gpu *device) {
    char shaders[4096];
    snprintf(shaders, sizeof shaders, "%s/shaders", getenv("ROIL_SOURCE_DIR"));
    *w = (voxels_world){.device = device};
    w->library = shader_library_create(&(shader_library_desc){.shader_root = shaders});
    gpu_test_ok(w->library);
}

static inline void voxels_close(voxels_world *w) {
    shader_library_destroy(w->library);
    arena_free(&w->memory);
}

// ---- meshes -----------------------------------------------------------------------------------

typedef struct shape { // to be added to
    mesh_vertex *vertices;
    uint32_t *indices;
    size_t vertex_count, vertex_capacity, index_count, index_capacity;
} shape;

static inline uint32_t shape_vertex(shape *s, float x, float y, float z) {
    MEM_RESERVE(s->vertices, s->vertex_count + 1, s->vertex_capacity);
    s->vertices[s->vertex_count] = (mesh_vertex){.position = {x, y, z}};
    return (uint32_t)s->vertex_count++;
}

static inline void shape_triangle(shape *s, uint32_t a, uint32_t b, uint32_t c) {
    MEM_RESERVE(s->indices, s->index_count + 3, s->index_capacity);
    s->indices[s->index_count++] = a;
    s->indices[s->index_count++] = b;
    s->indices[s->index_count++] = c;
}

// Counter-clockwise as seen from outside, each side with vertices of its own, as files have them.
static inline void shape_box(shape *s, float3 low, float3 high) {
    static const uint8_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 6; i++) {
        uint32_t at[4];
        for (int k = 0; k < 4; k++)
            at[k] =
                shape_vertex(s, sides[i][k] & 1 ? high.x : low.x, sides[i][k] & 2 ? high.y : low.y,
                             sides[i][k] & 4 ? high.z : low.z);
        shape_triangle(s, at[0], at[1], at[2]);
        shape_triangle(s, at[0], at[2], at[3]);
    }
}

// A grid of points over two angles that both go round; `place` of (u, v) in turns.
static inline void shape_round(shape *s, uint32_t us, uint32_t vs, bool poles,
                               float3 (*place)(float u, float v)) {
    uint32_t first = (uint32_t)s->vertex_count;
    for (uint32_t v = 0; v < vs + poles; v++)
        for (uint32_t u = 0; u < us; u++) {
            bool pole = poles && (v == 0 || v == vs);
            float3 p = place(pole ? 0 : (float)u / (float)us, (float)v / (float)vs);
            shape_vertex(s, p.x, p.y, p.z);
        }
    for (uint32_t v = 0; v < vs; v++)
        for (uint32_t u = 0; u < us; u++) {
            uint32_t next = poles ? v + 1 : (v + 1) % vs;
            uint32_t a = first + v * us + u, b = first + v * us + (u + 1) % us;
            uint32_t c = first + next * us + u, d = first + next * us + (u + 1) % us;
            shape_triangle(s, a, c, d);
            shape_triangle(s, a, d, b);
        }
}

static const float turn_ = 6.2831853f;

static inline float3 on_sphere(float u, float v) { // of radius 1
    float ring = v <= 0 || v >= 1 ? 0 : sinf(turn_ / 2 * v);
    float z = v <= 0 ? 1 : v >= 1 ? -1 : cosf(turn_ / 2 * v);
    return (float3){ring * cosf(turn_ * u), ring * sinf(turn_ * u), z};
}

static inline float3 on_torus(float u, float v) { // of radii 1 and 0.4
    float ring = 1 + 0.4f * cosf(turn_ * v);
    return (float3){ring * cosf(turn_ * u), ring * sinf(turn_ * u), -0.4f * sinf(turn_ * v)};
}

static inline void shape_sphere(shape *s, uint32_t fine) {
    shape_round(s, 2 * fine, fine, true, on_sphere);
}

// Moves the shape's memory into the world's. A mesh that stands still at the origin.
static inline scene_mesh *shape_mesh(voxels_world *w, shape *s) {
    scene_mesh *mesh = arena_alloc(&w->memory, sizeof *mesh);
    mesh_part *part = arena_alloc(&w->memory, sizeof *part);
    *part = (mesh_part){.count = (uint32_t)s->index_count, .color = {1, 1, 1, 1}, .texture = -1};
    *mesh = (scene_mesh){
        .name = "shape",
        .data = {.vertices =
                     arena_copy(&w->memory, s->vertices, s->vertex_count * sizeof *s->vertices),
                 .vertex_count = (uint32_t)s->vertex_count,
                 .indices = arena_copy(&w->memory, s->indices, s->index_count * sizeof *s->indices),
                 .index_count = (uint32_t)s->index_count,
                 .parts = part,
                 .part_count = 1},
        .position = triple(w, 0, 0, 0),
        .rotation = triple(w, 0, 0, 0),
        .scale = number(w, 1),
        .color = triple(w, 1, 1, 1)};
    mem_free(s->vertices);
    mem_free(s->indices);
    *s = (shape){0};
    return mesh;
}

// ---- the exact answer -------------------------------------------------------------------------

typedef struct double3 {
    double v[3];
} double3;

static inline double dot3(double3 a, double3 b) {
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

static inline double3 minus3(double3 a, double3 b) {
    return (double3){{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2]}};
}

static inline double3 cross3(double3 a, double3 b) {
    return (double3){{a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
                      a.v[0] * b.v[1] - a.v[1] * b.v[0]}};
}

// Corners of the mesh's triangles in the world; free with mem_free.
static inline double3 *placed_corners(voxels_world *w, const scene_mesh *mesh) {
    mat4 m;
    gpu_test_ok(scene_mesh_transform(mesh, &w->context, m));
    double3 *out = mem_alloc(mesh->data.index_count * sizeof *out);
    for (uint32_t i = 0; i < mesh->data.index_count; i++) {
        const float *p = mesh->data.vertices[mesh->data.indices[i]].position;
        for (int a = 0; a < 3; a++)
            out[i].v[a] = (double)m[0][a] * (double)p[0] + (double)m[1][a] * (double)p[1] +
                          (double)m[2][a] * (double)p[2] + (double)m[3][a];
    }
    return out;
}

// How often the mesh goes around a point: by the solid angles of its triangles. Van Oosterom and
// Strackee, "The solid angle of a plane triangle", 1983.
static inline double winding_at(const double3 *corners, size_t count, double3 p) {
    double sum = 0;
    for (size_t i = 0; i < count; i += 3) {
        double3 a = minus3(corners[i], p), b = minus3(corners[i + 1], p);
        double3 c = minus3(corners[i + 2], p);
        double la = sqrt(dot3(a, a)), lb = sqrt(dot3(b, b)), lc = sqrt(dot3(c, c));
        sum += 2 * atan2(dot3(a, cross3(b, c)),
                         la * lb * lc + dot3(a, b) * lc + dot3(b, c) * la + dot3(c, a) * lb);
    }
    return sum / (4 * 3.14159265358979);
}

// ---- voxels of a world ------------------------------------------------------------------------

static inline voxels *make_voxels(voxels_world *w, const voxels_desc *desc) {
    voxels *v = voxels_create(&w->memory, desc);
    gpu_test_ok(v);
    gpu_test_ok(voxels_build(v, w->device, w->library, NULL));
    gpu_test_ok(voxels_allocate(v, w->device));
    return v;
}

static inline voxels_change update_voxels(voxels_world *w, voxels *v, double time, double dt) {
    voxels_change change;
    w->context.time = time;
    gpu_test_ok(gpu_frame_begin(w->device));
    gpu_test_ok(voxels_update(v, w->device, &w->context, dt, &change));
    gpu_test_ok(gpu_frame_end(w->device));
    return change;
}

// A byte a cell; free with mem_free.
static inline uint32_t *read_ids(voxels_world *w, const voxels *v) {
    size_t size = gpu_buffer_size(voxels_ids(v));
    uint32_t *out = mem_alloc(size);
    gpu_test_ok(gpu_buffer_read(w->device, voxels_ids(v), 0, out, size));
    return out;
}
