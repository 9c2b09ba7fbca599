// The timeline at the bottom of the window: a track to scrub in, buttons, speed.
//
// The upper strip of the track is the range that is looped, with a handle at each end. Below it,
// the pointer moves the current frame.
#include "app/branches.h"
#include "app/drawing.h"
#include "app/label.h"
#include "app/live.h"
#include "app/track.h"
#include <math.h>
#include <stdio.h>

// Units.
static const float TRACK_HEIGHT = 38, STRIP = 10, INSET = 8, REACH = 7, LABEL_SPACE = 64;
static const float NUMBERS_FROM = 350, SPEED_FROM = 450, SWITCHES_FROM = 640, RATE_FROM = 710,
                   BRANCHES_FROM = 780; // of the bar's width

enum { SNAPSHOTS = 64 };

typedef enum grab { GRAB_NONE, GRAB_FRAME, GRAB_FROM, GRAB_TO, GRAB_RANGE } grab;
static struct {
    grab what;
    double from; // of a range that is being drawn
} grabbed;

// ---- scrubbing --------------------------------------------------------------------------------

static void bar_seek(live *l, double frame) {
    timeline_seek(&l->time, l->time.smooth ? frame : round(frame));
}

static grab grab_at(const timeline *t, const track *bar, const ui_canvas *c) {
    if (c->y >= c->area.top + STRIP * ui_scale()) return c->shift ? GRAB_RANGE : GRAB_FRAME;
    float reach = REACH * ui_scale(), from = fabsf(track_x(bar, t->from) - c->x),
          to = fabsf(track_x(bar, t->to) - c->x);
    if (fminf(from, to) > reach) return GRAB_NONE;
    if (from == to) return c->x < track_x(bar, t->from) ? GRAB_FROM : GRAB_TO;
    return from < to ? GRAB_FROM : GRAB_TO;
}

static void bar_drag(live *l, const track *bar, const ui_canvas *c) {
    timeline *t = &l->time;
    double frame = track_frame(bar, c->x), whole = round(frame);
    switch (grabbed.what) {
    case GRAB_FRAME:
        bar_seek(l, frame);
        break;
    case GRAB_FROM:
        timeline_set_loop(t, fmin(whole, t->to), t->to);
        break;
    case GRAB_TO:
        timeline_set_loop(t, t->from, fmax(whole, t->from));
        break;
    case GRAB_RANGE: // a click alone is too short to mean one
        if (whole != grabbed.from) timeline_set_loop(t, grabbed.from, whole);
        break;
    case GRAB_NONE:
        break;
    }
}

static void scrub(live *l, const track *bar, const ui_canvas *c) {
    bool strip = c->y < c->area.top + STRIP * ui_scale();
    if (c->double_clicked && strip) timeline_set_loop(&l->time, l->time.first, l->time.last);
    if (c->pressed) {
        grabbed.what = grab_at(&l->time, bar, c);
        grabbed.from = round(track_frame(bar, c->x));
    }
    if (c->held) bar_drag(l, bar, c);
    if (!c->held) grabbed.what = GRAB_NONE;
}

// ---- drawing of the track -----------------------------------------------------------------------

static void draw_ticks(const timeline *t, const track *bar, ui_rect body) {
    float s = ui_scale();
    track_ticks ticks = track_ticks_of(bar, LABEL_SPACE * s);
    uint32_t strong = ui_rgba(UI_DIM, 0.55f), weak = ui_rgba(UI_DIM, 0.28f);
    if (ticks.between > 0) {
        double n = ceil(t->first / ticks.between);
        for (; n * ticks.between <= t->last; n++) {
            float x = roundf(track_x(bar, n * ticks.between));
            ui_line(x, body.bottom - 4 * s, x, body.bottom, weak, s);
        }
    }
    for (double n = ceil(t->first / ticks.step); n * ticks.step <= t->last; n++) {
        float x = roundf(track_x(bar, n * ticks.step));
        char text[32];
        snprintf(text, sizeof text, "%.0f", n * ticks.step);
        ui_line(x, body.bottom - 9 * s, x, body.bottom, strong, s);
        if (x + 4 * s + ui_text_width(text) < body.right)
            ui_label(x + 4 * s, body.top + 2 * s, ui_rgba(UI_DIM, 1), text);
    }
}

// A bar over the frames that can be shown at once, and a mark for each snapshot of a simulation.
static void draw_kept(const live *l, const track *bar, ui_rect body) {
    float s = ui_scale(), top = body.bottom - 5 * s, bottom = body.bottom - 3 * s;
    uint32_t color = ui_rgba(UI_ACCENT, 0.75f);
    double first, last = l->time.first - 1;
    while (drawing_find_kept(l, last + 1, &first, &last)) {
        float left = track_x(bar, first - 0.5), right = track_x(bar, last + 0.5);
        ui_fill((ui_rect){fmaxf(left, bar->left), top, fminf(right, bar->right), bottom}, color, 0);
    }
    double frames[SNAPSHOTS];
    size_t count = roil_snapshots(l->effect, frames, SNAPSHOTS);
    for (size_t i = 0; i < count && i < SNAPSHOTS; i++) {
        float x = roundf(track_x(bar, frames[i])), y = body.top + 18 * s;
        ui_triangle(x - 3 * s, y, x + 3 * s, y, x, y + 4 * s, ui_rgba(UI_TEXT, 0.7f));
    }
}

static void draw_handle(float x, ui_rect strip, bool active) {
    float s = ui_scale();
    uint32_t color = ui_rgba(active ? UI_ACCENT : UI_TEXT, active ? 1 : 0.75f);
    ui_fill((ui_rect){x - 3 * s, strip.top, x + 3 * s, strip.bottom}, color, 2 * s);
}

static void draw_range(const timeline *t, const track *bar, ui_rect strip, ui_rect body,
                       const ui_canvas *c) {
    float s = ui_scale(), from = track_x(bar, t->from), to = track_x(bar, t->to);
    float middle = (strip.top + strip.bottom) / 2;
    bool whole = t->from <= t->first && t->to >= t->last;
    uint32_t color = ui_rgba(t->loop ? UI_ACCENT : UI_DIM, whole ? 0.35f : 0.8f);
    ui_fill((ui_rect){from, middle - 1.5f * s, to, middle + 1.5f * s}, color, 1.5f * s);
    uint32_t outside = ui_rgba(UI_PANEL, 0.7f);
    if (t->from > t->first) ui_fill((ui_rect){body.left, body.top, from, body.bottom}, outside, 0);
    if (t->to < t->last) ui_fill((ui_rect){to, body.top, body.right, body.bottom}, outside, 0);
    grab near = grabbed.what != GRAB_NONE ? grabbed.what
                : c->hovered              ? grab_at(t, bar, c)
                                          : GRAB_NONE;
    draw_handle(from, strip, near == GRAB_FROM);
    draw_handle(to, strip, near == GRAB_TO);
}

static void draw_playhead(const timeline *t, const track *bar, ui_rect body) {
    float s = ui_scale(), x = track_x(bar, t->frame);
    uint32_t color = ui_rgba(UI_ACCENT, 1);
    ui_fill((ui_rect){bar->left, body.bottom - 2 * s, x, body.bottom}, ui_rgba(UI_ACCENT, 0.45f),
            0);
    ui_fill((ui_rect){x - s, body.top, x + s, body.bottom}, color, 0);
    ui_triangle(x - 5 * s, body.top, x + 5 * s, body.top, x, body.top + 6 * s, color);
}

// Marks the frame that a click would go to.
static void draw_pointer(const track *bar, ui_rect body, const ui_canvas *c) {
    if (!c->hovered || c->held || c->y < body.top) return;
    float x = track_x(bar, round(track_frame(bar, c->x)));
    ui_line(x, body.top, x, body.bottom, ui_rgba(UI_TEXT, 0.35f), ui_scale());
}

static void draw_track(live *l) {
    float s = ui_scale();
    const timeline *t = &l->time;
    ui_canvas c = ui_canvas_begin("timeline", 0, TRACK_HEIGHT * s);
    ui_rect strip = c.area, body = c.area;
    strip.bottom = strip.top + (STRIP - 2) * s;
    body.top += STRIP * s;
    const track bar = {t->first, t->last, body.left + INSET * s, body.right - INSET * s};
    scrub(l, &bar, &c);
    ui_fill(body, ui_rgba(UI_FIELD, 1), 4 * s);
    draw_ticks(t, &bar, body);
    draw_range(t, &bar, strip, body, &c);
    draw_kept(l, &bar, body);
    draw_pointer(&bar, body, &c);
    draw_playhead(t, &bar, body);
    ui_canvas_end();
}

// ---- the row below ------------------------------------------------------------------------------

static void draw_buttons(live *l) {
    timeline *t = &l->time;
    if (ui_icon_button("start", UI_ICON_START, false, "To the start (Home)")) bar_seek(l, t->from);
    ui_same_line();
    if (ui_icon_button("back", UI_ICON_BACK, false, "One frame back (Left)")) timeline_step(t, -1);
    ui_same_line();
    if (ui_icon_button("play", t->playing ? UI_ICON_PAUSE : UI_ICON_PLAY, t->playing,
                       t->playing ? "Pause (Space)" : "Play (Space)"))
        t->playing = !t->playing;
    ui_same_line();
    if (ui_icon_button("forward", UI_ICON_FORWARD, false, "One frame on (Right)"))
        timeline_step(t, 1);
    ui_same_line();
    if (ui_icon_button("end", UI_ICON_END, false, "To the end (End)")) bar_seek(l, t->to);
    ui_same_line();
    if (ui_icon_button("loop", UI_ICON_LOOP, t->loop, "Start again at the end of the range"))
        t->loop = !t->loop;
}

// All frames take the same width, so that what is beside them does not move. `whole`: with what
// the number is of, and its time.
static void draw_numbers(const timeline *t, bool whole) {
    float s = ui_scale(), space = ui_text_width(" ");
    char frame[32], widest[32], last[32], seconds[32];
    int decimals = t->smooth ? 2 : 0;
    snprintf(frame, sizeof frame, "%.*f", decimals, t->frame);
    snprintf(widest, sizeof widest, "%.*f", decimals, t->last);
    snprintf(last, sizeof last, "of %.0f", t->last);
    snprintf(seconds, sizeof seconds, "%.2f s", timeline_seconds(t));
    float first = ui_text_width(widest) + 6 * s, second = ui_text_width(last);
    float third = ui_text_width(widest) + ui_text_width("00.00 s");
    ui_canvas c = ui_canvas_begin("time", first + (whole ? second + third : 0), label_row());
    float y = c.area.top + (label_row() - label_height()) / 2;
    label_right(c.area.left + first, y, ui_rgba(UI_TEXT, 1), frame);
    if (whole) {
        ui_label(c.area.left + first + space, y, ui_rgba(UI_DIM, 1), last);
        label_right(c.area.right - 6 * s, y, ui_rgba(UI_TEXT, 1), seconds);
    }
    ui_canvas_end();
}

static void draw_speed(timeline *t) {
    static const double speeds[] = {0.1, 0.25, 0.5, 1, 2, -1};
    static const char *const words[] = {"0.1\u00d7", "0.25\u00d7", "0.5\u00d7",
                                        "1\u00d7",   "2\u00d7",    "reverse"};
    enum { COUNT = sizeof speeds / sizeof *speeds };
    size_t index = 0;
    for (size_t i = 1; i < COUNT; i++)
        if (fabs(speeds[i] - t->speed) < fabs(speeds[index] - t->speed)) index = i;
    ui_width(92 * ui_scale());
    if (ui_choice("##speed", &index, words, COUNT)) t->speed = speeds[index];
    ui_tooltip("Speed of time");
}

// Pictures drawn while time stands still do not count for the speed.
static void draw_rate(const live *l) {
    double rate = performance_rate(l->performance);
    char text[32] = "";
    if (rate > 0 && l->time.playing)
        snprintf(text, sizeof text, rate >= 9.95 ? "%.0f fps" : "%.1f fps", rate);
    ui_canvas c = ui_canvas_begin("rate", 0, label_row());
    label_right(c.area.right, c.area.top + (label_row() - label_height()) / 2, ui_rgba(UI_TEXT, 1),
                text);
    ui_canvas_end();
}

static void draw_switches(live *l) {
    timeline *t = &l->time;
    label_switch("every frame", &t->every, ui_rgba(UI_ACCENT, 1));
    ui_tooltip("Show every frame, however long each takes; else frames are left out to keep the "
               "time");
    ui_same_line();
    if (label_switch("smooth", &t->smooth, ui_rgba(UI_ACCENT, 1))) bar_seek(l, t->frame);
    ui_tooltip("Show times between frames, as often as the window is drawn");
}

// Leaves out what does not fit into a narrow window.
static void draw_row(live *l) {
    timeline *t = &l->time;
    ui_rect space = ui_space();
    float units = (space.right - space.left) / ui_scale();
    draw_buttons(l);
    ui_same_line();
    draw_numbers(t, units > NUMBERS_FROM);
    if (units > SPEED_FROM) {
        ui_same_line();
        draw_speed(t);
    }
    if (units > SWITCHES_FROM) {
        ui_same_line();
        draw_switches(l);
    }
    if (units > BRANCHES_FROM) {
        ui_same_line();
        branches_draw_buttons(l);
    }
    if (units > RATE_FROM) {
        ui_same_line();
        draw_rate(l);
    }
}

void timeline_draw(live *l, ui_rect where) {
    ui_panel_begin("time", where);
    if (l->effect) { // else there is no time
        draw_track(l);
        draw_row(l);
    }
    ui_panel_end();
}
