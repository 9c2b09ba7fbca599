// The window that shows what writing back would change in the effect's files, before it is done.
#include "app/label.h"
#include "app/live.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <string.h>

static const float WIDTH = 760, HEIGHT = 360; // units

struct write_back {
    roil_edits *edits; // NULL: they were written, and belong to the undo steps
    roil_edit *list;
    size_t count, writable;
    char control[96]; // the only one, or the group of layers; "": all
    bool layers;      // there will be another number of them
};

void write_back_close(live *l) {
    write_back *w = l->writing;
    if (!w) return;
    roil_edits_free(w->edits);
    mem_free(w->list);
    mem_free(w);
    l->writing = NULL;
}

static void open_edits(live *l, roil_edits *edits, const char *control) {
    write_back_close(l);
    size_t count = edits ? roil_edits_list(edits, NULL, 0) : 0;
    if (count == 0) {
        live_notice(l, "%s", edits ? "Nothing was changed" : roil_error());
        roil_edits_free(edits);
        return;
    }
    write_back *w = l->writing = mem_alloc(sizeof *w);
    w->edits = edits;
    w->list = mem_alloc(count * sizeof *w->list);
    w->count = roil_edits_list(edits, w->list, count);
    if (control) str_copy(w->control, sizeof w->control, control);
    for (size_t i = 0; i < count; i++) w->writable += !w->list[i].refusal;
}

void write_back_ask(live *l, const char *control) {
    if (l->effect) open_edits(l, roil_edits_create(l->effect, control), control);
}

void write_back_pin(live *l, const char *control) {
    if (l->effect) open_edits(l, roil_edits_create_parameter(l->effect, control), control);
}

void write_back_layer(live *l, const char *layers, size_t layer, roil_layer_change how) {
    if (!l->effect) return;
    open_edits(l, roil_edits_create_layer(l->effect, layers, layer, how), layers);
    if (l->writing) l->writing->layers = true;
}

// ---- writing ------------------------------------------------------------------------------------

static bool is_refused(const write_back *w, const char *name) {
    for (size_t i = 0; i < w->count; i++)
        if (w->list[i].refusal && strcmp(w->list[i].controls, name) == 0) return true;
    return false;
}

static bool is_meant(const write_back *w, const roil_control *c) {
    if (w->layers) return c->layer && strcmp(w->control, c->group) == 0;
    return !w->control[0] || strcmp(w->control, c->name) == 0;
}

// The values that were written are the script's own from now on; undoing sets them again.
static void note_written(live *l, write_back *w) {
    char label[sizeof w->control + PATH_CAP];
    snprintf(label, sizeof label, "written: %s%s", w->layers ? "layers of " : "",
             w->control[0] ? w->control : path_name(l->file));
    undo_note_written(&l->undo, w->edits, label);
    w->edits = NULL;
    for (size_t i = 0; i < roil_control_count(l->effect); i++) {
        roil_control c;
        roil_get_control(l->effect, i, &c);
        if (!c.moved || !is_meant(w, &c) || is_refused(w, c.name)) continue;
        char *text = roil_live_setting(l->follow, c.name);
        if (text) undo_add_value(&l->undo, c.name, text);
        if (w->layers) roil_live_reset(l->follow, c.name); // another one has its name now
        roil_free(text);
    }
}

static void write_files(live *l) {
    write_back *w = l->writing;
    if (roil_edits_write(w->edits)) {
        log_write(LOG_DEBUG, "live: wrote back %zu", w->writable);
        live_notice(l, "Written; Ctrl+Z takes it back");
        note_written(l, w);
    } else {
        live_notice(l, "%s", roil_error());
    }
    write_back_close(l);
}

// ---- drawing ------------------------------------------------------------------------------------

// Draws each line of a text with a sign before it, as patches are shown.
static void draw_lines(const char *text, char sign, ui_color color) {
    strbuf line = {0};
    for (const char *at = text; *at;) {
        size_t length = strcspn(at, "\n");
        line.length = 0;
        strbuf_add(&line, "%c %.*s", sign, (int)length, at);
        ui_text_mono(color, strbuf_text(&line), true);
        at += length + (at[length] == '\n');
    }
    strbuf_free(&line);
}

static void draw_edit(const roil_edit *edit) {
    if (edit->refusal) {
        strbuf text = {0};
        strbuf_add(&text, "%s stays set: %s", edit->controls, edit->refusal);
        ui_text_wrapped(strbuf_text(&text));
        strbuf_free(&text);
    } else {
        ui_text_color(UI_DIM, "%s:%d  %s", path_name(edit->file), edit->line, edit->controls);
        draw_lines(edit->before, '-', UI_ERROR);
        draw_lines(edit->after, '+', UI_GOOD);
    }
    ui_gap(6 * ui_scale());
}

void write_back_draw(live *l) {
    write_back *w = l->writing;
    if (!w) return;
    bool open = true, writes = false;
    const ui_rect where = label_place(l->view, WIDTH, HEIGHT, false);
    if (ui_window_begin("Write into the file", &open, where, false)) {
        ui_disable_begin(w->writable == 0);
        writes = ui_button("Write");
        ui_disable_end();
        ui_same_line();
        if (ui_button("Cancel")) open = false;
        ui_gap(6 * ui_scale());
        for (size_t i = 0; i < w->count; i++) draw_edit(&w->list[i]);
    }
    ui_window_end();
    if (writes)
        write_files(l);
    else if (!open)
        write_back_close(l);
}
