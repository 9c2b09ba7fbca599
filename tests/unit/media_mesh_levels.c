// Simplified meshes: fewer triangles, as near to the mesh as they say, of its own vertices; of a
// file, with the mesh.
#include "base/memory.h"
#include "media/mesh_levels.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { RINGS = 48, SECTORS = 96 };

typedef struct shape {
    arena memory;
    mesh_vertex *vertices;
    uint32_t *indices;
    mesh_part parts[2];
    mesh_data data;
} shape;

static void begin_shape(shape *s, uint32_t vertices, uint32_t indices) {
    *s = (shape){0};
    s->vertices = arena_alloc(&s->memory, vertices * sizeof *s->vertices);
    s->indices = arena_alloc(&s->memory, indices * sizeof *s->indices);
}

static void end_shape(shape *s, uint32_t part_count) {
    s->data.vertices = s->vertices;
    s->data.indices = s->indices;
    s->data.parts = s->parts;
    s->data.part_count = part_count;
    for (uint32_t i = 0; i < part_count; i++) {
        s->parts[i].first = i * s->data.index_count / part_count;
        s->parts[i].count = s->data.index_count / part_count;
        s->parts[i].texture = -1;
    }
}

// Of radius 1, with a part for each half and a seam where the angle begins.
static void make_ball(shape *s) {
    begin_shape(s, (RINGS + 1) * (SECTORS + 1), RINGS * SECTORS * 6);
    for (uint32_t r = 0; r <= RINGS; r++) {
        for (uint32_t k = 0; k <= SECTORS; k++) {
            double up = GLM_PI * r / RINGS, around = 2 * GLM_PI * (k % SECTORS) / SECTORS;
            const float n[3] = {(float)(sin(up) * cos(around)), (float)(sin(up) * sin(around)),
                                (float)cos(up)};
            mesh_vertex *v = &s->vertices[s->data.vertex_count++];
            memcpy(v->position, n, sizeof n);
            memcpy(v->normal, n, sizeof n);
            v->u = (float)k / SECTORS;
            if (r == RINGS || k == SECTORS) continue;
            uint32_t at = s->data.vertex_count - 1, next = at + SECTORS + 1;
            const uint32_t corners[6] = {at, next, next + 1, at, next + 1, at + 1};
            memcpy(s->indices + s->data.index_count, corners, sizeof corners);
            s->data.index_count += 6;
        }
    }
    end_shape(s, 2);
}

static float corner(const shape *s, const uint32_t *triangle, int k, int axis) {
    return s->vertices[triangle[k]].position[axis];
}

static void levels_are_as_near_as_they_say(void **state) {
    (void)state;
    shape s;
    mesh_levels levels;
    make_ball(&s);
    mesh_levels_make(&s.data, &s.memory, &levels);
    assert_true(levels.count >= 2);
    uint32_t before = s.data.index_count;
    for (uint32_t i = 0; i < levels.count; i++) {
        uint32_t count = 0;
        for (uint32_t p = 0; p < 2; p++) {
            mesh_run run = levels.runs[i][p];
            assert_true(run.count % 3 == 0 && run.count > 0);
            for (uint32_t t = 0; t < run.count; t += 3) {
                const uint32_t *triangle = levels.indices + run.first - s.data.index_count + t;
                double middle[3];
                for (int c = 0; c < 3; c++)
                    middle[c] =
                        ((double)corner(&s, triangle, 0, c) + (double)corner(&s, triangle, 1, c) +
                         (double)corner(&s, triangle, 2, c)) /
                        3;
                double off =
                    1 - sqrt(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]);
                // Quadric errors are means over planes, not greatest distances.
                if (off > 2 * (double)levels.errors[i])
                    fail_msg("level %u: off by %g, and %g is said", i + 1, off,
                             (double)levels.errors[i]);
                bool upper = p == 0; // parts keep to their half
                assert_true(upper ? middle[2] > -0.1 : middle[2] < 0.1);
            }
            count += run.count;
        }
        assert_true(count < before * 0.7);
        assert_true(i == 0 || levels.errors[i] > levels.errors[i - 1]);
        before = count;
    }
    arena_free(&s.memory);
}

// A triangle across the seam would show the whole texture backwards.
static void seams_of_textures_stay(void **state) {
    (void)state;
    shape s;
    mesh_levels levels;
    make_ball(&s);
    s.parts[1].texture = 0;
    mesh_levels_make(&s.data, &s.memory, &levels);
    assert_true(levels.count >= 2);
    for (uint32_t i = 0; i < levels.count; i++) {
        mesh_run run = levels.runs[i][1];
        assert_true(run.count > 0 && run.count < s.parts[1].count * 0.7);
        for (uint32_t t = 0; t < run.count; t += 3) {
            const uint32_t *triangle = levels.indices + run.first - s.data.index_count + t;
            float least = 1, most = 0;
            for (int k = 0; k < 3; k++) {
                assert_true(corner(&s, triangle, k, 2) < 1e-6f);   // of the lower half
                if (corner(&s, triangle, k, 2) < -0.99f) continue; // all angles meet at the pole
                least = fminf(least, s.vertices[triangle[k]].u);
                most = fmaxf(most, s.vertices[triangle[k]].u);
            }
            assert_true(most - least < 0.6f);
        }
    }
    arena_free(&s.memory);
}

// A box whose faces are grids with normals of their own: flat, and all edges are seams.
static void add_face(shape *s, int axis, float side, uint32_t cells) {
    uint32_t first = s->data.vertex_count, row = cells + 1;
    for (uint32_t y = 0; y <= cells; y++) {
        for (uint32_t x = 0; x <= cells; x++) {
            mesh_vertex *v = &s->vertices[s->data.vertex_count++];
            v->position[axis] = side;
            v->position[(axis + 1) % 3] = side * (2.0f * (float)x / (float)cells - 1);
            v->position[(axis + 2) % 3] = 2.0f * (float)y / (float)cells - 1;
            v->normal[axis] = side;
            if (x == cells || y == cells) continue;
            uint32_t at = first + y * row + x;
            const uint32_t corners[6] = {at, at + 1, at + row + 1, at, at + row + 1, at + row};
            memcpy(s->indices + s->data.index_count, corners, sizeof corners);
            s->data.index_count += 6;
        }
    }
}

static void flat_faces_stay_flat(void **state) {
    (void)state;
    enum { CELLS = 12 };
    shape s;
    mesh_levels levels;
    begin_shape(&s, 6 * (CELLS + 1) * (CELLS + 1), 6 * CELLS * CELLS * 6);
    for (int axis = 0; axis < 3; axis++) {
        add_face(&s, axis, 1, CELLS);
        add_face(&s, axis, -1, CELLS);
    }
    end_shape(&s, 1);
    mesh_levels_make(&s.data, &s.memory, &levels);
    assert_true(levels.count >= 1);
    mesh_run run = levels.runs[0][0];
    assert_true(levels.errors[0] < 1e-6f);
    assert_true(run.count >= 36 && run.count <= s.data.index_count / 2);
    for (uint32_t t = 0; t < run.count; t += 3) {
        const uint32_t *triangle = levels.indices + run.first - s.data.index_count + t;
        for (int k = 1; k < 3; k++)
            assert_memory_equal(s.vertices[triangle[k]].normal, s.vertices[triangle[0]].normal,
                                sizeof s.vertices->normal);
        for (int axis = 0; axis < 3; axis++) {
            float n = s.vertices[triangle[0]].normal[axis];
            for (int k = 0; k < 3 && n != 0; k++) assert_true(corner(&s, triangle, k, axis) == n);
        }
    }
    arena_free(&s.memory);
}

// How much of the box is of a part, by the sides of its triangles.
static double area_of(const shape *s, const uint32_t *indices, mesh_run run) {
    double sum = 0;
    for (uint32_t t = 0; t < run.count; t += 3) {
        vec3 a, b, out;
        float *at = s->vertices[indices[run.first + t]].position;
        glm_vec3_sub(s->vertices[indices[run.first + t + 1]].position, at, a);
        glm_vec3_sub(s->vertices[indices[run.first + t + 2]].position, at, b);
        glm_vec3_cross(a, b, out);
        sum += (double)glm_vec3_norm(out) / 2;
    }
    return sum;
}

// A yellow stripe over all of a red, flat board: no shape is lost, but a colour may be.
static void what_colours_have_moved_is_said(void **state) {
    (void)state;
    enum { CELLS = 24, ROW = 6 * CELLS, STRIPE = 2 * ROW };
    shape s;
    mesh_levels levels;
    begin_shape(&s, (CELLS + 1) * (CELLS + 1), CELLS * ROW + STRIPE);
    add_face(&s, 2, 1, CELLS);
    end_shape(&s, 2);
    uint32_t *middle = s.indices + 11 * ROW, *end = s.indices + CELLS * ROW;
    memcpy(end, middle, STRIPE * sizeof *end);
    memmove(middle, middle + STRIPE, (size_t)(end - middle) * sizeof *end);
    s.parts[0] = (mesh_part){.count = CELLS * ROW - STRIPE, .color = {0.5f, 0, 0}, .texture = -1};
    s.parts[1] = (mesh_part){
        .first = CELLS * ROW - STRIPE, .count = STRIPE, .color = {0.8f, 0.5f, 0}, .texture = -1};
    double before = area_of(&s, s.indices, (mesh_run){s.parts[1].first, STRIPE});
    mesh_levels_make(&s.data, &s.memory, &levels);
    for (uint32_t i = 0; i < levels.count; i++) {
        mesh_run run = levels.runs[i][1];
        run.first -= s.data.index_count;
        double moved = fabs(area_of(&s, levels.indices, run) - before) / 2 / 2; // of two edges
        if ((double)levels.errors[i] < moved)
            fail_msg("level %u: edges moved by %g, and %g is said", i + 1, moved,
                     (double)levels.errors[i]);
    }
    arena_free(&s.memory);
}

static void what_is_small_or_broken_has_none(void **state) {
    (void)state;
    shape s;
    mesh_levels levels;
    make_ball(&s);
    s.data.index_count = 30;
    mesh_levels_make(&s.data, &s.memory, &levels);
    assert_int_equal(levels.count, 0);
    arena_free(&s.memory);
    for (int broken = 0; broken < 3; broken++) {
        make_ball(&s);
        if (broken == 0) s.vertices[7].position[1] = NAN;
        if (broken == 1) s.vertices[7].position[1] = 1e20f;
        if (broken == 2) s.indices[100] = s.data.vertex_count;
        mesh_levels_make(&s.data, &s.memory, &levels);
        assert_true(levels.count == 0 && levels.index_count == 0);
        arena_free(&s.memory);
    }
}

static void a_file_comes_with_its_levels(void **state) {
    (void)state;
    arena memory = {0};
    mesh_data mesh;
    char root[4096], path[4200];
    snprintf(root, sizeof root, "%s/effects", getenv("ROIL_SOURCE_DIR"));
    snprintf(path, sizeof path, "%s/data/pine.obj", root);
    if (!mesh_load(path, root, &memory, &mesh)) fail_msg("%s", err_get());
    assert_true(mesh.level_count > 0);
    uint32_t end = mesh.index_count;
    for (uint32_t i = 0; i < mesh.level_count; i++)
        for (uint32_t p = 0; p < mesh.part_count; p++) {
            assert_int_equal(mesh.levels[i].runs[p].first, end);
            end += mesh.levels[i].runs[p].count;
        }
    assert_int_equal(end, mesh.index_count + mesh.level_index_count);
    for (uint32_t i = 0; i < end; i++) assert_true(mesh.indices[i] < mesh.vertex_count);
    arena_free(&memory);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_as_near_as_they_say),
        cmocka_unit_test(seams_of_textures_stay),
        cmocka_unit_test(flat_faces_stay_flat),
        cmocka_unit_test(what_colours_have_moved_is_said),
        cmocka_unit_test(what_is_small_or_broken_has_none),
        cmocka_unit_test(a_file_comes_with_its_levels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
