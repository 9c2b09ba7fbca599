// A folder of its own for each test of the media layer, and damaged copies of files.
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char test_folder[PATH_CAP];

static inline int test_setup(void **state) {
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(test_folder, sizeof test_folder, "%s/roil-media-XXXXXX", base ? base : P_tmpdir);
    return mkdtemp(test_folder) ? 0 : -1;
}

static inline int test_teardown(void **state) {
    (void)state;
    char command[PATH_CAP + 16];
    snprintf(command, sizeof command, "rm -rf '%s'", test_folder);
    return system(command);
}

// Path of a file in the folder; good until the eighth next call.
static inline const char *test_path(const char *name) {
    static char paths[8][PATH_CAP];
    static int next;
    char *out = paths[next++ % 8];
    assert_true(path_join(out, test_folder, name));
    return out;
}

// A file of the source tree, or NULL when the tests run without it.
static inline const char *test_source(const char *name) {
    static char path[PATH_CAP];
    const char *root = getenv("ROIL_SOURCE_DIR");
    return root && path_join(path, root, name) && file_exists(path) ? path : NULL;
}

// Not by file_write: thousands of damaged files need not reach the disk.
static inline void test_put(const char *name, const void *data, size_t size) {
    assert_true(file_make_parent_folders(test_path(name)));
    FILE *f = fopen(test_path(name), "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

static inline void assert_message(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("message \"%s\" lacks \"%s\"", err_get(), part);
}

static inline size_t test_count_files(void) {
    char pattern[PATH_CAP + 8];
    snprintf(pattern, sizeof pattern, "%s/*", test_folder);
    file_list list = {0};
    assert_true(file_glob(pattern, &list));
    size_t count = list.count;
    file_list_free(&list);
    return count;
}

static inline uint32_t test_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

// Runs `work` where no file may grow beyond `limit` bytes; true when it returned false with a
// message, which is what a full disk must lead to.
static inline bool test_fails_on_full_disk(bool (*work)(void), rlim_t limit) {
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){limit, limit});
        bool failed = !work() && err_get()[0];
        _exit(failed ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}
