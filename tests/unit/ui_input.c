// Which of the user's doings a frame sees together.
#include "base_test.h"

#include "base/memory.h"
#include "ui/input.h"
#include <stdio.h>
#include <string.h>

enum { UP, DOWN }; // as GLFW counts

static input_queue q;

static void move(double x) {
    input_push(&q, &(input_event){.kind = INPUT_MOVE, .x = x});
}
static void wheel(double y) {
    input_push(&q, &(input_event){.kind = INPUT_WHEEL, .y = y});
}
static void button(int action) {
    input_push(&q, &(input_event){.kind = INPUT_BUTTON, .action = action});
}
static void key(int code, int action) {
    input_push(&q, &(input_event){.kind = INPUT_KEY, .code = code, .action = action});
}
static void letter(int code) {
    input_push(&q, &(input_event){.kind = INPUT_CHAR, .code = code});
}

// One frame, as text: "m3 b1" is a move to 3, then a button going down.
static void expect_frame(const char *expected) {
    input_frame frame = {0};
    input_event e;
    char seen[512] = "", one[32];
    while (input_take(&q, &frame, &e)) {
        double number = e.kind == INPUT_MOVE    ? e.x
                        : e.kind == INPUT_WHEEL ? e.y
                        : e.kind == INPUT_CHAR  ? e.code
                                                : e.action;
        snprintf(one, sizeof one, "%s%c%g", *seen ? " " : "", "mwbkc"[e.kind], number);
        strncat(seen, one, sizeof seen - strlen(seen) - 1);
    }
    assert_string_equal(seen, expected);
}

static int empty(void **state) {
    (void)state;
    q = (input_queue){0};
    return 0;
}

static void moves_are_one(void **state) {
    (void)state;
    for (int i = 1; i <= 5; i++) move(i);
    expect_frame("m5");
    expect_frame("");
}

static void a_fast_drag_keeps_its_ends(void **state) {
    (void)state;
    move(1);
    button(DOWN);
    move(2);
    move(3);
    button(UP);
    move(9);
    expect_frame("m1 b1"); // pressed where it began
    expect_frame("m3");    // moved while down
    expect_frame("b0");    // released where it ended
    expect_frame("m9");
}

static void a_click_is_seen_down_for_a_frame(void **state) {
    (void)state;
    button(DOWN);
    button(UP);
    button(DOWN);
    button(UP);
    for (int i = 0; i < 2; i++) {
        expect_frame("b1");
        expect_frame("b0");
    }
}

static void a_tap_is_seen_down_for_a_frame(void **state) {
    (void)state;
    key(65, DOWN);
    letter('a');
    key(65, UP);
    key(66, DOWN);
    expect_frame("k1 c97");
    expect_frame("k0 k1");
}

static void keys_wait_for_a_click(void **state) {
    (void)state;
    button(DOWN);
    button(UP);
    key(264, DOWN);
    expect_frame("b1");
    expect_frame("b0");
    expect_frame("k1");
}

static void the_wheel_turns_where_the_pointer_was(void **state) {
    (void)state;
    move(1);
    wheel(1);
    wheel(1);
    move(2);
    expect_frame("m1 w2");
    expect_frame("m2");
}

static void a_full_queue_forgets_the_oldest(void **state) {
    (void)state;
    for (int i = 0; i < INPUT_EVENTS + 10; i++) letter(i);
    input_frame frame = {0};
    input_event e;
    assert_true(input_take(&q, &frame, &e));
    assert_int_equal(e.code, 10);
    assert_int_equal(q.count, INPUT_EVENTS - 1);
}

static void a_move_alone_is_no_act(void **state) {
    (void)state;
    assert_false(input_acts(&q));
    move(1);
    assert_false(input_acts(&q));
    key(264, DOWN);
    move(2);
    assert_true(input_acts(&q));
    expect_frame("m1 k1 m2");
    assert_false(input_acts(&q));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(moves_are_one, empty),
        cmocka_unit_test_setup(a_fast_drag_keeps_its_ends, empty),
        cmocka_unit_test_setup(a_click_is_seen_down_for_a_frame, empty),
        cmocka_unit_test_setup(a_tap_is_seen_down_for_a_frame, empty),
        cmocka_unit_test_setup(keys_wait_for_a_click, empty),
        cmocka_unit_test_setup(the_wheel_turns_where_the_pointer_was, empty),
        cmocka_unit_test_setup(a_move_alone_is_no_act, empty),
        cmocka_unit_test_setup(a_full_queue_forgets_the_oldest, empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
