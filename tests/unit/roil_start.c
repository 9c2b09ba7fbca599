// When roil has the reader's compiler get ready: beside a start that will compile, and no other.
#include "base_test.h"

#include "roil.h"
#include <sys/wait.h>

enum { WAIT_MS = 20000 };

// A program in the place of the reader. It leaves a file, and ends.
static path_text put_reader(const char *folder, const char *name) {
    char text[2 * PATH_CAP];
    path_text program = in(folder, name);
    snprintf(text, sizeof text, "#!/bin/sh\n: > '%s.ran'\n", program.text);
    put(folder, name, text);
    assert_int_equal(chmod(program.text, 0700), 0);
    return program;
}

static bool start(const char *reader, bool no_cache) {
    roil *r = roil_create(&(roil_desc){.home = getenv("ROIL_SOURCE_DIR"),
                                       .reader = reader,
                                       .no_cache = no_cache,
                                       .no_device = true});
    roil_destroy(r);
    return r != NULL;
}

static bool ran(const path_text *program, int wait_ms) {
    char name[PATH_CAP + 8];
    snprintf(name, sizeof name, "%s.ran", program->text);
    for (int i = 0; i < wait_ms / 10 && !file_exists(name); i++) usleep(10000);
    return file_exists(name);
}

// There is one reader at a time, so if the first start had one, the second would start no other.
static void the_compiler_gets_ready_for_an_empty_cache_only(void **state) {
    path_text first = put_reader(*state, "first"), second = put_reader(*state, "second");
    setenv("ROIL_CACHE_DIR", in(*state, "cache").text, 1);
    put(*state, "cache/spirv/0.spv", "");
    assert_true(start(first.text, false));
    assert_int_equal(remove(in(*state, "cache/spirv/0.spv").text), 0);
    assert_true(start(second.text, false));
    assert_true(ran(&second, WAIT_MS));
    assert_false(ran(&first, 0));
}

// In a process of its own, which leaves this one without a reader.
static void the_compiler_gets_ready_without_a_cache(void **state) {
    path_text third = put_reader(*state, "third");
    int status = -1;
    setenv("ROIL_CACHE_DIR", in(*state, "cache").text, 1);
    put(*state, "cache/spirv/0.spv", "");
    pid_t child = fork();
    if (child == 0) _exit(start(third.text, true) ? 0 : 1);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_true(ran(&third, WAIT_MS));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(the_compiler_gets_ready_without_a_cache), // first: it forks
        SCRATCH_TEST(the_compiler_gets_ready_for_an_empty_cache_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
