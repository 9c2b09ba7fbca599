// Results in memory: rows are copied, so that one arena holds all of them.
#include "bench/results.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include <assert.h>
#include <string.h>

void bench_results_free(bench_results *r) {
    mem_free(r->rows);
    arena_free(&r->memory);
    *r = (bench_results){0};
}

bench_row *bench_find(const bench_results *r, size_t index) {
    for (size_t i = 0; i < r->row_count; i++)
        if (r->rows[i].index == index) return &r->rows[i];
    return NULL;
}

static bench_settings copy_settings(bench_settings from, arena *memory) {
    bench_settings to = {arena_alloc(memory, from.count * sizeof *to.items), from.count};
    for (size_t i = 0; i < from.count; i++)
        to.items[i] = (roil_setting){arena_string(memory, from.items[i].name),
                                     arena_string(memory, from.items[i].value)};
    return to;
}

static bench_numbers copy_numbers(bench_numbers from, arena *memory) {
    bench_numbers to = {arena_alloc(memory, from.count * sizeof *to.items), from.count};
    for (size_t i = 0; i < from.count; i++)
        to.items[i] = (sweep_number){arena_string(memory, from.items[i].name), from.items[i].value};
    return to;
}

static bench_times copy_times(bench_times from, arena *memory) {
    bench_times to = {arena_alloc(memory, from.count * sizeof *to.items), from.count};
    for (size_t i = 0; i < from.count; i++) {
        const bench_figure *ms = &from.items[i].ms;
        to.items[i] = (bench_time){arena_string(memory, from.items[i].name), *ms};
        if (ms->values)
            to.items[i].ms.values = arena_copy(memory, ms->values, ms->count * sizeof *ms->values);
    }
    return to;
}

static bench_row copy_row(const bench_row *row, arena *memory) {
    bench_row to = *row;
    to.label = arena_string(memory, row->label);
    to.effect = arena_string(memory, row->effect);
    to.inside = NULL; // these are not measured any more
    to.message = arena_string(memory, row->message ? row->message : "");
    to.device = row->device ? arena_string(memory, row->device) : NULL;
    to.inputs = row->inputs ? arena_string(memory, row->inputs) : NULL;
    to.thumbnail = row->thumbnail ? arena_string(memory, row->thumbnail) : NULL;
    to.frames = arena_copy(memory, row->frames, row->frame_count * sizeof *row->frames);
    to.axes = copy_settings(row->axes, memory);
    to.settings = copy_settings(row->settings, memory);
    to.gpu = copy_times(row->gpu, memory);
    to.cpu = copy_times(row->cpu, memory);
    to.times = copy_times(row->times, memory);
    to.counters = copy_numbers(row->counters, memory);
    to.published = copy_numbers(row->published, memory);
    return to;
}

void bench_add(bench_results *r, const bench_row *row) {
    assert(row->state != BENCH_PLANNED);
    bench_row copy = copy_row(row, &r->memory);
    bench_row *old = bench_find(r, row->index);
    if (old) {
        *old = copy;
        return;
    }
    MEM_RESERVE(r->rows, r->row_count + 1, r->row_capacity);
    size_t at = r->row_count++;
    for (; at > 0 && r->rows[at - 1].index > row->index; at--) r->rows[at] = r->rows[at - 1];
    r->rows[at] = copy;
}

void bench_add_axis(bench_results *r, const sweep_axis *axis) {
    const char **values = arena_alloc(&r->memory, axis->value_count * sizeof *values);
    for (size_t i = 0; i < axis->value_count; i++)
        values[i] = arena_string(&r->memory, axis->values[i]);
    r->axes[r->axis_count++] =
        (sweep_axis){arena_string(&r->memory, axis->name), arena_string(&r->memory, axis->label),
                     values, axis->value_count};
}

bool bench_take_earlier(bench_results *r, const char *folder, const char *other, bool exactly) {
    bench_results old;
    char path[PATH_CAP];
    if (!path_join(path, folder, "results.json")) return false;
    if (!file_exists(path)) return true;
    if (!bench_read(folder, &old)) return false;
    bool same = true;
    if (strcmp(old.content, r->content) != 0)
        same = err_set("%s is of %s", path, other);
    else if (strcmp(old.device, r->device) != 0 || (exactly && strcmp(old.driver, r->driver) != 0))
        same = err_set("%s was measured on %s (%s), this is %s (%s)", path, old.device, old.driver,
                       r->device, r->driver);
    else if (exactly && strcmp(old.commit, r->commit) != 0)
        same = err_set("%s was measured at commit %s, this is %s", path, old.commit, r->commit);
    for (size_t i = 0; same && i < old.row_count; i++) bench_add(r, &old.rows[i]);
    if (same) r->date = arena_string(&r->memory, old.date);
    bench_results_free(&old);
    return same;
}

const bench_figure *bench_get_time(const bench_times *t, const char *name) {
    for (size_t i = 0; i < t->count; i++)
        if (strcmp(t->items[i].name, name) == 0) return &t->items[i].ms;
    return NULL;
}

const bench_time *bench_main_time(const bench_row *row) {
    for (size_t i = 0; i < row->gpu.count; i++)
        if (strcmp(row->gpu.items[i].name, "all") == 0) return &row->gpu.items[i];
    return row->times.count ? &row->times.items[0] : NULL;
}

const char *bench_axis_value(const bench_row *row, const char *name) {
    for (size_t i = 0; i < row->axes.count; i++)
        if (strcmp(row->axes.items[i].name, name) == 0) return row->axes.items[i].value;
    return NULL;
}

const char *bench_state_name(bench_state state) {
    static const char *const names[] = {"planned", "done", "failed", "limit"};
    return names[state];
}
