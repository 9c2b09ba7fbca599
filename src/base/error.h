// Errors caused by input: each thread has one message, which is set where the fault is found.
//
// There are three kinds of error, which are never mixed. A bug fails an assert. Bad input makes a
// function return false or NULL and set a message here, which names file, line and object and says
// what is accepted. When the host is out of memory, the process prints one line and exits.
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
// Sets a function that err_out_of_memory calls first. A child process ends itself there, with a
// status that its parent knows.
void err_when_out_of_memory(void (*leave)(void));
