// How a sequence plays back: at its own pace on a display of 60 pictures a second, where nothing
// may wait for data; and as fast as it goes, where every frame waits for its own.
//
//   bench_playback FILE.lua [SECONDS [WIDTH HEIGHT [NAME=VALUE ...]]]     (10 s, 480 x 270)
#include "base/clock.h"
#include "base/memory.h"
#include "roil.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_SETTINGS = 16, MOST_TIMES = 64 };
static const double tick = 1.0 / 60, warm = 1; // seconds: of a picture; that do not count

typedef struct picture { // milliseconds
    double whole, recorded, device;
} picture;

typedef struct bench {
    const char *file;
    double seconds;
    uint32_t width, height;
    roil_setting settings[MOST_SETTINGS];
    size_t setting_count;
    picture *pictures;
    size_t count, capacity;
} bench;

static void fail(const char *what) {
    fprintf(stderr, "bench_playback: %s: %s\n", what, roil_error());
    exit(EXIT_FAILURE);
}

static int by_size(const void *a, const void *b) {
    double x = ((const picture *)a)->whole, y = ((const picture *)b)->whole;
    return (x > y) - (x < y);
}

static void sleep_until(double when) {
    double left = when - clock_seconds();
    if (left <= 0) return;
    struct timespec time = {(time_t)left, (long)((left - (double)(time_t)left) * 1e9)};
    nanosleep(&time, NULL);
}

// Until the device has drawn it, as the live window waits for its times.
static picture draw(roil_effect *e, double frame) {
    roil_time times[MOST_TIMES];
    picture p = {0};
    double begin = clock_seconds();
    if (!roil_advance(e, frame)) fail("advance");
    p.recorded = 1e3 * (clock_seconds() - begin);
    size_t count = roil_times(e, times, MOST_TIMES);
    for (size_t i = 0; i < count; i++) p.device += times[i].milliseconds;
    p.whole = 1e3 * (clock_seconds() - begin);
    return p;
}

static roil_playback playback_of(roil_effect *e) {
    roil_playback now;
    if (!roil_get_playback(e, &now)) fail("the effect has no sequence");
    return now;
}

static roil_effect *open_effect(bench *b, roil **r, bool never_waits) {
    *r = roil_create(&(roil_desc){.never_waits = never_waits});
    if (!*r) fail("no device");
    roil_effect *e = roil_load(*r, b->file, b->settings, b->setting_count);
    if (!e || !roil_prepare(e, b->width, b->height)) fail(b->file);
    return e;
}

static void close_effect(roil *r, roil_effect *e) {
    roil_unload(e);
    roil_destroy(r);
}

static double megabytes(uint64_t after, uint64_t before, double seconds) {
    return (double)(after - before) * 1e-6 / seconds;
}

static void print_frame(const roil_playback *p) {
    printf("a frame takes %.1f MB, %" PRIu64
           " voxels are not 0: %.2f bytes each; all frames on the "
           "device take %.1f MB; %u threads decode\n",
           (double)p->frame_bytes * 1e-6, p->frame_voxels,
           (double)p->frame_bytes / (double)p->frame_voxels, (double)p->device_bytes * 1e-6,
           p->threads);
}

static void in_time(bench *b) {
    roil *r;
    roil_effect *e = open_effect(b, &r, true);
    roil_effect_info info = roil_get_info(e);
    double start = clock_seconds(), next = start, counted = start;
    roil_playback before = {0};
    for (double now = start; now - start < b->seconds + warm || b->count == 0;
         now = clock_seconds()) {
        double at = (now - start) * info.fps;
        picture p = draw(e, info.first_frame + at);
        if (now - start >= warm) {
            MEM_RESERVE(b->pictures, b->count + 1, b->capacity);
            b->pictures[b->count++] = p;
        } else {
            before = playback_of(e);
            counted = clock_seconds();
        }
        next += tick;
        if (next < clock_seconds()) next = clock_seconds();
        sleep_until(next);
    }
    double seconds = clock_seconds() - counted;
    roil_playback after = playback_of(e);
    qsort(b->pictures, b->count, sizeof *b->pictures, by_size);
    size_t over = 0;
    for (size_t i = 0; i < b->count; i++) over += b->pictures[i].whole > 1e3 * tick;
    const picture *often = &b->pictures[b->count * 95 / 100], *worst = &b->pictures[b->count - 1];
    printf(
        "in time:  %.1f frames/s shown of %g, %" PRIu64 " of %zu pictures late; decoded %.0f MB/s, "
        "uploaded %.0f MB/s; decoding took %.2f threads\n"
        "          picture %.2f ms (median), %.2f (95 %%; recorded in %.2f, on the device %.2f), "
        "%.2f (worst; %.2f, %.2f); %zu over %.1f ms\n",
        (double)(after.shown - before.shown) / seconds, info.fps, after.late - before.late,
        b->count, megabytes(after.decoded_bytes, before.decoded_bytes, seconds),
        megabytes(after.uploaded_bytes, before.uploaded_bytes, seconds),
        (after.decode_seconds - before.decode_seconds) / seconds, b->pictures[b->count / 2].whole,
        often->whole, often->recorded, often->device, worst->whole, worst->recorded, worst->device,
        over, 1e3 * tick);
    print_frame(&after);
    close_effect(r, e);
}

static void at_full_speed(bench *b) {
    roil *r;
    roil_effect *e = open_effect(b, &r, false);
    roil_effect_info info = roil_get_info(e);
    draw(e, info.first_frame);
    double start = clock_seconds(), now = start;
    roil_playback before = playback_of(e), after = before;
    for (uint32_t i = 1; now - start < b->seconds && i < info.frames; i++) {
        draw(e, info.first_frame + i);
        now = clock_seconds();
    }
    after = playback_of(e);
    double seconds = now - start, count = (double)(after.decoded - before.decoded);
    printf("all of it: %.1f frames/s; decoded and uploaded %.0f MB/s; a frame takes a thread %.0f "
           "ms\n",
           (double)(after.shown - before.shown) / seconds,
           megabytes(after.uploaded_bytes, before.uploaded_bytes, seconds),
           count > 0 ? 1e3 * (after.decode_seconds - before.decode_seconds) / count : 0);
    close_effect(r, e);
}

int main(int argc, char **argv) {
    bench b = {.seconds = 10, .width = 480, .height = 270};
    if (argc < 2) {
        fprintf(stderr, "bench_playback FILE.lua [SECONDS [WIDTH HEIGHT [NAME=VALUE ...]]]\n");
        return EXIT_FAILURE;
    }
    b.file = argv[1];
    if (argc > 2) b.seconds = atof(argv[2]);
    if (argc > 4) {
        b.width = (uint32_t)atoi(argv[3]);
        b.height = (uint32_t)atoi(argv[4]);
    }
    for (int i = 5; i < argc && b.setting_count < MOST_SETTINGS; i++) {
        char *value = strchr(argv[i], '=');
        if (!value) fail(argv[i]);
        *value = '\0';
        b.settings[b.setting_count++] = (roil_setting){argv[i], value + 1};
    }
    at_full_speed(&b);
    in_time(&b);
    mem_free(b.pictures);
    return EXIT_SUCCESS;
}
