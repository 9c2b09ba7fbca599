// A worker. Every failure ends in this file: the process exits with a status that says what
// happened.
#include "reader/worker.h"
#include "base/error.h"
#include "base/memory.h"
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

enum { CHANNEL = WIRE_CONTROL, OUT, INPUT, FILES_END };

static void worker_leave(void) { // exit() here means that memory ran out (base/error.h)
    _exit(WIRE_EXIT_MEMORY);
}

// Moves the files to their numbers. All are first copied above these numbers, so that none is
// overwritten before it was moved.
static void take_files(const int files[WIRE_FILES], int said) {
    const int from[] = {said, files[WIRE_CHANNEL], files[WIRE_OUT], files[WIRE_INPUT]};
    const int to[] = {STDERR_FILENO, CHANNEL, OUT, INPUT};
    int high[COUNT_OF(from)];
    for (size_t i = 0; i < COUNT_OF(from); i++) high[i] = fcntl(from[i], F_DUPFD, FILES_END);
    for (size_t i = 0; i < COUNT_OF(from); i++)
        if (high[i] < 0 || dup2(high[i], to[i]) < 0) _exit(EXIT_FAILURE);
    closefrom(FILES_END);
}

static const void *read_input(size_t size) {
    char *bytes = mem_alloc(size + 1);
    if (!wire_read(INPUT, bytes, size)) {
        err_set("its size has changed");
        mem_free(bytes);
        return NULL;
    }
    close(INPUT);
    return bytes;
}

static _Noreturn void worker_refuse(const isolate_call *call) {
    const char *message = err_get();
    bool sent = ftruncate(OUT, 0) == 0 && lseek(OUT, 0, SEEK_SET) == 0 &&
                isolate_put(call, message, strlen(message));
    _exit(sent ? WIRE_EXIT_REFUSED : EXIT_FAILURE);
}

void worker_run(const reader_job *job, const wire_request *r, const int files[WIRE_FILES],
                int said) {
    isolate_call call = {.name = r->name,
                         .arguments = r->arguments,
                         .argument_size = r->argument_size,
                         .size = r->size,
                         .out = OUT,
                         .channel = CHANNEL,
                         .ask = wire_ask};
    take_files(files, said);
    signal(SIGCHLD, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    atexit(worker_leave);
    err_when_out_of_memory(worker_leave, true);
    worker_limit(&r->limits);
    worker_confine();
    err_clear();
    call.bytes = read_input(call.size);
    if (!call.bytes) {
        err_prefix("%s: ", call.name);
        worker_refuse(&call);
    }
    if (job->work(&call)) _exit(EXIT_SUCCESS);
    worker_refuse(&call);
}
