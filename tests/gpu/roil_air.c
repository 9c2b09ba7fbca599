// Simulated air through the public interface: what is drawn, and how often, does not change what is
// simulated; frames that were left out are caught up with; a reload goes on.
#include "roil_test.h"

enum { WIDE = 16, HIGH = 24 };

// The upright slice through the middle of the box, cell by cell.
static const char SLICE[] =
    "// A slice.\n"
    "//@ field float value : shown\n"
    "#include \"fields.glsl\"\n"
    "writeonly uniform image2D color; //= output rgba16f : it\n"
    "void main() {\n"
    "    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);\n"
    "    if (any(greaterThanEqual(at, size))) return;\n"
    "    vec2 uv = (vec2(at) + 0.5) / vec2(size);\n"
    "    vec3 p = vec3(mix(-0.8, 0.8, uv.x), 0.05, mix(2.4, 0.0, uv.y));\n"
    "    imageStore(color, at, vec4(vec3(field_value(p)), 1.0));\n"
    "}\n";

// %s: frames a second, more keys of the air, more of the file; what is shown.
static const char SCRIPT[] =
    "local fx = effect { name = 'air', fps = %g, frames = 1000 }\n"
    "local strength = param { 'strength', 1, min = 0, max = 9 }\n"
    "local air = lbm { size = {16, 16, 24}, voxel_size = 0.1, speed = 2, buoyancy_heat = 6, %s }\n"
    "air:source { shape = box { position = {0.2, 0, 0.5}, size = {0.4, 0.4, 0.4} }, temperature = "
    "1,\n"
    "             density = strength * curve { {0, 0.9}, {0.3, 0.1}, {0.5, 0.5} } }\n"
    "%s\n"
    "local shown = shader { 'slice.comp', value = %s }\n"
    "fx.output = shown.color\n"
    "return fx\n";

typedef uint8_t picture[WIDE * HIGH * 4];

static void script(char out[2048], double fps, const char *keys, const char *more,
                   const char *shown) {
    snprintf(out, 2048, SCRIPT, fps, keys, more, shown);
}

static roil_effect *open(roil *r, double fps, const char *keys, const char *more) {
    char text[2048], path[512];
    script(text, fps, keys, more, "air.density");
    write_text("slice.comp", SLICE, path);
    roil_effect *e = load_text(r, "air.lua", text);
    ok(roil_prepare(e, WIDE, HIGH));
    return e;
}

static void draw(roil_effect *e, double frame, picture out) {
    ok(roil_render(e, frame));
    ok(roil_read(e, false, out));
}

static int at(const picture p, int x, int y) {
    return p[4 * (y * WIDE + x)];
}

static void is_same(const picture a, const picture b, int slack) {
    for (int i = 0; i < WIDE * HIGH; i++)
        if (abs(a[4 * i] - b[4 * i]) > slack)
            fail_msg("texel %d, %d: %d is not %d", i % WIDE, i / WIDE, a[4 * i], b[4 * i]);
}

static int brightest(const picture p) {
    int most = 0;
    for (int i = 0; i < WIDE * HIGH; i++)
        if (p[4 * i] > most) most = p[4 * i];
    return most;
}

// Of what is shown, the mean row, from above.
static double height_of(const picture p) {
    double sum = 0, weighted = 0;
    for (int i = 0; i < WIDE * HIGH; i++) {
        sum += p[4 * i];
        weighted += p[4 * i] * (double)(i / WIDE);
    }
    assert_true(sum > 0);
    return weighted / sum;
}

static double readout(roil_effect *e, const char *name) {
    roil_readout all[32];
    size_t count = roil_readouts(e, all, 32);
    for (size_t i = 0; i < count && i < 32; i++)
        if (strcmp(all[i].name, name) == 0) return all[i].value;
    fail_msg("no readout '%s' of %zu", name, count);
    return 0;
}

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
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .punctual = true});
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
        &(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .validate = true, .punctual = true});
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

// ---- what it is given -------------------------------------------------------------------------

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

static const char CUBE[] =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\n"
    "v 1 1 1\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n"
    "f 2 4 8 6\n";

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
        "air:source { shape = sphere { position = %s, radius = 0.1 }, density = 1 }\n"
        "air:collider { mesh { 'cube.obj', scale = 0.3, position = {0.3, 0, 1.2} } }";
    static const char *const places[] = {"{0.3, 0, 1.2}", "vec(0.3 - 2 * time, 0, 1.2)"};
    for (int i = 0; i < 2; i++) {
        picture p;
        char more[256], path[512];
        write_text("cube.obj", CUBE, path);
        snprintf(more, sizeof more, within, places[i]);
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

static bool count_call(void *user, double done, double whole) {
    (void)done, (void)whole;
    ++*(int *)user;
    return true;
}

static int reload(roil_live *live, const char *keys, const char *shown, double frame) {
    char text[2048], path[512];
    int calls = 0;
    script(text, 24, keys, "", shown);
    write_text("air.lua", text, path);
    roil_live_wait(live);
    assert_true(roil_live_update(live, WIDE, HIGH, frame));
    if (roil_live_message(live)) fail_msg("%s", roil_live_message(live));
    roil_on_progress(roil_live_effect(live), count_call, &calls);
    ok(roil_advance(roil_live_effect(live), frame));
    return calls;
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
        cmocka_unit_test(meshes_give_smoke_and_stand_in_its_way),
        cmocka_unit_test(meshes_of_sources_may_meet),
        cmocka_unit_test(a_source_that_holds_the_pressure_blows_new_air_out),
        cmocka_unit_test(air_that_is_too_fast_is_held_back_by_itself),
        cmocka_unit_test(air_that_was_held_back_in_passing_is_told),
        cmocka_unit_test(nothing_that_is_given_bursts_it),
        cmocka_unit_test(air_that_bursts_stops_and_says_so),
        cmocka_unit_test(what_burst_is_never_shown),
        cmocka_unit_test(what_is_not_in_the_air_is_told),
        cmocka_unit_test(what_solids_keep_from_giving_is_told),
        cmocka_unit_test(smoke_is_where_its_source_is_and_rises),
        cmocka_unit_test(smoke_heat_and_dye_are_told_apart),
        cmocka_unit_test(a_field_pushes_the_air),
        cmocka_unit_test(sheets_give_smoke_and_stand_in_its_way),
        cmocka_unit_test(what_fails_at_a_step_is_told),
        cmocka_unit_test(a_lattice_that_is_too_large_names_its_line),
        cmocka_unit_test(air_that_nobody_reads_takes_no_memory),
        cmocka_unit_test(it_tells_of_itself),
        cmocka_unit_test(air_that_is_too_fast_stops_and_says_why),
        cmocka_unit_test(a_reload_goes_on_where_the_lattice_is_the_same),
    };
    return test_run(tests);
}
