// Messages over the picture: why the newest file cannot be shown or a number was clamped, and short
// notices.
#include "app/drawing.h"
#include "app/label.h"
#include "app/live.h"
#include "app/text_wrap.h"
#include "base/clock.h"
#include "base/str.h"
#include <math.h>
#include <stdio.h>

// Units; those of the style that a card's size follows from.
static const float PADDING = 12, SPACING = 6, MONO_SIZE = 0.92f;
static const float MARGIN = 24, CARD_WIDTH = 900, CARD_SHARE = 0.7f; // of the view's height
static const double SURE = 1;      // seconds after which a rate is told
static const double NOTICED = 0.3; // seconds of a frame that are told
enum { MAX_TEXT = 4096 };

static const char *message_of(const live *l) {
    const char *message = l->follow ? roil_live_message(l->follow) : NULL;
    return message ? message : l->broken;
}

static bool is_room(ui_rect view) {
    float s = ui_scale();
    return view.right - view.left > 160 * s && view.bottom - view.top > 100 * s;
}

// ---- card ---------------------------------------------------------------------------------------

static ui_rect card_place(const text_message *m, const char *hint, ui_rect view) {
    float s = ui_scale(), line = label_height();
    float width = fminf(view.right - view.left - 2 * MARGIN * s, CARD_WIDTH * s);
    float inner = width - 2 * PADDING * s;
    size_t lines = text_wrap_lines(m->head, m->head_length, inner, ui_text_width);
    float height = 2 * PADDING * s + (float)lines * line;
    if (m->rest_lines) height += 2 * SPACING * s + (float)m->rest_lines * ceilf(line * MONO_SIZE);
    if (hint) height += 2 * SPACING * s + line;
    height = fminf(ceilf(height), (view.bottom - view.top) * CARD_SHARE);
    float left = floorf((view.left + view.right - width) / 2);
    float bottom = floorf(view.bottom - MARGIN * s);
    return (ui_rect){left, bottom - height, left + width, bottom};
}

typedef struct card {
    const char *name;
    ui_color edge;
    const char *text, *hint; // may be NULL
} card;

// Draws a card at the bottom of the view. Returns where there is room for a notice above it.
static float draw_card(const card *c, ui_rect view) {
    float s = ui_scale();
    char head[MAX_TEXT];
    strbuf rest = {0};
    text_message m = text_split(c->text);
    ui_rect at = card_place(&m, c->hint, view);
    float columns = (at.right - at.left - 2 * PADDING * s) / ui_mono_width();
    snprintf(head, sizeof head, "%.*s", (int)m.head_length, m.head);
    text_excerpt(m.rest, m.rest_length, columns > 0 ? (size_t)columns : 0, &rest);
    ui_card_begin(c->name, at, ui_rgba(c->edge, 1));
    ui_text_wrapped(head);
    if (m.rest_lines) {
        ui_gap(SPACING * s);
        ui_text_mono(UI_TEXT, strbuf_text(&rest), false);
    }
    strbuf_free(&rest);
    if (c->hint) {
        ui_gap(SPACING * s);
        ui_text_color(UI_DIM, "%s", c->hint);
    }
    ui_card_end();
    return at.top - SPACING * s;
}

// ---- notice -------------------------------------------------------------------------------------

// `part` of the work that it tells of is done; below 0: it tells of none. Returns where there is
// room for another notice above it.
static float draw_notice(const char *text, float part, ui_rect view, float bottom) {
    float s = ui_scale(), height = label_height() + 12 * s;
    char line[sizeof((live *)NULL)->notice];
    snprintf(line, sizeof line, "%.*s", (int)text_split(text).head_length, text);
    float width = fminf(ui_text_width(line) + 32 * s, view.right - view.left - 2 * MARGIN * s);
    float left = floorf((view.left + view.right - width) / 2), top = floorf(bottom - height);
    ui_fill((ui_rect){left, top, left + width, bottom}, ui_rgba(UI_PANEL, 0.92f), height / 2);
    label_within(left + 16 * s, top + 6 * s, width - 32 * s, ui_rgba(UI_TEXT, 1), line);
    if (part < 0) return top - SPACING * s;
    ui_rect bar = {left + 16 * s, bottom - 4 * s, left + width - 16 * s, bottom - 2 * s};
    ui_fill(bar, ui_rgba(UI_LINE, 1), s);
    bar.right = bar.left + (bar.right - bar.left) * fminf(part, 1);
    ui_fill(bar, ui_rgba(UI_ACCENT, 1), s);
    return top - SPACING * s;
}

static void draw_waiting(const live *l, bool broken, ui_rect view) {
    char text[1024];
    snprintf(text, sizeof text, broken ? "%s will be drawn once it is mended" : "Waiting for %s",
             l->file);
    label_center((view.left + view.right) / 2, (view.top + view.bottom) / 2 - label_height(),
                 ui_rgba(UI_DIM, 1), text);
}

// Returns what the user can do, or what continues meanwhile; NULL: nothing.
static const char *hint_of(const live *l) {
    if (l->held) return "Nothing is drawn until a file is saved, or time is played.";
    return l->effect ? "The last good effect goes on." : NULL;
}

// Returns the seconds until a simulation that has come to `reached` comes to `time`, as fast as it
// was since it fell behind; NAN: it is too early to tell.
static double time_left(live *l, double reached, double time) {
    double now = clock_seconds();
    if (!(l->behind.since > 0) || reached < l->behind.from) {
        l->behind.since = now;
        l->behind.from = reached;
    }
    double passed = now - l->behind.since, done = reached - l->behind.from;
    return passed > SURE && done > 0 ? (time - reached) * passed / done : (double)NAN;
}

// Prints how far a simulation is behind, or what is wrong with it. False: neither.
static bool say_simulation(live *l, char *out, size_t capacity, float *part) {
    roil_simulation s;
    bool behind = drawing_is_behind(l);
    if (!behind) l->behind.since = 0;
    if (!l->effect || !roil_get_simulation(l->effect, &s)) return false;
    double time = timeline_seconds(&l->time);
    bool tells = behind && isfinite(s.reached);
    double left = tells ? time_left(l, s.reached, time) : (double)NAN;
    *part = !behind ? -1 : tells && time > 0 ? (float)(s.reached / time) : 0;
    if (tells && left >= 1)
        snprintf(out, capacity, "Simulating: %.2f of %.2f s, %.0f s left; Esc stops", s.reached,
                 time, left);
    else if (tells)
        snprintf(out, capacity, "Simulating: %.2f of %.2f s", s.reached, time);
    else if (behind)
        snprintf(out, capacity, "Simulating");
    else if (s.trouble)
        snprintf(out, capacity, "%s: %s", s.pass, s.trouble);
    return behind || s.trouble;
}

// Prints what is at work, if that takes long enough to be noticed. False: it does not.
static bool say_work(const live *l, char *out, size_t capacity, float *part) {
    double frame, seconds, usual;
    if (!drawing_is_busy(l, &frame, &seconds, &usual) || fmax(seconds, usual) < NOTICED)
        return false;
    bool longer = seconds > usual; // than the last one, so that nobody knows
    *part = longer ? 1 : (float)(seconds / usual);
    if (longer)
        snprintf(out, capacity, "Drawing frame %.6g: %.1f s", frame, seconds);
    else
        snprintf(out, capacity, "Drawing frame %.6g: %.1f of some %.1f s", frame, seconds, usual);
    return true;
}

void overlay_draw(live *l, ui_rect view) {
    if (clock_seconds() >= l->notice_until) l->notice[0] = '\0'; // and the loop may sleep
    if (!is_room(view)) return;
    const char *message = message_of(l), *warning = l->effect ? roil_warning(l->effect) : NULL;
    float bottom = floorf(view.bottom - MARGIN * ui_scale());
    if (!l->effect) draw_waiting(l, message, view);
    if (message)
        bottom = draw_card(&(card){"message", UI_ERROR, message, hint_of(l)}, view);
    else if (warning)
        bottom = draw_card(&(card){"warning", UI_WARNING, warning, NULL}, view);
    char text[640];
    float part = -1;
    if (say_simulation(l, text, sizeof text, &part) || say_work(l, text, sizeof text, &part)) {
        ui_mark("work", view);
        bottom = draw_notice(text, part, view, bottom);
    }
    if (l->notice[0]) draw_notice(l->notice, -1, view, bottom);
}
