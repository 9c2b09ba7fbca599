// Numbers in sliders: from value to bar and back, how they are written, how they are typed.
#include "base_test.h"

#include "base/memory.h"
#include "ui/parts.h"
#include <math.h>

static const number_range linear = {0, 200, false, false}, logarithmic = {0.1, 10, true, false},
                          from_zero = {0, 1000, true, false}, whole = {8, 1024, false, true},
                          free_range = {(double)-INFINITY, (double)INFINITY, false, false};

static void shares_go_there_and_back(void **state) {
    (void)state;
    const number_range *const ranges[] = {&linear, &logarithmic, &from_zero, &whole};
    for (size_t i = 0; i < COUNT_OF(ranges); i++) {
        assert_true(number_to_share(ranges[i], ranges[i]->min) == 0);
        assert_true(fabs(number_to_share(ranges[i], ranges[i]->max) - 1) < 1e-12);
        for (double share = 0; share <= 1; share += 0.01) {
            double value = number_from_share(ranges[i], share);
            assert_true(value >= ranges[i]->min - 1e-9 && value <= ranges[i]->max + 1e-9);
            assert_true(fabs(number_to_share(ranges[i], value) - share) < 1e-9);
        }
    }
    assert_true(fabs(number_from_share(&logarithmic, 0.5) - 1) < 1e-12); // the middle of 0.1 to 10
}

static void dragging_the_whole_width_crosses_the_range(void **state) {
    (void)state;
    assert_true(fabs(number_drag(&linear, 50, 100, 200) - 150) < 1e-9);
    assert_true(number_drag(&linear, 50, 1e6, 200) == 200);
    assert_true(fabs(number_drag(&logarithmic, 0.1, 200, 200) - 10) < 1e-9);
    assert_true(number_drag(&free_range, 0, 10, 200) > 0); // zero can be left
    const number_range wide = {1e-6, 1e6, true, false};    // a limit, and no bar
    assert_true(!number_is_bounded(&wide) && number_is_bounded(&logarithmic));
    assert_true(fabs(number_drag(&wide, 2, 10, 200) - 2.2) < 1e-9);
    assert_true(number_drag(&wide, 1e6, 10, 200) == 1e6);
}

static void text(const number_range *r, double value, const char *expected) {
    char out[64];
    number_text(r, value, out, sizeof out);
    assert_string_equal(out, expected);
}

static void are_written_as_finely_as_can_be_seen(void **state) {
    (void)state;
    text(&linear, 20, "20.0");
    text(&linear, 20.125, "20.125"); // typed
    text(&whole, 128, "128");
    text(&logarithmic, 1, "1.000");
    text(&free_range, 0, "0.000");
    text(&free_range, 12345, "12345");
    text(&linear, (double)3.3f, "3.3");
}

static void are_rounded_to_what_is_written(void **state) {
    (void)state;
    assert_true(number_round(&linear, 20.123) == 20.1);
    assert_true(number_round(&whole, 63.6) == 64);
    assert_true(number_round(&linear, 250) == 200);
}

static void typing_takes_numbers_within_the_range(void **state) {
    (void)state;
    double value = -7;
    assert_true(number_parse(&linear, " 12.5 ", &value) && value == 12.5);
    assert_true(number_parse(&linear, "1e9", &value) && value == 200);
    assert_true(number_parse(&whole, "63.7", &value) && value == 64);
    value = -7;
    static const char *const wrong[] = {"", "abc", "12x", "nan", "inf", "1 2"};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        assert_false(number_parse(&linear, wrong[i], &value));
        assert_true(value == -7);
    }
}

static void what_was_typed_waits_for_its_widget(void **state) {
    (void)state;
    number_typing t = {0};
    double first = 1, second = 2;
    number_type_begin(&t, 11, &linear, first);
    assert_string_equal(t.text, "1.0");
    strcpy(t.text, "42");
    number_type_begin(&t, 22, &linear, second); // Tab: the second is asked first
    assert_false(number_type_take(&t, 22, &linear, &second));
    assert_true(number_type_take(&t, 11, &linear, &first));
    assert_true(first == 42);
    number_type_leave(&t); // untouched
    assert_false(number_type_take(&t, 22, &linear, &second));
    assert_true(second == 2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_go_there_and_back),
        cmocka_unit_test(dragging_the_whole_width_crosses_the_range),
        cmocka_unit_test(are_written_as_finely_as_can_be_seen),
        cmocka_unit_test(are_rounded_to_what_is_written),
        cmocka_unit_test(typing_takes_numbers_within_the_range),
        cmocka_unit_test(what_was_typed_waits_for_its_widget),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
