// What temporal accumulation does to noise and to what moves: flicker and error of flicker.lua,
// frame by frame against many steps without jitter, as rows of a table.
//
//   bench_flicker flicker.lua
#include "base/memory.h"
#include "media/compare.h"
#include "roil.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 180, NUMBERS = WIDTH * HEIGHT * 3, FRAMES = 60, SETTLED = 20 };

typedef struct row {
    const char *name, *steps, *jitter, *random, *gathered, *spread, *response, *known;
} row;

static const row truth = {"truth", "512", "0", "blue", "0", "1", "1", "0"};
static const row rows[] = {
    {"no jitter", "16", "0", "blue", "0", "1", "1", "0"},
    {"white jitter", "16", "1", "white", "0", "1", "1", "0"},
    {"blue jitter", "16", "1", "blue", "0", "1", "1", "0"},
    {"white, 8 frames", "16", "1", "white", "8", "1", "1", "0"},
    {"blue, 4 frames", "16", "1", "blue", "4", "1", "1", "0"},
    {"blue, 8 frames: the default", "16", "1", "blue", "8", "1", "1", "0"},
    {"blue, 16 frames", "16", "1", "blue", "16", "1", "1", "0"},
    {"response 0.75", "16", "1", "blue", "8", "1", "0.75", "0"},
    {"response 0", "16", "1", "blue", "8", "1", "0", "0"},
    {"response 0, velocity", "16", "1", "blue", "8", "1", "0", "1"},
    {"no clipping", "16", "1", "blue", "8", "10", "1", "0"},
    {"half the spread", "16", "1", "blue", "8", "0.5", "1", "0"},
    {"velocity", "16", "1", "blue", "8", "1", "1", "1"},
};

static void fail(const char *what) {
    fprintf(stderr, "bench_flicker: %s: %s\n", what, roil_error());
    exit(EXIT_FAILURE);
}

static roil_effect *load(roil *r, const char *file, const char *motion, const row *how) {
    const roil_setting settings[] = {
        {"motion", motion},          {"steps", how->steps},       {"jitter", how->jitter},
        {"random", how->random},     {"gathered", how->gathered}, {"spread", how->spread},
        {"response", how->response}, {"known", how->known},
    };
    roil_effect *e = roil_load(r, file, settings, sizeof settings / sizeof *settings);
    if (!e || !roil_prepare(e, WIDTH, HEIGHT)) fail(file);
    return e;
}

static void draw(roil_effect *e, int frame, float *rgb) {
    static uint8_t pixels[WIDTH * HEIGHT * 4];
    if (!roil_render(e, frame) || !roil_read(e, false, pixels)) fail("frame");
    for (int i = 0; i < NUMBERS; i++) rgb[i] = (float)pixels[i / 3 * 4 + i % 3] / 255;
}

// Of errors against the truth: how much they change from frame to frame, in levels of 255.
static double change(const float *now, const float *before) {
    double sum = 0;
    for (int i = 0; i < NUMBERS; i++) sum += fabs((double)now[i] - (double)before[i]);
    return 255 * sum / NUMBERS;
}

static void measure(roil *r, const char *file, const char *motion, const row *how,
                    const float *wanted) {
    static float now[NUMBERS], error[2][NUMBERS], map[WIDTH * HEIGHT];
    roil_effect *e = load(r, file, motion, how);
    double flicker = 0, psnr = 0, worst = INFINITY, flip = 0;
    int count = 0, flips = 0;
    for (int frame = 1; frame <= FRAMES; frame++) {
        const float *want = wanted + (size_t)(frame - 1) * NUMBERS;
        float *apart = error[frame % 2];
        draw(e, frame, now);
        for (int i = 0; i < NUMBERS; i++) apart[i] = now[i] - want[i];
        if (frame <= SETTLED) continue;
        compare_picture a = {WIDTH, HEIGHT, now}, b = {WIDTH, HEIGHT, want};
        double one = compare_psnr(&a, &b);
        flicker += change(apart, error[(frame + 1) % 2]);
        psnr += one;
        worst = fmin(worst, one);
        count++;
        if (frame % 10 != 0) continue;
        flip += compare_flip(&a, &b, 67, map);
        flips++;
    }
    printf("| %s | %s | %.3f | %.2f | %.2f | %.4f |\n", motion, how->name, flicker / count,
           psnr / count, worst, flip / flips);
    fflush(stdout);
    roil_unload(e);
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// GPU milliseconds of march and accumulate with the defaults.
static void print_cost(roil *r, const char *file) {
    static const char *const passes[] = {"march", "accumulate"};
    double cost[2][FRAMES];
    roil_effect *e = load(r, file, "camera", &rows[5]);
    if (!roil_prepare(e, 1920, 1080)) fail("size");
    for (int frame = 0; frame < FRAMES; frame++) {
        roil_time times[64];
        if (!roil_render(e, frame + 1)) fail("frame");
        size_t count = roil_times(e, times, sizeof times / sizeof *times);
        for (size_t t = 0; t < count; t++)
            for (int p = 0; p < 2; p++)
                if (strcmp(times[t].pass, passes[p]) == 0) cost[p][frame] = times[t].milliseconds;
    }
    roil_unload(e);
    printf("\n1920x1080 on %s:", roil_device_name(r));
    for (int p = 0; p < 2; p++) {
        qsort(cost[p], FRAMES, sizeof cost[p][0], by_size);
        printf(" %s %.3f ms", passes[p], cost[p][FRAMES / 2]);
    }
    printf("\n");
}

int main(int argc, char **argv) {
    static const char *const motions[] = {"none", "camera", "wind", "fire"};
    if (argc != 2) {
        fprintf(stderr, "usage: bench_flicker flicker.lua\n");
        return EXIT_FAILURE;
    }
    roil *r = roil_create(&(roil_desc){0});
    if (!r) fail("no device");
    float *wanted = mem_alloc((size_t)FRAMES * NUMBERS * sizeof *wanted);
    printf("| what moves | samples | flicker (of 255) | PSNR dB | worst frame | FLIP |\n"
           "|---|---|---|---|---|---|\n");
    for (int m = 0; m < 4; m++) {
        roil_effect *e = load(r, argv[1], motions[m], &truth);
        for (int frame = 1; frame <= FRAMES; frame++)
            draw(e, frame, wanted + (size_t)(frame - 1) * NUMBERS);
        roil_unload(e);
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
            measure(r, argv[1], motions[m], &rows[i], wanted);
    }
    mem_free(wanted);
    print_cost(r, argv[1]);
    roil_destroy(r);
    return EXIT_SUCCESS;
}
