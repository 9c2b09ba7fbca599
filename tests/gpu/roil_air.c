// Simulated air through the public interface: what is drawn, and how often, does not change what is
// simulated; frames that were left out are caught up with; a reload goes on.
#include "roil_air_test.h"

// ---- time -------------------------------------------------------------------------------------

static void how_often_is_drawn_changes_nothing(void **state) {
    static const double rates[] = {10, 24, 60};
    picture pictures[3];
    for (int i = 0; i < 3; i++) {
        roil_effect *e = open(*state, rates[i], "", "");
        for (double frame = 1; frame <= 1 + 0.5 * rates[i]; frame++) draw(e, frame, pictures[i]);
        roil_unload(e);
    }
    assert_true(brightest(pictures[0]) > 100);
    is_same(pictures[0], pictures[1], 1);
    is_same(pictures[0], pictures[2], 1);
}

static const char UPDATE[] =
    "function fx.update(t, dt) strength:set(t > 0.2 and t < 0.3 and 5 or 1) end";

static void a_jump_is_as_good_as_every_frame(void **state) {
    picture each, jump;
    roil_effect *a = open(*state, 24, "", UPDATE), *b = open(*state, 24, "", UPDATE);
    for (int frame = 1; frame <= 13; frame++) draw(a, frame, each);
    draw(b, 13, jump);
    is_same(each, jump, 0);
    roil_unload(a);
    roil_unload(b);
}

static void a_jump_back_begins_anew(void **state) {
    picture first, again, anew;
    roil_effect *e = open(*state, 24, "", "");
    draw(e, 5, first);
    draw(e, 12, again);
    draw(e, 5, again);
    is_same(first, again, 0);
    roil_restart(e);
    draw(e, 5, anew);
    is_same(first, anew, 0);
    roil_unload(e);
}

static void air_is_warmed_up_before_the_first_frame(void **state) {
    picture cold, warm;
    roil_effect *a = open(*state, 24, "", ""), *b = open(*state, 24, "warm_up = 0.3", "");
    draw(a, 1, cold);
    draw(b, 1, warm);
    if (!(height_of(warm) < height_of(cold) - 0.5))
        fail_msg("rows %.2f and %.2f", height_of(warm), height_of(cold));
    roil_unload(a);
    roil_unload(b);
}

static void another_size_of_the_picture_changes_nothing(void **state) {
    picture each, resized;
    roil_effect *a = open(*state, 24, "", ""), *b = open(*state, 24, "", "");
    for (int frame = 1; frame <= 8; frame++) draw(a, frame, each);
    draw(b, 7, resized);
    double steps = readout(b, "steps");
    ok(roil_prepare(b, 3 * WIDE, 2 * HIGH));
    ok(roil_prepare(b, WIDE, HIGH));
    assert_true(readout(b, "steps") == steps);
    draw(b, 7, resized); // the same state
    draw(b, 8, resized);
    is_same(each, resized, 0);
    roil_unload(a);
    roil_unload(b);
}

// A window draws what there is, and comes to the same in the end.
static void a_window_catches_up_over_several_pictures(void **state) {
    picture whole, parts;
    roil_simulation s;
    roil_effect *a = open(*state, 24, "", UPDATE);
    draw(a, 30, whole);
    roil_unload(a);
    roil *window = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .never_waits = true});
    ok(window);
    roil_effect *b = open(window, 24, "warm_up = 3600", UPDATE);
    draw(b, 1, parts);
    assert_true(roil_get_simulation(b, &s) && s.waiting); // for 720000 steps
    roil_unload(b);
    b = open(window, 24, "", UPDATE);
    do {
        draw(b, 30, parts);
        assert_true(roil_get_simulation(b, &s));
    } while (s.waiting);
    is_same(whole, parts, 0);
    roil_unload(b);
    test_messages += roil_validation_messages(window);
    roil_destroy(window);
}

static bool count_steps(void *user, double done, double whole) {
    (void)done;
    if (whole > *(double *)user) *(double *)user = whole;
    return true;
}

static void draw_whole(roil_effect *e, double frame, picture out) {
    roil_simulation s;
    do {
        draw(e, frame, out);
        assert_true(roil_get_simulation(e, &s));
    } while (s.waiting);
}

// A window that has shown three seconds goes back to any frame of them by a second of steps.
static void a_window_goes_back_by_a_second_at_most(void **state) {
    enum { FPS = 10, SHOWN = 31, STEPS = 200 }; // of a second
    picture was[SHOWN + 1], again;
    double steps = 0;
    (void)state;
    roil *window = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .never_waits = true});
    ok(window);
    roil_effect *e = open(window, FPS, "", UPDATE);
    for (int frame = 1; frame <= SHOWN; frame++) draw_whole(e, frame, was[frame]);
    roil_on_progress(e, count_steps, &steps);
    draw_whole(e, 28, again);
    is_same(was[28], again, 0);
    draw_whole(e, 19, again);
    is_same(was[19], again, 0);
    assert_true(steps > 0 && steps < 1.2 * STEPS);
    ok(roil_set(e, "strength", "2")); // from here on, what was computed is of no use
    draw_whole(e, 18, again);
    assert_true(steps > 1.6 * STEPS);
    roil_unload(e);
    test_messages += roil_validation_messages(window);
    roil_destroy(window);
}

// Steps without pictures, in parts; returns how many.
static int catch_up(roil_effect *e, double frame) {
    int parts = 0;
    for (bool more = true; more; parts += more) ok(roil_catch_up(e, frame, &more));
    return parts;
}

// To a frame of a time that was simulated a window goes, back and forth, by a second of steps.
// In single precision: in half precision graphics cards round a step that writes images otherwise
// than one that does not, so that it shows where submissions end.
static void a_window_catches_up_without_pictures(void **state) {
    enum { FPS = 10, LAST = 41, BACK = 14 };
    static const char SINGLE[] = "precision = 'f32'";
    picture whole, back, again;
    roil_effect *a = open(*state, FPS, SINGLE, UPDATE);
    for (int frame = 1; frame <= LAST; frame++) draw(a, frame, frame <= BACK ? back : whole);
    roil_unload(a);
    roil *window = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .never_waits = true});
    ok(window);
    roil_effect *b = open(window, FPS, SINGLE, UPDATE);
    int all = catch_up(b, LAST);
    draw_whole(b, LAST, again);
    is_same(whole, again, 0);
    int less = catch_up(b, BACK);
    draw_whole(b, BACK, again);
    is_same(back, again, 0);
    int forth = catch_up(b, LAST);
    draw_whole(b, LAST, again);
    is_same(whole, again, 0);
    const int second = all * FPS / LAST + 1;
    if (!(all > LAST / 2 && less <= second && forth <= second))
        fail_msg("%d parts, then %d and %d", all, less, forth);
    roil_unload(b);
    test_messages += roil_validation_messages(window);
    roil_destroy(window);
}

static const char LIFT[] =
    "local fx = effect { name = 'lift', fps = 24, frames = 240 }\n"
    "local lift = param { 'lift', 0.4, min = 0, max = 4, unit = 'm/s' }\n"
    "local air = slices { count = 1, size = {32, 32}, height = 2, variation = 0 }\n"
    "air:inflow { shape = disc { 0.5, 0.15, radius = 0.12 }, density = 1, velocity = {0, lift} }\n"
    "fx.output = shader { 'slice.comp', value = air.density }.color\n"
    "return fx\n";

// Where a hand goes to another frame while steps to an earlier one are under way.
static void a_window_changes_its_mind(void **state) {
    picture whole, again;
    char path[512];
    (void)state;
    roil *window = roil_create(
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .never_waits = true});
    ok(window);
    write_text("slice.comp", SLICE, path);
    roil_effect *e = load_text(window, "lift.lua", LIFT);
    ok(roil_prepare(e, WIDE, HIGH));
    catch_up(e, 20);
    draw_whole(e, 20, again);
    roil_branch *b = roil_branch_begin(e);
    ok(b);
    roil_branch_enter(e, b);
    draw_whole(e, 20, again);
    ok(roil_set(e, "lift", "3.6"));
    draw_whole(e, 20, again);
    draw_whole(e, 21, whole);
    for (int parts = 0; parts < 4; parts++) {
        bool more;
        draw_whole(e, 1, again);
        ok(roil_set(e, "lift", "2")); // what was simulated is forgotten, but for where it began
        ok(roil_set(e, "lift", "3.6"));
        for (int i = 0; i < parts; i++) ok(roil_catch_up(e, 14, &more));
        ok(roil_catch_up(e, 21, &more));
        draw_whole(e, 21, again);
        is_same(whole, again, 0);
    }
    roil_unload(e);
    test_messages += roil_validation_messages(window);
    roil_destroy(window);
}

// ---- what it tells ----------------------------------------------------------------------------

static void it_tells_of_itself(void **state) {
    picture p;
    roil_simulation s;
    roil_effect *e = open(*state, 24, "", "");
    for (int frame = 1; frame <= 9; frame++) draw(e, frame, p);
    assert_true(fabs(readout(e, "time step") - 0.005) < 1e-9);
    assert_true(readout(e, "steps") == 68); // 8 / 24 s are 66.7 steps, and one more to mix with
    assert_true(readout(e, "speed") > 0.01 && readout(e, "speed") < 2);
    assert_true(fabs(readout(e, "mass drift")) < 5);
    assert_true(roil_get_simulation(e, &s));
    assert_false(s.waiting);
    assert_null(s.trouble);
    assert_true(s.reached >= 8 / 24.0 && s.reached < 8 / 24.0 + 0.006);
    roil_unload(e);
}

static void air_that_is_too_fast_stops_and_says_why(void **state) {
    picture p;
    roil_simulation s;
    roil_effect *e =
        open(*state, 24, "guard = 'stop'",
             "air:source { shape = box { position = {0, 0, 0.5} }, velocity = {0, 0, 9} }");
    for (int frame = 1; frame <= 12; frame++) draw(e, frame, p);
    assert_true(roil_get_simulation(e, &s));
    assert_non_null(s.trouble);
    if (!strstr(s.trouble, "'speed'")) fail_msg("%s", s.trouble);
    double steps = readout(e, "steps");
    draw(e, 13, p);
    assert_true(readout(e, "steps") == steps);
    roil_unload(e);
}

static void air_that_is_too_fast_is_held_back_by_itself(void **state) {
    picture p;
    roil_simulation s;
    roil_effect *e = open(*state, 24, "buoyancy_density = 400", "");
    draw(e, 12, p); // the frames before are looked over, too
    roil_time times[32];
    assert_true(roil_times(e, times, 32) > 0); // waits
    assert_true(roil_get_simulation(e, &s));
    assert_non_null(s.trouble);
    if (!strstr(s.trouble, "held back")) fail_msg("%s", s.trouble);
    assert_true(readout(e, "Mach") < 0.31);
    double steps = readout(e, "steps");
    draw(e, 13, p);
    assert_true(readout(e, "steps") > steps);
    roil_unload(e);
}

// The smoke has been spoilt by then.
static void air_that_was_held_back_in_passing_is_told(void **state) {
    picture p;
    roil_time times[32];
    roil_simulation s;
    roil_effect *e = open(*state, 24, "buoyancy_heat = 0",
                          "air:source { shape = box { position = {0, 0, 0.5} }, temperature = 0,\n"
                          "  velocity = vec(0, 0, 9 * step(0.1, time) * step(time, 0.2)) }");
    for (int frame = 1; frame <= 24; frame++) draw(e, frame, p);
    assert_true(roil_times(e, times, 32) > 0); // waits
    assert_true(readout(e, "Mach") < 0.25);
    assert_true(roil_get_simulation(e, &s) && s.trouble);
    if (!strstr(s.trouble, "was, from 0.1") || !strstr(s.trouble, "'speed'"))
        fail_msg("%s", s.trouble);
    roil_restart(e);
    draw(e, 1, p);
    assert_true(roil_times(e, times, 32) > 0);
    assert_true(roil_get_simulation(e, &s));
    assert_null(s.trouble);
    roil_unload(e);
}

// Whatever is given to it, held-back air stays air: its mass, too.
static void nothing_that_is_given_bursts_it(void **state) {
    static const char *const more[] = {
        "air:source { shape = box { position = {0, 0, 0.5} }, velocity = {0, 0, 90} }",
        "air:source { shape = box { position = {0, 0, 0.5} }, density = sqrt(position.x),\n"
        "  temperature = 1 / (0 * position.x), velocity = {0, 0, 1} }",
        ""};
    static const char *const keys[] = {"", "", "wind = {90, 0, 0}, boundary = { left = 'inflow' }"};
    for (size_t i = 0; i < 3; i++) {
        picture p;
        roil_time times[32];
        roil_effect *e = open(*state, 24, keys[i], more[i]);
        draw(e, 13, p);
        assert_true(roil_times(e, times, 32) > 0); // waits
        assert_true(fabs(readout(e, "mass drift")) < 15);
        assert_true(readout(e, "Mach") > 0.01 && readout(e, "Mach") < 0.31);
        roil_unload(e);
    }
}

static void said(roil_effect *e, const char *part) {
    roil_simulation s;
    roil_time times[32];
    assert_true(roil_times(e, times, 32) > 0); // waits
    assert_true(roil_get_simulation(e, &s));
    assert_non_null(s.trouble);
    if (!strstr(s.trouble, part)) fail_msg("%s", s.trouble);
}

static void air_that_bursts_stops_and_says_so(void **state) {
    picture p;
    roil_effect *e = open(*state, 24, "buoyancy_density = 1e9", "");
    draw(e, 13, p);
    said(e, "the air burst and has stopped");
    double steps = readout(e, "steps");
    draw(e, 14, p);
    assert_true(readout(e, "steps") == steps);
    roil_unload(e);
}

// While the host does not know yet that it has to stop, steps go on, and the picture stays.
static void what_burst_is_never_shown(void **state) {
    static const char *const keys[] = {"guard = 'stop'", "buoyancy_heat = 1e7"};
    for (int i = 0; i < 2; i++) {
        picture p, last = {0};
        double steps = 0;
        int changed = 0, held = 0;
        roil_effect *e =
            open(*state, 24, keys[i],
                 "air:source { shape = box { position = {0, 0, 0.5} }, density = 1,\n"
                 "  temperature = smoothstep(0.1, 0.2, time), velocity = vec(0, 0, 40 * time) }");
        for (int frame = 1; frame <= 12; frame++) {
            draw(e, frame, p);
            bool same = memcmp(p, last, sizeof p) == 0, steps_on = readout(e, "steps") > steps;
            if (held) assert_true(same);
            changed += !same;
            held += same && steps_on;
            steps = readout(e, "steps");
            memcpy(last, p, sizeof p);
        }
        print_message("%s: %d pictures, then %d more states of it\n", keys[i], changed, held);
        assert_true(changed > 0 && held > 0);
        roil_unload(e);
    }
}

static void what_is_not_in_the_air_is_told(void **state) {
    static const char beside[] =
        "air:source { shape = sphere { position = %s, radius = 0.2 }, density = 1 }";
    static const char *const places[] = {"{50, 0, 0}", "vec(50 - 150 * time, 0, 0.5)"};
    for (int i = 0; i < 2; i++) {
        picture p;
        char more[256];
        snprintf(more, sizeof more, beside, places[i]);
        roil_effect *e = open(*state, 24, "", more);
        draw(e, 2, p);
        said(e, "lbm_source_2 has not been in the air so far");
        draw(e, 9, p); // the second one comes by
        roil_simulation s;
        assert_true(roil_get_simulation(e, &s));
        assert_true(i == 0 ? s.trouble != NULL : s.trouble == NULL);
        roil_unload(e);
    }
}

// A source within a collider; the second one comes out of it.
static void what_solids_keep_from_giving_is_told(void **state) {
    static const char within[] =
        "local pace = param { 'pace', %d, min = 0, max = 2 }\n"
        "air:source { shape = sphere { position = vec(0.3 - pace * time, 0, 1.2), radius = 0.1 },\n"
        "             density = 1 }\n"
        "air:collider { mesh { 'cube.obj', scale = 0.3, position = {0.3, 0, 1.2} } }";
    for (int i = 0; i < 2; i++) {
        picture p;
        char more[512], path[512];
        write_text("cube.obj", CUBE, path);
        snprintf(more, sizeof more, within, 2 * i);
        roil_effect *e = open(*state, 24, "buoyancy_density = 3", more);
        draw(e, 1, p);
        draw(e, 2, p);
        said(e, "lbm_source_2 lies within colliders or walls");
        draw(e, 9, p);
        roil_time times[32];
        roil_simulation s;
        assert_true(roil_times(e, times, 32) > 0); // waits
        assert_true(roil_get_simulation(e, &s));
        assert_true(i == 0 ? s.trouble != NULL : s.trouble == NULL);
        roil_unload(e);
    }
}

// ---- reload -----------------------------------------------------------------------------------

static int reload(roil_live *live, const char *keys, const char *shown, double frame) {
    char text[2048], path[512];
    script(text, 24, keys, "", shown);
    write_text("air.lua", text, path);
    return test_reload(live, WIDE, HIGH, frame);
}

static void a_reload_goes_on_where_the_lattice_is_the_same(void **state) {
    char path[512];
    write_text("slice.comp", SLICE, path);
    write_text("air.lua", "", path);
    roil_live *live = roil_live_create(*state, &(roil_live_desc){.file = path});
    ok(live);
    assert_int_equal(reload(live, "", "air.density", 1), 0);
    ok(roil_advance(roil_live_effect(live), 2));
    ok(roil_advance(roil_live_effect(live), 3));
    double steps = readout(roil_live_effect(live), "steps");
    assert_int_equal(reload(live, "viscosity = 0.001", "air.density * 0.5", 4), 0);
    assert_true(readout(roil_live_effect(live), "steps") > steps);
    assert_true(reload(live, "warm_up = 0.01", "air.density", 5) > 0); // from the first on
    assert_true(reload(live, "time_step = 0.003", "air.density", 6) > 0);
    roil_live_destroy(live);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(how_often_is_drawn_changes_nothing),
        cmocka_unit_test(a_jump_is_as_good_as_every_frame),
        cmocka_unit_test(a_jump_back_begins_anew),
        cmocka_unit_test(air_is_warmed_up_before_the_first_frame),
        cmocka_unit_test(another_size_of_the_picture_changes_nothing),
        cmocka_unit_test(a_window_catches_up_over_several_pictures),
        cmocka_unit_test(a_window_goes_back_by_a_second_at_most),
        cmocka_unit_test(a_window_catches_up_without_pictures),
        cmocka_unit_test(a_window_changes_its_mind),
        cmocka_unit_test(air_that_is_too_fast_is_held_back_by_itself),
        cmocka_unit_test(air_that_was_held_back_in_passing_is_told),
        cmocka_unit_test(nothing_that_is_given_bursts_it),
        cmocka_unit_test(air_that_bursts_stops_and_says_so),
        cmocka_unit_test(what_burst_is_never_shown),
        cmocka_unit_test(what_is_not_in_the_air_is_told),
        cmocka_unit_test(what_solids_keep_from_giving_is_told),
        cmocka_unit_test(it_tells_of_itself),
        cmocka_unit_test(air_that_is_too_fast_stops_and_says_why),
        cmocka_unit_test(a_reload_goes_on_where_the_lattice_is_the_same),
    };
    return test_run(tests);
}
