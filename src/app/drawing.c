// The effect's pictures: when one is drawn, and which one is shown.
//
// A frame may take seconds. The window goes on meanwhile, with the pictures that are there: where
// the device of the effects is not the one that draws the window (roil_shows_apart), nothing here
// waits. At most one frame is at work, and while it is, nobody touches what the device uses.
//
// Steps of simulations and pictures are apart: while a simulation is behind, its steps are handed
// over in small parts, and a picture is drawn from time to time only.
//
// A picture that was drawn is kept (film.h) until something else than time changes, so that frames
// play, and can be looked for, at once.
#include "app/drawing.h"
#include "app/branches.h"
#include "app/film.h"
#include "app/window.h"
#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include <math.h>

static const uint64_t AHEAD = 2;        // parts of steps that wait for their turn
static const double STEPS = 0.03;       // seconds of them at once, where they are waited for
static const double RARE = 1, PART = 5; // seconds between two pictures of a simulation that is
                                        // behind, and what part of the time they may take (1/PART)
static const double LAST_SECONDS = 1, POLL = 0.01; // of a frame when the window is closed
enum { MOST_SAMPLES = 65536 };

struct drawing {
    film film;
    roil_still *now;      // the last that was drawn; NULL: none
    roil_still *coming;   // of the frame at work
    double now_frame;     // of `now`
    double frame;         // the last that was drawn, or is at work
    double shown;         // frame that is shown
    bool drawn;           // the effect has a picture, in its size of now
    bool whole;           // `now` may be kept
    bool working;         // a frame is at work
    bool fresh;           // nothing has changed since it began
    bool stepping;        // a simulation is behind
    uint64_t count;       // frames that were drawn
    double began, called; // clock_seconds when the frame began, and had been handed over
    double before;        // when the one before began
    double lasted;        // seconds that the last one took
    double pictured;      // clock_seconds of the last picture of a simulation that is behind
};

drawing *drawing_create(void) {
    return mem_alloc(sizeof(drawing));
}

void drawing_destroy(drawing *d, roil *r) {
    film_set_range(&d->film, r, 0, -1);
    roil_still_destroy(r, d->now);
    roil_still_destroy(r, d->coming);
    mem_free(d);
}

bool drawing_is_there(const live *l) {
    return l->drawing->drawn;
}

uint64_t drawing_count(const live *l) {
    return l->drawing->count;
}

bool drawing_works(const live *l) {
    return l->drawing->working;
}

bool drawing_is_behind(const live *l) {
    return l->drawing->stepping;
}

bool drawing_is_busy(const live *l, double *frame, double *seconds, double *usual) {
    const drawing *d = l->drawing;
    *frame = d->frame;
    *seconds = d->working ? clock_seconds() - d->began : 0;
    *usual = d->lasted;
    return d->working;
}

// ---- what is kept -----------------------------------------------------------------------------

void drawing_forget(live *l) {
    drawing *d = l->drawing;
    film_clear(&d->film, l->r);
    d->whole = d->fresh = false;
}

void drawing_lose(live *l, bool keep) {
    if (!keep) drawing_forget(l);
    l->drawing->drawn = false;
}

// What is inspected or written must be the effect's own picture, and what hands do to an effect
// that listens is done at the time of that one.
static bool may_keep(const live *l) {
    return l->effect && !l->session.inspector && !l->session.slices && !l->shot &&
           !branches_wait(l) && roil_samples(l->effect) == 0 &&
           roil_hotkeys(l->effect, NULL, 0) == 0;
}

// Its picture can be shown at once.
static bool drawing_keeps(const live *l, double frame) {
    const drawing *d = l->drawing;
    return may_keep(l) &&
           ((d->now && d->whole && d->now_frame == frame) || film_get(&d->film, frame) != NULL);
}

static void put_away(live *l) {
    drawing *d = l->drawing;
    if (d->now && d->whole && may_keep(l))
        film_put(&d->film, l->r, d->now_frame, d->now);
    else
        roil_still_destroy(l->r, d->now);
    d->now = NULL;
}

bool drawing_find_kept(const live *l, double from, double *first, double *last) {
    const drawing *d = l->drawing;
    double now = d->now && d->whole ? d->now_frame : (double)NAN, frame = from;
    if (!may_keep(l)) return false;
    while (frame <= l->time.last && frame != now && !film_get(&d->film, frame)) frame++;
    *first = frame;
    while (frame <= l->time.last && (frame == now || film_get(&d->film, frame))) frame++;
    *last = frame - 1;
    return *last >= *first;
}

void drawing_exchange(live *l, film *from, film *to) {
    drawing *d = l->drawing;
    if (d->now && d->whole) film_put(&d->film, l->r, d->now_frame, roil_still_share(d->now));
    film_set_range(from, l->r, 0, -1);
    *from = d->film;
    d->film = *to;
    *to = (film){0};
    d->frame = d->now_frame = d->shown = (double)NAN; // `now` is of the other one
    d->whole = d->fresh = d->stepping = false;
    l->camera_moved = false;
    l->broken = NULL;
}

// ---- drawing ----------------------------------------------------------------------------------

// Returns whether another picture of the same frame would have more samples of a reference, up to a
// limit.
static bool gathers(const live *l) {
    uint32_t samples = roil_samples(l->effect);
    return samples > 0 && samples < MOST_SAMPLES;
}

// Returns whether a simulation, or a frame of a sequence, was too late for the picture.
static bool waits(const live *l) {
    roil_simulation simulation;
    roil_playback playback;
    return (roil_get_simulation(l->effect, &simulation) && simulation.waiting) ||
           (roil_get_playback(l->effect, &playback) && playback.waiting);
}

bool drawing_is_whole(const live *l) {
    const drawing *d = l->drawing;
    return d->drawn && !d->working && d->frame == l->time.frame && !l->dirty && !waits(l);
}

bool drawing_is_wanted(const live *l) {
    const drawing *d = l->drawing;
    if (!l->effect || l->broken || l->held) return false;
    return l->dirty ||
           !((d->drawn && d->frame == l->time.frame) || drawing_keeps(l, l->time.frame));
}

static void take(live *l) {
    drawing *d = l->drawing;
    if (d->coming && !roil_still_ready(l->r, d->coming)) { // there was no memory
        live_break(l, roil_error());
        roil_still_destroy(l->r, d->coming);
        d->coming = NULL;
    }
    if (d->coming) put_away(l);
    if (d->coming) d->now = d->coming;
    d->coming = NULL;
    d->whole = d->now && d->fresh && !l->dirty;
    d->now_frame = d->shown = d->frame;
}

bool drawing_finish(live *l) {
    drawing *d = l->drawing;
    if (!d->working) return true;
    if (roil_shows_apart(l->r) && roil_pending(l->r)) return false;
    if (roil_is_lost(l->r)) {
        if (!l->broken) live_break(l, roil_error());
        return false;
    }
    double now = clock_seconds();
    d->working = false;
    d->drawn = true;
    d->count++;
    l->pictures++;
    d->lasted = now - d->began;
    d->pictured = now;
    performance_add(l->performance, l->effect, d->called - d->began, d->began - d->before);
    d->before = d->began;
    bool changed = l->dirty, early = waits(l);
    log_write(LOG_DEBUG, "live: drew frame %g%s", d->frame, early ? ", early" : "");
    l->dirty = gathers(l) || early;
    take(l);
    l->dirty = l->dirty || changed;
    return true;
}

// Where the picture can be shown as it is, no memory for another one is no error.
static void keep_coming(live *l) {
    drawing *d = l->drawing;
    uint64_t bytes = d->now ? roil_still_bytes(d->now) : (uint64_t)l->width * l->height * 8;
    bool apart = roil_shows_apart(l->r);
    film_set_range(&d->film, l->r, l->time.first, l->time.last);
    if (!film_make_room(&d->film, l->r, l->time.frame, bytes) && !apart) {
        put_away(l);
        return;
    }
    d->coming = roil_still_create(l->effect);
    if (d->coming) return;
    if (apart)
        live_break(l, roil_error());
    else
        put_away(l);
}

static void draw(live *l) {
    drawing *d = l->drawing;
    double frame = l->time.frame, start = clock_seconds();
    bool back = d->drawn && frame < d->frame; // what passes remember is of later times: begin anew
    if (!(back ? roil_render : roil_advance)(l->effect, frame)) {
        live_break(l, roil_error());
        return;
    }
    d->began = start;
    d->called = clock_seconds();
    d->frame = frame;
    d->working = d->fresh = true;
    l->dirty = false;
    keep_coming(l);
    if (!roil_shows_apart(l->r)) drawing_finish(l);
}

// Hands over steps of simulations. Returns whether a picture is due.
static bool catch_up(live *l) {
    drawing *d = l->drawing;
    roil_simulation simulation;
    bool apart = roil_shows_apart(l->r), more = roil_get_simulation(l->effect, &simulation);
    double end = clock_seconds() + STEPS;
    while (more && (apart ? roil_pending(l->r) < AHEAD : clock_seconds() < end)) {
        if (roil_catch_up(l->effect, l->time.frame, &more)) continue;
        live_break(l, roil_error());
        more = false;
    }
    if (more && !d->stepping) d->pictured = clock_seconds();
    d->stepping = more;
    return !l->broken && (!more || clock_seconds() > d->pictured + fmax(RARE, PART * d->lasted));
}

void drawing_begin(live *l) {
    drawing *d = l->drawing;
    if (d->working) return;
    if (!drawing_is_wanted(l)) {
        d->stepping = false;
        return;
    }
    if (roil_shows_apart(l->r) && !d->stepping && roil_pending(l->r)) return;
    if (catch_up(l)) draw(l);
}

// Where another effect follows, the frame at work is waited for: without its device the program
// ends.
void drawing_end(live *l) {
    const double end = clock_seconds() + (l->leaves ? (double)INFINITY : LAST_SECONDS);
    while (roil_pending(l->r) && clock_seconds() < end && !(l->leaves && window_closing(l->window)))
        window_wait(POLL);
    if (roil_pending(l->r)) roil_give_up(l->r);
}

// ---- showing ----------------------------------------------------------------------------------

void drawing_show(live *l, roil_picture *out) {
    drawing *d = l->drawing;
    roil_still *kept = NULL;
    double before = d->shown;
    if (may_keep(l)) {
        if (film_get(&d->film, l->time.frame)) d->shown = l->time.frame;
        if (d->now && d->now_frame == l->time.frame) d->shown = d->now_frame;
        if (d->shown != d->now_frame) kept = film_get(&d->film, d->shown);
    }
    if (d->shown != before && isfinite(d->shown))
        log_write(LOG_DEBUG, "live: shows frame %g", d->shown);
    out->still = kept ? kept : d->now;
    out->beside = NULL;
    out->effect = d->drawn && !roil_shows_apart(l->r) ? l->effect : NULL;
}
