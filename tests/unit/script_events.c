// What a script does from frame to frame: when its functions run, what they are told, and that a
// frame follows from the events before it alone.
#include "script_helper.h"

#include "effect/events.h"
#include <math.h>

#define HEAD "local fx = effect { fps = 10, frames = 40 } "

#define SCENE                                                                                      \
    " fx.camera = camera { eye = {0, -10, 10}, target = {0, 0, 0}, fov = 60 }"                     \
    " fx.output = geometry { }"

static effect *load_with(const char *text, const char *events) {
    effect_setting setting = {.name = "effect.events", .text = events};
    effect *e = helper_accepts(HEAD, text, SCENE, &setting, events ? 1 : 0);
    if (!effect_check_settings(e) || !effect_check(e)) fail_msg("%s\n  in: %s", err_get(), text);
    return e;
}

static effect *load(const char *text) {
    return load_with(text, NULL);
}

static void is(const effect *e, const char *name, double wanted) {
    if (fabs(helper_status(e, name) - wanted) > 1e-4)
        fail_msg("%s is %g, not %g", name, helper_status(e, name), wanted);
}

// ---- frames -----------------------------------------------------------------------------------

#define COUNTING                                                                                   \
    "local n, starts, sum = 0, 0, 0 "                                                              \
    "fx:on_start(function() n, sum = 0, 0; starts = starts + 1; fx:status('starts', starts) end) " \
    "fx:on_frame(function(t, dt) n = n + 1; sum = sum + dt; fx:status('t', t) end) "               \
    "fx:on_frame(function(t) fx:status('n', n); fx:status('sum', sum) end)"

static void each_frame_runs_once_whichever_are_drawn(void **state) {
    (void)state;
    effect *e = load(COUNTING);
    helper_run(e, 1);
    is(e, "n", 1);
    is(e, "t", 0);
    is(e, "sum", 0);
    helper_run(e, 11);
    is(e, "n", 11);
    is(e, "t", 1);
    is(e, "sum", 1);
    helper_run(e, 11);
    helper_run(e, 11.7); // between two: as of the one before
    is(e, "n", 11);
    helper_run(e, 14);
    is(e, "n", 14);
    is(e, "starts", 1);
    effect_destroy(e);
}

static void back_in_time_is_from_the_beginning(void **state) {
    (void)state;
    effect *e = load(COUNTING);
    helper_run(e, 20);
    helper_run(e, 6);
    is(e, "n", 6);
    is(e, "t", 0.5);
    is(e, "starts", 2);
    effect_restart(e);
    helper_run(e, 6);
    is(e, "n", 6);
    is(e, "starts", 3);
    effect_destroy(e);
}

static void chance_is_the_same_again(void **state) {
    (void)state;
    effect *e = load("local x fx:on_start(function() x = 0 end) "
                     "fx:on_frame(function() x = x + math.random(); fx:status('x', x) end)");
    helper_run(e, 9);
    double first = helper_status(e, "x");
    helper_run(e, 30);
    assert_true(helper_status(e, "x") != first);
    helper_run(e, 9);
    assert_true(helper_status(e, "x") == first);
    effect_destroy(e);
}

// ---- events -----------------------------------------------------------------------------------

#define HEARING                                                                                    \
    "local log = {} "                                                                              \
    "fx:on_start(function() log = {} end) "                                                        \
    "fx:on_frame(function(t) fx:status('t', t) end) "                                              \
    "fx:on_key('f', function(event) log[#log + 1] = event; fx:status('keys', #log); "              \
    "  fx:status('key time', event.time); fx:status('placed', event.hit ~= nil) end, 'counts') "   \
    "fx:on_click(function(event) fx:status('x', event.x) fx:status('y', event.y) "                 \
    "  local p = event.hit.position; fx:status('hit x', p[1]) fx:status('hit y', p[2]) "           \
    "  fx:status('hit z', p[3]) fx:status('distance', event.hit.distance) "                        \
    "  fx:status('same', pick(event.ray).distance) fx:status('again', pick(event.x, event.y)."     \
    "distance) end) "

static void events_come_at_their_frame(void **state) {
    (void)state;
    effect *e = load_with(HEARING, "1 key f; 0.42 key f; 2 key f 0.5 0.5");
    helper_run(e, 5); // 0.4 s
    const effect_status *all;
    assert_int_equal(effect_statuses(e, &all), 1);
    helper_run(e, 6);
    is(e, "keys", 1);
    is(e, "key time", 0.42);
    is(e, "t", 0.5);
    is(e, "placed", 0);
    helper_run(e, 40);
    is(e, "keys", 3);
    is(e, "placed", 1);
    helper_run(e, 8);
    is(e, "keys", 1);
    const effect_hearing *heard;
    assert_int_equal(effect_hearings(e, &heard), 2);
    assert_string_equal(heard[0].key, "f");
    assert_string_equal(heard[0].help, "counts");
    assert_string_equal(heard[1].key, "");
    effect_destroy(e);
}

// The camera looks down at 45 degrees from 10 m: the middle of the picture is the origin.
static void clicks_meet_the_ground(void **state) {
    (void)state;
    effect *e = load_with(HEARING, "0 click 0.5 0.5");
    helper_run(e, 1);
    is(e, "hit x", 0);
    is(e, "hit y", 0);
    is(e, "hit z", 0);
    is(e, "distance", sqrt(200));
    is(e, "same", sqrt(200));
    is(e, "again", sqrt(200));
    effect_destroy(e);
    e = load_with(HEARING, "0 click 3 -2 0"); // over a point
    helper_run(e, 1);
    is(e, "hit x", 3);
    is(e, "hit y", -2);
    assert_true(helper_status(e, "x") > 0.5 && helper_status(e, "y") > 0.5);
    effect_destroy(e);
    e = load_with(HEARING, "0 click 5 5 8 0 0 -2"); // along a ray
    helper_run(e, 1);
    is(e, "hit x", 5);
    is(e, "hit y", 5);
    is(e, "distance", 8);
    effect_destroy(e);
}

static void the_scripts_own_events_are_a_control(void **state) {
    (void)state;
    effect *e = load(HEARING "fx.events = { { 2, key = 'f', at = {0.25, 0.5} }, "
                             "{ 1, click = {1, 2, 0} } }");
    helper_is_set(e, "effect.events", "1 click 1 2 0; 2 key f 0.25 0.5");
    helper_run(e, 40);
    is(e, "keys", 1);
    assert_true(effect_set(e, "effect.events", "1 key f; 1.5 key f"));
    helper_run(e, 40);
    is(e, "keys", 2);
    assert_true(effect_set(e, "effect.events", ""));
    helper_is_set(e, "effect.events", "");
    assert_true(effect_reset(e, "effect.events"));
    helper_is_set(e, "effect.events", "1 click 1 2 0; 2 key f 0.25 0.5");
    helper_run(e, 40);
    is(e, "keys", 1);
    assert_false(effect_set(e, "effect.events", "1 key g"));
    assert_string_equal(err_get(),
                        "effect.events: the effect handles no key g; it handles: key f, click");
    effect_destroy(e);
}

// What a hand adds at the time that is shown needs nothing run again; what is before it does.
static void an_event_of_now_happens_at_once(void **state) {
    (void)state;
    effect *e = load_with(COUNTING HEARING, "0.2 key f");
    helper_run(e, 11);
    is(e, "keys", 1);
    assert_true(effect_set(e, "effect.events", "0.2 key f; 1 key f"));
    helper_run(e, 11);
    is(e, "keys", 2);
    assert_true(effect_set(e, "effect.events", "0.2 key f; 1 key f; 3 key f"));
    helper_run(e, 12);
    is(e, "keys", 2);
    is(e, "starts", 1);
    assert_true(effect_set(e, "effect.events", "0.2 key f; 0.5 key f; 1 key f; 3 key f"));
    helper_run(e, 12);
    is(e, "keys", 3);
    is(e, "starts", 2);
    effect_destroy(e);
}

// Crates of 2 m at x = -4, 0 and 4; the camera looks down at the middle one.
static void clicks_meet_instances_which_go_back_with_time(void **state) {
    (void)state;
    helper_put("crate.obj", "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
                            "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                            "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    effect *e =
        load_with("local crates = instances { mesh { 'crate.obj' }, at = { {-4, 0, 0}, {0, 0, 0}, "
                  "{4, 0, 0} } } fx:on_click(function(event) local h = event.hit "
                  "fx:status('index', h.index) fx:status('own', h.instances == crates) "
                  "fx:status('z', h.normal[3]) fx:status('mesh', h.mesh:find('crate.obj') ~= nil) "
                  "crates:set(h.index, { state = {7}, kind = 0 }) end) "
                  "fx:on_frame(function() local sum = 0 for i = 1, #crates do "
                  "sum = sum + i * crates:get(i).state[1] end fx:status('sum', sum) end) "
                  "local scene = geometry { crates } fx.output = scene.albedo ",
                  "1 click 0 0 1; 1 click 4 0 1; 2 click 0 0 1 0 0 -1");
    helper_run(e, 11);
    is(e, "index", 3);
    is(e, "own", 1);
    is(e, "mesh", 1);
    is(e, "z", 1);
    helper_run(e, 13);
    is(e, "sum", 2 * 7 + 3 * 7);
    assert_false(effect_rehearse(e, 21)); // what was hidden is met no more: the ground is no crate
    helper_run(e, 5);
    is(e, "sum", 0);
    effect_destroy(e);
}

// ---- parameters -------------------------------------------------------------------------------

static void parameters_go_back_with_time(void **state) {
    (void)state;
    effect *e = load_with("local wind = param { 'wind', 3 } local toon = param { 'toon', false } "
                          "local word = param { 'word', 'b', words = {'a', 'b'} } "
                          "fx:on_key('t', function() toon:toggle() word:toggle() wind:set(5) end) "
                          "fx:on_frame(function() fx:status('toon', toon:get()) "
                          "fx:status('a', word:get() == 'a') end)",
                          "1 key t");
    helper_run(e, 12);
    helper_is_set(e, "wind", "5");
    helper_is_set(e, "toon", "true");
    is(e, "a", 1);
    helper_run(e, 5);
    helper_is_set(e, "wind", "3");
    helper_is_set(e, "toon", "false");
    is(e, "a", 0);
    helper_run(e, 12);
    assert_true(effect_set(e, "wind", "7")); // by hand
    helper_run(e, 5);
    helper_is_set(e, "wind", "7");
    effect_destroy(e);
}

// ---- what is refused --------------------------------------------------------------------------

static void what_is_wrong_is_said(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } wrong[] = {
        {"fx:on_frame(3)", "fx:on_frame takes a function; got a number"},
        {"fx:on_key(function() end)", "takes the name of a key first"},
        {"fx:on_key('f')", "takes a function after the key"},
        {"fx:on_key('space', function() end)", "key 'space'; accepted: a letter as f"},
        {"fx:on_click(function() end, 3)", "says in a text what it does"},
        {"fx.events = 3", "'events' takes a list"},
        {"fx.events = { 3 }", "events[1] is no table"},
        {"fx.events = { { key = 'f' } }", "events[1] has no time"},
        {"fx.events = { { 1 } }", "events[1] is not one of click and key"},
        {"fx.events = { { 1, key = 'f', click = {1, 1} } }", "is not one of click and key"},
        {"fx.events = { { 1, key = 'f', ta = {0, 0} } }", "an event: unknown key 'ta'"},
        {"fx.events = { { 1, click = {0.5} } }", "events[1] is at no place"},
        {"fx.events = { { 1, click = {0.5, 'x'} } }", "is at what is no number"},
        {"fx.events = { { 1, click = {0.5, 2} } }", "accepted: 0 to 1"},
        {"fx.events = { { -1, key = 'f' } }", "an event is at -1 s"},
        {"fx.events = { { 0/0, key = 'f' } }", "accepted: 0 to 1e6"},
        {"fx.events = { { 1, click = {0, 0, 0, 0, 0, 0} } }", "has no direction"},
        {"pick(0.5, 0.5)", "nothing stands anywhere while the file loads"},
        {"fx.on_frame = 3", "'on_frame' is a method, which is called: fx:on_frame(...)"},
        {"fx:status('', 3)", "accepted: 1 to 48"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        helper_refuses(HEAD, wrong[i].text, SCENE, wrong[i].message);
    effect *e = helper_accepts(
        HEAD, "fx:on_key('f', function() end) fx.events = { { 1, key = 'g' } }", SCENE, NULL, 0);
    assert_false(effect_check_settings(e));
    assert_string_equal(err_get(), "effect.events: the effect handles no key g; it handles: key f");
    effect_destroy(e);
    static const char *const texts[] = {"x",
                                        "1",
                                        "1 f",
                                        "1 key",
                                        "1 key ff",
                                        "1 click",
                                        "1 click 0.5",
                                        "1 click 1 2 3 4",
                                        "1 click 0.5 0.5 x",
                                        "1 key f nan 0",
                                        "-1 key f"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        effect_event list[EFFECT_MOST_EVENTS];
        size_t count;
        if (events_parse(texts[i], list, &count)) fail_msg("accepted: %s", texts[i]);
    }
}

static void a_fault_is_reported_and_then_all_begins_anew(void **state) {
    (void)state;
    effect *e = load_with("local n fx:on_start(function() n = 0 end)\n"
                          "fx:on_key('f', function(event) event.hit.x = 1 end)\n"
                          "fx:on_frame(function() n = n + 1 fx:status('n', n) end)",
                          "1 key f");
    helper_run(e, 5);
    assert_false(effect_rehearse(e, 15));
    assert_non_null(strstr(err_get(), "e.lua:2:"));
    helper_run(e, 5);
    is(e, "n", 5);
    effect_destroy(e);
    script_limits limits = {.frame = 100000};
    e = helper_load_with(HEAD "fx:on_frame(function(t) while t > 0.5 do end end)" SCENE, &limits,
                         NULL, 0);
    assert_non_null(e);
    assert_true(effect_check_settings(e) && effect_check(e));
    helper_run(e, 4);
    assert_false(effect_rehearse(e, 9));
    effect_destroy(e);
    helper_put("flag.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    e = load("fx:on_frame(function() pick(0.5, 0.5) end) " // where it stands says what is picked
             "geometry { mesh { 'flag.obj', position = function() "
             "fx:status('picked', pcall(pick, 0.5, 0.5)) return {0, 0, 0} end } }");
    helper_run(e, 4);
    is(e, "picked", 0);
    effect_destroy(e);
    e = load(COUNTING);
    assert_false(effect_rehearse(e, 1e9));
    assert_non_null(strstr(err_get(), "at most 1000000"));
    effect_destroy(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_frame_runs_once_whichever_are_drawn),
        cmocka_unit_test(back_in_time_is_from_the_beginning),
        cmocka_unit_test(chance_is_the_same_again),
        cmocka_unit_test(events_come_at_their_frame),
        cmocka_unit_test(clicks_meet_the_ground),
        cmocka_unit_test(the_scripts_own_events_are_a_control),
        cmocka_unit_test(an_event_of_now_happens_at_once),
        cmocka_unit_test(clicks_meet_instances_which_go_back_with_time),
        cmocka_unit_test(parameters_go_back_with_time),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(a_fault_is_reported_and_then_all_begins_anew),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
