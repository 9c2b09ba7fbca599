// What every test that needs a device shares: one device a program, with validation; exit 77 when
// this machine has no Vulkan device at all; no validation message may be left at the end.
//
//   static const struct CMUnitTest tests[] = {cmocka_unit_test(image_keeps_its_texels)};
//   int main(void) { return gpu_test_run(tests, COUNT_OF(tests)); }
//
// In a test, `*state` is the device.
#pragma once
#include "base/error.h"
#include "base/memory.h"
#include "gpu/gpu.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h> // wants the headers above

// Ends the program with 77 when there is no device.
static inline void gpu_test_need_device(void) {
    gpu_info info;
    if (gpu_list(&info, 1) > 0) return;
    fprintf(stderr, "skipped: %s\n", err_get());
    exit(77);
}

// `cache_dir` may be NULL.
static inline gpu *gpu_test_open(const char *cache_dir) {
    gpu_desc desc = {.cache_dir = cache_dir, .validate = true};
    gpu *g = gpu_create(&desc);
    if (!g) fail_msg("no device: %s", err_get());
    return g;
}

static inline void gpu_test_close(gpu *g) {
    if (!gpu_idle(g)) fail_msg("the device does not come to rest: %s", err_get());
    uint64_t messages = gpu_validation_messages(g);
    gpu_destroy(g);
    if (messages > 0) fail_msg("%llu validation messages", (unsigned long long)messages);
}

static inline int gpu_test_setup(void **state) {
    *state = gpu_test_open(NULL);
    return 0;
}

static inline int gpu_test_teardown(void **state) {
    gpu_test_close(*state);
    return 0;
}

// Name of the running program's group in reports: the device it ran on.
static inline int gpu_test_run_group(const char *name, const struct CMUnitTest *tests,
                                     size_t count) {
    gpu_test_need_device();
    return _cmocka_run_group_tests(name, tests, count, gpu_test_setup, gpu_test_teardown);
}
#define gpu_test_run(tests, count) gpu_test_run_group(__FILE__, (tests), (count))

// A result of false or NULL is a failure that tells why.
#define gpu_test_ok(result)                                                                        \
    do {                                                                                           \
        if (!(result)) fail_msg("%s: %s", #result, err_get());                                     \
    } while (0)
