// Camera, sun, sky and mesh transforms as numbers.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/memory.h"
#include "scene/scene.h"
#include <math.h>
#include <string.h>

typedef struct stage {
    arena memory;
    scene scene;
    field_context context;
    struct frame_block frame;
} stage;

static const field *number(stage *s, float v) {
    return field_constant(&s->memory, 1, (float[4]){v});
}

static const field *triple(stage *s, float x, float y, float z) {
    return field_constant(&s->memory, 3, (float[4]){x, y, z});
}

static int open_stage(void **state) {
    stage *s = mem_alloc(sizeof *s);
    scene_init(&s->scene, &s->memory);
    *state = s;
    return 0;
}

static int close_stage(void **state) {
    stage *s = *state;
    arena_free(&s->memory);
    mem_free(s);
    return 0;
}

static void fill(stage *s, float aspect) {
    if (!scene_fill_frame(&s->scene, &s->context, aspect, &s->frame)) fail_msg("%s", err_get());
}

static void near3(const float *got, double x, double y, double z) {
    const double want[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        if (!(fabs((double)got[i] - want[i]) < 1e-4))
            fail_msg("(%g, %g, %g), not (%g, %g, %g)", (double)got[0], (double)got[1],
                     (double)got[2], x, y, z);
}

// Where a point of the world lies in the camera's space.
static void see(const stage *s, const float p[3], float out[4]) {
    const float *m = s->frame.view.m;
    for (int i = 0; i < 4; i++)
        out[i] = m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i];
}

static void project(const stage *s, const float seen[4], float out[3]) {
    const float *m = s->frame.projection.m;
    float clip[4];
    for (int i = 0; i < 4; i++)
        clip[i] = m[i] * seen[0] + m[4 + i] * seen[1] + m[8 + i] * seen[2] + m[12 + i] * seen[3];
    for (int i = 0; i < 3; i++) out[i] = clip[i] / clip[3];
}

// ---- orbit ------------------------------------------------------------------------------------

static void orbit(stage *s, float yaw, float pitch) {
    s->scene.camera.target = triple(s, 1, 2, 3);
    s->scene.camera.distance = number(s, 4);
    s->scene.camera.yaw = number(s, yaw);
    s->scene.camera.pitch = number(s, pitch);
    fill(s, 1);
}

static void orbit_at_yaw_0_looks_along_y(void **state) {
    stage *s = *state;
    orbit(s, 0, 0);
    near3(s->frame.eye.v, 1, -2, 3);
    float seen[4];
    see(s, (float[3]){1, 2, 3}, seen);
    near3(seen, 0, 0, -4); // the camera looks along -z of its own space
    see(s, (float[3]){2, 2, 4}, seen);
    near3(seen, 1, 1, -4); // +X is right, +Z is up
}

static void yaw_turns_the_eye_counter_clockwise_seen_from_above(void **state) {
    stage *s = *state;
    orbit(s, 90, 0);
    near3(s->frame.eye.v, 5, 2, 3);
    orbit(s, 180, 0);
    near3(s->frame.eye.v, 1, 6, 3);
    orbit(s, -90, 0);
    near3(s->frame.eye.v, -3, 2, 3);
    orbit(s, 360, 0);
    near3(s->frame.eye.v, 1, -2, 3);
}

static void pitch_raises_the_eye_at_the_same_distance(void **state) {
    stage *s = *state;
    orbit(s, 0, 30);
    near3(s->frame.eye.v, 1, 2 - 4 * sqrt(3) / 2, 3 + 2);
    orbit(s, 0, -30);
    near3(s->frame.eye.v, 1, 2 - 4 * sqrt(3) / 2, 3 - 2);
}

static void pitch_at_the_pole_keeps_the_yaw(void **state) {
    stage *s = *state;
    const float pitches[] = {0, 60, 88, 89.5f, 90, 120, -88, -90};
    for (size_t i = 0; i < COUNT_OF(pitches); i++) {
        orbit(s, 60, pitches[i]);
        // The first column of the inverse is the camera's right, which pitch does not turn.
        near3(s->frame.view_inverse.m, 0.5, sqrt(3) / 2, 0);
    }
}

static void eye_replaces_the_orbit(void **state) {
    stage *s = *state;
    s->scene.camera.eye = triple(s, 7, 8, 9);
    orbit(s, 45, 45);
    near3(s->frame.eye.v, 7, 8, 9);
}

static void straight_down_and_up_have_y_on_the_vertical(void **state) {
    stage *s = *state;
    for (int down = 0; down < 2; down++) {
        s->scene.camera.eye = triple(s, 0, 0, down ? 5 : -5);
        s->scene.camera.target = triple(s, 0, 0, 0);
        fill(s, 1);
        float seen[4];
        see(s, (float[3]){0, 1, 0}, seen);
        near3(seen, 0, 1, -5);
        see(s, (float[3]){1, 0, 0}, seen);
        near3(seen, down ? 1 : -1, 0, -5);
    }
}

static void eye_at_the_target_looks_along_y(void **state) {
    stage *s = *state;
    s->scene.camera.eye = s->scene.camera.target = triple(s, 1, 1, 1);
    fill(s, 1);
    float seen[4];
    see(s, (float[3]){1, 3, 1}, seen);
    near3(seen, 0, 0, -2);
}

// ---- lens -------------------------------------------------------------------------------------

static void lens_and_projection_agree(void **state) {
    stage *s = *state;
    s->scene.camera.fov = number(s, 60);
    s->scene.camera.near = number(s, 0.5f);
    s->scene.camera.far = number(s, 50);
    fill(s, 2);
    double half = tan(30 * GLM_PI / 180);
    near3(s->frame.lens.v, 2 * half, half, 0.5);
    assert_true(s->frame.lens.v[3] == 50);
    float at[3], x = (float)(2 * half), y = (float)half;
    project(s, (float[4]){0, 0, -0.5f, 1}, at);
    near3(at, 0, 0, 0); // near is depth 0
    project(s, (float[4]){0, 0, -50, 1}, at);
    near3(at, 0, 0, 1);
    project(s, (float[4]){3 * x, 3 * y, -3, 1}, at);
    near3(at, 1, -1, (double)at[2]); // the upper right corner; y points down in the picture
}

// What is 1 m off the axis is half the way to the edge of a picture of 4 m, however deep it lies
// and wherever the camera stands; within half a pixel of a thousand.
static void an_orthographic_picture_is_so_high(void **state) {
    stage *s = *state;
    s->scene.camera.orthographic = number(s, 4);
    for (int turn = 0; turn < 8; turn++) {
        orbit(s, 25 + 45.0f * (float)turn, 20);
        for (int deep = -1; deep <= 1; deep++) {
            const float *m = s->frame.view_inverse.m;
            float at[3], seen[4], clip[3];
            for (int i = 0; i < 3; i++)
                at[i] = (float)(1 + i) + m[i] + 0.5f * m[4 + i] + 2 * (float)deep * m[8 + i];
            see(s, at, seen);
            project(s, seen, clip);
            assert_float_equal(clip[0], 0.5, 1e-3);
            assert_float_equal(clip[1], -0.25, 1e-3);
            assert_true(clip[2] > 0 && clip[2] < 1);
        }
        assert_float_equal(s->frame.eye.v[3], 4000 - 4, 1e-2); // from where it is said to stand
    }
}

static void lens_out_of_range_is_brought_into_it(void **state) {
    stage *s = *state;
    s->scene.camera.fov = number(s, 0);
    s->scene.camera.near = number(s, 0);
    s->scene.camera.far = number(s, 0);
    fill(s, 1);
    for (int i = 0; i < 16; i++) assert_true(isfinite(s->frame.projection.m[i]));
    assert_true(s->frame.lens.v[1] > 0 && s->frame.lens.v[2] > 0);
    assert_true(s->frame.lens.v[3] > s->frame.lens.v[2]);
}

static void view_inverse_undoes_view(void **state) {
    stage *s = *state;
    orbit(s, 33, 21);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            double sum = 0;
            for (int j = 0; j < 4; j++)
                sum +=
                    (double)s->frame.view.m[4 * j + i] * (double)s->frame.view_inverse.m[4 * k + j];
            assert_true(fabs(sum - (i == k)) < 1e-5);
        }
}

// ---- light ------------------------------------------------------------------------------------

static void sun_direction_follows_azimuth_and_elevation(void **state) {
    stage *s = *state;
    static const struct {
        float azimuth, elevation;
        double at[3];
    } cases[] = {{0, 0, {1, 0, 0}},
                 {90, 0, {0, 1, 0}},
                 {180, 45, {-M_SQRT1_2, 0, M_SQRT1_2}},
                 {17, 90, {0, 0, 1}},
                 {-90, -30, {0, -0.8660254, -0.5}}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        s->scene.sun.azimuth = number(s, cases[i].azimuth);
        s->scene.sun.elevation = number(s, cases[i].elevation);
        fill(s, 1);
        near3(s->frame.sun_direction.v, cases[i].at[0], cases[i].at[1], cases[i].at[2]);
    }
}

static void sun_radiance_is_irradiance_over_pi(void **state) {
    stage *s = *state;
    s->scene.sun.color = triple(s, 1, 0.5f, 0.25f);
    s->scene.sun.strength = number(s, GLM_PIf);
    fill(s, 1);
    near3(s->frame.sun_radiance.v, 1, 0.5, 0.25);
}

static void sky_colours_are_scaled_by_its_strength(void **state) {
    stage *s = *state;
    s->scene.sky.zenith = triple(s, 0.1f, 0.2f, 0.4f);
    s->scene.sky.horizon = triple(s, 0.6f, 0.5f, 0.3f);
    s->scene.sky.strength = number(s, 2);
    fill(s, 1);
    near3(s->frame.sky_zenith.v, 0.2, 0.4, 0.8);
    near3(s->frame.sky_horizon.v, 1.2, 1, 0.6);
}

static void sun_and_sky_keep_out_what_is_no_light(void **state) {
    stage *s = *state;
    s->scene.sun.azimuth = number(s, NAN);
    s->scene.sun.elevation = number(s, INFINITY);
    s->scene.sun.strength = number(s, INFINITY);
    s->scene.sky.zenith = triple(s, 1e30f, 1, 1);
    s->scene.sky.strength = number(s, 1e30f);
    s->scene.sky.horizon = triple(s, -1, 0, NAN);
    fill(s, 1);
    near3(s->frame.sun_direction.v, 1, 0, 0);
    for (int i = 0; i < 3; i++) {
        assert_true(isfinite(s->frame.sun_radiance.v[i]) && s->frame.sun_radiance.v[i] > 1e9f);
        assert_true(isfinite(s->frame.sky_zenith.v[i]) && s->frame.sky_zenith.v[i] > 1e9f);
    }
    near3(s->frame.sky_horizon.v, 0, 0, 0);
}

// ---- values that move -------------------------------------------------------------------------

static bool fail_call(void *user, int function, double time, float out[4]) {
    (void)user, (void)function, (void)time, (void)out;
    return err_set("effect.lua:7: no");
}

static void yaw_may_be_a_curve(void **state) {
    stage *s = *state;
    const curve_key keys[] = {{0, {0}}, {2, {180}}};
    const curve *c = curve_create(&s->memory, &(curve){CURVE_LINEAR, 1, keys, COUNT_OF(keys), 0});
    assert_non_null(c);
    orbit(s, 0, 0);
    s->scene.camera.yaw = field_curve(&s->memory, c);
    s->context.time = 1;
    fill(s, 1);
    near3(s->frame.eye.v, 5, 2, 3);
}

static void failing_function_fails_the_frame(void **state) {
    stage *s = *state;
    s->context.call = fail_call;
    s->scene.sky.strength = field_call(&s->memory, 1, 0);
    assert_false(scene_fill_frame(&s->scene, &s->context, 1, &s->frame));
    assert_non_null(strstr(err_get(), "effect.lua:7: no"));
}

// ---- meshes -----------------------------------------------------------------------------------

static void place(stage *s, const scene_mesh *mesh, const float p[3], float out[4]) {
    mat4 m;
    assert_true(scene_mesh_transform(mesh, &s->context, m));
    vec4 at = {p[0], p[1], p[2], 1};
    glm_mat4_mulv(m, at, out);
}

static void mesh_is_scaled_then_turned_then_moved(void **state) {
    stage *s = *state;
    scene_mesh mesh = {
        .position = triple(s, 10, 20, 30), .rotation = triple(s, 0, 0, 90), .scale = number(s, 2)};
    float at[4];
    place(s, &mesh, (float[3]){1, 0, 0}, at);
    near3(at, 10, 22, 30);
    place(s, &mesh, (float[3]){0, 0, 1}, at);
    near3(at, 10, 20, 32);
}

static void mesh_turns_about_x_then_y_then_z(void **state) {
    stage *s = *state;
    scene_mesh mesh = {
        .position = triple(s, 0, 0, 0), .rotation = triple(s, 90, 90, 0), .scale = number(s, 1)};
    float at[4];
    place(s, &mesh, (float[3]){0, 1, 0}, at); // about X to +Z, about Y to +X
    near3(at, 1, 0, 0);
    mesh.rotation = triple(s, 0, 90, 90);
    place(s, &mesh, (float[3]){0, 0, 1}, at); // about Y to +X, about Z to +Y
    near3(at, 0, 1, 0);
}

// A field that is transformed and a mesh that is turned by the same angles lie alike.
static void mesh_turns_as_fields_do(void **state) {
    stage *s = *state;
    const field *angles = triple(s, 20, -35, 70), *position = triple(s, 1, 2, 3);
    scene_mesh mesh = {.position = position, .rotation = angles, .scale = number(s, 1.5f)};
    const field *args[FIELD_MAX_ARGS] = {
        field_make(&s->memory, "position", (const field *[16]){0}, NULL), position, angles,
        triple(s, 1.5f, 1.5f, 1.5f)};
    const field *inside = field_make(&s->memory, "transform", args, NULL);
    assert_non_null(inside);
    const float p[3] = {0.3f, -0.8f, 0.5f};
    float at[4], back[4];
    place(s, &mesh, p, at);
    assert_true(field_eval(inside, &s->context, (float3){at[0], at[1], at[2]}, back));
    near3(back, (double)p[0], (double)p[1], (double)p[2]);
}

#define STAGE_TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, close_stage)

int main(void) {
    static const struct CMUnitTest tests[] = {
        STAGE_TEST(orbit_at_yaw_0_looks_along_y),
        STAGE_TEST(yaw_turns_the_eye_counter_clockwise_seen_from_above),
        STAGE_TEST(pitch_raises_the_eye_at_the_same_distance),
        STAGE_TEST(pitch_at_the_pole_keeps_the_yaw),
        STAGE_TEST(eye_replaces_the_orbit),
        STAGE_TEST(straight_down_and_up_have_y_on_the_vertical),
        STAGE_TEST(eye_at_the_target_looks_along_y),
        STAGE_TEST(lens_and_projection_agree),
        STAGE_TEST(an_orthographic_picture_is_so_high),
        STAGE_TEST(lens_out_of_range_is_brought_into_it),
        STAGE_TEST(view_inverse_undoes_view),
        STAGE_TEST(sun_direction_follows_azimuth_and_elevation),
        STAGE_TEST(sun_radiance_is_irradiance_over_pi),
        STAGE_TEST(sky_colours_are_scaled_by_its_strength),
        STAGE_TEST(sun_and_sky_keep_out_what_is_no_light),
        STAGE_TEST(yaw_may_be_a_curve),
        STAGE_TEST(failing_function_fails_the_frame),
        STAGE_TEST(mesh_is_scaled_then_turned_then_moved),
        STAGE_TEST(mesh_turns_about_x_then_y_then_z),
        STAGE_TEST(mesh_turns_as_fields_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
