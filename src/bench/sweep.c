// Measures a sweep, from its file to its results.
#include "bench/sweep.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include <string.h>

enum { EFFECT_MAX = 16 << 20 };

// ---- from the sweep's words to ours -------------------------------------------------------------

static bench_settings copy_pairs(const sweep_pair *pairs, size_t count, arena *memory) {
    bench_settings s = {arena_alloc(memory, count * sizeof *s.items), count};
    for (size_t i = 0; i < count; i++) s.items[i] = (roil_setting){pairs[i].name, pairs[i].text};
    return s;
}

static bench_row plan_row(const sweep_row *from, size_t index, arena *memory) {
    return (bench_row){
        .index = index,
        .label = from->label,
        .axes = copy_pairs(from->axes, from->axis_count, memory),
        .effect = from->effect,
        .inside = from->inside,
        .width = from->width,
        .height = from->height,
        .frames = from->frames,
        .frame_count = from->frame_count,
        .warmup = from->warmup,
        .repeats = from->repeats,
        .limit = from->limit,
        .settings = copy_pairs(from->settings, from->setting_count, memory),
        .message = "",
        .published = {from->published, from->published_count},
    };
}

static bench_job plan_job(const sweep *s, const sweep_row *from, const bench_row *reference) {
    static const bench_measure measures[] = {BENCH_FRAMES, BENCH_RELOAD, BENCH_START};
    return (bench_job){
        .measure = measures[s->measure],
        .reference = reference,
        .samples = s->samples,
        .first = from->first,
        .last = from->last,
        .edits = from->edits,
        .edit_count = from->edit_count,
        .command = from->command,
        .empty_cache = from->empty_cache,
    };
}

// ---- what is measured, as a hash ----------------------------------------------------------------

// Hashes the content of the effect's file, so that rows from before and after an edit are not
// mixed.
static hash128 add_effect(hash128 h, const sweep_row *row) {
    void *data;
    size_t size;
    h = hash_add_text(h, path_name(row->effect));
    if (!file_read_inside(row->inside, row->effect, EFFECT_MAX, &data, &size)) return h;
    h = hash_combine(h, hash_bytes(data, size));
    mem_free(data);
    return h;
}

static hash128 add_row(hash128 h, const sweep_row *row) {
    double numbers[] = {row->width,  row->height,  row->first, row->last,
                        row->warmup, row->repeats, row->limit, row->empty_cache};
    h = hash_combine(h, hash_bytes(numbers, sizeof numbers));
    h = hash_combine(h, hash_bytes(row->frames, row->frame_count * sizeof *row->frames));
    h = hash_add_text(hash_add_text(h, row->label), row->command);
    for (size_t i = 0; i < row->setting_count; i++)
        h = hash_add_text(hash_add_text(h, row->settings[i].name), row->settings[i].text);
    for (size_t i = 0; i < row->edit_count; i++) h = hash_add_text(h, row->edits[i]);
    return h;
}

static const char *content_of(const sweep *s, arena *memory) {
    double numbers[] = {s->measure, s->samples, s->compared, s->settle, s->counters};
    hash128 h =
        hash_combine(hash_bytes(s->name, strlen(s->name)), hash_bytes(numbers, sizeof numbers));
    for (size_t i = 0; i < s->row_count + s->reference_count; i++) {
        const sweep_row *row = i < s->row_count ? &s->rows[i] : &s->references[i - s->row_count];
        const sweep_row *before = i > 0 && i < s->row_count ? row - 1 : NULL;
        if (!before || strcmp(before->effect, row->effect) != 0) h = add_effect(h, row);
        h = add_row(h, row);
    }
    char hex[33];
    hash_to_hex(h, hex);
    return arena_string(memory, hex);
}

// ---- results ------------------------------------------------------------------------------------

static void describe_reference(bench_results *r, const sweep *s) {
    r->has_reference = s->reference_count > 0;
    r->reference.traced = s->samples > 0;
    r->reference.samples = s->samples;
    r->reference.settings.items =
        arena_alloc(&r->memory, s->reference_setting_count * sizeof(roil_setting));
    for (size_t i = 0; i < s->reference_setting_count; i++)
        r->reference.settings.items[r->reference.settings.count++] =
            (roil_setting){arena_string(&r->memory, s->reference[i].name),
                           arena_string(&r->memory, s->reference[i].text)};
}

static void results_describe(bench_results *r, const sweep *s, roil *device) {
    *r = (bench_results){0};
    r->version = arena_string(&r->memory, roil_version());
    r->commit = bench_commit(roil_home(device), &r->memory);
    r->sweep = arena_string(&r->memory, s->name);
    r->title = arena_string(&r->memory, s->title);
    r->file = arena_string(&r->memory, s->file);
    r->content = content_of(s, &r->memory);
    const char **notes = arena_alloc(&r->memory, s->note_count * sizeof *notes);
    for (size_t i = 0; i < s->note_count; i++) notes[i] = arena_string(&r->memory, s->notes[i]);
    r->notes = notes;
    r->note_count = s->note_count;
    r->device = arena_string(&r->memory, roil_device_name(device));
    r->driver = arena_string(&r->memory, roil_device_driver(device));
    bench_describe_machine(r);
    r->axes = arena_alloc(&r->memory, s->axis_count * sizeof *r->axes);
    for (size_t i = 0; i < s->axis_count; i++) bench_add_axis(r, &s->axes[i]);
    describe_reference(r, s);
}

// ---- running ------------------------------------------------------------------------------------

typedef struct running {
    const bench_order *order;
    const sweep *sweep;
    bench_session *session;
    bench_results *results;
    bench_row *references;
    bool *chosen;
} running;

static bool is_planned(const running *u, size_t i) {
    return u->chosen[i] && !bench_find(u->results, i);
}

static bool run_row(running *u, size_t i) {
    const sweep_row *from = &u->sweep->rows[i];
    arena memory = {0};
    bench_row row = plan_row(from, i, &memory);
    const bench_row *reference =
        from->reference == SWEEP_NO_REFERENCE ? NULL : &u->references[from->reference];
    bench_job job = plan_job(u->sweep, from, reference);
    bool done = bench_measure_row(u->session, &job, &row, &memory);
    if (row.state != BENCH_PLANNED) { // a device that is lost leaves a row
        bench_add(u->results, &row);
        char *why = done ? NULL : mem_copy(err_get(), strlen(err_get()) + 1);
        bool written = bench_write(u->results, u->order->folder);
        if (why) err_set("%s", why);
        mem_free(why);
        done = done && written;
    }
    arena_free(&memory);
    return done;
}

static bool run_rows(running *u) {
    const bench_watcher *w = &u->order->watcher;
    size_t total = 0, count = 0;
    for (size_t i = 0; i < u->sweep->row_count; i++) total += is_planned(u, i);
    if (w->begin) w->begin(w->user, u->sweep, total);
    for (size_t i = 0; i < u->sweep->row_count; i++) {
        if (!is_planned(u, i)) continue;
        bench_row next = {.index = i, .label = u->sweep->rows[i].label};
        if (w->row) w->row(w->user, &next, count);
        if (!run_row(u, i)) return false;
        count++;
        if (w->result) w->result(w->user, bench_find(u->results, i), count);
    }
    return true;
}

static bench_session *open_session(const bench_order *order, const sweep *s) {
    return bench_open(&(bench_session_desc){
        .device = order->device,
        .folder = order->folder,
        .keep = order->resume,
        .settle = s->settle,
        .counters = s->counters,
        .compared = s->compared,
        .own_cache = s->measure == SWEEP_RELOAD,
        .stopped = order->watcher.stopped,
        .steps = order->watcher.steps,
        .user = order->watcher.user,
    });
}

static bool same_names(const sweep_row *a, const sweep_row *b) {
    bool same = a->setting_count == b->setting_count;
    for (size_t i = 0; same && i < a->setting_count; i++)
        same = strcmp(a->settings[i].name, b->settings[i].name) == 0;
    return same;
}

// Reports a name that no row's effect has before anything is measured. A name that is wrong in some
// rows is only found when these are measured.
static bool check_names(const sweep *s, const bool *chosen) {
    roil *r = roil_create(&(roil_desc){.no_device = true});
    arena memory = {0};
    bool good = false;
    const sweep_row *last = NULL;
    for (size_t i = 0; r && !good && i < s->row_count; i++) {
        const sweep_row *row = &s->rows[i];
        if (!chosen[i] || (last && last->effect == row->effect && same_names(last, row))) continue;
        last = row;
        bench_settings all = copy_pairs(row->settings, row->setting_count, &memory);
        roil_effect *e = roil_load_inside(r, row->inside, row->effect, all.items, all.count);
        good = e != NULL;
        roil_unload(e);
    }
    arena_free(&memory);
    roil_destroy(r);
    return good;
}

bool bench_read_sweep(const bench_order *order, arena *memory, sweep *out) {
    roil *r = roil_create(&(roil_desc){.no_device = true, .memory = order->memory});
    if (!r) return false;
    sweep_options options = order->options;
    options.home = roil_home(r);
    bool done = sweep_read(order->file, &options, memory, out);
    roil_destroy(r);
    return done;
}

bool bench_run(const bench_order *order, bench_results *out) {
    arena memory = {0};
    sweep s;
    *out = (bench_results){0};
    running u = {.order = order, .sweep = &s, .results = out};
    bool done = bench_read_sweep(order, &memory, &s);
    if (done) u.chosen = bench_choose(&s, &order->choice);
    if (u.chosen && check_names(&s, u.chosen)) u.session = open_session(order, &s);
    if (u.session) {
        u.references = arena_alloc(&memory, s.reference_count * sizeof *u.references);
        for (size_t i = 0; i < s.reference_count; i++)
            u.references[i] = plan_row(&s.references[i], i, &memory);
        results_describe(out, &s, bench_roil(u.session));
        done = (!order->resume ||
                bench_take_earlier(out, order->folder,
                                   "another sweep, or of other options or effects; measure again "
                                   "without --resume, or into another folder",
                                   true)) &&
               bench_write(out, order->folder) && run_rows(&u);
    } else {
        done = false;
    }
    bench_close(u.session);
    mem_free(u.chosen);
    arena_free(&memory);
    return done;
}
