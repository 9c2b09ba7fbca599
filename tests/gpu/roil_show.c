// A window's picture without a window: the effect in its place, and triangles over it.
#include "media/png.h"
#include "pass/blue_noise.h"
#include "roil/view.h"
#include "roil_test.h"

// Colours over the whole range of display light, alpha below one, its first column dark.
static const char *const ramp_shader =
    "// Every step from dark to bright.\n"
    "\n"
    "writeonly uniform image2D color; //= output rgba16f : the ramp\n"
    "void main() {\n"
    "    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);\n"
    "    if (any(greaterThanEqual(pixel, size))) return;\n"
    "    float at = float(pixel.x + size.x * pixel.y) / float(size.x * size.y);\n"
    "    imageStore(color, pixel, vec4(at, at * at, 1.2 * at * at * at - 0.1, 0.5));\n"
    "}\n";

static const char *const flat_shader =
    "// One colour.\n"
    "\n"
    "writeonly uniform image2D color; //= output rgba16f : the picture\n"
    "void main() { imageStore(color, ivec2(gl_GlobalInvocationID.xy), vec4(0.4, 0.25, 1.0, 1.0)); "
    "}\n";

static const float gray[3] = {0.2f, 0.4f, 0.6f}; // 51 102 153

static roil_effect *open_effect(roil *r, const char *shader, uint32_t width, uint32_t height) {
    char path[512];
    write_text("show.comp", shader, path);
    roil_effect *e = load_text(r, "show.lua",
                               "local fx = effect { name = 'show', fps = 24, frames = 9 }\n"
                               "fx.output = shader { 'show.comp' }.color\n"
                               "return fx\n");
    ok(roil_prepare(e, width, height));
    ok(roil_render(e, 1));
    return e;
}

// Shows what `more` says on a picture of that size, and reads it back; free with mem_free.
static uint8_t *show(roil *r, uint32_t width, uint32_t height, const roil_picture *more) {
    roil_picture p = *more;
    p.width = width;
    p.height = height;
    memcpy(p.background, gray, sizeof gray);
    uint8_t *pixels = mem_alloc((size_t)width * height * 4);
    ok(roil_show(r, &p));
    ok(roil_read_shown(r, pixels));
    return pixels;
}

// ---- the effect -------------------------------------------------------------------------------

static void nothing_has_been_shown_at_first(void **state) {
    uint8_t pixel[4];
    expect_error(roil_read_shown(*state, pixel), "nothing has been shown");
    ok(roil_show(*state, &(roil_picture){.width = 0, .height = 9}));
    expect_error(roil_read_shown(*state, pixel), "nothing has been shown");
}

// The pixels live as long as `memory`.
static const uint8_t *read_file(roil_effect *e, arena *memory) {
    char path[512];
    png_image file;
    write_text("show.png", "", path);
    ok(roil_save(e, path, NULL));
    ok(png_read(path, NULL, memory, &file));
    return file.pixels;
}

static void the_picture_is_that_of_a_file(void **state) {
    enum { W = 256, H = 128 };
    arena memory = {0};
    roil_effect *e = open_effect(*state, ramp_shader, W, H);
    const uint8_t *wanted = read_file(e, &memory);
    uint8_t *whole = show(*state, W, H, &(roil_picture){.effect = e, .view = {0, 0, W, H}});
    assert_memory_equal(whole, wanted, 4 * W * H);
    uint8_t *inside =
        show(*state, 2 * W, 2 * H, &(roil_picture){.effect = e, .view = {7, 11, 7 + W, 11 + H}});
    for (uint32_t y = 0; y < H; y++)
        assert_memory_equal(inside + 4 * ((y + 11) * 2 * W + 7), wanted + 4 * y * W, 4 * W);
    expect_pixel(inside, 2 * W, 6, 11, 51, 102, 153, 0);
    expect_pixel(inside, 2 * W, 7 + W, 11, 51, 102, 153, 0);
    expect_pixel(inside, 2 * W, 7, 10, 51, 102, 153, 0);
    expect_pixel(inside, 2 * W, 7, 11 + H, 51, 102, 153, 0);
    mem_free(whole);
    mem_free(inside);
    arena_free(&memory);
    roil_unload(e);
}

// The mean of a channel in a square as large as the noise.
static double mean_of(const uint8_t *pixels, uint32_t width, uint32_t left, int channel) {
    double sum = 0;
    for (uint32_t y = 0; y < BLUE_NOISE_SIZE; y++)
        for (uint32_t x = 0; x < BLUE_NOISE_SIZE; x++)
            sum += pixels[4 * (y * width + left + x) + (uint32_t)channel];
    return sum / (BLUE_NOISE_SIZE * BLUE_NOISE_SIZE);
}

// What lies between two codes is shown as the mean of both, at every size, and stands still.
static void dark_skies_have_no_bands(void **state) {
    enum { W = 4 * BLUE_NOISE_SIZE, H = BLUE_NOISE_SIZE };
    static const char sky[] =
        "// Dark grey in four steps, less than a code of 8 bits from each to the next.\n"
        "\n"
        "writeonly uniform image2D color; //= output rgba16f : the picture\n"
        "void main() {\n"
        "    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);\n"
        "    float step = float(4 * pixel.x / size.x);\n"
        "    imageStore(color, pixel, vec4(vec3(0.0042 + 0.0001 * step), 1.0));\n"
        "}\n";
    for (uint32_t scale = 1; scale <= 2; scale++) {
        roil_effect *e = open_effect(*state, sky, W / scale, H / scale);
        const roil_picture p = {.effect = e, .view = {0, 0, W, H}};
        uint8_t *first = show(*state, W, H, &p), *second = show(*state, W, H, &p);
        assert_memory_equal(first, second, 4 * W * H);
        for (int c = 0; c < 3; c++) {
            // Away from where a step meets the next, which are mixed when the picture is enlarged.
            double low = mean_of(first, W, 0, c), high = mean_of(first, W, W - BLUE_NOISE_SIZE, c);
            float wanted[2] = {255 * srgb_exact(0.0042f), 255 * srgb_exact(0.0045f)};
            if (fabs(low - (double)wanted[0]) > 0.1 || fabs(high - (double)wanted[1]) > 0.1)
                fail_msg("means %g and %g, not %g and %g", low, high, (double)wanted[0],
                         (double)wanted[1]);
        }
        mem_free(first);
        mem_free(second);
        roil_unload(e);
    }
}

// The rectangle that is not background.
static void expect_place(const uint8_t *pixels, uint32_t width, uint32_t height, uint32_t left,
                         uint32_t top, uint32_t right, uint32_t bottom) {
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            bool inside = x >= left && x < right && y >= top && y < bottom;
            if (inside)
                expect_pixel(pixels, width, x, y, 170, 137, 255, 1); // dithered
            else
                expect_pixel(pixels, width, x, y, 51, 102, 153, 0);
        }
}

static void the_picture_keeps_its_aspect_in_the_middle(void **state) {
    static const struct {
        float view[4];
        uint32_t place[4];
    } cases[] = {
        {{0, 0, 96, 96}, {0, 24, 96, 72}},     // bars above and below, magnified
        {{0, 0, 96, 24}, {24, 0, 72, 24}},     // at the sides, smaller
        {{10, 20, 74, 52}, {10, 20, 74, 52}},  // as it is
        {{-32, 0, 32, 32}, {0, 0, 32, 32}},    // half outside
        {{80, 40, 80, 60}, {0, 0, 0, 0}},      // no room
        {{-1e30f, 0, 1e30f, 50}, {0, 0, 0, 0}} // nonsense
    };
    roil_effect *e = open_effect(*state, flat_shader, 64, 32);
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        roil_picture p = {.effect = e};
        memcpy(p.view, cases[i].view, sizeof p.view);
        uint8_t *pixels = show(*state, 96, 96, &p);
        const uint32_t *at = cases[i].place;
        expect_place(pixels, 96, 96, at[0], at[1], at[2], at[3]);
        mem_free(pixels);
    }
    roil_unload(e);
}

static void an_effect_without_a_frame_shows_nothing(void **state) {
    roil_effect *e = open_effect(*state, flat_shader, 16, 16);
    ok(roil_prepare(e, 32, 16));
    uint8_t *pixels = show(*state, 32, 16, &(roil_picture){.effect = e, .view = {0, 0, 32, 16}});
    expect_place(pixels, 32, 16, 0, 0, 0, 0);
    mem_free(pixels);
    ok(roil_render(e, 1));
    pixels = show(*state, 32, 16, &(roil_picture){.effect = e, .view = {0, 0, 32, 16}});
    expect_place(pixels, 32, 16, 0, 0, 32, 16);
    mem_free(pixels);
    roil_unload(e);
}

// While an effect loads there is no picture, and the cores are busy.
static void nothing_is_drawn_once(void **state) {
    roil_picture none = {.width = 96, .height = 96, .view = {0, 0, 96, 96}};
    ok(roil_show(*state, &none));
    const view *v = view_get(*state);
    const uint64_t made = v->made.pictures;
    ok(roil_show(*state, &none));
    assert_int_equal(v->made.pictures, made);
    assert_int_equal(v->redraw.area_count, 0);
    none.view[2] = 48; // it has no picture there either
    none.background[0] = 0.5f;
    ok(roil_show(*state, &none));
    assert_int_equal(v->redraw.area_count, 1);
}

static void the_canvas_follows_the_window(void **state) {
    static const uint32_t sizes[][2] = {{1, 1}, {300, 7}, {7, 300}, {64, 64}, {64, 64}, {1, 1}};
    roil_effect *e = open_effect(*state, flat_shader, 8, 8);
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        uint32_t w = sizes[i][0], h = sizes[i][1], side = w < h ? w : h;
        uint8_t *pixels = show(
            *state, w, h, &(roil_picture){.effect = e, .view = {0, 0, (float)side, (float)side}});
        expect_place(pixels, w, h, 0, 0, side, side);
        mem_free(pixels);
    }
    roil_unload(e);
}

// ---- the overlay ------------------------------------------------------------------------------

enum { N = 32 };
static const float everywhere[4] = {0, 0, N, N};

// A rectangle as two triangles: 4 vertices, the texture's corners at its corners.
static void quad(roil_vertex out[4], float left, float top, float right, float bottom,
                 uint32_t color) {
    for (int i = 0; i < 4; i++)
        out[i] = (roil_vertex){.x = i & 1 ? right : left,
                               .y = i & 2 ? bottom : top,
                               .u = (float)(i & 1),
                               .v = (float)(i >> 1),
                               .color = color};
}

static const uint32_t quads[12] = {0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7};

static uint8_t *show_draws(roil *r, const roil_vertex *vertices, const roil_draw *draws,
                           size_t count) {
    return show(r, N, N,
                &(roil_picture){.vertices = vertices,
                                .vertex_count = 8,
                                .indices = quads,
                                .index_count = 12,
                                .draws = draws,
                                .draw_count = count});
}

static roil_draw draw_of(uint32_t quad_index, const roil_texture *texture, const float clip[4]) {
    roil_draw d = {.texture = texture, .first = 6 * quad_index, .count = 6};
    memcpy(d.clip, clip, sizeof d.clip);
    return d;
}

static void triangles_cover_their_pixels_in_order(void **state) {
    roil_vertex v[8];
    quad(v, 4, 8, 20, 24, 0xff0000ff);       // red
    quad(v + 4, 12, 16, 28, 30, 0xff00ff00); // green, later
    const roil_draw draws[] = {draw_of(0, NULL, everywhere), draw_of(1, NULL, everywhere)};
    uint8_t *pixels = show_draws(*state, v, draws, 2);
    for (uint32_t y = 0; y < N; y++)
        for (uint32_t x = 0; x < N; x++) {
            if (x >= 12 && x < 28 && y >= 16 && y < 30)
                expect_pixel(pixels, N, x, y, 0, 255, 0, 0);
            else if (x >= 4 && x < 20 && y >= 8 && y < 24)
                expect_pixel(pixels, N, x, y, 255, 0, 0, 0);
            else
                expect_pixel(pixels, N, x, y, 51, 102, 153, 0);
        }
    mem_free(pixels);
}

static void colours_are_mixed_as_they_are_encoded(void **state) {
    roil_vertex v[8];
    quad(v, 0, 0, N, N, 0x40c08020); // 32 128 192, a quarter opaque
    quad(v + 4, 0, 0, N / 2, N, 0x80ffffff);
    const roil_draw draws[] = {draw_of(0, NULL, everywhere), draw_of(1, NULL, everywhere)};
    uint8_t *pixels = show_draws(*state, v, draws, 2);
    float quarter = 64 / 255.0f, half = 128 / 255.0f;
    int below[3] = {51, 102, 153}, color[3] = {32, 128, 192}, once[3], twice[3];
    for (int i = 0; i < 3; i++) {
        float mixed = quarter * (float)color[i] + (1 - quarter) * (float)below[i];
        once[i] = (int)lrintf(mixed);
        twice[i] = (int)lrintf(255 * half + (1 - half) * mixed);
    }
    expect_pixel(pixels, N, N - 1, 5, once[0], once[1], once[2], 1);
    expect_pixel(pixels, N, 3, 5, twice[0], twice[1], twice[2], 1);
    mem_free(pixels);
}

static void clips_cut_and_empty_ones_draw_nothing(void **state) {
    static const struct {
        float clip[4];
        uint32_t place[4];
    } cases[] = {
        {{5, 6, 17, 20}, {5, 6, 17, 20}},     {{-9, -9, 3, 4}, {0, 0, 3, 4}},
        {{30, 29, 99, 1e9f}, {30, 29, N, N}}, {{9, 9, 9, 20}, {0, 0, 0, 0}},
        {{20, 9, 9, 20}, {0, 0, 0, 0}},       {{N, 0, N + 9, N}, {0, 0, 0, 0}},
        {{-9, 0, 0, N}, {0, 0, 0, 0}},
    };
    roil_vertex v[8];
    quad(v, 0, 0, N, N, 0xffff89aa); // what expect_place takes for the effect
    quad(v + 4, 0, 0, 0, 0, 0);
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const roil_draw draw = draw_of(0, NULL, cases[i].clip);
        uint8_t *pixels = show_draws(*state, v, &draw, 1);
        const uint32_t *at = cases[i].place;
        expect_place(pixels, N, N, at[0], at[1], at[2], at[3]);
        mem_free(pixels);
    }
}

static void textures_are_multiplied_by_the_colour(void **state) {
    static const uint8_t texels[2][2][4] = {{{255, 0, 0, 255}, {0, 255, 0, 255}},
                                            {{0, 0, 255, 255}, {255, 255, 255, 0}}};
    roil_texture *t = roil_texture_create(*state, 2, 2, &texels[0][0][0]);
    roil_texture *clear = roil_texture_create(*state, 3, 5, NULL);
    ok(t && clear);
    roil_vertex v[8];
    quad(v, 0, 0, N, N, 0xff80c0ff); // 255 192 128
    quad(v + 4, 0, 0, N, N, 0xffffffff);
    const roil_draw draws[] = {draw_of(0, t, everywhere), draw_of(1, clear, everywhere)};
    uint8_t *pixels = show_draws(*state, v, draws, 2);
    expect_pixel(pixels, N, 0, 0, 255, 0, 0, 0);
    expect_pixel(pixels, N, N - 1, 0, 0, 192, 0, 0);
    expect_pixel(pixels, N, 0, N - 1, 0, 0, 128, 0);
    expect_pixel(pixels, N, N - 1, N - 1, 51, 102, 153, 0);
    expect_pixel(pixels, N, N / 2, 0, 120, 102, 0, 1); // 15 parts red, 17 green
    mem_free(pixels);
    roil_texture_destroy(*state, t);
    roil_texture_destroy(*state, clear);
    roil_texture_destroy(*state, NULL);
}

static void interfaces_grow_and_shrink(void **state) {
    enum { MOST = 30000 };
    roil_vertex *v = mem_alloc(4 * MOST * sizeof *v);
    uint32_t *indices = mem_alloc(6 * MOST * sizeof *indices);
    for (uint32_t i = 0; i < MOST; i++) { // all alike but for the last
        quad(v + 4 * i, 0, 0, N, N, 0xff000000 | i % 256);
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 4 * i + quads[k];
    }
    static const uint32_t counts[] = {1, 900, MOST, 7};
    for (size_t i = 0; i < COUNT_OF(counts); i++) {
        roil_draw draw = {.first = 6 * (counts[i] - 1), .count = 6, .clip = {0, 0, N, N}};
        uint8_t *pixels = show(*state, N, N,
                               &(roil_picture){.vertices = v,
                                               .vertex_count = 4 * counts[i],
                                               .indices = indices,
                                               .index_count = 6 * counts[i],
                                               .draws = &draw,
                                               .draw_count = 1});
        expect_pixel(pixels, N, 9, 9, (int)((counts[i] - 1) % 256), 0, 0, 0);
        mem_free(pixels);
    }
    mem_free(v);
    mem_free(indices);
}

// Half transparent quads, clipped, with and without a texture, over a picture: what is drawn only
// where something has changed is what is drawn anew as a whole.
static void what_changes_looks_as_if_drawn_anew(void **state) {
    enum { W = 400, H = 300, QUADS = 40, ROUNDS = 12 };
    roil *r = *state;
    roil_effect *e = open_effect(r, ramp_shader, 64, 32);
    roil_texture *t = roil_texture_create(r, 2, 2, (const uint8_t[16]){255, 90, 9, 200, 7, 7});
    static roil_vertex v[4 * QUADS];
    static uint32_t indices[6 * QUADS];
    static roil_draw draws[QUADS];
    roil_picture p = {.effect = e,
                      .view = {10, 10, 310, 170},
                      .vertices = v,
                      .indices = indices,
                      .draws = draws,
                      .vertex_count = COUNT_OF(v),
                      .index_count = COUNT_OF(indices),
                      .draw_count = QUADS};
    uint32_t random = 7;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        for (uint32_t i = 0; i < QUADS; i++) {
            random = random * 1664525 + 1013904223;
            if (round && random >> 28) continue; // most stay
            float x = (float)((random >> 8) % W) - 20.3f, y = (float)((random >> 18) % H) - 20.7f;
            float size = i % 8 ? 30 : 150;
            quad(v + 4 * i, x, y, x + size, y + size, random | 0x40000000);
            for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = quads[k] + 4 * i;
            draws[i] = (roil_draw){i % 3 ? NULL : t, 6 * i, 6, {x + 3, 0, W, y + 0.8f * size}};
        }
        if (round == 5) p.view[0] = 40;
        if (round == 7) ok(roil_render(e, 2));
        uint8_t *changed = show(r, W, H, &p);
        mem_free(show(r, W / 2, H, &p)); // of another size: nothing of before holds
        uint8_t *whole = show(r, W, H, &p);
        assert_memory_equal(changed, whole, 4 * W * H);
        mem_free(changed);
        mem_free(whole);
        if (round % 2) continue;
        changed = show(r, W, H, &p); // nothing has changed
        whole = show(r, W, H, &p);
        assert_memory_equal(changed, whole, 4 * W * H);
        mem_free(changed);
        mem_free(whole);
    }
    roil_texture_destroy(r, t);
    roil_unload(e);
}

static void wrong_indices_are_errors(void **state) {
    roil_vertex v[8];
    quad(v, 0, 0, N, N, 0xffffffff);
    roil_draw draw = draw_of(1, NULL, everywhere);
    roil_picture p = {.width = N,
                      .height = N,
                      .vertices = v,
                      .vertex_count = 7,
                      .indices = quads,
                      .index_count = 12,
                      .draws = &draw,
                      .draw_count = 1};
    expect_error(roil_show(*state, &p), "index 11 is vertex 7; there are 7");
    p.index_count = 11;
    expect_error(roil_show(*state, &p), "draw 0 has 6 indices from 6 on; there are 11");
    draw.first = UINT32_MAX;
    expect_error(roil_show(*state, &p), "there are 11");
}

static void a_roil_without_device_shows_nothing(void **state) {
    (void)state;
    roil *r = roil_create(&(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .no_device = true});
    ok(r);
    expect_error(roil_show(r, &(roil_picture){.width = 8, .height = 8}), "no device");
    expect_error(roil_texture_create(r, 8, 8, NULL) != NULL, "no device");
    assert_false(roil_is_lost(r));
    assert_int_equal(roil_get_memory(r).device, 0);
    roil_destroy(r);
}

static void memory_in_use_is_counted(void **state) {
    assert_false(roil_is_lost(*state));
    mem_free(show(*state, N, N, &(roil_picture){0})); // what was let go before is gone now
    roil_memory before = roil_get_memory(*state);
    roil_texture *t = roil_texture_create(*state, 512, 512, NULL);
    ok(t);
    roil_memory after = roil_get_memory(*state);
    assert_true(after.device > before.device + 1000000); // of 1048576; reading back was freed
    assert_true(after.reserved >= after.device);
    roil_texture_destroy(*state, t);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_has_been_shown_at_first),
        cmocka_unit_test(the_picture_is_that_of_a_file),
        cmocka_unit_test(dark_skies_have_no_bands),
        cmocka_unit_test(the_picture_keeps_its_aspect_in_the_middle),
        cmocka_unit_test(an_effect_without_a_frame_shows_nothing),
        cmocka_unit_test(nothing_is_drawn_once),
        cmocka_unit_test(the_canvas_follows_the_window),
        cmocka_unit_test(triangles_cover_their_pixels_in_order),
        cmocka_unit_test(colours_are_mixed_as_they_are_encoded),
        cmocka_unit_test(clips_cut_and_empty_ones_draw_nothing),
        cmocka_unit_test(textures_are_multiplied_by_the_colour),
        cmocka_unit_test(interfaces_grow_and_shrink),
        cmocka_unit_test(what_changes_looks_as_if_drawn_anew),
        cmocka_unit_test(wrong_indices_are_errors),
        cmocka_unit_test(a_roil_without_device_shows_nothing),
        cmocka_unit_test(memory_in_use_is_counted),
    };
    return test_run(tests);
}
