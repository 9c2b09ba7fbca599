// What tests of the base layer share: cmocka, a scratch folder, and messages.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/file.h"
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static inline void assert_message(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("\"%s\" is not in: %s", part, err_get());
}

static inline int scratch_remove(const char *path, const struct stat *info, int kind,
                                 struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

// *state becomes the name of a new, empty folder: an absolute path without links.
static inline int scratch_setup(void **state) {
    char name[] = "/tmp/roil-base-XXXXXX";
    if (!mkdtemp(name)) return -1;
    *state = realpath(name, NULL);
    err_clear();
    return *state ? 0 : -1;
}

static inline int scratch_teardown(void **state) {
    nftw(*state, scratch_remove, 16, FTW_DEPTH | FTW_PHYS);
    free(*state);
    return 0;
}

typedef struct path_text {
    char text[PATH_CAP];
} path_text;

static inline path_text in(const char *folder, const char *name) {
    path_text path;
    assert_true(path_join(path.text, folder, name));
    return path;
}

static inline void put(const char *folder, const char *name, const char *text) {
    path_text path = in(folder, name);
    assert_true(file_make_parent_folders(path.text));
    if (!file_write(path.text, text, strlen(text))) fail_msg("%s", err_get());
}

#define SCRATCH_TEST(name) cmocka_unit_test_setup_teardown(name, scratch_setup, scratch_teardown)
