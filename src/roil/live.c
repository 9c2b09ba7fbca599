// Effects that follow their files: the functions that the caller's thread runs.
#include "roil/live.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include <string.h>

static const double LAST_SECONDS = 1; // that a builder is waited for in the end

static char *copy_text(const char *text) {
    return mem_copy(text, strlen(text) + 1);
}

// ---- settings ---------------------------------------------------------------------------------

static live_setting *find_setting(roil_live *l, const char *name) {
    for (size_t i = 0; i < l->setting_count; i++)
        if (strcmp(l->settings[i].name, name) == 0) return &l->settings[i];
    return NULL;
}

static void remove_setting(roil_live *l, live_setting *s) {
    mem_free(s->name);
    mem_free(s->text);
    mem_free(s->initial);
    size_t index = (size_t)(s - l->settings);
    l->setting_count--;
    memmove(s, s + 1, (l->setting_count - index) * sizeof *s);
}

static void add_setting(roil_live *l, const roil_setting *s, const char *initial, bool preset) {
    live_setting *old = find_setting(l, s->name);
    if (old) remove_setting(l, old);
    *MEM_ADD(l->settings, l->setting_count, l->setting_capacity) = (live_setting){
        copy_text(s->name), copy_text(s->value), initial ? copy_text(initial) : NULL, preset};
}

static void put_setting(roil_live *l, const char *name, const char *text, const char *initial) {
    pthread_mutex_lock(&l->lock);
    add_setting(l, &(roil_setting){name, text}, initial, false);
    pthread_mutex_unlock(&l->lock);
}

void live_drop_preset_settings(roil_live *l) {
    for (size_t i = l->setting_count; i-- > 0;)
        if (l->settings[i].preset) remove_setting(l, &l->settings[i]);
}

void live_add_preset_setting(roil_live *l, const roil_setting *s) {
    const live_setting *there = find_setting(l, s->name);
    if (!there || there->preset) add_setting(l, s, NULL, true);
}

// Drops a setting, so that the script's value `initial` holds again. Where a preset sets another
// value, the script's value must become a setting of its own.
static void drop_setting(roil_live *l, const char *name, const char *initial) {
    pthread_mutex_lock(&l->lock);
    live_setting *old = find_setting(l, name);
    if (old && old->preset && initial)
        add_setting(l, &(roil_setting){name, initial}, initial, false);
    else if (old)
        remove_setting(l, old);
    pthread_mutex_unlock(&l->lock);
}

// Returns whether only a load can set the control: an option, a resolution, a place of a grid.
static bool is_fixed(const effect_control *c) {
    return c->kind == EFFECT_CONTROL_OPTION || c->kind == EFFECT_CONTROL_SCALE ||
           c->kind == EFFECT_CONTROL_LOADED;
}

static bool is_structural(const effect *e, const effect_control *c) {
    return is_fixed(c) || (c->kind == EFFECT_CONTROL_FIELD && effect_has_tiles(e)) ||
           (c->kind == EFFECT_CONTROL_PARAM && effect_get_param(e, c->index)->structural);
}

bool roil_live_set(roil_live *l, const char *name, const char *value) {
    mem_enter();
    if (!l->effect) return mem_leave(err_set("'%s' cannot be set: no effect is loaded", name));
    effect *e = l->effect->effect;
    const effect_control *c = effect_find_control(e, name);
    if (!c) return mem_leave(false);
    float parsed[4]; // what no load can take is refused at once
    bool done =
        is_fixed(c) ? value_parse(c->desc, c->name, value, parsed) : effect_set(e, name, value);
    if (!done) return mem_leave(false);
    if (strcmp(value, c->initial) == 0)
        drop_setting(l, name, c->initial);
    else
        put_setting(l, name, value, c->initial);
    if (is_structural(e, c)) live_want(l);
    return mem_leave(true);
}

static bool reset(roil_live *l, const char *name) {
    if (!name) {
        bool done = true;
        for (size_t i = l->setting_count;
             i-- > 0 && done;) { // each is removed, or stays as the last
            char *each = copy_text(l->settings[i].name);
            done = reset(l, each);
            mem_free(each);
        }
        return done;
    }
    if (!l->effect) return err_set("'%s' cannot be reset: no effect is loaded", name);
    effect *e = l->effect->effect;
    const effect_control *c = effect_find_control(e, name);
    drop_setting(l, name, c ? c->initial : NULL);
    if (!c) return false;
    if (is_structural(e, c)) live_want(l);
    return is_fixed(c) || effect_reset(e, name);
}

bool roil_live_reset(roil_live *l, const char *name) {
    return MEM_CALL(reset(l, name));
}

char *roil_live_setting(roil_live *l, const char *name) {
    mem_enter();
    pthread_mutex_lock(&l->lock);
    const live_setting *s = find_setting(l, name);
    char *text = s ? copy_text(s->text) : NULL;
    pthread_mutex_unlock(&l->lock);
    return roil_leave_text(text);
}

static bool holds(const live_setting *s, const effect_control *c) {
    return !s->initial || strcmp(s->initial, c->initial) == 0;
}

// Applies the settings of now to a new effect, whose load may have begun before some of them.
static void apply_settings(roil_live *l, effect *e) {
    for (size_t i = 0; i < effect_control_count(e); i++) {
        const effect_control *c = effect_get_control(e, i);
        const live_setting *s = find_setting(l, c->name);
        if (is_fixed(c)) continue; // another load is on its way then
        if (s && holds(s, c) && (!c->moved || strcmp(effect_control_setting(c), s->text) != 0))
            effect_set(e, c->name, s->text);
        else if ((!s || !holds(s, c)) && c->moved)
            effect_reset(e, c->name);
    }
}

// Drops a user's settings whose control is gone, or whose value in the script has changed.
static void forget_stale(roil_live *l, effect *e) {
    pthread_mutex_lock(&l->lock);
    for (size_t i = l->setting_count; i-- > 0;) {
        live_setting *s = &l->settings[i];
        const effect_control *c = effect_find_control(e, s->name);
        if (s->initial && !(c && holds(s, c))) remove_setting(l, s);
    }
    pthread_mutex_unlock(&l->lock);
}

// ---- taking over ------------------------------------------------------------------------------

static bool prepare_effect(roil_effect *e, const roil_effect *old) {
    if (!old) return effect_allocate(e->effect, e->width, e->height);
    for (size_t i = 0; i < old->kept_count; i++) roil_keep(e, old->kept[i]); // if it is there still
    roil_apply_kept(e);
    e->frame = old->frame; // its picture is shown until the next one is drawn
    return effect_adopt(e->effect, old->effect, e->width, e->height);
}

static bool take_over(roil_live *l, effect *made, uint32_t width, uint32_t height) {
    roil_effect *e = mem_alloc(sizeof *e);
    *e = (roil_effect){.owner = l->owner, .effect = made, .width = width, .height = height};
    if (!prepare_effect(e, l->effect)) {
        roil_unload(e);
        return false;
    }
    roil_unload(l->effect);
    l->effect = e;
    apply_settings(l, made);
    forget_stale(l, made);
    return true;
}

static void set_message(roil_live *l, char *message) {
    mem_free(l->message);
    l->message = message;
}

bool roil_live_update(roil_live *l, uint32_t width, uint32_t height, double frame) {
    pthread_mutex_lock(&l->lock);
    l->frame = frame;
    l->framed = true;
    live_result result = {0};
    if (l->ready && (!l->result.effect || (width && height))) {
        result = l->result;
        l->result = (live_result){0};
        l->ready = false;
    }
    bool left = l->left && !l->left_reported;
    l->left_reported = true;
    pthread_mutex_unlock(&l->lock);
    if (left)
        set_message(l, copy_text("the last load hangs and was abandoned; a new one has begun"));
    if (result.effect && take_over(l, result.effect, width, height)) {
        l->counts.reloads++;
        l->counts.last = clock_seconds() - result.since;
        set_message(l, NULL);
        return true;
    }
    if (!result.effect && !result.message) return left;
    l->counts.failures++;
    set_message(l, result.message ? result.message : copy_text(err_get()));
    return true;
}

// ---- life -------------------------------------------------------------------------------------

static void on_changed(void *user, const char *path, double when) {
    (void)path;
    live_note(user, when);
}

static void on_settled(void *user) { // files saved together make one build
    live_wake(user);
}

static bool make_library(roil_live *l) {
    char folder[PATH_CAP], cache[PATH_CAP];
    path_folder(folder, l->origin.file);
    bool cached = l->owner->cache && path_join(cache, l->owner->cache, "spirv");
    roil_assets assets; // those of a project file that is wrong are read once it is mended
    if (!roil_find_assets(l->owner, &l->origin, &assets)) assets.count = 0;
    l->library = shader_library_create(&(shader_library_desc){
        .shader_root = l->owner->shaders,
        .effect_root = folder,
        .assets = assets.folders,
        .asset_count = assets.count,
        .cache_dir = cached ? cache : NULL,
        .remembers = true,
    });
    arena_free(&assets.memory);
    return l->library != NULL;
}

static void init_locks(roil_live *l) {
    pthread_condattr_t monotonic; // as clock_seconds
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->news, &monotonic);
    pthread_cond_init(&l->idle, &monotonic);
    pthread_condattr_destroy(&monotonic);
}

static void free_live(roil_live *l) { // its threads have ended
    watch_destroy(l->watch);
    live_free_result(&l->result);
    roil_unload(l->effect);
    shader_library_destroy(l->library);
    content_cache_destroy(l->contents);
    while (l->setting_count) remove_setting(l, &l->settings[l->setting_count - 1]);
    live_free_names(l->good, l->good_count);
    live_free_names(l->watched, l->watched_count);
    live_free_names(l->presets, l->preset_count);
    pthread_cond_destroy(&l->news);
    pthread_cond_destroy(&l->idle);
    pthread_mutex_destroy(&l->lock);
    mem_free(l->settings);
    mem_free(l->file);
    mem_free(l->message);
    mem_free(l);
}

static roil_live *create_live(roil *r, const roil_live_desc *desc) {
    if (!r->device) return ERR_NULL("no device: an effect can only be checked");
    roil_live *l = mem_alloc(sizeof *l);
    *l = (roil_live){
        .owner = r, .file = copy_text(desc->file), .wake = desc->wake, .user = desc->user};
    init_locks(l);
    l->contents = content_cache_create();
    l->presets = mem_alloc(desc->preset_count * sizeof *l->presets);
    for (size_t i = 0; i < desc->preset_count; i++)
        l->presets[l->preset_count++] = copy_text(desc->presets[i]);
    for (size_t i = 0; i < desc->setting_count; i++)
        put_setting(l, desc->settings[i].name, desc->settings[i].value, NULL);
    bool found = roil_find_origin(NULL, l->file, &l->origin);
    l->watch =
        found && make_library(l) ? watch_create(&(watch_desc){on_changed, on_settled, l}) : NULL;
    const char *file = l->origin.file;
    if (!l->watch || !watch_set(l->watch, &file, 1)) {
        free_live(l);
        return NULL;
    }
    l->building = true; // until the builder says otherwise
    live_want(l);
    if (live_start(l)) return l;
    free_live(l);
    return NULL;
}

roil_live *roil_live_create(roil *r, const roil_live_desc *desc) {
    RETURN_MADE(roil_live, create_live(r, desc), roil_live_destroy(made));
}

// Returns whether all builders ended before `until`. Call it with the lock held.
static bool wait_for_end(roil_live *l, double until) {
    struct timespec t = {.tv_sec = (time_t)until};
    t.tv_nsec = (long)((until - (double)t.tv_sec) * 1e9);
    int late = 0;
    while ((!l->builder->ended || l->left) && !late)
        late = pthread_cond_timedwait(&l->idle, &l->lock, &t);
    return !late;
}

bool roil_live_destroy(roil_live *l) {
    if (!l) return true;
    pthread_mutex_lock(&l->lock);
    l->ending = true;
    time_limit_stop(&l->builder->time);
    pthread_cond_broadcast(&l->news);
    bool ended = wait_for_end(l, clock_seconds() + LAST_SECONDS);
    pthread_mutex_unlock(&l->lock);
    if (!ended) { // what it works on has to stay
        l->owner->stuck = true;
        return err_set("a load hangs and was abandoned");
    }
    pthread_join(l->builder->thread, NULL);
    mem_free(l->builder);
    free_live(l);
    return true;
}

void roil_live_wait(roil_live *l) {
    watch_catch_up(l->watch);
    pthread_mutex_lock(&l->lock);
    while (l->wanted || l->building) pthread_cond_wait(&l->idle, &l->lock);
    pthread_mutex_unlock(&l->lock);
}

roil_effect *roil_live_effect(roil_live *l) {
    return l->effect;
}

const char *roil_live_message(roil_live *l) {
    return l->message;
}

roil_live_count roil_live_counts(const roil_live *l) {
    return l->counts;
}
