// The reader and who asks it: results come back, and crashes, hangs and floods end in a worker.
// This program is its own reader, with jobs that misbehave.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/isolate_wire.h"
#include "base/memory.h"
#include "media/vdb_wire.h"
#include "reader/reader.h"
#include "reader_child.h"
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __SANITIZE_ADDRESS__
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

// ---- jobs -------------------------------------------------------------------------------------

static bool echo(const isolate_call *call) {
    return isolate_put(call, call->arguments, call->argument_size) &&
           isolate_put(call, call->bytes, call->size);
}

static bool refuse(const isolate_call *call) {
    isolate_put(call, "half a result", 13);
    return err_set("%s: no good", call->name);
}

static bool crash(const isolate_call *call) {
    static const char said[] = "what a\x1b mess\nand more";
    bool told = write(STDERR_FILENO, said, strlen(said)) > 0;
    signal(SIGSEGV, SIG_DFL); // the sanitizer has a handler
    return told && raise(SIGSEGV) == 0 && call->size;
}

static bool leave(const isolate_call *call) {
    exit(call->size ? 1 : 0);
}

static bool spin(const isolate_call *call) {
    for (volatile size_t i = 0; call; i++) {
    }
    return true;
}

static bool flood(const isolate_call *call) {
    for (int i = 0; i < 64; i++)
        if (mmap(NULL, (size_t)1 << 30, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
            MAP_FAILED)
            return err_set("%s: no memory", call->name);
    return true;
}

static bool want_much(const isolate_call *call) {
    for (int i = 0; i < 64; i++) isolate_put(call, mem_alloc((size_t)1 << 30), 1);
    return true;
}

static bool pour(const isolate_call *call) {
    static const char piece[1 << 16];
    while (isolate_put(call, piece, sizeof piece)) {
    }
    return false;
}

// What a worker that was taken over would like to do. The result: what it could.
static bool escape(const isolate_call *call) {
    bool opened = open("/etc/passwd", O_RDONLY) >= 0 || open("/tmp", O_PATH) >= 0;
    bool spoke = socket(AF_INET, SOCK_STREAM, 0) >= 0 || socket(AF_UNIX, SOCK_STREAM, 0) >= 0;
    bool killed = kill(getppid(), 0) == 0 || kill(1, 0) == 0;
    pid_t child = fork();
    if (child == 0) _exit(0);
    bool forked = child > 0;
    char *const none[] = {NULL};
    bool ran = execve("/nowhere", none, none) == 0 || errno != EPERM;
    char text[100];
    snprintf(text, sizeof text, "%s%s%s%s%s", opened ? "opened " : "", spoke ? "spoke " : "",
             killed ? "killed " : "", forked ? "forked " : "", ran ? "ran " : "");
    return isolate_put(call, text, strlen(text));
}

static bool beg(const isolate_call *call) {
    void *data;
    size_t size;
    if (!call->ask(call, call->bytes, 1000, &data, &size)) return false;
    return isolate_put(call, data, size);
}

static bool beg_and_spin(const isolate_call *call) {
    return beg(call) && spin(call);
}

// As if the worker had been taken over: it says that all went well, with a nonsense of words
// before.
static bool lie(const isolate_call *call) {
    wire_news news = {.word = 77};
    memset(news.text, 'x', sizeof news.text);
    wire_send(call->channel, &news, sizeof news, NULL, 0, 0);
    wire_send(call->channel, "y", 1, NULL, 0, 0); // of the wrong size: as if the reader was lost
    return true;
}

static bool burn(const isolate_call *call) {
    volatile uint32_t i = 0;
    while (i < 200000000) i++;
    return call->size == 0;
}

// What a decoder of volumes would say that was taken over: the number in the file's name says which
// part of its answer is wrong; 0: none.
static bool lie_of_a_frame(const isolate_call *call) {
    enum { INDEX = 512, TEXELS = 1024 };
    int lie = call->name[strlen(call->name) - 1] - '0';
    vdb_frame_head head = {.active = {{0, 0, 0}, {8, 8, 8}, 1},
                           .images[0] = {.texels = TEXELS, .index = INDEX, .bricks = 1}};
    uint32_t brick = 1;
    size_t size = TEXELS + VDB_BLOCK * VDB_BLOCK * VDB_BLOCK * sizeof(uint16_t);
    if (lie == 1) brick = 2;
    if (lie == 2) head.images[0].bricks = VDB_MOST_BRICKS;
    if (lie == 3) head.images[0].texels = size;
    if (lie == 4) head.images[0].index = UINT64_MAX - 3;
    if (lie == 5) head.images[0].texels = 8;
    if (lie == 6) head.active.high[1] = 9;
    if (lie == 7) head.active.low[2] = 8;
    if (lie == 8) size = sizeof head - 1;
    if (lie == 9) head.images[0].index = INDEX + 1;
    char *answer = mem_alloc(TEXELS + size);
    memcpy(answer, &head, sizeof head);
    memcpy(answer + INDEX, &brick, sizeof brick);
    return isolate_put(call, answer, size);
}

static bool lie_of_a_file(const isolate_call *call) {
    const char *name = call->bytes;
    int lie = name[strlen(name) - 1] - '0';
    const vdb_sent_info untold = {.count = VDB_NO_EXTENTS};
    if (lie == 10) return isolate_put(call, &untold, sizeof untold);
    vdb_sent_info info = {.count = 1, .text = 1};
    vdb_sent_grid grid = {.components = 1, .name = 2, .type = 2};
    char texts[] = "a\0b";
    if (lie == 1) info.count = 2;
    if (lie == 2) info.text = UINT32_MAX;
    if (lie == 3) grid.components = 2;
    if (lie == 4) grid.grid_class = -1;
    if (lie == 5) texts[1] = 'x';
    if (lie == 6) texts[3] = 'x';
    if (lie == 7) grid.index_max[0] = 1 << 30;
    if (lie == 8) grid.index_min[1] = 1;
    if (lie == 9) grid.name = 0;
    return isolate_put(call, &info, sizeof info) && isolate_put(call, "", 1) &&
           isolate_put(call, &grid, sizeof grid) && isolate_put(call, texts, sizeof texts);
}

// Takes until the test opens the gate on its side.
static bool got_ready;

static void get_ready(void) {
    int gate = open(getenv("ROIL_TEST_GATE"), O_RDONLY);
    got_ready = gate >= 0;
    close(gate);
}

static bool tell_ready(const isolate_call *call) {
    return isolate_put(call, got_ready ? "ready" : "", got_ready ? 5 : 0);
}

static const reader_job jobs[] = {
    {"echo", echo, NULL, NULL},
    {"refuse", refuse, NULL, NULL},
    {"crash", crash, NULL, NULL},
    {"leave", leave, NULL, NULL},
    {"spin", spin, NULL, NULL},
    {"beg and spin", beg_and_spin, NULL, NULL},
    {"flood", flood, NULL, NULL},
    {"want much", want_much, NULL, NULL},
    {"pour", pour, NULL, NULL},
    {"beg", beg, NULL, NULL},
    {"escape", escape, NULL, NULL},
    {"lie", lie, NULL, NULL},
    {"burn", burn, NULL, NULL},
    {"prepared", tell_ready, get_ready, NULL},
    {"elsewhere", NULL, NULL, "no-such-program"},
    {"vdb frame", lie_of_a_frame, NULL, NULL},
    {"vdb heads", lie_of_a_file, NULL, NULL},
    {"vdb info", lie_of_a_file, NULL, NULL},
};

// ---- asking -----------------------------------------------------------------------------------

static isolate_job job_of(const char *kind) {
    return (isolate_job){
        .kind = kind,
        .name = "file.x",
        .bytes = "",
        .limits = {.processor_ms = 20000, .memory = (uint64_t)1 << 30, .result = 1 << 20}};
}

static void fails(const isolate_job *job, const char *message) {
    isolate_result r;
    if (isolate_run(job, &r)) fail_msg("%s did not fail", job->kind);
    if (!strstr(err_get(), message)) fail_msg("'%s' is not in: %s", message, err_get());
    assert_null(r.data);
    assert_int_equal(r.size, 0);
}

static void echoes(void) {
    isolate_result r;
    isolate_job job = job_of("echo");
    job.arguments = "arguments and ";
    job.argument_size = 14;
    job.bytes = "bytes";
    job.size = 5;
    if (!isolate_run(&job, &r)) fail_msg("%s", err_get());
    assert_int_equal(r.size, 19);
    assert_memory_equal(r.data, "arguments and bytes", 19);
    ((char *)r.data)[0] = 'A'; // may be written to
    isolate_free(&r);
}

static void results_come_back(void **state) {
    (void)state;
    echoes();
    isolate_result r;
    isolate_job job = job_of("echo"); // nothing
    assert_true(isolate_run(&job, &r));
    assert_int_equal(r.size, 0);
    isolate_free(&r);
}

static void a_file_is_read_from_its_beginning(void **state) {
    (void)state;
    char path[] = "/tmp/roil-reader-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, "contents", 8), 8);
    isolate_job job = job_of("echo");
    job.bytes = NULL;
    job.file = file;
    job.size = 8;
    isolate_result r;
    assert_true(isolate_run(&job, &r));
    assert_memory_equal(r.data, "contents", 8);
    isolate_free(&r);
    job.size = 9; // it was cut since
    fails(&job, "file.x: its size has changed");
    close(file);
    unlink(path);
}

static void failures_come_back_as_messages(void **state) {
    (void)state;
    isolate_job job = job_of("refuse");
    fails(&job, "file.x: no good");
    assert_string_equal(err_get(), "file.x: no good");
    job = job_of("crash");
    fails(&job, "file.x: the reader crashed (signal 11): what a? mess");
    job.who = "the compiler";
    job.name = NULL;
    fails(&job, "the compiler crashed (signal 11)");
    job = job_of("leave"); // as base/memory.h does
    fails(&job, "file.x: the reader ran out of memory (1024 MiB)");
    job = job_of("no such job");
    fails(&job, "");
    job = job_of("elsewhere");
    fails(&job, "could not start a process: there is no no-such-program beside it");
    echoes();
}

static void limits_hold(void **state) {
    (void)state;
    isolate_job job = job_of("pour");
    fails(&job, "file.x: the reader makes more than 1 MiB of it");
    job = job_of("spin");
    job.limits.processor_ms = 100;
    fails(&job, "file.x: the reader ran out of time (0.1 s)");
    job = job_of("flood");
    if (!SANITIZED) fails(&job, "file.x: no memory");
    job = job_of("want much");
    if (!SANITIZED) fails(&job, "file.x: the reader ran out of memory (1024 MiB)");
}

static void processor_time_is_told(void **state) {
    (void)state;
    isolate_result r;
    isolate_job job = job_of("burn");
    assert_true(isolate_run(&job, &r));
    assert_in_range(r.processor_ms, 10, 20000);
    isolate_free(&r);
    job = job_of("spin");
    job.limits.processor_ms = 100;
    assert_false(isolate_run(&job, &r));
    assert_in_range(r.processor_ms, 40, 2000); // counted by other ticks than the limit
}

static void a_worker_can_do_nothing_else(void **state) {
    (void)state;
    if (SANITIZED) skip(); // it has no filter
    isolate_result r;
    isolate_job job = job_of("escape");
    if (!isolate_run(&job, &r)) fail_msg("%s", err_get());
    if (r.size) fail_msg("a worker %.*s", (int)r.size, (char *)r.data);
}

static int give(void *user, const char *name, size_t *size) {
    (void)user;
    if (strcmp(name, "yes") != 0) return -1;
    int file = memfd_create("yes", MFD_CLOEXEC);
    assert_int_equal(write(file, "given", 5), 5);
    *size = 5;
    return file;
}

static void files_are_opened_by_who_asked(void **state) {
    (void)state;
    isolate_result r;
    isolate_job job = job_of("beg");
    job.bytes = "yes";
    job.size = 3;
    fails(&job, "yes: cannot be read");
    job.open = give;
    assert_true(isolate_run(&job, &r));
    assert_memory_equal(r.data, "given", 5);
    isolate_free(&r);
    job.bytes = "no";
    job.size = 2;
    fails(&job, "no: cannot be read");
}

static void a_worker_that_lies_is_not_believed(void **state) {
    (void)state;
    isolate_job job = job_of("lie");
    fails(&job, "the reader's process is gone");
    echoes();
}

static void a_decoder_of_volumes_that_lies_is_not_believed(void **state) {
    (void)state;
    const vdb_source source = {.grid = "a", .components = 1, .gains = {1, 1, 1}};
    arena memory = {0};
    for (int lie = 0; lie <= 10; lie++) {
        char name[16];
        const char *path = name;
        arena *const memories[] = {&memory};
        snprintf(name, sizeof name, "x.vdb%c", '0' + lie);
        const vdb_frame_desc desc = {.path = name,
                                     .box = {{0, 0, 0}, {1, 1, 1}},
                                     .shape = {{8, 8, 8}, false, 1},
                                     .sparse = true,
                                     .max_bytes = 1 << 20,
                                     .sources = &source,
                                     .count = 1};
        vdb_frame frame;
        vdb_info info;
        bool seen = vdb_read_frame(&desc, &frame), known = vdb_read_info(name, &memory, &info);
        bool headed = vdb_read_infos(NULL, &path, 1, memories, &info);
        if (seen != (lie % 10 == 0) || known != (lie == 0) || headed != (lie == 0))
            fail_msg("lie %d: %s", lie, err_get());
        if (lie > 0 && !strstr(err_get(), "returned nonsense")) fail_msg("%s", err_get());
        vdb_frame_free(&frame);
    }
    arena_free(&memory);
}

static void *kill_reader(void *user) {
    pid_t *process = user;
    // The worker's begin is not to be seen from here; the job would run for ever without this.
    assert_int_equal(kill(*process, SIGKILL), 0);
    return NULL;
}

static void a_reader_that_was_lost_is_replaced(void **state) {
    (void)state;
    echoes();
    pid_t first = find_reader();
    if (!first) skip();
    pthread_t thread;
    isolate_job job = job_of("spin");
    job.limits.processor_ms = 300;
    assert_int_equal(pthread_create(&thread, NULL, kill_reader, &first), 0);
    fails(&job, "ran out of time");
    pthread_join(thread, NULL);
    echoes();
    assert_int_not_equal(find_reader(), first);
}

// SIGCHLD ignored means that nobody gets a status: a failure of waitpid is no success.
static void a_host_may_do_what_it_likes_with_its_signals(void **state) {
    (void)state;
    pid_t first = find_reader();
    if (!first) skip();
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    void (*handler)(int) = signal(SIGCHLD, SIG_IGN);
    assert_int_equal(kill(first, SIGKILL), 0);
    echoes();
    assert_int_not_equal(find_reader(), first);
    isolate_job job = job_of("crash");
    fails(&job, "crashed (signal 11)");
    job = job_of("spin");
    job.limits.processor_ms = 50;
    fails(&job, "ran out of time");
    signal(SIGCHLD, handler);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

// In a process of its own, which closes what the tests write to. The first of all: the reader is
// the first thing that is opened there.
static void a_host_may_have_closed_its_standard_files(void **state) {
    (void)state;
    pid_t child = fork();
    if (child == 0) {
        for (int file = 0; file <= STDERR_FILENO; file++) close(file);
        isolate_warm_up("echo");
        isolate_job job = job_of("echo");
        job.bytes = "bytes";
        job.size = 5;
        isolate_result r;
        bool done = isolate_run(&job, &r) && r.size == 5 && memcmp(r.data, "bytes", 5) == 0;
        bool free = fcntl(0, F_GETFD) < 0 && fcntl(1, F_GETFD) < 0 && fcntl(2, F_GETFD) < 0;
        _exit(done && free ? 0 : 1);
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
}

static int give_and_tell(void *user, const char *name, size_t *size) {
    const int *pipe_end = user;
    assert_int_equal(write(*pipe_end, "!", 1), 1);
    return give(NULL, name, size);
}

// All workers are busy for hosts that are killed: the next job has its turn before these run out of
// their time.
static void a_worker_goes_when_nobody_waits(void **state) {
    enum { HOSTS = 8 };
    (void)state;
    pid_t hosts[HOSTS];
    int ends[2];
    echoes(); // the reader is there, and shared
    assert_int_equal(pipe(ends), 0);
    for (int i = 0; i < HOSTS; i++) {
        if ((hosts[i] = fork()) != 0) continue;
        isolate_result r;
        isolate_job job = job_of("beg and spin");
        job.bytes = "yes";
        job.size = 3;
        job.limits.processor_ms = 10000;
        job.open = give_and_tell;
        job.user = &ends[1];
        isolate_run(&job, &r);
        _exit(0);
    }
    for (int i = 0; i < HOSTS; i++) {
        char byte;
        assert_int_equal(read(ends[0], &byte, 1), 1); // one of them is busy
    }
    for (int i = 0; i < HOSTS; i++) {
        assert_int_equal(kill(hosts[i], SIGKILL), 0);
        assert_int_equal(waitpid(hosts[i], NULL, 0), hosts[i]);
    }
    double begin = clock_seconds();
    echoes();
    assert_true(clock_seconds() - begin < 5);
    close(ends[0]);
    close(ends[1]);
}

static void what_is_got_ready_holds_nobody_up(void **state) {
    (void)state;
    isolate_result r;
    isolate_warm_up("prepared");
    echoes(); // the gate is shut
    int gate = open(getenv("ROIL_TEST_GATE"), O_WRONLY);
    assert_true(gate >= 0);
    close(gate);
    isolate_job job = job_of("prepared");
    for (int i = 0; i < 2; i++) {
        if (!isolate_run(&job, &r)) fail_msg("%s", err_get());
        assert_int_equal(r.size, 5);
        isolate_free(&r);
    }
    pid_t first = find_reader();
    if (first) assert_int_equal(kill(first, SIGKILL), 0); // its second process goes, too
}

static void *ask_many(void *user) {
    isolate_result r;
    uint8_t *mine = user;
    isolate_job job = job_of("echo");
    for (int i = 0; i < 20; i++) {
        job.bytes = mine;
        job.size = 64;
        if (!isolate_run(&job, &r)) return user;
        bool same = r.size == 64 && memcmp(r.data, mine, 64) == 0;
        isolate_free(&r);
        if (!same) return user;
    }
    return NULL;
}

// More at once than workers, and than the socket holds: each gets its own answer.
static void many_threads_may_ask(void **state) {
    enum { THREADS = 100 };
    (void)state;
    static uint8_t bytes[THREADS][64];
    pthread_t threads[THREADS];
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 256 << 10);
    for (int i = 0; i < THREADS; i++) {
        memset(bytes[i], i, sizeof bytes[i]);
        assert_int_equal(pthread_create(&threads[i], &small, ask_many, bytes[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        void *failed;
        pthread_join(threads[i], &failed);
        assert_null(failed);
    }
    pthread_attr_destroy(&small);
}

static void without_a_reader_there_is_a_message(void **state) {
    (void)state;
    pid_t first = find_reader();
    if (!first) skip();
    assert_int_equal(kill(first, SIGKILL), 0);
    pid_t child = fork();
    if (child == 0) {
        setenv("ROIL_READER", "/nowhere/roil-reader", 1);
        isolate_job job = job_of("echo");
        isolate_result r;
        bool done = isolate_run(&job, &r);
        _exit(!done && strstr(err_get(), "/nowhere/roil-reader: cannot be run") ? 0 : 1);
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
}

int main(int count, char **arguments) {
    if (count > 0 && strcmp(arguments[0], "roil-reader") == 0)
        return reader_serve(jobs, COUNT_OF(jobs));
    static char self[PATH_CAP];
    if (readlink("/proc/self/exe", self, sizeof self - 1) < 0) return 1;
    setenv("ROIL_READER", self, 1);
    char gate[] = "/tmp/roil-gate-XXXXXX";
    if (!mkdtemp(gate) || rmdir(gate) != 0 || mkfifo(gate, 0600) != 0) return 1;
    setenv("ROIL_TEST_GATE", gate, 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_host_may_have_closed_its_standard_files),
        cmocka_unit_test(results_come_back),
        cmocka_unit_test(a_file_is_read_from_its_beginning),
        cmocka_unit_test(failures_come_back_as_messages),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(processor_time_is_told),
        cmocka_unit_test(a_worker_can_do_nothing_else),
        cmocka_unit_test(files_are_opened_by_who_asked),
        cmocka_unit_test(a_worker_that_lies_is_not_believed),
        cmocka_unit_test(a_decoder_of_volumes_that_lies_is_not_believed),
        cmocka_unit_test(a_reader_that_was_lost_is_replaced),
        cmocka_unit_test(a_host_may_do_what_it_likes_with_its_signals),
        cmocka_unit_test(a_worker_goes_when_nobody_waits),
        cmocka_unit_test(what_is_got_ready_holds_nobody_up),
        cmocka_unit_test(many_threads_may_ask),
        cmocka_unit_test(without_a_reader_there_is_a_message),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(gate);
    return failed;
}
