// A stack for libraries that recurse over what strangers wrote.
#pragma once
#include <stdbool.h>

// Calls `run` on a thread with room for deep recursion, and waits for it. False with a message when
// there is no such thread.
bool run_on_large_stack(void *(*run)(void *), void *user);
