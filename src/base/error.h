// Errors caused by input: each thread has one message, which is set where the fault is found.
//
// There are three kinds of error, which are never mixed. A bug fails an assert. Bad input makes a
// function return false or NULL and set a message here, which names file, line and object and says
// what is accepted. When the host is out of memory, what the caller began fails (base/memory.h).
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))

// Sets the thread's message. Always returns false, so that `return err_set(...)` is one line.
bool err_set(const char *format, ...) PRINTF_LIKE(1, 2);

// The same of a function that returns a pointer.
#define ERR_NULL(...) (err_set(__VA_ARGS__), NULL)

// Puts text before the current message ("while loading x: " + message). Always returns false.
bool err_prefix(const char *format, ...) PRINTF_LIKE(1, 2);

// The thread's message; "" when there is none. Valid until the next err_ call of the thread.
const char *err_get(void);
void err_clear(void);

bool err_no_memory(size_t size); // false with the message "out of memory (SIZE bytes wanted)"
// Ends the process by abort(), when even the reserve of memory is used up. Where the process is
// roil's own: by one line on stderr and exit status 1. No handler of exit() runs.
__attribute__((noreturn)) void err_out_of_memory(size_t size);
void err_own_process(void);
// Sets a function that err_out_of_memory calls first. `at_once`: it is called when memory is short,
// and no reserve is touched: a child process ends itself there, with a status that its parent
// knows.
void err_when_out_of_memory(void (*leave)(void), bool at_once);
bool err_leaves_at_once(void);
