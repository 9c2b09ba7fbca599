#include "base/log.h"
#include "base/alias.h"
#include "base/str.h"
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"debug", "info", "warning", "error"};
static atomic_int threshold = -1; // -1: not read from the environment yet

static int least_level(void) {
    int level = atomic_load(&threshold);
    if (level >= 0) return level;
    level = LOG_INFO;
    const char *wanted = getenv("ROIL_LOG");
    for (int i = 0; wanted && i < 4; i++)
        if (strcmp(wanted, names[i]) == 0) level = i;
    atomic_store(&threshold, level);
    return level;
}

void log_set_level(log_level least) {
    atomic_store(&threshold, (int)least);
}

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; // guards what follows
static void (*target)(void *user, int level, const char *text);
static void *target_user;

void log_set_target(void (*wanted)(void *user, int level, const char *text), void *user) {
    pthread_mutex_lock(&lock);
    target = wanted;
    if (!wanted) atomic_store(&threshold, -1);
    target_user = user;
    pthread_mutex_unlock(&lock);
}

void log_to_stderr(void *user, int level, const char *text) {
    (void)user;
    if (level == LOG_INFO)
        fprintf(stderr, "%s\n", text);
    else
        fprintf(stderr, "%s: %s\n", names[level], text);
}

void log_write(log_level level, const char *format, ...) {
    if ((int)level < least_level()) return;
    char text[4096];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    alias_hide(text, sizeof text);
    str_make_printable(text);
    pthread_mutex_lock(&lock);
    if (target)
        target(target_user, level, text);
    else if (getenv("ROIL_LOG"))
        log_to_stderr(NULL, level, text);
    pthread_mutex_unlock(&lock);
}
