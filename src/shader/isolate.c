// Asking the server for a compile: see isolate.h.
#include "shader/isolate.h"
#include "base/log.h"
#include "base/memory.h"
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/pidfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { ATTEMPTS = 3 }; // with a new server each

static atomic_uint limit_ms = ISOLATE_MILLISECONDS, limit_mb = ISOLATE_MEGABYTES;

static struct {
    pthread_mutex_t lock;
    int control; // socket; -1: no server
    int process; // its pidfd, -1: none
} server = {.lock = PTHREAD_MUTEX_INITIALIZER, .control = -1, .process = -1};

void isolate_set_limits(uint32_t milliseconds, uint32_t megabytes) {
    atomic_store(&limit_ms, milliseconds);
    atomic_store(&limit_mb, megabytes);
}

typedef struct start {
    int ends[2]; // of the socket: ours, the server's
    pid_t process;
    int error;
} start;

static void *fork_server(void *user) {
    start *s = user;
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before); // the server must run no handler of ours
    s->process = fork();
    s->error = errno;
    if (s->process == 0) isolate_serve(s->ends[1]);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return NULL;
}

// With the lock held, like all that touches the server.
static bool start_server(void) {
    start s;
    if (server.control >= 0) return true;
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, s.ends) != 0)
        return err_set("no socket to the compiler: %s", strerror(errno));
    bool done = run_on_large_stack(fork_server, &s); // workers stand on a copy of that stack
    close(s.ends[1]);
    if (done && s.process > 0) {
        server.control = s.ends[0];
        server.process = pidfd_open(s.process, 0);
        return true;
    }
    close(s.ends[0]);
    return done ? err_set("no process to compile in: %s", strerror(s.error)) : false;
}

static void bury_server(void) {
    siginfo_t info;
    if (server.control >= 0) close(server.control);
    server.control = -1;
    if (server.process < 0) return;
    pidfd_send_signal(server.process, SIGKILL, NULL, 0);
    while (waitid(P_PIDFD, (id_t)server.process, &info, WEXITED) != 0 && errno == EINTR) {
    }
    close(server.process);
    server.process = -1;
}

static bool send_request(const isolate_request *r, const int files[2]) {
    _Alignas(struct cmsghdr) char space[CMSG_SPACE(2 * sizeof(int))] = {0};
    struct iovec data = {.iov_base = (void *)r, .iov_len = sizeof *r};
    struct msghdr message = {
        .msg_iov = &data, .msg_iovlen = 1, .msg_control = space, .msg_controllen = sizeof space};
    struct cmsghdr *attached = CMSG_FIRSTHDR(&message);
    attached->cmsg_level = SOL_SOCKET;
    attached->cmsg_type = SCM_RIGHTS;
    attached->cmsg_len = CMSG_LEN(2 * sizeof(int));
    memcpy(CMSG_DATA(attached), files, 2 * sizeof(int));
    int error = 0;
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (!start_server()) return false;
        do error = sendmsg(server.control, &message, MSG_NOSIGNAL) < 0 ? errno : 0;
        while (error == EINTR);
        if (!error) return true;
        bury_server();
    }
    return err_set("the compiler cannot be asked: %s", strerror(error));
}

static int64_t now(void) { // milliseconds
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000 + t.tv_nsec / 1000000;
}

typedef enum verdict { LOST, LATE, ENDED } verdict; // LOST: the server is gone

// Timers end workers, so being late means that a server is stuck or has a queue of bad shaders.
static verdict wait_for_status(int file, const isolate_request *r, int *status) {
    int64_t end = now() + ISOLATE_WARM_UP * 1000 + 2 * (int64_t)isolate_real_limit(r);
    for (;;) {
        struct pollfd ready = {.fd = file, .events = POLLIN};
        int64_t left = end - now();
        int found = left > 0 ? poll(&ready, 1, left < INT_MAX ? (int)left : INT_MAX) : 0;
        if (found < 0 && errno == EINTR) continue;
        if (found <= 0) return LATE;
        return read(file, status, sizeof *status) == sizeof *status ? ENDED : LOST;
    }
}

// False with an error; else how it went.
static bool ask(const isolate_request *r, int paper, verdict *how, int *status) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return err_set("no pipe to the compiler: %s", strerror(errno));
    const int files[] = {paper, ends[1]};
    pthread_mutex_lock(&server.lock);
    bool sent = send_request(r, files);
    pthread_mutex_unlock(&server.lock);
    close(ends[1]);
    if (sent) *how = wait_for_status(ends[0], r, status);
    close(ends[0]);
    if (!sent || *how != LATE) return sent;
    pthread_mutex_lock(&server.lock);
    bury_server();
    pthread_mutex_unlock(&server.lock);
    return true;
}

static bool fail_time(const isolate_request *r) {
    return err_set("the compiler ran out of time (%g s)", r->milliseconds / 1000.0);
}

// Why a worker left no answer. What it said is the stranger's text, perhaps: one printable line.
static bool fail_status(const isolate_request *r, int paper, int status) {
    char said[201];
    ssize_t size = pread(paper, said, sizeof said - 1, (off_t)r->length + 1);
    said[size > 0 ? size : 0] = '\0';
    int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (status == ISOLATE_NO_WORKER) return err_set("no process to compile in: too little memory");
    if (number == SIGPROF || number == SIGALRM) return fail_time(r);
    if (strstr(said, "bad_alloc") || strstr(said, "out of memory"))
        return err_set("the compiler ran out of memory (%u MiB)", r->megabytes);
    said[strcspn(said, "\r\n")] = '\0';
    for (char *c = said; *c; c++)
        if (!isprint((unsigned char)*c)) *c = '?';
    return err_set("the compiler crashed (%s %d)%s%s", number ? "signal" : "status",
                   number ? number : WEXITSTATUS(status), *said ? ": " : "", said);
}

static bool read_answer(const isolate_request *r, int paper, glsl_answer *out) {
    struct stat info;
    isolate_answer head;
    off_t begin = (off_t)r->length + 1, data = begin + (off_t)sizeof head;
    bool valid = fstat(paper, &info) == 0 && info.st_size >= data &&
                 pread(paper, &head, sizeof head, begin) == sizeof head &&
                 head.size == (size_t)(info.st_size - data) && head.outcome <= GLSL_NO_CODE &&
                 (head.outcome != GLSL_DONE || head.size % sizeof(uint32_t) == 0);
    if (!valid) return err_set("the compiler left no answer");
    char *copy = mem_alloc(head.size + 1); // a log ends with the zero
    if (head.size && pread(paper, copy, head.size, data) != (ssize_t)head.size) {
        mem_free(copy);
        return err_set("the compiler's answer cannot be read");
    }
    *out = (glsl_answer){.outcome = head.outcome, .data = copy, .size = head.size};
    return true;
}

static bool exchange(const isolate_request *r, int paper, glsl_answer *out) {
    verdict how = LOST;
    int status = 0;
    for (int attempt = 0; attempt < ATTEMPTS && how == LOST; attempt++)
        if (!ask(r, paper, &how, &status)) return false;
    if (how == LATE) return fail_time(r);
    if (how == LOST) return err_set("the compiler's process is gone");
    return status == 0 ? read_answer(r, paper, out) : fail_status(r, paper, status);
}

bool isolate_compile(const char *source, shader_stage stage, glsl_answer *out) {
    isolate_request r = {.stage = stage,
                         .milliseconds = atomic_load(&limit_ms),
                         .megabytes = atomic_load(&limit_mb),
                         .length = strlen(source)};
    int paper = memfd_create("roil-shader", MFD_CLOEXEC);
    if (paper < 0) return err_set("no memory file for the compiler: %s", strerror(errno));
    bool done = isolate_write(paper, source, r.length + 1)
                    ? exchange(&r, paper, out)
                    : err_set("the compiler's memory file: %s", strerror(errno));
    close(paper);
    return done;
}

void shader_warm_up(void) {
    pthread_mutex_lock(&server.lock);
    if (!start_server()) log_write(LOG_DEBUG, "%s", err_get()); // the first compile tries again
    pthread_mutex_unlock(&server.lock);
}
