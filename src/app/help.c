// F1: lists the keys and what the mouse does.
#include "app/live.h"
#include "base/memory.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>

// Units.
static const float PADDING = 20, ROW = 24, BETWEEN = 40, GAP = 14, CAP = 14, HEADING = 26,
                   BLOCK_GAP = 8;
static const float EDGE = 12; // of PADDING, what a card has itself

typedef struct entry {
    const char *name, *help;
} entry;

static const entry mouse[] = {
    {"Drag", "turn the camera"},
    {"Shift drag", "move the camera"},
    {"Wheel", "nearer, farther"},
    {"Double click", "frame the volume"},
    {"Drag a handle (H)", "move it; Shift: level, Ctrl: in steps"},
    {"Drag in the timeline", "choose the frame"},
    {"Shift drag there", "choose the range to loop"},
    {"Double click a number", "type it"},
    {"Right click a value", "reset it, copy it as Lua"},
};

typedef struct keys { // as they are with this effect
    entry list[64];
    char names[64][16];
    size_t count;
} keys;

static void list_keys(const live *l, keys *out) {
    size_t count;
    const live_key *table = live_keys(&count);
    for (size_t i = 0; i < count && out->count < COUNT_OF(out->list); i++) {
        bool taken = !table[i].mods && event_hears_key(l, table[i].key);
        char *name = out->names[out->count];
        snprintf(name, sizeof *out->names, "%s%s", taken ? "Alt+" : "", table[i].name);
        out->list[out->count++] = (entry){name, table[i].help};
    }
}

static void list_hotkeys(const live *l, keys *out) {
    roil_hotkey all[LIVE_HOTKEYS];
    size_t count = event_hotkeys(l, all);
    for (size_t i = 0; i < count; i++) {
        char *name = out->names[out->count];
        snprintf(name, sizeof *out->names, "%s", all[i].key[0] ? all[i].key : "Click");
        name[0] = (char)toupper((unsigned char)name[0]);
        out->list[out->count++] = (entry){name, all[i].help};
    }
}

typedef struct block { // two columns under a heading
    const char *heading;
    const entry *list;
    size_t count;
} block;

static size_t rows_of(const block *b) {
    return (b->count + 1) / 2;
}

static float name_width(const block *b) {
    float width = 0;
    for (size_t i = 0; i < b->count; i++)
        width = fmaxf(width, ui_text_width(b->list[i].name) + (CAP + GAP) * ui_scale());
    return width;
}

static float column_width(const block *b) {
    float width = 0;
    for (size_t i = 0; i < b->count; i++) width = fmaxf(width, ui_text_width(b->list[i].help));
    return name_width(b) + width;
}

static void draw_entry(entry e, float left, float top, float name) {
    float s = ui_scale(), cap = ui_text_width(e.name) + CAP * s;
    ui_rect key = {left, top, left + cap, top + (ROW - 4) * s};
    ui_fill(key, ui_rgba(UI_LINE, 1), 4 * s);
    ui_label(left + CAP / 2 * s, top + 3 * s, ui_rgba(UI_TEXT, 1), e.name);
    ui_label(left + name, top + 3 * s, ui_rgba(UI_TEXT, 0.8f), e.help);
}

// Draws a block; the columns of all blocks have the same width. Returns where the block ends.
static float draw_block(const block *b, float left, float top, float column) {
    float s = ui_scale(), name = name_width(b);
    ui_label(left, top, ui_rgba(UI_ACCENT, 1), b->heading);
    top += HEADING * s;
    size_t rows = rows_of(b);
    for (size_t i = 0; i < b->count; i++)
        draw_entry(b->list[i], left + (float)(i / rows) * (column + BETWEEN * s),
                   top + (float)(i % rows) * ROW * s, name);
    return top + (float)rows * ROW * s;
}

void help_draw(live *l) {
    if (!l->help) return;
    keys own = {.count = 0}, heard = {.count = 0};
    list_keys(l, &own);
    list_hotkeys(l, &heard);
    const block blocks[] = {{"Keys", own.list, own.count},
                            {"Mouse", mouse, COUNT_OF(mouse)},
                            {"This effect", heard.list, heard.count}};
    size_t count = heard.count ? 3 : 2;
    float s = ui_scale(), column = 0, height = (2 * PADDING - BLOCK_GAP) * s;
    for (size_t i = 0; i < count; i++) {
        column = fmaxf(column, column_width(&blocks[i]));
        height += (HEADING + BLOCK_GAP + (float)rows_of(&blocks[i]) * ROW) * s;
    }
    float width = 2 * (column + PADDING * s) + BETWEEN * s;
    float left = floorf((l->view.left + l->view.right - width) / 2);
    float top = floorf((l->view.top + l->view.bottom - height) / 2);
    ui_shade(l->view);
    ui_card_begin("help", (ui_rect){left, top, left + width, top + height}, 0);
    ui_canvas c = ui_canvas_begin("keys", width - 2 * EDGE * s, height - 2 * EDGE * s);
    left = c.area.left + (PADDING - EDGE) * s;
    top = c.area.top + (PADDING - EDGE) * s;
    for (size_t i = 0; i < count; i++)
        top = draw_block(&blocks[i], left, top, column) + BLOCK_GAP * s;
    ui_canvas_end();
    ui_card_end();
}
