#include "app/branches.h"
#include "app/drawing.h"
#include "app/film.h"
#include "app/label.h"
#include "base/log.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 8, NOTHING = -1, FORK = MOST };
static const float REACH = 6, PADDING = 10; // units

typedef struct kept_setting {
    char *name, *text;
} kept_setting;

typedef struct branch {
    film film;          // of one that is not the present one, as all that follows
    roil_branch *state; // NULL: its simulations start from the beginning
    kept_setting *settings;
    size_t count, capacity;
    undo undo;
} branch;

struct branches {
    branch list[MOST];
    size_t count, now, other; // how many; the present one; the one that is compared with it
    int asked;                // which one to go to, or FORK
    bool comparing;
    float split; // 0 to 1, from the left of the view
    bool held;   // the line between two
};

branches *branches_create(void) {
    branches *b = mem_alloc(sizeof *b);
    b->count = 1;
    b->asked = NOTHING;
    b->split = 0.5f;
    return b;
}

static void forget_settings(branch *one) {
    for (size_t i = 0; i < one->count; i++) {
        mem_free(one->settings[i].name);
        mem_free(one->settings[i].text);
    }
    one->count = 0;
}

void branches_destroy(branches *b, roil *r) {
    for (size_t i = 0; i < b->count; i++) {
        branch *one = &b->list[i];
        film_set_range(&one->film, r, 0, -1);
        roil_branch_destroy(one->state);
        forget_settings(one);
        mem_free(one->settings);
        undo_free(&one->undo);
    }
    mem_free(b);
}

void branches_forget(live *l) {
    branches *b = l->branches;
    for (size_t i = 0; i < b->count; i++) film_clear(&b->list[i].film, l->r);
}

void branches_reload(live *l) {
    branches *b = l->branches;
    for (size_t i = 0; i < b->count; i++) {
        roil_branch_destroy(b->list[i].state);
        b->list[i].state = NULL;
    }
}

// ---- settings ---------------------------------------------------------------------------------

// All look from one camera, or they could not be compared.
static bool is_own(const char *name) {
    return strncmp(name, "camera.", 7) != 0;
}

static char *copy_text(const char *text) {
    return mem_copy(text, strlen(text) + 1);
}

static void note_settings(live *l, branch *out) {
    forget_settings(out);
    for (size_t i = 0; i < roil_control_count(l->effect); i++) {
        roil_control c;
        roil_get_control(l->effect, i, &c);
        char *text = is_own(c.name) ? roil_live_setting(l->follow, c.name) : NULL;
        if (!text) continue;
        *MEM_ADD(out->settings, out->count, out->capacity) =
            (kept_setting){copy_text(c.name), copy_text(text)};
        roil_free(text);
    }
}

static const char *find_setting(const branch *one, const char *name) {
    for (size_t i = 0; i < one->count; i++)
        if (strcmp(one->settings[i].name, name) == 0) return one->settings[i].text;
    return NULL;
}

static void apply_settings(live *l, const branch *to) {
    for (size_t i = 0; i < roil_control_count(l->effect); i++) {
        roil_control c;
        roil_get_control(l->effect, i, &c);
        char *text = is_own(c.name) ? roil_live_setting(l->follow, c.name) : NULL;
        if (text && !find_setting(to, c.name)) roil_live_reset(l->follow, c.name);
        roil_free(text);
    }
    for (size_t i = 0; i < to->count; i++) {
        char *text = roil_live_setting(l->follow, to->settings[i].name);
        bool same = text && strcmp(text, to->settings[i].text) == 0;
        if (!same && !roil_live_set(l->follow, to->settings[i].name, to->settings[i].text))
            live_notice(l, "%s", roil_error());
        roil_free(text);
    }
}

// ---- going from one to another ----------------------------------------------------------------

static char name_of(size_t index) {
    return (char)('A' + index);
}

// `state`: what the next one begins with, which it owns.
static void change_to(live *l, size_t to, roil_branch *state) {
    branches *b = l->branches;
    branch *from = &b->list[b->now], *next = &b->list[to];
    note_settings(l, from);
    from->state = roil_branch_leave(l->effect);
    from->undo = l->undo;
    apply_settings(l, next);
    roil_branch_enter(l->effect, state);
    next->state = NULL;
    l->undo = next->undo;
    next->undo = (undo){0};
    drawing_exchange(l, &from->film, &next->film);
    b->now = to;
    log_write(LOG_DEBUG, "live: branch %c", name_of(to));
}

static void fork_off(live *l) {
    branches *b = l->branches;
    roil_simulation simulation;
    bool simulates = roil_get_simulation(l->effect, &simulation);
    roil_branch *state = simulates ? roil_branch_begin(l->effect) : NULL;
    if (simulates && !state) {
        live_notice(l, "%s", roil_error());
        return;
    }
    size_t to = b->count++;
    note_settings(l, &b->list[to]);
    b->other = b->now;
    change_to(l, to, state);
    live_notice(l, "Branch %c goes on from frame %.6g", name_of(to), l->time.frame);
}

void branches_fork(live *l) {
    branches *b = l->branches;
    if (!l->effect) return;
    if (b->count == MOST) {
        live_notice(l, "There are %d branches; no more are kept", MOST);
        return;
    }
    l->time.playing = false;
    b->asked = FORK;
}

static void go_to(live *l, size_t index) {
    if (index != l->branches->now) l->branches->asked = (int)index;
}

void branches_next(live *l) {
    const branches *b = l->branches;
    if (b->count == 1) live_notice(l, "There is one branch; B makes another");
    go_to(l, (b->now + 1) % b->count);
}

void branches_compare(live *l) {
    branches *b = l->branches;
    if (b->count == 1) live_notice(l, "There is nothing to compare with; B makes a branch");
    b->comparing = b->count > 1 && !b->comparing;
}

bool branches_wait(const live *l) {
    return l->branches->asked == FORK;
}

void branches_update(live *l) {
    branches *b = l->branches;
    int asked = b->asked;
    if (asked == NOTHING || !l->effect || (asked == FORK && !drawing_is_whole(l))) return;
    b->asked = NOTHING;
    if (asked == FORK) {
        fork_off(l);
        return;
    }
    roil_branch *state = b->list[asked].state;
    if ((size_t)asked != b->now) b->other = b->now;
    change_to(l, (size_t)asked, state);
}

// ---- side by side -----------------------------------------------------------------------------

static float split_of(const live *l) {
    return roundf(l->view.left + (l->view.right - l->view.left) * l->branches->split);
}

// The earlier one is to the left.
void branches_show(live *l, roil_picture *out) {
    const branches *b = l->branches;
    if (!b->comparing) return;
    roil_still *now = out->still, *other = film_get(&b->list[b->other].film, l->time.frame);
    bool left = b->now < b->other;
    out->still = left ? now : other;
    out->beside = left ? other : now;
    out->split = split_of(l);
    if (!out->beside) out->split = l->view.right;
    if (!out->still) out->split = l->view.left;
}

bool branches_input(live *l, const ui_canvas *view) {
    branches *b = l->branches;
    if (!b->comparing) b->held = false;
    if (!b->comparing) return false;
    bool near = view->hovered && fabsf(view->x - split_of(l)) <= REACH * ui_scale();
    if (view->pressed) b->held = near;
    if (b->held && view->held) {
        float at = (view->x - l->view.left) / fmaxf(l->view.right - l->view.left, 1);
        b->split = fminf(fmaxf(at, 0), 1);
    }
    bool had = b->held;
    if (!view->held) b->held = false;
    return had || near;
}

// Draws a name, and returns where it ends.
static void draw_name(const live *l, size_t index, bool right, bool missing) {
    float s = ui_scale(), x = split_of(l), top = l->view.top + 16 * s;
    bool late = index == l->branches->now && drawing_is_wanted(l); // it shows another frame
    char text[96];
    if (missing)
        snprintf(text, sizeof text, "%c has no picture of frame %.6g", name_of(index),
                 l->time.frame);
    else
        snprintf(text, sizeof text, "%c%s", name_of(index), late ? " \u2026" : "");
    float width = ui_text_width(text) + 2 * PADDING * s, height = label_height() + 8 * s;
    float left = right ? x + PADDING * s : x - PADDING * s - width;
    ui_fill((ui_rect){left, top, left + width, top + height}, ui_rgba(UI_PANEL, 0.85f), 4 * s);
    bool now = index == l->branches->now;
    ui_label(left + PADDING * s, top + 4 * s, ui_rgba(now ? UI_ACCENT : UI_TEXT, 1), text);
}

void branches_draw(live *l) {
    const branches *b = l->branches;
    if (!b->comparing) return;
    float s = ui_scale(), x = split_of(l), middle = (l->view.top + l->view.bottom) / 2;
    size_t first = b->now < b->other ? b->now : b->other;
    size_t second = b->now < b->other ? b->other : b->now;
    bool missing = !film_get(&b->list[b->other].film, l->time.frame);
    ui_line(x, l->view.top, x, l->view.bottom, ui_rgba(UI_TEXT, 0.9f), 2 * s);
    ui_fill((ui_rect){x - 4 * s, middle - 16 * s, x + 4 * s, middle + 16 * s},
            ui_rgba(UI_ACCENT, 1), 4 * s);
    ui_mark("split", (ui_rect){x - 4 * s, middle - 16 * s, x + 4 * s, middle + 16 * s});
    draw_name(l, first, false, missing && first == b->other);
    draw_name(l, second, true, missing && second == b->other);
}

void branches_draw_buttons(live *l) {
    branches *b = l->branches;
    for (size_t i = 0; i < b->count && b->count > 1; i++) {
        char name[] = {name_of(i), '\0'};
        bool on = i == b->now;
        if (label_switch(name, &on, ui_rgba(UI_ACCENT, 1))) go_to(l, i);
        ui_tooltip("Go to this branch (X: the next one)");
        ui_same_line();
    }
    bool off = false;
    if (label_switch("branch", &off, ui_rgba(UI_ACCENT, 1))) branches_fork(l);
    ui_tooltip("Go on from this frame with settings of your own (B)");
    if (b->count == 1) return;
    ui_same_line();
    if (label_switch("A | B", &b->comparing, ui_rgba(UI_ACCENT, 1)) && b->count == 1)
        b->comparing = false;
    ui_tooltip("Compare two branches side by side (C)");
}
