// What the voxeliser makes of meshes, before any device sees them.
#include "base/maths.h"
#include "base/memory.h"
#include "scene/voxels_mesh.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h> // wants the headers above

enum { MOST = 512 };

typedef struct soup { // triangles with corners of their own, as files may have them
    mesh_vertex vertices[MOST];
    uint32_t indices[MOST], count;
} soup;

static void add(soup *s, float3 a, float3 b, float3 c) {
    const float3 corners[3] = {a, b, c};
    for (int i = 0; i < 3; i++) {
        s->indices[s->count] = s->count;
        s->vertices[s->count++] =
            (mesh_vertex){.position = {corners[i].x, corners[i].y, corners[i].z}};
    }
}

// A cube of side 2 * half around (x, 0, 0), its faces outwards, or inwards.
static void add_cube(soup *s, float x, float half, bool inwards) {
    for (int side = 0; side < 6; side++) {
        float3 p[4];
        for (int k = 0; k < 4; k++) {
            float v[3], u = k == 1 || k == 2 ? half : -half, w = k >= 2 ? half : -half;
            int axis = side / 2;
            v[axis] = side % 2 ? half : -half;
            v[(axis + 1) % 3] = u;
            v[(axis + 2) % 3] = w;
            p[k] = (float3){v[0] + x, v[1], v[2]};
        }
        bool turn = (side % 2 == 0) != inwards;
        add(s, p[0], p[turn ? 2 : 1], p[turn ? 1 : 2]);
        add(s, p[0], p[turn ? 3 : 2], p[turn ? 2 : 3]);
    }
}

static voxel_surface make(const soup *s, voxels_rule rule, uint32_t cells) {
    mesh_data mesh = {.vertices = s->vertices,
                      .vertex_count = s->count,
                      .indices = s->indices,
                      .index_count = s->count};
    voxel_surface out;
    voxel_surface_create(&out, &mesh, rule, cells);
    return out;
}

static size_t count_flag(const voxel_surface *s, uint32_t flag) {
    size_t count = 0;
    for (size_t i = 0; i < s->item_count; i++) count += (s->items[i].v[3] & flag) != 0;
    return count;
}

static void corners_at_a_place_are_one_point(void **state) {
    (void)state;
    soup s = {.count = 0};
    add_cube(&s, 0, 1, false);
    voxel_surface made = make(&s, VOXELS_AUTO, 4);
    assert_int_equal(made.point_count, 8);
    assert_int_equal(made.item_count, 12);
    assert_int_equal(made.group_count, 1);
    assert_int_equal(count_flag(&made, VOXEL_CROSSES), 12);
    assert_int_equal(count_flag(&made, VOXEL_SHELL), 0);
    assert_true(made.size == 2 && made.box.min.x == -1 && made.box.max.z == 1);
    assert_true(fabsf(made.groups[0].thinnest - 1) < 1e-3f); // the opposite face
    voxel_surface_free(&made);
}

// What a file says of a corner twice may differ in its last digit.
static void corners_that_are_all_but_at_a_place_are_one_point(void **state) {
    (void)state;
    soup s = {.count = 0};
    add_cube(&s, 0, 1, false);
    for (uint32_t i = 0; i < s.count; i += 2) s.vertices[i].position[0] += 2e-7f;
    voxel_surface made = make(&s, VOXELS_AUTO, 4);
    assert_int_equal(made.point_count, 8);
    assert_int_equal(count_flag(&made, VOXEL_SHELL), 0); // it is closed
    voxel_surface_free(&made);
    for (uint32_t i = 0; i < s.count; i += 2) s.vertices[i].position[0] += 2e-3f;
    made = make(&s, VOXELS_AUTO, 4);
    assert_true(made.point_count > 8); // that is a gap
    voxel_surface_free(&made);
}

static void triangles_without_area_and_duplicates_are_left_out(void **state) {
    (void)state;
    soup s = {.count = 0};
    add_cube(&s, 0, 1, false);
    add_cube(&s, 0, 1, false);
    add(&s, (float3){1, 1, 1}, (float3){1, 1, 1}, (float3){-1, 1, 1});
    voxel_surface made = make(&s, VOXELS_SOLID, 4);
    assert_int_equal(made.item_count, 12);
    voxel_surface_free(&made);
    add_cube(&s, 0, 1, true); // and seen from behind
    made = make(&s, VOXELS_SOLID, 4);
    assert_int_equal(count_flag(&made, VOXEL_CROSSES), 12);
    voxel_surface_free(&made);
}

static void open_parts_are_shells_unless_told_otherwise(void **state) {
    (void)state;
    soup s = {.count = 0};
    add_cube(&s, 0, 1, false);
    add_cube(&s, 4, 1, false);
    s.count -= 3; // of the second
    voxel_surface made = make(&s, VOXELS_AUTO, 4);
    assert_int_equal(made.group_count, 2);
    assert_int_equal(count_flag(&made, VOXEL_CROSSES), 12);
    assert_int_equal(count_flag(&made, VOXEL_SHELL), 11);
    assert_true(made.groups[1].thinnest == 0 && made.groups[1].box.min.x == 3);
    voxel_surface_free(&made);
    made = make(&s, VOXELS_SOLID, 4);
    assert_int_equal(count_flag(&made, VOXEL_CROSSES), 23);
    voxel_surface_free(&made);
    made = make(&s, VOXELS_SHELL, 4);
    assert_int_equal(count_flag(&made, VOXEL_CROSSES), 0);
    assert_int_equal(count_flag(&made, VOXEL_SHELL), 23);
    voxel_surface_free(&made);
}

static void parts_that_overlap_are_apart_and_cavities_are_not(void **state) {
    (void)state;
    soup s = {.count = 0};
    add_cube(&s, 0, 1, false);
    add_cube(&s, 1.5f, 1, false);    // overlaps
    add_cube(&s, 8, 1, false);       // far away
    add_cube(&s, -0.2f, 0.5f, true); // a cavity of the first
    voxel_surface made = make(&s, VOXELS_SOLID, 4);
    assert_int_equal(made.group_count, 2);
    assert_int_equal(made.groups[0].item_count + made.groups[1].item_count, 48);
    size_t with_cavity = made.groups[0].box.min.x == -1 ? 0 : 1;
    assert_true(made.groups[with_cavity].item_count >= 24);
    assert_true(made.groups[1 - with_cavity].box.min.x == 0.5f);
    voxel_surface_free(&made);
}

static void thin_parts_know_what_is_behind_them(void **state) {
    (void)state;
    soup s = {.count = 0};
    add_cube(&s, 0, 1, false);
    add_cube(&s, 0, 0.98f, true); // walls of 1/100 of the size
    voxel_surface made = make(&s, VOXELS_AUTO, 4);
    for (size_t i = 0; i < made.item_count; i++) {
        float behind = half_to_float((uint16_t)(made.items[i].v[3] >> 16));
        assert_true(fabsf(behind - 0.01f) < 1e-4f);
    }
    voxel_surface_free(&made);
}

// Lines across a triangle are shared out: about 512 to an item, each row of them in one.
static void large_triangles_are_cut_into_strips(void **state) {
    (void)state;
    soup s = {.count = 0};
    add_cube(&s, 0, 1, false);
    voxel_surface made = make(&s, VOXELS_SOLID, 128);
    assert_int_equal(made.item_count, 12 * 32);
    bool seen[32] = {false};
    for (size_t i = 0; i < 32; i++) {
        uint32_t flags = made.items[i].v[3];
        assert_int_equal(flags >> 6 & 63, 31);
        assert_false(seen[flags & 63]);
        seen[flags & 63] = true;
    }
    voxel_surface_free(&made);
}

static void nothing_is_made_of_nothing(void **state) {
    (void)state;
    soup s = {.count = 0};
    add(&s, (float3){1, 2, 3}, (float3){1, 2, 3}, (float3){1, 2, 3});
    voxel_surface made = make(&s, VOXELS_AUTO, 64);
    assert_int_equal(made.item_count, 0);
    assert_int_equal(made.group_count, 0);
    voxel_surface_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_at_a_place_are_one_point),
        cmocka_unit_test(corners_that_are_all_but_at_a_place_are_one_point),
        cmocka_unit_test(triangles_without_area_and_duplicates_are_left_out),
        cmocka_unit_test(open_parts_are_shells_unless_told_otherwise),
        cmocka_unit_test(parts_that_overlap_are_apart_and_cavities_are_not),
        cmocka_unit_test(thin_parts_know_what_is_behind_them),
        cmocka_unit_test(large_triangles_are_cut_into_strips),
        cmocka_unit_test(nothing_is_made_of_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
