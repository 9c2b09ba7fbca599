// fork, a memory file for the result, and a pidfd to wait on. Every limit is set in the child only.
// The child leaves through _exit, so that no handler or destructor of the parent runs twice.
#include "media/isolate.h"
#include "base/error.h"
#include "base/memory.h"
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/pidfd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { CPU_SECONDS = 60, WALL_MILLISECONDS = 120000, MESSAGE_MAX = 8192 };
enum { EXIT_REFUSED = 3, EXIT_NO_MEMORY = 4 };
static const rlim_t MEMORY_BYTES = (rlim_t)4 << 30, RESULT_BYTES = (rlim_t)2 << 30;

bool isolate_put(int out, const void *data, size_t size) {
    const char *p = data;
    while (size > 0) {
        ssize_t n = write(out, p, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return err_set("result of the child: %s", strerror(errno));
        p += n;
        size -= (size_t)n;
    }
    return true;
}

static void limit(int resource, rlim_t value) {
    struct rlimit r;
    if (getrlimit(resource, &r) != 0) return;
    r.rlim_cur = r.rlim_max == RLIM_INFINITY || value < r.rlim_max ? value : r.rlim_max;
    setrlimit(resource, &r);
}

// Address space that is mapped already (a GPU driver maps much) does not count.
static rlim_t mapped_bytes(void) {
    unsigned long pages = 0;
    FILE *f = fopen("/proc/self/statm", "re");
    if (!f) return 0;
    if (fscanf(f, "%lu", &pages) != 1) pages = 0;
    fclose(f);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void leave(void) { // exit() in the child means that memory ran out (base/error.h)
    _exit(EXIT_NO_MEMORY);
}

static _Noreturn void run_child(const isolate_job *job, int out, rlim_t mapped) {
    static const int FAULTS[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGXFSZ};
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (size_t i = 0; i < COUNT_OF(FAULTS); i++) signal(FAULTS[i], SIG_DFL);
    atexit(leave); // runs before all handlers of the parent, and ends there
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, CPU_SECONDS);
    limit(RLIMIT_FSIZE, RESULT_BYTES);
    if (mapped) limit(RLIMIT_AS, mapped + MEMORY_BYTES);
    err_clear();
    if (job->work(job->user, out)) _exit(EXIT_SUCCESS);
    const char *message = err_get();
    bool told = ftruncate(out, 0) == 0 && lseek(out, 0, SEEK_SET) == 0 &&
                isolate_put(out, message, strlen(message));
    _exit(told ? EXIT_REFUSED : EXIT_FAILURE);
}

// The child's wait status; it has been killed if it took too long.
static int wait_for(pid_t child, bool *late) {
    int fd = pidfd_open(child, 0);
    struct pollfd ready = {.fd = fd, .events = POLLIN};
    int found = -1;
    if (fd >= 0) do
            found = poll(&ready, 1, WALL_MILLISECONDS);
        while (found < 0 && errno == EINTR);
    if (fd >= 0) close(fd);
    *late = found == 0;
    if (*late) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

static bool read_result(const isolate_job *job, int out, void **data, size_t *size) {
    struct stat info;
    if (fstat(out, &info) != 0) return err_set("%s: %s", job->name, strerror(errno));
    *size = (size_t)info.st_size;
    char *bytes = mem_alloc(*size + 1);
    size_t at = 0;
    while (at < *size) {
        ssize_t n = pread(out, bytes + at, *size - at, (off_t)at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        at += (size_t)n;
    }
    *data = bytes;
    if (at == *size) return true;
    mem_free(bytes);
    return err_set("%s: the result of the child cannot be read", job->name);
}

static bool take_result(const isolate_job *job, int status, bool late, int out, void **data,
                        size_t *size) {
    if (late || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU))
        return err_set("%s: took too long to read, and was given up", job->name);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ)
        return err_set("%s: holds too much", job->name);
    if (WIFSIGNALED(status))
        return err_set("%s: damaged: the library that reads it crashed (%s)", job->name,
                       strsignal(WTERMSIG(status)));
    int code = WEXITSTATUS(status);
    if (code == EXIT_NO_MEMORY) return err_set("%s: needs more than 4 GiB to read", job->name);
    if (code != EXIT_SUCCESS && code != EXIT_REFUSED)
        return err_set("%s: damaged: the library that reads it failed", job->name);
    if (!read_result(job, out, data, size)) return false;
    if (code == EXIT_SUCCESS) return true;
    err_set("%.*s", MESSAGE_MAX, (char *)*data);
    mem_free(*data);
    return false;
}

bool isolate_run(const isolate_job *job, void **data, size_t *size) {
    int out = memfd_create("roil-isolate", MFD_CLOEXEC);
    if (out < 0) return err_set("%s: no memory file: %s", job->name, strerror(errno));
    rlim_t mapped = mapped_bytes();
    pid_t child = fork();
    if (child == 0) run_child(job, out, mapped);
    bool done, late;
    if (child < 0) {
        done = err_set("%s: no child process: %s", job->name, strerror(errno));
    } else {
        int status = wait_for(child, &late);
        done = take_result(job, status, late, out, data, size);
    }
    close(out);
    return done;
}
