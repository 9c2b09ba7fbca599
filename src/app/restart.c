#include "app/restart.h"
#include "app/arguments.h"
#include "base/log.h"
#include "base/memory.h"
#include <signal.h>
#include <unistd.h>

static arguments list_arguments(const live *l, const app_device *device, const char *why) {
    arguments a = {0};
    const char *const always[] = {"roil", "live", "--paused", "--after-hang", why, "--frame"};
    for (size_t i = 0; i < COUNT_OF(always); i++) arguments_add(&a, always[i]);
    arguments_add_number(&a, l->time.frame);
    arguments_add_device(&a, device);
    if (l->effect) arguments_add_moved(&a, l->effect);
    arguments_add(&a, "--");
    arguments_add(&a, l->file);
    return a;
}

int restart(const live *l, const app_device *device) {
    arguments a = list_arguments(l, device, l->broken_text);
    log_write(LOG_WARNING, "%s; the program restarts", l->broken_text);
    execv("/proc/self/exe", a.list);
    arguments_free(&a);
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
    for (size_t i = 0; i < COUNT_OF(prepared); i++) arguments_free(&prepared[i]);
}

void restart_arm(const live *l) {
    static int current;
    if (l->held) {
        restart_disarm();
        return;
    }
    current = 1 - current;
    arguments_free(&prepared[current]);
    prepared[current] = list_arguments(
        l, l->device, "the process crashed while it drew this: a shader or a fault of the driver");
    ready = prepared[current].list;
    set_fault_handler(true);
}
