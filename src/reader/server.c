// Receives requests and forks a worker for each. One thread works, on a large stack, of which each
// worker gets a copy; the thread of main() waits for it.
//
// Some jobs need preparation, which takes a compiler 80 ms. They have a server of their own, so
// that no picture waits for it: the same loop in a process that the first server forks, and to
// which it forwards such requests. Jobs of another program, which loads libraries that no other job
// needs, have one too.
#include "base/isolate_wire.h"
#include "base/log.h"
#include "base/stack.h"
#include "reader/worker.h"
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAX_WORKERS = 8, SAID_MAX = 200, MAX_HELPERS = 2 }; // at a time; more requests wait

typedef struct worker {
    pid_t process;
    int channel; // to who waits
    int said;    // memory file of its stderr
    bool alone;  // who waited has gone
} worker;

typedef struct helper {  // another server
    const char *program; // NULL: this one, where jobs are got ready
    int control;         // its socket
    pid_t process;
} helper;

typedef struct server {
    const reader_job *jobs;
    size_t job_count;
    bool ready; // this is the process where jobs were got ready
    helper helpers[MAX_HELPERS];
    size_t helper_count;
    worker workers[MAX_WORKERS];
    size_t count;
    pid_t process;
} server;

static void wake_up(int signal_number) {
    (void)signal_number;
}

// The death of a worker must not be noticed, and when memory runs out workers must be killed first.
static void set_kill_policy(void) {
    FILE *file = fopen("/proc/self/oom_score_adj", "we");
    if (file) {
        fputs("1000", file);
        fclose(file);
    }
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
    prctl(PR_SET_DUMPABLE, 0); // as some systems pipe cores to a program whatever the limit
}

// ---- helpers ----------------------------------------------------------------------------------

static void become_ready(server *s) {
    closefrom(WIRE_CONTROL + 1); // channels are those of the first one's workers
    s->count = s->helper_count = 0;
    s->ready = true;
    s->process = getpid();
    for (size_t i = 0; i < s->job_count; i++)
        if (s->jobs[i].get_ready) s->jobs[i].get_ready();
}

static bool find_program(const char *name, char out[PATH_CAP]) { // beside this one
    char folder[PATH_CAP];
    return path_own_folder(folder) && path_join(out, folder, name) && access(out, X_OK) == 0;
}

static _Noreturn void become_program(const char *name) {
    char path[PATH_CAP], plain[] = "roil-reader", *const arguments[] = {plain, NULL};
    closefrom(WIRE_CONTROL + 1);
    fcntl(WIRE_CONTROL, F_SETFD, 0);
    if (find_program(name, path)) execv(path, arguments);
    _exit(EXIT_FAILURE);
}

typedef enum role { FIRST, HELPER } role;

// Returns HELPER in the new process, which continues with its own loop. A failure shows when the
// helper is used.
static role start_helper(server *s, const char *program) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) _exit(EXIT_FAILURE);
    pid_t process = fork();
    if (process < 0) _exit(EXIT_FAILURE); // who asks starts a new reader, and says so in the end
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != s->process || dup3(ends[1], WIRE_CONTROL, O_CLOEXEC) < 0)
            _exit(EXIT_FAILURE);
        if (program) become_program(program);
        become_ready(s);
        return HELPER;
    }
    close(ends[1]);
    s->helpers[s->helper_count++] = (helper){program, ends[0], process};
    return FIRST;
}

static helper *find_helper(server *s, const char *program) {
    for (size_t i = 0; i < s->helper_count; i++)
        if (s->helpers[i].program == program) return &s->helpers[i];
    return NULL;
}

// Starts the helper that such jobs will be forwarded to.
static void get_ready(server *s, const reader_job *job) {
    bool elsewhere = job->program || (job->get_ready && !s->ready);
    if (elsewhere && !find_helper(s, job->program)) start_helper(s, job->program);
}

// Forwards a request. A helper that has ended is started again. A request that is lost with a
// helper closes its channel, and its client asks again.
static void hand_on(server *s, const char *program, const wire_request *r,
                    const int files[WIRE_FILES]) {
    for (int attempt = 0; attempt < 2; attempt++) {
        helper *h = find_helper(s, program);
        if (!h && start_helper(s, program) == HELPER) return;
        h = find_helper(s, program);
        if (wire_send(h->control, r, sizeof *r, files, WIRE_FILES, 0)) break;
        close(h->control);
        kill(h->process, SIGKILL);
        waitpid(h->process, NULL, 0);
        *h = s->helpers[--s->helper_count];
    }
    for (size_t i = 0; i < WIRE_FILES; i++) close(files[i]);
}

static const reader_job *find_job(const server *s, const char *kind) {
    for (size_t i = 0; i < s->job_count; i++)
        if (strcmp(s->jobs[i].kind, kind) == 0) return &s->jobs[i];
    return NULL;
}

// ---- the end of a worker ----------------------------------------------------------------------

static void worker_report(const worker *w, int status, uint32_t processor_ms) {
    static wire_news news;
    news = (wire_news){.word = WIRE_END, .status = status, .processor_ms = processor_ms};
    if (w->said >= 0 && pread(w->said, news.text, SAID_MAX, 0) < 0) news.text[0] = '\0';
    wire_send(w->channel, &news, sizeof news, NULL, 0, MSG_DONTWAIT);
    close(w->channel);
    if (w->said >= 0) close(w->said);
}

static uint32_t milliseconds(const struct rusage *used) {
    return (uint32_t)((used->ru_utime.tv_sec + used->ru_stime.tv_sec) * 1000 +
                      (used->ru_utime.tv_usec + used->ru_stime.tv_usec) / 1000);
}

static void workers_reap(server *s) {
    size_t kept = 0;
    for (size_t i = 0; i < s->count; i++) {
        int status = WIRE_NO_WORKER;
        struct rusage used = {0};
        pid_t ended = wait4(s->workers[i].process, &status, WNOHANG, &used);
        if (ended == 0)
            s->workers[kept++] = s->workers[i];
        else // a failure of wait4 must not read as success
            worker_report(&s->workers[i], ended > 0 ? status : WIRE_NO_WORKER, milliseconds(&used));
    }
    s->count = kept;
}

// ---- its beginning ----------------------------------------------------------------------------

static void start_worker(server *s, const reader_job *job, const wire_request *r,
                         const int files[WIRE_FILES]) {
    static const wire_news begun = {.word = WIRE_BEGUN};
    worker w = {.channel = files[WIRE_CHANNEL], .said = memfd_create("roil-said", MFD_CLOEXEC)};
    wire_send(w.channel, &begun, sizeof begun, NULL, 0, MSG_DONTWAIT);
    w.process = w.said < 0 ? -1 : fork();
    if (w.process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != s->process) _exit(EXIT_FAILURE); // it died before that
        worker_run(job, r, files, w.said);
    }
    close(files[WIRE_OUT]);
    close(files[WIRE_INPUT]);
    if (w.process < 0)
        worker_report(&w, WIRE_NO_WORKER, 0);
    else
        s->workers[s->count++] = w;
}

static void server_refuse(const char *program, const int files[WIRE_FILES]) {
    worker none = {.channel = files[WIRE_CHANNEL], .said = memfd_create("roil-said", MFD_CLOEXEC)};
    if (none.said >= 0) dprintf(none.said, "there is no %s beside it", program);
    close(files[WIRE_OUT]);
    close(files[WIRE_INPUT]);
    worker_report(&none, WIRE_NO_WORKER, 0);
}

static void serve_request(server *s) {
    char path[PATH_CAP];
    static wire_request r;
    int files[WIRE_FILES];
    size_t count;
    bool whole = wire_receive(WIRE_CONTROL, &r, sizeof r, files, WIRE_FILES, &count);
    if (!whole && count == 0) _exit(EXIT_SUCCESS); // there will be no more
    r.kind[sizeof r.kind - 1] = r.name[sizeof r.name - 1] = '\0';
    const reader_job *job = find_job(s, r.kind);
    if (whole && count == 0 && job) get_ready(s, job);
    if (!whole || count != WIRE_FILES || !job || r.argument_size > sizeof r.arguments) {
        for (size_t i = 0; i < count; i++) close(files[i]);
        return;
    }
    if (job->program && !find_program(job->program, path))
        server_refuse(job->program, files);
    else if (job->program || (job->get_ready && !s->ready))
        hand_on(s, job->program, &r, files);
    else
        start_worker(s, job, &r, files);
}

// Ends workers whose client has gone away.
static void end_lonely(server *s, const struct pollfd *channels) {
    for (size_t i = 0; i < s->count; i++) {
        worker *w = &s->workers[i];
        if (w->alone || !(channels[i].revents & (POLLHUP | POLLERR))) continue;
        w->alone = true;
        kill(w->process, SIGKILL);
    }
}

static void *server_serve(void *user) {
    server *s = user;
    sigset_t open;
    sigemptyset(&open);
    for (;;) {
        struct pollfd ready[1 + MAX_WORKERS];
        bool room = s->count < MAX_WORKERS;
        for (size_t i = 0; i < s->count; i++)
            ready[1 + i] = (struct pollfd){.fd = s->workers[i].alone ? -1 : s->workers[i].channel};
        ready[0] = (struct pollfd){.fd = WIRE_CONTROL, .events = room ? POLLIN : 0};
        int found = ppoll(ready, 1 + s->count, NULL, &open);
        if (found > 0 && ready[0].revents & POLLHUP) _exit(EXIT_SUCCESS);
        if (found > 0) end_lonely(s, ready + 1);
        bool asked = found > 0 && ready[0].revents & POLLIN;
        workers_reap(s);
        if (asked) serve_request(s);
    }
}

int reader_serve(const reader_job *jobs, size_t count) {
    static server s;
    int type = 0;
    socklen_t size = sizeof type;
    if (getsockopt(WIRE_CONTROL, SOL_SOCKET, SO_TYPE, &type, &size) != 0 ||
        type != SOCK_SEQPACKET) {
        fprintf(stderr, "roil-reader: roil starts it, to read files and shaders\n");
        return 2;
    }
    log_set_target(log_to_stderr, NULL); // which the first process reads
    s = (server){.jobs = jobs, .job_count = count, .process = getpid()};
    fcntl(WIRE_CONTROL, F_SETFD, FD_CLOEXEC);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGCHLD, wake_up);
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGCHLD);
    sigprocmask(SIG_SETMASK, &blocked, NULL); // in all threads: serve() waits with it open
    set_kill_policy();
    run_on_large_stack(server_serve, &s);
    return EXIT_FAILURE; // too little memory for the stack
}
