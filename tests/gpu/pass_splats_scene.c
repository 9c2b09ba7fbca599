// Splats among other things: surfaces, smoke, light; and what pictures and motion make of them.
#include "splats_test.h"

enum { MIDDLE = SIDE / 2 };

// One of half a metre.
static void open_one(spots *s, gpu *device) {
    spots_open(s, device, 1);
    spots_field(s, "size", number(&s->w, 0.5f));
}

// The picture's sum of a channel, of a particle there.
static double draw_sum(spots *s, spot one, int channel) {
    float *pixels = spots_draw(s, &one);
    double sum = sum_of(pixels, channel);
    mem_free(pixels);
    return sum;
}

static double seen_before_wall(gpu *device, float size, float away, float soften) {
    spots s;
    spots_open(&s, device, 1);
    spots_field(&s, "size", number(&s.w, size));
    spots_field(&s, "color", triple(&s.w, 100, 100, 100));
    spots_set(&s, "soften", soften);
    if (away > 0) spots_wall(&s, away);
    spots_build(&s);
    double sum = draw_sum(&s, (spot){.age = 0}, 0);
    spots_close(&s);
    return sum;
}

static void surfaces_hide_what_is_behind(void **state) {
    static const float sizes[] = {0.5f, 0.02f}; // listed, and added to pixels
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        double free = seen_before_wall(*state, sizes[i], 0, 0);
        assert_true(free > 1);
        assert_true(seen_before_wall(*state, sizes[i], 4.9f, 0) == 0);
        is_near(seen_before_wall(*state, sizes[i], 5.1f, 0), free, 1e-3 * free, "before a wall");
        is_near(seen_before_wall(*state, sizes[i], 5.1f, 0.4f), free / 4, 5e-3 * free, "soft");
    }
}

// Light without opacity is scaled up, too.
static void half_the_resolution_keeps_the_light(void **state) {
    spots s;
    open_one(&s, *state);
    gpu_test_ok(pass_set_scale(s.splats, 0.5f));
    gpu_test_ok(pass_declare(s.splats));
    pass *back = world_add(&s.w, NULL, "even.comp", "back");
    gpu_test_ok(pass_set_uniform(back, "tint", triple(&s.w, 0, 0, 0)) && pass_declare(back));
    pass *over = world_add(&s.w, "over", NULL, "over");
    gpu_test_ok(pass_set_image(over, "volume", pass_output(s.splats, "image")));
    gpu_test_ok(pass_set_image(over, "source", pass_output(back, "color")));
    gpu_test_ok(pass_declare(over));
    world_render(&s.w, SIDE, SIDE, pass_output(over, "color"));
    s.w.host.hold = true;
    spot one = {.age = 0};
    float *pixels = spots_draw_other(&s, &one, pass_output(over, "color"));
    double wanted = 3.14159265 / 3 * 8 * 8;
    is_near(sum_of(pixels, 0), wanted, 0.03 * wanted, "light");
    mem_free(pixels);
    spots_close(&s);
}

// ---- pictures ---------------------------------------------------------------------------------

static void open_pictured(spots *s, gpu *device, float columns, float rows) {
    open_one(s, device);
    pass *cells = world_add(&s->w, NULL, "four_cells.comp", "cells");
    gpu_test_ok(pass_declare(cells));
    gpu_test_ok(pass_set_image(s->splats, "sprite", pass_output(cells, "color")));
    const field *size = field_constant(&s->w.memory, 2, (float[4]){columns, rows});
    gpu_test_ok(pass_set_uniform(s->splats, "flipbook", size));
}

static void a_flipbook_goes_with_age(void **state) {
    spots s;
    open_pictured(&s, *state, 2, 2);
    spots_build(&s);
    for (int i = 0; i < 4; i++) {
        spot one = {.age = 2.5f * (float)i + 1, .lifetime = 10};
        float *pixels = spots_draw(&s, &one);
        for (int k = 0; k < 3; k++)
            if (i == k)
                is_near((double)pixel_at(pixels, MIDDLE, MIDDLE)[k], 64 / (64 + 2.25), 0.02,
                        "cell");
            else
                assert_true(sum_of(pixels, k) == 0);
        mem_free(pixels);
    }
    spots_close(&s);
}

// Red is at the top left; turned by a quarter to the left it is at the bottom left.
static void a_picture_turns(void **state) {
    for (int turned = 0; turned < 2; turned++) {
        spots s;
        open_pictured(&s, *state, 1, 1);
        spots_field(&s, "angle", number(&s.w, turned ? 90 : 0));
        spots_build(&s);
        spot one = {.age = 0};
        float *pixels = spots_draw(&s, &one);
        int x = MIDDLE - 4, top = MIDDLE - 4, bottom = MIDDLE + 3;
        const float *red = pixel_at(pixels, x, turned ? bottom : top);
        const float *green = pixel_at(pixels, turned ? x : MIDDLE + 3, top);
        assert_true(red[0] > 0.9f && red[1] < 0.01f);
        assert_true(green[1] > 0.9f && green[0] < 0.01f);
        mem_free(pixels);
        spots_close(&s);
    }
}

// ---- streaks ----------------------------------------------------------------------------------

// Columns with light in them; and the first of these.
static int lit_columns(const float *pixels, int *first) {
    int count = 0;
    *first = SIDE;
    for (int x = SIDE - 1; x >= 0; x--) {
        float sum = 0;
        for (int y = 0; y < SIDE; y++) sum += pixel_at(pixels, x, y)[0];
        if (sum <= 0.01f) continue;
        count++;
        *first = x;
    }
    return count;
}

// Backwards along its way, as long as that, and of as much light as one that stands still.
static void a_streak_is_as_long_as_its_way(void **state) {
    static const float sizes[] = {0.5f, 0.05f}, times[] = {0.1f, 0.4f};
    for (int i = 0; i < 4; i++) {
        float size = sizes[i / 2], time = times[i % 2];
        spots s;
        spots_open(&s, *state, 1);
        spots_field(&s, "size", number(&s.w, size));
        spots_field(&s, "color", triple(&s.w, 100, 100, 100));
        spots_set(&s, "streak", time);
        spots_build(&s);
        double still = draw_sum(&s, (spot){.age = 0}, 0);
        spot one = {.at = {0.5f, 0, 0}, .moves = {2, 0, 0}};
        float *pixels = spots_draw(&s, &one);
        is_near(sum_of(pixels, 0), still, 0.04 * still, "light");
        int first, count = lit_columns(pixels, &first);
        double way = 2 * (double)time * METRE, width = (double)size * METRE;
        is_near(count, way + width, 3.1, "length");
        is_near(first + 0.5 * count, MIDDLE + METRE / 2 - way / 2, 1.1, "middle");
        mem_free(pixels);
        spots_close(&s);
    }
}

// ---- light ------------------------------------------------------------------------------------

static pass *add_smoke(spots *s) {
    pass *p = world_add(&s->w, "lighting", NULL, "lighting");
    gpu_test_ok(pass_set_field(p, "density", block(&s->w, 1, 1)));
    gpu_test_ok(pass_set_option(p, "fire_lights", "0"));
    gpu_test_ok(pass_set_option(p, "shadow_resolution", "32"));
    gpu_test_ok(pass_set_uniform(p, "extinction", triple(&s->w, 1, 0.5f, 0)));
    gpu_test_ok(pass_set_uniform(p, "albedo", triple(&s->w, 1, 1, 1)));
    gpu_test_ok(pass_declare(p));
    return p;
}

// The sun stands overhead: light comes down through a metre of smoke to a particle in its middle.
static void smoke_shadows_a_lit_particle(void **state) {
    double light[2][3];
    for (int smoke = 0; smoke < 2; smoke++) {
        spots s;
        open_one(&s, *state);
        s.w.scene.sun.strength = number(&s.w, 100);
        s.w.scene.sun.elevation = number(&s.w, 90);
        gpu_test_ok(pass_set_option(s.splats, "lit", "on"));
        spots_set(&s, "view_steps", 0);
        if (smoke) {
            pass *lighting = add_smoke(&s);
            graph_image lights = pass_output(lighting, "lights");
            gpu_test_ok(pass_set_image(s.splats, "lights", lights));
            gpu_test_ok(pass_set_image(s.splats, "shadow", pass_output(lighting, "shadow")));
        }
        spots_build(&s);
        spot one = {.age = 0};
        float *pixels = spots_draw(&s, &one);
        for (int k = 0; k < 3; k++) light[smoke][k] = sum_of(pixels, k);
        mem_free(pixels);
        spots_close(&s);
    }
    // A quarter of the sphere to the side, of Henyey and Greenstein's with g = 0.2.
    double phase = (1 - 0.04) / (12.5663706 * pow(1.04, 1.5));
    double area = 3.14159265 / 3 * 8 * 8;
    is_near(light[0][0], 100 * phase * area, 0.01 * 100 * phase * area, "in the open");
    for (int k = 0; k < 3; k++)
        is_near(light[1][k] / light[0][k], exp(-1 + 0.5 * k), 0.02, "in smoke");
}

static void smoke_before_a_particle_dims_it(void **state) {
    double light[2][3];
    for (int smoke = 0; smoke < 2; smoke++) {
        spots s;
        open_one(&s, *state);
        if (smoke) pass_add_source(s.splats, add_smoke(&s));
        spots_build(&s);
        spot one = {.age = 0};
        float *pixels = spots_draw(&s, &one);
        for (int k = 0; k < 3; k++) light[smoke][k] = sum_of(pixels, k);
        mem_free(pixels);
        spots_close(&s);
    }
    for (int k = 0; k < 3; k++)
        is_near(light[1][k] / light[0][k], exp(-1 + 0.5 * k), 0.03, "behind smoke");
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_hide_what_is_behind),
        cmocka_unit_test(half_the_resolution_keeps_the_light),
        cmocka_unit_test(a_flipbook_goes_with_age),
        cmocka_unit_test(a_picture_turns),
        cmocka_unit_test(a_streak_is_as_long_as_its_way),
        cmocka_unit_test(smoke_shadows_a_lit_particle),
        cmocka_unit_test(smoke_before_a_particle_dims_it),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
