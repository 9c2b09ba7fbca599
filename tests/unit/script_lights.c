// Lights and the sky's image as an effect file says them.
#include "media/exr.h"
#include "script_helper.h"
#include <math.h>

#define HEAD "local fx = effect { name = 'lights' }\n"
#define TAIL "\nfx.output = final { geometry { }.albedo }.color\nreturn fx\n"

static effect *load(const char *text) {
    effect *e = helper_load(text);
    if (!e) fail_msg("%s", err_get());
    return e;
}

static void refused(const char *text, const char *message) {
    effect *e = helper_load(text);
    if (e) fail_msg("accepted: %s", text);
    if (!strstr(err_get(), message)) fail_msg("\"%s\" is not in: %s", message, err_get());
}

static float evaluate(effect *e, const field *node, double time, int component) {
    field_context context = *effect_pass_host(e)->context;
    context.time = time;
    float value[4];
    if (!field_eval(node, &context, (float3){0, 0, 0}, value)) fail_msg("%s", err_get());
    return value[component];
}

static void each_kind_can_be_made(void **state) {
    (void)state;
    effect *e = load(HEAD "fx.lights = {\n"
                          "  point_light { position = {1, 2, 3} },\n"
                          "  sphere_light { position = {0, 0, 1}, radius = 0.5, power = 40 },\n"
                          "  spot_light { position = {0, 0, 5}, color = '#ff0000', angle = 30 },\n"
                          "}" TAIL);
    const scene *s = effect_scene(e);
    assert_int_equal(s->light_count, 3);
    assert_int_equal(s->lights[0].kind, SCENE_POINT);
    assert_int_equal(s->lights[2].kind, SCENE_SPOT);
    assert_true(evaluate(e, s->lights[0].position, 0, 1) == 2);
    assert_true(evaluate(e, s->lights[0].power, 0, 0) == 100);
    assert_true(evaluate(e, s->lights[1].radius, 0, 0) == 0.5f);
    assert_true(evaluate(e, s->lights[2].color, 0, 0) == 1);
    assert_true(evaluate(e, s->lights[2].color, 0, 1) == 0);
    struct light_block block;
    assert_true(scene_fill_lights(s, effect_pass_host(e)->context, &block));
    assert_int_equal(block.count.v[0], 4);
    effect_destroy(e);
}

static void numbers_are_functions_curves_and_parameters(void **state) {
    (void)state;
    effect *e = load(HEAD "local p = param { 'brightness', 7 }\n"
                          "fx.lights = { spot_light {\n"
                          "  position = function(t) return {t, 0, 2 * t} end, power = p * 2,\n"
                          "  angle = curve { {0, 10}, {1, 20} } } }" TAIL);
    const scene_light *light = effect_scene(e)->lights;
    assert_true(evaluate(e, light->position, 3, 2) == 6);
    assert_true(evaluate(e, light->power, 0, 0) == 14);
    assert_true(fabsf(evaluate(e, light->angle, 0.5, 0) - 15) < 1e-4f);
    assert_true(effect_set(e, "brightness", "1"));
    assert_true(evaluate(e, light->power, 0, 0) == 2);
    effect_destroy(e);
}

static void last_list_counts(void **state) {
    (void)state;
    effect *e = load(HEAD "local a = point_light { position = {0, 0, 0} }\n"
                          "fx.lights = {a, a}\nassert(#fx.lights == 2)\nfx.lights = {a}" TAIL);
    assert_int_equal(effect_scene(e)->light_count, 1);
    effect_destroy(e);
    e = load(HEAD "fx.lights = {}" TAIL);
    assert_int_equal(effect_scene(e)->light_count, 0);
    effect_destroy(e);
}

static void mistakes_are_named(void **state) {
    (void)state;
    refused(HEAD "fx.lights = { point_light { position = {0, 0, 1}, range = -1 } }" TAIL,
            "point_light: 'range' is -1; accepted: 0 m or more");
    refused(HEAD "fx.lights = { spot_light { position = {0, 0, 1}, falloff = 'square' } }" TAIL,
            "spot_light: unknown value of 'falloff' 'square'");
    refused(HEAD "fx.lights = { point_light { position = {0, 0, 1}, falloff = 'linear' } }" TAIL,
            "point_light: falloff = \"linear\" ends at a 'range', which is missing");
    refused(HEAD "fx.lights = { point_light { } }" TAIL,
            "point_light: 'position' is missing: where it stands, {x, y, z} in metres");
    refused(HEAD "fx.lights = { sphere_light { position = {0, 0, 1} } }" TAIL,
            "sphere_light: 'radius' is missing");
    refused(HEAD "fx.lights = { point_light { position = {0, 0, 1}, radius = 1 } }" TAIL,
            "point_light: unknown key 'radius'");
    refused(HEAD "fx.lights = { spot_light { position = {0, 0, 1}, softnes = 1 } }" TAIL,
            "spot_light: unknown key 'softnes'; did you mean 'softness'?");
    refused(HEAD "fx.lights = { point_light { {0, 0, 1} } }" TAIL,
            "point_light takes only named values");
    refused(HEAD "fx.lights = { point_light { position = {0, 0, 1}, power = perlin { } } }" TAIL,
            "point_light: 'power' varies in space");
    refused(HEAD "fx.lights = point_light { position = {0, 0, 1} }" TAIL,
            "effect: 'lights' takes a list, as in { point_light { position = {0, 0, 3} } }; got a "
            "light");
    refused(HEAD "fx.lights = { key = point_light { position = {0, 0, 1} } }" TAIL,
            "got a table with names");
    refused(HEAD "fx.lights = { point_light { position = {0, 0, 1} }, sun { } }" TAIL,
            "effect: entry 2 of 'lights' is a sun");
    refused(HEAD "fx.lights = { point_light { position = {0, 0, 1}, power = -3 } }" TAIL,
            "point_light: 'power' is -3; accepted: 0 W or more");
    refused(HEAD "fx.sky = sky { night = 2 }" TAIL, "sky: 'night' is 2; accepted: 0 to 1");
    refused(HEAD "fx.camera = orbit { fov = 200 }" TAIL,
            "orbit: 'fov' is 200; accepted: 1 to 170 degrees");
    refused(HEAD "local a = {}\n"
                 "for i = 1, 64 do a[i] = point_light { position = {0, 0, i} } end\n"
                 "fx.lights = a" TAIL,
            "effect: 64 lights; at most 63 are possible");
    refused(HEAD "fx.light = {}" TAIL, "effect: unknown field 'light'; did you mean 'lights'?");
}

static const char *text_of(effect *e, const char *name) {
    static char said[64];
    const effect_control *c = effect_find_control(e, name);
    if (!c) fail_msg("%s", err_get());
    strbuf text = {0};
    effect_print_control(e, c, &text);
    snprintf(said, sizeof said, "%s", strbuf_text(&text));
    strbuf_free(&text);
    return said;
}

static const char named[] =
    HEAD "local lamp = spot_light { position = {0, 0, 5}, power = function(t) return t end }\n"
         "fx.lights = { lamp, lamp, point_light { position = {0, 0, 1} },\n"
         "              sphere_light { position = {0, 0, 1}, radius = 1, name = 'sun' } }" TAIL;

static void numbers_are_set_by_name(void **state) {
    (void)state;
    const effect_setting settings[] = {{"lamp_2.angle", "20", NULL}};
    effect *e = helper_load_with(named, NULL, settings, 1);
    if (!e || !effect_check_settings(e)) fail_msg("%s", err_get());
    const scene *s = effect_scene(e);
    assert_true(evaluate(e, s->lights[0].angle, 0, 0) == 45);
    assert_true(evaluate(e, s->lights[1].angle, 0, 0) == 20);
    assert_true(effect_set(e, "lamp.power", "50") && effect_set(e, "point_light.color", "#ff0000"));
    assert_true(effect_set(e, "sun_2.radius", "2")); // the sun itself has the name
    assert_true(evaluate(e, s->lights[0].power, 7, 0) == 50);
    assert_true(evaluate(e, s->lights[1].power, 7, 0) == 7);
    assert_true(evaluate(e, s->lights[3].radius, 0, 0) == 2);
    assert_string_equal(text_of(e, "point_light.color"), "#ff0000");
    assert_true(effect_reset(e, "lamp.power"));
    assert_true(evaluate(e, s->lights[0].power, 7, 0) == 7);
    effect_destroy(e);
}

static void wrong_settings_are_named(void **state) {
    (void)state;
    effect *e = load(named);
    assert_true(effect_check_settings(e));
    assert_false(effect_set(e, "lamp.power", "-1"));
    assert_string_equal(err_get(), "lamp.power is -1; accepted: 0 W or more");
    assert_false(effect_set(e, "lamp.color", "red"));
    assert_string_equal(err_get(), "lamp.color cannot be 'red'; accepted: #rrggbb or three "
                                   "numbers, as 1,0.5,0.1");
    assert_false(effect_set(e, "lamp.powr", "1"));
    assert_string_equal(err_get(), "nothing is named 'lamp.powr'; did you mean 'lamp.power'?");
    assert_false(effect_set(e, "point_light.angle", "1")); // only a spot has one
    effect_destroy(e);
}

// ---- the sky's image ----------------------------------------------------------------------------

static void put_sky(const char *name, float value) {
    char path[PATH_CAP];
    float values[8] = {value, value, value, value, value, value, value, value};
    exr_channel channel = {"Y", values, false};
    assert_true(path_join(path, helper_folder, name));
    if (!exr_write(path, &(exr_image){4, 2, &channel, 1})) fail_msg("%s", err_get());
}

static void sky_can_be_an_image(void **state) {
    (void)state;
    put_sky("sky.exr", 3);
    effect *e = load(HEAD "fx.sky = sky { image = 'sky.exr', rotation = 90 }" TAIL);
    struct frame_block frame;
    const scene *s = effect_scene(e);
    assert_non_null(s->sky.image);
    assert_true(scene_fill_frame(s, effect_pass_host(e)->context, 1, &frame));
    assert_true(frame.sky_zenith.v[3] == 1); // as bright as the file has it
    assert_true(fabsf(frame.sky_horizon.v[3] - GLM_PI_2f) < 1e-6f);
    assert_true(fabsf(frame.sky_zenith.v[0] - 3) < 1e-3f);
    const char *const *files;
    bool watched = false;
    for (size_t i = 0, n = effect_files(e, &files); i < n; i++)
        watched = watched || strcmp(path_name(files[i]), "sky.exr") == 0;
    assert_true(watched);
    effect_destroy(e);
}

static void controls_are_those_of_the_sky_that_is_there(void **state) {
    (void)state;
    put_sky("sky.exr", 3);
    effect *e = load(HEAD "fx.sky = sky { image = 'sky.exr', strength = 2 }" TAIL);
    assert_true(effect_check_settings(e));
    assert_true(effect_set(e, "sky.rotation", "45"));
    assert_true(effect_set(e, "sun.angle", "2"));
    assert_false(effect_set(e, "sky.zenith", "1,1,1"));
    assert_string_equal(err_get(),
                        "sky.zenith: this sky is an image; only one of two colours has it");
    effect_destroy(e);
    e = load(HEAD "fx.sky = sky { image = 'sky.exr' } fx.sky = sky { horizon = 1 }" TAIL);
    assert_null(effect_scene(e)->sky.image);
    assert_true(effect_check_settings(e));
    assert_true(effect_set(e, "sky.zenith", "1,1,1"));
    assert_false(effect_set(e, "sky.rotation", "45"));
    assert_string_equal(err_get(), "sky.rotation: this sky has no image");
    effect_destroy(e);
}

static void an_effect_has_one_image(void **state) {
    (void)state;
    put_sky("sky.exr", 3);
    effect *e = load(HEAD "fx.sky = sky { image = 'sky.exr' } fx.sky = sky { image = 'sky.exr' }"
                          "fx.sky = sky { image = './sky.exr' }" TAIL);
    effect_destroy(e);
    put_sky("other.exr", 3);
    refused(HEAD "fx.sky = sky { image = 'sky.exr' } fx.sky = sky { image = 'other.exr' }" TAIL,
            "other.exr: a second image for the sky; an effect has one");
}

static void mistakes_in_a_sky_are_named(void **state) {
    (void)state;
    put_sky("black.exr", 0);
    put_sky("below.exr", -1);
    helper_put("text.exr", "no picture");
    refused(HEAD "fx.sky = sky { image = 'black.exr' }" TAIL, "the panorama is all black");
    refused(HEAD "fx.sky = sky { image = 'below.exr' }" TAIL, "the panorama holds -1 at 0, 0");
    refused(HEAD "fx.sky = sky { image = 'text.exr' }" TAIL, "cannot be read as EXR");
    refused(HEAD "fx.sky = sky { image = 'none.exr' }" TAIL, "none.exr");
    refused(HEAD "fx.sky = sky { image = '../sky.exr' }" TAIL, "leads out");
    refused(HEAD "fx.sky = sky { image = 3 }" TAIL, "sky: 'image' must be a string");
    refused(HEAD "fx.sky = sky { image = 'black.exr', horizon = 1 }" TAIL,
            "sky: 'image' is given, and 'horizon' too; an image stands for both colours");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_kind_can_be_made),
        cmocka_unit_test(numbers_are_functions_curves_and_parameters),
        cmocka_unit_test(last_list_counts),
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(numbers_are_set_by_name),
        cmocka_unit_test(wrong_settings_are_named),
        cmocka_unit_test(sky_can_be_an_image),
        cmocka_unit_test(controls_are_those_of_the_sky_that_is_there),
        cmocka_unit_test(an_effect_has_one_image),
        cmocka_unit_test(mistakes_in_a_sky_are_named),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
