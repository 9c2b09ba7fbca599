// The process that compilers are forked from, and these compilers. Why: isolate.h.
#include "base/memory.h"
#include "shader/isolate.h"
#include <errno.h>
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
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __has_feature
#define SANITIZED __has_feature(address_sanitizer)
#elif defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

enum {
    MAX_WORKERS = 8,       // at a time; more requests wait
    CONTROL = 3,           // the server's socket
    PAPER = STDERR_FILENO, // of a worker
};

bool isolate_write(int file, const void *data, size_t size) {
    const char *at = data;
    while (size) {
        ssize_t done = write(file, at, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        at += done;
        size -= (size_t)done;
    }
    return true;
}

// ---- worker -----------------------------------------------------------------------------------

static void limit(int what, rlim_t most) {
    struct rlimit now;
    if (getrlimit(what, &now) != 0) return;
    if (most > now.rlim_max) most = now.rlim_max;
    now.rlim_cur = now.rlim_max = most;
    setrlimit(what, &now);
}

static rlim_t address_space(void) { // in use, bytes; 0: unknown
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file) return 0;
    if (fscanf(file, "%lu", &pages) != 1) pages = 0;
    fclose(file);
    return pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

uint64_t isolate_real_limit(const isolate_request *r) {
    return 3 * (uint64_t)r->milliseconds + ISOLATE_PATIENCE * 1000;
}

// Timers of signals that nothing here catches: they end the process whatever it does.
static void set_timer(int which, uint64_t milliseconds) {
    struct itimerval timer = {.it_value = {.tv_sec = (time_t)(milliseconds / 1000),
                                           .tv_usec = (suseconds_t)(milliseconds % 1000 * 1000)}};
    if (setitimer(which, &timer, NULL) != 0) _exit(1);
}

static void limit_worker(const isolate_request *r) {
    rlim_t used = SANITIZED ? 0 : address_space(); // terabytes, kept for the sanitizer
    if (used) limit(RLIMIT_AS, used + ((rlim_t)r->megabytes << 20));
    limit(RLIMIT_FSIZE, r->length + 2 * (rlim_t)SPIRV_MAX_SIZE);
    set_timer(ITIMER_PROF, r->milliseconds);
    set_timer(ITIMER_REAL, isolate_real_limit(r));
}

static void rehearse(const glsl_answer *answer, shader_stage stage) {
    arena memory = {0};
    shader_binary binary;
    spirv code = {.words = mem_copy(answer->data, answer->size),
                  .count = answer->size / sizeof *code.words};
    spirv_reflect(&code, stage, &memory, &binary);
    mem_free(code.words);
    arena_free(&memory);
}

static void answer_and_leave(void *user, const glsl_answer *answer) {
    const isolate_request *r = user;
    if (answer->outcome == GLSL_DONE) rehearse(answer, r->stage);
    off_t begin = (off_t)r->length + 1;
    isolate_answer head = {.outcome = answer->outcome, .size = answer->size};
    bool done = lseek(PAPER, begin, SEEK_SET) == begin && ftruncate(PAPER, begin) == 0 &&
                isolate_write(PAPER, &head, sizeof head) &&
                isolate_write(PAPER, answer->data, answer->size);
    _exit(done ? 0 : 1);
}

static _Noreturn void work(isolate_request *r, int paper, const sigset_t *signals) {
    if (dup2(paper, PAPER) < 0) _exit(1);
    closefrom(PAPER + 1);
    signal(SIGCHLD, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    sigprocmask(SIG_SETMASK, signals, NULL);
    const char *source = mmap(NULL, r->length + 1, PROT_READ, MAP_PRIVATE, PAPER, 0);
    if (source == MAP_FAILED || lseek(PAPER, (off_t)r->length + 1, SEEK_SET) < 0) _exit(1);
    limit_worker(r);
    glsl_run(source, r->stage, answer_and_leave, r);
    _exit(1);
}

// ---- server -----------------------------------------------------------------------------------

typedef struct worker {
    pid_t process;
    int status; // pipe to who waits
} worker;

static void get_ready(void *user, const glsl_answer *answer) {
    (void)user;
    if (answer->outcome == GLSL_DONE) rehearse(answer, SHADER_COMPUTE);
}

static void wake_up(int signal_number) {
    (void)signal_number;
}

static void leave(void) {
    _exit(1);
}

// Nothing of the parent is kept: neither its files, nor its signal handlers, nor what it does when
// it exits. `signals` gets the mask to wait with: everything comes through.
static void detach(int control, sigset_t *signals) {
    if (dup2(control, CONTROL) < 0) _exit(1);
    int nothing = open("/dev/null", O_RDWR);
    for (int file = 0; file < CONTROL; file++)
        if (nothing >= 0 && nothing != file) dup2(nothing, file);
    closefrom(CONTROL + 1);
    for (int number = 1; number < NSIG; number++) signal(number, SIG_DFL);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGCHLD, wake_up);
    sigset_t blocked;
    sigemptyset(signals);
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGCHLD);
    sigprocmask(SIG_SETMASK, &blocked, NULL);
    setsid(); // Ctrl-C is the parent's affair
}

// Nobody shall notice when a worker dies, and when memory runs out it shall die first.
static void be_humble(void) {
    FILE *file = fopen("/proc/self/oom_score_adj", "we");
    if (file) {
        fputs("1000", file);
        fclose(file);
    }
    atexit(leave);
    limit(RLIMIT_CORE, 0);
    prctl(PR_SET_DUMPABLE, 0); // as some systems pipe cores to a program whatever the limit
}

static void report(int status_pipe, int status) {
    isolate_write(status_pipe, &status, sizeof status);
    close(status_pipe);
}

static size_t reap(worker *workers, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        int status = ISOLATE_NO_WORKER;
        if (waitpid(workers[i].process, &status, WNOHANG) == 0)
            workers[kept++] = workers[i];
        else
            report(workers[i].status, status);
    }
    return kept;
}

// Reads a request with its two files. False when there will be no more.
static bool receive(isolate_request *r, int files[2]) {
    _Alignas(struct cmsghdr) char space[CMSG_SPACE(2 * sizeof(int))];
    struct iovec data = {.iov_base = r, .iov_len = sizeof *r};
    struct msghdr message = {
        .msg_iov = &data, .msg_iovlen = 1, .msg_control = space, .msg_controllen = sizeof space};
    ssize_t size = recvmsg(CONTROL, &message, MSG_CMSG_CLOEXEC);
    const struct cmsghdr *attached = CMSG_FIRSTHDR(&message);
    if (size != sizeof *r || !attached || attached->cmsg_len != CMSG_LEN(2 * sizeof(int)))
        return false;
    memcpy(files, CMSG_DATA(attached), 2 * sizeof(int));
    return true;
}

static size_t start_worker(isolate_request *r, const int files[2], const sigset_t *signals,
                           worker *workers, size_t count) {
    pid_t process = fork();
    if (process == 0) work(r, files[0], signals);
    close(files[0]);
    if (process < 0) {
        report(files[1], ISOLATE_NO_WORKER);
        return count;
    }
    workers[count] = (worker){.process = process, .status = files[1]};
    return count + 1;
}

_Noreturn void isolate_serve(int control) {
    static const char warm_up[] = "#version 460\nlayout(r32f) uniform image2D image;\n"
                                  "uniform float value;\n"
                                  "void main() { imageStore(image, ivec2(0), vec4(value)); }\n";
    sigset_t signals;
    worker workers[MAX_WORKERS];
    size_t count = 0;
    detach(control, &signals);
    alarm(ISOLATE_WARM_UP); // from here on a lock that the fork left locked is no disaster
    be_humble();
    glsl_run(warm_up, SHADER_COMPUTE, get_ready, NULL);
    alarm(0);
    for (;;) {
        struct pollfd ready = {.fd = CONTROL, .events = POLLIN};
        int found = ppoll(&ready, count < MAX_WORKERS, NULL, &signals);
        count = reap(workers, count);
        isolate_request r;
        int files[2];
        if (found <= 0) continue;
        if (!receive(&r, files)) _exit(0);
        count = start_worker(&r, files, &signals, workers, count);
    }
}
