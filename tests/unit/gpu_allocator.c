// The offset allocator against an oracle that marks every byte.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "gpu/allocator.h"

static uint32_t random_next(uint32_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

typedef struct entry {
    allocator_place place;
    uint64_t size;
} entry;

enum { RANGE = 4096, MOST = 200 };

typedef struct oracle {
    bool taken[RANGE];
    entry list[MOST];
    size_t count;
    uint64_t used;
} oracle;

static bool fits_somewhere(const oracle *o, uint64_t size, uint64_t alignment) {
    for (uint64_t at = 0; at + size <= RANGE; at += alignment) {
        uint64_t i = 0;
        while (i < size && !o->taken[at + i]) i++;
        if (i == size) return true;
    }
    return false;
}

static void oracle_mark(oracle *o, uint64_t offset, uint64_t size, bool taken) {
    for (uint64_t i = offset; i < offset + size; i++) {
        assert_true(o->taken[i] != taken);
        o->taken[i] = taken;
    }
    o->used += taken ? size : -size;
}

static void take_one(allocator *a, oracle *o, uint32_t *seed) {
    uint64_t size = 1 + random_next(seed) % 300, alignment = UINT64_C(1) << random_next(seed) % 9;
    allocator_place place;
    bool fits = fits_somewhere(o, size, alignment);
    assert_int_equal(allocator_alloc(a, size, alignment, &place), fits);
    if (!fits) return;
    assert_true(place.offset % alignment == 0 && place.offset + size <= RANGE);
    oracle_mark(o, place.offset, size, true);
    o->list[o->count++] = (entry){place, size};
}

static void free_one(allocator *a, oracle *o, uint32_t *seed) {
    size_t i = random_next(seed) % o->count;
    allocator_free(a, o->list[i].place.span);
    oracle_mark(o, o->list[i].place.offset, o->list[i].size, false);
    o->list[i] = o->list[--o->count];
}

static void random_work_agrees_with_the_oracle(void **state) {
    (void)state;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        uint32_t random = seed * 2654435761u;
        oracle o = {0};
        allocator a;
        allocator_init(&a, RANGE);
        for (int i = 0; i < 2000; i++) {
            bool grow = o.count == 0 || (o.count < MOST && random_next(&random) % 5 < 3);
            if (grow) {
                take_one(&a, &o, &random);
            } else {
                free_one(&a, &o, &random);
            }
            assert_int_equal(a.used, o.used);
        }
        while (o.count > 0) free_one(&a, &o, &random);
        assert_int_equal(a.used, 0);
        assert_int_equal(allocator_largest_hole(&a), RANGE);
        allocator_deinit(&a);
    }
}

static void freed_neighbours_become_one_hole(void **state) {
    (void)state;
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                     {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int order = 0; order < 6; order++) {
        allocator a;
        allocator_place p[3], all;
        allocator_init(&a, 300);
        for (int i = 0; i < 3; i++) assert_true(allocator_alloc(&a, 100, 1, &p[i]));
        assert_int_equal(allocator_largest_hole(&a), 0);
        for (int i = 0; i < 3; i++) allocator_free(&a, p[orders[order][i]].span);
        assert_true(allocator_alloc(&a, 300, 1, &all));
        assert_int_equal(all.offset, 0);
        allocator_deinit(&a);
    }
}

static void smallest_fitting_hole_is_taken(void **state) {
    (void)state;
    allocator a;
    allocator_place p[5], small;
    static const uint64_t sizes[5] = {200, 10, 60, 10, 100};
    allocator_init(&a, 380);
    for (int i = 0; i < 5; i++) assert_true(allocator_alloc(&a, sizes[i], 1, &p[i]));
    allocator_free(&a, p[0].span);
    allocator_free(&a, p[2].span);
    allocator_free(&a, p[4].span);
    assert_true(allocator_alloc(&a, 50, 1, &small));
    assert_int_equal(small.offset, p[2].offset);
    allocator_deinit(&a);
}

static void alignment_leaves_the_gap_usable(void **state) {
    (void)state;
    allocator a;
    allocator_place one, aligned, gap;
    allocator_init(&a, 1024);
    assert_true(allocator_alloc(&a, 1, 1, &one));
    assert_true(allocator_alloc(&a, 256, 256, &aligned));
    assert_int_equal(aligned.offset, 256);
    assert_true(allocator_alloc(&a, 255, 1, &gap));
    assert_int_equal(gap.offset, 1);
    allocator_deinit(&a);
}

static void sizes_beyond_the_range_are_refused(void **state) {
    (void)state;
    allocator a;
    allocator_place p;
    allocator_init(&a, 1024);
    assert_false(allocator_alloc(&a, 1025, 1, &p));
    assert_false(allocator_alloc(&a, UINT64_MAX, UINT64_C(1) << 63, &p));
    assert_true(allocator_alloc(&a, 1, 1, &p));
    assert_false(allocator_alloc(&a, UINT64_MAX, 2, &p));
    assert_false(allocator_alloc(&a, 1, UINT64_C(1) << 63, &p));
    assert_int_equal(a.used, 1);
    allocator_deinit(&a);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_work_agrees_with_the_oracle),
        cmocka_unit_test(freed_neighbours_become_one_hole),
        cmocka_unit_test(smallest_fitting_hole_is_taken),
        cmocka_unit_test(alignment_leaves_the_gap_usable),
        cmocka_unit_test(sizes_beyond_the_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
