// From the world to the window and back.
#include "base_test.h"

#include "app/lens.h"
#include "base/maths.h"
#include "base/memory.h"

static const ui_rect view = {10, 20, 810, 620};
static const roil_camera cameras[] = {
    {.eye = {4, -12, 3.36f}, .target = {4, 4, 3.36f}, .fov = 31.89f},
    {.eye = {-3, 2, 8}, .target = {1, 1, 1}, .fov = 60},
    {.eye = {0, 0, 50}, .target = {0, 0, 0}, .fov = 1}, // from above
    {.eye = {-9, 0, 1}, .target = {0, 0, 1}, .fov = 40, .orthographic = 6},
};

static void near3(const float a[3], const float b[3], float within) {
    for (int i = 0; i < 3; i++) assert_float_equal(a[i], b[i], within);
}

static void what_is_looked_at_is_in_the_middle(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cameras); i++) {
        lens l = lens_make(&cameras[i], view, 4 / 3.0f);
        float at[2];
        assert_true(lens_project(&l, cameras[i].target, at));
        assert_float_equal(at[0], 410, 1e-2f);
        assert_float_equal(at[1], 320, 1e-2f);
    }
    lens l = lens_make(&cameras[0], view, 1); // narrower than the view: bars at its sides
    assert_float_equal(l.picture.left, 110, 1e-3f);
    assert_float_equal(l.picture.bottom, 620, 1e-3f);
    l = lens_make(&cameras[0], view, 2);
    assert_float_equal(l.picture.top, 120, 1e-3f);
    assert_float_equal(l.picture.right, 810, 1e-3f);
}

static void x_is_right_and_z_is_up(void **state) {
    (void)state;
    lens l = lens_make(&cameras[0], view, 4 / 3.0f);
    float middle[2], right[2], up[2];
    assert_true(lens_project(&l, (float[]){4, 4, 3.36f}, middle));
    assert_true(lens_project(&l, (float[]){5, 4, 3.36f}, right));
    assert_true(lens_project(&l, (float[]){4, 4, 4.36f}, up));
    assert_float_equal(right[0] - middle[0], lens_pixels(&l, (float[]){4, 4, 3.36f}), 1e-2f);
    assert_float_equal(right[1], middle[1], 1e-2f);
    assert_float_equal(middle[1] - up[1], 600 / (2 * 16 * tanf(glm_rad(31.89f) / 2)), 1e-2f);
    l = lens_make(&cameras[2], view, 4 / 3.0f);
    assert_true(lens_project(&l, (float[]){0, 0.1f, 0}, up));
    assert_true(up[1] < 310); // +Y is up where one looks down
}

static void without_perspective_depth_changes_nothing(void **state) {
    (void)state;
    lens l = lens_make(&cameras[3], view, 4 / 3.0f);
    float near[2], far[2];
    assert_true(lens_project(&l, (float[]){-3, -1, 2}, near));
    assert_true(lens_project(&l, (float[]){3, -1, 2}, far));
    assert_float_equal(near[0], far[0], 0.6f);
    assert_float_equal(near[1], far[1], 0.6f);
    assert_float_equal(near[0] - 410, 100, 0.5f); // 6 m are the 600 pixels of its height
    assert_float_equal(320 - near[1], 100, 0.5f);
}

static void rays_go_through_what_is_projected(void **state) {
    (void)state;
    const float point[3] = {0.5f, 1.5f, 0.75f};
    for (size_t i = 0; i < COUNT_OF(cameras); i++) {
        lens l = lens_make(&cameras[i], view, 4 / 3.0f);
        float at[2];
        vec3 ray, to, found;
        assert_true(lens_project(&l, point, at));
        lens_ray(&l, at[0], at[1], ray);
        glm_vec3_sub((float *)(uintptr_t)point, l.eye, to);
        glm_vec3_normalize(to);
        near3(ray, to, 1e-5f);
        assert_true(lens_on_plane(&l, at[0], at[1], point, l.forward, found));
        near3(found, point, 1e-3f);
        vec3 beside = {0.5f, 1.5f - 2, 0.75f}; // on the same line along y
        if (lens_on_line(&l, at[0], at[1], beside, (float[]){0, 1, 0}, found))
            near3(found, point, 2e-3f);
        else
            fail();
        lens_on_sphere(&l, at[0], at[1], (float[]){0.5f, 1.5f, 0}, 0.75f, false, found);
        assert_float_equal(glm_vec3_distance(found, (float[]){0.5f, 1.5f, 0}), 0.75f, 1e-2f);
    }
}

static void what_is_behind_is_not_seen(void **state) {
    (void)state;
    lens l = lens_make(&cameras[0], view, 4 / 3.0f);
    const float before[3] = {4, 0, 3}, behind[3] = {4, -20, 3}, more[3] = {4, -30, 3};
    float at[2], line[4];
    assert_false(lens_project(&l, behind, at));
    assert_false(lens_project_line(&l, behind, more, line));
    assert_true(lens_project_line(&l, before, behind, line));
    assert_true(lens_project(&l, before, at));
    assert_float_equal(line[0], at[0], 1e-3f);
    assert_true(line[3] > view.bottom); // it goes out below, under the eye
    assert_true(lens_project_line(&l, behind, before, line));
    assert_float_equal(line[2], at[0], 1e-3f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_looked_at_is_in_the_middle),
        cmocka_unit_test(x_is_right_and_z_is_up),
        cmocka_unit_test(without_perspective_depth_changes_nothing),
        cmocka_unit_test(rays_go_through_what_is_projected),
        cmocka_unit_test(what_is_behind_is_not_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
