// What simulated air is given: sources, meshes, pushes.
#include "long_test.h"
#include "roil_air_test.h"

static void smoke_is_where_its_source_is_and_rises(void **state) {
    picture early, late;
    roil_effect *e = open(*state, 24, "", "");
    draw(e, 1, early);
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) { // cells 8 to 11 along x, 3 to 6 along z
            bool inside = x >= 8 && x < 12 && y >= HIGH - 7 && y < HIGH - 3;
            int value = at(early, x, y);
            if (inside ? value < 200 : value > 0) fail_msg("%d, %d: %d", x, y, value);
        }
    draw(e, 20, late);
    if (!(height_of(late) < height_of(early) - 2))
        fail_msg("it is at row %.2f, and was at %.2f", height_of(late), height_of(early));
    roil_unload(e);
}

// Three that the air carries, each by its own name.
// Warm, smoky air that is the same everywhere has nothing that holds it back: it rises by what
// buoyancy says of it, in metres and seconds, each second by as much.
static void heat_and_smoke_lift_by_their_buoyancy(void **state) {
    static const double lifts[][2] = {{5.2, 0}, {0, 14}, {3, 4}}; // by 1 of heat, by 1 of smoke
    for (size_t i = 0; i < COUNT_OF(lifts); i++) {
        char text[2048], path[512];
        picture p;
        snprintf(text, sizeof text,
                 "local fx = effect { name = 'lift', fps = 20, frames = 100 }\n"
                 "local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 3, boundary = "
                 "'periodic', buoyancy_heat = %g, buoyancy_density = %g }\n"
                 "air:source { shape = box { position = {0, 0, 0.8}, size = {9, 9, 9} }, "
                 "temperature = 0.5, density = 0.2 }\n"
                 "local shown = shader { 'slice.comp', value = air.velocity.z / 2 }\n"
                 "fx.output = shown.color\n"
                 "return fx\n",
                 lifts[i][0], lifts[i][1]);
        write_text("slice.comp", SLICE, path);
        roil_effect *e = load_text(*state, "lift.lua", text);
        ok(roil_prepare(e, WIDE, HIGH));
        for (int frame = 7; frame <= 13; frame += 6) {
            draw(e, frame, p);
            const double speed = (0.5 * lifts[i][0] + 0.2 * lifts[i][1]) * (frame - 1) / 20.0;
            const int wanted = srgb((float)(speed / 2));
            const int seen = at(p, 8, HIGH - 8);
            print_message("heat lifts by %g, smoke by %g: %d is shown, wanted %d\n", lifts[i][0],
                          lifts[i][1], seen, wanted);
            assert_true(abs(seen - wanted) < 3);
        }
        roil_unload(e);
    }
}

static void smoke_heat_and_dye_are_told_apart(void **state) {
    static const char *const shown[] = {"air.density", "0.5 * air.temperature", "air.dye"};
    static const int given[] = {170, 203, 231}; // 0.4, 0.6, 0.8 in sRGB
    for (int i = 0; i < 3; i++) {
        char text[2048], path[512];
        picture p;
        script(text, 24, "buoyancy_heat = 0",
               "air:source { shape = box { position = {-0.4, 0, 1.6}, size = {0.4, 0.4, 0.4} },\n"
               "  density = 0.4, temperature = 1.2, dye = 0.8, velocity = {0, 0, 0} }",
               shown[i]);
        write_text("slice.comp", SLICE, path);
        roil_effect *e = load_text(*state, "air.lua", text);
        ok(roil_prepare(e, WIDE, HIGH));
        draw(e, 3, p);
        int inside = at(p, 4, HIGH - 17);
        if (abs(inside - given[i]) > 2 || at(p, 14, HIGH - 17) != 0)
            fail_msg("%s: %d and %d", shown[i], inside, at(p, 14, HIGH - 17));
        roil_unload(e);
    }
}

static void a_field_pushes_the_air(void **state) {
    if (!sim_long_tests("a force that is a field")) return; // gpu/roil_checkpoint has one, too
    picture still, pushed;
    roil_effect *a = open(*state, 24, "buoyancy_density = 0", "");
    roil_effect *b = open(*state, 24, "force = vec(-8 * step(0, position.z), 0, 0)", "");
    draw(a, 12, still);
    draw(b, 12, pushed);
    double left[2] = {0, 0};
    for (int i = 0; i < WIDE * HIGH; i++)
        if (i % WIDE < 7) {
            left[0] += still[4 * i];
            left[1] += pushed[4 * i];
        }
    if (!(left[1] > 1.5 * left[0])) fail_msg("%g is not much above %g", left[1], left[0]);
    roil_unload(a);
    roil_unload(b);
}

// Held above the pressure around, a box without any velocity of its own blows to all sides.
static void a_source_that_holds_the_pressure_blows_new_air_out(void **state) {
    char text[2048], path[512];
    picture p;
    script(text, 24, "buoyancy_heat = 0",
           "air:source { shape = box { position = {0, 0, 1.5}, size = {0.4, 0.4, 0.4} }, "
           "pressure = 1 }\n",
           "0.5 + 5 * air.velocity.x");
    write_text("slice.comp", SLICE, path);
    roil_effect *e = load_text(*state, "air.lua", text);
    ok(roil_prepare(e, WIDE, HIGH));
    draw(e, 6, p);
    int left = at(p, 4, HIGH - 15), right = at(p, 11, HIGH - 15); // at rest: 187
    if (!(left < 179 && right > 195)) fail_msg("%d, %d", left, right);
    roil_unload(e);
}

// A mesh of that name gives smoke at `source` and stands, somewhat larger, at `collider`.
static roil_effect *open_meshes(roil *r, const char *name, const char *obj, const char *source,
                                const char *collider) {
    char path[512], more[512];
    write_text(name, obj, path);
    snprintf(more, sizeof more,
             "air:source { mesh { '%s', scale = 0.2, position = %s }, density = 1 }\n"
             "air:collider { mesh { '%s', scale = 0.3, position = %s } }",
             name, source, name, collider);
    return open(r, 24, "buoyancy_density = 3", more);
}

// A cube that moves gives smoke where it is at the time of a step; another one keeps it out.
static void meshes_give_smoke_and_stand_in_its_way(void **state) {
    picture p;
    roil_effect *e =
        open_meshes(*state, "cube.obj", CUBE,
                    "curve { {0, {-0.5, 0, 0.5}}, {0.5, {-0.5, 0, 1.5}} }", "{0.3, 0, 1.2}");
    draw(e, 1, p);
    assert_true(at(p, 3, HIGH - 5) > 200 && at(p, 3, HIGH - 16) == 0);
    draw(e, 13, p);
    assert_true(at(p, 3, HIGH - 16) > 200);
    for (int y = 10; y < 14; y++)
        for (int x = 9; x < 13; x++)
            if (at(p, x, y) > 2) fail_msg("%d, %d within the cube: %d", x, y, at(p, x, y));
    roil_unload(e);
}

// Two sources in the same place: one gives smoke, and the other heat, which makes it rise.
static void meshes_of_sources_may_meet(void **state) {
    if (!sim_long_tests("meshes of sources that meet")) return;
    static const char place[] = "mesh { 'cube.obj', scale = 0.2, position = {-0.5, 0, 0.5} }";
    char path[512], more[512];
    picture p;
    write_text("cube.obj", CUBE, path);
    snprintf(more, sizeof more,
             "air:source { %s, density = 1 }\nair:source { %s, temperature = 1 }", place, place);
    roil_effect *e = open(*state, 24, "buoyancy_heat = 6", more);
    draw(e, 1, p);
    assert_true(at(p, 3, HIGH - 5) > 200 && at(p, 3, HIGH - 9) < 50);
    draw(e, 13, p);
    assert_true(at(p, 3, HIGH - 5) > 200 && at(p, 3, HIGH - 9) > 100);
    roil_unload(e);
}

// A mesh that lies in one plane has cells too, though its box is of no size.
static void sheets_give_smoke_and_stand_in_its_way(void **state) {
    if (!sim_long_tests("meshes that lie in one plane")) return;
    static const char sheet[] = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
    picture p;
    roil_simulation s;
    roil_effect *e =
        open_meshes(*state, "sheet.obj", sheet, "{-0.45, 0, 0.45}", "{-0.45, 0, 1.25}");
    draw(e, 13, p);
    assert_true(at(p, 3, HIGH - 5) > 200);
    if (at(p, 3, HIGH - 13) > 2) fail_msg("within the sheet: %d", at(p, 3, HIGH - 13));
    roil_time times[32];
    assert_true(roil_times(e, times, 32) > 0); // waits
    assert_true(roil_get_simulation(e, &s));
    if (s.trouble) fail_msg("%s", s.trouble);
    roil_unload(e);
}

static void what_fails_at_a_step_is_told(void **state) {
    roil_effect *e =
        open(*state, 24, "viscosity = function(t) assert(t < 0.1) return 0.001 end", "");
    ok(roil_render(e, 2));
    expect_error(roil_render(e, 4), "viscosity");
    roil_unload(e);
    e = open(*state, 24, "",
             "air:source { shape = sphere { position = {0, 0, 1}, radius = 0.2 }, density = 1,\n"
             "  rate = function(t) assert(t < 0.1) return 3 end }");
    ok(roil_render(e, 2));
    expect_error(roil_render(e, 4), "lbm_source");
    expect_error(roil_render(e, 5), "rate");
    roil_unload(e);
}

static void a_lattice_that_is_too_large_names_its_line(void **state) {
    char text[2048];
    script(text, 24,
           "size = {1024, 1024, 1024}, velocity_set = 'd3q27', scalar_set = 'd3q27', "
           "precision = 'f32'",
           "", "air.density");
    roil_effect *e = load_text(*state, "air.lua", text);
    expect_error(roil_prepare(e, WIDE, HIGH), "air.lua:3: lbm: a lattice of 1024 x 1024 x 1024");
    roil_unload(e);
}

static uint64_t memory_with(roil *r, const char *more) {
    picture p;
    uint64_t before = roil_get_memory(r).device;
    roil_effect *e = open(r, 24, "", more);
    draw(e, 2, p);
    uint64_t taken = roil_get_memory(r).device - before;
    roil_unload(e);
    return taken;
}

static void air_that_nobody_reads_takes_no_memory(void **state) {
    static const char MORE[] =
        "local more = lbm { size = {32, 32, 32}, voxel_size = 0.1, speed = 2 }\n"
        "more:source { shape = sphere { position = {0, 0, 1}, radius = 0.2 }, density = 1 }\n";
    char read[512];
    snprintf(read, sizeof read,
             "%sair:source { shape = sphere { position = {0, 0, 1} },\n"
             "             density = more.density }",
             MORE);
    uint64_t alone = memory_with(*state, ""), unread = memory_with(*state, MORE);
    assert_true(unread < alone + (1 << 14));
    assert_true(memory_with(*state, read) > alone + (1 << 20));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(smoke_is_where_its_source_is_and_rises),
        cmocka_unit_test(heat_and_smoke_lift_by_their_buoyancy),
        cmocka_unit_test(smoke_heat_and_dye_are_told_apart),
        cmocka_unit_test(a_field_pushes_the_air),
        cmocka_unit_test(a_source_that_holds_the_pressure_blows_new_air_out),
        cmocka_unit_test(meshes_give_smoke_and_stand_in_its_way),
        cmocka_unit_test(meshes_of_sources_may_meet),
        cmocka_unit_test(sheets_give_smoke_and_stand_in_its_way),
        cmocka_unit_test(what_fails_at_a_step_is_told),
        cmocka_unit_test(a_lattice_that_is_too_large_names_its_line),
        cmocka_unit_test(air_that_nobody_reads_takes_no_memory),
    };
    return test_run(tests);
}
