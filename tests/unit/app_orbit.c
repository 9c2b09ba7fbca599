// The camera moved by hand: what is framed is seen, what is turned comes back.
#include "base_test.h"

#include "app/orbit.h"
#include "base/maths.h"

// Where a point lands in the picture: -1 to 1 each way when it is inside, z its distance in front.
static void project(const roil_camera *camera, float aspect, const float point[3], vec3 out) {
    mat4 view;
    vec4 p = {point[0], point[1], point[2], 1}, seen;
    vec3 up = {0, 0, 1};
    glm_lookat((float *)camera->eye, (float *)camera->target, up, view);
    glm_mat4_mulv(view, p, seen);
    float half = tanf(glm_rad(camera->fov) / 2);
    out[0] = seen[0] / -seen[2] / (half * aspect);
    out[1] = seen[1] / -seen[2] / half;
    out[2] = -seen[2];
}

static void near3(const float a[3], const float b[3], float within) {
    for (int i = 0; i < 3; i++) assert_true(fabsf(a[i] - b[i]) <= within);
}

static void what_goes_in_comes_out(void **state) {
    (void)state;
    static const roil_camera cameras[] = {
        {.eye = {4, -12, 3.36f}, .target = {4, 4, 3.36f}, .fov = 31.89f},
        {.eye = {5, 0, 0}, .target = {0, 0, 0}, .fov = 60},
        {.eye = {-3, 2, 8}, .target = {1, 1, 1}, .fov = 20},
        {.eye = {0.01f, 0.02f, -0.01f}, .target = {0, 0, 0}, .fov = 45},
        {.eye = {1000, -2000, 500}, .target = {0, 0, 0}, .fov = 10},
    };
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        orbit o;
        roil_camera back;
        orbit_from(&o, &cameras[i]);
        orbit_to(&o, &back);
        near3(back.eye, cameras[i].eye, 1e-5f * (1 + o.distance));
        near3(back.target, cameras[i].target, 0);
        assert_true(back.fov == cameras[i].fov);
    }
}

static void yaw_counts_as_in_lua(void **state) {
    (void)state;
    orbit o;
    orbit_from(&o, &(roil_camera){.eye = {0, -6, 0}, .target = {0, 0, 0}, .fov = 40});
    assert_true(fabsf(o.yaw) < 1e-4f && fabsf(o.pitch) < 1e-4f); // looks along +Y
    orbit_from(&o, &(roil_camera){.eye = {6, 0, 6}, .target = {0, 0, 0}, .fov = 40});
    assert_true(fabsf(o.yaw - 90) < 1e-4f && fabsf(o.pitch - 45) < 1e-4f);
}

static void straight_down_and_nowhere_are_no_accident(void **state) {
    (void)state;
    orbit o;
    roil_camera back;
    orbit_from(&o, &(roil_camera){.eye = {1, 2, 9}, .target = {1, 2, 3}, .fov = 40});
    orbit_to(&o, &back);
    near3(back.eye, (float[3]){1, 2, 9}, 1e-4f);
    orbit_from(&o, &(roil_camera){.eye = {1, 2, 3}, .target = {1, 2, 3}, .fov = 40});
    assert_true(o.distance > 0 && isfinite(o.yaw) && isfinite(o.pitch));
}

static void turning_keeps_the_distance_and_the_horizon(void **state) {
    (void)state;
    orbit o;
    roil_camera camera;
    orbit_from(&o, &(roil_camera){.eye = {0, -6, 1}, .target = {0, 0, 1}, .fov = 40});
    for (int i = 0; i < 500; i++) {
        orbit_turn(&o, 7.3f, 3.1f);
        orbit_to(&o, &camera);
        assert_true(fabsf(glm_vec3_distance(camera.eye, camera.target) - 6) < 1e-3f);
        assert_true(o.pitch <= 89);
    }
    assert_true(o.pitch == 89);
}

static void panning_moves_by_shares_of_the_picture(void **state) {
    (void)state;
    orbit o;
    roil_camera camera;
    vec3 before, after;
    const float aspect = 1.5f, point[3] = {0, 0, 1};
    orbit_from(&o, &(roil_camera){.eye = {2, -6, 3}, .target = {0, 0, 1}, .fov = 40});
    orbit_to(&o, &camera);
    project(&camera, aspect, point, before);
    orbit_pan(&o, 0.25f, 0.1f); // to the right and down, as the pointer does
    orbit_to(&o, &camera);
    project(&camera, aspect, point, after);
    assert_true(fabsf((after[0] - before[0]) * aspect - 0.5f) < 1e-4f);
    assert_true(fabsf((after[1] - before[1]) + 0.2f) < 1e-4f);
}

static void a_raised_eye_is_as_high_as_said(void **state) {
    (void)state;
    static const roil_camera cameras[] = {
        {.eye = {0, -6, -2}, .target = {0, 0, 1}, .fov = 40}, // below what it looks at
        {.eye = {3, -1, 0.5f}, .target = {1, 1, 0}, .fov = 40},
        {.eye = {0, -1, -9}, .target = {0, 0, -8}, .fov = 40}, // too near to be turned
        {.eye = {0, -6, 4}, .target = {0, 0, 1}, .fov = 40}};  // high enough
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++)
        for (int shift = 0; shift < 2; shift++) {
            orbit o, before;
            roil_camera camera;
            orbit_from(&o, &cameras[i]);
            before = o;
            orbit_raise(&o, 1.5f, shift);
            orbit_to(&o, &camera);
            assert_true(fabsf(camera.eye[2] - fmaxf(cameras[i].eye[2], 1.5f)) < 1e-4f);
            assert_true(o.distance == before.distance && o.yaw == before.yaw);
            assert_true(o.target[0] == before.target[0] && o.target[1] == before.target[1]);
            if (shift) assert_true(o.pitch == before.pitch);
            if (!shift && i != 2) assert_true(o.target[2] == before.target[2]);
        }
}

static void zooming_never_reaches_the_target(void **state) {
    (void)state;
    orbit o;
    orbit_from(&o, &(roil_camera){.eye = {0, -6, 1}, .target = {0, 0, 1}, .fov = 40});
    float before = o.distance;
    orbit_zoom(&o, 1);
    assert_true(o.distance < before);
    orbit_zoom(&o, -1);
    assert_true(fabsf(o.distance - before) < 1e-4f);
    orbit_zoom(&o, 1e4f);
    assert_true(o.distance > 0);
    orbit_zoom(&o, -1e4f);
    assert_true(isfinite(o.distance));
}

static void a_framed_box_is_seen_whole(void **state) {
    (void)state;
    static const float boxes[][2][3] = {{{-1, -1, 0}, {1, 1, 4}},
                                        {{0, 0, 0}, {8, 8, 6.7f}},
                                        {{-100, 3, -1}, {100, 3.1f, 1}},
                                        {{5, 5, 5}, {5.01f, 5.01f, 5.01f}}};
    static const float aspects[] = {0.3f, 1, 16 / 9.0f, 4};
    for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++)
        for (size_t a = 0; a < sizeof aspects / sizeof *aspects; a++)
            for (int turn = 0; turn < 40; turn++) {
                orbit o = {.distance = 3, .fov = 15 + 2.5f * (float)turn};
                orbit_turn(&o, (float)turn * 31, (float)(turn % 9 - 4) * 21);
                orbit_frame(&o, boxes[b][0], boxes[b][1], aspects[a]);
                roil_camera camera;
                orbit_to(&o, &camera);
                float reach = 0;
                for (int corner = 0; corner < 8; corner++) {
                    vec3 seen, p;
                    for (int i = 0; i < 3; i++) p[i] = boxes[b][corner >> i & 1][i];
                    project(&camera, aspects[a], p, seen);
                    assert_true(seen[2] > 0);
                    reach = fmaxf(reach, fmaxf(fabsf(seen[0]), fabsf(seen[1])));
                }
                assert_true(reach < 1);
                assert_true(reach > 0.85f); // and fills the picture
            }
}

static void without_perspective_the_eye_stays(void **state) {
    (void)state;
    orbit o = {.distance = 5, .fov = 40}, before = o;
    orbit_flatten(&o);
    float height = orbit_height(&o);
    assert_float_equal(height, 2 * 5 * tanf(glm_rad(20)), 1e-5f);
    orbit_zoom(&o, 2);
    assert_true(o.distance == 5 && orbit_height(&o) < height);
    orbit_zoom(&o, 1e4f);
    assert_true(o.orthographic > 0);
    o = before;
    orbit_flatten(&o);
    orbit_frame(&o, (float[]){-1, -1, 0}, (float[]){1, 1, 4}, 2);
    assert_true(o.orthographic > 4 && o.orthographic < 4.5f);
    orbit_deepen(&o);
    assert_true(o.orthographic == 0);
    assert_float_equal(orbit_height(&o), 4.32f, 0.02f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_goes_in_comes_out),
        cmocka_unit_test(yaw_counts_as_in_lua),
        cmocka_unit_test(straight_down_and_nowhere_are_no_accident),
        cmocka_unit_test(turning_keeps_the_distance_and_the_horizon),
        cmocka_unit_test(panning_moves_by_shares_of_the_picture),
        cmocka_unit_test(a_raised_eye_is_as_high_as_said),
        cmocka_unit_test(zooming_never_reaches_the_target),
        cmocka_unit_test(a_framed_box_is_seen_whole),
        cmocka_unit_test(without_perspective_the_eye_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
