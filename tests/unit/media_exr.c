// EXR: values survive, to the precision of their channel.
#include "media_test.h"

#include "media/exr.h"
#include <math.h>

enum {
    WIDTH = 19,
    HEIGHT = 37,
    COUNT = WIDTH * HEIGHT
}; // three chunks of 16 lines, the last short

static float color[COUNT], depth[COUNT];

static void fill(void) {
    for (int i = 0; i < COUNT; i++) {
        color[i] = (float)i / 8.0f;           // exact in half
        depth[i] = 1e6f + (float)i * 0.0625f; // not
    }
}

static const exr_channel *find(const exr_image *image, const char *name) {
    for (size_t c = 0; c < image->channel_count; c++)
        if (strcmp(image->channels[c].name, name) == 0) return &image->channels[c];
    return NULL;
}

static void write_picture(const char *path) {
    fill();
    exr_channel channels[] = {{"R", color, true}, {"G", color, true},  {"B", color, true},
                              {"A", color, true}, {"Z", depth, false}, {"F", color, false}};
    exr_image image = {WIDTH, HEIGHT, channels, 6};
    assert_true(exr_write(path, &image));
}

static void half_and_float_channels_survive(void **state) {
    (void)state;
    write_picture(test_path("a.exr"));
    arena memory = {0};
    exr_image out;
    assert_true(exr_read(test_path("a.exr"), NULL, &memory, &out));
    assert_int_equal(out.width, WIDTH);
    assert_int_equal(out.height, HEIGHT);
    assert_int_equal(out.channel_count, 6);
    assert_memory_equal(find(&out, "R")->values, color, sizeof color);
    assert_memory_equal(find(&out, "F")->values, color, sizeof color);
    assert_memory_equal(find(&out, "Z")->values, depth, sizeof depth);
    assert_true(find(&out, "A")->half);
    assert_false(find(&out, "Z")->half);
    arena_free(&memory);
}

static void half_rounds_and_keeps_what_is_not_finite(void **state) {
    (void)state;
    float values[4] = {1.0f + 1.0f / 4096.0f, 1e6f, -INFINITY, NAN};
    exr_channel channel = {"Y", values, true};
    exr_image image = {4, 1, &channel, 1}, out;
    assert_true(exr_write(test_path("b.exr"), &image));
    arena memory = {0};
    assert_true(exr_read(test_path("b.exr"), NULL, &memory, &out));
    const float *got = out.channels[0].values;
    assert_true(got[0] == 1.0f);
    assert_true(isinf(got[1]) && got[1] > 0.0f);
    assert_true(isinf(got[2]) && got[2] < 0.0f);
    assert_true(isnan(got[3]));
    arena_free(&memory);
}

static void only_the_channels_that_are_wanted_are_read(void **state) {
    (void)state;
    write_picture(test_path("a.exr"));
    arena memory = {0};
    exr_image out;
    const exr_wish wish = {"ZRX", picture_limits_default};
    assert_true(exr_read(test_path("a.exr"), &wish, &memory, &out));
    assert_int_equal(out.channel_count, 2);
    assert_memory_equal(exr_find(&out, "R"), color, sizeof color);
    assert_memory_equal(exr_find(&out, "Z"), depth, sizeof depth);
    assert_null(exr_find(&out, "F"));
    arena_free(&memory);
}

// Where all channels are halves, OpenEXR takes another way.
static void halves_may_have_channels_that_nobody_wants(void **state) {
    (void)state;
    exr_channel channels[] = {{"R", color, true}, {"G", color, true}, {"A", color, true}};
    for (size_t count = 2; count <= 3; count++) {
        arena memory = {0};
        exr_image out;
        const exr_wish wish = {"R", picture_limits_default};
        assert_true(exr_write(test_path("h.exr"), &(exr_image){WIDTH, HEIGHT, channels, count}));
        assert_true(exr_read(test_path("h.exr"), &wish, &memory, &out));
        assert_int_equal(out.channel_count, 1);
        assert_memory_equal(out.channels[0].values, color, sizeof color);
        arena_free(&memory);
    }
}

static void memory_is_known_before_it_is_taken(void **state) {
    (void)state;
    write_picture(test_path("a.exr"));
    arena memory = {0};
    exr_image out;
    exr_wish wish = {"RZ", {WIDTH, HEIGHT, (size_t)WIDTH * HEIGHT * 3 * sizeof(float)}};
    assert_true(exr_read(test_path("a.exr"), &wish, &memory, &out));
    wish.letters = "RFZ";
    assert_false(exr_read(test_path("a.exr"), &wish, &memory, &out));
    assert_message("a.exr: a picture of ");
    assert_message("with 16 bytes a pixel takes ");
    wish = (exr_wish){"R", {WIDTH - 1, HEIGHT, (uint64_t)1 << 30}};
    assert_false(exr_read(test_path("a.exr"), &wish, &memory, &out));
    assert_message("is accepted");
    arena_free(&memory);
}

static void truncations_are_errors_and_flips_are_survived(void **state) {
    (void)state;
    const exr_wish all = {NULL, picture_limits_default};
    write_picture(test_path("a.exr"));
    void *data;
    size_t size;
    assert_true(file_read(test_path("a.exr"), 1 << 24, &data, &size));
    exr_image out;
    for (size_t n = 0; n < size; n += n < 400 ? 1 : 97) {
        arena memory = {0};
        void *cut = mem_copy(data, n ? n : 1); // so that reading beyond it is seen
        assert_false(exr_decode(cut, n, "cut.exr", &all, &memory, &out));
        assert_message("cut.exr");
        mem_free(cut);
        arena_free(&memory);
    }
    uint32_t random = 7;
    for (int i = 0; i < 400; i++) {
        arena memory = {0};
        uint8_t *copy = mem_copy(data, size);
        for (int k = 0; k < 4; k++)
            copy[test_random(&random) % (i % 2 ? size : 400)] = (uint8_t)test_random(&random);
        if (!exr_decode(copy, size, "flip.exr", &all, &memory, &out)) assert_message("flip.exr");
        mem_free(copy);
        arena_free(&memory);
    }
    mem_free(data);
}

static void random_bytes_are_an_error(void **state) {
    (void)state;
    uint8_t noise[300];
    uint32_t random = 3;
    for (size_t i = 0; i < sizeof noise; i++) noise[i] = (uint8_t)test_random(&random);
    test_put("noise.exr", noise, sizeof noise);
    arena memory = {0};
    exr_image out;
    assert_false(exr_read(test_path("noise.exr"), NULL, &memory, &out));
    assert_message("noise.exr");
    assert_false(exr_read(test_path("absent.exr"), NULL, &memory, &out));
    arena_free(&memory);
}

static void a_full_disk_is_an_error(void **state) {
    (void)state;
    exr_channel channel = {"Y", color, true};
    exr_image image = {WIDTH, HEIGHT, &channel, 1};
    assert_int_equal(symlink("/dev/full", test_path("full.exr")), 0);
    assert_false(exr_write(test_path("full.exr"), &image));
    assert_message("full.exr");
    assert_false(exr_write(test_path("no/such.exr"), &image));
    image.width = 16385;
    assert_false(exr_write(test_path("wide.exr"), &image));
    assert_message("16384");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_and_float_channels_survive),
        cmocka_unit_test(half_rounds_and_keeps_what_is_not_finite),
        cmocka_unit_test(only_the_channels_that_are_wanted_are_read),
        cmocka_unit_test(halves_may_have_channels_that_nobody_wants),
        cmocka_unit_test(memory_is_known_before_it_is_taken),
        cmocka_unit_test(truncations_are_errors_and_flips_are_survived),
        cmocka_unit_test(random_bytes_are_an_error),
        cmocka_unit_test(a_full_disk_is_an_error),
    };
    return cmocka_run_group_tests(tests, test_setup, test_teardown);
}
