// Half floats, every one of them, and boxes.
#include "base_test.h"

#include "base/maths.h"
#include <math.h>

enum { HALF_INFINITY = 0x7c00, HALF_SIGN = 0x8000 };

// The definition, from the bits: sign, 5 bits of exponent, 10 of mantissa.
static double half_value(uint16_t bits) {
    int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return bits & HALF_SIGN ? -value : value;
}

static void every_half_has_its_value(void **state) {
    (void)state;
    for (uint32_t bits = 0; bits < 65536; bits++) {
        float value = half_to_float((uint16_t)bits);
        uint32_t magnitude = bits & 0x7fff;
        assert_int_equal(signbit(value) != 0, bits >> 15);
        if (magnitude > HALF_INFINITY)
            assert_true(isnan(value));
        else if (magnitude == HALF_INFINITY)
            assert_true(isinf(value));
        else
            assert_true((double)value == half_value((uint16_t)bits));
    }
}

static void every_half_survives_the_round_trip(void **state) {
    (void)state;
    for (uint32_t bits = 0; bits < 65536; bits++) {
        uint16_t back = half_from_float(half_to_float((uint16_t)bits));
        if ((bits & 0x7fff) > HALF_INFINITY) {
            assert_true((back & 0x7fff) > HALF_INFINITY);
            assert_int_equal(back >> 15, bits >> 15);
        } else {
            assert_int_equal(back, bits);
        }
    }
}

// Between each half and the next: below the middle goes down, above goes up, the middle to even.
// The middle after the largest half is 65520, from where infinity begins.
static void rounding_is_to_nearest_even(void **state) {
    (void)state;
    for (uint32_t bits = 0; bits < HALF_INFINITY; bits++) {
        double low = half_value((uint16_t)bits);
        double high = bits == HALF_INFINITY - 1 ? 65536 : half_value((uint16_t)(bits + 1));
        float middle = (float)((low + high) / 2); // exact: a float has 13 bits more
        uint32_t even = bits + (bits & 1);
        for (uint32_t sign = 0; sign <= HALF_SIGN; sign += HALF_SIGN) {
            float s = sign ? -1.0f : 1.0f;
            assert_int_equal(half_from_float(s * nextafterf(middle, 0)), sign | bits);
            assert_int_equal(half_from_float(s * middle), sign | even);
            assert_int_equal(half_from_float(s * nextafterf(middle, 1e9f)), sign | (bits + 1));
        }
    }
}

static void extremes_become_zero_and_infinity(void **state) {
    (void)state;
    assert_int_equal(half_from_float(65504), 0x7bff);
    assert_int_equal(half_from_float(1e30f), HALF_INFINITY);
    assert_int_equal(half_from_float(-INFINITY), HALF_SIGN | HALF_INFINITY);
    assert_int_equal(half_from_float(1e-30f), 0);
    assert_int_equal(half_from_float(-1e-30f), HALF_SIGN);
    assert_int_equal(half_from_float(1e-40f), 0); // subnormal as a float
    assert_true((half_from_float(NAN) & 0x7fff) > HALF_INFINITY);
}

static void assert_box(box3 b, float x0, float y0, float z0, float x1, float y1, float z1) {
    assert_true(b.min.x == x0 && b.min.y == y0 && b.min.z == z0);
    assert_true(b.max.x == x1 && b.max.y == y1 && b.max.z == z1);
}

static const box3 unit = {{0, 0, 0}, {1, 1, 1}}, shifted = {{0.5f, -1, 0}, {2, 0.5f, 3}};

static void boxes_meet_and_join(void **state) {
    (void)state;
    assert_box(box3_intersect(unit, shifted), 0.5f, 0, 0, 1, 0.5f, 1);
    assert_box(box3_union(unit, shifted), 0, -1, 0, 2, 1, 3);
    assert_box(box3_intersect(unit, box3_infinite()), 0, 0, 0, 1, 1, 1);
    box3 far = {{5, 5, 5}, {6, 6, 6}};
    assert_true(box3_is_empty(box3_intersect(unit, far)));
}

static void empty_box_adds_nothing(void **state) {
    (void)state;
    assert_true(box3_is_empty(box3_empty()));
    assert_box(box3_union(box3_empty(), unit), 0, 0, 0, 1, 1, 1);
    assert_box(box3_union(unit, box3_empty()), 0, 0, 0, 1, 1, 1);
    assert_true(box3_is_empty(box3_union(box3_empty(), box3_empty())));
    assert_true(box3_is_empty(box3_grow(box3_empty(), 100)));
    assert_true(box3_is_empty((box3){{0, 0, 0}, {1, 0, 1}})); // flat
    assert_true(box3_is_empty((box3){{NAN, 0, 0}, {1, 1, 1}}));
    assert_true(box3_is_empty(box3_intersect(unit, box3_empty())));
}

static void boxes_grow_and_shrink(void **state) {
    (void)state;
    assert_box(box3_grow(unit, 0.5f), -0.5f, -0.5f, -0.5f, 1.5f, 1.5f, 1.5f);
    assert_true(box3_is_empty(box3_grow(unit, -0.6f)));
}

static void infinite_boxes_are_told_from_finite_ones(void **state) {
    (void)state;
    assert_true(box3_is_finite(unit));
    assert_false(box3_is_finite(box3_infinite()));
    assert_false(box3_is_finite(box3_grow(box3_infinite(), 100)));
    assert_false(box3_is_finite((box3){{0, 0, 0}, {1, INFINITY, 1}}));
    assert_false(box3_is_finite((box3){{0, 0, NAN}, {1, 1, 1}}));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_has_its_value),
        cmocka_unit_test(every_half_survives_the_round_trip),
        cmocka_unit_test(rounding_is_to_nearest_even),
        cmocka_unit_test(extremes_become_zero_and_infinity),
        cmocka_unit_test(boxes_meet_and_join),
        cmocka_unit_test(empty_box_adds_nothing),
        cmocka_unit_test(boxes_grow_and_shrink),
        cmocka_unit_test(infinite_boxes_are_told_from_finite_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
