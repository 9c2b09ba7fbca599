// The loop of the live window: takes changed files, advances time, draws the effect when anything
// changed, draws the interface over it, and presents the result. It sleeps while nothing moves.
#include "app/live.h"
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
enum { MAX_PICTURE = 16384, MOST_SAMPLES = 65536 };

typedef struct loop {
    window *w;
    roil_picture picture;
    double last, drawn_at; // clock_seconds
    double awake_until;
    int awake_frames;
    uint32_t wanted[2]; // size of the picture by now, and since when
    double wanted_since;
    uint64_t reloads;
    bool drawn;   // the effect has a picture
    double frame; // of it
    bool logged;  // that the first frame was shown
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

static void take_over(live *l, loop *p) {
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
    p->drawn = p->drawn && !first;
    log_write(LOG_DEBUG, "live: took over, %.0f ms after the change",
              roil_live_counts(l->follow).last * 1000);
}

static void loop_follow_files(live *l, loop *p) {
    if (!roil_live_update(l->follow, l->width, l->height, l->time.frame)) return;
    const char *message = roil_live_message(l->follow);
    uint64_t reloads = roil_live_counts(l->follow).reloads;
    if (message) log_write(LOG_DEBUG, "live: %s", message);
    if (reloads != p->reloads) take_over(l, p);
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
    float scale = live_previews[l->session.preview].scale;
    uint32_t width = picture_size(l->view.right - l->view.left, scale);
    uint32_t height = picture_size(l->view.bottom - l->view.top, scale);
    if (width != p->wanted[0] || height != p->wanted[1]) {
        p->wanted[0] = width;
        p->wanted[1] = height;
        p->wanted_since = now;
    }
    if ((width == l->width && height == l->height) || (l->effect && l->held)) return;
    if (p->drawn && now - p->wanted_since < STEADY) return;
    l->width = width;
    l->height = height;
    if (!l->effect) return; // it will be prepared for that size
    p->drawn = false;
    if (roil_prepare(l->effect, width, height))
        live_redraw(l);
    else
        live_break(l, roil_error());
}

// Returns whether another picture of the same frame would have more samples of a reference, up to a
// limit.
static bool gathers(const live *l) {
    uint32_t samples = roil_samples(l->effect);
    return samples > 0 && samples < MOST_SAMPLES;
}

// Returns whether a simulation has not reached the picture's time.
static bool simulates(const live *l) {
    roil_simulation simulation;
    return roil_get_simulation(l->effect, &simulation) && simulation.waiting;
}

// Returns whether a simulation, or a frame of a sequence, was too late for the picture.
static bool waits(const live *l) {
    roil_playback playback;
    return simulates(l) || (roil_get_playback(l->effect, &playback) && playback.waiting);
}

static void draw_effect(live *l, loop *p) {
    double start = clock_seconds(), frame = l->time.frame;
    bool back = p->drawn && frame < p->frame; // what passes remember is of later times: begin anew
    if (!(back ? roil_render : roil_advance)(l->effect, frame)) {
        live_break(l, roil_error());
        return;
    }
    double end = clock_seconds();
    log_write(LOG_DEBUG, "live: drew frame %g", frame);
    l->dirty = gathers(l) || waits(l);
    p->drawn = true;
    l->pictures++;
    p->frame = frame;
    performance_add(l->performance, l->effect, end - start, start - p->drawn_at);
    p->drawn_at = start;
}

static bool can_draw(const live *l) {
    return l->effect && !l->broken && !l->held;
}

static void loop_advance(live *l, loop *p, double seconds) {
    if (l->held && l->time.playing) {
        l->held = false;
        live_redraw(l);
        restart_arm(l);
    }
    // Time that a simulation cannot keep up with passes more slowly.
    if (can_draw(l) && simulates(l)) seconds = 0;
    bool moved = l->effect && timeline_advance(&l->time, seconds);
    if (l->broken && !l->held && l->time.frame != l->broken_frame)
        l->broken = NULL; // another time may do
    if (can_draw(l) && (moved || l->dirty)) draw_effect(l, p);
    if (can_draw(l) && p->drawn) inspector_update(l); // also while time stands still
}

// ---- screenshot -------------------------------------------------------------------------------

static void shot_name(const live *l, int number, char *out, size_t capacity) {
    const char *name = path_name(l->file);
    int length = (int)(strlen(name) - (str_ends_with(name, ".lua") ? 4 : 0));
    char again[16] = "";
    if (number > 1) snprintf(again, sizeof again, "-%d", number);
    snprintf(out, capacity, "%.*s-%.6g%s.png", length, name, l->time.frame, again);
}

static void take_shot(live *l, const loop *p) {
    if (l->effect && p->drawn && waits(l)) return; // for the frame that it is named after
    l->shot = false;
    if (!l->effect || !p->drawn) return;
    char file[PATH_CAP];
    int number = 1;
    do shot_name(l, number++, file, sizeof file);
    while (file_exists(file));
    if (!roil_save(l->effect, file, NULL)) {
        live_notice(l, "%s", roil_error());
        return;
    }
    log_write(LOG_DEBUG, "live: wrote %s", file);
    live_notice(l,
                "Saved %s, %u x %u pixels (preview: %s); `roil render --from` draws it in any size",
                file, l->width, l->height, live_previews[l->session.preview].name);
}

// ---- interface --------------------------------------------------------------------------------

typedef struct layout {
    ui_rect splitter, panel, bar;
    bool has_panel;
} layout;

static layout lay_out(live *l, uint32_t width, uint32_t height) {
    float s = ui_scale(), w = (float)width, h = (float)height;
    layout out = {.has_panel = false};
    l->view = (ui_rect){0, 0, w, h};
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

static void draw_interface(live *l, const loop *p, const layout *at, uint32_t width) {
    ui_canvas view = ui_bare(l->view);
    ui_mark("view", l->view);
    if (!handles_input(l, &view)) {
        camera_input(l, &view);
        event_input(l, &view);
    }
    if (p->drawn) handles_draw(l);
    if (p->drawn) probe_draw(l, &view);
    status_draw(l, l->view);
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
    out->effect = p->drawn ? l->effect : NULL;
    memcpy(out->view, &l->view, sizeof out->view);
    if (!roil_show(l->r, out)) return false;
    log_write(LOG_DEBUG, "live: shown");
    if (p->drawn && !p->logged) log_write(LOG_DEBUG, "live: first frame after %.2f s", age());
    p->logged = p->logged || p->drawn;
    return true;
}

// ---- loop -------------------------------------------------------------------------------------

static double time_to_sleep(const live *l, const loop *p, double now) {
    bool drawing = can_draw(l);
    if (p->minimized) return LONG;
    if (ui_pending() || p->awake_frames > 0 || (drawing && l->dirty) || graph_view_busy(l))
        return 0;
    double most = LONG;
    if (drawing && l->time.playing) {
        double rate = l->time.fps * fabs(l->time.speed);
        if (l->time.smooth || !(rate > 0)) return 0;
        most = fmin((1 - fabs(l->time.owed)) / rate, most);
    }
    if (!l->held && (p->wanted[0] != l->width || p->wanted[1] != l->height))
        most = fmin(most, TICK);
    if (now < p->awake_until || l->notice[0]) most = fmin(most, TICK);
    if (ui_wants_keys()) most = fmin(most, BLINK);
    return fmax(most, 0);
}

static bool loop_turn(live *l, loop *p) {
    double most = time_to_sleep(l, p, clock_seconds());
    bool woken = window_wait(most) && most > 0;
    if (woken || ui_pending()) {
        p->awake_until = clock_seconds() + SETTLE;
        p->awake_frames = SETTLE_FRAMES;
    } else if (p->awake_frames > 0) {
        p->awake_frames--;
    }
    return !window_closing(p->w) && !l->quit;
}

bool live_loop(live *l, window *w) {
    loop p = {.w = w, .last = clock_seconds()};
    bool playing = false;
    while (loop_turn(l, &p)) {
        double now = clock_seconds(), passed = playing ? now - p.last : 0;
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
        loop_resize(l, &p, now);
        loop_follow_files(l, &p);
        loop_advance(l, &p, passed);
        playing = l->time.playing;
        if (p.drawn) inspector_update(l);
        if (p.drawn) flow_tools_update(l);
        if (p.drawn) graph_view_update(l);
        if (l->shot) take_shot(l, &p);
        ui_begin();
        undo_frame(&l->undo, ui_held());
        draw_interface(l, &p, &at, width);
        ui_end(&p.picture);
        if (roil_is_lost(l->r) || !loop_show(l, &p, width, height)) {
            if (!l->broken) live_break(l, roil_error());
            return false;
        }
    }
    return true;
}
