// An effect as a layer of a host's picture: cameras as matrices, lights, depth and motion, and
// pictures that are read back without waiting.
#include "roil_test.h"

enum { WIDTH = 48, HEIGHT = 28 };

// A ball that is seen from 5 m, 0.9 m to the left of the middle and 0.3 m above it.
static const char ball[] =
    "local fx = effect { name = 'ball', fps = 10, first = 0 }\n"
    "fx.camera = orbit { target = {0, 0, 0}, distance = 5, yaw = 0, pitch = 0, fov = 40 }\n"
    "local b = sphere { position = {-0.9, 0, 0.3}, radius = 0.6, falloff = 0.3 }\n"
    "local smoke = march { density = b * 6, emission = b * vec(4, 2, 1), steps = 32 }\n"
    "fx.output = final { smoke }.color\n"
    "return fx\n";

typedef struct pixels {
    float *rgba;
    uint32_t width, height;
} pixels;

static pixels read_image(roil_effect *e, roil_layer_image which) {
    pixels p = {0};
    const char *name = roil_get_layer_image(e, which);
    ok(name);
    roil_readback *b = roil_read_begin(e, name);
    ok(b);
    roil_read_size(b, &p.width, &p.height);
    p.rgba = mem_alloc(4 * sizeof(float) * p.width * p.height);
    ok(roil_read_end(b, p.rgba));
    return p;
}

static const float *at(const pixels *p, uint32_t x, uint32_t y) {
    return p->rgba + 4 * (y * p->width + x);
}

static float difference(const pixels *a, const pixels *b) {
    float most = 0;
    for (size_t i = 0; i < 4 * (size_t)a->width * a->height; i++)
        most = fmaxf(most, fabsf(a->rgba[i] - b->rgba[i]));
    return most;
}

static roil_effect *load_layer(roil *r, const char *name, const char *text, uint32_t width) {
    roil_effect *e = load_text(r, name, text);
    ok(roil_make_layer(e, &(roil_layer_desc){.motion = true}));
    ok(roil_prepare(e, width, HEIGHT));
    return e;
}

// From (0, -5, 0) along +y, z up; depths ordinary, y down in clip space.
static roil_view straight(void) {
    const float half = tanf(20 * 3.14159265f / 180), near = 0.5f, far = 50;
    roil_view v = {.view = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, -5, 1}};
    v.projection[0] = 1 / (half * WIDTH / HEIGHT);
    v.projection[5] = -1 / half;
    v.projection[10] = far / (near - far);
    v.projection[11] = -1;
    v.projection[14] = near * far / (near - far);
    return v;
}

static pixels draw(roil_effect *e, const roil_view *v, roil_layer_image which) {
    ok(roil_set_view(e, v));
    ok(roil_render(e, 0));
    return read_image(e, which);
}

static void cameras_of_every_kind_see_the_same(void **state) {
    roil_effect *e = load_layer(*state, "ball.lua", ball, WIDTH);
    roil_view v = straight();
    pixels script = draw(e, NULL, ROIL_LAYER_COLOR), host = draw(e, &v, ROIL_LAYER_COLOR);
    assert_true(at(&script, 16, 12)[3] > 0.5f);
    assert_true(at(&script, 40, 12)[3] == 0);
    assert_true(difference(&script, &host) < 2e-3f);

    roil_view reversed = v, upward = v, forward = v;
    reversed.projection[10] = 0; // no end
    reversed.projection[14] = 0.5f;
    upward.projection[5] *= -1;
    for (int i = 0; i < 4; i++) forward.view[4 * i + 2] *= -1;
    for (int i = 8; i < 12; i++) forward.projection[i] *= -1;
    const roil_view *others[] = {&reversed, &upward, &forward};
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        pixels other = draw(e, others[i], ROIL_LAYER_COLOR);
        assert_true(difference(&other, &host) == 0);
        mem_free(other.rgba);
    }
    mem_free(script.rgba);
    mem_free(host.rgba);
    roil_unload(e);
}

static void a_part_of_a_picture_is_seen_by_an_oblique_projection(void **state) {
    roil_effect *e = load_layer(*state, "ball.lua", ball, WIDTH), *left;
    roil_view v = straight();
    pixels whole = draw(e, &v, ROIL_LAYER_COLOR);
    left = load_layer(*state, "ball.lua", ball, WIDTH / 2);
    v.projection[0] *= 2;
    v.projection[8] = -1; // 2 x + 1 of the depth
    pixels half = draw(left, &v, ROIL_LAYER_COLOR);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH / 2; x++)
            for (int c = 0; c < 4; c++)
                assert_true(fabsf(at(&whole, x, y)[c] - at(&half, x, y)[c]) < 2e-3f);
    mem_free(whole.rgba);
    mem_free(half.rgba);
    roil_unload(left);
    roil_unload(e);
}

static void jitter_moves_the_picture(void **state) {
    roil_effect *e = load_layer(*state, "ball.lua", ball, WIDTH);
    roil_view v = straight();
    pixels still = draw(e, &v, ROIL_LAYER_COLOR);
    v.jitter[0] = 1;
    v.jitter[1] = 2;
    pixels moved = draw(e, &v, ROIL_LAYER_COLOR);
    for (uint32_t y = 0; y + 2 < HEIGHT; y++)
        for (uint32_t x = 0; x + 1 < WIDTH; x++)
            for (int c = 0; c < 4; c++)
                assert_true(fabsf(at(&still, x, y)[c] - at(&moved, x + 1, y + 2)[c]) < 2e-3f);
    mem_free(still.rgba);
    mem_free(moved.rgba);
    roil_unload(e);
}

// In the unit of the camera's space, which the view scales.
static void depth_is_that_of_the_medium(void **state) {
    roil_effect *e = load_layer(*state, "ball.lua", ball, WIDTH);
    roil_view v = straight();
    pixels depth = draw(e, &v, ROIL_LAYER_DEPTH);
    const float middle = at(&depth, 14, 11)[0];
    assert_true(middle > 4.4f && middle < 5); // in the ball's near half
    assert_true(at(&depth, 40, 11)[0] >= 1e8f);
    for (int i = 0; i < 15; i++) v.view[i] *= i % 4 < 3 ? 100 : 1; // centimetres
    v.projection[14] *= 100;
    pixels scaled = draw(e, &v, ROIL_LAYER_DEPTH);
    assert_true(fabsf(at(&scaled, 14, 11)[0] - 100 * middle) < 0.5f);
    mem_free(depth.rgba);
    mem_free(scaled.rgba);
    roil_unload(e);
}

// Where a point was in the picture, left and right, by the camera alone.
static void motion_tells_where_things_were(void **state) {
    roil_effect *e = load_layer(*state, "ball.lua", ball, WIDTH);
    roil_view v = straight();
    ok(roil_set_view(e, &v));
    ok(roil_render(e, 0));
    v.view[12] = -0.2f; // the camera goes 0.2 m to the right
    v.view[13] = 0.1f;  // and down by half of that
    v.jitter[0] = 0.25f;
    v.jitter[1] = -0.4f;
    ok(roil_set_view(e, &v));
    ok(roil_advance(e, 1));
    pixels motion = read_image(e, ROIL_LAYER_MOTION), depth = read_image(e, ROIL_LAYER_DEPTH);
    const float deep = at(&depth, 13, 11)[0], *m = at(&motion, 13, 11);
    assert_true(fabsf(m[0] - -0.2f * v.projection[0] / (2 * deep)) < 2e-4f);
    assert_true(fabsf(m[1] - 0.1f * v.projection[5] / (2 * deep)) < 2e-4f);
    mem_free(motion.rgba);
    mem_free(depth.rgba);
    roil_unload(e);
}

// Smoke that is carried along by 2 m/s to the right, beside a ball of smoke that does not move,
// seen by a camera that stands still.
static void motion_has_that_of_the_medium(void **state) {
    roil_effect *e = load_layer(
        *state, "wind.lua",
        "local fx = effect { name = 'wind', fps = 10, first = 0 }\n"
        "local lumps = worley { frequency = 2 }:advect(vec(2, 0, 0), { period = 1, mean = 0.5 })\n"
        "local b = sphere { position = {-0.9, 0, 0.3}, radius = 0.6, falloff = 0.3 } * (lumps + "
        "0.5)\n"
        "local smoke = march { density = b * 6, steps = 32 }\n"
        "local rock = sphere { position = {0.9, 0, 0.3}, radius = 0.6 }\n"
        "local still = march { density = rock * 6, steps = 32 }\n"
        "fx.output = final { over { still, smoke } }.color\n"
        "return fx\n",
        WIDTH);
    roil_view v = straight();
    ok(roil_set_view(e, &v));
    ok(roil_render(e, 0));
    ok(roil_advance(e, 1));
    pixels motion = read_image(e, ROIL_LAYER_MOTION), depth = read_image(e, ROIL_LAYER_DEPTH);
    const float deep = at(&depth, 14, 11)[0], *m = at(&motion, 14, 11);
    assert_true(fabsf(m[0] - 0.2f * v.projection[0] / (2 * deep)) < 1e-3f);
    assert_true(fabsf(m[1]) < 1e-3f);
    assert_true(at(&depth, 33, 11)[0] < 5 && at(&motion, 33, 11)[0] == 0);
    assert_true(at(&depth, 46, 11)[0] > 1e8f && at(&motion, 46, 11)[0] == 0);
    mem_free(motion.rgba);
    mem_free(depth.rgba);
    roil_unload(e);
}

static const char lit[] =
    "local fx = effect { name = 'lit' }\n"
    "fx.sun = sun { strength = 0 }\n"
    "fx.sky = sky { strength = 0 }\n"
    "fx.lights = { point_light { position = {0, 0, 9}, power = 0 } }\n"
    "local b = sphere { radius = 0.9 }\n"
    "local light = lighting { density = b * 8, shadow_resolution = 16, glow_resolution = 16 }\n"
    "local smoke = march { from = light, steps = 32 }\n"
    "fx.output = final { smoke }.color\n"
    "return fx\n";

static void sums(const pixels *p, float out[2]) {
    out[0] = out[1] = 0;
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++) out[x >= p->width / 2] += at(p, x, y)[0];
}

static void lights_are_those_of_the_host(void **state) {
    roil_effect *e = load_layer(*state, "lit.lua", lit, WIDTH);
    const roil_view v = straight();
    const roil_sun sun = {.towards = {3, 0, 0}, .irradiance = {4, 4, 4}};
    const roil_point_light lamp = {.position = {-3, -1, 0}, .intensity = {40, 40, 40}};
    float dark[2], by_sun[2], by_lamp[2];
    pixels p = draw(e, &v, ROIL_LAYER_COLOR);
    sums(&p, dark);
    mem_free(p.rgba);
    ok(roil_set_lights(e, &(roil_lights){.sun = &sun}));
    p = draw(e, &v, ROIL_LAYER_COLOR);
    sums(&p, by_sun);
    mem_free(p.rgba);
    ok(roil_set_lights(e, &(roil_lights){.points = &lamp, .count = 1}));
    p = draw(e, &v, ROIL_LAYER_COLOR);
    sums(&p, by_lamp);
    mem_free(p.rgba);
    assert_true(dark[0] + dark[1] == 0);
    assert_true(by_sun[1] > 2 * by_sun[0] && by_sun[1] > 0);
    assert_true(by_lamp[0] > 2 * by_lamp[1] && by_lamp[0] > 0);
    ok(roil_set_lights(e, NULL));
    p = draw(e, &v, ROIL_LAYER_COLOR);
    sums(&p, dark);
    mem_free(p.rgba);
    assert_true(dark[0] + dark[1] == 0);
    const roil_point_light two[2] = {lamp, lamp};
    expect_error(roil_set_lights(e, &(roil_lights){.points = two, .count = 2}),
                 "2 lights besides the sun; the effect is made for 1");
    roil_unload(e);
}

// Three balls in a row, of which the middle one can be moved. As one medium of their sum they are
// what all of them together are, from either side.
#define BALLS                                                                                      \
    "local fx = effect { name = 'row', fps = 10, first = 0 }\n"                                    \
    "local place = param { 'place', 0.2, min = -3, max = 3 }\n"                                    \
    "local a = sphere { position = {-0.3, -1.6, 0.2}, radius = 0.8, falloff = 0.5 }\n"             \
    "local b = sphere { position = vec(0, place, 0), radius = 0.8, falloff = 0.5 }\n"              \
    "local c = sphere { position = {0.3, 1.9, -0.2}, radius = 0.8, falloff = 0.5 }\n"
static const char row[] =
    BALLS "local function of(ball, r, g, b)\n"
          "  return march { density = ball * 2, albedo = {0, 0, 0}, steps = 48,\n"
          "                 emission = ball * vec(r, g, b), resolution = 0.5 * (1 + r) }\n"
          "end\n"
          "local near, middle, far = of(a, 1, 0, 0), of(b, 0, 1, 0), of(c, 0, 0, 1)\n"
          "fx.output = final { over { middle, over { far, near } } }.color\n"
          "return fx\n";
static const char sum[] =
    BALLS "fx.output = final { march { density = (a + b + c) * 2, albedo = {0, 0, 0},\n"
          "  emission = a * vec(1, 0, 0) + b * vec(0, 1, 0) + c * vec(0, 0, 1), steps = 200 }\n"
          "}.color\n"
          "return fx\n";

static void expect_sum(roil_effect *apart, roil_effect *one, const roil_view *v, float slack) {
    static const roil_layer_image which[] = {ROIL_LAYER_COLOR, ROIL_LAYER_TRANSMITTANCE,
                                             ROIL_LAYER_DEPTH};
    ok(roil_set_view(one, v));
    ok(roil_render(one, 0));
    for (size_t i = 0; i < COUNT_OF(which); i++) {
        pixels a = draw(apart, v, which[i]), b = read_image(one, which[i]);
        assert_int_equal(a.width, b.width);
        for (size_t k = 0; k < 4 * (size_t)a.width * a.height; k++)
            if (fabsf(a.rgba[k] - b.rgba[k]) > slack)
                fail_msg("image %zu, pixel %zu, %zu, channel %zu: %g, in one medium %g", i,
                         k / 4 % a.width, k / 4 / a.width, k % 4, (double)a.rgba[k],
                         (double)b.rgba[k]);
        mem_free(a.rgba);
        mem_free(b.rgba);
    }
}

static void media_lie_one_before_the_other(void **state) {
    roil_effect *apart = load_text(*state, "row.lua", row),
                *one = load_text(*state, "sum.lua", sum);
    ok(roil_make_layer(apart, NULL));
    ok(roil_make_layer(one, NULL));
    ok(roil_prepare(apart, WIDTH, HEIGHT));
    ok(roil_prepare(one, WIDTH, HEIGHT));
    roil_view front = straight(), behind = front;
    for (int i = 0; i < 8; i++) behind.view[i] *= -1;
    behind.view[6] = front.view[6];
    expect_sum(apart, one, &front, 0.02f);
    expect_sum(apart, one, &behind, 0.02f);
    ok(roil_set(apart, "place", "-1.2")); // into the nearest
    ok(roil_set(one, "place", "-1.2"));
    expect_sum(apart, one, &front, 0.2f);
    roil_unload(apart);
    roil_unload(one);
}

static void pictures_are_read_without_waiting(void **state) {
    roil_effect *e = load_text(*state, "ball.lua", ball);
    float *all = mem_alloc(sizeof *all * 4 * WIDTH * HEIGHT);
    uint32_t width, height;
    ok(roil_prepare(e, WIDTH, HEIGHT));
    expect_error(roil_read_begin(e, NULL), "render a frame first");
    ok(roil_render(e, 0));
    roil_readback *first = roil_read_begin(e, NULL); // the scene-linear picture
    ok(first);
    ok(roil_render(e, 1));
    roil_read_size(first, &width, &height);
    assert_int_equal(width, WIDTH);
    assert_int_equal(height, HEIGHT);
    ok(roil_read_end(first, all));
    assert_true(all[4 * (12 * WIDTH + 16)] > 0.5f);
    roil_readback *second = roil_read_begin(e, NULL);
    ok(second);
    while (!roil_read_ready(second)) usleep(1000); // each look is an event of the device
    ok(roil_read_end(second, NULL));
    expect_error(roil_read_begin(e, "marc"), "did you mean 'march'");
    mem_free(all);
    roil_unload(e);
}

static void what_is_not_in_a_layer_is_said(void **state) {
    roil_effect *e = load_text(*state, "crowd.lua",
                               "local fx = effect { name = 'crowd' }\n"
                               "local b = sphere { radius = 1 }\n"
                               "local smoke = march { density = b }\n"
                               "local haze = march { name = 'haze', density = b * 0.1 }\n"
                               "local p = particles { count = 16, rate = 10, lifetime = 1 }\n"
                               "local sparks = splats { name = 'sparks', from = p }\n"
                               "fx.output = final { over { sparks, haze } }.color\n"
                               "return fx\n");
    test_listen(ROIL_WARNING);
    ok(roil_make_layer(e, &(roil_layer_desc){.source = "march"}));
    roil_set_log(NULL, NULL, ROIL_WARNING);
    assert_non_null(strstr(test_said,
                           "crowd.lua: a layer shows the medium of 'march' alone; it leaves "
                           "out 'haze', 'sparks'"));
    expect_error(roil_set_samples(e, 2, 0), "are not averaged");
    roil_unload(e);
    e = load_text(*state, "ball.lua", ball);
    test_listen(ROIL_WARNING);
    ok(roil_make_layer(e, NULL));
    roil_set_log(NULL, NULL, ROIL_WARNING);
    assert_string_equal(test_said, "");
    roil_unload(e);
    e = load_text(*state, "ball.lua", ball);
    ok(roil_set_samples(e, 2, 0));
    expect_error(roil_make_layer(e, NULL), "are not averaged");
    roil_unload(e);
}

static void what_a_host_gets_wrong_is_said(void **state) {
    roil_effect *e = load_text(*state, "ball.lua", ball);
    roil_view v = straight();
    expect_error(roil_get_layer_image(e, ROIL_LAYER_COLOR), "roil_make_layer makes it one");
    expect_error(roil_make_layer(e, &(roil_layer_desc){.source = "smke"}),
                 "no pass march is called 'smke'; there are: march");
    ok(roil_make_layer(e, NULL));
    expect_error(roil_make_layer(e, NULL), "is a layer already");
    v.projection[11] = 0;
    v.projection[15] = 1;
    expect_error(roil_set_view(e, &v), "is no perspective");
    v = straight();
    v.view[5] = NAN;
    expect_error(roil_set_view(e, &v), "not finite");
    v = straight();
    memset(v.view, 0, sizeof v.view);
    expect_error(roil_set_view(e, &v), "has no inverse");
    expect_error(roil_set_lights(e, &(roil_lights){.sun = &(roil_sun){.angle = 1}}),
                 "has no length");
    roil_unload(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(cameras_of_every_kind_see_the_same),
        cmocka_unit_test(a_part_of_a_picture_is_seen_by_an_oblique_projection),
        cmocka_unit_test(jitter_moves_the_picture),
        cmocka_unit_test(depth_is_that_of_the_medium),
        cmocka_unit_test(motion_tells_where_things_were),
        cmocka_unit_test(motion_has_that_of_the_medium),
        cmocka_unit_test(lights_are_those_of_the_host),
        cmocka_unit_test(media_lie_one_before_the_other),
        cmocka_unit_test(pictures_are_read_without_waiting),
        cmocka_unit_test(what_is_not_in_a_layer_is_said),
        cmocka_unit_test(what_a_host_gets_wrong_is_said),
    };
    return test_run(tests);
}
