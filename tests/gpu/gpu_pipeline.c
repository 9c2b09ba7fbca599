// Pipelines: equal descriptions share what the driver made of them, others do not.
#include "gpu/vk.h"
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <pthread.h>
#include <string.h>

static const gpu_slot step_slots[] = {
    {.binding = 0, .kind = GPU_SLOT_UNIFORM},
    {.binding = 1, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true}};
static const gpu_compute_desc step_desc = {.label = "step",
                                           .code = step_comp_code,
                                           .code_size = sizeof step_comp_code,
                                           .slots = step_slots,
                                           .slot_count = COUNT_OF(step_slots),
                                           .local_size = {64, 1, 1}};

static const gpu_slot triangle_slots[] = {
    {.binding = 0, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true},
    {.binding = 1, .kind = GPU_SLOT_UNIFORM}};
static const gpu_graphics_desc triangle_desc = {.label = "triangle",
                                                .vertex_code = triangle_vert_code,
                                                .vertex_size = sizeof triangle_vert_code,
                                                .fragment_code = triangle_frag_code,
                                                .fragment_size = sizeof triangle_frag_code,
                                                .slots = triangle_slots,
                                                .slot_count = COUNT_OF(triangle_slots),
                                                .colors = {GPU_RGBA8}};

static size_t count_built(gpu *g) { // those in use
    size_t count = 0;
    for (int i = 0; i < VK_BUILT_ROWS; i++) {
        for (const vk_built *built = g->built[i]; built; built = built->next)
            count += built->references > 0;
    }
    return count;
}

static void last_ones_are_kept_for_a_while(void **state) {
    gpu *g = *state;
    gpu_pipeline *a = gpu_pipeline_create_compute(g, &step_desc);
    gpu_test_ok(a);
    const vk_built *built = a->built;
    gpu_pipeline_destroy(g, a);
    a = gpu_pipeline_create_compute(g, &step_desc);
    assert_ptr_equal(a->built, built);
    for (uint32_t i = 0; i < VK_BUILT_IDLE + 4; i++) {
        gpu_compute_desc other = step_desc;
        gpu_slot slots[GPU_MAX_SLOTS];
        memcpy(slots, step_desc.slots, step_desc.slot_count * sizeof *slots);
        slots[other.slot_count++] = (gpu_slot){.binding = 8 + i, .kind = GPU_SLOT_UNIFORM};
        other.slots = slots;
        gpu_pipeline *b = gpu_pipeline_create_compute(g, &other);
        gpu_test_ok(b);
        gpu_pipeline_destroy(g, b);
    }
    assert_int_equal(g->idle_count, VK_BUILT_IDLE);
    assert_int_equal(count_built(g), 1);
    gpu_pipeline_destroy(g, a);
    assert_int_equal(g->idle_count, VK_BUILT_IDLE);
}

static void equal_descriptions_share_and_keep_their_labels(void **state) {
    gpu *g = *state;
    gpu_compute_desc other = step_desc;
    other.label = "other";
    gpu_pipeline *a = gpu_pipeline_create_compute(g, &step_desc);
    gpu_pipeline *b = gpu_pipeline_create_compute(g, &other);
    gpu_test_ok(a && b);
    assert_ptr_equal(a->built, b->built);
    assert_int_equal(count_built(g), 1);
    assert_string_equal(a->label, "step");
    assert_string_equal(b->label, "other");
    gpu_pipeline_destroy(g, a);
    assert_int_equal(b->built->references, 1);
    assert_int_equal(count_built(g), 1);
    gpu_pipeline_destroy(g, b);
    assert_int_equal(count_built(g), 0);
}

static void any_difference_separates(void **state) {
    gpu *g = *state;
    gpu_graphics_desc descs[6];
    for (size_t i = 0; i < COUNT_OF(descs); i++) descs[i] = triangle_desc;
    gpu_slot wider[3] = {triangle_slots[0], triangle_slots[1], {.binding = 7}};
    descs[1].cull = GPU_CULL_BACK;
    descs[2].blend = true;
    descs[3].colors[0] = GPU_RGBA16F;
    descs[4].depth = GPU_D32F;
    descs[5].slots = wider;
    descs[5].slot_count = COUNT_OF(wider);
    gpu_pipeline *made[COUNT_OF(descs)];
    for (size_t i = 0; i < COUNT_OF(descs); i++) {
        made[i] = gpu_pipeline_create_graphics(g, &descs[i]);
        gpu_test_ok(made[i]);
    }
    assert_int_equal(count_built(g), COUNT_OF(descs));
    gpu_pipeline *again = gpu_pipeline_create_graphics(g, &descs[5]);
    gpu_test_ok(again);
    assert_ptr_equal(again->built, made[5]->built);
    gpu_pipeline_destroy(g, again);
    for (size_t i = 0; i < COUNT_OF(descs); i++) gpu_pipeline_destroy(g, made[i]);
    assert_int_equal(count_built(g), 0);
}

static void run_step(gpu *g, gpu_pipeline *pipeline, gpu_buffer *buffer) {
    const uint32_t params[3] = {1, 1, 64};
    const gpu_binding bindings[] = {
        {.binding = 0, .uniform = params, .uniform_size = sizeof params},
        {.binding = 1, .buffer = buffer}};
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = COUNT_OF(bindings),
                                                     .threads = {64, 1, 1}}));
}

// As a reload does it: the new pipeline is made before the old one goes, both within a frame.
static void survivor_works_when_the_first_has_gone(void **state) {
    gpu *g = *state;
    gpu_buffer *buffer = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "data", .size = 256});
    gpu_pipeline *old = gpu_pipeline_create_compute(g, &step_desc);
    gpu_test_ok(buffer && old);
    gpu_test_ok(gpu_frame_begin(g));
    gpu_buffer_fill(g, buffer, 0);
    run_step(g, old, buffer);
    gpu_pipeline *new = gpu_pipeline_create_compute(g, &step_desc);
    gpu_test_ok(new);
    gpu_pipeline_destroy(g, old);
    run_step(g, new, buffer);
    gpu_test_ok(gpu_frame_end(g));
    gpu_test_ok(gpu_idle(g));
    gpu_test_ok(gpu_frame_begin(g));
    run_step(g, new, buffer);
    gpu_pipeline_destroy(g, new);
    gpu_test_ok(gpu_frame_end(g));
    uint32_t found[64];
    gpu_test_ok(gpu_buffer_read(g, buffer, 0, found, sizeof found));
    assert_int_equal(found[63], 3);
    gpu_buffer_destroy(g, buffer);
}

static void broken_code_is_refused_and_leaves_nothing(void **state) {
    gpu *g = *state;
    static const uint32_t text[8] = {0x6e69616d};
    gpu_compute_desc wrong = step_desc;
    wrong.code = text;
    wrong.code_size = sizeof text;
    assert_null(gpu_pipeline_create_compute(g, &wrong));
    assert_non_null(strstr(err_get(), "'step': the shader code is not SPIR-V"));
    gpu_graphics_desc half = triangle_desc;
    half.fragment_code = NULL;
    assert_null(gpu_pipeline_create_graphics(g, &half));
    assert_non_null(strstr(err_get(), "'triangle': the shader code is not SPIR-V"));
    assert_int_equal(count_built(g), 0);
}

enum { THREADS = 4, ROUNDS = 25 };

static void *share_with_others(void *user) {
    gpu *g = user;
    for (int i = 0; i < ROUNDS; i++) {
        gpu_pipeline *a = gpu_pipeline_create_compute(g, &step_desc);
        gpu_pipeline *b = gpu_pipeline_create_compute(g, &step_desc);
        if (!a || !b || a->built != b->built) return "not shared";
        gpu_pipeline_destroy(g, a);
        gpu_pipeline_destroy(g, b);
    }
    return NULL;
}

static void threads_share_without_losing_count(void **state) {
    gpu *g = *state;
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, share_with_others, g), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        void *fault;
        pthread_join(threads[i], &fault);
        assert_null(fault);
    }
    assert_int_equal(count_built(g), 0);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_descriptions_share_and_keep_their_labels),
        cmocka_unit_test(last_ones_are_kept_for_a_while),
        cmocka_unit_test(any_difference_separates),
        cmocka_unit_test(survivor_works_when_the_first_has_gone),
        cmocka_unit_test(broken_code_is_refused_and_leaves_nothing),
        cmocka_unit_test(threads_share_without_losing_count),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
