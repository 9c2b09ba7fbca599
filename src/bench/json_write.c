// Results as results.json.
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "bench/json.h"
#include "bench/results.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS = 8 };
static const double EXACT_WHOLE = 9007199254740992; // 2^53

// Converts to UTF-8, which JSON requires: names of files and devices can be anything.
static json_t *text(const char *from) {
    json_t *value = json_string(from ? from : "");
    if (value) return value;
    arena memory = {0};
    char *clean = arena_string(&memory, from);
    for (char *at = clean; *at; at++)
        if ((unsigned char)*at >= 128) *at = '?';
    value = json_string(clean);
    arena_free(&memory);
    return value;
}

static bool is_whole(double value) {
    return fabs(value) < EXACT_WHOLE && value == floor(value);
}

static double rounded(double value) { // to the digits that are written
    char text[32];
    snprintf(text, sizeof text, "%.*g", DIGITS, value);
    return strtod(text, NULL);
}

// JSON has no infinity. Whole numbers keep all their digits: samples are counted by the million.
// What is whole only as it is written is written as such, so that reading and writing again changes
// nothing.
static json_t *number(double value) {
    if (!is_whole(value)) value = rounded(value);
    if (is_whole(value)) return json_integer((json_int_t)value);
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *whole(uint64_t value) {
    return json_integer((json_int_t)value);
}

static json_t *settings_json(const bench_settings *s) {
    json_t *all = json_object();
    for (size_t i = 0; i < s->count; i++)
        json_object_set_new(all, s->items[i].name, text(s->items[i].value));
    return all;
}

static json_t *numbers_json(const bench_numbers *n) {
    json_t *all = json_object();
    for (size_t i = 0; i < n->count; i++)
        json_object_set_new(all, n->items[i].name, number(n->items[i].value));
    return all;
}

static json_t *numbers_list(const double *values, size_t count) {
    json_t *all = json_array();
    for (size_t i = 0; i < count; i++) json_array_append_new(all, number(values[i]));
    return all;
}

static json_t *figure_json(const bench_figure *f) {
    json_t *all = json_pack("{s:o, s:o, s:o, s:o}", "median", number(f->median), "p5",
                            number(f->p5), "p95", number(f->p95), "count", whole(f->count));
    if (f->values) json_object_set_new(all, "values", numbers_list(f->values, f->count));
    return all;
}

static json_t *times_json(const bench_times *t) {
    json_t *all = json_object();
    for (size_t i = 0; i < t->count; i++)
        json_object_set_new(all, t->items[i].name, figure_json(&t->items[i].ms));
    return all;
}

static json_t *row_json(const bench_row *row) {
    json_t *all = json_object();
    json_object_set_new(all, "index", whole(row->index));
    json_object_set_new(all, "label", text(row->label));
    json_object_set_new(all, "axes", settings_json(&row->axes));
    json_object_set_new(all, "effect", text(row->effect));
    json_object_set_new(all, "width", whole(row->width));
    json_object_set_new(all, "height", whole(row->height));
    json_object_set_new(all, "frames", numbers_list(row->frames, row->frame_count));
    json_object_set_new(all, "warmup", whole(row->warmup));
    json_object_set_new(all, "repeats", whole(row->repeats));
    json_object_set_new(all, "limit", number(row->limit));
    json_object_set_new(all, "settings", settings_json(&row->settings));
    json_object_set_new(all, "state", json_string(bench_state_name(row->state)));
    json_object_set_new(all, "message", text(row->message));
    json_object_set_new(all, "gpu_ms", times_json(&row->gpu));
    json_object_set_new(all, "cpu_ms", times_json(&row->cpu));
    json_object_set_new(all, "times_ms", times_json(&row->times));
    json_object_set_new(all, "counters", numbers_json(&row->counters));
    json_object_set_new(all, "memory",
                        json_pack("{s:o, s:o, s:o}", "device", whole(row->device_bytes), "reserved",
                                  whole(row->reserved_bytes), "host", whole(row->host_bytes)));
    if (row->compared)
        json_object_set_new(all, "error",
                            json_pack("{s:o, s:o, s:o}", "psnr", number(row->psnr), "ssim",
                                      number(row->ssim), "flip", number(row->flip)));
    if (row->device && row->device[0]) json_object_set_new(all, "device", text(row->device));
    if (row->inputs && row->inputs[0]) json_object_set_new(all, "inputs", text(row->inputs));
    if (row->thumbnail) json_object_set_new(all, "thumbnail", text(row->thumbnail));
    json_object_set_new(all, "published", numbers_json(&row->published));
    return all;
}

static json_t *texts_json(const char *const *texts, size_t count) {
    json_t *all = json_array();
    for (size_t i = 0; i < count; i++) json_array_append_new(all, text(texts[i]));
    return all;
}

static json_t *axes_json(const bench_results *r) {
    json_t *all = json_array();
    for (size_t i = 0; i < r->axis_count; i++) {
        const sweep_axis *a = &r->axes[i];
        json_array_append_new(all, json_pack("{s:o, s:o, s:o}", "name", text(a->name), "label",
                                             text(a->label), "values",
                                             texts_json(a->values, a->value_count)));
    }
    return all;
}

static json_t *reference_json(const bench_results *r) {
    if (!r->has_reference) return json_null();
    const bench_reference *f = &r->reference;
    json_t *all = json_pack("{s:s, s:o}", "kind", f->traced ? "traced" : "row", "settings",
                            settings_json(&f->settings));
    if (f->traced) json_object_set_new(all, "samples", whole(f->samples));
    return all;
}

json_t *bench_to_tree(const bench_results *r) {
    json_t *all = json_object(), *rows = json_array();
    json_object_set_new(all, "roil", text(r->version));
    json_object_set_new(all, "commit", text(r->commit));
    json_object_set_new(all, "sweep", text(r->sweep));
    json_object_set_new(all, "title", text(r->title));
    json_object_set_new(all, "file", text(r->file));
    json_object_set_new(all, "content", text(r->content));
    json_object_set_new(all, "notes", texts_json(r->notes, r->note_count));
    json_object_set_new(all, "device", text(r->device));
    json_object_set_new(all, "driver", text(r->driver));
    json_object_set_new(all, "machine",
                        json_pack("{s:o, s:o, s:o}", "cpu", text(r->cpu), "cores", whole(r->cores),
                                  "os", text(r->os)));
    json_object_set_new(all, "date", text(r->date));
    json_object_set_new(all, "axes", axes_json(r));
    json_object_set_new(all, "reference", reference_json(r));
    if (r->tuned)
        json_object_set_new(all, "tuned",
                            json_pack("{s:o, s:o, s:b}", "before", whole(r->before), "chosen",
                                      whole(r->chosen), "by_process", (int)r->by_process));
    for (size_t i = 0; i < r->row_count; i++) json_array_append_new(rows, row_json(&r->rows[i]));
    json_object_set_new(all, "rows", rows);
    return all;
}

char *bench_to_json(const bench_results *r) {
    json_t *all = bench_to_tree(r);
    char *json = json_text(all, JSON_INDENT(1) | JSON_REAL_PRECISION(DIGITS));
    json_decref(all);
    return json;
}

bool bench_write(const bench_results *r, const char *folder) {
    char path[PATH_CAP];
    if (!path_join(path, folder, "results.json")) return false;
    char *json = bench_to_json(r);
    if (!json) return err_set("%s: the results cannot be written as JSON", path);
    bool done = file_make_folders(folder) && file_write_inside(folder, path, json, strlen(json));
    mem_free(json);
    return done && bench_write_csv(r, folder);
}
