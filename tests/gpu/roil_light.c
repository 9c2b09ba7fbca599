// Lit effects that change while they live: what a reference has gathered, and memory.
#include "roil_live_test.h"

static const char QUAD[] = "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3 4\n";

static session follow(roil *r, const char *script) {
    session s = {.frame = 1};
    put("quad.obj", QUAD);
    write_text("test.lua", script, script_path);
    s.live = roil_live_create(r, &(roil_live_desc){.file = script_path});
    ok(s.live);
    expect_good(&s);
    return s;
}

static void rewrite(session *s, const char *script) {
    write_text("test.lua", script, script_path);
    expect_good(s);
}

// ---- a reference ------------------------------------------------------------------------------

#define TRACED                                                                                     \
    "local fx = effect { name = 'test' }\n"                                                        \
    "local thick = param { 'thick', 2, min = 0, max = 9 }\n"                                       \
    "local volume = reference { density = sphere { radius = 1 } * thick, samples = 3 }\n"          \
    "fx.output = volume.color\n"                                                                   \
    "return fx\n"

static void expect_samples(session *s, double frame, uint32_t samples) {
    roil_effect *e = roil_live_effect(s->live);
    ok(roil_advance(e, frame));
    assert_int_equal(roil_samples(e), samples);
}

static void reference_gathers_until_something_changes(void **state) {
    session s = follow(*state, TRACED);
    expect_samples(&s, 1, 3);
    expect_samples(&s, 1, 6);
    expect_samples(&s, 1, 9);
    expect_samples(&s, 2, 3); // time goes on
    expect_samples(&s, 2, 6);
    ok(roil_live_set(s.live, "thick", "3"));
    expect_samples(&s, 2, 3);
    expect_samples(&s, 2, 6);
    ok(roil_live_set(s.live, "sun.elevation", "10"));
    expect_samples(&s, 2, 3);
    ok(roil_live_set(s.live, "camera.yaw", "20"));
    expect_samples(&s, 2, 3);
    expect_samples(&s, 2, 6);
    rewrite(&s, "-- another file\n" TRACED);
    expect_samples(&s, 2, 3);
    expect_samples(&s, 2, 6);
    end(&s);
}

// Ground up to the horizon, in haze: a reference shows it as the effect does, though only `shade`
// or `forward` is told of the haze. With neither smoke nor bounces the two are the same picture.
static void haze_of_surfaces_is_in_the_reference(void **state) {
    enum { SIDE = 24, PATHS = 64 };
    static const char FAR[] =
        "local fx = effect { name = 'test', frames = 2 }\n"
        "fx.camera = camera { eye = {0, -3, 0.5}, target = {0, 0, 0.4}, fov = 40, far = 4000 }\n"
        "fx.sun = sun { elevation = 60, strength = 3 }\n"
        "fx.sky = sky { zenith = {0, 0, 0}, horizon = {0, 0.3, 0.6} }\n"
        "local plain = mesh { 'quad.obj', scale = 100 }\n"
        "local scene = geometry { plain }\n"
        "local solid = %s\n"
        "local volume = march { density = sphere { radius = 0.1, position = {0, 0, 9} }, %s }\n"
        "fx.output = final { over { volume, solid }, tonemap = 'none' }.color\n"
        "return fx\n";
    static const char *const ways[] = {"shade { from = scene, haze = 0.02 }",
                                       "forward { plain, haze = 0.02 }"};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        char text[2048], path[512];
        uint8_t pixels[2][SIDE * SIDE * 4];
        put("quad.obj", QUAD);
        for (uint32_t traced = 0; traced < 2; traced++) {
            snprintf(text, sizeof text, FAR, ways[i],
                     traced ? "bounces = 1, filter = 'none'" : "from = scene");
            write_text("far.lua", text, path);
            roil_set_reference(*state, traced * PATHS);
            roil_effect *e = roil_load(*state, path, NULL, 0);
            roil_set_reference(*state, 0);
            ok(e);
            ok(roil_prepare(e, SIDE, SIDE));
            do ok(roil_advance(e, 1));
            while (roil_samples(e) < traced * PATHS);
            ok(roil_read(e, false, pixels[traced]));
            roil_unload(e);
        }
        double hazy = 0;
        for (uint32_t row = 0; row < 3 * SIDE; row++) { // of each colour
            double mean[2] = {0}, near_eye = 0;
            for (uint32_t k = 0; k < SIDE; k++) {
                for (int t = 0; t < 2; t++)
                    mean[t] += pixels[t][4 * (SIDE * (row / 3) + k) + row % 3] / (double)SIDE;
                near_eye += pixels[0][4 * (SIDE * (SIDE - 1) + k) + row % 3] / (double)SIDE;
            }
            hazy = fmax(hazy, fabs(mean[0] - near_eye));
            if (fabs(mean[0] - mean[1]) > 4)
                fail_msg("%s: row %u is %g, traced %g", ways[i], row / 3, mean[0], mean[1]);
        }
        assert_true(hazy > 40);
    }
}

// ---- how far lights reach ---------------------------------------------------------------------

// A light by itself ends and falls off as one of hundreds does.
static void point_light_reaches_as_far_as_a_lamp(void **state) {
    enum { SIDE = 32, MIDDLE = 4 * (SIDE / 2 * SIDE + SIDE / 2) };
    static const char TEXT[] =
        "local fx = effect { name = 'test' }\n"
        "fx.camera = camera { eye = {0, 0, 8}, target = {0, 0.001, 0}, fov = 50 }\n"
        "fx.sun = sun { strength = 0 }\n"
        "fx.sky = sky { strength = 0 }\n"
        "local scene = geometry { mesh { 'quad.obj' } }\n"
        "local lamps = nil\n"
        "%s { %s position = {0, 0, 1}, power = 300, range = 2.5, falloff = '%s' } %s\n"
        "local solid = shade { from = { scene, lamps } }\n"
        "fx.output = final { solid, tonemap = 'none' }.color\n"
        "return fx\n";
    static const char *const falloffs[] = {"inverse_square", "linear"};
    for (size_t i = 0; i < COUNT_OF(falloffs); i++) {
        char text[2048];
        uint8_t pixels[2][SIDE * SIDE * 4];
        put("quad.obj", QUAD);
        for (int lamp = 0; lamp < 2; lamp++) {
            snprintf(text, sizeof text, TEXT,
                     lamp ? "lamps = point_lights" : "fx.lights = { point_light",
                     lamp ? "count = 1," : "", falloffs[i], lamp ? "" : "}");
            roil_effect *e = load_text(*state, "reach.lua", text);
            ok(roil_prepare(e, SIDE, SIDE));
            ok(roil_render(e, 0));
            ok(roil_read(e, false, pixels[lamp]));
            roil_unload(e);
        }
        int lit = 0, dark = 0;
        for (size_t k = 0; k < sizeof pixels[0]; k += 4) {
            lit += pixels[0][k] > 0;
            dark += pixels[0][k] == 0;
            if (abs(pixels[0][k] - pixels[1][k]) > 1)
                fail_msg("%s: byte %zu is %d, of a lamp %d", falloffs[i], k, pixels[0][k],
                         pixels[1][k]);
        }
        assert_true(pixels[0][MIDDLE] > 100 && lit > SIDE && dark > SIDE);
    }
}

// ---- reloads ----------------------------------------------------------------------------------

enum { KINDS = 8, REST = 16, ROUNDS = 40 };

// Lights, meshes and what the sky is differ from one to the next.
static void write_kind(int kind, char out[2048]) {
    static const char *const lights[] = {
        "point_light { position = {1, -2, 2}, power = 50 }",
        "sphere_light { position = {1, -2, 2}, radius = 0.2, power = 9 }, "
        "spot_light { position = {0, 0, 3}, power = 9 }"};
    snprintf(
        out, 2048,
        "local fx = effect { name = 'test', fps = 24, frames = 1000 }\n"
        "fx.lights = { %s }\n"
        "fx.sky = sky { strength = %d }\n"
        "local lit = lighting { density = sphere { radius = 1 } * 4, emission = {1, 0, 0},\n"
        "  shadow_resolution = 16, glow_resolution = 8, sweeps = 1 }\n"
        "local scene = geometry { mesh { 'quad.obj' }%s }\n"
        "local solid = shade { from = {scene, lit} }\n"
        "local volume = march { from = {lit, scene}, steps = 4 }\n"
        "local calm = accumulate { from = volume, source = volume.color, depth = scene.depth }\n"
        "fx.output = over { volume = calm.color, edge = volume.edge, source = solid, depth = "
        "scene.depth }\n"
        "return fx\n",
        lights[kind & 1], 1 + (kind >> 2 & 1),
        kind & 2 ? ", mesh { 'quad.obj', position = {0, 0, -1} }" : "");
}

static void reload_kind(session *s, int kind) {
    char script[2048];
    write_kind(kind, script);
    rewrite(s, script);
    ok(roil_advance(roil_live_effect(s->live), s->frame++));
}

static uint64_t memory_at_rest(roil *r, session *s) {
    reload_kind(s, 0);
    for (int i = 0; i < 4; i++) // what was let go dies with its frames
        ok(roil_advance(roil_live_effect(s->live), s->frame++));
    return roil_get_memory(r).device;
}

static void reloads_of_lit_effects_leave_no_memory(void **state) {
    char script[2048];
    write_kind(0, script);
    session s = follow(*state, script);
    for (int i = 1; i < REST; i++) reload_kind(&s, i % KINDS);
    uint64_t before = memory_at_rest(*state, &s);
    for (int i = 1; i < ROUNDS; i++) reload_kind(&s, i * 5 % KINDS);
    assert_int_equal(memory_at_rest(*state, &s), before);
    end(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_gathers_until_something_changes),
        cmocka_unit_test(haze_of_surfaces_is_in_the_reference),
        cmocka_unit_test(point_light_reaches_as_far_as_a_lamp),
        cmocka_unit_test(reloads_of_lit_effects_leave_no_memory),
    };
    return test_run(tests);
}
