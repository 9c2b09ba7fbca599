// Messages to people, on stderr. Any thread. The program's results never go through here: it prints
// them to stdout.
#pragma once
#include "base/error.h"

typedef enum log_level { LOG_DEBUG, LOG_INFO, LOG_WARNING, LOG_ERROR } log_level;

void log_write(log_level level, const char *format, ...) PRINTF_LIKE(2, 3);
void log_set_level(log_level least); // default: LOG_INFO, or $ROIL_LOG=debug|info|warning|error
