#include "app/restart.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct arguments {
    char **list;
    size_t count, capacity;
} arguments;

static void argument_add(arguments *a, const char *text) {
    MEM_RESERVE(a->list, a->count + 2, a->capacity);
    a->list[a->count++] = mem_copy(text, strlen(text) + 1);
    a->list[a->count] = NULL;
}

static void add_number(arguments *a, double number) {
    char text[32];
    snprintf(text, sizeof text, "%.9g", number);
    argument_add(a, text);
}

static void add_moved(arguments *a, roil_effect *e) {
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        char *text = c.moved ? roil_control_text(e, c.name) : NULL;
        if (!text) continue;
        strbuf setting = {0};
        strbuf_add(&setting, "%s=%s", c.name, text);
        argument_add(a, "--set");
        argument_add(a, strbuf_text(&setting));
        strbuf_free(&setting);
        roil_free(text);
    }
}

static void add_option(arguments *a, const char *name, double number) {
    if (!(number > 0)) return;
    argument_add(a, name);
    add_number(a, number);
}

static void add_device(arguments *a, const app_device *d) {
    if (d->name) argument_add(a, "--device");
    if (d->name) argument_add(a, d->name);
    if (d->memory) argument_add(a, "--memory");
    if (d->memory) argument_add(a, d->memory);
    for (size_t i = 0; d->assets && d->assets[i]; i++) {
        argument_add(a, "--assets");
        argument_add(a, d->assets[i]);
    }
    if (d->validate) argument_add(a, "--validate");
    if (d->no_cache) argument_add(a, "--no-cache");
    add_option(a, "--timeout", d->timeout);
    add_option(a, "--time-limit", d->time_limit);
}

static arguments list_arguments(const live *l, const app_device *device, const char *why) {
    arguments a = {0};
    const char *const always[] = {"roil", "live", "--paused", "--after-hang", why, "--frame"};
    for (size_t i = 0; i < COUNT_OF(always); i++) argument_add(&a, always[i]);
    add_number(&a, l->time.frame);
    add_device(&a, device);
    if (l->effect) add_moved(&a, l->effect);
    argument_add(&a, "--");
    argument_add(&a, l->file);
    return a;
}

static void free_arguments(arguments *a) {
    for (size_t i = 0; i < a->count; i++) mem_free(a->list[i]);
    mem_free(a->list);
    *a = (arguments){0};
}

int restart(const live *l, const app_device *device) {
    arguments a = list_arguments(l, device, l->broken_text);
    log_write(LOG_WARNING, "%s; the program restarts", l->broken_text);
    execv("/proc/self/exe", a.list);
    free_arguments(&a);
    return app_fail(APP_BAD_INPUT, "%s", l->broken_text);
}

// ---- after a crash ----------------------------------------------------------------------------

#ifdef __SANITIZE_ADDRESS__
enum { REPORTED = 1 }; // faults, by the sanitizer
#else
enum { REPORTED = 0 };
#endif

static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
static arguments prepared[2];        // of which the handler uses
static char **volatile ready = NULL; // one; NULL: the fault ends the process

static void on_fault(int number) {
    static const char text[] = "roil: the process crashed and restarts\n";
    (void)number;
    if (!ready) return; // and meets the fault again, without a handler
    if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(APP_BAD_INPUT);
    execv("/proc/self/exe", ready);
    _exit(APP_BAD_INPUT);
}

static void set_fault_handler(bool handled) {
    if (REPORTED) return;
    struct sigaction action = {.sa_handler = handled ? on_fault : SIG_DFL,
                               .sa_flags = SA_RESETHAND | SA_NODEFER};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < COUNT_OF(faults); i++) sigaction(faults[i], &action, NULL);
}

void restart_disarm(void) {
    ready = NULL;
    set_fault_handler(false);
    for (size_t i = 0; i < COUNT_OF(prepared); i++) free_arguments(&prepared[i]);
}

void restart_arm(const live *l) {
    static int current;
    if (l->held) {
        restart_disarm();
        return;
    }
    current = 1 - current;
    free_arguments(&prepared[current]);
    prepared[current] = list_arguments(
        l, l->device, "the process crashed while it drew this: a shader or a fault of the driver");
    ready = prepared[current].list;
    set_fault_handler(true);
}
