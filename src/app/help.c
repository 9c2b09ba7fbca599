// F1: what the keys and the mouse do.
#include "app/live.h"
#include <math.h>

// Units.
static const float PADDING = 24, ROW = 26, BETWEEN = 40, GAP = 14, CAP = 14, HEADING = 30,
                   BLOCK_GAP = 12;
static const float EDGE = 12; // of PADDING, what a card has itself

typedef struct entry {
    const char *name, *help;
} entry;

static const entry mouse[] = {
    {"Drag", "turn the camera"},
    {"Shift drag", "move the camera"},
    {"Wheel", "nearer, farther"},
    {"Double click", "frame the volume"},
    {"Drag in the timeline", "choose the frame"},
    {"Shift drag there", "choose the range to loop"},
    {"Double click a number", "type it"},
    {"Right click a value", "reset it, copy it as Lua"},
};

static entry key_of(const void *from, size_t i) {
    const live_key *key = (const live_key *)from + i;
    return (entry){key->name, key->help};
}

static entry mouse_of(const void *from, size_t i) {
    return ((const entry *)from)[i];
}

typedef struct block { // two columns under a heading
    const char *heading;
    const void *from;
    entry (*get)(const void *from, size_t i);
    size_t count;
} block;

static size_t rows_of(const block *b) {
    return (b->count + 1) / 2;
}

static float name_width(const block *b) {
    float width = 0;
    for (size_t i = 0; i < b->count; i++)
        width = fmaxf(width, ui_text_width(b->get(b->from, i).name) + (CAP + GAP) * ui_scale());
    return width;
}

static float column_width(const block *b) {
    float width = 0;
    for (size_t i = 0; i < b->count; i++)
        width = fmaxf(width, ui_text_width(b->get(b->from, i).help));
    return name_width(b) + width;
}

static void draw_entry(entry e, float left, float top, float name) {
    float s = ui_scale(), cap = ui_text_width(e.name) + CAP * s;
    ui_rect key = {left, top, left + cap, top + (ROW - 4) * s};
    ui_fill(key, ui_rgba(UI_LINE, 1), 4 * s);
    ui_label(left + CAP / 2 * s, top + 3 * s, ui_rgba(UI_TEXT, 1), e.name);
    ui_label(left + name, top + 3 * s, ui_rgba(UI_TEXT, 0.8f), e.help);
}

// Columns of all blocks are as wide. Returns where the block ends.
static float draw_block(const block *b, float left, float top, float column) {
    float s = ui_scale(), name = name_width(b);
    ui_label(left, top, ui_rgba(UI_ACCENT, 1), b->heading);
    top += HEADING * s;
    size_t rows = rows_of(b);
    for (size_t i = 0; i < b->count; i++)
        draw_entry(b->get(b->from, i), left + (float)(i / rows) * (column + BETWEEN * s),
                   top + (float)(i % rows) * ROW * s, name);
    return top + (float)rows * ROW * s;
}

void help_draw(live *l) {
    if (!l->help) return;
    block keys = {"Keys", NULL, key_of, 0};
    const block hands = {"Mouse", mouse, mouse_of, sizeof mouse / sizeof *mouse};
    keys.from = live_keys(&keys.count);
    float s = ui_scale(), column = fmaxf(column_width(&keys), column_width(&hands));
    float rows = (float)(rows_of(&keys) + rows_of(&hands));
    float width = 2 * (column + PADDING * s) + BETWEEN * s;
    float height = (2 * PADDING + 2 * HEADING + BLOCK_GAP + rows * ROW) * s;
    float left = floorf((l->view.left + l->view.right - width) / 2);
    float top = floorf((l->view.top + l->view.bottom - height) / 2);
    ui_shade(l->view);
    ui_card_begin("help", (ui_rect){left, top, left + width, top + height}, 0);
    ui_canvas c = ui_canvas_begin("keys", width - 2 * EDGE * s, height - 2 * EDGE * s);
    left = c.area.left + (PADDING - EDGE) * s;
    top = draw_block(&keys, left, c.area.top + (PADDING - EDGE) * s, column);
    draw_block(&hands, left, top + BLOCK_GAP * s, column);
    ui_canvas_end();
    ui_card_end();
}
