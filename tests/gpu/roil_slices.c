// Slices through the public interface: what is drawn, and how often, does not change what flows;
// how they fill space; obstacles; a reload and a checkpoint go on.
#include "base/memory.h"
#include "media/png.h"
#include "roil_test.h"

enum { SIDE = 24 };

// A plane of space, 2 m wide, from below.
static const char PLANE[] =
    "// A plane.\n"
    "//@ field float value : shown\n"
    "#include \"fields.glsl\"\n"
    "uniform float turn;   //= 0 [-inf, inf] degrees : round the axis\n"
    "uniform float level;  //= 0 [0, 1] : 1: across the axis instead, half way up\n"
    "writeonly uniform image2D color; //= output rgba16f : it\n"
    "void main() {\n"
    "    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);\n"
    "    if (any(greaterThanEqual(at, size))) return;\n"
    "    vec2 uv = (vec2(at) + 0.5) / vec2(size);\n"
    "    float x = mix(-1.0, 1.0, uv.x), a = radians(turn);\n"
    "    vec3 p = level > 0.5 ? vec3(x, mix(1.0, -1.0, uv.y), 0.6)\n"
    "                         : vec3(x * cos(a), x * sin(a), mix(2.0, 0.0, uv.y));\n"
    "    imageStore(color, at, vec4(vec3(field_value(p)), 1.0));\n"
    "}\n";

// Frames a second; more keys of the slices; more of the file; what is shown, and how.
static const char SCRIPT[] =
    "local fx = effect { name = 'slices', fps = %g, frames = 1000 }\n"
    "local flow = slices { size = {32, 32}, height = 2, buoyancy_heat = 4, %s }\n"
    "%s\n"
    "fx.output = shader { 'plane.comp', value = %s }.color\n"
    "return fx\n";

static const char INFLOW[] =
    "flow:inflow { shape = disc { 0.5, 0.15, radius = 0.12 }, density = 0.8, "
    "temperature = curve { {0, 2}, {0.5, 1} }, velocity = {0, 1} }";

typedef uint8_t picture[SIDE * SIDE * 4];

static void script(char out[2048], double fps, const char *keys, const char *more,
                   const char *shown) {
    snprintf(out, 2048, SCRIPT, fps, keys, more, shown);
}

static roil_effect *open(roil *r, double fps, const char *keys, const char *more,
                         const char *shown) {
    char text[2048], path[512];
    script(text, fps, keys, more, shown);
    write_text("plane.comp", PLANE, path);
    roil_effect *e = load_text(r, "slices.lua", text);
    ok(roil_prepare(e, SIDE, SIDE));
    return e;
}

static void draw(roil_effect *e, double frame, picture out) {
    ok(roil_render(e, frame));
    ok(roil_read(e, false, out));
}

static void draw_of(roil *r, const char *keys, const char *more, const char *shown, double frame,
                    picture out) {
    roil_effect *e = open(r, 24, keys, more, shown);
    draw(e, frame, out);
    roil_unload(e);
}

static int at(const picture p, int x, int y) {
    return p[4 * (y * SIDE + x)];
}

static int sum(const picture p, int top, int bottom) {
    int all = 0;
    for (int y = top; y < bottom; y++)
        for (int x = 0; x < SIDE; x++) all += at(p, x, y);
    return all;
}

static int difference(const picture a, const picture b) { // the greatest
    int most = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        int one = abs(a[4 * i] - b[4 * i]);
        if (one > most) most = one;
    }
    return most;
}

// ---- time -------------------------------------------------------------------------------------

static void how_often_is_drawn_changes_nothing(void **state) {
    picture coarse, fine;
    roil_effect *e = open(*state, 10, "", INFLOW, "flow.density");
    for (int frame = 1; frame <= 6; frame++) draw(e, frame, coarse);
    roil_unload(e);
    e = open(*state, 50, "", INFLOW, "flow.density");
    for (int frame = 6; frame <= 26; frame++) draw(e, frame, fine);
    roil_unload(e);
    assert_true(sum(coarse, 0, SIDE) > 2000);
    assert_int_equal(difference(coarse, fine), 0);
}

static void a_jump_is_as_good_as_every_frame(void **state) {
    picture all, jump, back;
    roil_effect *e = open(*state, 24, "", INFLOW, "flow.density");
    for (int frame = 0; frame <= 12; frame++) draw(e, frame, all);
    roil_unload(e);
    e = open(*state, 24, "", INFLOW, "flow.density");
    draw(e, 20, jump);
    assert_true(difference(all, jump) > 8);
    draw(e, 12, back); // from the first on again
    roil_unload(e);
    assert_int_equal(difference(all, back), 0);
}

static void the_last_two_states_are_mixed(void **state) {
    picture now[3];
    // A step takes as long as four frames.
    roil_effect *e = open(*state, 96, "time_step = 1/24", INFLOW, "flow.density");
    for (int i = 0; i < 3; i++) draw(e, 40 + 2 * i, now[i]);
    roil_unload(e);
    assert_true(difference(now[0], now[2]) > 4);
    for (int i = 0; i < SIDE * SIDE; i++) {
        int a = now[0][4 * i], b = now[1][4 * i], c = now[2][4 * i];
        int low = a < c ? a : c, high = a < c ? c : a;
        assert_true(b >= low - 1 && b <= high + 1);
    }
}

static float linear_of(int srgb) { // more than a few
    return powf(((float)srgb / 255 + 0.055f) / 1.055f, 2.4f);
}

// The air is at rest at time 0, and half a step later half way to the state after the first step.
static void a_picture_shows_the_flow_of_its_time(void **state) {
    picture begin, half, whole;
    roil_effect *e = open(*state, 48, "time_step = 1/24", INFLOW, "flow.density");
    draw(e, 1, begin);
    draw(e, 2, half);
    draw(e, 3, whole);
    roil_unload(e);
    assert_int_equal(sum(begin, 0, SIDE), 0);
    assert_true(sum(whole, 0, SIDE) > 500);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (whole[4 * i] > 20)
            assert_true(abs(half[4 * i] - srgb(linear_of(whole[4 * i]) / 2)) <= 1);
}

static void it_is_warmed_up_before_the_first_frame(void **state) {
    static const char steady[] = "flow:inflow { shape = disc { 0.5, 0.15, radius = 0.12 }, density "
                                 "= 0.8, velocity = {0, 1} }";
    picture late, warm;
    draw_of(*state, "variation = 0", steady, "flow.density", 13, late);
    draw_of(*state, "variation = 0, warm_up = 0.5", steady, "flow.density", 1, warm);
    assert_int_equal(difference(late, warm), 0);
}

// ---- space ------------------------------------------------------------------------------------

static void without_variation_and_offset_it_is_alike_all_round(void **state) {
    picture round, other;
    static const char turned[] = "flow.density, turn = 37";
    draw_of(*state, "count = 3, variation = 0", INFLOW, "flow.density", 12, round);
    draw_of(*state, "count = 3, variation = 0", INFLOW, turned, 12, other);
    assert_true(sum(round, 0, SIDE) > 2000);
    assert_true(difference(round, other) <= 2);
    for (int y = 0; y < SIDE; y++) // and a slice is its own mirror
        for (int x = 0; x < SIDE; x++)
            assert_true(abs(at(round, x, y) - at(round, SIDE - 1 - x, y)) <= 2);
    // Slices that differ do not look the same from all sides, nor does what an offset bends.
    draw_of(*state, "count = 3, variation = 0.5", INFLOW, "flow.density", 12, round);
    draw_of(*state, "count = 3, variation = 0.5", INFLOW, turned, 12, other);
    assert_true(difference(round, other) > 8);
    static const char bent[] = "count = 3, variation = 0, offset = curl { frequency = 2, amount = "
                               "0.2 }";
    draw_of(*state, bent, INFLOW, "flow.density", 12, round);
    draw_of(*state, bent, INFLOW, turned, 12, other);
    assert_true(difference(round, other) > 8);
}

static void a_slice_is_what_space_holds_in_its_plane(void **state) {
    picture space, slice;
    draw_of(*state, "count = 3, variation = 0.5", INFLOW, "flow.density, turn = 60", 12, space);
    draw_of(*state, "count = 3, variation = 0.5", INFLOW, "flow:slice(2).density, turn = 60", 12,
            slice);
    assert_true(sum(space, 0, SIDE) > 2000);
    assert_true(difference(space, slice) <= 2);
}

// A round plume that leans, seen from the side.
static void draw_marched(roil *r, const char *keys, const char *skipping, picture out) {
    char text[2048];
    snprintf(
        text, sizeof text,
        "local fx = effect { name = 'slices', fps = 24 }\n"
        "fx.camera = orbit { target = {0, 0, 1}, distance = 5, yaw = 20 }\n"
        "local flow = slices { size = {32, 32}, height = 2, sides = 'open', axis = {0.3, 0, 1},\n"
        "                      buoyancy_heat = 4, %s }\n"
        "%s\n"
        "fx.output = march { density = flow.density * 5 * length(flow.velocity),\n"
        "                    radiance = {1, 1, 1}, skipping = '%s', bricks = 48 }.color\n"
        "return fx\n",
        keys, INFLOW, skipping);
    roil_effect *e = load_text(r, "marched.lua", text);
    ok(roil_prepare(e, SIDE, SIDE));
    draw(e, 20, out);
    roil_unload(e);
}

static void bricks_leave_nothing_out(void **state) {
    static const char *const keys[] = {"count = 5",
                                       "count = 2, offset = vec(sin(position.z * 4), 0, 0) * 0.1"};
    picture all, skipped;
    for (size_t i = 0; i < COUNT_OF(keys); i++) {
        draw_marched(*state, keys[i], "off", all);
        draw_marched(*state, keys[i], "on", skipped);
        assert_true(sum(all, 0, SIDE) > 2000);
        assert_int_equal(difference(all, skipped), 0);
    }
}

static void velocity_points_outwards_all_round(void **state) {
    static const char jets[] = "flow:force { force = vec((position.x - 0.5) * 60, 0, 0), shape = "
                               "disc { 0.5, 0.3, radius = "
                               "0.2 } }";
    static const char outward[] = "flow.velocity:dot(vec(position.x, position.y, 0) / "
                                  "length(vec(position.x, position.y, 0))) "
                                  "* 0.5, level = 1";
    picture p;
    draw_of(*state, "variation = 0, buoyancy_heat = 0, bottom = 'open', sides = 'open', count = 2",
            jets, outward, 2, p);
    int ring[8];
    for (int i = 0; i < 8; i++) {
        float a = 0.7853982f * (float)i + 0.2f;
        ring[i] =
            at(p, (int)(SIDE * (0.5f + 0.2f * cosf(a))), (int)(SIDE * (0.5f + 0.2f * sinf(a))));
        assert_true(ring[i] > 20);
    }
}

// ---- parts ------------------------------------------------------------------------------------

// In the middle of a disc in fluid at rest, after half a second: 30 steps.
static int held(roil *r, const char *keys, const char *inflow) {
    picture p;
    char more[256];
    snprintf(more, sizeof more, "flow:inflow { shape = disc { 0.5, 0.5, radius = 0.3 }, %s }",
             inflow);
    draw_of(r, keys, more, "flow.density", 13, p);
    assert_int_equal(at(p, 1, 1), 0); // nothing elsewhere
    return at(p, SIDE / 2, SIDE / 2);
}

// Air that is warm and smoky everywhere, with nothing that holds it back, rises by what is said of
// it, in metres and seconds, each second by as much. What inflow gives in a step lifts from the
// next step on.
static void forces_lift_by_what_they_say(void **state) {
    static const struct {
        const char *keys;
        double lift, late; // m/s^2, s
    } rows[] = {
        {"buoyancy_heat = 5.2", 2.6, 0.01},
        {"buoyancy_heat = 0, buoyancy_density = 14", 2.8, 0.01},
        {"buoyancy_heat = 3, buoyancy_density = 4", 2.3, 0.01},
        {"buoyancy_heat = 0, force = {0, 2.5, 0}", 2.5, 0},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        char keys[256];
        picture p;
        snprintf(keys, sizeof keys,
                 "top = 'periodic', bottom = 'periodic', sides = 'periodic', time_step = 1 / 100, "
                 "variation = 0, %s",
                 rows[i].keys);
        roil_effect *e = open(*state, 20, keys,
                              "flow:inflow { shape = disc { 0.5, 0.5, radius = 4 }, density = 0.2, "
                              "temperature = 0.5 }",
                              "flow.velocity.z / 2");
        for (int frame = 7; frame <= 13; frame += 6) {
            draw(e, frame, p);
            const double time = (frame - 1) / 20.0 - rows[i].late;
            const int wanted = srgb((float)(rows[i].lift * time / 2));
            print_message("%s: %d is shown, wanted %d\n", rows[i].keys, at(p, 12, 12), wanted);
            assert_true(abs(at(p, 12, 12) - wanted) < 3);
        }
        roil_unload(e);
    }
}

static void inflow_holds_or_adds(void **state) {
    static const char still[] = "variation = 0";
    assert_int_equal(held(*state, still, "density = 0.4"), srgb(0.4f));
    int added = held(*state, still, "density = 0.6, mode = 'add'");
    assert_true(abs(added - srgb(0.6f * 30 / 60)) <= 1);
    int slow = held(*state, still, "density = 0.6, rate = 2");
    assert_true(abs(slow - srgb(0.6f * (1 - expf(-2 * 30 / 60.0f)))) <= 1);
    // As much is given in a second as goes.
    int even = held(*state, "variation = 0, dissolve_rate = 20", "density = 8, mode = 'add'");
    float left = expf(-20 / 60.0f), each = 8 / 60.0f;
    float least = each * left / (1 - left), most = each / (1 - left);
    assert_true(even >= srgb(least) - 1 && even <= srgb(most) + 1);
}

static void write_plate(void) { // dark from 0.2 to 0.8 of the width, at half the height
    static uint8_t pixels[64][64][4];
    char path[512];
    memset(pixels, 255, sizeof pixels);
    for (int y = 30; y < 34; y++)
        for (int x = 13; x < 51; x++) memset(pixels[y][x], 0, 3);
    snprintf(path, sizeof path, "%s/plate.png", test_folder);
    const png_image image = {.width = 64, .height = 64, .channels = 4, .bits = 8, .pixels = pixels};
    assert_true(png_write(path, &image, NULL, 0));
}

static void a_painted_obstacle_stands_in_the_way(void **state) {
    picture free, held, moved;
    char more[512];
    write_plate();
    draw_of(*state, "", INFLOW, "flow.density", 24, free);
    snprintf(more, sizeof more, "%s flow:obstacle { image = image 'plate.png' }", INFLOW);
    draw_of(*state, "", more, "flow.density", 24, held);
    assert_true(sum(free, 0, SIDE / 2 - 2) > 1000);
    assert_true(sum(held, 0, SIDE / 2 - 2) < sum(free, 0, SIDE / 2 - 2) / 4);
    snprintf(more, sizeof more,
             "%s flow:obstacle { image = image 'plate.png', offset = {0, 0.35} }", INFLOW);
    draw_of(*state, "", more, "flow.density", 24, moved); // above the lower half
    assert_true(sum(moved, SIDE / 4, SIDE / 2 - 2) > 2 * sum(held, SIDE / 4, SIDE / 2 - 2));
}

static void an_obstacle_that_moves_pushes(void **state) {
    static const char still[] = "flow:obstacle { shape = disc { 0.5, 0.5, radius = 0.15 } }";
    static const char moving[] =
        "flow:obstacle { shape = disc { curve { {0, 0.3}, {1, 0.8} }, 0.5, "
        "radius = 0.15 }, velocity = {1, 0} }";
    static const char shown[] = "flow:slice(1).velocity.x * 0.5";
    picture p;
    draw_of(*state, "", still, shown, 8, p);
    assert_int_equal(sum(p, 0, SIDE), 0);
    draw_of(*state, "", moving, shown, 8, p);
    assert_true(sum(p, 0, SIDE) > 1000);
}

static double readout(roil_effect *e, const char *name) {
    roil_readout all[16];
    size_t count = roil_readouts(e, all, 16);
    for (size_t i = 0; i < count && i < 16; i++)
        if (strcmp(all[i].name, name) == 0) return all[i].value;
    fail_msg("no readout '%s'", name);
    return 0;
}

static void it_tells_of_itself(void **state) {
    picture p;
    roil_simulation now;
    roil_effect *e = open(*state, 24, "viscosity = 0.01, speed = 3", INFLOW, "flow.density");
    for (int frame = 1; frame <= 6; frame++) draw(e, frame, p);
    assert_float_equal(readout(e, "Reynolds"), 600, 1e-3);
    assert_float_equal(readout(e, "steps"), 13, 0);
    assert_true(readout(e, "speed") > 0.5 && readout(e, "speed") < 3);
    assert_true(readout(e, "iterations") >= 1);
    assert_true(readout(e, "residual") < 1e-3);
    assert_true(roil_get_simulation(e, &now) && !now.trouble);
    roil_unload(e);
    static const char fast[] =
        "flow:inflow { shape = disc { 0.5, 0.3, radius = 0.2 }, velocity = {0, "
        "50} }";
    e = open(*state, 24, "", fast, "flow.density");
    for (int frame = 1; frame <= 6; frame++) draw(e, frame, p);
    assert_true(roil_get_simulation(e, &now) && now.trouble);
    if (!strstr(now.trouble, "set 'time_step' below")) fail_msg("%s", now.trouble);
    roil_unload(e);
}

// ---- going on ---------------------------------------------------------------------------------

static int reload(roil_live *live, const char *keys, const char *shown, double frame) {
    char text[2048], path[512];
    script(text, 24, keys, INFLOW, shown);
    write_text("slices.lua", text, path);
    return test_reload(live, SIDE, SIDE, frame);
}

static void a_reload_goes_on_where_the_flow_is_the_same(void **state) {
    char path[512];
    write_text("plane.comp", PLANE, path);
    write_text("slices.lua", "", path);
    roil_live *live = roil_live_create(*state, &(roil_live_desc){.file = path});
    ok(live);
    assert_int_equal(reload(live, "", "flow.density", 1), 0);
    ok(roil_advance(roil_live_effect(live), 2));
    ok(roil_advance(roil_live_effect(live), 3));
    // Numbers, faces and the place in space may differ.
    assert_int_equal(reload(live, "viscosity = 0.001, sides = 'open', position = {1, 0, 0}",
                            "flow.density * 0.5", 4),
                     0);
    assert_true(reload(live, "count = 3", "flow.density", 5) > 0); // from the first on
    assert_true(reload(live, "count = 3, time_step = 1/48", "flow.density", 6) > 0);
    roil_live_destroy(live);
}

static void a_restored_run_is_the_one_that_never_stopped(void **state) {
    picture through, again;
    char file[512];
    double last = 0;
    snprintf(file, sizeof file, "%s/middle", test_folder);
    roil_effect *e = open(*state, 100, "", INFLOW, "flow.density"); // some frames without a step
    for (int frame = 1; frame <= 20; frame++) draw(e, frame, through);
    ok(roil_checkpoint(e, file));
    for (int frame = 21; frame <= 30; frame++) draw(e, frame, through);
    roil_unload(e);
    e = open(*state, 100, "", INFLOW, "flow.density");
    ok(roil_restore(e, file, &last));
    assert_float_equal(last, 20, 0);
    for (int frame = 21; frame <= 30; frame++) draw(e, frame, again);
    assert_memory_equal(through, again, sizeof again);
    roil_unload(e);
    e = open(*state, 100, "count = 4", INFLOW, "flow.density");
    ok(roil_render(e, 1));
    expect_error(roil_restore(e, file, NULL), "made with slices = 2, the effect has slices = 4");
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(how_often_is_drawn_changes_nothing),
        cmocka_unit_test(a_jump_is_as_good_as_every_frame),
        cmocka_unit_test(the_last_two_states_are_mixed),
        cmocka_unit_test(a_picture_shows_the_flow_of_its_time),
        cmocka_unit_test(it_is_warmed_up_before_the_first_frame),
        cmocka_unit_test(without_variation_and_offset_it_is_alike_all_round),
        cmocka_unit_test(a_slice_is_what_space_holds_in_its_plane),
        cmocka_unit_test(bricks_leave_nothing_out),
        cmocka_unit_test(velocity_points_outwards_all_round),
        cmocka_unit_test(forces_lift_by_what_they_say),
        cmocka_unit_test(inflow_holds_or_adds),
        cmocka_unit_test(a_painted_obstacle_stands_in_the_way),
        cmocka_unit_test(an_obstacle_that_moves_pushes),
        cmocka_unit_test(it_tells_of_itself),
        cmocka_unit_test(a_reload_goes_on_where_the_flow_is_the_same),
        cmocka_unit_test(a_restored_run_is_the_one_that_never_stopped),
    };
    return test_run(tests);
}
