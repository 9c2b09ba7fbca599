// Systems of an effect: functions of the script that run frame by frame, handle events, and restart
// when time goes back.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "effect/events.h"
#include "scene/bvh.h"
#include <math.h>
#include <string.h>

enum { MOST_HEARINGS = 64, MOST_FRAMES = 1000000 };

typedef struct moved_param { // by the script
    size_t param;
    float before[4];
} moved_param;

struct effect_systems {
    double frame;               // that ran last; NAN: none
    effect_event *events, *own; // in force, and the script's; by time
    size_t count, own_count;
    size_t next; // of `events`, that has not happened yet
    effect_hearing hearings[MOST_HEARINGS];
    size_t hearing_count;
    effect_status status[EFFECT_MOST_STATUS];
    size_t status_count;
    moved_param *moved;
    size_t moved_count, moved_capacity;
};

static const double SOON = 1e-9; // seconds that are none

static double time_of(const effect *e, double frame) {
    return (frame - e->facts.first) / e->facts.fps;
}

static effect_systems *systems_of(effect *e) {
    if (!e->systems) {
        e->systems = mem_alloc(sizeof *e->systems);
        e->systems->frame = (double)NAN;
    }
    return e->systems;
}

void effect_free_systems(effect *e) {
    if (!e->systems) return;
    mem_free(e->systems->events);
    mem_free(e->systems->own);
    mem_free(e->systems->moved);
    mem_free(e->systems);
}

// ---- declaring --------------------------------------------------------------------------------

void effect_add_systems(effect *e) {
    systems_of(e);
}

bool effect_add_hearing(effect *e, const char *key, const char *help) {
    effect_systems *s = systems_of(e);
    effect_event probe = {.numbers = 2};
    if (strlen(key) >= sizeof probe.key) return err_set("key '%s' has too long a name", key);
    memcpy(probe.key, key, strlen(key));
    if (!events_check(&probe)) return false;
    for (size_t i = 0; i < s->hearing_count; i++) {
        if (strcmp(s->hearings[i].key, key) != 0) continue;
        if (!s->hearings[i].help[0]) s->hearings[i].help = arena_string(&e->memory, help);
        return true;
    }
    if (s->hearing_count == MOST_HEARINGS) return err_set("more than %d keys", MOST_HEARINGS);
    s->hearings[s->hearing_count++] =
        (effect_hearing){arena_string(&e->memory, key), arena_string(&e->memory, help)};
    return true;
}

static void events_sort(effect_event *list, size_t count) { // by time; who came first stays first
    for (size_t i = 1; i < count; i++) {
        effect_event event = list[i];
        size_t at = i;
        for (; at > 0 && list[at - 1].time > event.time; at--) list[at] = list[at - 1];
        list[at] = event;
    }
}

static bool is_same(const effect_event *a, const effect_event *b) {
    return a->time == b->time && strcmp(a->key, b->key) == 0 && a->numbers == b->numbers &&
           memcmp(a->at, b->at, sizeof a->at) == 0;
}

// Returns the index of the first event that two lists do not share, and its time (s); INFINITY: the
// lists are equal.
static size_t first_difference(const effect_event *a, size_t a_count, const effect_event *b,
                               size_t b_count, double *time) {
    size_t i = 0;
    while (i < a_count && i < b_count && is_same(&a[i], &b[i])) i++;
    *time = fmin(i < a_count ? a[i].time : (double)INFINITY,
                 i < b_count ? b[i].time : (double)INFINITY);
    return i;
}

// Takes a new list of events. If it changes what has happened already, everything restarts.
static void events_take(effect *e, const effect_event *list, size_t count) {
    effect_systems *s = e->systems;
    effect_event *taken = mem_copy(list, count * sizeof *list);
    events_sort(taken, count);
    double from;
    size_t first = first_difference(taken, count, s->events, s->count, &from);
    if (first < s->next || from <= time_of(e, s->frame - 1) + SOON) {
        s->frame = (double)NAN;
        s->next = 0;
    }
    effect_forget_snapshots_from(e, from);
    mem_free(s->events);
    s->events = taken;
    s->count = count;
}

bool effect_set_events(effect *e, const effect_event *list, size_t count) {
    effect_systems *s = systems_of(e);
    if (count > EFFECT_MOST_EVENTS) return err_set("more than %d events", EFFECT_MOST_EVENTS);
    for (size_t i = 0; i < count; i++)
        if (!events_check(&list[i])) return false;
    mem_free(s->own);
    s->own = mem_copy(list, count * sizeof *list);
    s->own_count = count;
    events_sort(s->own, count);
    events_take(e, s->own, count);
    return true;
}

bool effect_move_param(effect *e, size_t param, const float value[4]) {
    effect_systems *s = e->systems;
    moved_param now = {.param = param};
    memcpy(now.before, e->params[param]->value, sizeof now.before);
    if (!effect_set_value(e, param, value)) return false;
    for (size_t i = 0; s && i < s->moved_count; i++)
        if (s->moved[i].param == param) return true;
    if (!s || isnan(s->frame)) return true; // there is no time yet to go back from
    *MEM_ADD(s->moved, s->moved_count, s->moved_capacity) = now;
    return true;
}

void effect_forget_moved(effect *e, size_t param) {
    effect_systems *s = e->systems;
    for (size_t i = 0; s && i < s->moved_count; i++)
        if (s->moved[i].param == param) s->moved[i] = s->moved[--s->moved_count];
}

bool effect_set_status(effect *e, const char *name, double value, const char *unit) {
    effect_systems *s = systems_of(e);
    size_t i = 0;
    while (i < s->status_count && strcmp(s->status[i].name, name) != 0) i++;
    if (i == EFFECT_MOST_STATUS)
        return err_set("more than %d numbers of status", EFFECT_MOST_STATUS);
    effect_status *status = &s->status[i];
    if (i == s->status_count) {
        s->status_count++;
        status->name = arena_string(&e->memory, name);
        status->unit = arena_string(&e->memory, unit);
    }
    status->value = value;
    return true;
}

// ---- asking -----------------------------------------------------------------------------------

size_t effect_hearings(const effect *e, const effect_hearing **out) {
    *out = e->systems ? e->systems->hearings : NULL;
    return e->systems ? e->systems->hearing_count : 0;
}

size_t effect_statuses(const effect *e, const effect_status **out) {
    *out = e->systems ? e->systems->status : NULL;
    return e->systems ? e->systems->status_count : 0;
}

double effect_systems_time(const effect *e) {
    bool ran = e->systems && !isnan(e->systems->frame);
    return ran ? time_of(e, e->systems->frame) : -(double)INFINITY;
}

const effect_event *effect_events(const effect *e, size_t *count) {
    *count = e->systems ? e->systems->count : 0;
    return e->systems ? e->systems->events : NULL;
}

// ---- places -----------------------------------------------------------------------------------

static bool camera(effect *e, struct frame_block *out) {
    return effect_fill_frame(e, out);
}

bool effect_camera_ray(effect *e, float x, float y, float origin[3], float direction[3]) {
    struct frame_block f;
    if (!camera(e, &f)) return false;
    vec3 way = {(2 * x - 1 - f.shift.v[0]) * f.lens.v[0], (1 - 2 * y - f.shift.v[1]) * f.lens.v[1],
                -1};
    mat4 to_world;
    memcpy(to_world, &f.view_inverse, sizeof to_world);
    glm_mat4_mulv3(to_world, way, 0, direction);
    glm_vec3_normalize(direction);
    memcpy(origin, f.eye.v, 3 * sizeof *origin);
    return true;
}

// Returns the position in the picture of a point. False: it is behind the camera.
static bool picture_place(const struct frame_block *f, const float point[3], float *x, float *y) {
    mat4 view;
    vec3 p;
    memcpy(view, &f->view, sizeof view);
    glm_mat4_mulv3(view, (float *)(uintptr_t)point, 1, p);
    *x = 0.5f + 0.5f * (p[0] / (-p[2] * f->lens.v[0]) + f->shift.v[0]);
    *y = 0.5f - 0.5f * (p[1] / (-p[2] * f->lens.v[1]) + f->shift.v[1]);
    return p[2] < 0 && isfinite(*x) && isfinite(*y);
}

static bool event_aim(effect *e, effect_happening *h) {
    const effect_event *event = h->event;
    struct frame_block f;
    vec3 seen;
    h->placed = event->numbers > 0;
    if (!h->placed) return true;
    if (event->numbers == 2) {
        h->x = event->at[0];
        h->y = event->at[1];
        return effect_camera_ray(e, h->x, h->y, h->origin, h->direction);
    }
    if (!camera(e, &f)) return false;
    memcpy(h->origin, event->numbers == 6 ? event->at : f.eye.v, sizeof h->origin);
    if (event->numbers == 6)
        memcpy(h->direction, event->at + 3, sizeof h->direction);
    else
        glm_vec3_sub((float *)(uintptr_t)event->at, h->origin, h->direction);
    glm_vec3_normalize(h->direction);
    glm_vec3_add(h->origin, h->direction, seen);
    if (!picture_place(&f, event->numbers == 6 ? seen : event->at, &h->x, &h->y))
        h->x = h->y = 0.5f;
    return true;
}

static bool pick_ground(const float origin[3], const float direction[3], scene_hit *out) {
    float distance = -origin[2] / direction[2];
    if (!isfinite(distance) || distance <= 0) return false;
    *out = (scene_hit){.normal = {0, 0, direction[2] < 0 ? 1 : -1}, .distance = distance};
    for (int i = 0; i < 2; i++) out->position[i] = origin[i] + distance * direction[i];
    return true;
}

static bool pick_mesh(effect *e, const float origin[3], const float way[3], const scene_mesh *only,
                      scene_hit *out) {
    return e->host.bvh && scene_bvh_place(e->host.bvh, &e->context) &&
           scene_pick(e->host.bvh, origin, way, only, out);
}

bool effect_pick(effect *e, const float origin[3], const float direction[3], scene_hit *out) {
    vec3 way;
    glm_vec3_normalize_to((float *)(uintptr_t)direction, way);
    return pick_mesh(e, origin, way, NULL, out) || pick_ground(origin, way, out);
}

bool effect_is_under_ground(effect *e, const float at[3], float *height) {
    static const float up[] = {0, 0, 1}, down[] = {0, 0, -1};
    scene_hit above, below;
    if (!pick_mesh(e, at, up, NULL, &above) || !above.behind || above.instances) return false;
    *height = above.position[2];
    return !pick_mesh(e, at, down, above.mesh, &below) || !below.behind;
}

// ---- running ----------------------------------------------------------------------------------

static bool systems_begin(effect *e, effect_systems *s) {
    for (size_t i = 0; i < s->moved_count; i++)
        effect_set_value(e, s->moved[i].param, s->moved[i].before);
    effect_reset_instances(e);
    s->moved_count = s->next = 0;
    s->frame = e->facts.first - 1.0;
    e->context.time = 0;
    return !e->hooks.start || e->hooks.start(e->hooks.user);
}

static bool event_happen(effect *e, const effect_event *event) {
    effect_happening h = {.event = event};
    if (!e->hooks.event) return true;
    if (!event_aim(e, &h)) return false;
    h.met = h.placed && effect_pick(e, h.origin, h.direction, &h.hit);
    return e->hooks.event(e->hooks.user, &h);
}

static bool events_tell(effect *e, effect_systems *s) { // what has happened until the last frame
    double now = time_of(e, s->frame) + SOON;
    e->context.time = time_of(e, s->frame);
    while (s->next < s->count && s->events[s->next].time <= now) {
        effect_event event = s->events[s->next++];
        if (!event_happen(e, &event)) return false;
    }
    return true;
}

static bool systems_step(effect *e, effect_systems *s) {
    double dt = s->frame < e->facts.first ? 0 : 1 / e->facts.fps;
    s->frame++;
    if (e->hooks.renew) e->hooks.renew(e->hooks.user);
    e->context.time = time_of(e, s->frame);
    if (e->hooks.frame && !e->hooks.frame(e->hooks.user, e->context.time, dt)) return false;
    return events_tell(e, s);
}

// Reports progress, since skipped frames have no picture that shows it.
static bool tell_progress(effect *e, double done, double whole) {
    return whole <= 1 || effect_tell_progress(e, done, whole);
}

// A frame whose functions failed runs again for the next picture, from the beginning.
bool effect_run_systems(effect *e, double frame) {
    effect_systems *s = e->systems;
    if (!s) return true;
    double target = fmax(floor(frame + 1e-6), e->facts.first), time = e->context.time;
    if (target - e->facts.first > MOST_FRAMES)
        return err_set("frame %g: what the script does from frame to frame is run for at most %d "
                       "of them",
                       frame, MOST_FRAMES);
    bool done = true;
    if (isnan(s->frame) || target < s->frame) done = systems_begin(e, s);
    double left = target - s->frame, began = s->frame;
    for (; done && s->frame < target; done = done && tell_progress(e, s->frame - began, left))
        done = systems_step(e, s);
    done = done && events_tell(e, s);
    e->context.time = time;
    if (!done) s->frame = (double)NAN;
    return done;
}

void effect_restart_systems(effect *e) {
    if (e->systems) e->systems->frame = (double)NAN;
}

void effect_resize_systems(effect *e, uint32_t width, uint32_t height) {
    effect_systems *s = e->systems;
    if (!s || (e->width == width && e->height == height)) return;
    for (size_t i = 0; i < s->next; i++) // where these were depends on it
        if (s->events[i].numbers == 2) s->frame = (double)NAN;
}

// ---- as a control -----------------------------------------------------------------------------

static bool is_heard(const effect_systems *s, const effect_event *event) {
    for (size_t i = 0; i < s->hearing_count; i++)
        if (strcmp(s->hearings[i].key, event->key) == 0) return true;
    strbuf keys = {0};
    for (size_t i = 0; i < s->hearing_count; i++)
        strbuf_add(&keys, "%s%s%s", keys.length ? ", " : "", s->hearings[i].key[0] ? "key " : "",
                   s->hearings[i].key[0] ? s->hearings[i].key : "click");
    err_set("the effect handles no %s%s; it handles: %s", event->key[0] ? "key " : "clicks",
            event->key, keys.length ? strbuf_text(&keys) : "nothing");
    strbuf_free(&keys);
    return false;
}

bool events_add_control(effect *e) {
    static const char name[] = "effect.events";
    static const value_desc desc = {
        .type = VALUE_OTHER,
        .unit = "",
        .help = "what happens to it: seconds, click or key and its name, where"};
    if (!e->systems || effect_control_of(e, name)) return true;
    control own = {
        .face = {.kind = EFFECT_CONTROL_EVENTS, .name = name, .group = "effect", .desc = &desc}};
    for (size_t i = 0; i < e->systems->own_count; i++)
        if (!is_heard(e->systems, &e->systems->own[i])) return err_prefix("%s: ", name);
    return effect_apply_to(e, effect_add_control(e, &own));
}

bool events_control_set(effect *e, control *c, const char *text) {
    effect_event *list = mem_alloc(EFFECT_MOST_EVENTS * sizeof *list);
    size_t count;
    bool done = events_parse(text, list, &count);
    for (size_t i = 0; done && i < count; i++) done = is_heard(e->systems, &list[i]);
    if (done) events_take(e, list, count);
    mem_free(list);
    return done || err_prefix("%s: ", c->face.name);
}

void events_control_reset(effect *e, control *c) {
    (void)c;
    events_take(e, e->systems->own, e->systems->own_count);
}

void events_control_print(const effect *e, const control *c, strbuf *out) {
    (void)c;
    events_print(e->systems->events, e->systems->count, out);
}
