// A large stack for libraries that recurse over input of strangers.
#pragma once
#include <stdbool.h>

// Calls `run` on a thread whose stack allows deep recursion, and waits for it. False with a message
// when the thread cannot be created.
bool run_on_large_stack(void *(*run)(void *), void *user);
