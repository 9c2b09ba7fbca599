// Errors caused by input: one message per thread, set where the fault is seen.
//
// Three kinds of error are never mixed. A bug: assert. Bad input: a function returns false or NULL
// and leaves a message here that names file, line and object, and says what is accepted. Host out
// of memory: one line on stderr, exit.
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))

// Sets the thread's message. Always returns false, so that `return err_set(...)` is one line.
bool err_set(const char *format, ...) PRINTF_LIKE(1, 2);

// Puts text before the current message ("while loading x: " + message). Always returns false.
bool err_prefix(const char *format, ...) PRINTF_LIKE(1, 2);

// The thread's message; "" when there is none. Valid until the next err_ call of the thread.
const char *err_get(void);
void err_clear(void);

// Ends the process: one line on stderr, exit status 1. No handler of exit() runs.
__attribute__((noreturn)) void err_out_of_memory(size_t size);
// `leave` is called before: in a child process it ends it, with a status that its parent knows.
void err_when_out_of_memory(void (*leave)(void));
