// Panoramas: what is refused, and the numbers that are made of the rest.
#include "media_test.h"

#include "media/exr.h"
#include "scene/sky_table.h"
#include <math.h>

static const double pi = 3.14159265358979;

enum { WIDTH = 8, HEIGHT = 4, COUNT = WIDTH * HEIGHT };

static void write_planes(const char *name, uint32_t width, uint32_t height, const char *names,
                         const float *values) {
    exr_channel channels[4];
    char letters[4][2] = {{0}};
    size_t count = strlen(names);
    for (size_t c = 0; c < count; c++) {
        letters[c][0] = names[c];
        channels[c] = (exr_channel){letters[c], values, false};
    }
    exr_image image = {width, height, channels, count};
    if (!exr_write(test_path(name), &image)) fail_msg("%s", err_get());
}

static sky_image *load(const char *name, arena *memory) {
    err_clear();
    return sky_image_load(test_path(name), test_folder, memory);
}

static void refused(const char *name, const char *message) {
    arena memory = {0};
    assert_null(load(name, &memory));
    assert_message(message);
    arena_free(&memory);
}

static void fill(float *values, float value) {
    for (int i = 0; i < COUNT; i++) values[i] = value;
}

// ---- files ------------------------------------------------------------------------------------

static void even_sky_is_as_bright_everywhere(void **state) {
    (void)state;
    arena memory = {0};
    float values[COUNT], zenith[3], horizon[3];
    fill(values, 0.75f);
    write_planes("even.exr", WIDTH, HEIGHT, "BGR", values);
    sky_image *s = load("even.exr", &memory);
    if (!s) fail_msg("%s", err_get());
    sky_image_means(s, zenith, horizon);
    for (int c = 0; c < 3; c++)
        assert_true(fabsf(zenith[c] - 0.75f) < 1e-5f && fabsf(horizon[c] - 0.75f) < 1e-5f);
    arena_free(&memory);
}

static void grey_file_is_white_light(void **state) {
    (void)state;
    arena memory = {0};
    float values[COUNT], zenith[3], horizon[3];
    fill(values, 2);
    write_planes("grey.exr", WIDTH, HEIGHT, "Y", values);
    sky_image *s = load("grey.exr", &memory);
    if (!s) fail_msg("%s", err_get());
    sky_image_means(s, zenith, horizon);
    assert_true(zenith[0] == zenith[2] && fabsf(zenith[1] - 2) < 1e-5f);
    arena_free(&memory);
}

static void values_that_are_no_light_are_refused(void **state) {
    (void)state;
    static const float wrong[] = {-0.25f, NAN, INFINITY, -INFINITY};
    static const char *const said[] = {"holds -0.25 at 3, 1", "nan at 3, 1", "inf at 3, 1",
                                       "holds -inf at 3, 1"};
    for (int i = 0; i < 4; i++) {
        float values[COUNT];
        fill(values, 1);
        values[WIDTH + 3] = wrong[i];
        write_planes("wrong.exr", WIDTH, HEIGHT, "RGB", values);
        refused("wrong.exr", said[i]);
    }
    float dark[COUNT] = {0};
    dark[7] = 1e-30f; // nothing is left of it in half floats
    write_planes("dark.exr", WIDTH, HEIGHT, "RGB", dark);
    refused("dark.exr", "the panorama is all black");
}

static void sun_brighter_than_half_floats_is_cut(void **state) {
    (void)state;
    arena memory = {0};
    float values[COUNT], zenith[3], horizon[3];
    fill(values, 1e30f);
    write_planes("sun.exr", WIDTH, HEIGHT, "RGB", values);
    sky_image *s = load("sun.exr", &memory);
    if (!s) fail_msg("%s", err_get());
    sky_image_means(s, zenith, horizon);
    assert_true(fabsf(zenith[0] / 65504 - 1) < 1e-5f);
    arena_free(&memory);
}

static void what_is_no_panorama_is_refused(void **state) {
    (void)state;
    float *values = mem_alloc((SKY_WIDTH_MAX + 1) * sizeof *values);
    values[0] = 1;
    write_planes("wide.exr", SKY_WIDTH_MAX + 1, 1, "RGB", values);
    refused("wide.exr", "wide.exr: a picture of 8193x1; up to 8192x4096 is accepted");
    write_planes("high.exr", 1, SKY_HEIGHT_MAX + 1, "RGB", values);
    refused("high.exr", "a picture of 1x4097");
    write_planes("depth.exr", WIDTH, HEIGHT, "Z", values);
    refused("depth.exr", "the picture has no channel 'R'; R, G and B, or Y are accepted");
    write_planes("half.exr", WIDTH, HEIGHT, "RB", values);
    refused("half.exr", "the picture has no channel 'G'");
    test_put("text.exr", "no picture", 10);
    refused("text.exr", "text.exr");
    refused("none.exr", "none.exr");
    mem_free(values);
}

static void file_outside_is_refused(void **state) {
    (void)state;
    float values[COUNT];
    fill(values, 1);
    write_planes("even.exr", WIDTH, HEIGHT, "RGB", values);
    arena memory = {0};
    assert_true(file_make_folders(test_path("inner")));
    assert_null(sky_image_load(test_path("even.exr"), test_path("inner"), &memory));
    assert_message("leads out of");
    arena_free(&memory);
}

static void damaged_files_are_refused_or_read(void **state) {
    (void)state;
    float values[COUNT];
    for (int i = 0; i < COUNT; i++) values[i] = 1 + (float)i;
    write_planes("good.exr", WIDTH, HEIGHT, "BGR", values);
    void *bytes;
    size_t size;
    assert_true(file_read(test_path("good.exr"), 1 << 20, &bytes, &size));
    uint8_t *damaged = mem_alloc(size);
    uint32_t chance = 7;
    for (int i = 0; i < 150; i++) {
        memcpy(damaged, bytes, size);
        size_t length = i % 3 ? size : test_random(&chance) % size;
        for (int k = 0; k < 1 + i % 5; k++)
            damaged[test_random(&chance) % size] = (uint8_t)test_random(&chance);
        test_put("bad.exr", damaged, length);
        arena memory = {0};
        if (!load("bad.exr", &memory)) assert_message("bad.exr");
        arena_free(&memory);
    }
    mem_free(damaged);
    mem_free(bytes);
}

// ---- numbers ----------------------------------------------------------------------------------

static double row_area(uint32_t y, uint32_t rows) { // in parts of the sphere
    return (cos(pi * y / rows) - cos(pi * (y + 1) / rows)) / 2;
}

// Mean over the sphere.
static double mean(const panorama *p, size_t channel) {
    double sum = 0;
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++)
            sum += row_area(y, p->height) / p->width *
                   (double)p->rgb[3 * (y * p->width + x) + channel];
    return sum;
}

static panorama noise(arena *memory, uint32_t width, uint32_t height) {
    panorama out = {width, height, arena_alloc(memory, 3ul * width * height * sizeof(float))};
    uint32_t chance = 3;
    for (uint32_t i = 0; i < 3 * width * height; i++)
        out.rgb[i] = (float)(test_random(&chance) % 1000) / 100;
    return out;
}

static void every_size_has_the_same_light(void **state) {
    (void)state;
    static const uint32_t sizes[][2] = {{8, 4}, {16, 8}, {15, 7}, {1, 1}, {40, 3}, {2, 50}};
    arena memory = {0};
    panorama image = noise(&memory, 17, 9);
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        panorama other = panorama_resize(&image, sizes[i][0], sizes[i][1], &memory);
        assert_int_equal(other.width, sizes[i][0]);
        assert_int_equal(other.height, sizes[i][1]);
        for (size_t c = 0; c < 3; c++)
            assert_true(fabs(mean(&other, c) / mean(&image, c) - 1) < 1e-5);
    }
    arena_free(&memory);
}

static void shares_rise_to_one_and_follow_the_light(void **state) {
    (void)state;
    arena memory = {0};
    panorama image = {64, 32, arena_alloc(&memory, 3 * 64 * 32 * sizeof(float))};
    for (size_t c = 0; c < 3; c++) image.rgb[3 * (8 * 64 + 40) + c] = 100; // one bright texel
    sky_table *table = arena_alloc(&memory, sizeof *table);
    sky_table_fill(&image, table);
    for (uint32_t y = 0; y < SKY_CELLS_Y; y++) {
        for (uint32_t x = 1; x < SKY_CELLS_X; x++)
            assert_true(table->values[y][x] > table->values[y][x - 1]);
        assert_true(table->values[y][SKY_CELLS_X - 1] == 1);
        if (y > 0) assert_true(table->values[y][SKY_CELLS_X] > table->values[y - 1][SKY_CELLS_X]);
    }
    assert_true(table->values[SKY_CELLS_Y - 1][SKY_CELLS_X] == 1);
    // The texel is 4 x 4 cells; all but the least share of the light falls there.
    float rows = table->values[35][SKY_CELLS_X] - table->values[31][SKY_CELLS_X];
    float cells = table->values[33][163] - table->values[33][159];
    assert_true(rows > 0.94f && rows < 1 && cells > 0.94f && cells < 1);
    arena_free(&memory);
}

// L(d) = 2 + x + z / 2 has the irradiance pi (2 + 2/3 (x + z / 2)) on a surface.
static void polynomials_are_irradiance(void **state) {
    (void)state;
    arena memory = {0};
    panorama image = {256, 128, arena_alloc(&memory, 3 * 256 * 128 * sizeof(float))};
    for (uint32_t y = 0; y < 128; y++)
        for (uint32_t x = 0; x < 256; x++)
            for (uint32_t c = 0; c < 3; c++) {
                double azimuth = 2 * pi * ((x + 0.5) / 256 - 0.5), t = pi * (y + 0.5) / 128;
                image.rgb[3 * (y * 256 + x) + c] =
                    (float)((c + 1) * (2 + sin(t) * sin(azimuth) + cos(t) / 2));
            }
    sky_table *table = arena_alloc(&memory, sizeof *table);
    sky_table_fill(&image, table);
    const float *k = table->values[SKY_CELLS_Y];
    for (uint32_t c = 0; c < 3; c++) {
        const double want[9] = {2, 0, 1.0 / 3, 2.0 / 3, 0, 0, 0, 0, 0};
        for (uint32_t i = 0; i < 9; i++)
            if (!(fabs((double)k[3 * i + c] / (c + 1) - want[i]) < 1e-3))
                fail_msg("coefficient %u is %g, not %g", i, (double)k[3 * i + c] / (c + 1),
                         want[i]);
    }
    arena_free(&memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_sky_is_as_bright_everywhere),
        cmocka_unit_test(grey_file_is_white_light),
        cmocka_unit_test(values_that_are_no_light_are_refused),
        cmocka_unit_test(sun_brighter_than_half_floats_is_cut),
        cmocka_unit_test(what_is_no_panorama_is_refused),
        cmocka_unit_test(file_outside_is_refused),
        cmocka_unit_test(damaged_files_are_refused_or_read),
        cmocka_unit_test(every_size_has_the_same_light),
        cmocka_unit_test(shares_rise_to_one_and_follow_the_light),
        cmocka_unit_test(polynomials_are_irradiance),
    };
    return cmocka_run_group_tests(tests, test_setup, test_teardown);
}
