// Handles Ctrl-C, or a terminal that closes, for work that is done in parts: the current part is
// cancelled, and finished ones are kept.
#include "app/app.h"
#include <signal.h>

static volatile sig_atomic_t interrupted;

static void on_interrupt(int number) {
    (void)number;
    interrupted = 1;
}

void app_hear_interrupts(void) {
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
}

bool app_is_interrupted(void *user) {
    (void)user;
    return interrupted;
}
