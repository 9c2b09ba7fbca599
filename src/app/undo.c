#include "app/undo.h"
#include "base/memory.h"
#include "base/str.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double PAUSE = 0.5; // seconds: turns of the wheel within it are one gesture
static const char camera[] = "camera.";

static char *copy_text(const char *text) {
    return text ? mem_copy(text, strlen(text) + 1) : NULL;
}

static bool same_text(const char *a, const char *b) {
    return a && b ? strcmp(a, b) == 0 : a == b;
}

static void free_step(undo_step *s) {
    for (size_t i = 0; i < s->count; i++) {
        mem_free(s->values[i].name);
        mem_free(s->values[i].before);
        mem_free(s->values[i].after);
    }
    mem_free(s->values);
    roil_edits_free(s->written);
    file_change_free(s->file);
    *s = (undo_step){0};
}

static undo_step *add_step(undo *u) {
    while (u->count > u->done) free_step(&u->steps[--u->count]);
    if (u->count == UNDO_STEPS) {
        free_step(&u->steps[0]);
        memmove(u->steps, u->steps + 1, (UNDO_STEPS - 1) * sizeof *u->steps);
        u->count--;
    }
    MEM_RESERVE(u->steps, u->count + 1, u->capacity);
    u->done = u->count + 1;
    u->open = true;
    undo_step *s = &u->steps[u->count++];
    *s = (undo_step){0};
    return s;
}

static undo_value *find(undo_step *s, const char *name) {
    for (size_t i = 0; i < s->count; i++)
        if (strcmp(s->values[i].name, name) == 0) return &s->values[i];
    return NULL;
}

// Several values of one thing are that thing: "camera", "sun".
static void name_step(undo_step *s) {
    size_t thing = strcspn(s->values[0].name, ".") + 1;
    bool same = true;
    for (size_t i = 1; i < s->count; i++)
        same = same && strncmp(s->values[i].name, s->values[0].name, thing) == 0;
    if (s->count == 1)
        str_copy(s->label, sizeof s->label, s->values[0].name);
    else if (same)
        snprintf(s->label, sizeof s->label, "%.*s", (int)thing - 1, s->values[0].name);
    else
        snprintf(s->label, sizeof s->label, "%zu values", s->count);
}

// A wheel that is turned holds nothing down.
static bool continues(undo *u, const char *name, double now) {
    if (u->done == 0 || u->done < u->count || u->steps[u->done - 1].written ||
        u->steps[u->done - 1].file)
        return false;
    bool wheel = strncmp(name, camera, sizeof camera - 1) == 0 && now - u->last_note < PAUSE;
    return u->open || (wheel && find(&u->steps[u->done - 1], name));
}

void undo_frame(undo *u, bool held) {
    if (!held) u->open = false;
}

static void set_value(undo_step *s, const char *name, const char *before, const char *after) {
    undo_value *v = find(s, name);
    if (!v) {
        MEM_RESERVE(s->values, s->count + 1, s->capacity);
        v = &s->values[s->count++];
        *v = (undo_value){.name = copy_text(name), .before = copy_text(before)};
    }
    mem_free(v->after);
    v->after = copy_text(after);
}

static bool changes(const undo_step *s) {
    for (size_t i = 0; i < s->count; i++)
        if (!same_text(s->values[i].before, s->values[i].after)) return true;
    return false;
}

void undo_note(undo *u, const char *name, const char *before, const char *after, double now) {
    bool goes_on = continues(u, name, now);
    if (!goes_on && same_text(before, after)) return;
    undo_step *s = goes_on ? &u->steps[u->done - 1] : add_step(u);
    set_value(s, name, before, after);
    name_step(s);
    u->open = true;
    u->last_note = now;
    if (changes(s)) return;
    free_step(s);
    u->done = --u->count;
    u->open = false;
}

void undo_label(undo *u, const char *format, ...) {
    if (u->done == 0 || !u->open) return;
    va_list args;
    va_start(args, format);
    vsnprintf(u->steps[u->done - 1].label, sizeof u->steps->label, format, args);
    va_end(args);
}

void undo_note_written(undo *u, roil_edits *written, const char *label) {
    undo_step *s = add_step(u);
    s->written = written;
    str_copy(s->label, sizeof s->label, label);
    u->open = false;
}

void undo_add_value(undo *u, const char *name, const char *before) {
    set_value(&u->steps[u->done - 1], name, before, NULL);
}

void undo_note_file(undo *u, file_change *file, const char *label) {
    undo_step *s = add_step(u);
    s->file = file;
    str_copy(s->label, sizeof s->label, label);
    u->open = false;
}

undo_step *undo_back(undo *u) {
    u->open = false;
    return u->done > 0 ? &u->steps[--u->done] : NULL;
}

undo_step *undo_again(undo *u) {
    u->open = false;
    return u->done < u->count ? &u->steps[u->done++] : NULL;
}

void undo_free(undo *u) {
    for (size_t i = 0; i < u->count; i++) free_step(&u->steps[i]);
    mem_free(u->steps);
    *u = (undo){0};
}
