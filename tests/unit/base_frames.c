// Frames as people write them.
#include "base/error.h"
#include "base/frames.h"
#include "base/memory.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void frames_are(const char *text, size_t count, double first, double last) {
    double *numbers;
    size_t found;
    if (!frames_parse(text, &numbers, &found)) fail_msg("%s", err_get());
    assert_int_equal(found, count);
    assert_true(numbers[0] == first && numbers[count - 1] == last);
    mem_free(numbers);
}

static void lists_and_ranges_are_read(void **state) {
    (void)state;
    frames_are("30", 1, 30, 30);
    frames_are("10,30,50", 3, 10, 50);
    frames_are("0-99", 100, 0, 99);
    frames_are("0-99:2", 50, 0, 98);
    frames_are("1-2:0.25", 5, 1, 2);
    frames_are("5,0-2,7", 5, 5, 7);
}

static void all_else_is_refused(void **state) {
    (void)state;
    static const char *const wrong[] = {"",    "x",   "-1",     "3-",    "3-2",       "1-5:0",
                                        "1,",  "1;2", "1-5:-1", "1e999", "0-9999999", "0x10",
                                        "1 2", "nan", "1-5:",   ",1",    "0-1:1e-9",  "1-2-3"};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        double *numbers;
        size_t count;
        if (frames_parse(wrong[i], &numbers, &count)) fail_msg("'%s' was taken", wrong[i]);
        assert_non_null(strstr(err_get(), "accepted: 30, or 10,30,50"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_and_ranges_are_read),
        cmocka_unit_test(all_else_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
