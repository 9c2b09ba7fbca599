// The arena: every object aligned, zeroed, its own, and in place until all are freed together.
#include "base_test.h"

#include "base/arena.h"
#include "base/memory.h"

enum { OBJECTS = 3000, BIG = 1 << 20 };

static void objects_are_aligned_and_zeroed(void **state) {
    (void)state;
    arena a = {0};
    for (size_t size = 0; size < 600; size++) {
        unsigned char *object = arena_alloc(&a, size);
        assert_int_equal((uintptr_t)object % 16, 0);
        for (size_t i = 0; i < size; i++) assert_int_equal(object[i], 0);
        memset(object, 0xff, size);
    }
    arena_free(&a);
    assert_null(a.block);
}

// Sizes from nothing to far beyond a block; each object is filled with its own number.
static void objects_neither_move_nor_overlap(void **state) {
    (void)state;
    static unsigned char *objects[OBJECTS];
    static size_t sizes[OBJECTS];
    arena a = {0};
    uint32_t random = 1;
    for (size_t i = 0; i < OBJECTS; i++) {
        random = random * 1664525u + 1013904223u;
        sizes[i] = i % 100 == 7 ? 20000 + (random >> 14) : random >> 24;
        objects[i] = arena_alloc(&a, sizes[i]);
        memset(objects[i], (int)(i % 251), sizes[i]);
    }
    for (size_t i = 0; i < OBJECTS; i++)
        for (size_t k = 0; k < sizes[i]; k++) assert_int_equal(objects[i][k], i % 251);
    arena_free(&a);
}

static void large_object_leaves_the_block_in_use(void **state) {
    (void)state;
    arena a = {0};
    char *before = arena_alloc(&a, 16), *big = arena_alloc(&a, BIG), *after = arena_alloc(&a, 16);
    assert_ptr_equal(after, before + 16);
    assert_int_equal((uintptr_t)big % 16, 0);
    memset(big, 1, BIG);
    assert_int_equal(after[0], 0);
    arena_free(&a);
}

static void large_object_may_come_first(void **state) {
    (void)state;
    arena a = {0};
    char *big = arena_alloc(&a, BIG), *small = arena_alloc(&a, 16);
    memset(big, 1, BIG);
    assert_int_equal(small[0], 0);
    arena_free(&a);
}

static void freed_arena_can_be_used_again(void **state) {
    (void)state;
    arena a = {0};
    arena_free(&a);
    memset(arena_alloc(&a, 1000), 1, 1000);
    arena_free(&a);
    char *object = arena_alloc(&a, 1000);
    for (size_t i = 0; i < 1000; i++) assert_int_equal(object[i], 0);
    arena_free(&a);
}

static void texts_are_copied_and_formatted(void **state) {
    (void)state;
    arena a = {0};
    char text[] = "field";
    char *copy = arena_string(&a, text), *bytes = arena_copy(&a, text, 2);
    text[0] = 'x';
    assert_string_equal(copy, "field");
    assert_memory_equal(bytes, "fi", 2);
    assert_string_equal(arena_format(&a, "%s %d%%", copy, 7), "field 7%");
    char *empty = arena_format(&a, "%s", "");
    assert_string_equal(empty, "");
    char *wide = arena_format(&a, "%100000d", 1);
    assert_int_equal(strlen(wide), 100000);
    arena_free(&a);
}

static void reserve_grows_and_keeps_what_was_there(void **state) {
    (void)state;
    int *array = NULL;
    size_t capacity = 0, grown = 0;
    for (int i = 0; i < 10000; i++) {
        size_t before = capacity;
        MEM_RESERVE(array, (size_t)i + 1, capacity);
        grown += capacity != before;
        array[i] = i;
    }
    for (int i = 0; i < 10000; i++) assert_int_equal(array[i], i);
    assert_true(capacity >= 10000 && grown < 20);
    size_t before = capacity;
    MEM_RESERVE(array, 5, capacity);
    assert_int_equal(capacity, before);
    mem_free(array);
}

static void empty_blocks_are_not_null(void **state) {
    (void)state;
    void *a = mem_alloc(0), *b = mem_copy(NULL, 0), *c = mem_resize(NULL, 0, 0);
    assert_true(a && b && c);
    mem_free(a);
    mem_free(b);
    mem_free(c);
    mem_free(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(objects_are_aligned_and_zeroed),
        cmocka_unit_test(objects_neither_move_nor_overlap),
        cmocka_unit_test(large_object_leaves_the_block_in_use),
        cmocka_unit_test(large_object_may_come_first),
        cmocka_unit_test(freed_arena_can_be_used_again),
        cmocka_unit_test(texts_are_copied_and_formatted),
        cmocka_unit_test(reserve_grows_and_keeps_what_was_there),
        cmocka_unit_test(empty_blocks_are_not_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
