// explosions { }, shell { } and layers { } in an effect file: what they take and give, what is said
// after a mistake, and that what came while the effect ran is forgotten when time goes back.
#include "base/memory.h"
#include "script_helper.h"

#include <math.h>

#define HEAD "local fx = effect { name = 'burst', fps = 10, frames = 50 }\n"
#define TAIL "\nfx.output = ball.image\nreturn fx\n"

static void refused(const char *text, const char *message) {
    helper_refuses(HEAD, text, TAIL, message);
}

static void mistakes_are_named(void **state) {
    (void)state;
    refused("local ball = shell(3)", "shell takes named values");
    refused("local ball = shell { at = {1} }", "'at' takes explosions { }");
    refused("local ball = shell { radus = 1 }", "unknown key 'radus'; did you mean 'radius'?");
    refused("local ball = shell { mode = 'ray' }", "option 'mode' cannot be 'ray'");
    refused("local ball = shell { life = 0 }", "uniform 'life' is 0; accepted: 0.001 to");
    refused("explosions(3)", "explosions takes a list");
    refused("explosions { seed = 3 }", "explosions takes a list");
    refused("explosions { {1}, 2 }", "number 2 is a number; a table is accepted");
    refused("explosions { {1, sise = 2} }", "unknown key 'sise'; did you mean 'size'?");
    refused("explosions { {1, size = -1} }", "number 1: 'size' is -1; accepted: 0 to");
    refused("explosions { {0/0} }", "'time' is");
    refused("explosions { {'1'} }", "number 1: its time is a string; a number of seconds");
    refused("local l = {} for i = 1, 1025 do l[i] = {i} end explosions(l)", "at most 1024");
    refused("explosions { {1} }:add { size = 2 }", "adds one while the effect runs");
    refused("explosions { {1} }:ad { size = 2 }", "unknown method 'ad'; did you mean 'add'?");
    refused("explosions { {1} }.add { size = 2 }", "with a colon");
    refused("explosions { {1} }:latest(1, 65)", "number 65; accepted: 1 to 64");
}

static void blasts_name_mistakes(void **state) {
    (void)state;
    refused("blast(3)", "blast takes position, time and charge");
    refused("blast { chrge = 1 }", "'chrge' is none of them");
    refused("blast { 3 }", "a value has no name");
    refused("blast { time = 'now' }", "'time' is seconds");
    refused("local p = blast { }.presure",
            "no field 'presure'; it has pressure, velocity, impulse and arrival");
    refused("local p = blast { charge = -1 }.pressure", "charge");
    refused("local p = blast { position = 'here' }.velocity", "position");
    refused("blast_pressure { chrge = 1 }", "did you mean 'charge'?");
}

// What a script can ask of a field that varies in space: a place.
static void a_blast_is_asked_at_a_place(void **state) {
    (void)state;
    effect *e =
        helper_load("local fx = effect { }\n"
                    "local burst = blast { position = {1, 0, 0}, time = -0.012, charge = 8 }\n"
                    "local push = burst.impulse:get { 3, 0, 0 }\n"
                    "assert(math.abs(push / 234.4 - 1) < 0.001, push)\n"
                    "local v = burst.velocity:get { 1, 7, 0 }\n"
                    "assert(#v == 3 and v[1] == 0 and v[2] > 10 and v[3] == 0, v[2])\n"
                    "assert(burst.pressure:get { 21, 0, 0 } == 0)\n"
                    "local late = burst.arrival:get { 21, 0, 0 }\n"
                    "assert(late > 0.03 and late < 0.036, late)\n"
                    "fx.output = final { geometry { } }.color\n"
                    "return fx\n");
    if (!e) fail_msg("%s", err_get());
    effect_destroy(e);
    refused("local p = blast { }.impulse:get()", "say where, as in get { 0, 0, 1 }");
    refused("local p = blast { }.impulse:get { 1, 2 }", "the place is three numbers");
    refused("local p = blast { }.impulse:get { 1, 2, 0 / 0 }", "the place is three numbers");
}

static void layers_name_mistakes(void **state) {
    (void)state;
    refused("layers(3)", "layers takes 1 to 64 pairs");
    refused("layers { }", "got 0 of them");
    refused("layers { {1} }", "number 1 is none");
    refused("layers { {2, 1}, {3, 'x'} }", "number 2 is none");
    refused("layers { {2, 1}, dimensions = 4 }", "'dimensions' is 2 or 3");
    refused("layers { {2, 1}, noise = 'worley' }", "'noise' is perlin, simplex, value or worley");
    refused("layers { {2, 1}, sed = 4 }", "sed");
}

static void a_list_tells_what_it_holds(void **state) {
    (void)state;
    effect *e = helper_accepts(
        HEAD,
        "local all = explosions { {1, size = 2, seed = 9}, {3, position = {1, 2, 3}, life = 4} }\n"
        "assert(#all == 2 and all:get(3) == nil and all:get(0) == nil)\n"
        "local one, two = all:get(1), all:get(2)\n"
        "assert(one.time == 1 and one.size == 2 and one.seed == 9 and one.life == 1)\n"
        "assert(two.position[3] == 3 and two.life == 4 and two.seed == 2)\n"
        "assert(#one.shift == 3 and one.shift[1] ~= two.shift[1] and one.random < 1)\n"
        "assert(all:latest(0.9) == nil and all:latest(1).time == 1 and all:latest(1, 2) == nil)\n"
        "assert(all:latest(9).time == 3 and all:latest(9, 2).time == 1)\n"
        "local ball = shell { at = all }",
        TAIL, NULL, 0);
    if (!effect_check(e)) fail_msg("%s", err_get());
    effect_destroy(e);
}

static void what_came_is_forgotten_when_time_goes_back(void **state) {
    (void)state;
    effect *e = helper_accepts(HEAD,
                               "local all = explosions { {9} }\n"
                               "fx:on_key('f', function() all:add { size = 3 } end)\n"
                               "fx:on_frame(function(t)\n"
                               "  fx:status('count', #all)\n"
                               "  fx:status('last', all:get(#all).time)\n"
                               "  fx:status('size', all:get(#all).size)\n"
                               "end)\n"
                               "fx.events = { {1, key = 'f'}, {2, key = 'f'} }\n"
                               "fx.output = geometry { }",
                               "", NULL, 0);
    if (!effect_check_settings(e) || !effect_check(e)) fail_msg("%s", err_get());
    static const struct {
        double frame, count, last, size;
    } draws[] = {{5, 1, 9, 1}, {15, 2, 1, 3}, {30, 3, 2, 3}, {3, 1, 9, 1}, {15, 2, 1, 3}};
    for (size_t i = 0; i < COUNT_OF(draws); i++) {
        helper_run(e, draws[i].frame);
        assert_true(helper_status(e, "count") == draws[i].count);
        assert_true(helper_status(e, "last") == draws[i].last);
        assert_true(helper_status(e, "size") == draws[i].size);
    }
    effect_destroy(e);
}

// The field that the only shell was given.
static const field *displacement_of(effect *e) {
    size_t index;
    const pass *shell = effect_get_pass(e, 0);
    assert_true(pass_is(shell, "shell"));
    assert_int_equal(pass_find_key(shell, "displacement", &index), PASS_FIELD);
    return pass_get_field(shell, index);
}

static float value_at(const field *node, float x, float y, float z) {
    const field_context context = {.time = 0};
    float out[4];
    if (!field_eval(node, &context, (float3){x, y, z}, out)) fail_msg("%s", err_get());
    return out[0];
}

static effect *load_displacement(const char *expression) {
    char text[512];
    snprintf(text, sizeof text, "local ball = shell { displacement = %s }", expression);
    return helper_accepts(HEAD, text, TAIL, NULL, 0);
}

// (3 a + b) / 4 of noises a and b, each by itself.
static void layers_are_the_sum_of_their_noises(void **state) {
    (void)state;
    static const char *const texts[] = {
        "layers { {2, 3}, {7, 1}, seed = 5 }",
        "perlin { frequency = 2, octaves = 1, seed = 5 }",
        "perlin { frequency = 7, octaves = 1, seed = 22 }",
    };
    effect *effects[3];
    const field *fields[3];
    for (int i = 0; i < 3; i++) {
        effects[i] = load_displacement(texts[i]);
        fields[i] = displacement_of(effects[i]);
    }
    float least = 1, most = 0;
    for (int i = 0; i < 300; i++) {
        float x = sinf((float)i), y = cosf(1.7f * (float)i), z = sinf(2.3f * (float)i + 1);
        float sum = value_at(fields[0], x, y, z);
        float a = value_at(fields[1], x, y, z), b = value_at(fields[2], x, y, z);
        assert_true(fabsf(sum - (3 * a + b) / 4) < 1e-5f);
        least = fminf(least, sum);
        most = fmaxf(most, sum);
    }
    assert_true(least >= 0 && most <= 1 && most - least > 0.4f);
    for (int i = 0; i < 3; i++) effect_destroy(effects[i]);
}

// The same at any distance, closed behind, and the same all along a pole.
static void flat_layers_wrap_the_origin(void **state) {
    (void)state;
    effect *e = load_displacement("layers { {4.4, 1}, {9, 0.5}, dimensions = 2 }");
    const field *node = displacement_of(e);
    float least = 1, most = 0;
    for (int i = 0; i < 100; i++) {
        float angle = 0.0628f * (float)i, z = sinf((float)i);
        float near = value_at(node, cosf(angle), sinf(angle), z);
        assert_true(fabsf(near - value_at(node, 3 * cosf(angle), 3 * sinf(angle), 3 * z)) < 1e-3f);
        least = fminf(least, near);
        most = fmaxf(most, near);
        assert_true(fabsf(value_at(node, -1, 1e-4f, z) - value_at(node, -1, -1e-4f, z)) < 5e-3f);
    }
    assert_true(most - least > 0.2f);
    effect_destroy(e);
}

static void the_explosion_compiles_in_every_form(void **state) {
    (void)state;
    static const effect_setting settings[] = {
        {"form", "mesh", NULL}, {"form", "volume", NULL}, {"noise", "worley", NULL}};
    char file[PATH_CAP], scripts[PATH_CAP];
    helper_source(file, "effects/layered_explosion.lua");
    helper_source(scripts, "scripts");
    for (size_t i = 0; i < COUNT_OF(settings); i++) {
        effect *e = helper_create(file, &settings[i], 1);
        if (!script_load_limited(e, scripts, NULL) || !effect_check_settings(e) || !effect_check(e))
            fail_msg("%s=%s: %s", settings[i].name, settings[i].text, err_get());
        effect_destroy(e);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(blasts_name_mistakes),
        cmocka_unit_test(a_blast_is_asked_at_a_place),
        cmocka_unit_test(layers_name_mistakes),
        cmocka_unit_test(a_list_tells_what_it_holds),
        cmocka_unit_test(what_came_is_forgotten_when_time_goes_back),
        cmocka_unit_test(layers_are_the_sum_of_their_noises),
        cmocka_unit_test(flat_layers_wrap_the_origin),
        cmocka_unit_test(the_explosion_compiles_in_every_form),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
