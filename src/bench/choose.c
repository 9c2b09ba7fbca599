// Chooses which rows of a sweep are measured.
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "bench/sweep.h"
#include <fnmatch.h>
#include <string.h>

static const sweep_axis *find_axis(const sweep *s, const char *name) {
    const char *known[2 * SWEEP_MAX_AXES];
    for (size_t i = 0; i < s->axis_count; i++) {
        const sweep_axis *a = &s->axes[i];
        if (strcmp(a->name, name) == 0 || strcmp(a->label, name) == 0) return a;
        known[2 * i] = a->name;
        known[2 * i + 1] = a->label;
    }
    strbuf list = {0};
    strbuf_add(&list, "accepted: ");
    for (size_t i = 0; i < s->axis_count; i++)
        strbuf_add(&list, "%s%s", i ? ", " : "", s->axes[i].name);
    words_refuse(known, 2 * s->axis_count, name, strbuf_text(&list), "%s has no axis '%.64s'",
                 s->file, name);
    strbuf_free(&list);
    return NULL;
}

static bool has_value(const sweep *s, const sweep_axis *axis, const char *value) {
    if (words_find(axis->values, axis->value_count, value) >= 0) return true;
    strbuf list = {0};
    words_print(axis->values, axis->value_count, &list);
    err_set("%s: axis '%s' has no value '%.64s'; accepted: %s", s->file, axis->name, value,
            strbuf_text(&list));
    strbuf_free(&list);
    return false;
}

static const char *value_of(const sweep_row *row, const char *axis) {
    for (size_t i = 0; i < row->axis_count; i++)
        if (strcmp(row->axes[i].name, axis) == 0) return row->axes[i].text;
    return "";
}

// Returns whether the row has one of the named values of every named axis.
static bool is_among(const sweep_row *row, const bench_choice *c, const char *const *axes) {
    for (size_t i = 0; i < c->only_count; i++) {
        bool found = false;
        for (size_t k = 0; k < c->only_count; k++)
            found = found ||
                    (axes[k] == axes[i] && strcmp(value_of(row, axes[k]), c->only[k].value) == 0);
        if (!found) return false;
    }
    return true;
}

static bool find_axes(const sweep *s, const bench_choice *c, const char **axes) {
    for (size_t i = 0; i < c->only_count; i++) {
        const sweep_axis *axis = find_axis(s, c->only[i].name);
        if (!axis || !has_value(s, axis, c->only[i].value)) return false;
        axes[i] = axis->name;
    }
    return true;
}

bool *bench_choose(const sweep *s, const bench_choice *c) {
    bool *chosen = mem_alloc(s->row_count * sizeof *chosen);
    const char **axes = mem_alloc(c->only_count * sizeof *axes);
    bool known = find_axes(s, c, axes);
    size_t count = 0, left = 0;
    for (size_t i = 0; known && i < s->row_count; i++) {
        const sweep_row *row = &s->rows[i];
        chosen[i] = is_among(row, c, axes) && (!c->rows || fnmatch(c->rows, row->label, 0) == 0);
        if (!chosen[i]) continue;
        // Every n-th of those that are left, so that each shard has cheap and dear ones.
        if (c->shards) chosen[i] = left % c->shards == c->shard - 1;
        left++;
        count += chosen[i];
    }
    if (known && !count) {
        if (c->rows)
            err_set("%s: no row is like '%.128s'; --list shows them", s->file, c->rows);
        else
            err_set("%s: no row is left to be measured", s->file);
    }
    mem_free(axes);
    if (count) return chosen;
    mem_free(chosen);
    return NULL;
}
