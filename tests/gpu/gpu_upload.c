// Writing and reading: sizes beyond the staging ring, inside and outside frames, every level.
#include "gpu_test.h"
#include <string.h>

static uint32_t *noise(size_t count, uint32_t seed) {
    uint32_t *words = mem_alloc(count * sizeof *words);
    for (size_t i = 0; i < count; i++) words[i] = seed = seed * 1664525u + 1013904223u;
    return words;
}

static gpu_image *make_image(gpu *g, gpu_format format, uint32_t width, uint32_t height,
                             uint32_t depth) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = "image",
                                                             .format = format,
                                                             .width = width,
                                                             .height = height,
                                                             .depth = depth,
                                                             .use = GPU_USE_SAMPLED});
    gpu_test_ok(image);
    return image;
}

// 40 MB each: the ring has 16 MiB.
static void volume_larger_than_the_ring_arrives(void **state) {
    gpu *g = *state;
    enum { W = 200, H = 250, D = 200 };
    size_t count = (size_t)W * H * D, size = count * 4;
    uint32_t *found = mem_alloc(size);
    for (int in_frame = 0; in_frame < 2; in_frame++) {
        uint32_t *words = noise(count, 1 + (uint32_t)in_frame);
        gpu_image *image = make_image(g, GPU_R32U, W, H, D);
        if (in_frame) gpu_test_ok(gpu_frame_begin(g));
        gpu_test_ok(gpu_image_write(g, image, 0, words, size));
        if (in_frame) gpu_test_ok(gpu_frame_end(g));
        gpu_test_ok(gpu_image_read(g, image, found, size));
        assert_memory_equal(found, words, size);
        gpu_image_destroy(g, image);
        mem_free(words);
    }
    mem_free(found);
}

static void picture_of_long_rows_arrives(void **state) {
    gpu *g = *state;
    enum { W = 4096, H = 600 }; // 64 KiB a row, 37.5 MiB
    size_t count = (size_t)W * H * 4, size = count * 4;
    uint32_t *words = noise(count, 5), *found = mem_alloc(size);
    for (size_t i = 0; i < count; i++) words[i] &= 0x3fffffff; // no NaN, whose bits may change
    gpu_image *image = make_image(g, GPU_RGBA32F, W, H, 0);
    gpu_test_ok(gpu_image_write(g, image, 0, words, size));
    gpu_test_ok(gpu_image_read(g, image, found, size));
    assert_memory_equal(found, words, size);
    gpu_image_destroy(g, image);
    mem_free(words);
    mem_free(found);
}

static void buffer_larger_than_the_ring_arrives(void **state) {
    gpu *g = *state;
    size_t count = 9000001, size = count * 4;
    uint32_t *words = noise(count, 9), *found = mem_alloc(size);
    gpu_buffer *buffer = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "words", .size = size});
    gpu_test_ok(buffer);
    gpu_test_ok(gpu_buffer_write(g, buffer, 0, words, size));
    gpu_test_ok(gpu_buffer_read(g, buffer, 0, found, size));
    assert_memory_equal(found, words, size);
    gpu_buffer_destroy(g, buffer);
    mem_free(words);
    mem_free(found);
}

static void many_small_writes_keep_their_order(void **state) {
    gpu *g = *state;
    enum { COUNT = 3000 };
    uint32_t found[COUNT + 1];
    gpu_buffer *buffer =
        gpu_buffer_create(g, &(gpu_buffer_desc){.label = "words", .size = sizeof found});
    gpu_test_ok(buffer);
    for (uint32_t i = 0; i < COUNT; i++) { // each overwrites the second word of the one before
        uint32_t pair[2] = {i, ~i};
        gpu_test_ok(gpu_buffer_write(g, buffer, i * 4, pair, sizeof pair));
        if (i == COUNT / 2) gpu_test_ok(gpu_frame_begin(g));
    }
    gpu_test_ok(gpu_frame_end(g));
    gpu_test_ok(gpu_buffer_read(g, buffer, 0, found, sizeof found));
    for (uint32_t i = 0; i < COUNT; i++) assert_int_equal(found[i], i);
    assert_int_equal(found[COUNT], ~(uint32_t)(COUNT - 1));
    gpu_buffer_destroy(g, buffer);
}

static void parts_of_a_buffer_are_read_and_written_at_any_byte(void **state) {
    gpu *g = *state;
    gpu_buffer *buffer = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "bytes", .size = 11});
    gpu_test_ok(buffer);
    char found[12] = {0};
    gpu_test_ok(gpu_buffer_write(g, buffer, 0, "hello world", 11));
    gpu_test_ok(gpu_buffer_write(g, buffer, 5, "-W", 2));
    gpu_test_ok(gpu_buffer_read(g, buffer, 3, found, 8));
    assert_string_equal(found, "lo-World");
    assert_false(gpu_buffer_write(g, buffer, 5, "1234567", 7));
    assert_false(gpu_buffer_read(g, buffer, UINT64_MAX, found, 2));
    assert_non_null(strstr(err_get(), "'bytes'"));
    gpu_buffer_destroy(g, buffer);
}

static void buffers_are_copied_from_their_beginning(void **state) {
    gpu *g = *state;
    gpu_buffer *from = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "from", .size = 11});
    gpu_buffer *to = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "to", .size = 7});
    gpu_test_ok(from && to);
    char found[8] = {0};
    gpu_test_ok(gpu_buffer_write(g, from, 0, "hello world", 11));
    gpu_test_ok(gpu_buffer_write(g, to, 0, "1234567", 7));
    gpu_test_ok(gpu_buffer_copy(g, from, to, 4));
    gpu_test_ok(gpu_buffer_copy(g, from, to, 0));
    gpu_test_ok(gpu_buffer_read(g, to, 0, found, 7));
    assert_string_equal(found, "hell567");
    assert_false(gpu_buffer_copy(g, from, to, 8));
    assert_non_null(strstr(err_get(), "'to' (7)"));
    assert_false(gpu_buffer_copy(g, from, from, 4));
    gpu_buffer_destroy(g, from);
    gpu_buffer_destroy(g, to);
}

static void frame_copies_land_in_a_mapped_buffer(void **state) {
    gpu *g = *state;
    float texels[4] = {1, 2, 3, 4}, zero[4] = {0};
    gpu_image *image = make_image(g, GPU_R32F, 2, 2, 0), *other = make_image(g, GPU_R32F, 2, 2, 0);
    gpu_buffer *target = gpu_buffer_create(
        g, &(gpu_buffer_desc){.label = "target", .size = 64, .kind = GPU_BUFFER_READBACK});
    gpu_test_ok(target);
    gpu_test_ok(gpu_image_write(g, image, 0, texels, sizeof texels));
    gpu_test_ok(gpu_image_write(g, other, 0, texels, sizeof texels));
    uint64_t frame = gpu_frame_begin(g);
    gpu_test_ok(frame);
    gpu_buffer_fill(g, target, 0xffffffff);
    gpu_image_clear(g, image, zero);
    gpu_test_ok(gpu_image_copy_to_buffer(g, image, target, 0));
    gpu_test_ok(gpu_image_copy_to_buffer(g, other, target, 32));
    assert_false(gpu_image_copy_to_buffer(g, other, target, 52));
    assert_false(gpu_image_copy_to_buffer(g, other, target, 30));
    assert_false(gpu_image_read(g, image, texels, sizeof texels)); // a frame is open
    gpu_test_ok(gpu_frame_end(g));
    gpu_test_ok(gpu_frame_wait(g, frame));
    const float *map = gpu_buffer_map(target);
    assert_memory_equal(map, zero, sizeof zero);
    assert_memory_equal(map + 8, texels, sizeof texels);
    assert_true(((const uint32_t *)map)[4] == 0xffffffff);
    gpu_image_destroy(g, image);
    gpu_image_destroy(g, other);
    gpu_buffer_destroy(g, target);
}

static void areas_of_an_image_are_copied(void **state) {
    gpu *g = *state;
    uint8_t texels[16], zero[16] = {0}, found[16];
    for (uint8_t i = 0; i < 16; i++) texels[i] = i + 1;
    gpu_image *from = make_image(g, GPU_R8, 4, 4, 0), *to = make_image(g, GPU_R8, 4, 4, 0);
    gpu_test_ok(gpu_image_write(g, from, 0, texels, 16));
    gpu_test_ok(gpu_image_write(g, to, 0, zero, 16));
    static const gpu_area areas[] = {{1, 0, 3, 1}, {0, 2, 2, 2}}, wide = {2, 0, 3, 1};
    gpu_test_ok(gpu_image_copy_areas(g, from, to, areas, 2));
    gpu_test_ok(gpu_image_copy_areas(g, from, to, areas, 0));
    gpu_test_ok(gpu_image_read(g, to, found, 16));
    static const uint8_t copied[16] = {0, 2, 3, 4, 0, 0, 0, 0, 9, 10, 0, 0, 13, 14, 0, 0};
    assert_memory_equal(found, copied, 16);
    gpu_test_ok(gpu_image_copy(g, from, to));
    gpu_test_ok(gpu_image_read(g, to, found, 16));
    assert_memory_equal(found, texels, 16);
    assert_false(gpu_image_copy_areas(g, from, to, &wide, 1));
    assert_non_null(strstr(err_get(), "area 0 is not inside"));
    assert_false(gpu_image_copy_areas(g, from, to, areas, GPU_MAX_AREAS + 1));
    assert_false(gpu_image_copy_areas(g, from, from, areas, 1));
    gpu_image_destroy(g, from);
    gpu_image_destroy(g, to);
}

static void wrong_sizes_are_refused(void **state) {
    gpu *g = *state;
    uint8_t bytes[16] = {0};
    gpu_image *image = make_image(g, GPU_R8, 4, 4, 0);
    assert_false(gpu_image_write(g, image, 0, bytes, 15));
    assert_non_null(strstr(err_get(), "15 bytes given; 16 are needed"));
    assert_false(gpu_image_write(g, image, 1, bytes, 4));
    assert_non_null(strstr(err_get(), "no level 1"));
    assert_false(gpu_image_read(g, image, bytes, 12));
    gpu_image_destroy(g, image);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(volume_larger_than_the_ring_arrives),
        cmocka_unit_test(picture_of_long_rows_arrives),
        cmocka_unit_test(buffer_larger_than_the_ring_arrives),
        cmocka_unit_test(many_small_writes_keep_their_order),
        cmocka_unit_test(parts_of_a_buffer_are_read_and_written_at_any_byte),
        cmocka_unit_test(buffers_are_copied_from_their_beginning),
        cmocka_unit_test(frame_copies_land_in_a_mapped_buffer),
        cmocka_unit_test(areas_of_an_image_are_copied),
        cmocka_unit_test(wrong_sizes_are_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
