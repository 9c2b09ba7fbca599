// slices { } in an effect file: what it gives, what can be set by name, and what is said after a
// mistake. Without a device.
#include "script_helper.h"

#define HEAD "local fx = effect { name = 'flow' }\n"
#define FLOW "local flow = slices { size = {32, 48}, height = 3, "
#define TAIL "\nfx.output = march { density = flow.density }.color\nreturn fx\n"

static void refused(const char *text, const char *message) {
    helper_refuses(HEAD, text, TAIL, message);
}

static effect *load(const char *text, const effect_setting *settings, size_t count) {
    return helper_accepts(HEAD, text, TAIL, settings, count);
}

static void mistakes_are_named(void **state) {
    (void)state;
    refused("local flow = slices(3)", "slices takes named values");
    refused("local flow = slices { size = {32, 8} }",
            "slices: 'size' has 8; whole numbers from 16");
    refused("local flow = slices { size = {1, 2, 3} }", "'size' must be the cells of a slice");
    refused("local flow = slices { size = 4096 }",
            "'size' has 4096; whole numbers from 16 to 2048");
    refused(FLOW "count = 0 }", "slices: 'count' is 0; 1 to 32");
    refused(FLOW "count = 2.5 }", "'count' is 2.5; a whole number");
    refused(FLOW "height = 0 }", "'height' is 0 m");
    refused(FLOW "axis = {0, 0, 0} }", "'axis' is {0, 0, 0}; a direction is accepted");
    refused(FLOW "time_step = 0 }", "'time_step' is 0 s");
    refused(FLOW "warm_up = -1 }", "'warm_up' is -1 s");
    refused(FLOW "viscosity = 1, reynolds = 100 }", "'reynolds' and 'viscosity' say the same");
    refused(FLOW "vortcity = 1 }", "slices: unknown key 'vortcity'; did you mean 'vorticity'?");
    refused(FLOW "ofset = position }", "slices: unknown key 'ofset'; did you mean 'offset'?");
    refused(FLOW "offset = 'far' }", "slices: 'offset'");
    refused(FLOW "top = 'opne' }",
            "option 'top' cannot be 'opne'; accepted: closed, open, periodic");
    refused(FLOW "buoyancy = 1 }", "slices: unknown key 'buoyancy'; accepted: viscosity");
    refused(FLOW "}\nlocal a = flow.densty", "no field 'densty'; did you mean 'density'?");
    refused(FLOW "}\nlocal a = flow:slice(3)", "there is no slice 3; 1 to 2");
    refused(FLOW "}\nlocal a = flow.slice(1)", "slice takes a number, as in flow:slice(1)");
    refused(FLOW "}\nlocal a = flow:slice(1).spin", "no field 'spin'");
}

static void mistakes_of_parts_are_named(void **state) {
    (void)state;
    refused(FLOW "}\nflow.inflow { }", "inflow takes a table, as in flow:inflow {");
    refused(FLOW "}\nflow:inflow { density = 1 }", "field 'shape' is missing");
    refused(FLOW "}\nflow:inflow { shape = 1, densty = 1 }",
            "inflow: unknown key 'densty'; did you mean 'density'?");
    refused(FLOW "}\nflow:inflow { shape = 1, mode = 'ad' }", "option 'mode' cannot be 'ad'");
    refused(FLOW "}\nflow:inflow { shape = {1, 2} }", "'shape' takes 1 component");
    refused(FLOW "}\nflow:force { shape = 1 }", "field 'force' is missing");
    refused(FLOW "}\nflow:obstacle { }", "nothing stands there; give it shape");
    refused(FLOW "}\nflow:obstacle { image = 'rock.png' }", "'image' takes a picture");
    refused(FLOW "}\nflow:obstacle { shpe = 1 }", "unknown key 'shpe'; did you mean 'shape'?");
    refused(FLOW "}\nflow:obstacle { image = image 'none.png' }", "none.png");
    refused(FLOW "}\nlocal d = disc { 0.5, 0.5, radus = 1 }",
            "disc: unknown key 'radus'; did you mean 'radius'?");
}

static void a_graph_that_cannot_be_is_refused(void **state) {
    (void)state;
    effect *e = load(FLOW "top = 'periodic' }", NULL, 0);
    assert_false(effect_check(e));
    if (!strstr(err_get(), "periodic")) fail_msg("%s", err_get());
    effect_destroy(e);
    e = load(FLOW "}\nflow:inflow { shape = flow.dye, density = 1 }", NULL, 0);
    assert_false(effect_check(e));
    if (!strstr(err_get(), "cycle: slices.step -> slices.step")) fail_msg("%s", err_get());
    effect_destroy(e);
}

static void all_of_it_can_be_set_by_name(void **state) {
    (void)state;
    const effect_setting settings[] = {{"slices.viscosity", "0.5", NULL},
                                       {"slices.top", "closed", NULL},
                                       {"slices_inflow.rate", "3", NULL},
                                       {"slices.seed", "9", NULL}};
    effect *e = load(FLOW "sides = 'open', viscosity = 2 }\n"
                          "flow:inflow { shape = disc { 0.5, 0.1 }, density = 1, rate = 7 }\n"
                          "flow:force { force = {1, curve { {0, 1}, {1, 0} }} }\n"
                          "flow:obstacle { shape = disc { radius = 0.1 }, velocity = {1, 0} }",
                     settings, 4);
    if (!effect_check(e)) fail_msg("%s", err_get());
    helper_is_set(e, "slices.viscosity", "0.5");
    helper_is_set(e, "slices.top", "closed");
    helper_is_set(e, "slices.sides", "open");
    helper_is_set(e, "slices_inflow.rate", "3");
    helper_is_set(e, "slices.seed", "9");
    effect_destroy(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(mistakes_of_parts_are_named),
        cmocka_unit_test(a_graph_that_cannot_be_is_refused),
        cmocka_unit_test(all_of_it_can_be_set_by_name),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
