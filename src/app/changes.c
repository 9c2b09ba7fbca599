// Values that the user sets in the window, and undoing them: live_set and live_reset are the one
// way in. A step that was written into files is undone in them; its values are set once the effect
// has been loaded from them.
#include "app/label.h"
#include "app/live.h"
#include "app/restart.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/log.h"
#include <stdio.h>

static const float WIDTH = 260, HEIGHT = 320; // units

// ---- setting ------------------------------------------------------------------------------------

static void settle(live *l) {
    live_redraw(l);
    restart_arm(l);
}

void live_set(live *l, const char *name, const char *value) {
    log_write(LOG_DEBUG, "live: set %s = %s", name, value);
    char *before = roil_live_setting(l->follow, name);
    if (roil_live_set(l->follow, name, value))
        undo_note(&l->undo, name, before, value, clock_seconds());
    else
        live_notice(l, "%s", roil_error());
    roil_free(before);
    settle(l);
}

static void reset_one(live *l, const char *name) {
    char *before = roil_live_setting(l->follow, name);
    if (roil_live_reset(l->follow, name))
        undo_note(&l->undo, name, before, NULL, clock_seconds());
    else
        live_notice(l, "%s", roil_error());
    roil_free(before);
}

static void reset_all(live *l) {
    size_t count = l->effect ? roil_control_count(l->effect) : 0;
    for (size_t i = 0; i < count; i++) {
        roil_control c;
        roil_get_control(l->effect, i, &c);
        if (c.moved) reset_one(l, c.name);
    }
    undo_label(&l->undo, "reset all");
    if (!roil_live_reset(l->follow, NULL)) live_notice(l, "%s", roil_error());
    l->camera_moved = false;
}

void live_reset(live *l, const char *name) {
    log_write(LOG_DEBUG, "live: reset %s", name ? name : "everything");
    if (name)
        reset_one(l, name);
    else
        reset_all(l);
    settle(l);
}

// ---- files --------------------------------------------------------------------------------------

bool live_write(live *l, const char *path, const char *label, bool (*write)(live *l, void *user),
                void *user) {
    char root[PATH_CAP];
    path_folder(root, l->file);
    file_change *c = file_change_begin(root, path);
    bool done = c && write(l, user) && file_change_end(c);
    if (done) {
        undo_note_file(&l->undo, c, label);
        log_write(LOG_DEBUG, "live: wrote %s", path);
    } else {
        live_notice(l, "%s", roil_error());
        log_write(LOG_DEBUG, "live: %s", roil_error());
        file_change_free(c);
    }
    return done;
}

static bool write_preset(live *l, void *name) {
    return roil_write_preset(l->effect, name);
}

bool live_write_preset(live *l, char *name) {
    char path[PATH_CAP], label[96];
    int stem;
    const char *file = path_stem(l->file, &stem);
    snprintf(path, sizeof path, "%.*s.presets/%s.lua", stem, file, name);
    snprintf(label, sizeof label, "saved preset %.60s", name);
    return live_write(l, path, label, write_preset, name);
}

// ---- undoing ------------------------------------------------------------------------------------

static void set_values(live *l, const undo_step *step, bool back) {
    for (size_t i = 0; i < step->count; i++) {
        const undo_value *v = &step->values[i];
        const char *text = back ? v->before : v->after;
        bool done =
            text ? roil_live_set(l->follow, v->name, text) : roil_live_reset(l->follow, v->name);
        if (!done) live_notice(l, "%s", roil_error());
    }
    l->camera_moved = false;
    settle(l);
}

// Takes a step back, or again. False: a file is another one now, and the step stays.
static bool take_step(live *l, const undo_step *step, bool back) {
    if (step->file) {
        if (!file_change_apply(step->file, back)) {
            live_notice(l, "%s", roil_error());
            return false;
        }
    } else if (!step->written) {
        set_values(l, step, back);
    } else if (!(back ? roil_edits_undo : roil_edits_write)(step->written)) {
        live_notice(l, "%s", roil_error());
        return false;
    }
    l->awaits_file = step->written != NULL;
    l->restored = step->written && back ? (size_t)(step - l->undo.steps) + 1 : 0;
    return true;
}

static bool move_step(live *l, bool back) {
    undo_step *step = back ? undo_back(&l->undo) : undo_again(&l->undo);
    if (!step) return false;
    if (!take_step(l, step, back)) {
        if (back)
            undo_again(&l->undo);
        else
            undo_back(&l->undo);
        return false;
    }
    log_write(LOG_DEBUG, "live: %s %s", back ? "undid" : "redid", step->label);
    live_notice(l, back ? "Undid %s" : "Did %s again", step->label);
    return true;
}

// Takes steps until `done` hold. After one that wrote files, the rest waits until they are loaded.
static void go_to(live *l, size_t done) {
    l->goal = done;
    while (l->effect && !l->awaits_file && l->undo.done != l->goal)
        if (!move_step(l, l->undo.done > l->goal)) l->goal = l->undo.done;
}

void live_undo(live *l) {
    size_t from = l->awaits_file ? l->goal : l->undo.done;
    if (from == 0)
        live_notice(l, "Nothing to undo");
    else
        go_to(l, from - 1);
}

void live_redo(live *l) {
    size_t from = l->awaits_file ? l->goal : l->undo.done;
    if (from >= l->undo.count)
        live_notice(l, "Nothing to do again");
    else
        go_to(l, from + 1);
}

void changes_take_over(live *l) {
    size_t step = l->restored;
    bool awaited = l->awaits_file;
    l->restored = 0;
    l->awaits_file = false;
    if (step > 0 && step <= l->undo.count) set_values(l, &l->undo.steps[step - 1], true);
    if (awaited && l->goal <= l->undo.count) go_to(l, l->goal);
}

// ---- list ---------------------------------------------------------------------------------------

// The newest is on top; what was undone is dim.
void changes_draw(live *l) {
    if (!l->undo_list) return;
    size_t chosen = l->undo.done;
    const ui_rect where = label_place(l->view, WIDTH, HEIGHT, true);
    if (ui_window_begin("What was done", &l->undo_list, where, false)) {
        for (size_t i = l->undo.count; i-- > 0;) {
            char id[24];
            snprintf(id, sizeof id, "%zu", i);
            ui_push(id);
            if (ui_row(l->undo.steps[i].label, i + 1 == l->undo.done, i >= l->undo.done))
                chosen = i + 1;
            ui_pop();
        }
        if (ui_row("as it was at first", l->undo.done == 0, false)) chosen = 0;
    }
    ui_window_end();
    if (chosen != l->undo.done) go_to(l, chosen);
}
