// Point lights by the hundred as an effect file says them.
#include "pass/light/point_lights.h"
#include "script_helper.h"

#define HEAD "local fx = effect { name = 'lamps' }\n"
#define LIT                                                                                        \
    "\nlocal scene = geometry { }\n"                                                               \
    "local lit = shade { from = {scene, lamps}, point_lights_by = 'tiles' }\n"                     \
    "fx.output = final { over { point_light_glows { from = {scene, lamps}, mist = 0.1 }, lit } "   \
    "}.color\n"                                                                                    \
    "return fx\n"

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

static void effect_is_sound(effect *e) {
    if (!effect_check(e)) fail_msg("%s", err_get());
    effect_destroy(e);
}

static void fields_tell_lamps_apart(void **state) {
    (void)state;
    effect_is_sound(load(HEAD
                         "local lamps = point_lights { count = 3, falloff = 'linear',\n"
                         "  position = vec(sin(time + light_index), 2 * light_random, 1),\n"
                         "  color = palette { {0, '#ff0000'}, {1, '#0000ff'} }(light_random).rgb,\n"
                         "  power = param { 'power', 20 }, range = 4 }" LIT));
}

static void instances_have_a_lamp_each(void **state) {
    (void)state;
    helper_put("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    effect_is_sound(
        load(HEAD "local trees = instances { mesh { 'a.obj' }, at = { {0, 0, 0}, {2, 0, 0} } }\n"
                  "local lamps = point_lights { at = trees, position = {0, 0, 2},\n"
                  "  power = 200 * instance_state.x }" LIT));
}

static void what_is_wrong_is_said(void **state) {
    (void)state;
    refused(HEAD "point_lights { }", "one of 'count' (1 to 16384) and 'at'");
    refused(HEAD "point_lights { count = 0 }", "'count' is 0; 1 to 16384");
    refused(HEAD "point_lights { count = 16385 }", "'count' is 16385; 1 to 16384");
    refused(HEAD "point_lights { count = 2.5 }", "a whole number");
    refused(HEAD "point_lights { at = 3 }", "'at' takes instances { }; got a number");
    refused(HEAD "point_lights { count = 2, strength = 3 }", "unknown key 'strength'");
    refused(HEAD "point_lights { count = 2, position = 1, colour = {1, 1, 1} }", "'color'");
    refused(HEAD "point_lights { count = 2, range = -3 }", "'range' is -3; accepted: 0 and above");
    refused(HEAD "point_lights { count = 2, radius = -1 }", "'radius' is -1; accepted: 0");
    refused(HEAD "point_lights { count = 2, color = {1, -1, 1} }", "'color' is -1; accepted: 0");
    refused(HEAD "point_lights(3)", "point_lights takes named values");
    refused(HEAD "local scene = geometry { }\n"
                 "shade { from = scene, point_lights = scene.albedo }",
            "'point_lights' takes a pass point_lights { }");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_tell_lamps_apart),
        cmocka_unit_test(instances_have_a_lamp_each),
        cmocka_unit_test(what_is_wrong_is_said),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
