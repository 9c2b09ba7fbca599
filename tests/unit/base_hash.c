// Content hashes: those of XXH3, equal on every machine, sensitive to every byte and to the order.
#include "base_test.h"

#include "base/hash.h"

static bool same(hash128 a, hash128 b) {
    return a.low == b.low && a.high == b.high;
}

static void hashes_are_those_of_xxh3(void **state) {
    (void)state;
    char hex[33];
    hash_to_hex(hash_bytes("", 0), hex);
    assert_string_equal(hex, "99aa06d3014798d86001c324468d497f");
    assert_true(hash64("", 0) == UINT64_C(0x2d06800538d394c2));
}

static void hex_shows_leading_zeros(void **state) {
    (void)state;
    char hex[33];
    hash_to_hex((hash128){.low = 0xab, .high = 1}, hex);
    assert_string_equal(hex, "000000000000000100000000000000ab");
}

static void every_bit_matters(void **state) {
    (void)state;
    unsigned char data[300] = {0};
    hash128 before = hash_bytes(data, sizeof data);
    for (size_t bit = 0; bit < 8 * sizeof data; bit++) {
        data[bit / 8] ^= (unsigned char)(1u << bit % 8);
        assert_false(same(hash_bytes(data, sizeof data), before));
        data[bit / 8] ^= (unsigned char)(1u << bit % 8);
    }
    assert_true(same(hash_bytes(data, sizeof data), before));
    for (size_t size = 0; size < sizeof data; size++)
        assert_false(same(hash_bytes(data, size), before));
}

static void order_of_combining_matters(void **state) {
    (void)state;
    hash128 a = hash_bytes("a", 1), b = hash_bytes("b", 1), c = hash_bytes("c", 1);
    assert_true(same(hash_combine(a, b), hash_combine(a, b)));
    assert_false(same(hash_combine(a, b), hash_combine(b, a)));
    assert_false(same(hash_combine(a, a), a));
    assert_false(same(hash_combine(hash_combine(a, b), c), hash_combine(a, hash_combine(b, c))));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hashes_are_those_of_xxh3),
        cmocka_unit_test(hex_shows_leading_zeros),
        cmocka_unit_test(every_bit_matters),
        cmocka_unit_test(order_of_combining_matters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
