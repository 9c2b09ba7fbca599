// Frames: order, times, deferred destruction, a lost device, pipelines from other threads.
#include "gpu/vk.h"
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <pthread.h>
#include <string.h>

enum { COUNT = 1 << 16 };

static gpu_pipeline *make_step(gpu *g) {
    const gpu_slot slots[] = {
        {.binding = 0, .kind = GPU_SLOT_UNIFORM},
        {.binding = 1, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true}};
    return gpu_pipeline_create_compute(g, &(gpu_compute_desc){.label = "step",
                                                              .code = step_comp_code,
                                                              .code_size = sizeof step_comp_code,
                                                              .slots = slots,
                                                              .slot_count = COUNT_OF(slots),
                                                              .local_size = {64, 1, 1}});
}

static gpu_buffer *make_buffer(gpu *g) {
    gpu_buffer *buffer =
        gpu_buffer_create(g, &(gpu_buffer_desc){.label = "counts", .size = COUNT * 4});
    gpu_test_ok(buffer);
    return buffer;
}

static bool step(gpu *g, gpu_pipeline *pipeline, gpu_buffer *buffer, uint32_t add) {
    const uint32_t params[3] = {1, add, COUNT};
    const gpu_binding bindings[] = {
        {.binding = 0, .uniform = params, .uniform_size = sizeof params},
        {.binding = 1, .buffer = buffer}};
    return gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                .bindings = bindings,
                                                .binding_count = COUNT_OF(bindings),
                                                .threads = {COUNT, 1, 1}});
}

static void frames_follow_each_other(void **state) {
    gpu *g = *state;
    gpu_pipeline *pipeline = make_step(g);
    gpu_test_ok(pipeline);
    gpu_buffer *buffer = make_buffer(g);
    uint32_t found, last = 0;
    for (uint32_t i = 0; i < 10; i++) {
        uint64_t frame = gpu_frame_begin(g);
        gpu_test_ok(frame);
        if (i > 0) assert_int_equal(frame, last + 1);
        assert_int_equal(gpu_frame_open(g), frame);
        assert_false(gpu_frame_done(g, frame));
        if (i == 0) gpu_buffer_fill(g, buffer, 0);
        gpu_test_ok(step(g, pipeline, buffer, 1 + i));
        gpu_test_ok(gpu_frame_end(g));
        last = (uint32_t)frame;
    }
    gpu_test_ok(gpu_buffer_read(g, buffer, 4 * (COUNT - 1), &found, sizeof found));
    assert_int_equal(found, 55);
    gpu_test_ok(gpu_frame_wait(g, last));
    gpu_test_ok(gpu_frame_wait(g, 1));
    assert_true(gpu_frame_done(g, last));
    assert_false(gpu_frame_done(g, last + 1));
    assert_int_equal(gpu_frame_open(g), 0);
    assert_false(gpu_frame_wait(g, last + 1));
    gpu_pipeline_destroy(g, pipeline);
    gpu_buffer_destroy(g, buffer);
}

static void passes_are_timed_in_order_and_never_negative(void **state) {
    gpu *g = *state;
    gpu_pipeline *pipeline = make_step(g);
    gpu_test_ok(pipeline);
    gpu_buffer *buffer = make_buffer(g);
    enum { FRAMES = GPU_FRAMES_IN_FLIGHT + 2 };
    uint64_t frames[FRAMES];
    for (int i = 0; i < FRAMES; i++) {
        frames[i] = gpu_frame_begin(g);
        gpu_test_ok(frames[i]);
        gpu_pass_begin(g, "first");
        gpu_test_ok(step(g, pipeline, buffer, 1));
        gpu_pass_end(g);
        gpu_pass_begin(g, i % 2 ? "odd" : "even");
        gpu_test_ok(step(g, pipeline, buffer, 2));
        gpu_pass_end(g);
        assert_int_equal(gpu_frame_times(g, frames[i], NULL, 0), 0); // still open
        gpu_test_ok(gpu_frame_end(g));
    }
    gpu_pass_time times[4];
    for (int i = 2; i < FRAMES; i++) {
        assert_int_equal(gpu_frame_times(g, frames[i], times, 4), 2);
        assert_string_equal(times[0].label, "first");
        assert_string_equal(times[1].label, i % 2 ? "odd" : "even");
        for (int pass = 0; pass < 2; pass++) {
            assert_true(times[pass].milliseconds >= 0.0 && times[pass].milliseconds < 60e3);
        }
        assert_int_equal(gpu_frame_times(g, frames[i], times, 1), 1);
    }
    assert_int_equal(gpu_frame_times(g, frames[0], times, 4), 0); // too old
    assert_int_equal(gpu_frame_times(g, frames[FRAMES - 1] + 1, times, 4), 0);
    gpu_pipeline_destroy(g, pipeline);
    gpu_buffer_destroy(g, buffer);
}

static void a_pass_is_timed_in_parts(void **state) {
    gpu *g = *state;
    gpu_pass_time times[8];
    gpu_buffer *buffer = make_buffer(g);
    uint64_t frame = gpu_frame_begin(g);
    gpu_test_ok(frame);
    gpu_pass_begin(g, "steps");
    for (uint32_t i = 0; i < 4; i++) {
        gpu_pass_next(g, i % 2 ? "sources" : "steps"); // the first is the one that runs
        gpu_buffer_fill(g, buffer, i);
        gpu_pass_next(g, i % 2 ? "sources" : "steps");
    }
    gpu_pass_end(g);
    gpu_test_ok(gpu_frame_end(g));
    assert_int_equal(gpu_frame_times(g, frame, times, COUNT_OF(times)), 4);
    for (int i = 0; i < 4; i++) assert_string_equal(times[i].label, i % 2 ? "sources" : "steps");
    gpu_buffer_destroy(g, buffer);
}

static void passes_beyond_the_limit_run_untimed(void **state) {
    gpu *g = *state;
    static gpu_pass_time times[GPU_MAX_PASSES + 8];
    gpu_buffer *buffer = make_buffer(g);
    uint64_t frame = gpu_frame_begin(g);
    gpu_test_ok(frame);
    for (uint32_t i = 0; i < GPU_MAX_PASSES + 4; i++) {
        gpu_pass_begin(g,
                       "a pass with a label that is longer than the sixty-three bytes kept of it");
        gpu_buffer_fill(g, buffer, i);
        gpu_pass_end(g);
    }
    gpu_test_ok(gpu_frame_end(g));
    assert_int_equal(gpu_frame_times(g, frame, times, COUNT_OF(times)), GPU_MAX_PASSES);
    uint32_t found;
    gpu_test_ok(gpu_buffer_read(g, buffer, 0, &found, sizeof found));
    assert_int_equal(found, GPU_MAX_PASSES + 3);
    gpu_buffer_destroy(g, buffer);
}

// Makes, uses and lets go one object of each kind; all are still needed when they are destroyed.
static void use_and_destroy(gpu *g, gpu_buffer *target, uint32_t value) {
    gpu_pipeline *pipeline = make_step(g);
    gpu_test_ok(pipeline);
    gpu_buffer *buffer = make_buffer(g);
    gpu_image *image = gpu_image_create(
        g,
        &(gpu_image_desc){
            .label = "one", .format = GPU_R32U, .width = 1, .height = 1, .use = GPU_USE_STORAGE});
    gpu_test_ok(image);
    gpu_test_ok(gpu_image_write(g, image, 0, &value, sizeof value));
    gpu_test_ok(gpu_frame_begin(g));
    gpu_test_ok(step(g, pipeline, buffer, value));
    gpu_test_ok(gpu_image_copy_to_buffer(g, image, target, 0));
    uint64_t used = gpu_get_memory_use(g).used;
    gpu_pipeline_destroy(g, pipeline);
    gpu_buffer_destroy(g, buffer);
    gpu_image_destroy(g, image);
    assert_int_equal(gpu_get_memory_use(g).used, used);
    gpu_test_ok(gpu_frame_end(g));
}

static void destroyed_objects_live_until_their_frame_is_done(void **state) {
    gpu *g = *state;
    gpu_buffer *target = gpu_buffer_create(
        g, &(gpu_buffer_desc){.label = "target", .size = 4, .kind = GPU_BUFFER_READBACK});
    gpu_test_ok(target);
    for (uint32_t i = 0; i < 2; i++) use_and_destroy(g, target, i);
    gpu_test_ok(gpu_idle(g));
    uint64_t used = gpu_get_memory_use(g).used; // staging and uniforms are there by now
    for (uint32_t i = 2; i < 20; i++) use_and_destroy(g, target, i);
    gpu_test_ok(gpu_idle(g));
    assert_int_equal(*(const uint32_t *)gpu_buffer_map(target), 19);
    assert_int_equal(gpu_get_memory_use(g).used, used);
    gpu_buffer_destroy(g, target);
    gpu_image_destroy(g, NULL);
    gpu_buffer_destroy(g, NULL);
    gpu_pipeline_destroy(g, NULL);
}

static void unused_objects_give_their_memory_back(void **state) {
    gpu *g = *state;
    gpu_test_ok(gpu_idle(g));
    uint64_t reserved = gpu_get_memory_use(g).reserved;
    for (int i = 0; i < 200; i++) { // 200 times 64 MiB, without a frame between
        gpu_buffer *buffer =
            gpu_buffer_create(g, &(gpu_buffer_desc){.label = "large", .size = 64 << 20});
        gpu_test_ok(buffer);
        gpu_buffer_destroy(g, buffer);
    }
    gpu_test_ok(gpu_idle(g));
    assert_true(gpu_get_memory_use(g).reserved <= reserved);
}

static void *build_pipelines(void *user) {
    gpu *g = user;
    uintptr_t built = 0;
    for (int i = 0; i < 20; i++) {
        gpu_pipeline *pipeline = make_step(g);
        if (pipeline) built++;
        gpu_pipeline_destroy(g, pipeline);
    }
    return (void *)built;
}

static void pipelines_are_built_on_other_threads(void **state) {
    gpu *g = *state;
    pthread_t threads[2];
    gpu_pipeline *pipeline = make_step(g);
    gpu_test_ok(pipeline);
    gpu_buffer *buffer = make_buffer(g);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, build_pipelines, g), 0);
    }
    for (int i = 0; i < 30; i++) {
        gpu_test_ok(gpu_frame_begin(g));
        gpu_test_ok(step(g, pipeline, buffer, 1));
        gpu_test_ok(gpu_frame_end(g));
    }
    for (int i = 0; i < 2; i++) {
        void *built;
        pthread_join(threads[i], &built);
        assert_int_equal((uintptr_t)built, 20);
    }
    gpu_pipeline_destroy(g, pipeline);
    gpu_buffer_destroy(g, buffer);
}

static void every_call_on_a_lost_device_fails_with_a_message(void **state) {
    (void)state;
    gpu *g = gpu_test_open(NULL);
    gpu_pipeline *pipeline = make_step(g);
    gpu_test_ok(pipeline);
    gpu_buffer *buffer = make_buffer(g);
    gpu_image_desc desc = {.format = GPU_R8, .width = 4, .height = 4, .use = GPU_USE_SAMPLED};
    gpu_image *image = gpu_image_create(g, &desc);
    gpu_test_ok(image);
    uint8_t bytes[16] = {0};
    gpu_test_ok(gpu_frame_begin(g));
    gpu_test_ok(step(g, pipeline, buffer, 1));
    assert_false(gpu_is_lost(g));
    atomic_store(&g->lost, true); // what any call sets that the driver answers with "device lost"

    err_clear();
    assert_false(step(g, pipeline, buffer, 1));
    assert_non_null(strstr(err_get(), "was lost"));
    gpu_pass_begin(g, "pass");
    gpu_pass_end(g);
    gpu_image_clear(g, image, (const float[4]){0});
    gpu_buffer_fill(g, buffer, 1);
    assert_false(gpu_draw_all(g, &(gpu_draw_desc){.colors = {image}}));
    assert_false(gpu_image_write(g, image, 0, bytes, sizeof bytes));
    assert_false(gpu_buffer_write(g, buffer, 0, bytes, sizeof bytes));
    assert_false(gpu_present(g, image, NULL, 0));
    assert_false(gpu_frame_end(g));
    assert_int_equal(gpu_frame_begin(g), 0);
    assert_false(gpu_image_read(g, image, bytes, sizeof bytes));
    assert_false(gpu_buffer_read(g, buffer, 0, bytes, sizeof bytes));
    assert_false(gpu_idle(g));
    assert_false(gpu_frame_wait(g, 1));
    assert_int_equal(gpu_frame_times(g, 1, NULL, 0), 0);
    assert_null(gpu_image_create(g, &desc));
    assert_null(gpu_buffer_create(g, &(gpu_buffer_desc){.size = 4}));
    assert_null(make_step(g));
    assert_non_null(strstr(err_get(), "was lost"));
    gpu_image_destroy(g, image);
    gpu_buffer_destroy(g, buffer);
    gpu_pipeline_destroy(g, pipeline);
    assert_int_equal(gpu_validation_messages(g), 0);
    gpu_destroy(g);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_follow_each_other),
        cmocka_unit_test(passes_are_timed_in_order_and_never_negative),
        cmocka_unit_test(a_pass_is_timed_in_parts),
        cmocka_unit_test(passes_beyond_the_limit_run_untimed),
        cmocka_unit_test(destroyed_objects_live_until_their_frame_is_done),
        cmocka_unit_test(unused_objects_give_their_memory_back),
        cmocka_unit_test(pipelines_are_built_on_other_threads),
        cmocka_unit_test(every_call_on_a_lost_device_fails_with_a_message),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
