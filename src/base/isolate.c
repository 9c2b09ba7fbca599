// The client's side: starts the reader, sends it jobs and receives their results. Nothing that
// comes over a job's channel is trusted, since a compromised worker may have sent it.
#include "base/isolate.h"
#include "base/error.h"
#include "base/isolate_wire.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "base/time_limit.h"
#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/pidfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum {
    ATTEMPTS = 3,          // with a new reader each
    QUEUE_MS = 10 * 60000, // until a job has its turn, behind those of other threads
    SLACK_MS = 5000,       // beyond what ends the worker by itself
};

static struct {
    pthread_mutex_t lock;
    int control;     // socket; -1: no reader
    int process;     // its pidfd, -1: none
    uint64_t number; // how many there were
    char program[PATH_CAP];
} reader = {.lock = PTHREAD_MUTEX_INITIALIZER, .control = -1, .process = -1};

// ---- the reader's process ---------------------------------------------------------------------

static bool find_reader(char out[PATH_CAP]) {
    static const char *const places[] = {"roil-reader", "../libexec/roil/roil-reader",
                                         "../../libexec/roil/roil-reader"}; // lib/ARCHITECTURE
    const char *named = reader.program[0] ? reader.program : getenv("ROIL_READER");
    char folder[PATH_CAP];
    if (named && named[0]) return str_copy(out, PATH_CAP, named) || path_too_long(named);
    if (!path_own_folder(folder)) return false;
    for (size_t i = 0; i < COUNT_OF(places); i++)
        if (path_join(out, folder, places[i]) && access(out, X_OK) == 0) return true;
    return err_set("%s: no roil-reader here, which reads files and shaders; set ROIL_READER",
                   folder);
}

// The reader gets its socket and nothing else of this process: no files, no blocked or ignored
// signals, no terminal (Ctrl-C concerns this process only).
static int reader_spawn(const char *program, int end, pid_t *process) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t how;
    sigset_t none, all;
    char name[] = "roil-reader", *const arguments[] = {name, NULL};
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&how);
    int error = posix_spawn_file_actions_adddup2(&files, end, WIRE_CONTROL);
    for (int file = 0; file < WIRE_CONTROL && !error; file++)
        error = posix_spawn_file_actions_addopen(&files, file, "/dev/null", O_RDWR, 0);
    if (!error) error = posix_spawn_file_actions_addclosefrom_np(&files, WIRE_CONTROL + 1);
    posix_spawnattr_setsigmask(&how, &none);
    posix_spawnattr_setsigdefault(&how, &all);
    posix_spawnattr_setflags(&how,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSID);
    if (!error) error = posix_spawn(process, program, &files, &how, arguments, environ);
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

// Call it with the lock held, like every function that uses the reader.
static bool start_reader(void) {
    char program[PATH_CAP];
    int ends[2];
    pid_t process;
    if (reader.control >= 0) return true;
    if (!find_reader(program)) return false;
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return err_set("no socket to the reader: %s", strerror(errno));
    for (int i = 0; i < 2; i++) ends[i] = wire_keep(ends[i]);
    int error = reader_spawn(program, ends[1], &process);
    if (ends[1] >= 0) close(ends[1]);
    if (!error) {
        reader.control = ends[0];
        reader.process = wire_keep(pidfd_open(process, 0));
        reader.number++;
        return true;
    }
    if (ends[0] >= 0) close(ends[0]);
    return err_set("%s: cannot be run: %s", program, strerror(error));
}

// Ends the reader of this number, unless another thread has replaced it already. A host that
// ignores SIGCHLD, or waits for any child, may have taken its status, which nobody needs.
static void stop_reader(uint64_t number) {
    siginfo_t info;
    if (reader.number != number) return;
    if (reader.control >= 0) close(reader.control);
    reader.control = -1;
    if (reader.process < 0) return;
    pidfd_send_signal(reader.process, SIGKILL, NULL, 0);
    while (waitid(P_PIDFD, (id_t)reader.process, &info, WEXITED) != 0 && errno == EINTR) {
    }
    close(reader.process);
    reader.process = -1;
}

bool isolate_set_reader(const char *program) {
    pthread_mutex_lock(&reader.lock);
    bool fits = str_copy(reader.program, sizeof reader.program, program);
    pthread_mutex_unlock(&reader.lock);
    return fits || path_too_long(program);
}

void isolate_warm_up(const char *kind) {
    wire_request get_ready = {0};
    str_copy(get_ready.kind, sizeof get_ready.kind, kind);
    pthread_mutex_lock(&reader.lock);
    if (!start_reader())
        log_write(LOG_DEBUG, "%s", err_get()); // the first job tries again
    else
        wire_send(reader.control, &get_ready, sizeof get_ready, NULL, 0, MSG_DONTWAIT);
    pthread_mutex_unlock(&reader.lock);
}

// ---- one job ----------------------------------------------------------------------------------

typedef struct exchange {
    const isolate_job *job;
    wire_request request;
    int input, out;  // out: the memory file of the result
    uint64_t number; // of the reader that was asked
    wire_news end;
    bool refused; // the message is the work's own, and names the file
} exchange;

typedef enum verdict { LOST, LATE, ENDED } verdict; // LOST: the reader is gone

static int64_t now(void) { // milliseconds
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000 + t.tv_nsec / 1000000;
}

static bool wait_until(int file, short event, int64_t end) {
    struct pollfd ready = {.fd = file, .events = event};
    for (;;) {
        int64_t left = end - now();
        int found = left > 0 ? poll(&ready, 1, left < INT_MAX ? (int)left : INT_MAX) : 0;
        if (found < 0 && errno == EINTR) continue;
        return found > 0;
    }
}

static const char *who(const exchange *x) {
    return x->job->who ? x->job->who : "the reader";
}

// Sends the request. While the socket is full, the lock is released so that other threads can use
// their reader.
static bool send_request(exchange *x, const int files[WIRE_FILES]) {
    int64_t end = now() + QUEUE_MS;
    for (int attempt = 0; attempt < ATTEMPTS;) {
        int full = -1, error = 0;
        pthread_mutex_lock(&reader.lock);
        bool started = start_reader();
        x->number = reader.number;
        if (started && !wire_send(reader.control, &x->request, sizeof x->request, files, WIRE_FILES,
                                  MSG_DONTWAIT))
            error = errno;
        if (error == EAGAIN)
            full = fcntl(reader.control, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
        else if (error)
            stop_reader(x->number), attempt++;
        pthread_mutex_unlock(&reader.lock);
        if (!started) return false;
        if (!error) return true;
        if (error != EAGAIN) continue;
        bool room = full >= 0 && wait_until(full, POLLOUT, end);
        if (full >= 0) close(full);
        if (!room) break;
    }
    return err_set("%s cannot be asked", who(x));
}

static void open_for_worker(const exchange *x, int channel, const char *name) {
    wire_file answer = {0};
    size_t size = 0;
    int file = x->job->open ? x->job->open(x->job->user, name, &size) : -1;
    answer.size = size;
    wire_send(channel, &answer, sizeof answer, &file, file >= 0, MSG_DONTWAIT);
    if (file >= 0) close(file);
}

// Waits until the worker ends. Its own timers end it, so if it is late, the reader or the machine
// is stuck.
static verdict wait_for_end(exchange *x, int channel) {
    int64_t end = now() + QUEUE_MS;
    bool begun = false;
    for (;;) {
        wire_news *news = &x->end;
        size_t none;
        if (!wait_until(channel, POLLIN, end)) return LATE;
        if (!wire_receive(channel, news, sizeof *news, NULL, 0, &none)) return LOST;
        news->text[sizeof news->text - 1] = '\0';
        if (news->word == WIRE_END) return ENDED;
        if (news->word == WIRE_OPEN) open_for_worker(x, channel, news->text);
        if (news->word != WIRE_BEGUN || begun) continue;
        begun = true;
        end = now() + (int64_t)wire_real_limit(&x->request.limits) + SLACK_MS;
    }
}

// Runs one exchange. False with a message; else `*how` says how it went.
static bool exchange_run(exchange *x, verdict *how) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return err_set("no socket to the reader: %s", strerror(errno));
    for (int i = 0; i < 2; i++) ends[i] = wire_keep(ends[i]);
    const int files[WIRE_FILES] = {
        [WIRE_CHANNEL] = ends[1], [WIRE_OUT] = x->out, [WIRE_INPUT] = x->input};
    bool sent = send_request(x, files);
    if (ends[1] >= 0) close(ends[1]);
    if (sent) *how = wait_for_end(x, ends[0]);
    if (ends[0] >= 0) close(ends[0]);
    if (!sent || *how != LATE) return sent;
    pthread_mutex_lock(&reader.lock);
    stop_reader(x->number);
    pthread_mutex_unlock(&reader.lock);
    return true;
}

// ---- the end of it ----------------------------------------------------------------------------

static bool fail_time(const exchange *x) {
    if (!time_limit_check()) return false;
    return err_set("%s ran out of time (%g s)", who(x), x->job->limits.processor_ms / 1000.0);
}

static unsigned mebibytes(uint64_t bytes) {
    return (unsigned)(bytes >> 20);
}

// Sets the message of a worker that left no result. What it wrote may be a stranger's text, so it
// becomes one printable line.
static bool fail_status(exchange *x) {
    int status = x->end.status;
    char *said = x->end.text;
    int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    bool memory = strstr(said, "bad_alloc") || strstr(said, "out of memory");
    said[strcspn(said, "\r\n")] = '\0';
    for (char *c = said; *c; c++)
        if (!isprint((unsigned char)*c)) *c = '?';
    if (status == WIRE_NO_WORKER)
        return err_set("%s could not start a process%s%.200s", who(x), *said ? ": " : "", said);
    if (number == SIGPROF || number == SIGALRM) return fail_time(x);
    if (number == SIGXFSZ)
        return err_set("%s makes more than %u MiB of it", who(x), mebibytes(x->job->limits.result));
    if (memory || (WIFEXITED(status) && WEXITSTATUS(status) == WIRE_EXIT_MEMORY))
        return err_set("%s ran out of memory (%u MiB)", who(x), mebibytes(x->job->limits.memory));
    return err_set("%s crashed (%s %d)%s%.200s", who(x), number ? "signal" : "status",
                   number ? number : WEXITSTATUS(status), *said ? ": " : "", said);
}

// Maps the result. Seals ensure that no worker writes to it any more.
static bool map_result(const exchange *x, isolate_result *out) {
    struct stat info;
    if (fcntl(x->out, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0 ||
        fstat(x->out, &info) != 0)
        return err_set("%s left a result that cannot be read: %s", who(x), strerror(errno));
    out->size = (size_t)info.st_size;
    if (out->size == 0) return true;
    out->data = mmap(NULL, out->size, PROT_READ | PROT_WRITE, MAP_PRIVATE, x->out, 0);
    if (out->data != MAP_FAILED) return true;
    out->data = NULL;
    out->size = 0;
    return err_set("%s left a result that cannot be read: %s", who(x), strerror(errno));
}

static bool take_result(exchange *x, isolate_result *out) {
    int status = x->end.status;
    out->processor_ms = x->end.processor_ms;
    time_limit_charge(out->processor_ms * 1e-3);
    x->refused = WIFEXITED(status) && WEXITSTATUS(status) == WIRE_EXIT_REFUSED;
    if (status != 0 && !x->refused) return fail_status(x);
    if (!map_result(x, out)) return false;
    if (!x->refused) return true;
    int length = out->size < PATH_CAP ? (int)out->size : PATH_CAP;
    err_set("%.*s", length, out->data ? (const char *)out->data : "");
    isolate_free(out);
    return false;
}

// Makes the request. This is the one place where the limits of a job are set: it may take what the
// thread's time limit leaves. `name` is for the messages of the work.
static bool make_request(exchange *x) {
    const isolate_job *job = x->job;
    wire_request *r = &x->request;
    assert(job->argument_size <= ISOLATE_ARGUMENTS);
    r->limits = job->limits;
    r->limits.processor_ms = (uint32_t)fmin(job->limits.processor_ms, 1 + 1000 * time_limit_left());
    r->size = job->size;
    r->argument_size = (uint32_t)job->argument_size;
    if (job->argument_size) memcpy(r->arguments, job->arguments, job->argument_size);
    if (!str_copy(r->kind, sizeof r->kind, job->kind)) return err_set("no work '%s'", job->kind);
    return str_copy(r->name, sizeof r->name, job->name ? job->name : "") ||
           path_too_long(job->name);
}

static int memory_file(const char *name, const void *bytes, size_t size) {
    int file = wire_keep(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
    const isolate_call put = {.out = file};
    bool done = file >= 0 ? isolate_put(&put, bytes, size) : err_set("%s", strerror(errno));
    if (done) return file;
    err_prefix("no memory file for the reader: ");
    if (file >= 0) close(file);
    return -1;
}

static bool empty(int file) { // of what a worker left whose reader was lost
    return (ftruncate(file, 0) == 0 && lseek(file, 0, SEEK_SET) == 0) ||
           err_set("no memory file for the reader: %s", strerror(errno));
}

static bool exchange_all(exchange *x, isolate_result *out) {
    verdict how = LOST;
    for (int attempt = 0; attempt < ATTEMPTS && how == LOST; attempt++)
        if (!empty(x->out) || !exchange_run(x, &how)) return false;
    if (how == LATE) return fail_time(x);
    if (how == LOST) return err_set("the reader's process is gone");
    return take_result(x, out);
}

static bool run_with_input(exchange *x, isolate_result *out) {
    x->out = memory_file("roil-result", NULL, 0);
    bool done = x->out >= 0 && exchange_all(x, out);
    if (x->out >= 0) close(x->out);
    return done;
}

bool isolate_run(const isolate_job *job, isolate_result *out) {
    exchange *x = mem_alloc(sizeof *x);
    *x = (exchange){.job = job, .input = job->file};
    *out = (isolate_result){0};
    bool made = time_limit_check() && make_request(x);
    if (made && job->bytes) x->input = memory_file("roil-input", job->bytes, job->size);
    bool done = made && x->input >= 0 && run_with_input(x, out);
    if (made && job->bytes && x->input >= 0) close(x->input);
    if (!done && !x->refused && job->name) err_prefix("%s: ", job->name);
    mem_free(x);
    return done;
}

void isolate_free(isolate_result *r) {
    if (r->data) munmap(r->data, r->size);
    r->data = NULL;
    r->size = 0;
}
