// Reads results.json. Strangers may have written it: every value is checked for its type and its
// range, texts lose control characters, and counts are limited.
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "bench/json.h"
#include "bench/results.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { FILE_MAX = 256 << 20, DEPTH_PARTS = 256, MAX_PARTS = 1024, MAX_FIGURES = 1000000 };
static const double LARGEST = 1e15;

typedef struct reader {
    const char *file;
    char at[DEPTH_PARTS]; // what is being read: "rows[3].gpu_ms.march"
    arena *memory;
} reader;

static bool wrong(const reader *r, const char *key, const char *accepted) {
    return err_set("%s: %s%s%.64s must be %s", r->file, r->at, r->at[0] && key[0] ? "." : "", key,
                   accepted);
}

static void go_to(reader *r, const char *format, ...) PRINTF_LIKE(2, 3);
static void go_to(reader *r, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(r->at, sizeof r->at, format, args);
    va_end(args);
}

// ---- values -----------------------------------------------------------------------------------

static const char *clean_text(const reader *r, const char *text) {
    char *copy = arena_string(r->memory, text);
    str_make_printable(copy);
    return copy;
}

static bool get_text(const reader *r, const json_t *from, const char *key, const char **out) {
    const json_t *value = json_object_get(from, key);
    *out = "";
    if (!value || json_is_null(value)) return true;
    if (!json_is_string(value)) return wrong(r, key, "a text");
    *out = clean_text(r, json_string_value(value));
    return true;
}

static bool number_of(const reader *r, const json_t *value, const char *key, double *out) {
    if (!json_is_number(value)) return wrong(r, key, "a number");
    *out = json_number_value(value);
    return (isfinite(*out) && fabs(*out) <= LARGEST) || wrong(r, key, "a number up to 1e15");
}

static bool get_whole(const reader *r, const json_t *from, const char *key, uint64_t most,
                      uint64_t *out) {
    const json_t *value = json_object_get(from, key);
    *out = 0;
    if (!value) return true;
    if (!json_is_integer(value) || json_integer_value(value) < 0 ||
        (uint64_t)json_integer_value(value) > most)
        return wrong(r, key, "a whole number, and not too large");
    *out = (uint64_t)json_integer_value(value);
    return true;
}

static bool get_whole32(const reader *r, const json_t *from, const char *key, uint32_t *out) {
    uint64_t value;
    if (!get_whole(r, from, key, UINT32_MAX, &value)) return false;
    *out = (uint32_t)value;
    return true;
}

static bool get_numbers(const reader *r, const json_t *from, const char *key, double **out,
                        size_t *count) {
    const json_t *list = json_object_get(from, key);
    *out = NULL;
    *count = 0;
    if (!list) return true;
    if (!json_is_array(list) || json_array_size(list) > MAX_FIGURES)
        return wrong(r, key, "a list of numbers");
    *out = arena_alloc(r->memory, json_array_size(list) * sizeof **out);
    for (; *count < json_array_size(list); (*count)++)
        if (!number_of(r, json_array_get(list, *count), key, &(*out)[*count])) return false;
    return true;
}

// Returns an object, or an empty one where there is none. `size`: the number of its members.
static bool get_object(const reader *r, const json_t *from, const char *key, json_t **out,
                       size_t *size) {
    *out = json_object_get(from, key);
    *size = 0;
    if (!*out || json_is_null(*out)) return true;
    *size = json_object_size(*out);
    return (json_is_object(*out) && *size <= MAX_PARTS) ||
           wrong(r, key, "an object of at most 1024 members");
}

static bool get_settings(const reader *r, const json_t *from, const char *key,
                         bench_settings *out) {
    json_t *all, *value;
    const char *name;
    size_t size;
    *out = (bench_settings){0};
    if (!get_object(r, from, key, &all, &size)) return false;
    out->items = arena_alloc(r->memory, size * sizeof *out->items);
    json_object_foreach(all, name, value) {
        if (!json_is_string(value)) return wrong(r, key, "an object of texts");
        out->items[out->count++] =
            (roil_setting){clean_text(r, name), clean_text(r, json_string_value(value))};
    }
    return true;
}

static bool get_named(const reader *r, const json_t *from, const char *key, bench_numbers *out) {
    json_t *all, *value;
    const char *name;
    size_t size;
    *out = (bench_numbers){0};
    if (!get_object(r, from, key, &all, &size)) return false;
    out->items = arena_alloc(r->memory, size * sizeof *out->items);
    json_object_foreach(all, name, value) {
        sweep_number *n = &out->items[out->count];
        n->name = clean_text(r, name);
        if (!number_of(r, value, key, &n->value)) return false;
        out->count++;
    }
    return true;
}

static bool get_number(const reader *r, const json_t *from, const char *key, double *out) {
    const json_t *value = json_object_get(from, key);
    *out = 0;
    return !value || number_of(r, value, key, out);
}

static bool get_times(const reader *r, const json_t *from, const char *key, bench_times *out) {
    json_t *all, *value;
    const char *name;
    size_t size, kept;
    *out = (bench_times){0};
    if (!get_object(r, from, key, &all, &size)) return false;
    out->items = arena_alloc(r->memory, size * sizeof *out->items);
    json_object_foreach(all, name, value) {
        bench_time *t = &out->items[out->count++];
        double *values;
        uint64_t count;
        t->name = clean_text(r, name);
        if (!json_is_object(value)) return wrong(r, key, "an object of figures");
        if (!get_number(r, value, "median", &t->ms.median) ||
            !get_number(r, value, "p5", &t->ms.p5) || !get_number(r, value, "p95", &t->ms.p95) ||
            !get_whole(r, value, "count", MAX_FIGURES, &count) ||
            !get_numbers(r, value, "values", &values, &kept))
            return false;
        t->ms.count = count;
        if (kept && kept != count) return wrong(r, "values", "as many as 'count' says");
        t->ms.values = kept ? values : NULL;
    }
    return true;
}

// ---- rows -------------------------------------------------------------------------------------

static bool get_state(const reader *r, const json_t *from, bench_row *row) {
    const char *word;
    if (!get_text(r, from, "state", &word)) return false;
    for (bench_state s = BENCH_DONE; s <= BENCH_LIMIT; s++)
        if (strcmp(word, bench_state_name(s)) == 0) {
            row->state = s;
            return true;
        }
    return wrong(r, "state", "\"done\", \"failed\" or \"limit\"");
}

static bool get_error(const reader *r, const json_t *from, bench_row *row) {
    json_t *error;
    size_t size;
    if (!get_object(r, from, "error", &error, &size) || !error || json_is_null(error))
        return !error || json_is_null(error);
    row->compared = true;
    row->psnr = INFINITY;
    return (json_is_null(json_object_get(error, "psnr")) ||
            get_number(r, error, "psnr", &row->psnr)) &&
           get_number(r, error, "ssim", &row->ssim) && get_number(r, error, "flip", &row->flip);
}

// Accepts only names that this program gives, because the files are opened.
static bool get_thumbnail(const reader *r, const json_t *from, bench_row *row) {
    const char *name;
    if (!get_text(r, from, "thumbnail", &name)) return false;
    if (!name[0]) return true;
    size_t digits = strncmp(name, "rows/", 5) == 0 ? strspn(name + 5, "0123456789") : 0;
    if (digits < 4 || digits > 8 || strcmp(name + 5 + digits, ".png") != 0)
        return wrong(r, "thumbnail", "as \"rows/0000.png\"");
    row->thumbnail = name;
    return true;
}

static bool get_memory(const reader *r, const json_t *from, bench_row *row) {
    json_t *memory;
    size_t size;
    return get_object(r, from, "memory", &memory, &size) &&
           get_whole(r, memory, "device", UINT64_MAX, &row->device_bytes) &&
           get_whole(r, memory, "reserved", UINT64_MAX, &row->reserved_bytes) &&
           get_whole(r, memory, "host", UINT64_MAX, &row->host_bytes);
}

static bool read_row(const reader *r, const json_t *from, bench_row *row) {
    uint64_t index;
    if (!json_is_object(from)) return wrong(r, "", "an object");
    if (!get_whole(r, from, "index", BENCH_MAX_ROWS - 1, &index)) return false;
    row->index = index;
    return get_text(r, from, "label", &row->label) && get_text(r, from, "effect", &row->effect) &&
           get_text(r, from, "message", &row->message) && get_state(r, from, row) &&
           get_settings(r, from, "axes", &row->axes) &&
           get_settings(r, from, "settings", &row->settings) &&
           get_whole32(r, from, "width", &row->width) &&
           get_whole32(r, from, "height", &row->height) &&
           get_whole32(r, from, "warmup", &row->warmup) &&
           get_whole32(r, from, "repeats", &row->repeats) &&
           get_number(r, from, "limit", &row->limit) &&
           get_numbers(r, from, "frames", &row->frames, &row->frame_count) &&
           get_times(r, from, "gpu_ms", &row->gpu) && get_times(r, from, "cpu_ms", &row->cpu) &&
           get_times(r, from, "times_ms", &row->times) &&
           get_named(r, from, "counters", &row->counters) &&
           get_named(r, from, "published", &row->published) && get_memory(r, from, row) &&
           get_error(r, from, row) && get_text(r, from, "device", &row->device) &&
           get_text(r, from, "inputs", &row->inputs) && get_thumbnail(r, from, row);
}

static bool read_rows(reader *r, const json_t *root, bench_results *out) {
    const json_t *rows = json_object_get(root, "rows");
    size_t count = json_array_size(rows);
    if (!json_is_array(rows) || count > BENCH_MAX_ROWS)
        return wrong(r, "rows", "a list of at most 4096 rows");
    out->rows = mem_alloc(count * sizeof *out->rows);
    out->row_capacity = count;
    for (size_t i = 0; i < count; i++) {
        bench_row *row = &out->rows[out->row_count];
        go_to(r, "rows[%zu]", i);
        if (!read_row(r, json_array_get(rows, i), row)) return false;
        if (i && row->index <= row[-1].index)
            return wrong(r, "index", "above that of the row before");
        out->row_count++;
    }
    return true;
}

// ---- head -------------------------------------------------------------------------------------

static bool get_texts(const reader *r, const json_t *from, const char *key, size_t most,
                      const char ***out, size_t *count) {
    const json_t *list = json_object_get(from, key);
    *count = 0;
    *out = NULL;
    if (!list) return true;
    if (!json_is_array(list) || json_array_size(list) > most)
        return wrong(r, key, "a list of texts, and not too long");
    *out = arena_alloc(r->memory, json_array_size(list) * sizeof **out);
    for (; *count < json_array_size(list); (*count)++) {
        const char *text = json_string_value(json_array_get(list, *count));
        if (!text) return wrong(r, key, "a list of texts");
        (*out)[*count] = clean_text(r, text);
    }
    return true;
}

static bool read_axes(reader *r, const json_t *root, bench_results *out) {
    const json_t *axes = json_object_get(root, "axes");
    size_t count = json_array_size(axes);
    if (axes && (!json_is_array(axes) || count > BENCH_MAX_AXES))
        return wrong(r, "axes", "a list of at most 16 axes");
    out->axes = arena_alloc(r->memory, count * sizeof *out->axes);
    for (; out->axis_count < count; out->axis_count++) {
        sweep_axis *a = &out->axes[out->axis_count];
        const json_t *from = json_array_get(axes, out->axis_count);
        go_to(r, "axes[%zu]", out->axis_count);
        if (!json_is_object(from)) return wrong(r, "", "an object");
        if (!get_text(r, from, "name", &a->name) || !get_text(r, from, "label", &a->label) ||
            !get_texts(r, from, "values", BENCH_MAX_VALUES, &a->values, &a->value_count))
            return false;
    }
    return true;
}

static bool read_reference(reader *r, const json_t *root, bench_results *out) {
    json_t *from;
    size_t size;
    const char *kind;
    if (!get_object(r, root, "reference", &from, &size)) return false;
    if (!from || json_is_null(from)) return true;
    go_to(r, "reference");
    if (!get_text(r, from, "kind", &kind)) return false;
    bool traced = strcmp(kind, "traced") == 0;
    if (!traced && strcmp(kind, "row") != 0) return wrong(r, "kind", "\"row\" or \"traced\"");
    out->has_reference = true;
    out->reference.traced = traced;
    return get_whole32(r, from, "samples", &out->reference.samples) &&
           get_settings(r, from, "settings", &out->reference.settings);
}

static bool read_tuned(reader *r, const json_t *root, bench_results *out) {
    json_t *from;
    size_t size;
    uint64_t before, chosen;
    if (!get_object(r, root, "tuned", &from, &size)) return false;
    if (!from || json_is_null(from)) return true;
    go_to(r, "tuned");
    if (!get_whole(r, from, "before", BENCH_MAX_ROWS - 1, &before) ||
        !get_whole(r, from, "chosen", BENCH_MAX_ROWS - 1, &chosen))
        return false;
    out->tuned = true;
    out->before = before;
    out->chosen = chosen;
    out->by_process = json_is_true(json_object_get(from, "by_process"));
    return true;
}

static bool read_head(reader *r, const json_t *root, bench_results *out) {
    json_t *machine;
    size_t size;
    return get_text(r, root, "roil", &out->version) && get_text(r, root, "commit", &out->commit) &&
           get_text(r, root, "sweep", &out->sweep) && get_text(r, root, "title", &out->title) &&
           get_text(r, root, "file", &out->file) && get_text(r, root, "content", &out->content) &&
           get_text(r, root, "device", &out->device) && get_text(r, root, "driver", &out->driver) &&
           get_text(r, root, "date", &out->date) &&
           get_object(r, root, "machine", &machine, &size) &&
           get_text(r, machine, "cpu", &out->cpu) && get_text(r, machine, "os", &out->os) &&
           get_whole32(r, machine, "cores", &out->cores) &&
           get_texts(r, root, "notes", BENCH_MAX_VALUES, &out->notes, &out->note_count);
}

bool bench_from_json(const json_t *root, const char *file, bench_results *out) {
    reader r = {.file = file, .memory = &out->memory};
    if (!json_is_object(root)) return wrong(&r, "it", "an object, as roil bench writes it");
    return read_head(&r, root, out) && read_axes(&r, root, out) && read_reference(&r, root, out) &&
           read_tuned(&r, root, out) && read_rows(&r, root, out);
}

// Reads a file below `folder`; without one, the file that the user named.
static bool read_file(const char *folder, const char *file, bench_results *out) {
    void *data;
    size_t size;
    *out = (bench_results){0};
    if (!file_read_inside(folder, file, FILE_MAX, &data, &size)) return false;
    json_error_t error;
    json_t *root = json_loadb(data, size, JSON_REJECT_DUPLICATES, &error);
    mem_free(data);
    bool done = root ? bench_from_json(root, file, out)
                     : err_set("%s:%d: is no JSON: %s", file, error.line, error.text);
    json_decref(root);
    if (!done) bench_results_free(out);
    return done;
}

bool bench_read_file(const char *file, bench_results *out) {
    return read_file(NULL, file, out);
}

bool bench_read(const char *folder, bench_results *out) {
    char path[PATH_CAP];
    *out = (bench_results){0};
    if (!path_join(path, folder, "results.json")) return false;
    return file_exists(path) ? read_file(folder, path, out)
                             : err_set("%s: %s", path, strerror(ENOENT));
}
