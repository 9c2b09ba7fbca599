// Statistics of a rendering: GPU time by pass and frame, counters, the machine.
#include "app/app.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/statistics.h"
#include "base/str.h"
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_PASSES = 256, MAX_COUNTERS = 64, MAX_READOUTS = 64 };

typedef struct frame_stats {
    double number, seconds;
    uint32_t samples; // of a reference
    roil_time *times;
    size_t time_count;
    roil_counter *counters;
    size_t counter_count;
} frame_stats;

struct app_stats {
    frame_stats *frames;
    size_t count, capacity;
    bool plays;                // sequences
    roil_playback first, last; // after the first frame, whose first data nobody could read ahead
    double began, ended;       // clock_seconds
    roil_readout readouts[MAX_READOUTS]; // after the last frame; strings are the effect's
    size_t readout_count;
    char slow[256]; // of the last frame (roil_slow); "": nothing
};

app_stats *app_stats_create(void) {
    return mem_alloc(sizeof(app_stats));
}

void app_stats_add(app_stats *s, roil_effect *e, double frame, double seconds) {
    roil_time times[MAX_PASSES];
    roil_counter counters[MAX_COUNTERS];
    frame_stats f = {.number = frame, .seconds = seconds, .samples = roil_samples(e)};
    f.time_count = roil_times(e, times, MAX_PASSES);
    f.counter_count = roil_counters(e, counters, MAX_COUNTERS);
    if (f.time_count > MAX_PASSES) f.time_count = MAX_PASSES;
    if (f.counter_count > MAX_COUNTERS) f.counter_count = MAX_COUNTERS;
    f.times = mem_copy(times, f.time_count * sizeof *times);
    f.counters = mem_copy(counters, f.counter_count * sizeof *counters);
    *MEM_ADD(s->frames, s->count, s->capacity) = f;
    s->plays = roil_get_playback(e, &s->last);
    s->readout_count = roil_readouts(e, s->readouts, MAX_READOUTS);
    if (s->readout_count > MAX_READOUTS) s->readout_count = MAX_READOUTS;
    if (!roil_slow(e, s->slow, sizeof s->slow)) s->slow[0] = 0;
    s->ended = clock_seconds();
    if (s->count > 1) return;
    s->first = s->last;
    s->began = s->ended;
}

void app_stats_destroy(app_stats *s) {
    for (size_t i = 0; i < s->count; i++) {
        mem_free(s->frames[i].times);
        mem_free(s->frames[i].counters);
    }
    mem_free(s->frames);
    mem_free(s);
}

// ---- summary ----------------------------------------------------------------------------------

// Every frame runs the same passes, so the first frame's names are used.
static stats_summary pass_summary(const app_stats *s, size_t pass, double *values) {
    for (size_t i = 0; i < s->count; i++)
        values[i] = pass < s->frames[i].time_count ? s->frames[i].times[pass].milliseconds : 0;
    return stats_summarise(values, s->count);
}

static stats_summary total_summary(const app_stats *s, double *values) {
    for (size_t i = 0; i < s->count; i++) {
        values[i] = 0;
        for (size_t k = 0; k < s->frames[i].time_count; k++)
            values[i] += s->frames[i].times[k].milliseconds;
    }
    return stats_summarise(values, s->count);
}

// Rates of the sequences since the first frame, per second.
typedef struct playback_rate {
    double shown, decoded, uploaded; // frames, MB, MB
} playback_rate;

static playback_rate rate_of(const app_stats *s) {
    double seconds = s->ended - s->began;
    if (!(seconds > 0)) return (playback_rate){0};
    return (playback_rate){
        (double)(s->last.shown - s->first.shown) / seconds,
        (double)(s->last.decoded_bytes - s->first.decoded_bytes) / seconds * 1e-6,
        (double)(s->last.uploaded_bytes - s->first.uploaded_bytes) / seconds * 1e-6,
    };
}

static double bytes_a_voxel(const roil_playback *p) {
    return p->frame_voxels ? (double)p->frame_bytes / (double)p->frame_voxels : 0;
}

static void print_playback(const app_stats *s) {
    const roil_playback *p = &s->last;
    playback_rate rate = rate_of(s);
    if (!s->plays || p->shown == 0) return;
    app_print(stdout,
              "sequences: %" PRIu64
              " frames shown, %.1f a second; decoded %.0f MB/s, uploaded %.0f MB/s\n",
              p->shown, rate.shown, rate.decoded, rate.uploaded);
    app_print(
        stdout,
        "           a frame takes %.1f MB, %.1f bytes a voxel that is not 0; all take %.1f MB\n",
        (double)p->frame_bytes * 1e-6, bytes_a_voxel(p), (double)p->device_bytes * 1e-6);
}

void app_format_readout(const roil_readout *r, char *out, size_t capacity) {
    if (strcmp(r->unit, "bool") == 0)
        str_copy(out, capacity, r->value != 0 ? "yes" : "no");
    else
        snprintf(out, capacity, "%.6g%s%s", r->value, r->unit[0] ? " " : "", r->unit);
}

static void print_readouts(const app_stats *s) {
    for (size_t i = 0; i < s->readout_count; i++) {
        const roil_readout *r = &s->readouts[i];
        bool first = i == 0 || strcmp(r->pass, s->readouts[i - 1].pass) != 0;
        if (first) app_print(stdout, "%s%s:", i ? "\n" : "", r->pass);
        char value[96];
        app_format_readout(r, value, sizeof value);
        app_print(stdout, "%s %s %s", first ? "" : ",", r->name, value);
    }
    if (s->readout_count) app_print(stdout, "\n");
}

void app_stats_print(const app_stats *s) {
    if (!s->count) return;
    double *values = mem_alloc(s->count * sizeof *values);
    app_print(stdout, "%-20s %10s %10s   GPU ms over %zu frame%s\n", "pass", "median", "95 %",
              s->count, s->count == 1 ? "" : "s");
    for (size_t i = 0; i < s->frames[0].time_count; i++) {
        stats_summary m = pass_summary(s, i, values);
        app_print(stdout, "%-20s %10.3f %10.3f\n", s->frames[0].times[i].pass, m.median, m.p95);
    }
    stats_summary total = total_summary(s, values);
    app_print(stdout, "%-20s %10.3f %10.3f\n", "all", total.median, total.p95);
    mem_free(values);
    print_playback(s);
    print_readouts(s);
    if (s->slow[0]) app_print(stdout, "%s\n", s->slow);
}

// ---- file -------------------------------------------------------------------------------------

static json_t *frame_json(const frame_stats *f) {
    json_t *passes = json_object(), *counters = json_object();
    for (size_t i = 0; i < f->time_count; i++)
        json_object_set_new(passes, f->times[i].pass, json_real(f->times[i].milliseconds));
    for (size_t i = 0; i < f->counter_count; i++) {
        char name[160];
        snprintf(name, sizeof name, "%s.%s", f->counters[i].pass, f->counters[i].name);
        json_object_set_new(counters, name, json_integer((json_int_t)f->counters[i].value));
    }
    json_t *all = json_pack("{s:f, s:f, s:o, s:o}", "frame", f->number, "cpu_ms", f->seconds * 1000,
                            "gpu_ms", passes, "counters", counters);
    if (f->samples) json_object_set_new(all, "samples", json_integer(f->samples));
    return all;
}

static json_t *playback_json(const app_stats *s) {
    const roil_playback *p = &s->last;
    playback_rate rate = rate_of(s);
    return json_pack("{s:I, s:I, s:f, s:f, s:f, s:I, s:I, s:I, s:i}", "shown", (json_int_t)p->shown,
                     "late", (json_int_t)p->late, "frames_a_second", rate.shown,
                     "decoded_mb_a_second", rate.decoded, "uploaded_mb_a_second", rate.uploaded,
                     "device_bytes", (json_int_t)p->device_bytes, "frame_bytes",
                     (json_int_t)p->frame_bytes, "frame_voxels", (json_int_t)p->frame_voxels,
                     "threads", (int)p->threads);
}

static json_t *readouts_json(const app_stats *s) {
    json_t *all = json_object();
    for (size_t i = 0; i < s->readout_count; i++) {
        const roil_readout *r = &s->readouts[i];
        char name[160];
        snprintf(name, sizeof name, "%s.%s", r->pass, r->name);
        if (isfinite(r->value)) json_object_set_new(all, name, json_real(r->value));
    }
    return all;
}

bool app_stats_save(const app_stats *s, const char *file, const roil *r, const char *effect,
                    uint32_t width, uint32_t height, const roil_setting *settings, size_t count) {
    json_t *root = json_pack("{s:s, s:s, s:s, s:s, s:i, s:i}", "roil", roil_version(), "effect",
                             effect, "device", roil_device_name(r), "driver", roil_device_driver(r),
                             "width", (int)width, "height", (int)height);
    json_t *set = json_object(), *frames = json_array(), *median = json_object();
    for (size_t i = 0; i < count; i++)
        json_object_set_new(set, settings[i].name, json_string(settings[i].value));
    for (size_t i = 0; i < s->count; i++) json_array_append_new(frames, frame_json(&s->frames[i]));
    double *values = mem_alloc(s->count * sizeof *values);
    for (size_t i = 0; s->count && i < s->frames[0].time_count; i++)
        json_object_set_new(median, s->frames[0].times[i].pass,
                            json_real(pass_summary(s, i, values).median));
    if (s->count) json_object_set_new(median, "all", json_real(total_summary(s, values).median));
    mem_free(values);
    json_object_set_new(root, "set", set);
    json_object_set_new(root, "median_gpu_ms", median);
    json_object_set_new(root, "frames", frames);
    if (s->readout_count) json_object_set_new(root, "readouts", readouts_json(s));
    if (s->plays) json_object_set_new(root, "sequences", playback_json(s));
    if (s->slow[0]) json_object_set_new(root, "slow", json_string(s->slow));
    char *text = json_text(root, JSON_INDENT(1) | JSON_REAL_PRECISION(6));
    json_decref(root);
    if (!text) return err_set("%s: the statistics cannot be written as JSON", file);
    bool done = file_make_parent_folders(file) && file_write(file, text, strlen(text));
    mem_free(text);
    return done;
}
