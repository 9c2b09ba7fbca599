// F1: lists the keys and what the mouse does.
#include "app/label.h"
#include "app/live.h"
#include "base/memory.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>

// Units.
static const float PADDING = 20, ROW = 24, LEAST_ROW = 20, BETWEEN = 40, GAP = 14, CAP = 14,
                   HEADING = 26, BLOCK_GAP = 8;
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

typedef struct block { // columns under a heading
    const char *heading;
    const entry *list;
    size_t count;
} block;

typedef struct grid { // of all blocks, in pixels
    size_t columns;
    float column, row;
} grid;

static size_t rows_of(const block *b, size_t columns) {
    return (b->count + columns - 1) / columns;
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

static void draw_entry(entry e, ui_rect key, float name) {
    float s = ui_scale(), y = floorf((key.top + key.bottom - label_height()) / 2);
    ui_fill(key, ui_rgba(UI_FIELD, 1), 4 * s);
    ui_frame(key, ui_rgba(UI_LINE, 1), 4 * s, s);
    ui_label(key.left + CAP / 2 * s, y, ui_rgba(UI_TEXT, 1), e.name);
    ui_label(key.left + name, y, ui_rgba(UI_TEXT, 0.8f), e.help);
}

// Returns where the block ends.
static float draw_block(const block *b, float left, float top, const grid *g) {
    float s = ui_scale(), name = name_width(b);
    ui_label(left, top, ui_rgba(UI_ACCENT, 1), b->heading);
    top += HEADING * s;
    size_t rows = rows_of(b, g->columns);
    for (size_t i = 0; i < b->count; i++) {
        entry e = b->list[i];
        float x = left + (float)(i / rows) * (g->column + BETWEEN * s);
        float y = top + (float)(i % rows) * g->row, cap = ui_text_width(e.name) + CAP * s;
        draw_entry(e, (ui_rect){x, y, x + cap, y + g->row - 4 * s}, name);
    }
    return top + (float)rows * g->row;
}

static float height_of(const block *blocks, size_t count, const grid *g) {
    float s = ui_scale(), height = (2 * PADDING - BLOCK_GAP) * s;
    for (size_t i = 0; i < count; i++)
        height += (HEADING + BLOCK_GAP) * s + (float)rows_of(&blocks[i], g->columns) * g->row;
    return height;
}

static float width_of(const grid *g) {
    float s = ui_scale();
    return (float)g->columns * (g->column + BETWEEN * s) + (2 * PADDING - BETWEEN) * s;
}

// In a small window rows are nearer to each other, and there is one column; what still does not fit
// is scrolled.
static grid fit(const block *blocks, size_t count, ui_rect all) {
    float s = ui_scale();
    grid g = {.columns = 2, .row = ROW * s};
    for (size_t i = 0; i < count; i++) g.column = fmaxf(g.column, column_width(&blocks[i]));
    if (width_of(&g) > all.right - all.left) g.columns = 1;
    while (g.row > LEAST_ROW * s && height_of(blocks, count, &g) > all.bottom - all.top) g.row -= s;
    return g;
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
    const ui_rect all = l->whole;
    const grid g = fit(blocks, count, all);
    float s = ui_scale(), width = width_of(&g), height = height_of(blocks, count, &g);
    float left = floorf((all.left + all.right - width) / 2);
    float top = floorf((all.top + all.bottom - height) / 2);
    ui_shade(all);
    ui_card_begin("help", (ui_rect){left, top, left + width, top + height}, 0);
    ui_canvas c = ui_canvas_begin("keys", width - 2 * EDGE * s, height - 2 * EDGE * s);
    left = c.area.left + (PADDING - EDGE) * s;
    top = c.area.top + (PADDING - EDGE) * s;
    for (size_t i = 0; i < count; i++) top = draw_block(&blocks[i], left, top, &g) + BLOCK_GAP * s;
    ui_canvas_end();
    ui_card_end();
}
