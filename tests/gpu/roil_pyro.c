// Gas that burns through the public interface: what it gives by name, how it keeps time, how it
// goes on from a checkpoint and over a reload, and what it tells.
#include "base/memory.h"
#include "roil_test.h"

enum { SIDE = 24 };

// A ball that moves on past the end of its source.
static const char WALL[] = "v -0.1 -0.5 -0.5\nv 0.1 -0.5 -0.5\nv -0.1 0.5 -0.5\nv 0.1 0.5 -0.5\n"
                           "v -0.1 -0.5 0.5\nv 0.1 -0.5 0.5\nv -0.1 0.5 0.5\nv 0.1 0.5 0.5\n"
                           "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

// %s: keys of the gas, of its source, more of the file, what is shown.
static const char SCRIPT[] =
    "local fx = effect { name = 'fire', fps = 60, frames = 100 }\n"
    "fx.camera = orbit { target = {0, 0, 1}, distance = 5 }\n"
    "local fire = pyro { size = {16, 16, 24}, voxel_size = 0.1, time_step = 1 / 90, %s }\n"
    "fire:source { shape = sphere { position = {0, 0, 0.5}, radius = 0.4 }, fuel = 0.2,\n"
    "              temperature = 900, %s }\n"
    "%s\n"
    "local shown = %s\n"
    "fx.output = final { march { density = fire.soot * 2000, emission = shown, steps = 16 } "
    "}.color\n"
    "return fx\n";

typedef uint8_t picture[SIDE * SIDE * 4];

static const char HEAT[] = "fire.temperature * 0.001";
static const char BRIEF[] = "during = {0, 0.05}";
static const char COLLIDER[] =
    "fire:collider { mesh { 'wall.obj', position = curve { {0, {-0.6, 0, "
    "1}}, {0.3, {0.5, 0, 1}} } } }";

// A coarser run in the same box, whose wind its guide is.
static const char GUIDED[] =
    "guide = (function() local c = pyro { size = {16, 16, 16}, voxel_size = 0.15, time_step = 1 / "
    "60, wind = {2, 0, 0},\n"
    "boundary = { left = 'inflow' } }\n"
    "c:source { shape = sphere { position = {0, 0, 0.5}, radius = 0.4 }, temperature = 900 }\n"
    "return c.velocity end)(), guide_rate = 50";

static const char STIRRED[] =
    "fire:collider { mesh { 'wall.obj', position = curve { {0, {-0.6, 0, 1}}, {0.3, {0.5, 0, 1}} } "
    "} }\n"
    "fire:templates { image 'source.exr', size = {0.3, 0.8}, lifetime = {0.03, 0.1}, strength = "
    "20,\n"
    "                 within = 'temperature', above = 400, scale_by = 'temperature' }\n"
    "fire:templates { image 'pair.exr', kind = 'velocity', strength = 30, align = 'direction',\n"
    "                 direction = curl { frequency = 1 }, count = 5, size = 0.7 }";

static void write_script(char text[2048], const char *keys, const char *source, const char *more,
                         const char *shown) {
    char path[512];
    snprintf(text, 2048, SCRIPT, keys, source, more, shown);
    write_text("wall.obj", WALL, path);
    copy_template("source.exr");
    copy_template("pair.exr");
}

static roil_effect *open(roil *r, const char *keys, const char *source, const char *more,
                         const char *shown) {
    char text[2048];
    write_script(text, keys, source, more, shown);
    roil_effect *e = load_text(r, "fire.lua", text);
    ok(roil_prepare(e, SIDE, SIDE));
    return e;
}

static void draw(roil_effect *e, int first, int last, picture out) {
    for (int frame = first; frame <= last; frame++) ok(roil_render(e, frame));
    ok(roil_read(e, false, out));
}

static int brightest(const picture p) {
    int most = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        if (p[4 * i] > most) most = p[4 * i];
    return most;
}

static double readout(roil_effect *e, const char *name) {
    roil_readout all[32];
    const size_t count = roil_readouts(e, all, 32);
    for (size_t i = 0; i < count && i < 32; i++)
        if (strcmp(all[i].name, name) == 0) return all[i].value;
    fail_msg("no readout '%s'", name);
    return 0;
}

// ---- fields -----------------------------------------------------------------------------------

static void it_gives_fields_by_name(void **state) {
    static const char *const fields[] = {"fire.temperature * 0.001", "fire.fuel",
                                         "fire.soot * 100",          "fire.burn",
                                         "fire.velocity * 0.1",      "vec(fire.pressure)",
                                         "fire.divergence * 0.01",   "fire.vorticity * 0.01",
                                         "fire.smoke * 100"};
    for (size_t i = 0; i < COUNT_OF(fields); i++) {
        picture shown;
        roil_effect *e =
            open(*state, "burn_time = 0.02, smoke_yield = 0.1", "rate = 60", "", fields[i]);
        draw(e, 1, 6, shown);
        if (brightest(shown) < 8) fail_msg("%s is nowhere", fields[i]);
        roil_unload(e);
    }
}

// As much as it is given, in air as cold as that around, and it makes nothing else. What is seen
// has a trace of soot.
static void smoke_neither_glows_nor_burns(void **state) {
    static const char SMOKE[] = "fire:source { shape = sphere { position = {0, 0, 1.4}, radius = "
                                "0.5 }, smoke = 0.4, soot = 1e-6 }";
    static const char *const fields[] = {"fire.smoke", "smoothstep(0.1, 0.3, fire.smoke) * 0.4"};
    int seen[2];
    for (int i = 0; i < 2; i++) {
        picture shown;
        roil_effect *e = open(*state, "", "during = {-2, -1}", SMOKE, fields[i]);
        draw(e, 1, 6, shown);
        seen[i] = brightest(shown);
        assert_true(readout(e, "soot") < 1e-6 && fabs(readout(e, "hottest") - 293) < 0.1);
        roil_unload(e);
    }
    print_message("smoke of 0.4 kg/m^3 is seen as %d, not %d\n", seen[0], seen[1]);
    assert_true(seen[1] > 60 && abs(seen[0] - seen[1]) <= 6);
}

// The divergence is what templates let out, too: here nothing else expands.
static void templates_show_in_the_divergence(void **state) {
    picture shown[2];
    static const char *const strengths[] = {"strength = 0", "strength = 60"};
    for (int k = 0; k < 2; k++) {
        char more[256];
        snprintf(more, sizeof more,
                 "fire:templates { image 'source.exr', count = 8, size = 1, %s }", strengths[k]);
        roil_effect *e = open(*state, "expansion = 0", BRIEF, more, "fire.divergence * 0.1");
        draw(e, 1, 6, shown[k]);
        roil_unload(e);
    }
    print_message("%d, %d\n", brightest(shown[0]), brightest(shown[1]));
    assert_true(brightest(shown[1]) > brightest(shown[0]) + 20);
}

#define COLD_FUEL                                                                                  \
    "fire:source { shape = box { position = {0, 0, 0.8}, size = {1.2, 1.2, 0.8} }, fuel = 0.05, "  \
    "during = {0, 0.01} }\n"

// It is the source that it stands for, and lights what does not burn without it.
static void a_spark_lights_fuel(void **state) {
    static const char *const more[] = {
        COLD_FUEL "fire:spark { at = {0, 0, 0.8}, time = 0.03, radius = 0.4 }",
        COLD_FUEL "fire:source { shape = sphere { position = {0, 0, 0.8}, radius = 0.4 }, "
                  "temperature = 1500, during = {0.03, 0.08} }",
        COLD_FUEL "fire:spark { at = {0, 0, 0.8} }", COLD_FUEL};
    picture shown[4];
    double burnt[4];
    for (int i = 0; i < 4; i++) {
        roil_effect *e = open(*state, "", "during = {-2, -1}", more[i], "fire.temperature * 5e-4");
        draw(e, 1, 6, shown[i]);
        burnt[i] = readout(e, "fuel burnt");
        roil_unload(e);
    }
    assert_memory_equal(shown[0], shown[1], sizeof *shown);
    print_message("burnt %.3g, %.3g, %.3g, %.3g kg\n", burnt[0], burnt[1], burnt[2], burnt[3]);
    assert_true(burnt[0] > 1e-3 && burnt[2] > 1.5e-4 && burnt[3] < 1e-6);
}

static void what_is_wrong_is_said(void **state) {
    static const struct {
        const char *keys, *source, *more, *shown, *message;
    } rows[] = {
        {"", "", "", "fire.sot", "no field 'sot'; did you mean 'soot'?"},
        {"", "", "", "fire.sorce", "no method or field 'sorce'; did you mean 'source'?"},
        {"", "", "fire:spark { time = 1 }", "fire.soot", "spark: 'at' is missing"},
        {"", "", "fire:spark { at = {0, 0, 1}, heat = 1 }", "fire.soot", "heat"},
        {"fuel = 'petroll'", "", "", "0", "petrol"},
        {"boundary = { left = 'periodic' }", "", "", "0", "'boundary_left' is periodic"},
        {"burn_tme = 1", "", "", "0", "did you mean 'burn_time'?"},
        {"", "denisty = 1", "", "0", "'denisty'"},
        {"", "velocity = vec(0, 0, fire.temperature)", "", "0",
         "reads the air that it is given to"},
        {"guide = {1, 0, 0}", "", "", "0", "'guide_size' is missing: 'guide' reads no grid"},
        {"", "smok = 1", "", "0", "did you mean 'smoke'?"},
        {"smoke_yield = -1", "", "", "0", "'smoke_yield'"},
        {"turbulence = 2", "", "", "0", "'turbulence'"},
        {"guide_rate = -1", "", "", "0", "'guide_rate'"},
        {"size = {20, 16, 16}", "", "", "0", "a multiple of 8 is needed"},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        char text[2048], path[512];
        write_script(text, rows[i].keys, rows[i].source, rows[i].more, rows[i].shown);
        write_text("wrong.lua", text, path);
        roil_effect *e = roil_load(*state, path, NULL, 0);
        expect_error(e && roil_prepare(e, SIDE, SIDE), rows[i].message);
        if (e) roil_unload(e);
    }
}

// A force that is the same everywhere and one that is a field of the same value do the same; one
// that varies does not.
static void it_is_pushed_by_a_field(void **state) {
    picture even, field, varied;
    static const char *const keys[] = {"force = {4, 0, 0}",
                                       "force = vec(4, 0, 0) + perlin { frequency = 1 } * 0.001",
                                       "force = curl { frequency = 1.5 } * 20"};
    picture *const shown[] = {&even, &field, &varied};
    for (int i = 0; i < 3; i++) {
        roil_effect *e = open(*state, keys[i], BRIEF, "", "vec(length(fire.velocity)) * 0.2");
        draw(e, 1, 6, *shown[i]);
        roil_unload(e);
    }
    assert_true(brightest(even) > 20);
    for (size_t i = 0; i < sizeof even; i++) assert_true(abs(even[i] - field[i]) <= 2);
    assert_memory_not_equal(even, varied, sizeof even);
}

static void a_coarser_run_guides_it(void **state) {
    picture alone, guided;
    picture *const shown[] = {&alone, &guided};
    for (int i = 0; i < 2; i++) {
        roil_effect *e = open(*state, i ? GUIDED : "", BRIEF, "", "vec(fire.velocity.x) * 0.2");
        draw(e, 1, 12, *shown[i]);
        roil_unload(e);
    }
    print_message("along x: %d alone, %d guided\n", brightest(alone), brightest(guided));
    assert_true(brightest(guided) > brightest(alone) + 40);
}

// ---- time -------------------------------------------------------------------------------------

static void a_jump_is_as_good_as_every_frame(void **state) {
    picture each[2], jump;
    static const char *const more[] = {COLLIDER, STIRRED};
    for (int k = 0; k < 2; k++) {
        roil_effect *a = open(*state, GUIDED, BRIEF, more[k], HEAT),
                    *b = open(*state, GUIDED, BRIEF, more[k], HEAT);
        draw(a, 1, 9, each[k]);
        draw(b, 9, 9, jump);
        assert_true(brightest(each[k]) > 40);
        assert_memory_equal(each[k], jump, sizeof jump);
        roil_unload(a);
        roil_unload(b);
    }
    assert_memory_not_equal(each[0], each[1], sizeof jump);
}

static double step_time(roil_effect *e) {
    roil_time times[64];
    const size_t count = roil_times(e, times, 64);
    for (size_t i = 0; i < count && i < 64; i++)
        if (strcmp(times[i].pass, "pyro.step") == 0) return times[i].milliseconds;
    fail_msg("no time of steps");
    return 0;
}

// 75 steps, each frame's in a submission of its own; then one or two.
static void times_are_of_all_that_a_frame_simulates(void **state) {
    picture p;
    roil_effect *e = open(*state, "", BRIEF, "", HEAT);
    draw(e, 50, 50, p);
    const double jump = step_time(e);
    draw(e, 51, 51, p);
    const double next = step_time(e);
    if (!(jump > 8 * next)) fail_msg("%g ms, then %g", jump, next);
    roil_unload(e);
}

// What is in the box after a source has given is what it gave, burnt or not.
static void a_source_gives_while_it_is_told_to(void **state) {
    picture p;
    roil_effect *e = open(*state, "boundary = 'wall'", "during = {0.05, 0.06}", "", HEAT);
    draw(e, 1, 2, p); // until 1/60 s
    assert_true(readout(e, "fuel") + readout(e, "fuel burnt") == 0);
    draw(e, 3, 12, p);
    const double given = readout(e, "fuel") + readout(e, "fuel burnt");
    draw(e, 13, 20, p);
    const double kept = readout(e, "fuel") + readout(e, "fuel burnt");
    print_message("%.4f kg given, %.4f kg kept\n", given, kept);
    assert_true(given > 0.01 && fabs(kept / given - 1) < 0.05);
    roil_unload(e);
}

static const char *in_folder(const char *name) {
    static char paths[4][512];
    static int turn;
    char *out = paths[turn++ % 4];
    snprintf(out, sizeof paths[0], "%s/%s", test_folder, name);
    return out;
}

static void a_restored_run_is_the_one_that_never_stopped(void **state) {
    picture through, again;
    char keys[512];
    snprintf(keys, sizeof keys, "vorticity = 2, smoke_yield = 0.1, %s", GUIDED);
    roil_effect *e = open(*state, keys, "", STIRRED, HEAT);
    draw(e, 1, 4, through);
    ok(roil_checkpoint(e, in_folder("middle")));
    draw(e, 5, 8, through);
    roil_unload(e);
    e = open(*state, keys, "", STIRRED, HEAT);
    ok(roil_restore(e, in_folder("middle"), NULL));
    draw(e, 5, 8, again);
    assert_memory_equal(through, again, sizeof again);
    roil_unload(e);
    snprintf(keys, sizeof keys, "boundary = 'wall', smoke_yield = 0.1, %s", GUIDED);
    e = open(*state, keys, "", "", HEAT);
    expect_error(roil_restore(e, in_folder("middle"), NULL),
                 "left = open, the effect has left = wall");
    roil_unload(e);
}

static int reload(roil_live *live, const char *keys, const char *shown, double frame) {
    char text[2048], path[512];
    write_script(text, keys, BRIEF, "", shown);
    write_text("live.lua", text, path);
    return test_reload(live, SIDE, SIDE, frame);
}

static void a_reload_goes_on_with_the_gas(void **state) {
    char path[512];
    write_text("live.lua", "", path);
    roil_live *live = roil_live_create(*state, &(roil_live_desc){.file = path});
    ok(live);
    reload(live, "", HEAT, 1);
    for (int frame = 2; frame <= 6; frame++) ok(roil_advance(roil_live_effect(live), frame));
    const double steps = readout(roil_live_effect(live), "steps");
    const double fuel = readout(roil_live_effect(live), "fuel burnt");
    assert_true(fuel > 0);
    assert_int_equal(reload(live, "cooling = 500", "fire.temperature * 0.0005", 7), 0);
    assert_true(readout(roil_live_effect(live), "steps") > steps);
    assert_true(reload(live, "warm_up = 0.05", HEAT, 8) > 0); // anew
    roil_live_destroy(live);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_gives_fields_by_name),
        cmocka_unit_test(smoke_neither_glows_nor_burns),
        cmocka_unit_test(templates_show_in_the_divergence),
        cmocka_unit_test(a_spark_lights_fuel),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(it_is_pushed_by_a_field),
        cmocka_unit_test(a_coarser_run_guides_it),
        cmocka_unit_test(a_jump_is_as_good_as_every_frame),
        cmocka_unit_test(times_are_of_all_that_a_frame_simulates),
        cmocka_unit_test(a_source_gives_while_it_is_told_to),
        cmocka_unit_test(a_restored_run_is_the_one_that_never_stopped),
        cmocka_unit_test(a_reload_goes_on_with_the_gas),
    };
    return test_run(tests);
}
