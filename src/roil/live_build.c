// The builder: loads the whole effect anew whenever something changed, while the old one is still
// drawn. Costly results are shared by all loads: compiled shaders and content of files, as long as
// the files are the same.
#include "base/clock.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "roil/live.h"
#include "script/script.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

static const double PATIENCE = 10; // seconds after which a build is left behind when there is news
static const double EMPTY_SECONDS = 0.5; // an empty file is being written, unless it stays so

// ---- files ------------------------------------------------------------------------------------

typedef struct file_set {
    char **paths; // sorted, each once
    size_t count, capacity;
} file_set;

static int by_name(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void add_files(file_set *set, const char *const *paths, size_t count) {
    MEM_RESERVE(set->paths, set->count + count, set->capacity);
    for (size_t i = 0; i < count; i++)
        set->paths[set->count++] = mem_copy(paths[i], strlen(paths[i]) + 1);
    if (set->count) qsort(set->paths, set->count, sizeof *set->paths, by_name);
    size_t kept = 0;
    for (size_t i = 0; i < set->count; i++) {
        if (kept && strcmp(set->paths[i], set->paths[kept - 1]) == 0)
            mem_free(set->paths[i]);
        else
            set->paths[kept++] = set->paths[i];
    }
    set->count = kept;
}

void live_free_names(char **names, size_t count) {
    for (size_t i = 0; i < count; i++) mem_free(names[i]);
    mem_free(names);
}

static bool is_watched(const roil_live *l, char *path) {
    return l->watched_count &&
           bsearch(&path, l->watched, l->watched_count, sizeof path, by_name) != NULL;
}

// Returns whether a file that was not watched yet may have changed after it was read.
static bool was_missed(const roil_live *l, const file_set *set, int64_t begin) {
    for (size_t i = 0; i < set->count; i++) {
        if (!is_watched(l, set->paths[i]) && file_changed_ns(set->paths[i]) >= begin) return true;
    }
    return false;
}

// Watches the files of this build, and after a failure those of the last good build too, since
// restoring them may repair the effect. `begin` is file_clock_ns() when the build began.
static void follow_files(roil_live *l, file_set *set, bool good, int64_t begin) {
    if (good) {
        live_free_names(l->good, l->good_count);
        file_set copy = {0};
        add_files(&copy, (const char *const *)set->paths, set->count);
        l->good = copy.paths;
        l->good_count = copy.count;
    } else {
        add_files(set, (const char *const *)l->good, l->good_count);
    }
    if (!watch_set(l->watch, (const char *const *)set->paths, set->count))
        log_write(LOG_WARNING, "%s", err_get());
    if (was_missed(l, set, begin)) live_want(l);
    live_free_names(l->watched, l->watched_count);
    l->watched = set->paths;
    l->watched_count = set->count;
}

// ---- presets ----------------------------------------------------------------------------------

static bool read_presets(const roil_live *l, roil_preset **out, file_set *files) {
    for (size_t i = 0; i < l->preset_count; i++) {
        char path[PATH_CAP];
        const char *file = path;
        if (!roil_preset_path(path, l->origin.file, l->presets[i])) return false;
        add_files(files, &file, 1);
        out[i] = roil_read_preset(l->owner, l->origin.file, l->presets[i]);
        if (!out[i]) return false;
    }
    return true;
}

// Replaces the settings of the presets by what their files say now. Settings from elsewhere win.
static bool apply_presets(roil_live *l, file_set *files) {
    roil_preset **read = mem_alloc(l->preset_count * sizeof *read);
    bool done = read_presets(l, read, files);
    pthread_mutex_lock(&l->lock);
    if (done) live_drop_preset_settings(l);
    for (size_t i = 0; done && i < l->preset_count; i++)
        for (size_t k = 0; k < read[i]->count; k++)
            live_add_preset_setting(l, &read[i]->settings[k]);
    pthread_mutex_unlock(&l->lock);
    for (size_t i = 0; i < l->preset_count; i++) roil_free_preset(read[i]);
    mem_free(read);
    return done;
}

// ---- one build --------------------------------------------------------------------------------

typedef struct order { // what a build goes by
    arena memory;
    effect_setting *settings;
    size_t setting_count;
    double frame;
    bool framed;
} order;

static order take_order(roil_live *l) {
    pthread_mutex_lock(&l->lock);
    order o = {.frame = l->frame, .framed = l->framed};
    o.settings = arena_alloc(&o.memory, l->setting_count * sizeof *o.settings);
    for (size_t i = 0; i < l->setting_count; i++) {
        const live_setting *s = &l->settings[i];
        o.settings[o.setting_count++] = (effect_setting){
            .name = arena_string(&o.memory, s->name),
            .text = arena_string(&o.memory, s->text),
            .initial = s->initial ? arena_string(&o.memory, s->initial) : NULL,
        };
    }
    pthread_mutex_unlock(&l->lock);
    return o;
}

static effect *builder_load(roil_live *l, const order *o, file_set *files) {
    const roil *r = l->owner;
    const char *const *read;
    roil_assets assets;
    effect *e = NULL;
    if (roil_find_assets(r, &l->origin, &assets)) {
        effect_desc desc = roil_effect_desc(r, &l->origin, &assets, o->settings, o->setting_count);
        desc.library = l->library;
        desc.contents = l->contents;
        e = effect_create(&desc);
    } else if (assets.project) {
        add_files(files, &assets.project, 1);
    }
    arena_free(&assets.memory);
    bool done = e && script_load(e, r->scripts) && effect_check_settings(e) && effect_compile(e) &&
                effect_rehearse(e, o->framed ? o->frame : effect_get_facts(e)->first);
    if (e) add_files(files, read, effect_files(e, &read));
    if (done) return e;
    effect_destroy(e);
    return NULL;
}

static live_result builder_build(roil_live *l, double since, file_set *files) {
    live_result result = {.since = since};
    mem_enter();
    if (apply_presets(l, files)) {
        order o = take_order(l);
        result.effect = builder_load(l, &o, files);
        arena_free(&o.memory);
    }
    if (result.effect && mem_is_short()) {
        effect_destroy(result.effect);
        result.effect = NULL;
    }
    mem_leave(true);
    if (!result.effect) result.message = live_explain(err_get(), l->owner->scripts);
    return result;
}

void live_free_result(live_result *result) {
    effect_destroy(result->effect);
    mem_free(result->message);
    *result = (live_result){0};
}

// ---- the thread -------------------------------------------------------------------------------

void live_note(roil_live *l, double when) {
    pthread_mutex_lock(&l->lock);
    if (!l->wanted) l->since = when;
    l->wanted = true;
    l->latest = when;
    pthread_mutex_unlock(&l->lock);
}

// Abandons a build that hangs, and starts another builder, so that later builds can run.
static void leave_stuck(roil_live *l) {
    live_builder *b = l->builder;
    if (!b || !b->busy || l->ending || clock_seconds() < b->begun + PATIENCE) return;
    time_limit_stop(&b->time);
    if (!live_start(l)) {
        log_write(LOG_WARNING, "%s", err_get());
        return;
    }
    b->left = true;
    l->left_reported = false;
    l->left++;
    pthread_detach(b->thread);
}

void live_wake(roil_live *l) {
    pthread_mutex_lock(&l->lock);
    leave_stuck(l);
    pthread_cond_signal(&l->news);
    pthread_mutex_unlock(&l->lock);
}

void live_want(roil_live *l) {
    live_note(l, clock_seconds());
    live_wake(l);
}

// Waits while the effect's file is empty, since an editor may be between truncating and writing it.
// True when it waited, or when there is more news.
static bool wait_for_content(roil_live *l) {
    struct stat info;
    double end = l->latest + EMPTY_SECONDS;
    if (clock_seconds() >= end || stat(l->origin.file, &info) != 0 || info.st_size > 0)
        return false;
    struct timespec until = {.tv_sec = (time_t)end};
    until.tv_nsec = (long)((end - (double)until.tv_sec) * 1e9);
    pthread_cond_timedwait(&l->news, &l->lock, &until);
    return true;
}

static void hand_over(roil_live *l, live_result result) {
    pthread_mutex_lock(&l->lock);
    live_result old = l->result;
    l->result = result;
    l->ready = true;
    pthread_mutex_unlock(&l->lock);
    live_free_result(&old); // nobody took it: the newer one wins
    if (l->wake) l->wake(l->user);
}

// Runs one build. Called with the lock held, which is released during the build itself. False: the
// builder was abandoned meanwhile.
static bool build_next(live_builder *b) {
    roil_live *l = b->live;
    l->wanted = false;
    l->building = b->busy = true;
    b->time = roil_time_limit(l->owner);
    b->begun = clock_seconds();
    double since = l->since;
    pthread_mutex_unlock(&l->lock);

    file_set files = {0};
    int64_t begin = file_clock_ns();
    time_limit *before = time_limit_enter(&b->time);
    live_result result = builder_build(l, since, &files);
    time_limit_leave(before);
    bool good = result.effect != NULL;

    pthread_mutex_lock(&l->lock);
    b->busy = false;
    bool left = b->left;
    pthread_mutex_unlock(&l->lock);
    if (left) {
        live_free_result(&result);
        live_free_names(files.paths, files.count);
    } else {
        hand_over(l, result);
        follow_files(l, &files, good, begin);
    }
    pthread_mutex_lock(&l->lock);
    return !left;
}

static void *builder_run(void *user) {
    live_builder *b = user;
    roil_live *l = b->live;
    pthread_mutex_lock(&l->lock);
    bool mine = true;
    while (mine && !l->ending) {
        if (!l->wanted) {
            l->building = false;
            pthread_cond_broadcast(&l->idle);
            pthread_cond_wait(&l->news, &l->lock);
        } else if (!wait_for_content(l)) {
            mine = build_next(b);
        }
    }
    b->ended = true;
    if (b->left) l->left--;
    pthread_cond_broadcast(&l->idle);
    if (b->left) mem_free(b);
    pthread_mutex_unlock(&l->lock);
    return NULL;
}

bool live_start(roil_live *l) {
    live_builder *b = mem_alloc(sizeof *b);
    live_builder *before = l->builder;
    b->live = l;
    l->builder = b;
    int failed = pthread_create(&b->thread, NULL, builder_run, b);
    if (!failed) return true;
    l->builder = before;
    mem_free(b);
    return err_set("%s: no thread can be made that builds it: %s", l->origin.file,
                   strerror(failed));
}
