// What tests of the public interface share: a roil with validation, and effects of one pass whose
// shader a test writes into a folder of its own.
#pragma once
#include "base/file.h"
#include "gpu_test.h"
#include "roil.h"
#include <math.h>
#include <string.h>
#include <unistd.h>

#define ok(result)                                                                                 \
    do {                                                                                           \
        if (!(result)) fail_msg("%s: %s", #result, roil_error());                                  \
    } while (0)

static char test_folder[256];
static uint64_t test_messages;
static bool test_interaction; // to be set before test_run: roil_desc.interaction

static inline int test_open(void **state) {
    const char *temporary = getenv("TMPDIR");
    snprintf(test_folder, sizeof test_folder, "%s/roil-test-XXXXXX",
             temporary ? temporary : "/tmp");
    assert_non_null(mkdtemp(test_folder));
    roil *r = roil_create(&(roil_desc){
        .home = getenv("ROIL_SOURCE_DIR"), .validate = true, .interaction = test_interaction});
    ok(r);
    *state = r;
    return 0;
}

static inline int test_close(void **state) {
    char command[300];
    test_messages = roil_validation_messages(*state);
    roil_destroy(*state);
    snprintf(command, sizeof command, "rm -r '%s'", test_folder);
    return system(command);
}

// Writes a file into the test's folder; `path` is where.
static inline void write_text(const char *name, const char *text, char path[512]) {
    snprintf(path, 512, "%s/%s", test_folder, name);
    assert_true(file_make_parent_folders(path));
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

// Copies a picture of the library of templates into the test's folder.
static inline void copy_template(const char *name) {
    char command[1024];
    snprintf(command, sizeof command, "cp '%s/effects/templates/%s' '%s/'",
             getenv("ROIL_SOURCE_DIR"), name, test_folder);
    assert_int_equal(system(command), 0);
}

static inline roil_effect *load_text(roil *r, const char *name, const char *text) {
    char path[512];
    write_text(name, text, path);
    roil_effect *e = roil_load(r, path, NULL, 0);
    ok(e);
    return e;
}

static char test_said[512]; // the last message of the log

static inline void test_hear(void *user, int level, const char *text) {
    if (level == *(const int *)user) snprintf(test_said, sizeof test_said, "%s", text);
}

// Hears messages of a level, until roil_set_log.
static inline void test_listen(int level) {
    static int wanted;
    wanted = level;
    test_said[0] = '\0';
    roil_set_log(test_hear, &wanted, (roil_level)level);
}

static inline void expect_error(bool result, const char *part) {
    assert_false(result);
    if (!strstr(roil_error(), part)) fail_msg("'%s' does not say '%s'", roil_error(), part);
}

static inline void expect_pixel(const uint8_t *pixels, uint32_t width, uint32_t x, uint32_t y,
                                int red, int green, int blue, int slack) {
    const uint8_t *p = pixels + 4 * (size_t)(y * width + x);
    if (abs(p[0] - red) <= slack && abs(p[1] - green) <= slack && abs(p[2] - blue) <= slack &&
        p[3] == 255)
        return;
    fail_msg("pixel %u,%u is %d %d %d %d, not %d %d %d", x, y, p[0], p[1], p[2], p[3], red, green,
             blue);
}

static inline bool test_count_call(void *user, double done, double whole) {
    (void)done, (void)whole;
    ++*(int *)user;
    return true;
}

// Loads a changed file and draws a frame. Returns how often a simulation said that it is catching
// up.
static inline int test_reload(roil_live *live, uint32_t width, uint32_t height, double frame) {
    int calls = 0;
    roil_live_wait(live);
    assert_true(roil_live_update(live, width, height, frame));
    if (roil_live_message(live)) fail_msg("%s", roil_live_message(live));
    roil_on_progress(roil_live_effect(live), test_count_call, &calls);
    ok(roil_advance(roil_live_effect(live), frame));
    return calls;
}

static inline float srgb_exact(float linear) { // IEC 61966-2-1
    linear = linear > 0 ? fminf(linear, 1) : 0;
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

static inline int srgb(float linear) {
    return (int)lrintf(255 * srgb_exact(linear));
}

// The value that main returns.
#define test_run(tests) test_run_group(__FILE__, (tests), COUNT_OF(tests))
static inline int test_run_group(const char *name, const struct CMUnitTest *tests, size_t count) {
    gpu_test_keep_driver();
    gpu_test_need_device();
    if (getenv("ROIL_TEST")) cmocka_set_test_filter(getenv("ROIL_TEST"));
    int failed = _cmocka_run_group_tests(name, tests, count, test_open, test_close);
    if (test_messages > 0) fprintf(stderr, "%s: validation messages were given\n", name);
    return failed + (test_messages > 0);
}
