// The cases of the hazard tracker, one by one.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gpu/hazard.h"

#define COMPUTE VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT
#define FRAGMENT VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
#define TRANSFER VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT
#define LOADS VK_ACCESS_2_SHADER_STORAGE_READ_BIT
#define STORES VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT
#define SAMPLES VK_ACCESS_2_SHADER_SAMPLED_READ_BIT
#define COPIES VK_ACCESS_2_TRANSFER_WRITE_BIT

static const hazard_access buffer_store = {.stages = COMPUTE, .writes = STORES};
static const hazard_access buffer_load = {.stages = COMPUTE, .reads = LOADS};
static const hazard_access buffer_load_in_fragment = {.stages = FRAGMENT, .reads = LOADS};
static const hazard_access image_store = {
    .stages = COMPUTE, .writes = STORES, .layout = VK_IMAGE_LAYOUT_GENERAL};
static const hazard_access image_load = {
    .stages = COMPUTE, .reads = LOADS, .layout = VK_IMAGE_LAYOUT_GENERAL};
static const hazard_access image_sample = {
    .stages = COMPUTE, .reads = SAMPLES, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
static const hazard_access image_sample_in_fragment = {
    .stages = FRAGMENT, .reads = SAMPLES, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
static const hazard_access image_copy = {
    .stages = TRANSFER, .writes = COPIES, .layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};

static void first_use_of_a_buffer_needs_nothing(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state written = {0}, read = {0};
    assert_false(hazard_track(&written, &buffer_store, &b));
    assert_false(hazard_track(&read, &buffer_load, &b));
}

static void read_after_write_sees_the_write(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_track(&s, &buffer_store, &b);
    assert_true(hazard_track(&s, &buffer_load, &b));
    assert_true(b.source_stages == COMPUTE && b.source_access == STORES);
    assert_true(b.stages == COMPUTE && b.access == LOADS);
}

static void write_after_read_waits_for_every_reader(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_track(&s, &buffer_load, &b);
    hazard_track(&s, &buffer_load_in_fragment, &b);
    assert_true(hazard_track(&s, &buffer_store, &b));
    assert_true(b.source_stages == (COMPUTE | FRAGMENT) && b.source_access == 0);
    assert_true(b.stages == COMPUTE);
}

static void write_after_write_is_ordered(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_track(&s, &buffer_store, &b);
    assert_true(hazard_track(&s, &buffer_store, &b));
    assert_true(b.source_stages == COMPUTE && b.source_access == STORES && b.access == STORES);
}

static void second_read_by_the_same_stage_needs_nothing(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_track(&s, &buffer_store, &b);
    assert_true(hazard_track(&s, &buffer_load, &b));
    assert_false(hazard_track(&s, &buffer_load, &b));
}

static void second_read_by_another_stage_waits_for_the_write(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_track(&s, &buffer_store, &b);
    hazard_track(&s, &buffer_load, &b);
    assert_true(hazard_track(&s, &buffer_load_in_fragment, &b));
    assert_true(b.source_stages == COMPUTE && b.source_access == STORES);
    assert_true((b.stages & FRAGMENT) && (b.access & LOADS));
    assert_false(hazard_track(&s, &buffer_load, &b));
    assert_false(hazard_track(&s, &buffer_load_in_fragment, &b));
}

// A stage that saw the write through one access, and another access through another stage, has not
// seen it through that access.
static void stages_and_accesses_are_covered_in_pairs(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_access uniform = {.stages = FRAGMENT, .reads = VK_ACCESS_2_UNIFORM_READ_BIT};
    hazard_access both = {.stages = FRAGMENT, .reads = LOADS};
    hazard_track(&s, &buffer_store, &b);
    hazard_track(&s, &buffer_load, &b);
    assert_true(hazard_track(&s, &uniform, &b));
    assert_true(b.stages == (COMPUTE | FRAGMENT));
    assert_true(b.access == (LOADS | VK_ACCESS_2_UNIFORM_READ_BIT));
    assert_false(hazard_track(&s, &both, &b));
}

static void reading_and_writing_in_place_is_ordered_each_time(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_access update = {.stages = COMPUTE, .reads = LOADS, .writes = STORES};
    assert_false(hazard_track(&s, &update, &b));
    for (int i = 0; i < 3; i++) {
        assert_true(hazard_track(&s, &update, &b));
        assert_true(b.source_stages == COMPUTE && b.source_access == STORES);
        assert_true(b.access == (LOADS | STORES));
    }
}

static void first_use_of_an_image_gives_it_a_layout(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    assert_true(hazard_track(&s, &image_store, &b));
    assert_true(b.source_stages == 0 && b.source_access == 0);
    assert_int_equal(b.old_layout, VK_IMAGE_LAYOUT_UNDEFINED);
    assert_int_equal(b.layout, VK_IMAGE_LAYOUT_GENERAL);
}

static void change_of_layout_waits_for_readers_and_writer(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_track(&s, &image_copy, &b);
    assert_true(hazard_track(&s, &image_sample_in_fragment, &b));
    assert_true(b.source_stages == TRANSFER && b.source_access == COPIES);
    assert_int_equal(b.old_layout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    assert_true(hazard_track(&s, &image_load, &b)); // a read, but the layout changes
    assert_true((b.source_stages & FRAGMENT) != 0);
    assert_int_equal(b.old_layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    assert_int_equal(b.layout, VK_IMAGE_LAYOUT_GENERAL);
}

// The change of layout is itself a write, which other stages have not seen.
static void another_stage_waits_for_the_change_of_layout(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state s = {0};
    hazard_track(&s, &image_store, &b);
    hazard_track(&s, &image_sample, &b);
    assert_false(hazard_track(&s, &image_sample, &b));
    assert_true(hazard_track(&s, &image_sample_in_fragment, &b));
    assert_true(b.source_stages == COMPUTE);
    assert_true(b.old_layout == b.layout);
}

static void levels_are_tracked_apart(void **state) {
    (void)state;
    hazard_barrier b;
    hazard_state levels[3] = {{0}};
    for (int i = 0; i < 3; i++) hazard_track(&levels[i], &image_store, &b);
    for (int i = 0; i < 2; i++) { // sample level i, store level i + 1
        assert_true(hazard_track(&levels[i], &image_sample, &b));
        assert_int_equal(b.old_layout, VK_IMAGE_LAYOUT_GENERAL);
        assert_true(hazard_track(&levels[i + 1], &image_store, &b));
        assert_int_equal(b.old_layout, VK_IMAGE_LAYOUT_GENERAL);
    }
    assert_int_equal(levels[0].layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    assert_int_equal(levels[2].layout, VK_IMAGE_LAYOUT_GENERAL);
}

static void one_command_merges_its_uses(void **state) {
    (void)state;
    hazard_access a = image_load;
    assert_true(hazard_merge(&a, &image_store));
    assert_true(a.reads == LOADS && a.writes == STORES);
    a = image_sample;
    assert_true(hazard_merge(&a, &image_load));
    assert_int_equal(a.layout, VK_IMAGE_LAYOUT_GENERAL);
    assert_true(a.reads == (SAMPLES | LOADS));
}

static void one_command_cannot_sample_what_it_writes(void **state) {
    (void)state;
    hazard_access a = image_sample;
    assert_false(hazard_merge(&a, &image_store));
    a = image_store;
    assert_false(hazard_merge(&a, &image_sample));
    a = image_copy;
    assert_false(hazard_merge(&a, &image_sample));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_use_of_a_buffer_needs_nothing),
        cmocka_unit_test(read_after_write_sees_the_write),
        cmocka_unit_test(write_after_read_waits_for_every_reader),
        cmocka_unit_test(write_after_write_is_ordered),
        cmocka_unit_test(second_read_by_the_same_stage_needs_nothing),
        cmocka_unit_test(second_read_by_another_stage_waits_for_the_write),
        cmocka_unit_test(stages_and_accesses_are_covered_in_pairs),
        cmocka_unit_test(reading_and_writing_in_place_is_ordered_each_time),
        cmocka_unit_test(first_use_of_an_image_gives_it_a_layout),
        cmocka_unit_test(change_of_layout_waits_for_readers_and_writer),
        cmocka_unit_test(another_stage_waits_for_the_change_of_layout),
        cmocka_unit_test(levels_are_tracked_apart),
        cmocka_unit_test(one_command_merges_its_uses),
        cmocka_unit_test(one_command_cannot_sample_what_it_writes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
