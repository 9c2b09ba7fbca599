// Results as results.csv (RFC 4180): a line for each row, and a column for everything that any row
// has.
#include "base/file.h"
#include "base/memory.h"
#include "base/words.h"
#include "bench/json.h"
#include "bench/results.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

// ---- names of columns -------------------------------------------------------------------------

typedef struct names { // each once, in the order in which they are met
    const char **items;
    size_t count, capacity;
} names;

static void add_name(names *n, const char *name) {
    if (words_find(n->items, n->count, name) >= 0) return;
    *MEM_ADD(n->items, n->count, n->capacity) = name;
}

typedef struct column { // of names that rows have
    const char *prefix;
    size_t at; // of a bench_times or a bench_numbers, in bench_row
} column;
static const column time_columns[] = {{"gpu", offsetof(bench_row, gpu)},
                                      {"cpu", offsetof(bench_row, cpu)},
                                      {"time", offsetof(bench_row, times)}};
static const column number_columns[] = {{"counter", offsetof(bench_row, counters)},
                                        {"published", offsetof(bench_row, published)}};

static const bench_times *times_of(const bench_row *row, size_t at) {
    return (const bench_times *)((const char *)row + at);
}

static const bench_numbers *numbers_of(const bench_row *row, size_t at) {
    return (const bench_numbers *)((const char *)row + at);
}

// "all" comes after the passes, even when a later row has another pass.
static names time_names(const bench_results *r, size_t at) {
    names n = {0};
    bool all = false;
    for (size_t i = 0; i < r->row_count; i++) {
        const bench_times *t = times_of(&r->rows[i], at);
        for (size_t k = 0; k < t->count; k++) {
            if (strcmp(t->items[k].name, "all") == 0)
                all = true;
            else
                add_name(&n, t->items[k].name);
        }
    }
    if (all) add_name(&n, "all");
    return n;
}

static names number_names(const bench_results *r, size_t at) {
    names n = {0};
    for (size_t i = 0; i < r->row_count; i++) {
        const bench_numbers *all = numbers_of(&r->rows[i], at);
        for (size_t k = 0; k < all->count; k++) add_name(&n, all->items[k].name);
    }
    return n;
}

typedef struct columns {
    names times[COUNT_OF(time_columns)], numbers[COUNT_OF(number_columns)];
} columns;

// ---- lines ------------------------------------------------------------------------------------

static void add_quoted(strbuf *out, const char *text) {
    bool quoted = text[strcspn(text, ",\"\r\n")] != '\0';
    if (!quoted) {
        strbuf_add(out, "%s", text);
        return;
    }
    strbuf_append(out, "\"", 1);
    for (; *text; text++) strbuf_append(out, *text == '"' ? "\"\"" : text, *text == '"' ? 2 : 1);
    strbuf_append(out, "\"", 1);
}

// Spreadsheets execute texts that begin so, unless they are numbers.
static bool looks_like_formula(const char *text) {
    if (!text[0] || !strchr("=+-@\t\r", text[0])) return false;
    char *end;
    double value = str_double(text, &end);
    return end == text || *end || !isfinite(value) || strchr(text, 'x') || strchr(text, 'X');
}

// Quotes a text if necessary. An apostrophe before what looks like a formula makes it a text.
static void add_text(strbuf *out, const char *text) {
    if (out->length && out->text[out->length - 1] != '\n') strbuf_append(out, ",", 1);
    strbuf safe = {0};
    if (looks_like_formula(text)) {
        strbuf_add(&safe, "'%s", text);
        add_quoted(out, safe.text);
    } else {
        add_quoted(out, text);
    }
    strbuf_free(&safe);
}
static void add_number(strbuf *out, double value) {
    strbuf_add(out, isinf(value) ? ",inf" : ",%.8g", value);
}

static void add_heading(strbuf *out, const char *prefix, const char *name, const char *of) {
    strbuf text = {0};
    strbuf_add(&text, "%s.%s%s", prefix, name, of);
    add_text(out, text.text);
    strbuf_free(&text);
}

static void add_headings(const bench_results *r, const columns *c, strbuf *out) {
    strbuf_add(out, "index,label");
    for (size_t i = 0; i < r->axis_count; i++) add_heading(out, "axis", r->axes[i].name, "");
    strbuf_add(out, ",effect,width,height,frames,state,message");
    for (size_t t = 0; t < COUNT_OF(time_columns); t++)
        for (size_t i = 0; i < c->times[t].count; i++) {
            static const char *const of[] = {".median", ".p5", ".p95", ".count"};
            for (size_t k = 0; k < COUNT_OF(of); k++)
                add_heading(out, time_columns[t].prefix, c->times[t].items[i], of[k]);
        }
    strbuf_add(out, ",memory.device,memory.reserved,memory.host,error.psnr,error.ssim,error.flip");
    for (size_t n = 0; n < COUNT_OF(number_columns); n++)
        for (size_t i = 0; i < c->numbers[n].count; i++)
            add_heading(out, number_columns[n].prefix, c->numbers[n].items[i], "");
    strbuf_add(out, ",device\n");
}

static void add_times(const columns *c, const bench_row *row, strbuf *out) {
    for (size_t t = 0; t < COUNT_OF(time_columns); t++)
        for (size_t i = 0; i < c->times[t].count; i++) {
            const bench_times *all = times_of(row, time_columns[t].at);
            const bench_figure *f = bench_get_time(all, c->times[t].items[i]);
            if (!f) {
                strbuf_add(out, ",,,,");
                continue;
            }
            add_number(out, f->median);
            add_number(out, f->p5);
            add_number(out, f->p95);
            strbuf_add(out, ",%zu", f->count);
        }
}

static void add_numbers(const columns *c, const bench_row *row, strbuf *out) {
    for (size_t n = 0; n < COUNT_OF(number_columns); n++)
        for (size_t i = 0; i < c->numbers[n].count; i++) {
            const bench_numbers *all = numbers_of(row, number_columns[n].at);
            size_t k = 0;
            while (k < all->count && strcmp(all->items[k].name, c->numbers[n].items[i]) != 0) k++;
            if (k < all->count)
                add_number(out, all->items[k].value);
            else
                strbuf_add(out, ",");
        }
}

static void add_row(const bench_results *r, const columns *c, const bench_row *row, strbuf *out) {
    strbuf_add(out, "%zu", row->index);
    add_text(out, row->label);
    for (size_t i = 0; i < r->axis_count; i++) {
        const char *value = bench_axis_value(row, r->axes[i].name);
        add_text(out, value ? value : "");
    }
    add_text(out, row->effect);
    strbuf_add(out, ",%" PRIu32 ",%" PRIu32 ",%zu,%s", row->width, row->height, row->frame_count,
               bench_state_name(row->state));
    add_text(out, row->message);
    add_times(c, row, out);
    strbuf_add(out, ",%" PRIu64 ",%" PRIu64 ",%" PRIu64, row->device_bytes, row->reserved_bytes,
               row->host_bytes);
    if (row->compared) {
        add_number(out, row->psnr);
        add_number(out, row->ssim);
        add_number(out, row->flip);
    } else {
        strbuf_add(out, ",,,");
    }
    add_numbers(c, row, out);
    add_text(out, row->device ? row->device : "");
    strbuf_add(out, "\n");
}

bool bench_write_csv(const bench_results *r, const char *folder) {
    char path[PATH_CAP];
    if (!path_join(path, folder, "results.csv")) return false;
    columns c;
    for (size_t t = 0; t < COUNT_OF(time_columns); t++)
        c.times[t] = time_names(r, time_columns[t].at);
    for (size_t n = 0; n < COUNT_OF(number_columns); n++)
        c.numbers[n] = number_names(r, number_columns[n].at);
    strbuf out = {0};
    add_headings(r, &c, &out);
    for (size_t i = 0; i < r->row_count; i++) add_row(r, &c, &r->rows[i], &out);
    bool done = file_write_inside(folder, path, out.text, out.length);
    strbuf_free(&out);
    for (size_t t = 0; t < COUNT_OF(time_columns); t++) mem_free(c.times[t].items);
    for (size_t n = 0; n < COUNT_OF(number_columns); n++) mem_free(c.numbers[n].items);
    return done;
}
