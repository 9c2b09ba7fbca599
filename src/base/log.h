// Messages to people. Any thread. They go where the host wants them: nowhere, unless it says so or
// $ROIL_LOG (debug, info, warning, error) asks for them on stderr. The program's results never go
// through here: it prints them to stdout.
#pragma once
#include "base/error.h"

typedef enum log_level { LOG_DEBUG, LOG_INFO, LOG_WARNING, LOG_ERROR } log_level;

void log_write(log_level level, const char *format, ...) PRINTF_LIKE(2, 3);
void log_set_level(log_level least); // default: LOG_INFO, or $ROIL_LOG
// Sets who takes messages, on any thread, and one at a time. NULL: nobody; the level is the default
// again.
void log_set_target(void (*write)(void *user, int level, const char *text), void *user);
void log_to_stderr(void *user, int level, const char *text); // a target: for programs
