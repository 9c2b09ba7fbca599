// What the heap has not comes from the reserve, and the call that lacked it fails.
#include "base/error.h"
#include "base/memory.h"
#include "base/time_limit.h"
#include "base_test.h"
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>

static bool failing;

static void *allocate(void *user, void *block, size_t size) {
    (void)user;
    if (!size) {
        free(block);
        return NULL;
    }
    return failing ? NULL : realloc(block, size);
}

static int use_heap(void **state) {
    (void)state;
    failing = false;
    return mem_set_heap((mem_heap){allocate, NULL}) ? 0 : -1;
}

static int leave_heap(void **state) {
    (void)state;
    return mem_blocks() == 0 && mem_set_heap((mem_heap){0}) ? 0 : -1;
}

static void call_that_lacks_memory_fails(void **state) {
    (void)state;
    mem_enter();
    assert_true(mem_leave(true));
    mem_enter();
    failing = true;
    unsigned char *block = mem_alloc(1000);
    failing = false;
    assert_true(mem_is_short());
    assert_false(time_limit_check()); // what takes long ends
    assert_message("out of memory");
    for (int i = 0; i < 1000; i++) assert_int_equal(block[i], 0);
    mem_free(block);
    mem_enter(); // one within it fails too
    assert_false(mem_leave(true));
    assert_false(mem_leave(true));
    assert_message("out of memory (1000 bytes wanted)");
    assert_false(mem_is_short());
    assert_true(time_limit_check());
    mem_enter();
    assert_true(mem_leave(true));
}

static void reserve_is_used_again(void **state) {
    (void)state;
    enum { BLOCKS = 64, SIZE = 60000 };
    void *blocks[BLOCKS];
    failing = true;
    mem_enter();
    for (int round = 0; round < 100; round++) { // 100 times as much as there is
        for (int i = 0; i < BLOCKS; i++) blocks[i] = mem_alloc(SIZE + (size_t)(i * 7));
        for (int i = 0; i < BLOCKS; i++) memset(blocks[i], round, SIZE);
        for (int i = 0; i < BLOCKS; i++) mem_free(blocks[(i * 29) % BLOCKS]);
    }
    failing = false;
    assert_false(mem_leave(true));
}

static void block_moves_into_the_reserve_and_out(void **state) {
    (void)state;
    char *text = mem_copy("volume", 7);
    mem_enter();
    failing = true;
    text = mem_resize(text, 7, 100);
    assert_string_equal(text, "volume");
    text = mem_resize(text, 100, 200);
    failing = false;
    text = mem_resize(text, 200, 50);
    assert_string_equal(text, "volume");
    assert_int_equal(mem_blocks(), 1);
    assert_false(mem_leave(true));
    mem_free(text);
}

static void tried_block_is_refused(void **state) {
    (void)state;
    mem_enter();
    void *block = mem_try(NULL, 10);
    failing = true;
    assert_null(mem_try(NULL, 10));
    assert_null(mem_try(block, 20));
    failing = false;
    mem_free(block);
    assert_true(mem_leave(true));
}

static void heap_stays_while_it_is_used(void **state) {
    (void)state;
    void *block = mem_alloc(1);
    assert_false(mem_set_heap((mem_heap){0}));
    assert_message("while nothing is allocated");
    mem_free(block);
}

static void *lack(void *user) {
    failing = true;
    void *block = mem_alloc(10);
    failing = false;
    mem_free(block);
    return user;
}

static void *call_and_lack(void *user) {
    mem_enter();
    lack(user);
    return mem_leave(true) ? NULL : user;
}

// A thread that works for calls makes them fail; one that made a call of its own does not.
static void other_threads_count_if_they_work_for_calls(void **state) {
    static char mark;
    pthread_t thread;
    void *result;
    (void)state;
    mem_enter();
    assert_int_equal(pthread_create(&thread, NULL, call_and_lack, &mark), 0);
    assert_int_equal(pthread_join(thread, &result), 0);
    assert_ptr_equal(result, &mark);
    assert_true(mem_leave(true));
    mem_enter();
    assert_int_equal(pthread_create(&thread, NULL, lack, &mark), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_false(mem_leave(true));
    assert_message("out of memory");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(call_that_lacks_memory_fails, use_heap, leave_heap),
        cmocka_unit_test_setup_teardown(reserve_is_used_again, use_heap, leave_heap),
        cmocka_unit_test_setup_teardown(block_moves_into_the_reserve_and_out, use_heap, leave_heap),
        cmocka_unit_test_setup_teardown(tried_block_is_refused, use_heap, leave_heap),
        cmocka_unit_test_setup_teardown(heap_stays_while_it_is_used, use_heap, leave_heap),
        cmocka_unit_test_setup_teardown(other_threads_count_if_they_work_for_calls, use_heap,
                                        leave_heap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
