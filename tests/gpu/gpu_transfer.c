// Transfers: what the host writes on any thread arrives in images beside the frames.
#include "gpu_test.h"
#include <pthread.h>
#include <string.h>

enum { W = 19, H = 7, D = 40 };

static gpu_image *make_image(gpu *g, gpu_format format) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = "atlas",
                                                             .format = format,
                                                             .width = W,
                                                             .height = H,
                                                             .depth = D,
                                                             .use = GPU_USE_SAMPLED});
    gpu_test_ok(image);
    return image;
}

typedef struct filling {
    uint32_t *to, seed;
    size_t count;
} filling;

static void *fill(void *user) {
    filling *f = user;
    for (size_t i = 0; i < f->count; i++) f->to[i] = f->seed = f->seed * 1664525u + 1013904223u;
    return NULL;
}

static void fill_elsewhere(void *to, uint32_t seed, size_t count) {
    pthread_t thread;
    filling f = {to, seed, count};
    assert_int_equal(pthread_create(&thread, NULL, fill, &f), 0);
    pthread_join(thread, NULL);
}

static void needs(gpu *g, gpu_image *image, uint32_t seed, size_t count) {
    uint32_t *wanted = mem_alloc(count * 4), *found = mem_alloc((size_t)W * H * D * 4);
    fill(&(filling){wanted, seed, count});
    gpu_test_ok(gpu_image_read(g, image, found, (size_t)W * H * D * 4));
    assert_memory_equal(found, wanted, count * 4);
    mem_free(wanted);
    mem_free(found);
}

static void slices_arrive_in_and_between_frames(void **state) {
    gpu *g = *state;
    size_t all = (size_t)W * H * D, some = (size_t)W * H * 13, second = (all * 4 + 15) / 16 * 16;
    gpu_transfer *t = gpu_transfer_create(g, second + some * 4);
    gpu_test_ok(t);
    gpu_image *images[2] = {make_image(g, GPU_R32U), make_image(g, GPU_R32U)};
    for (uint32_t round = 0; round < 6; round++) {
        fill_elsewhere(gpu_transfer_map(t), round, all);
        fill_elsewhere((char *)gpu_transfer_map(t) + second, 100 + round, some);
        const gpu_transfer_part parts[] = {{images[round % 2], 0, D},
                                           {images[1 - round % 2], second, 13}};
        if (round > 2) gpu_test_ok(gpu_frame_begin(g));
        gpu_test_ok(gpu_transfer_start(g, t, parts, 2));
        gpu_test_ok(gpu_transfer_finish(g, t));
        if (round > 2) gpu_test_ok(gpu_frame_end(g));
        needs(g, images[round % 2], round, all);
        needs(g, images[1 - round % 2], 100 + round, some);
        assert_true(gpu_transfer_done(g, t)); // reading waited for all
    }
    gpu_image_destroy(g, images[0]);
    gpu_image_destroy(g, images[1]);
    gpu_transfer_destroy(g, t);
}

static void one_that_is_under_way_can_be_dropped(void **state) {
    gpu *g = *state;
    for (int finished = 0; finished < 2; finished++) {
        gpu_transfer *t = gpu_transfer_create(g, (size_t)W * H * D * 4);
        gpu_image *image = make_image(g, GPU_R32U);
        gpu_test_ok(t);
        gpu_test_ok(gpu_transfer_start(g, t, &(gpu_transfer_part){image, 0, D}, 1));
        if (finished) gpu_test_ok(gpu_transfer_finish(g, t));
        gpu_transfer_destroy(g, t);
        gpu_image_destroy(g, image);
    }
}

static void parts_must_fit(void **state) {
    gpu *g = *state;
    gpu_transfer *t = gpu_transfer_create(g, (size_t)W * H * 4);
    gpu_image *image = make_image(g, GPU_R32U);
    assert_false(gpu_transfer_start(g, t, &(gpu_transfer_part){image, 0, 2}, 1));
    assert_false(gpu_transfer_start(g, t, &(gpu_transfer_part){image, 16, 1}, 1));
    assert_false(gpu_transfer_start(g, t, &(gpu_transfer_part){image, 0, 0}, 1));
    assert_false(gpu_transfer_start(g, t, &(gpu_transfer_part){image, 0, D + 1}, 1));
    gpu_test_ok(gpu_transfer_start(g, t, &(gpu_transfer_part){image, 0, 1}, 1));
    gpu_test_ok(gpu_transfer_finish(g, t));
    gpu_transfer_destroy(g, t);
    gpu_image_destroy(g, image);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_arrive_in_and_between_frames),
        cmocka_unit_test(one_that_is_under_way_can_be_dropped),
        cmocka_unit_test(parts_must_fit),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
