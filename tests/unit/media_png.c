// PNG: what is written comes back, and nothing else is taken for a picture.
#include "media_test.h"

#include "media/png.h"

enum { WIDTH = 7, HEIGHT = 5 };

static void fill(uint8_t *bytes, size_t count) {
    uint32_t state = 1;
    for (size_t i = 0; i < count; i++) bytes[i] = (uint8_t)test_random(&state);
}

static void round_trip(int channels, int bits) {
    uint8_t pixels[WIDTH * HEIGHT * 4 * 2];
    size_t sample = (size_t)bits / 8, row = WIDTH * (size_t)channels * sample;
    fill(pixels, row * HEIGHT);
    png_image in = {WIDTH, HEIGHT, channels, bits, pixels}, out;
    assert_true(png_write(test_path("a.png"), &in, NULL, 0));
    arena memory = {0};
    assert_true(png_read(test_path("a.png"), NULL, &memory, &out));
    assert_int_equal(out.width, WIDTH);
    assert_int_equal(out.height, HEIGHT);
    assert_int_equal(out.channels, 4);
    assert_int_equal(out.bits, bits);
    const uint8_t opaque[2] = {255, 255};
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        for (size_t c = 0; c < 4; c++) {
            const uint8_t *got = (const uint8_t *)out.pixels + (i * 4 + c) * sample;
            const uint8_t *wanted = pixels + (i * (size_t)channels + c) * sample;
            assert_memory_equal(got, (int)c < channels ? wanted : opaque, sample);
        }
    arena_free(&memory);
}

static void pixels_survive_at_every_depth(void **state) {
    (void)state;
    round_trip(3, 8);
    round_trip(4, 8);
    round_trip(3, 16);
    round_trip(4, 16);
}

static void texts_are_written_as_latin_or_utf8(void **state) {
    (void)state;
    uint8_t pixels[WIDTH * HEIGHT * 3] = {0};
    png_image in = {WIDTH, HEIGHT, 3, 8, pixels};
    png_text texts[] = {{"Software", "roil"}, {"Comment", "gr\xc3\xbcn"}};
    assert_true(png_write(test_path("t.png"), &in, texts, 2));
    void *data;
    size_t size;
    assert_true(file_read(test_path("t.png"), 1 << 20, &data, &size));
    assert_non_null(memmem(data, size, "tEXtSoftware\0roil", 17));
    assert_non_null(memmem(data, size, "iTXtComment", 11));
    assert_non_null(memmem(data, size, "gr\xc3\xbcn", 5));
    mem_free(data);
}

static void palette_and_interlace_become_rgba(void **state) {
    (void)state;
    const char *path = test_source("tests/fuzz/corpus/fuzz_texture/palette.png");
    if (!path) skip();
    arena memory = {0};
    png_image out;
    assert_true(png_read(path, NULL, &memory, &out));
    assert_int_equal(out.bits, 8);
    const uint8_t red[4] = {255, 0, 0, 255};
    assert_memory_equal(out.pixels, red, 4);
    arena_free(&memory);
}

static void gray_with_alpha_becomes_16_bit_rgba(void **state) {
    (void)state;
    const char *path = test_source("tests/fuzz/corpus/fuzz_texture/gray_alpha_16.png");
    if (!path) skip();
    arena memory = {0};
    png_image out;
    assert_true(png_read(path, NULL, &memory, &out));
    assert_int_equal(out.bits, 16);
    const uint16_t *p = out.pixels; // filter "sub" over bytes 0, 1, 2, 3
    assert_int_equal(p[0], 0x0001);
    assert_int_equal(p[1], 0x0001);
    assert_int_equal(p[3], 0x0203);
    arena_free(&memory);
}

static void every_truncation_is_an_error(void **state) {
    (void)state;
    uint8_t pixels[WIDTH * HEIGHT * 4];
    fill(pixels, sizeof pixels);
    png_image in = {WIDTH, HEIGHT, 4, 8, pixels}, out;
    assert_true(png_write(test_path("a.png"), &in, NULL, 0));
    void *data;
    size_t size;
    assert_true(file_read(test_path("a.png"), 1 << 20, &data, &size));
    arena memory = {0};
    for (size_t n = 0; n < size - 1; n++) {
        void *cut = mem_copy(data, n ? n : 1); // so that reading beyond it is seen
        assert_false(png_decode(cut, n, "cut.png", &picture_limits_default, &memory, &out));
        assert_message("cut.png");
        mem_free(cut);
    }
    arena_free(&memory);
    mem_free(data);
}

static void random_bytes_are_an_error(void **state) {
    (void)state;
    uint8_t bytes[512];
    fill(bytes, sizeof bytes);
    arena memory = {0};
    png_image out;
    assert_false(
        png_decode(bytes, sizeof bytes, "noise.png", &picture_limits_default, &memory, &out));
    assert_message("is not a PNG file");
    memcpy(bytes, "\x89PNG\r\n\x1a\n", 8);
    assert_false(
        png_decode(bytes, sizeof bytes, "noise.png", &picture_limits_default, &memory, &out));
    assert_false(png_read(test_path("absent.png"), NULL, &memory, &out));
    assert_message("absent.png");
    arena_free(&memory);
}

static void a_huge_header_is_refused(void **state) {
    (void)state;
    // 20000 x 1, with a right checksum, so that only the limit can refuse it.
    static const uint8_t huge[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x4e\x20\0\0\0\1\x08\2\0\0\0"
                                  "\xb4\xd6\x09\xd9";
    arena memory = {0};
    png_image out;
    assert_false(
        png_decode(huge, sizeof huge - 1, "huge.png", &picture_limits_default, &memory, &out));
    assert_message("16384");
    arena_free(&memory);
    png_image in = {20000, 1, 3, 8, huge};
    assert_false(png_write(test_path("huge.png"), &in, NULL, 0));
    assert_message("16384");
}

static void a_full_disk_is_an_error(void **state) {
    (void)state;
    uint8_t pixels[WIDTH * HEIGHT * 3] = {0};
    png_image in = {WIDTH, HEIGHT, 3, 8, pixels};
    assert_int_equal(symlink("/dev/full", test_path("full.png")), 0);
    assert_false(png_write(test_path("full.png"), &in, NULL, 0));
    assert_message("full.png");
    assert_false(png_write(test_path("no/such/folder.png"), &in, NULL, 0));
    assert_message("folder.png");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_survive_at_every_depth),
        cmocka_unit_test(texts_are_written_as_latin_or_utf8),
        cmocka_unit_test(palette_and_interlace_become_rgba),
        cmocka_unit_test(gray_with_alpha_becomes_16_bit_rgba),
        cmocka_unit_test(every_truncation_is_an_error),
        cmocka_unit_test(random_bytes_are_an_error),
        cmocka_unit_test(a_huge_header_is_refused),
        cmocka_unit_test(a_full_disk_is_an_error),
    };
    return cmocka_run_group_tests(tests, test_setup, test_teardown);
}
