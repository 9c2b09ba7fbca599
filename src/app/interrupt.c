// Ctrl-C, or a terminal that closes, where work is done in pieces: the piece in hand is given up,
// and what is done is kept.
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
