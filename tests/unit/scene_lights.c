// Sun and lights as the numbers that shaders read.
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
    scene_light lights[LIGHT_MAX];
    struct light_block block;
} stage;

static const double pi = 3.14159265358979;

static const field *number(stage *s, float v) {
    return field_constant(&s->memory, 1, (float[4]){v});
}

static const field *triple(stage *s, float x, float y, float z) {
    return field_constant(&s->memory, 3, (float[4]){x, y, z});
}

static int open_stage(void **state) {
    stage *s = mem_alloc(sizeof *s);
    scene_init(&s->scene, &s->memory);
    s->scene.lights = s->lights;
    *state = s;
    return 0;
}

static int close_stage(void **state) {
    stage *s = *state;
    arena_free(&s->memory);
    mem_free(s);
    return 0;
}

static scene_light *add(stage *s, scene_light_kind kind) {
    scene_light *light = &s->lights[s->scene.light_count++];
    *light = (scene_light){
        .kind = kind,
        .position = triple(s, 1, 2, 3),
        .color = triple(s, 1, 0.5f, 0),
        .power = number(s, 100),
        .radius = number(s, 0.25f),
        .target = triple(s, 1, 2, 0),
        .angle = number(s, 60),
        .softness = number(s, 0.5f),
    };
    return light;
}

static void fill(stage *s) {
    if (!scene_fill_lights(&s->scene, &s->context, &s->block)) fail_msg("%s", err_get());
}

static void near4(const shared_vec4 *got, double x, double y, double z, double w) {
    const double want[4] = {x, y, z, w};
    for (int i = 0; i < 4; i++)
        if (!(fabs((double)got->v[i] - want[i]) < 1e-4))
            fail_msg("(%g, %g, %g, %g), not (%g, %g, %g, %g)", (double)got->v[0], (double)got->v[1],
                     (double)got->v[2], (double)got->v[3], x, y, z, w);
}

static void sun_is_the_first_with_its_irradiance(void **state) {
    stage *s = *state;
    s->scene.sun.azimuth = number(s, 90);
    s->scene.sun.elevation = number(s, 30);
    s->scene.sun.color = triple(s, 1, 0.5f, 0.25f);
    s->scene.sun.strength = number(s, 4);
    s->scene.sun.angle = number(s, 60);
    fill(s);
    assert_int_equal(s->block.count.v[0], 1);
    near4(&s->block.lights[0].position, 0, sqrt(0.75), 0.5, 0.5);
    near4(&s->block.lights[0].color, 4, 2, 1, LIGHT_SUN);
}

static void sun_looks_as_wide_as_ours(void **state) {
    stage *s = *state;
    fill(s);
    near4(&s->block.lights[0].position, (double)s->block.lights[0].position.v[0],
          (double)s->block.lights[0].position.v[1], (double)s->block.lights[0].position.v[2],
          sin(0.265 * pi / 180));
}

static void power_goes_into_all_directions(void **state) {
    stage *s = *state;
    add(s, SCENE_POINT);
    fill(s);
    assert_int_equal(s->block.count.v[0], 2);
    near4(&s->block.lights[1].position, 1, 2, 3, 0.25);
    near4(&s->block.lights[1].color, 100 / (4 * pi), 50 / (4 * pi), 0, LIGHT_POINT);
}

static void one_number_is_a_grey(void **state) {
    stage *s = *state;
    scene_light *light = add(s, SCENE_POINT);
    light->color = number(s, 0.5f);
    light->position = number(s, 3);
    fill(s);
    near4(&s->block.lights[1].position, 3, 3, 3, 0.25);
    near4(&s->block.lights[1].color, 50 / (4 * pi), 50 / (4 * pi), 50 / (4 * pi), LIGHT_POINT);
}

static void spot_is_cut_from_a_point_light(void **state) {
    stage *s = *state;
    add(s, SCENE_SPOT);
    fill(s);
    near4(&s->block.lights[1].color, 100 / (4 * pi), 50 / (4 * pi), 0, LIGHT_SPOT);
    double outer = cos(pi / 6);
    near4(&s->block.lights[1].axis, 0, 0, -1, outer);
    near4(&s->block.lights[1].spread, (1 + outer) / 2, 0, 0, 0); // softness 0.5
}

static void spot_at_its_target_shines_down(void **state) {
    stage *s = *state;
    add(s, SCENE_SPOT)->target = triple(s, 1, 2, 3);
    fill(s);
    near4(&s->block.lights[1].axis, 0, 0, -1, cos(pi / 6));
}

static bool swing(void *user, int function, double time, float out[4]) {
    (void)user, (void)function;
    out[0] = out[1] = out[2] = out[3] = (float)time;
    return time < 5 || err_set("too late");
}

static void every_number_moves(void **state) {
    stage *s = *state;
    s->context = (field_context){.call = swing, .time = 2};
    add(s, SCENE_POINT)->power = field_call(&s->memory, 1, 1);
    fill(s);
    near4(&s->block.lights[1].color, 2 / (4 * pi), 1 / (4 * pi), 0, LIGHT_POINT);
    s->context.time = 6;
    assert_false(scene_fill_lights(&s->scene, &s->context, &s->block));
    assert_string_equal(err_get(), "light 1: too late");
}

static void what_no_light_can_be_is_kept_out(void **state) {
    stage *s = *state;
    scene_light *light = add(s, SCENE_SPOT);
    light->power = number(s, -5);
    light->radius = number(s, -1);
    light->position = triple(s, INFINITY, NAN, 0);
    light->angle = number(s, 900);
    light->softness = number(s, 7);
    fill(s);
    const struct light_entry *e = &s->block.lights[1];
    near4(&e->color, 0, 0, 0, LIGHT_SPOT);
    assert_true(e->position.v[3] == 0 && e->axis.v[3] == -1 && e->spread.v[0] == 1);
    for (int i = 0; i < 3; i++) assert_true(isfinite(e->position.v[i]) && isfinite(e->axis.v[i]));
}

static void there_is_room_for_all(void **state) {
    stage *s = *state;
    for (int i = 1; i < LIGHT_MAX; i++) add(s, SCENE_POINT);
    fill(s);
    assert_int_equal(s->block.count.v[0], LIGHT_MAX);
    assert_true(s->block.lights[LIGHT_MAX - 1].color.v[0] > 0);
}

#define STAGE_TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, close_stage)

int main(void) {
    const struct CMUnitTest tests[] = {
        STAGE_TEST(sun_is_the_first_with_its_irradiance),
        STAGE_TEST(sun_looks_as_wide_as_ours),
        STAGE_TEST(power_goes_into_all_directions),
        STAGE_TEST(one_number_is_a_grey),
        STAGE_TEST(spot_is_cut_from_a_point_light),
        STAGE_TEST(spot_at_its_target_shines_down),
        STAGE_TEST(every_number_moves),
        STAGE_TEST(what_no_light_can_be_is_kept_out),
        STAGE_TEST(there_is_room_for_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
