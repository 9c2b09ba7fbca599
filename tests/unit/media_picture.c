// Pictures as numbers: what files of both kinds become, and what is refused.
#include "media_test.h"

#include "media/exr.h"
#include "media/picture.h"
#include "media/png.h"
#include <math.h>

enum { WIDTH = 3, HEIGHT = 2, COUNT = WIDTH * HEIGHT, SIDE_MAX = 64 };

static void write_exr(const char *name, const char *names, const float *values) {
    exr_channel channels[4];
    char letters[4][2] = {{0}};
    size_t count = strlen(names);
    for (size_t c = 0; c < count; c++) {
        letters[c][0] = names[c];
        channels[c] = (exr_channel){letters[c], values + c * COUNT, false};
    }
    exr_image image = {WIDTH, HEIGHT, channels, count};
    if (!exr_write(test_path(name), &image)) fail_msg("%s", err_get());
}

static bool load(const char *name, uint32_t side_max, arena *memory, picture *out) {
    err_clear();
    return picture_read(test_path(name), test_folder, side_max, memory, out);
}

static void refused(const char *name, uint32_t side_max, const char *message) {
    arena memory = {0};
    picture p;
    assert_false(load(name, side_max, &memory, &p));
    assert_message(message);
    arena_free(&memory);
}

static void exr_keeps_its_numbers(void **state) {
    (void)state;
    arena memory = {0};
    picture p;
    float values[4 * COUNT];
    for (int i = 0; i < 4 * COUNT; i++) values[i] = (float)i - 7.5f;
    write_exr("a.exr", "RGBA", values);
    assert_true(load("a.exr", SIDE_MAX, &memory, &p));
    assert_int_equal(p.width, WIDTH);
    assert_int_equal(p.height, HEIGHT);
    assert_int_equal(p.bits, 0);
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 4; c++) assert_true(p.rgba[4 * i + c] == values[c * COUNT + i]);
    arena_free(&memory);
}

static void what_an_exr_lacks_is_grey_or_nothing_and_alpha_is_1(void **state) {
    (void)state;
    static const struct {
        const char *channels;
        float rgba[4];
    } rows[] = {{"Y", {2, 2, 2, 1}}, {"R", {2, 0, 0, 1}}, {"BA", {0, 0, 2, 2}}};
    float values[4 * COUNT];
    for (int i = 0; i < 4 * COUNT; i++) values[i] = 2;
    for (size_t k = 0; k < COUNT_OF(rows); k++) {
        arena memory = {0};
        picture p;
        write_exr("b.exr", rows[k].channels, values);
        assert_true(load("b.exr", SIDE_MAX, &memory, &p));
        for (int c = 0; c < 4; c++) assert_true(p.rgba[4 * (COUNT - 1) + c] == rows[k].rgba[c]);
        arena_free(&memory);
    }
}

static void png_becomes_0_to_1_of_its_whole_numbers(void **state) {
    (void)state;
    arena memory = {0};
    picture p;
    uint8_t bytes[4 * COUNT];
    uint16_t words[3 * COUNT];
    for (int i = 0; i < 4 * COUNT; i++) bytes[i] = (uint8_t)(10 * i);
    for (int i = 0; i < 3 * COUNT; i++) words[i] = (uint16_t)(3000 * i);
    assert_true(png_write(test_path("8.png"), &(png_image){WIDTH, HEIGHT, 4, 8, bytes}, NULL, 0));
    assert_true(png_write(test_path("16.png"), &(png_image){WIDTH, HEIGHT, 3, 16, words}, NULL, 0));
    assert_true(load("8.png", SIDE_MAX, &memory, &p));
    assert_int_equal(p.bits, 8);
    for (int i = 0; i < 4 * COUNT; i++) assert_true(p.rgba[i] == (float)bytes[i] / 255.0f);
    assert_true(load("16.png", SIDE_MAX, &memory, &p));
    assert_int_equal(p.bits, 16);
    assert_true(p.rgba[4] == (float)words[3] / 65535.0f && p.rgba[7] == 1);
    arena_free(&memory);
}

static void what_is_written_is_read_again(void **state) {
    (void)state;
    arena memory = {0};
    picture p;
    float values[4 * COUNT];
    for (int i = 0; i < 4 * COUNT; i++) values[i] = (float)i / 8;
    assert_true(picture_write(test_path("d.exr"), &(picture){WIDTH, HEIGHT, 0, values}));
    assert_true(load("d.exr", SIDE_MAX, &memory, &p));
    assert_int_equal(p.width, WIDTH);
    assert_memory_equal(p.rgba, values, sizeof values);
    arena_free(&memory);
}

static void broken_pictures_are_refused(void **state) {
    (void)state;
    float values[4 * COUNT] = {0};
    write_exr("good.exr", "RGBA", values);
    values[4] = NAN;
    write_exr("nan.exr", "RGBA", values);
    write_exr("depth.exr", "Z", values);
    test_put("text.exr", "not a picture", 13);
    test_put("text.png", "not a picture", 13);
    refused("missing.exr", SIDE_MAX, "missing.exr");
    refused("text.exr", SIDE_MAX, "text.exr");
    refused("text.png", SIDE_MAX, "text.png");
    refused("nan.exr", SIDE_MAX, "holds nan at 1, 1; finite numbers are accepted");
    refused("depth.exr", SIDE_MAX, "no channel R, G, B or Y");
    refused("good.exr", 2, "a picture of 3x2; up to 2x2 is accepted");
}

static void pictures_lie_below_the_root(void **state) {
    (void)state;
    arena memory = {0};
    picture p;
    float values[4 * COUNT] = {0};
    write_exr("c.exr", "RGBA", values);
    assert_true(file_make_parent_folders(test_path("inside/x")));
    assert_false(picture_read(test_path("c.exr"), test_path("inside"), SIDE_MAX, &memory, &p));
    arena_free(&memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exr_keeps_its_numbers),
        cmocka_unit_test(what_an_exr_lacks_is_grey_or_nothing_and_alpha_is_1),
        cmocka_unit_test(png_becomes_0_to_1_of_its_whole_numbers),
        cmocka_unit_test(what_is_written_is_read_again),
        cmocka_unit_test(broken_pictures_are_refused),
        cmocka_unit_test(pictures_lie_below_the_root),
    };
    return cmocka_run_group_tests(tests, test_setup, test_teardown);
}
