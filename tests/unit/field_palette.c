// Palettes: stops, edges, spaces, keys over time, black bodies, colours as text.
#include "field_build.h"

#include "field/color.h"
#include "field/palette.h"

static const palette *palette_of(palette_desc desc) {
    const palette *p = palette_create(build_memory(), &desc);
    if (!p) fail_msg("%s", err_get());
    return p;
}

static const palette *two_stops(palette_space space) {
    static const palette_stop stops[] = {{0, {1, 0, 0, 0}}, {2, {0, 0, 4, 1}}};
    static const palette_key key = {0, stops, 2};
    return palette_of((palette_desc){.space = space, .keys = &key, .key_count = 1});
}

static void color_at(const palette *p, double time, float position, float out[4]) {
    palette_eval(p, time, position, out);
}

static void ends_are_the_stops_and_hold(void **state) {
    (void)state;
    float c[4], low, high;
    const palette *p = two_stops(PALETTE_LINEAR);
    palette_range(p, &low, &high);
    assert_true(low == 0 && high == 2);
    for (float x = -5; x <= 0; x += 5) {
        color_at(p, 0, x, c);
        assert_true(fabsf(c[0] - 1) < 2e-3f && c[2] < 5e-3f && c[3] < 2e-3f);
    }
    for (float x = 2; x < 100; x *= 5) {
        color_at(p, 0, x, c);
        assert_true(c[0] < 2e-3f && fabsf(c[2] - 4) < 5e-3f && fabsf(c[3] - 1) < 2e-3f);
    }
    color_at(p, 0, NAN, c);
    assert_true(isfinite(c[0]));
}

static void stops_mix_linearly(void **state) {
    (void)state;
    float c[4];
    color_at(two_stops(PALETTE_LINEAR), 0, 0.5f, c);
    assert_true(fabsf(c[0] - 0.75f) < 2e-3f && fabsf(c[2] - 1) < 3e-3f &&
                fabsf(c[3] - 0.25f) < 2e-3f);
}

static void oklab_mixes_by_lightness(void **state) {
    (void)state;
    static const palette_stop stops[] = {{0, {0, 0, 0, 1}}, {1, {1, 1, 1, 1}}};
    static const palette_key key = {0, stops, 2};
    const palette *p =
        palette_of((palette_desc){.space = PALETTE_OKLAB, .keys = &key, .key_count = 1});
    float c[4];
    color_at(p, 0, 0.5f, c); // half the lightness is an eighth of the light
    for (int i = 0; i < 3; i++) assert_true(fabsf(c[i] - 0.125f) < 2e-3f);
    color_at(p, 0, 1, c);
    for (int i = 0; i < 3; i++) assert_true(fabsf(c[i] - 1) < 5e-3f);
}

static void oklab_goes_there_and_back(void **state) {
    (void)state;
    uint32_t seed = 1;
    for (int i = 0; i < 1000; i++) {
        float c[3] = {random_float(&seed) * 10, random_float(&seed), random_float(&seed)}, lab[3],
              back[3];
        color_to_oklab(c, lab);
        color_from_oklab(lab, back);
        for (int k = 0; k < 3; k++) assert_true(fabsf(back[k] - c[k]) < 1e-3f);
    }
    float lab[3]; // the reference implementation's white and red
    color_to_oklab((const float[3]){1, 1, 1}, lab);
    assert_true(fabsf(lab[0] - 1) < 1e-4f && fabsf(lab[1]) < 1e-4f && fabsf(lab[2]) < 1e-4f);
    color_to_oklab((const float[3]){1, 0, 0}, lab);
    assert_true(fabsf(lab[0] - 0.62796f) < 1e-3f && fabsf(lab[1] - 0.22486f) < 1e-3f &&
                fabsf(lab[2] - 0.12585f) < 1e-3f);
}

static void equal_positions_make_a_hard_edge(void **state) {
    (void)state;
    static const palette_stop stops[] = {
        {0, {0, 0, 0, 1}}, {0.5f, {0, 0, 0, 1}}, {0.5f, {1, 1, 1, 1}}, {1, {1, 1, 1, 1}}};
    static const palette_key key = {0, stops, 4};
    const palette *p = palette_of((palette_desc){.keys = &key, .key_count = 1});
    float c[4];
    color_at(p, 0, 0.5f - 1.0f / PALETTE_SIZE, c);
    assert_true(c[0] == 0);
    color_at(p, 0, 0.5f + 1.0f / PALETTE_SIZE, c);
    assert_true(c[0] == 1);
}

static void baked_texels_are_what_is_evaluated(void **state) {
    (void)state;
    const palette *p = two_stops(PALETTE_LINEAR);
    uint16_t texels[PALETTE_SIZE * 4];
    palette_bake(p, 0, texels);
    for (int i = 0; i < PALETTE_SIZE; i++) {
        float c[4];
        color_at(p, 0, 2 * ((float)i + 0.5f) / PALETTE_SIZE, c);
        for (int k = 0; k < 4; k++)
            assert_true(fabsf(c[k] - half_to_float(texels[4 * i + k])) < 1e-3f);
    }
}

static void a_range_wider_than_the_stops_holds_them(void **state) {
    (void)state;
    static const palette_stop stops[] = {{1, {1, 0, 0, 1}}, {2, {0, 1, 0, 1}}};
    static const palette_key key = {0, stops, 2};
    const palette *p = palette_of((palette_desc){.min = 0, .max = 4, .keys = &key, .key_count = 1});
    float c[4], low, high;
    palette_range(p, &low, &high);
    assert_true(low == 0 && high == 4);
    color_at(p, 0, 0.5f, c);
    assert_true(c[0] == 1);
    color_at(p, 0, 3, c);
    assert_true(c[1] == 1);
}

static void keys_mix_over_time(void **state) {
    (void)state;
    static const palette_stop cold[] = {{0, {0, 0, 0, 1}}, {1, {0, 0, 2, 1}}},
                              hot[] = {{0, {0, 0, 0, 1}}, {1, {4, 0, 0, 1}}};
    static const palette_key keys[] = {{1, cold, 2}, {3, hot, 2}};
    const palette *p = palette_of((palette_desc){.keys = keys, .key_count = 2});
    assert_true(palette_is_animated(p));
    assert_false(palette_is_animated(two_stops(PALETTE_LINEAR)));
    float c[4];
    color_at(p, 0, 1, c); // before the first key
    assert_true(c[0] == 0 && fabsf(c[2] - 2) < 5e-3f);
    color_at(p, 1.5, 1, c);
    assert_true(fabsf(c[0] - 1) < 5e-3f && fabsf(c[2] - 1.5f) < 5e-3f);
    color_at(p, 9, 1, c);
    assert_true(fabsf(c[0] - 4) < 1e-2f && c[2] == 0);
}

// CIE 1931 chromaticities of black bodies from the literature.
static void black_bodies_have_their_chromaticities(void **state) {
    (void)state;
    static const struct {
        float kelvin, x, y;
    } known[] = {{1500, 0.5857f, 0.3931f}, {2856, 0.4476f, 0.4074f},  {4000, 0.3805f, 0.3768f},
                 {6500, 0.3135f, 0.3237f}, {10000, 0.2807f, 0.2884f}, {20000, 0.2578f, 0.2590f}};
    for (size_t i = 0; i < COUNT_OF(known); i++) {
        float c[3];
        palette_blackbody(known[i].kelvin, c);
        assert_true(fabsf(0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2] - 1) < 1e-3f);
        float x = 0.4124f * c[0] + 0.3576f * c[1] + 0.1805f * c[2];
        float y = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        float z = 0.0193f * c[0] + 0.1192f * c[1] + 0.9505f * c[2];
        if (known[i].kelvin < 2000) continue; // out of the gamut: clipped
        assert_true(fabsf(x / (x + y + z) - known[i].x) < 0.006f);
        assert_true(fabsf(y / (x + y + z) - known[i].y) < 0.006f);
    }
    float red[3], colder[3], blue[3];
    palette_blackbody(1000, red);
    assert_true(red[0] > red[1] && red[1] >= red[2] && red[2] == 0);
    palette_blackbody(-5, colder); // clamped
    assert_true(colder[0] > 4 && colder[1] < 0.1f);
    palette_blackbody(1e9f, blue);
    assert_true(blue[2] > blue[0]);
}

static void physical_black_bodies_shine_by_the_fourth_power(void **state) {
    (void)state;
    const palette *p = palette_of((palette_desc){
        .blackbody = true, .physical = true, .min = 1000, .max = 4000, .reference = 2000});
    const palette *plain = palette_of((palette_desc){.blackbody = true, .min = 1000, .max = 4000});
    for (float kelvin = 1200; kelvin < 4000; kelvin += 300) {
        float c[4], even[4];
        color_at(p, 0, kelvin, c);
        color_at(plain, 0, kelvin, even);
        float want = powf(kelvin / 2000, 4),
              luminance = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        assert_true(fabsf(luminance / want - 1) < 0.01f);
        assert_true(fabsf(0.2126f * even[0] + 0.7152f * even[1] + 0.0722f * even[2] - 1) < 0.01f);
        assert_true(c[3] == 1);
    }
}

static void refuses(palette_desc desc, const char *part) {
    err_clear();
    assert_null(palette_create(build_memory(), &desc));
    assert_error(part);
}

static void bad_stops_are_refused(void **state) {
    (void)state;
    static const palette_stop good[] = {{0, {0}}, {1, {1, 1, 1, 1}}},
                              falling[] = {{1, {0}}, {0, {0}}};
    static const palette_stop odd[] = {{0, {0}}, {1, {-1}}}, same[] = {{1, {0}}, {1, {1}}},
                              lost[] = {{NAN, {0}}, {1, {1}}};
#define REFUSE(STOPS, COUNT, PART)                                                                 \
    refuses((palette_desc){.keys = &(palette_key){0, STOPS, COUNT}, .key_count = 1}, PART)
    REFUSE(good, 1, "1 stop;");
    REFUSE(good, 0, "0 stops");
    REFUSE(good, 1000, "1000 stops");
    REFUSE(falling, 2, "stop 2 at 0 lies before stop 1 at 1");
    REFUSE(odd, 2, "stop 2 has a colour component of -1");
    REFUSE(same, 2, "must be greater");
    REFUSE(lost, 2, "no finite position");
    refuses((palette_desc){0}, "no stops");
    refuses((palette_desc){.blackbody = true, .min = 3000, .max = 1000}, "must be greater");
    palette_key twice[] = {{1, good, 2}, {1, good, 2}};
    refuses((palette_desc){.keys = twice, .key_count = 2}, "key 2 at 1 s");
    refuses((palette_desc){.keys = twice, .key_count = 1, .blackbody = true}, "black body");
    refuses((palette_desc){.keys = twice, .key_count = 65}, "65 keys");
}

static void colours_are_read_as_srgb(void **state) {
    (void)state;
    float c[4];
    assert_true(value_parse_color("#fff", c));
    for (int i = 0; i < 4; i++) assert_true(c[i] == 1);
    assert_true(value_parse_color("#80Ff0040", c));
    assert_true(fabsf(c[0] - 0.21586f) < 1e-4f && c[1] == 1 && c[2] == 0);
    assert_true(fabsf(c[3] - 64.0f / 255) < 1e-6f);
    assert_true(value_parse_color("#010101", c));
    assert_true(fabsf(c[0] - 1 / 255.0f / 12.92f) < 1e-7f && c[3] == 1);
    static const char *const bad[] = {"",        "#",      "fff",     "#ff", "#ffff",
                                      "#gggggg", "#12345", "#ff88 0", "red"};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        assert_false(value_parse_color(bad[i], c));
        assert_error("#rrggbb");
    }
}

// ---- replacing --------------------------------------------------------------------------------

static void replaced_palette_gives_the_new_colors(void **state) {
    (void)state;
    for (int space = 0; space < 2; space++) {
        palette *p = (palette *)(uintptr_t)two_stops((palette_space)space);
        static const palette_stop stops[] = {
            {1, {0, 2, 0, 1}}, {2, {0, 2, 0, 1}}, {5, {1, 1, 1, 1}}};
        const palette_desc desc = {
            .space = (palette_space)space, .keys = &(palette_key){0, stops, 3}, .key_count = 1};
        assert_int_equal(palette_version(p), 0);
        if (!palette_replace(p, &desc)) fail_msg("%s", err_get());
        assert_int_equal(palette_version(p), 1);
        float c[4], low, high;
        palette_range(p, &low, &high);
        assert_true(low == 1 && high == 5);
        color_at(p, 0, 1.5f, c);
        assert_true(c[0] < 2e-3f && fabsf(c[1] - 2) < 5e-3f);
        const palette_desc *got = palette_get_desc(p);
        assert_int_equal(got->keys[0].count, 3);
        assert_memory_equal(got->keys[0].stops, stops, sizeof stops); // linear, as given
    }
}

static void palette_is_restored_to_what_it_was_made_of(void **state) {
    (void)state;
    palette *body = (palette *)(uintptr_t)palette_of(
        (palette_desc){.blackbody = true, .min = 500, .max = 3000});
    const palette_desc original = *palette_get_desc(body);
    uint16_t before[PALETTE_SIZE * 4], after[PALETTE_SIZE * 4];
    palette_bake(body, 0, before);
    static const palette_stop stops[] = {{0, {0, 0, 0, 1}}, {1, {1, 1, 1, 1}}};
    const palette_desc plain = {.keys = &(palette_key){0, stops, 2}, .key_count = 1};
    assert_true(palette_replace(body, &plain));
    palette_bake(body, 0, after);
    assert_memory_not_equal(before, after, sizeof before);
    assert_true(palette_replace(body, &original));
    palette_bake(body, 0, after);
    assert_memory_equal(before, after, sizeof before);
}

static void bad_replacement_changes_nothing(void **state) {
    (void)state;
    palette *p = (palette *)(uintptr_t)two_stops(PALETTE_LINEAR);
    static const palette_stop falling[] = {{1, {0, 0, 0, 1}}, {0, {1, 1, 1, 1}}};
    err_clear();
    assert_false(
        palette_replace(p, &(palette_desc){.keys = &(palette_key){0, falling, 2}, .key_count = 1}));
    assert_error("positions must not fall");
    static palette_stop many[PALETTE_MAX_STOPS];
    for (int i = 0; i < PALETTE_MAX_STOPS; i++) many[i] = (palette_stop){(float)i, {0, 0, 0, 1}};
    const palette_key keys[] = {{0, many, PALETTE_MAX_STOPS}, {1, many, PALETTE_MAX_STOPS}};
    assert_false(palette_replace(p, &(palette_desc){.keys = keys, .key_count = 2}));
    assert_error("128 stops; at most 64");
    assert_int_equal(palette_version(p), 0);
    assert_int_equal(palette_get_desc(p)->keys[0].count, 2);
}

static void replacing_again_and_again_takes_memory_once(void **state) {
    (void)state;
    arena memory = {0};
    static const palette_stop stops[] = {{0, {0, 0, 0, 1}}, {1, {1, 1, 1, 1}}};
    const palette_desc desc = {.keys = &(palette_key){0, stops, 2}, .key_count = 1};
    palette *p = palette_create(&memory, &desc);
    assert_true(palette_replace(p, &desc));
    const void *here = arena_alloc(&memory, 16);
    for (int i = 0; i < 1000; i++) assert_true(palette_replace(p, &desc));
    assert_int_equal((const char *)arena_alloc(&memory, 16) - (const char *)here, 16);
    arena_free(&memory);
}

// ---- text -------------------------------------------------------------------------------------

static void text_gives_stops_and_back(void **state) {
    (void)state;
    static const char text[] = "0 #000000; 0.5 #7a1500 0.5; 0.75 #ffffff 0; 1 4,2,0.1";
    palette_stop stops[PALETTE_MAX_STOPS];
    size_t count;
    if (!palette_parse(text, stops, &count)) fail_msg("%s", err_get());
    assert_int_equal(count, 4);
    assert_true(stops[1].at == 0.5f && stops[1].color[3] == 0.5f && stops[0].color[3] == 1);
    assert_true(stops[3].color[0] == 4 && stops[3].color[2] == 0.1f);
    strbuf out = {0};
    palette_print(stops, count, &out);
    assert_string_equal(strbuf_text(&out), text);
    strbuf_free(&out);
    assert_true(palette_parse("  0 #000 ;1 #ffffff80;", stops, &count) && count == 2);
    assert_true(fabsf(stops[1].color[3] - 128 / 255.0f) < 1e-6f);
    assert_true(palette_parse("", stops, &count) && count == 0);
}

static void every_number_survives_the_text(void **state) {
    (void)state;
    palette_stop stops[2] = {{-0.1f, {1.0f / 3, 1e-30f, 65504, 0.7f}}, {16777217, {0.5f, 0, 1, 1}}};
    strbuf out = {0};
    palette_print(stops, 2, &out);
    palette_stop again[PALETTE_MAX_STOPS];
    size_t count;
    assert_true(palette_parse(strbuf_text(&out), again, &count));
    assert_int_equal(count, 2);
    assert_memory_equal(stops, again, sizeof stops);
    strbuf_free(&out);
}

static void text_that_is_no_palette_is_refused(void **state) {
    (void)state;
    static const char *const bad[] = {
        "0",        "0 red",     "0 #12345", "0 1,2",       "0 1,2,3,4",          "0 #000 1 2",
        "nan #000", "0 inf,0,0", "x #000",   "0 #000; ; 1", "0 #000000000000000", "0 #000, 1 #fff",
    };
    palette_stop stops[PALETTE_MAX_STOPS];
    size_t count;
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        err_clear();
        if (palette_parse(bad[i], stops, &count)) fail_msg("'%s' was taken", bad[i]);
        assert_error("is wrong; accepted: position, colour and alpha");
    }
    strbuf long_text = {0};
    for (int i = 0; i <= PALETTE_MAX_STOPS; i++) strbuf_add(&long_text, "%d #000;", i);
    assert_false(palette_parse(strbuf_text(&long_text), stops, &count));
    assert_error("at most 64 stops");
    strbuf_free(&long_text);
}

static void hex_is_given_only_where_it_is_exact(void **state) {
    (void)state;
    char hex[8];
    float color[4];
    for (int byte = 0; byte < 256; byte++) {
        char text[8];
        snprintf(text, sizeof text, "#%02x%02x%02x", byte, 255 - byte, byte / 2);
        assert_true(value_parse_color(text, color));
        assert_true(value_color_hex(color, hex));
        assert_string_equal(hex, text);
    }
    assert_false(value_color_hex((float[3]){0.5f, 0, 0}, hex));
    assert_false(value_color_hex((float[3]){0, 1.5f, 0}, hex));
    assert_false(value_color_hex((float[3]){0, 0, NAN}, hex));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_are_the_stops_and_hold),
        cmocka_unit_test(stops_mix_linearly),
        cmocka_unit_test(oklab_mixes_by_lightness),
        cmocka_unit_test(oklab_goes_there_and_back),
        cmocka_unit_test(equal_positions_make_a_hard_edge),
        cmocka_unit_test(baked_texels_are_what_is_evaluated),
        cmocka_unit_test(a_range_wider_than_the_stops_holds_them),
        cmocka_unit_test(keys_mix_over_time),
        cmocka_unit_test(black_bodies_have_their_chromaticities),
        cmocka_unit_test(physical_black_bodies_shine_by_the_fourth_power),
        cmocka_unit_test(bad_stops_are_refused),
        cmocka_unit_test(colours_are_read_as_srgb),
        cmocka_unit_test(replaced_palette_gives_the_new_colors),
        cmocka_unit_test(palette_is_restored_to_what_it_was_made_of),
        cmocka_unit_test(bad_replacement_changes_nothing),
        cmocka_unit_test(replacing_again_and_again_takes_memory_once),
        cmocka_unit_test(text_gives_stops_and_back),
        cmocka_unit_test(every_number_survives_the_text),
        cmocka_unit_test(text_that_is_no_palette_is_refused),
        cmocka_unit_test(hex_is_given_only_where_it_is_exact),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(build_memory());
    return failed;
}
