// The child process: results come back, and crashes, hangs and floods end in it.
#include "media_test.h"

#include "media/isolate.h"
#include <sys/mman.h>

static bool run(bool (*work)(void *, int), void **data, size_t *size) {
    return isolate_run(&(isolate_job){"file.x", work, NULL}, data, size);
}

static bool give(void *user, int out) {
    (void)user;
    return isolate_put(out, "result", 6);
}

static bool refuse(void *user, int out) {
    (void)user;
    isolate_put(out, "half a result", 13);
    return err_set("file.x: %s", "no good");
}

static bool crash(void *user, int out) {
    (void)user, (void)out;
    raise(SIGSEGV);
    return true;
}

static bool leave(void *user, int out) {
    (void)user, (void)out;
    exit(0);
}

static bool flood(void *user, int out) {
    (void)user, (void)out;
    for (int i = 0; i < 64; i++)
        if (mmap(NULL, (size_t)1 << 30, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
            MAP_FAILED)
            return err_set("file.x: no memory");
    return true;
}

static void results_come_back(void **state) {
    (void)state;
    void *data;
    size_t size;
    assert_true(run(give, &data, &size));
    assert_int_equal(size, 6);
    assert_memory_equal(data, "result", 6);
    mem_free(data);
}

static void failures_come_back_as_messages(void **state) {
    (void)state;
    void *data;
    size_t size;
    assert_false(run(refuse, &data, &size));
    assert_string_equal(err_get(), "file.x: no good");
    assert_false(run(crash, &data, &size));
    assert_message("file.x");
    assert_message("crashed");
    assert_false(run(leave, &data, &size));
    assert_message("file.x");
    assert_false(run(flood, &data, &size));
    assert_string_equal(err_get(), "file.x: no memory");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_come_back),
        cmocka_unit_test(failures_come_back_as_messages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
