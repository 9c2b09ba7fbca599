// The loop of the live window: takes changed files, advances time, has the effect drawn when
// anything changed, draws the interface over its picture, and presents the result. It sleeps while
// nothing moves.
#include "app/branches.h"
#include "app/drawing.h"
#include "app/render_queue.h"
#include "app/restart.h"
#include "app/window.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/log.h"
#include "base/str.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

const live_preview live_previews[LIVE_PREVIEWS] = {{"full", 1}, {"half", 0.5f}, {"quarter", 0.25f}};

static const float SPLITTER = 5, MIN_PANEL = 240, MIN_VIEW = 200; // units
static const double NOTICE = 3;                                   // seconds that it is shown
static const double SETTLE = 0.7;  // seconds after an input in which widgets may still move
enum { SETTLE_FRAMES = 4 };        // and frames, however long they take: menus close, values follow
static const double STEADY = 0.12; // seconds that a size must last before pictures are made for it
static const double TICK = 1 / 60.0, BLINK = 0.25, LONG = 600;
// Seconds from one picture of the window to the next while a frame is at work, which needs the
// processor too: where a hand has done something, where something moves, and where only the sign of
// the work does.
static const double ANSWER = 1 / 80.0, LIVELY = 1 / 40.0, CALM = 1 / 10.0;
static const double POLL = 0.004; // seconds after which the device is asked whether it is done
enum { MAX_PICTURE = 16384 };

typedef struct loop {
    window *w;
    roil_picture picture;
    double last;   // clock_seconds when the last turn began ...
    double showed; // ... and the last one that showed something
    double polled; // ... and when input was asked for last
    double late;   // seconds that passed while a frame was at work, if all are to be drawn
    double awake_until;
    int awake_frames;
    uint32_t wanted[2]; // size of the picture by now, and since when
    double wanted_since;
    uint64_t reloads;
    bool shot;   // the picture has its size for a shot
    bool logged; // that the first frame was shown
    bool minimized;
} loop;

// ---- changes ----------------------------------------------------------------------------------

void live_notice(live *l, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(l->notice, sizeof l->notice, format, args);
    va_end(args);
    log_write(LOG_DEBUG, "live: notice: %s", l->notice);
    l->notice_until = clock_seconds() + NOTICE;
}

void live_redraw(live *l) {
    l->dirty = true;
    drawing_forget(l);
    if (!l->held) l->broken = NULL;
}

void live_break(live *l, const char *why) {
    str_copy(l->broken_text, sizeof l->broken_text, why);
    l->broken = l->broken_text;
    l->broken_frame = l->time.frame;
    l->time.playing = false;
    l->dirty = false;
    log_write(LOG_DEBUG, "live: %s", why);
}

// ---- following the files ----------------------------------------------------------------------

static void take_over(live *l) {
    bool first = !l->effect;
    l->effect = roil_live_effect(l->follow);
    roil_effect_info info = roil_get_info(l->effect);
    if (first) {
        bool playing = l->time.playing;
        timeline_init(&l->time, info.fps, info.first_frame, info.frames);
        l->time.playing = playing;
        if (isfinite(l->start)) timeline_seek(&l->time, l->start);
    } else {
        timeline_set_range(&l->time, info.fps, info.first_frame, info.frames);
    }
    l->camera_moved = false;     // the hand takes it up anew
    if (!first) l->held = false; // a file has changed
    live_redraw(l);
    if (first) drawing_lose(l, false);
    branches_reload(l);
    log_write(LOG_DEBUG, "live: took over, %.0f ms after the change",
              roil_live_counts(l->follow).last * 1000);
}

static void loop_follow_files(live *l, loop *p) {
    if (!roil_live_update(l->follow, l->width, l->height, l->time.frame)) return;
    const char *message = roil_live_message(l->follow);
    uint64_t reloads = roil_live_counts(l->follow).reloads;
    if (message) log_write(LOG_DEBUG, "live: %s", message);
    if (reloads != p->reloads) take_over(l);
    changes_take_over(l); // also of a file that failed: nothing waits for it
    p->reloads = reloads;
    restart_arm(l);
}

// ---- the effect's picture ---------------------------------------------------------------------

static uint32_t picture_size(float view, float scale) {
    float size = roundf(view * scale);
    return size < 1 ? 1 : size > MAX_PICTURE ? MAX_PICTURE : (uint32_t)size;
}

// While the user resizes the window the old picture is stretched, because preparing a new one takes
// time.
static void loop_resize(live *l, loop *p, double now) {
    float scale = l->shot ? 1 : live_previews[l->session.preview].scale;
    uint32_t width = picture_size(l->view.right - l->view.left, scale);
    uint32_t height = picture_size(l->view.bottom - l->view.top, scale);
    if (width != p->wanted[0] || height != p->wanted[1]) {
        p->wanted[0] = width;
        p->wanted[1] = height;
        p->wanted_since = now;
    }
    if ((width == l->width && height == l->height) || (l->effect && l->held)) return;
    if (drawing_is_there(l) && now - p->wanted_since < STEADY) return;
    l->width = width;
    l->height = height;
    if (!l->effect) return;         // it will be prepared for that size
    bool kept = l->shot || p->shot; // after a shot the size is as before, and so is what is kept
    p->shot = l->shot;
    drawing_lose(l, kept);
    if (!kept) live_redraw(l);
    l->dirty = true;
    if (!roil_prepare(l->effect, width, height)) live_break(l, roil_error());
}

// ---- time -------------------------------------------------------------------------------------

// Time that a simulation cannot keep up with passes more slowly. Where every frame is to be shown,
// that during a frame passes after it.
static void loop_advance(live *l, loop *p, double seconds) {
    double frame, taken, usual;
    if (l->held && l->time.playing) {
        l->held = false;
        live_redraw(l);
        restart_arm(l);
    }
    bool waits = l->time.every && drawing_is_busy(l, &frame, &taken, &usual);
    seconds += p->late;
    p->late = waits ? seconds : 0;
    if (waits || (drawing_is_behind(l) && !l->broken)) seconds = 0;
    if (l->effect) timeline_advance(&l->time, seconds);
    if (l->broken && !l->held && l->time.frame != l->broken_frame)
        l->broken = NULL; // another time may do
}

// ---- screenshot -------------------------------------------------------------------------------

static void shot_name(const live *l, int number, char *out, size_t capacity) {
    int length;
    const char *name = path_stem(l->file, &length);
    char again[16] = "";
    if (number > 1) snprintf(again, sizeof again, "-%d", number);
    snprintf(out, capacity, "%.*s-%.6g%s.png", length, name, l->time.frame, again);
}

static bool is_full_size(const live *l) {
    return l->width == picture_size(l->view.right - l->view.left, 1) &&
           l->height == picture_size(l->view.bottom - l->view.top, 1);
}

// Waits for the frame that it is named after, at the size of the window.
static void take_shot(live *l) {
    if (l->effect && !l->broken && !l->held && !(is_full_size(l) && drawing_is_whole(l))) return;
    l->shot = false;
    if (!l->effect || !drawing_is_there(l)) return;
    char file[PATH_CAP];
    int number = 1;
    do shot_name(l, number++, file, sizeof file);
    while (file_exists(file));
    if (!roil_save(l->effect, file, NULL)) {
        live_notice(l, "%s", roil_error());
        return;
    }
    log_write(LOG_DEBUG, "live: wrote %s", file);
    live_notice(l, "Saved %s, %u x %u pixels; `roil render --from` draws it in any size", file,
                l->width, l->height);
}

// ---- interface --------------------------------------------------------------------------------

typedef struct layout {
    ui_rect splitter, panel, bar;
    bool has_panel;
} layout;

static layout lay_out(live *l, uint32_t width, uint32_t height) {
    float s = ui_scale(), w = (float)width, h = (float)height;
    layout out = {.has_panel = false};
    l->view = l->whole = (ui_rect){0, 0, w, h};
    if (l->session.panel_hidden) return out;
    float most = w - MIN_VIEW * s;
    float wide = fminf(fmaxf(l->session.panel, MIN_PANEL) * s, most);
    float bar = fminf(TIMELINE_HEIGHT * s, floorf(h / 2)), split = SPLITTER * s;
    out.has_panel = wide >= MIN_PANEL * s / 2;
    float right = out.has_panel ? floorf(w - wide) : w;
    out.panel = (ui_rect){right, 0, w, h};
    out.splitter = (ui_rect){right - split, 0, right, h};
    l->view = (ui_rect){0, 0, out.has_panel ? right - split : w, h - bar};
    out.bar = (ui_rect){0, h - bar, l->view.right, h};
    return out;
}

static void draw_interface(live *l, const layout *at, uint32_t width) {
    ui_canvas view = ui_bare(l->view);
    ui_mark("view", l->view);
    if (!branches_input(l, &view) && !handles_input(l, &view)) {
        camera_input(l, &view);
        event_input(l, &view);
    }
    if (drawing_is_there(l)) handles_draw(l);
    if (drawing_is_there(l) && !drawing_works(l)) probe_draw(l, &view);
    status_draw(l, l->view);
    branches_draw(l);
    if (!l->session.panel_hidden) {
        timeline_draw(l, at->bar);
        if (at->has_panel) {
            float middle;
            if (ui_splitter(at->splitter, &middle))
                l->session.panel = ((float)width - middle) / ui_scale();
            panel_draw(l, at->panel);
        }
        graph_view_draw(l);
        inspector_draw(l);
        flow_tools_draw(l);
        performance_draw(l);
        changes_draw(l);
        write_back_draw(l);
        render_queue_draw(l);
    }
    overlay_draw(l, l->view);
    help_draw(l);
}

// Returns the seconds since the program was started, to a hundredth; 0 when the system does not
// say.
static double age(void) {
    struct timespec now;
    long long ticks;
    FILE *f = fopen("/proc/self/stat", "r");
    if (!f) return 0;
    bool known = fscanf(f,
                        "%*d (%*[^)]) %*c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s "
                        "%*s %*s %*s %*s %lld",
                        &ticks) == 1;
    fclose(f);
    if (!known || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0;
    double start = (double)ticks / (double)sysconf(_SC_CLK_TCK);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9 - start;
}

static bool loop_show(live *l, loop *p, uint32_t width, uint32_t height) {
    roil_picture *out = &p->picture;
    out->width = width;
    out->height = height;
    for (int i = 0; i < 3; i++) out->background[i] = 0.071f;
    drawing_show(l, out);
    branches_show(l, out);
    memcpy(out->view, &l->view, sizeof out->view);
    if (!roil_show(l->r, out)) return false;
    log_write(LOG_DEBUG, "live: shown");
    bool drawn = out->still || out->effect;
    if (drawn && !p->logged) log_write(LOG_DEBUG, "live: first frame after %.2f s", age());
    p->logged = p->logged || drawn;
    return true;
}

// ---- loop -------------------------------------------------------------------------------------

static bool at_work(const live *l) {
    double frame, taken, usual;
    return drawing_is_busy(l, &frame, &taken, &usual) || drawing_is_behind(l);
}

// Returns the seconds until the window is drawn again although the effects' device is at work.
static double time_to_show(const live *l, const loop *p, double now) {
    bool moves = l->time.playing || now < p->awake_until || p->awake_frames > 0 || ui_pending();
    return fmax(p->showed + (ui_acts() ? ANSWER : moves ? LIVELY : CALM) - now, 0);
}

static double time_to_sleep(const live *l, const loop *p, double now) {
    bool wanted = drawing_is_wanted(l);
    double most = LONG;
    if (p->minimized) return LONG;
    if (at_work(l)) return roil_shows_apart(l->r) ? fmin(time_to_show(l, p, now), POLL) : 0;
    if (ui_pending() || p->awake_frames > 0 || wanted || graph_view_busy(l)) return 0;
    if (l->effect && !l->broken && !l->held && l->time.playing) {
        double rate = l->time.fps * fabs(l->time.speed);
        if (l->time.smooth || !(rate > 0)) return 0;
        most = fmin((1 - fabs(l->time.owed)) / rate, most);
    }
    if (!l->held && (p->wanted[0] != l->width || p->wanted[1] != l->height))
        most = fmin(most, TICK);
    if (now < p->awake_until || l->notice[0]) most = fmin(most, TICK);
    if (ui_wants_keys() || render_queue_runs(l)) most = fmin(most, BLINK);
    return fmax(most, 0);
}

static bool loop_turn(live *l, loop *p) {
    double most = time_to_sleep(l, p, clock_seconds());
    bool woken = window_wait(most) && most > 0;
    if (ui_pending()) pulse_ask(&l->pulse, woken ? clock_seconds() : p->polled);
    p->polled = clock_seconds();
    if (woken || ui_pending()) {
        p->awake_until = p->polled + SETTLE;
        p->awake_frames = SETTLE_FRAMES;
    }
    return !window_closing(p->w) && !l->quit;
}

// What looks at the effect's own picture.
static void look(live *l) {
    if (!drawing_is_there(l)) return;
    if (!l->broken && !l->held) inspector_update(l);
    flow_tools_update(l);
    graph_view_update(l);
}

// Has what is wanted drawn, and uses the effect while nothing is at work.
static void loop_draw(live *l, loop *p, double now, double passed) {
    bool apart = roil_shows_apart(l->r);
    double frame, seconds = 0, usual;
    drawing_is_busy(l, &frame, &seconds, &usual);
    window_tell_busy(l->window, seconds);
    if (drawing_finish(l)) {
        loop_resize(l, p, now);
        loop_follow_files(l, p);
        branches_update(l);
        if (apart) look(l);
    }
    loop_advance(l, p, passed);
    drawing_begin(l);
    if (drawing_finish(l)) {
        if (!apart) look(l);
        if (l->shot) take_shot(l);
    }
}

bool live_loop(live *l, window *w) {
    loop p = {.w = w, .last = clock_seconds()};
    bool playing = false;
    while (loop_turn(l, &p)) {
        double now = clock_seconds(), passed = playing ? now - p.last : 0;
        uint64_t drawn = drawing_count(l);
        pulse_turn(&l->pulse, now - p.last, at_work(l));
        uint32_t width, height;
        p.last = now;
        window_pixels(w, &width, &height);
        p.minimized = !width || !height;
        if (p.minimized) {
            playing = false;
            continue;
        }
        ui_set_scale(window_scale(w) * l->session.scale);
        ui_set_contrast(l->session.contrast);
        layout at = lay_out(l, width, height);
        loop_draw(l, &p, now, passed);
        render_queue_update(l);
        playing = l->time.playing;
        if (roil_shows_apart(l->r) && at_work(l) && drawing_count(l) == drawn &&
            time_to_show(l, &p, now) > 0)
            continue;
        p.showed = now;
        if (p.awake_frames > 0) p.awake_frames--;
        if (p.awake_frames == 0 && drawing_count(l) != drawn) p.awake_frames = 1; // values follow
        ui_begin();
        undo_frame(&l->undo, ui_held());
        draw_interface(l, &at, width);
        ui_end(&p.picture);
        if (roil_is_lost(l->r) || !loop_show(l, &p, width, height)) {
            if (!l->broken) live_break(l, roil_error());
            return false;
        }
        pulse_show(&l->pulse, clock_seconds(), at_work(l));
    }
    return true;
}
