// How soon an edit is seen: from the close of the file to the submission of the first new frame.
// Drawing is left out: the device is idle when the file is written, and not waited for after.
//
//   bench_reload [FILE.lua]     effects/explosion.lua if none is named; a copy of its folder is
//   edited
#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "roil.h"
#include <ftw.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { WIDTH = 96, HEIGHT = 54, ROUNDS = 50 };

static void fail(const char *what) {
    fprintf(stderr, "bench_reload: %s: %s\n", what, roil_error());
    exit(EXIT_FAILURE);
}

// ---- the edited copy --------------------------------------------------------------------------

static char folder[PATH_CAP];

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

static void remove_folder(void) {
    nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

static void copy_folder(const char *from) {
    char command[3 * PATH_CAP];
    snprintf(folder, sizeof folder, "/tmp/roil-bench-XXXXXX");
    if (!mkdtemp(folder)) fail(folder);
    atexit(remove_folder);
    snprintf(command, sizeof command, "cp -rL '%s/.' '%s'", from, folder);
    if (system(command) != 0) fail("the effect's folder cannot be copied");
}

static char *read_text(const char *path) { // mem_free
    void *data;
    size_t size;
    if (!file_read(path, 1 << 20, &data, &size)) fail(path);
    return data;
}

// In place, as most editors write; returns the time of the close.
static double write_text(const char *path, const char *before, const char *after) {
    FILE *file = fopen(path, "w");
    if (!file || fputs(before, file) < 0 || fputs(after, file) < 0) fail(path);
    fclose(file);
    return clock_seconds();
}

// ---- measuring --------------------------------------------------------------------------------

typedef struct bell { // rung by the builder
    pthread_mutex_t mutex;
    pthread_cond_t rung;
    bool ringing;
} bell;

static bell news = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, false};

static void ring(void *user) {
    (void)user;
    pthread_mutex_lock(&news.mutex);
    news.ringing = true;
    pthread_cond_signal(&news.rung);
    pthread_mutex_unlock(&news.mutex);
}

static void wait_for_news(void) {
    pthread_mutex_lock(&news.mutex);
    while (!news.ringing) pthread_cond_wait(&news.rung, &news.mutex);
    news.ringing = false;
    pthread_mutex_unlock(&news.mutex);
}

typedef struct sample {
    double seen, gap; // milliseconds: until the frame is submitted; spent by the main thread
} sample;

static void take(roil_live *live, double frame) {
    if (!roil_live_update(live, WIDTH, HEIGHT, frame) || roil_live_message(live)) {
        fprintf(stderr, "bench_reload: %s\n", roil_live_message(live));
        exit(EXIT_FAILURE);
    }
}

static void settle(roil_live *live) { // nothing is being drawn or built
    static uint8_t pixels[WIDTH * HEIGHT * 4];
    roil_live_wait(live);
    if (!roil_read(roil_live_effect(live), false, pixels)) fail("read");
}

static sample measure(roil_live *live, double *frame, const char *path, const char *before,
                      const char *after) {
    settle(live);
    double closed = write_text(path, before, after);
    wait_for_news();
    double woken = clock_seconds();
    take(live, *frame);
    double taken = clock_seconds();
    if (!roil_advance(roil_live_effect(live), *frame)) fail("advance");
    double submitted = clock_seconds();
    *frame += 1;
    return (sample){1e3 * (submitted - closed), 1e3 * (taken - woken)};
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print(const char *name, const sample *samples, double target) {
    double seen[ROUNDS], gap[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) {
        seen[i] = samples[i].seen;
        gap[i] = samples[i].gap;
    }
    qsort(seen, ROUNDS, sizeof *seen, by_size);
    qsort(gap, ROUNDS, sizeof *gap, by_size);
    printf("| %s | %.1f | %.1f | %.1f | %.1f | %.0f |\n", name, seen[ROUNDS / 2], seen[ROUNDS - 1],
           gap[ROUNDS / 2], gap[ROUNDS - 1], target);
    fflush(stdout);
}

// ---- three kinds of edits
// --------------------------------------------------------------------------

typedef struct bench {
    roil *r;
    roil_live *live;
    double frame;
    char *script; // as it was
    const char *script_path;
} bench;

static double start(bench *b) { // milliseconds
    double begin = clock_seconds();
    b->r = roil_create(&(roil_desc){0});
    if (!b->r) fail("no device");
    b->live = roil_live_create(b->r, &(roil_live_desc){.file = b->script_path, .wake = ring});
    if (!b->live) fail(b->script_path);
    wait_for_news();
    take(b->live, b->frame);
    if (!roil_advance(roil_live_effect(b->live), b->frame++)) fail("advance");
    return 1e3 * (clock_seconds() - begin);
}

static void stop(bench *b) {
    roil_live_destroy(b->live);
    roil_destroy(b->r);
}

// Writes the script with `length` characters at `at` replaced, and measures.
static sample edit(bench *b, const char *at, size_t length, const char *text) {
    char *before = mem_copy(b->script, strlen(b->script) + 1);
    before[at - b->script] = '\0';
    strbuf after = {0};
    strbuf_add(&after, "%s%s", text, at + length);
    sample s = measure(b->live, &b->frame, b->script_path, before, after.text);
    strbuf_free(&after);
    mem_free(before);
    return s;
}

static const char *find(const bench *b, const char *text) {
    const char *at = strstr(b->script, text);
    if (!at) fail("the script has nothing to edit; effects/explosion.lua has");
    return at;
}

static void number_edits(bench *b) {
    sample samples[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) {
        char number[16];
        snprintf(number, sizeof number, "%d", 1000 + i);
        samples[i] = edit(b, find(b, "1400"), 4, number);
    }
    print("number", samples, 30);
}

// To and fro between two noises.
static void warm_edits(bench *b) {
    static const char *const words[] = {"worley_curl\", words", "perlin\", words"};
    sample samples[ROUNDS];
    for (int i = -2; i < ROUNDS; i++) { // the first two are new
        sample s = edit(b, find(b, words[0]), strlen(words[0]), words[(i + 3) % 2]);
        if (i >= 0) samples[i] = s;
    }
    print("structure, compiled before", samples, 60);
}

// A product with factors in an order that never was: numbers are uniforms, only another tree is
// another code.
static void cold_edits(bench *b) {
    sample samples[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) {
        strbuf more = {0};
        for (int k = 0; k < 6; k++)
            strbuf_add(&more,
                       (i + 1) & (1 << k) ? "clamp(1 * smoke, 1, 1) * " : "min(smoke, 0) * 0 + ");
        samples[i] = edit(b, find(b, "cover * crust"), 0, more.text);
        strbuf_free(&more);
    }
    print("structure, new", samples, 300);
}

int main(int argc, char **argv) {
    const char *file = argc > 1 ? argv[1] : "effects/explosion.lua";
    char from[PATH_CAP], path[PATH_CAP];
    path_folder(from, file);
    copy_folder(from);
    if (!path_join(path, folder, path_name(file))) fail(file);

    // Caches of its own, so that what is new is new in every run.
    char cache[PATH_CAP];
    if (!path_join(cache, folder, "cache") || setenv("ROIL_CACHE_DIR", cache, 1) != 0) fail(cache);
    bench b = {.frame = 20, .script = read_text(path), .script_path = path};
    printf("start to first frame submitted: %.0f ms, ", start(&b));
    stop(&b);
    printf("with warm caches %.0f ms\n\n", start(&b));
    printf("| edit | median ms | worst ms | take-over median ms | worst ms | target ms |\n"
           "|---|---|---|---|---|---|\n");
    number_edits(&b);
    warm_edits(&b);
    cold_edits(&b);
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    printf("\nreloads: %llu, largest resident size %ld MB\n",
           (unsigned long long)roil_live_counts(b.live).reloads, use.ru_maxrss >> 10);
    stop(&b);
    mem_free(b.script);
    return EXIT_SUCCESS;
}
