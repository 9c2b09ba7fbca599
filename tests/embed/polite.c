// A host that is hard to live with: it ignores SIGCHLD, has functions called as roil's own are,
// writes numbers with a comma, has 64 threads, and its memory fails. What roil does to it, it tells
// by its status and a line on stdout; roil itself must write nothing.
//
//   polite threads EFFECT.lua         64 threads, each with a roil; of these 2 draw
//   polite memory EFFECT.lua COUNT    fails COUNT allocations, spread over all, once and for good
//   polite numbers EFFECT.lua         frames in which 50 numbers change, and what they cost
#define _POSIX_C_SOURCE 200809L
#include <locale.h>
#include <pthread.h>
#include <roil.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { WIDTH = 32, HEIGHT = 18, BYTES = WIDTH * HEIGHT * 4, THREADS = 64, DRAWING = 2 };

// Names that roil has inside. Would it call these, it would end here.
bool file_read(void);
void log_write(void);
void *mem_alloc(size_t size);
bool file_read(void) {
    abort();
}
void log_write(void) {
    abort();
}
void *mem_alloc(size_t size) {
    (void)size;
    abort();
}

static _Noreturn void fail(const char *what) {
    printf("polite: %s: %s\n", what, roil_error());
    fflush(stdout);
    _Exit(1);
}

static double seconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// ---- one use of roil --------------------------------------------------------------------------

typedef struct use {
    const char *file;
    bool draws;
    uint8_t pixels[BYTES];
    bool failed, lacked; // memory, in a call that can fail
    char message[256];
} use;
static bool memory_failed(void);

static bool works(use *u, roil_effect *e) {
    float thickness = 5;
    size_t control;
    char *text = NULL;
    bool done = roil_check(e) && roil_find_control(e, "thickness", &control) &&
                roil_set_floats(e, control, &thickness, 1) && roil_set(e, "steps", "6") &&
                (text = roil_info_params(e)) != NULL;
    roil_free(text);
    if (!done || !u->draws) return done && roil_graph_passes(e, NULL, 0) > 0; // allocates last
    return roil_prepare(e, WIDTH, HEIGHT) && roil_render(e, 2) && roil_read(e, false, u->pixels);
}

// Creates all and destroys all. What fails leaves a message.
static void use_roil(use *u) {
    const roil_setting setting = {"thickness", "4"};
    roil *r = roil_create(&(roil_desc){.no_device = !u->draws});
    roil_effect *e = r ? roil_load(r, u->file, &setting, 1) : NULL;
    u->failed = !e || !works(u, e);
    if (u->failed) snprintf(u->message, sizeof u->message, "%s", roil_error());
    u->lacked = memory_failed();
    if (r && roil_validation_messages(r)) fail("Vulkan was misused");
    roil_unload(e);
    roil_destroy(r);
}

// ---- threads ----------------------------------------------------------------------------------

static void *use_in_thread(void *user) {
    use *u = user;
    use_roil(u);
    return NULL;
}

static void count_message(void *user, int level, const char *text) {
    if (level == ROIL_INFO && strcmp(text, "said by the script") == 0) ++*(int *)user;
}

// Nobody hears of what the threads' scripts say, until somebody wants to.
static void try_threads(const char *file) {
    static use uses[THREADS];
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++) {
        uses[i] = (use){.file = file, .draws = i < DRAWING};
        if (pthread_create(&threads[i], NULL, use_in_thread, &uses[i]) != 0) fail("no thread");
    }
    for (int i = 0; i < THREADS; i++) pthread_join(threads[i], NULL);
    for (int i = 0; i < THREADS; i++) {
        if (uses[i].failed) printf("%s\n", uses[i].message);
        if (uses[i].failed) fail("a thread failed");
        if (i < DRAWING && memcmp(uses[i].pixels, uses[0].pixels, BYTES) != 0) fail("differs");
    }
    int said = 0;
    use last = {.file = file};
    roil_set_log(count_message, &said, ROIL_INFO);
    use_roil(&last);
    roil_set_log(NULL, NULL, ROIL_INFO);
    use_roil(&last);
    if (said != 1) fail("the script's message is not told once");
    printf("%d threads, %d of them drew\n", THREADS, DRAWING);
}

// ---- memory -----------------------------------------------------------------------------------

static struct {
    atomic_long count, blocks; // allocations so far; blocks in use
    long wanted;               // which of them fails; 0: none
    bool always;               // and all later ones
    atomic_long failed;
} heap;

static bool memory_failed(void) {
    return atomic_load(&heap.failed) > 0;
}

static void *allocate(void *user, void *block, size_t size) {
    (void)user;
    if (!size) {
        atomic_fetch_sub(&heap.blocks, 1);
        free(block);
        return NULL;
    }
    long number = atomic_fetch_add(&heap.count, 1) + 1;
    if (heap.wanted && (number == heap.wanted || (heap.always && number > heap.wanted))) {
        atomic_fetch_add(&heap.failed, 1);
        return NULL;
    }
    void *given = realloc(block, size);
    if (given && !block) atomic_fetch_add(&heap.blocks, 1);
    return given;
}

static long run(use *u, long wanted, bool always) {
    heap.wanted = wanted;
    heap.always = always;
    atomic_store(&heap.count, 0);
    atomic_store(&heap.failed, 0);
    use_roil(u);
    heap.wanted = 0;
    if (atomic_load(&heap.blocks) != 0) {
        printf("%ld blocks were not freed (allocation %ld failed)\n", atomic_load(&heap.blocks),
               wanted);
        fail("leaks");
    }
    return atomic_load(&heap.count);
}

static void try_memory(const char *file, long count, bool draws) {
    use good = {.file = file, .draws = draws}, u = good;
    long calls = 0, tried = 0, total;
    run(&good, 0, false); // what lives as long as the process is there from now on
    if (good.failed) fail(good.message);
    total = run(&good, 0, false);
    if (good.failed || total < count) fail("too few allocations");
    for (long i = 0; i < 2 * count; i++, tried++) {
        long at = 1 + (i / 2) * (total - 1) / (count > 1 ? count - 1 : 1);
        run(&u, at, i % 2);
        calls += u.failed;
        if (u.failed && !strstr(u.message, "out of memory") &&
            !strstr(u.message, "not enough memory")) {
            printf("allocation %ld, %s: %s\n", at, i % 2 ? "always" : "once", u.message);
            fail("another message");
        }
        if (!u.failed && memcmp(u.pixels, good.pixels, BYTES) != 0) fail("draws something else");
        if (i % 2 && !u.failed && u.lacked) fail("nobody was told");
    }
    run(&u, 0, false);
    if (u.failed || memcmp(u.pixels, good.pixels, BYTES) != 0) fail("is not as before");
    printf("%s: %ld of %ld allocations, failed once and for good: %ld of %ld uses failed\n",
           draws ? "drawing" : "without a device", count, total, calls, tried);
}

// ---- numbers ----------------------------------------------------------------------------------

enum { FRAMES = 200, MOST = 64 };

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Processor time of this thread: setting 50 numbers, by text and by number, and a frame after it.
static void try_numbers(const char *file) {
    static double by_number[FRAMES], by_text[FRAMES], frame[FRAMES];
    size_t controls[MOST], count = 0;
    roil *r = roil_create(&(roil_desc){0});
    roil_effect *e = r ? roil_load(r, file, NULL, 0) : NULL;
    if (!e || !roil_prepare(e, WIDTH, HEIGHT)) fail("no effect");
    for (size_t i = 0; i < roil_control_count(e) && count < 50; i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        bool number = c.type == ROIL_FLOAT || c.type == ROIL_VECTOR || c.type == ROIL_COLOR;
        if (number && !c.structural) controls[count++] = i;
    }
    if (count < 50) fail("fewer than 50 numbers");
    for (int i = 0; i < FRAMES; i++) {
        double begin = seconds(CLOCK_THREAD_CPUTIME_ID);
        for (size_t k = 0; k < count; k++) {
            roil_control c;
            roil_get_control(e, controls[k], &c);
            char *text = roil_control_text(e, c.name);
            if (!text || !roil_set(e, c.name, text)) fail(c.name);
            roil_free(text);
        }
        double middle = seconds(CLOCK_THREAD_CPUTIME_ID);
        by_text[i] = middle - begin;
    }
    for (int i = 0; i < FRAMES; i++) {
        float values[MOST][4];
        roil_control c[MOST];
        for (size_t k = 0; k < count; k++) {
            roil_get_control(e, controls[k], &c[k]);
            memcpy(values[k], c[k].value, sizeof values[k]);
        }
        double begin = seconds(CLOCK_THREAD_CPUTIME_ID);
        for (size_t k = 0; k < count; k++)
            if (!roil_set_floats(e, controls[k], values[k], c[k].components)) fail(c[k].name);
        double middle = seconds(CLOCK_THREAD_CPUTIME_ID);
        if (!roil_advance(e, 1)) fail("no frame");
        by_number[i] = middle - begin;
        frame[i] = seconds(CLOCK_THREAD_CPUTIME_ID) - middle;
    }
    qsort(by_number, FRAMES, sizeof *by_number, by_size);
    qsort(by_text, FRAMES, sizeof *by_text, by_size);
    qsort(frame, FRAMES, sizeof *frame, by_size);
    printf("50 numbers: %.1f us or %.1f us by text; a frame: %.1f us (medians of processor time)\n",
           1e6 * by_number[FRAMES / 2], 1e6 * by_text[FRAMES / 2], 1e6 * frame[FRAMES / 2]);
    roil_unload(e);
    roil_destroy(r);
}

// ---- all of it --------------------------------------------------------------------------------

typedef struct manners { // what of the process is its own
    void (*handlers[32])(int);
    int flags[32];
    mode_t mask;
    char locale[256];
} manners;

static void note(manners *m) {
    memset(m, 0, sizeof *m);
    for (int i = 1; i < 32; i++) {
        struct sigaction action;
        sigaction(i, NULL, &action);
        m->handlers[i] = action.sa_handler;
        m->flags[i] = action.sa_flags;
    }
    m->mask = umask(022);
    umask(m->mask);
    snprintf(m->locale, sizeof m->locale, "%s", setlocale(LC_ALL, NULL));
}

int main(int argc, char **argv) {
    static manners before, after;
    if (argc < 3) return 2;
    signal(SIGCHLD, SIG_IGN);
    if (!setlocale(LC_ALL, "de_DE.UTF-8")) fail("no locale de_DE.UTF-8 in LOCPATH");
    note(&before);
    if (strcmp(argv[1], "threads") == 0) try_threads(argv[2]);
    if (strcmp(argv[1], "numbers") == 0) try_numbers(argv[2]);
    if (strcmp(argv[1], "memory") == 0 && argc == 4) {
        const roil_allocator own = {allocate, NULL};
        if (!roil_set_allocator(&own)) fail("the allocator");
        try_memory(argv[2], atol(argv[3]), false);
        try_memory(argv[2], atol(argv[3]) / 4, true);
    }
    note(&after);
    if (memcmp(&before, &after, sizeof before) != 0) fail("the process was changed");
    return 0;
}
