// What the results say about where they come from.
#include "bench_helper.h"

static void commit_is(const char *expected) {
    arena memory = {0};
    assert_string_equal(bench_commit(helper_folder, &memory), expected);
    arena_free(&memory);
}

static void commits_are_found(void **state) {
    (void)state;
    static const char *const files[][3] = {
        // file, content, commit that is found then
        {".git/HEAD", "ref: refs/heads/main\n", ""},
        {".git/packed-refs",
         "# pack\n0123456789abcdef refs/heads/other\nfedcba9876543210 refs/heads/main\n",
         "fedcba9"},
        {".git/refs/heads/main", "abcdef0123456789\n", "abcdef0"},
        {".git/HEAD", "1111111222222233\n", "1111111"},
        {"commit", "2222222333333344\n", "2222222"},
        {"commit", "no commit\n", ""},
    };
    commit_is("");
    for (size_t i = 0; i < COUNT_OF(files); i++) {
        helper_put(files[i][0], files[i][1], strlen(files[i][1]));
        commit_is(files[i][2]);
    }
}

static void the_machine_is_described(void **state) {
    (void)state;
    bench_results r = {0};
    bench_describe_machine(&r);
    assert_true(r.cores >= 1);
    assert_non_null(strstr(r.os, "Linux"));
    assert_int_equal(strlen(r.date), strlen("2026-11-21T18:00:00Z"));
    bench_results_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commits_are_found),
        cmocka_unit_test(the_machine_is_described),
    };
    return cmocka_run_group_tests(tests, helper_make, helper_remove);
}
