// Steps of what hands did: gestures, undone and done again.
#include "base_test.h"

#include "app/undo.h"
#include "base/memory.h"
#include <stdio.h>
#include <string.h>

static void step_is(const undo_step *s, const char *label, const char *name, const char *before,
                    const char *after) {
    assert_non_null(s);
    assert_string_equal(s->label, label);
    assert_string_equal(s->values[0].name, name);
    if (before)
        assert_string_equal(s->values[0].before, before);
    else
        assert_null(s->values[0].before);
    if (after)
        assert_string_equal(s->values[0].after, after);
    else
        assert_null(s->values[0].after);
}

static void a_gesture_is_one_step(void **state) {
    (void)state;
    undo *u = mem_alloc(sizeof *u);
    undo_note(u, "density", NULL, "1", 0);
    undo_frame(u, true);
    undo_note(u, "density", "1", "2", 0.1);
    undo_frame(u, true);
    undo_note(u, "density", "2", "3", 0.2);
    undo_frame(u, false); // let go
    undo_note(u, "density", "3", "4", 0.3);
    assert_int_equal(u->count, 2);
    step_is(undo_back(u), "density", "density", "3", "4");
    step_is(undo_back(u), "density", "density", NULL, "3");
    assert_null(undo_back(u));
    step_is(undo_again(u), "density", "density", NULL, "3");
    step_is(undo_again(u), "density", "density", "3", "4");
    assert_null(undo_again(u));
    undo_free(u);
    mem_free(u);
}

static void what_is_done_anew_replaces_what_was_undone(void **state) {
    (void)state;
    undo *u = mem_alloc(sizeof *u);
    for (int i = 0; i < 3; i++) {
        char name[] = "a";
        name[0] += (char)i;
        undo_note(u, name, NULL, "1", i);
        undo_frame(u, false);
    }
    undo_back(u);
    undo_back(u);
    undo_note(u, "d", NULL, "5", 9);
    assert_int_equal(u->count, 2);
    assert_null(undo_again(u));
    step_is(undo_back(u), "d", "d", NULL, "5");
    step_is(undo_back(u), "a", "a", NULL, "1");
    undo_free(u);
    mem_free(u);
}

static void values_together_have_a_label(void **state) {
    (void)state;
    undo *u = mem_alloc(sizeof *u);
    undo_note(u, "camera.eye", NULL, "1,2,3", 0);
    undo_note(u, "camera.target", NULL, "0,0,0", 0);
    assert_string_equal(u->steps[0].label, "camera");
    undo_frame(u, false);
    undo_note(u, "camera.eye", "1,2,3", "2,2,3", 0.3); // the wheel, turned on
    assert_int_equal(u->count, 1);
    undo_frame(u, false);
    undo_note(u, "camera.eye", "2,2,3", "4,2,3", 1.3); // later
    assert_int_equal(u->count, 2);
    undo_frame(u, false);
    undo_note(u, "density", NULL, "1", 2);
    undo_note(u, "steps", "3", NULL, 2);
    assert_string_equal(u->steps[2].label, "2 values");
    undo_label(u, "preset %s", "warm");
    assert_string_equal(u->steps[2].label, "preset warm");
    undo_free(u);
    mem_free(u);
}

static void what_comes_back_is_no_step(void **state) {
    (void)state;
    undo *u = mem_alloc(sizeof *u);
    undo_note(u, "density", NULL, "1", 0);
    undo_note(u, "density", "1", NULL, 0); // within the gesture
    assert_int_equal(u->count, 0);
    assert_null(undo_back(u));
    undo_note(u, "density", "1", "1", 1);
    assert_int_equal(u->count, 0);
    undo_free(u);
    mem_free(u);
}

static void the_oldest_are_forgotten(void **state) {
    (void)state;
    undo *u = mem_alloc(sizeof *u);
    for (int i = 0; i < UNDO_STEPS + 7; i++) {
        char before[16], after[16];
        snprintf(before, sizeof before, "%d", i);
        snprintf(after, sizeof after, "%d", i + 1);
        undo_note(u, "a", before, after, i);
        undo_frame(u, false);
    }
    assert_int_equal(u->count, UNDO_STEPS);
    for (int i = 0; i < UNDO_STEPS - 1; i++) undo_back(u);
    step_is(undo_back(u), "a", "a", "7", "8");
    assert_null(undo_back(u));
    undo_free(u);
    mem_free(u);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gesture_is_one_step),
        cmocka_unit_test(what_is_done_anew_replaces_what_was_undone),
        cmocka_unit_test(values_together_have_a_label),
        cmocka_unit_test(what_comes_back_is_no_step),
        cmocka_unit_test(the_oldest_are_forgotten),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
