// The module of rules by which fire spreads (scripts/lib/spread.lua), with lists of places.
#include "script_helper.h"

#include "script/reference.h"
#include <math.h>

#define HEAD "local fx = effect { fps = 10, frames = 400 } local spread = require 'spread' "
#define END " fx.output = geometry { }"
// A square of 21 x 21 things, 2 m apart; its middle, the 221st, at the origin, is lit at first.
#define SQUARE                                                                                     \
    "local list = {} for x = -20, 20, 2 do for y = -20, 20, 2 do list[#list + 1] = {x, y} end "    \
    "end local function light(t) t.fx, t.at = fx, t.at or list; local fire = spread(t) "           \
    "local lit, burned = 0, 0 "                                                                    \
    "fx:on_start(function() lit, burned = 0, 0; fire:ignite(221) end) "                            \
    "fire:on_ignite(function(i, t) assert(fire:state(i) == 'burning'); lit = lit + 1 end) "        \
    "fire:on_burned(function(i, t) assert(fire:state(i) == 'burned'); burned = burned + 1 end) "   \
    "fx:on_frame(function() local at = {0, 0, 0} "                                                 \
    "fx:status('lit', lit) fx:status('burned', burned) fx:status('burning', fire.burning) "        \
    "local high, low, sum = -1, 1, 0 for i, p in ipairs(list) do "                                 \
    "if fire:state(i) ~= 'normal' then "                                                           \
    "high, low, sum = math.max(high, p[1]), math.min(low, p[1]), sum + i * i % 1009 end end "      \
    "fx:status('high', high) fx:status('low', low) fx:status('sum', sum) "                         \
    "fx:status('sum of burned', fire.burned) end) return fire end "

static effect *load(const char *text) {
    effect *e = helper_accepts(HEAD SQUARE, text, END, NULL, 0);
    if (!effect_check_settings(e) || !effect_check(e)) fail_msg("%s\n  in: %s", err_get(), text);
    return e;
}

static void it_is_the_same_every_time(void **state) {
    (void)state;
    effect *e = load("light { reach = 3, speed = 2, burn = {2, 4}, seed = 7 }");
    effect *other = load("light { reach = 3, speed = 2, burn = {2, 4}, seed = 8 }");
    helper_run(e, 31);
    double lit = helper_status(e, "lit"), sum = helper_status(e, "sum");
    assert_true(lit > 20 && lit < 441);
    for (double frame = 40; frame < 60; frame++) helper_run(e, frame);
    for (double frame = 1; frame <= 31; frame++) helper_run(e, frame);
    assert_true(helper_status(e, "lit") == lit && helper_status(e, "sum") == sum);
    helper_run(other, 31);
    assert_true(helper_status(other, "sum") != sum);
    effect_destroy(e);
    effect_destroy(other);
}

static void every_change_is_an_event(void **state) {
    (void)state;
    effect *e = load("light { reach = 3, speed = 2, burn = {2, 4} }");
    const double frames[] = {1, 12, 40, 90, 400};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        helper_run(e, frames[i]);
        assert_true(helper_status(e, "lit") - helper_status(e, "burned") ==
                    helper_status(e, "burning"));
        assert_true(helper_status(e, "burned") == helper_status(e, "sum of burned"));
    }
    assert_true(helper_status(e, "lit") == 441 &&
                helper_status(e, "burned") == 441); // all of them, in the end
    effect_destroy(e);
}

static void it_stops_at_a_gap(void **state) {
    (void)state;
    static const char text[] =
        "local kept = {} for i, p in ipairs(list) do "
        "if math.abs(p[1] - 8) > 1 then kept[#kept + 1] = p end end list = kept "
        "local fire = light { reach = %g, speed = 2, burn = 3, variation = 0 } "
        "fx:on_start(function() fire:ignite_near({0, 0, 0}, 1) end)";
    char narrow[1024], wide[1024];
    snprintf(narrow, sizeof narrow, text, 3.9); // the gap is 4 m wide
    snprintf(wide, sizeof wide, text, 4.1);
    effect *e = load(narrow);
    helper_run(e, 400);
    assert_true(helper_status(e, "burning") == 0 && helper_status(e, "lit") == 14 * 21);
    assert_true(helper_status(e, "high") == 6 && helper_status(e, "low") == -20);
    effect_destroy(e);
    e = load(wide);
    helper_run(e, 400);
    assert_true(helper_status(e, "lit") == 20 * 21);
    effect_destroy(e);
}

static void wind_drives_it(void **state) {
    (void)state;
    effect *calm = load("light { reach = 3, burn = 8, variation = 0 }");
    effect *windy =
        load("light { reach = 3, burn = 8, variation = 0, wind = {2, 0, 0}, lean = 0 }");
    effect *strong = load("light { reach = 3, burn = 8, variation = 0, wind = function() return "
                          "{5, 0, 0} end, lean = 0 }");
    helper_run(calm, 71);
    helper_run(windy, 71);
    helper_run(strong, 71);
    assert_true(helper_status(calm, "high") == 6 &&
                helper_status(calm, "low") == -6); // 1 m/s for 7 s
    assert_true(helper_status(windy, "high") > helper_status(calm, "high"));
    assert_true(helper_status(windy, "low") > helper_status(calm, "low"));
    assert_true(helper_status(strong, "high") > helper_status(windy, "high"));
    helper_run(calm, 300);
    helper_run(strong, 300);
    assert_true(helper_status(calm, "low") == -20);
    assert_true(helper_status(strong, "low") >
                -20); // it burns out before it gets on against the wind
    effect_destroy(calm);
    effect_destroy(windy);
    effect_destroy(strong);
}

static void fuel_says_what_burns_and_how_long(void **state) {
    (void)state;
    effect *e = load("light { reach = 3, speed = 2, burn = 3, fuel = function(i) "
                     "return list[i][1] == 4 and 0 or 1 end }");
    helper_run(e, 400);
    assert_true(helper_status(e, "high") == 2 && helper_status(e, "lit") == 12 * 21);
    effect_destroy(e);
}

// Instances know their neighbours themselves; the fire is the same as among places of a list.
static void instances_burn_as_places_do(void **state) {
    (void)state;
    helper_put("tree.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    effect *places = load("light { reach = 3, speed = 2, burn = {2, 4}, seed = 7 }");
    effect *trees =
        load("local forest = instances { mesh { 'tree.obj' }, at = (function() local all "
             "= {} for i, p in ipairs(list) do all[i] = {p[1], p[2], 0} end return all "
             "end)() } light { at = forest, reach = 3, speed = 2, burn = {2, 4}, seed = 7 }");
    helper_run(places, 31);
    helper_run(trees, 31);
    assert_true(helper_status(places, "lit") == helper_status(trees, "lit"));
    assert_true(helper_status(places, "sum") == helper_status(trees, "sum"));
    effect_destroy(places);
    effect_destroy(trees);
}

// A row of barrels, each of which passes it on when it bursts, a second after it was lit.
static void what_is_passed_on_at_the_end_goes_in_steps(void **state) {
    (void)state;
    effect *e =
        load("list = { {0, 0}, {1, 0}, {2, 0}, {3, 0} } "
             "local fire = spread { fx = fx, at = list, reach = 1.5, speed = 1000, burn = 1, "
             "variation = 0, pass = 'burned' } local late = 0 "
             "fx:on_start(function() late = 0; fire:ignite(1) end) "
             "fire:on_late(function(i, t) late = late + 1 fx:status('late', late) end) "
             "fx:on_frame(function() fx:status('burned', fire.burned) "
             "fx:status('burning', fire.burning) fx:status('first', fire:progress(1)) end)");
    helper_run(e, 6);
    assert_true(helper_status(e, "burning") == 1 && fabs(helper_status(e, "first") - 0.5) < 1e-9);
    helper_run(e, 17);
    assert_true(helper_status(e, "burned") == 1 && helper_status(e, "burning") == 1 &&
                helper_status(e, "late") == 2);
    helper_run(e, 60);
    assert_true(helper_status(e, "burned") == 4 && helper_status(e, "late") == 4);
    effect_destroy(e);
}

static void what_is_put_out_lights_nothing_any_more(void **state) {
    (void)state;
    effect *e = load("list = { {0, 0}, {1, 0}, {2, 0} } local fire = spread { fx = fx, at = list, "
                     "reach = 1.5, speed = 1, burn = 10, variation = 0 } "
                     "fx:on_start(function() fire:ignite(1) end) fx:on_frame(function(t) "
                     "if t >= 1.5 then fire:put_out(2) end fx:status('burned', fire.burned) "
                     "fx:status('burning', fire.burning) fx:status('second', fire:progress(2)) "
                     "end)");
    helper_run(e, 13);
    assert_true(helper_status(e, "burning") == 2 && helper_status(e, "burned") == 0);
    helper_run(e, 60);
    assert_true(helper_status(e, "burning") == 1 && helper_status(e, "burned") == 1 &&
                helper_status(e, "second") == 1);
    effect_destroy(e);
}

static void a_frame_makes_so_many_changes_at_most(void **state) {
    (void)state;
    effect *e = load("light { reach = 60, speed = 1000, burn = 30, most = 10 }");
    helper_run(e, 2);
    assert_true(helper_status(e, "lit") == 11); // and the first, by hand
    helper_run(e, 3);
    assert_true(helper_status(e, "lit") == 21);
    effect_destroy(e);
}

static void what_is_wrong_is_said(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } wrong[] = {
        {"spread { at = { {0, 0} } }", "spread: 'fx' is missing"},
        {"spread { fx = fx }", "spread: 'at' is missing"},
        {"spread { fx = fx, at = { 3 } }", "'at' has no place as number 1"},
        {"spread { fx = fx, at = {} }", "'at' is empty"},
        {"spread { fx = fx, at = { {0, 0} }, rech = 2 }", "unknown key 'rech'"},
        {"spread { fx = fx, at = { {0, 0} }, reach = 0 }", "'reach' takes a number"},
        {"spread { fx = fx, at = { {0, 0} }, burn = {3, 2} }", "'burn' takes s"},
        {"spread { fx = fx, at = { {0, 0} }, pass = 'x' }", "'pass' takes"},
        {"spread { fx = fx, at = 3 }",
         "'at' takes instances { } or a list of {x, y, z}; got a number"},
        {"spread { fx = 3, at = { {0, 0} } }", "'fx' takes the effect"},
        {"spread { fx = fx, at = { {0, 0/0} } }", "'at' has no place as number 1"},
        {"spread { fx = fx, at = { {0, 0} } }:ignite(1)", "nothing burns while the file loads"},
        {"spread { fx = fx, at = { {0, 0} } }:on_ignite(3)", "is a function(i, t); got a number"},
        {"spread { fx = position, at = { {0, 0} } }", "'fx' takes the effect"},
        {"spread { fx = fx, at = fx }", "list of {x, y, z}; got an effect"},
        {"spread { fx = fx, at = { {0, 0} }, fuel = 'x' }", "'fuel' takes a number, a list or"},
        {"spread { fx = fx, at = { {0, 0, 'x'} } }", "'at' has no place as number 1"},
        {"spread { fx = fx, at = { {0, 1/0} } }", "'at' has no place as number 1"},
        {"spread { fx = fx, at = { {0, 0} }, reach = 1/0 }", "'reach' takes a number"},
        {"spread { fx = fx, at = { {0, 0} } }:ignte(1)",
         "e.lua:1: spread: unknown name 'ignte'; known are ignite, ignite_near, on_burned"},
        {"spread { fx = fx, at = { {0, 0} } }.ignite(1)", "with a colon, as in fire:ignite(1)"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        helper_refuses(HEAD, wrong[i].text, END, wrong[i].message);
}

static void stops(const char *text, const char *message) {
    effect *e = load(text);
    assert_false(effect_rehearse(e, 3));
    if (!strstr(err_get(), message)) fail_msg("\"%s\" is not in: %s", message, err_get());
    effect_destroy(e);
}

#define FRAME(call) "local fire = light { } fx:on_frame(function() " call " end)"

static void mistakes_of_a_frame_are_named(void **state) {
    (void)state;
    stops(FRAME("fire:ignite(442)"), "e.lua:1: spread: there is no number 442; 1 to 441 are there");
    stops(FRAME("fire:ignite()"), "there is no number nil");
    stops(FRAME("fire:put_out('a')"), "there is no number a");
    stops(FRAME("fire:progress(0)"), "there is no number 0");
    stops(FRAME("fire:ignite_near(5, 3)"), "ignite_near takes a place and a radius");
    stops(FRAME("fire:ignite_near({0, 0})"), "ignite_near takes a place and a radius");
    stops(FRAME("fx:status('burnt', fire.burnt)"), "unknown name 'burnt'");
    stops("light { wind = {1} }", "'wind' is no wind; accepted: {x, y, z} m/s");
    stops("light { wind = function() end }", "'wind' is no wind");
}

static void the_reference_has_its_keys(void **state) {
    (void)state;
    helper_refuses(HEAD, "spread { fx = fx, at = { {0, 0} }, x = 1 }", END, "unknown key 'x'");
    const value_desc *keys = script_object_find("spread")->keys;
    size_t count = 0;
    for (const char *at = strstr(err_get(), "known are "); (at = strchr(at, ',')); at++) count++;
    for (size_t i = 0; keys[i].name; i++)
        if (!strstr(err_get(), keys[i].name)) fail_msg("the module knows no '%s'", keys[i].name);
    for (; count > 0 && keys->name; keys++) count--;
    assert_true(count == 0 && keys->name && !keys[1].name); // as many
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_same_every_time),
        cmocka_unit_test(every_change_is_an_event),
        cmocka_unit_test(it_stops_at_a_gap),
        cmocka_unit_test(wind_drives_it),
        cmocka_unit_test(fuel_says_what_burns_and_how_long),
        cmocka_unit_test(instances_burn_as_places_do),
        cmocka_unit_test(what_is_passed_on_at_the_end_goes_in_steps),
        cmocka_unit_test(what_is_put_out_lights_nothing_any_more),
        cmocka_unit_test(a_frame_makes_so_many_changes_at_most),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(mistakes_of_a_frame_are_named),
        cmocka_unit_test(the_reference_has_its_keys),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
