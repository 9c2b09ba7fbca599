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
        cmocka_unit_test(reloads_of_lit_effects_leave_no_memory),
    };
    return test_run(tests);
}
