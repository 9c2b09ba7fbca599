// Tests that take minutes.
#pragma once
#include "gpu_test.h"
#include <string.h>

// Whether they are wanted. `left_out`: what is not tested without them.
static inline bool sim_long_tests(const char *left_out) {
    const char *wanted = getenv("ROIL_LONG_TESTS");
    if (wanted && strcmp(wanted, "1") == 0) return true;
    print_message("left out: %s; set ROIL_LONG_TESTS=1\n", left_out);
    return false;
}
