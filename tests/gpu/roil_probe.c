// What is under a pointer: the point that one sees, and what grids hold there.
#include "roil_test.h"

static const char ball_text[] =
    "local fx = effect { fps = 10, frames = 20 }\n"
    "local heat = raw { 'heat.raw', size = {8, 8, 8}, type = 'f32', channel = 'temperature',\n"
    "                   box = { min = {-1, -1, 0}, max = {1, 1, 2} } }\n"
    "local unread = heat.temperature\n"
    "local thick = param { 'thick', 20, min = 0, max = 1000 }\n"
    "fx.camera = camera { eye = {0, -6, 1}, target = {0, 0, 1}, fov = 30 }\n"
    "local ball = sphere { position = {0, 0, 1}, radius = 0.5 }\n"
    "fx.output = final { march { density = ball * thick, steps = 8 } }.color\n";

// A file of voxels, each as its number along y.
static void write_heat(void) {
    char path[512];
    float voxels[8][8][8]; // z, y, x
    for (int i = 0; i < 512; i++) (&voxels[0][0][0])[i] = (float)(i / 8 % 8);
    snprintf(path, sizeof path, "%s/heat.raw", test_folder);
    ok(file_write(path, voxels, sizeof voxels));
}

static roil_effect *open_ball(roil *r, const char *text) {
    write_heat();
    roil_effect *e = load_text(r, "ball.lua", text);
    ok(roil_prepare(e, 64, 64) && roil_render(e, 1));
    return e;
}

static void half_of_what_is_seen_lies_before(void **state) {
    roil_effect *e = open_ball(*state, ball_text);
    roil_probed p;
    ok(roil_probe(e, 0.5f, 0.5f, &p));
    const float deep = logf(2) / 20; // of an opaque ball
    assert_true(p.found && p.density == 20);
    assert_float_equal(p.at[0], 0, 1e-3f);
    assert_float_equal(p.at[1], -0.5f + deep, 3e-3f);
    assert_float_equal(p.at[2], 1, 1e-3f);
    assert_int_equal(p.count, 1);
    assert_string_equal(p.values[0].name, "heat.temperature");
    assert_int_equal(p.values[0].components, 1);
    assert_float_equal(p.values[0].value[0], (p.at[1] + 1) / 0.25f - 0.5f, 1e-2f);
    ok(roil_set(e, "thick", "0.1") && roil_render(e, 2)); // a thin one is seen through
    ok(roil_probe(e, 0.5f, 0.5f, &p));
    assert_float_equal(p.at[1], 0, 2e-2f);
    assert_float_equal(p.density, 0.1f, 1e-6f);
    roil_unload(e);
}

static void beside_it_is_nothing(void **state) {
    roil_effect *e = open_ball(*state, ball_text);
    roil_probed p;
    ok(roil_probe(e, 0.05f, 0.5f, &p) && !p.found);                // beside its box
    ok(roil_probe(e, 0.5f + 0.15f, 0.5f + 0.15f, &p) && !p.found); // in a corner of it
    ok(roil_set(e, "thick", "0") && roil_render(e, 1));
    ok(roil_probe(e, 0.5f, 0.5f, &p) && !p.found);
    roil_unload(e);
}

static void without_a_medium_it_says_so(void **state) {
    char path[512];
    write_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", path);
    roil_effect *e = load_text(*state, "none.lua",
                               "local fx = effect { }\n"
                               "fx.output = final { shade { from = { geometry { mesh { 'a.obj' } "
                               "} } } }.color\n"
                               "\n");
    roil_probed p;
    assert_false(roil_probe(e, 0.5f, 0.5f, &p));
    assert_non_null(strstr(roil_error(), "render a frame first"));
    ok(roil_prepare(e, 16, 16) && roil_render(e, 1));
    for (int i = 0; i < 2; i++) {
        assert_false(roil_probe(e, 0.5f, 0.5f, &p));
        assert_non_null(strstr(roil_error(), "nothing fills its space"));
    }
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_of_what_is_seen_lies_before),
        cmocka_unit_test(beside_it_is_nothing),
        cmocka_unit_test(without_a_medium_it_says_so),
    };
    return test_run(tests);
}
