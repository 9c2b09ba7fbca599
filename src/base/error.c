#include "base/error.h"
#include "base/alias.h"
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MESSAGE_CAP = 8192 };

static _Thread_local char message[MESSAGE_CAP];

bool err_set(const char *format, ...) {
    char text[MESSAGE_CAP]; // arguments may point into the current message
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    alias_hide(text, sizeof text);
    memcpy(message, text, strlen(text) + 1);
    return false;
}

bool err_prefix(const char *format, ...) {
    char text[2 * MESSAGE_CAP];
    va_list args;
    va_start(args, format);
    vsnprintf(text, MESSAGE_CAP, format, args);
    va_end(args);
    alias_hide(text, MESSAGE_CAP);
    size_t length = strlen(text);
    memcpy(text + length, message, strlen(message) + 1);
    text[MESSAGE_CAP - 1] = '\0';
    memcpy(message, text, strlen(text) + 1);
    return false;
}

const char *err_get(void) {
    return message;
}

void err_clear(void) {
    message[0] = '\0';
}

bool err_no_memory(size_t size) {
    return err_set("out of memory (%zu bytes wanted)", size);
}

static void (*leave_process)(void); // NULL: none
static bool leave_at_once, own_process;

void err_when_out_of_memory(void (*leave)(void), bool at_once) {
    leave_process = leave;
    leave_at_once = at_once;
}

bool err_leaves_at_once(void) {
    return leave_at_once;
}

void err_own_process(void) {
    own_process = true;
}

// Does not use exit(), because other threads still use what its handlers free.
void err_out_of_memory(size_t size) {
    static atomic_flag ending = ATOMIC_FLAG_INIT;
    if (leave_process) leave_process();
    if (!own_process) abort();
    if (!atomic_flag_test_and_set(&ending)) {
        fprintf(stderr, "roil: out of memory (%zu bytes wanted)\n", size);
        _exit(EXIT_FAILURE);
    }
    for (;;) pause(); // another thread has said so
}
