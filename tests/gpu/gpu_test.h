// What every test that needs a device shares: one device a program, with validation; exit 77 when
// this machine has no Vulkan device at all; no validation message may be left at the end.
//
//   static const struct CMUnitTest tests[] = {cmocka_unit_test(image_keeps_its_texels)};
//   int main(void) { return gpu_test_run(tests, COUNT_OF(tests)); }
//
// In a test, `*state` is the device. ROIL_TEST=NAME runs that one alone.
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
#include <string.h>

#include <cmocka.h> // wants the headers above

// Ends the program when it was not told where the source is, as ctest tells it.
static inline void gpu_test_need_source(void) {
    if (getenv("ROIL_SOURCE_DIR")) return;
    fprintf(stderr, "set ROIL_SOURCE_DIR to the root of the source\n");
    exit(1);
}

// Ends the program with 77 when there is no device.
static inline void gpu_test_need_device(void) {
    gpu_info info;
    if (gpu_list(&info, 1) > 0) return;
    fprintf(stderr, "skipped: %s\n", err_get());
    exit(77);
}

// Its sines, roots and powers are as coarse as Vulkan allows (2^-11 for a sine), others' are finer.
static inline bool gpu_test_is_coarse(void) {
    gpu_info info;
    return gpu_list(&info, 1) > 0 && strstr(info.name, "SwiftShader");
}

// `cache_dir` may be NULL.
static inline gpu *gpu_test_open(const char *cache_dir) {
    gpu_desc desc = {.cache_dir = cache_dir, .validate = true};
    gpu *g = gpu_create(&desc);
    if (!g) fail_msg("no device: %s", err_get());
    return g;
}

// Destroys the device. The count of what went wrong: validation messages, or a device that hangs.
static inline uint64_t gpu_test_finish(gpu *g) {
    bool idle = gpu_idle(g);
    if (!idle) fprintf(stderr, "the device does not come to rest: %s\n", err_get());
    uint64_t messages = gpu_validation_messages(g);
    gpu_destroy(g);
    return messages + !idle;
}

// In a test that opened a device of its own.
static inline void gpu_test_close(gpu *g) {
    assert_int_equal(gpu_test_finish(g), 0);
}

static inline int gpu_test_setup(void **state) {
    *state = gpu_test_open(NULL);
    return 0;
}

// cmocka reports a failed teardown of a group but exits with 0: the count is added by hand.
static uint64_t gpu_test_messages;
static inline int gpu_test_teardown(void **state) {
    if (*state) gpu_test_messages = gpu_test_finish(*state);
    return 0;
}

#ifdef __SANITIZE_ADDRESS__
// The leak checker must know drivers and layers by name to tell their leaks from ours, so they may
// not be unloaded before it runs: one more device stays open until the program ends.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libvulkan\nleak:libVkLayer\nleak:libLLVM\nleak:libnvidia\n";
}
static gpu *gpu_test_kept;
static inline void gpu_test_keep_driver(void) {
    gpu_test_kept = gpu_create(&(gpu_desc){.validate = true});
}
#else
static inline void gpu_test_keep_driver(void) {}
#endif

// The value that main returns.
static inline int gpu_test_run_group(const char *name, const struct CMUnitTest *tests,
                                     size_t count) {
    gpu_test_keep_driver();
    gpu_test_need_source();
    gpu_test_need_device();
    if (getenv("ROIL_TEST")) cmocka_set_test_filter(getenv("ROIL_TEST"));
    int failed = _cmocka_run_group_tests(name, tests, count, gpu_test_setup, gpu_test_teardown);
    if (gpu_test_messages > 0) fprintf(stderr, "%s: validation messages were given\n", name);
    return failed + (gpu_test_messages > 0);
}
#define gpu_test_run(tests, count) gpu_test_run_group(__FILE__, (tests), (count))

// Whether triangles are drawn where their corners say, as most devices do it: at 8 bits below a
// pixel. Vulkan asks for 4, by which each triangle is tilted a little.
static inline bool gpu_test_draws_precisely(gpu *g) {
    return gpu_get_info(g)->subpixel_bits >= 8;
}

// A result of false or NULL is a failure that tells why.
#define gpu_test_ok(result)                                                                        \
    do {                                                                                           \
        if (!(result)) fail_msg("%s: %s", #result, err_get());                                     \
    } while (0)
