// F1: what the keys and the mouse do.
#include "app/live.h"
#include <math.h>

// Units.
static const float PADDING = 24, ROW = 26, BETWEEN = 40, GAP = 14, CAP = 14, HEADING = 30;

typedef struct entry {
    const char *name, *help;
} entry;

static const entry mouse[] = {
    {"Drag", "turn the camera"},
    {"Middle drag", "move the camera"},
    {"Wheel", "nearer, farther"},
    {"Drag in the timeline", "choose the frame"},
    {"Shift drag there", "choose the range to loop"},
    {"Double click a number", "type it"},
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

typedef struct widths {
    float name, help;
} widths;

static widths measure(const block *blocks, size_t count) {
    widths w = {0, 0};
    for (size_t b = 0; b < count; b++)
        for (size_t i = 0; i < blocks[b].count; i++) {
            entry e = blocks[b].get(blocks[b].from, i);
            w.name = fmaxf(w.name, ui_text_width(e.name) + CAP * ui_scale());
            w.help = fmaxf(w.help, ui_text_width(e.help));
        }
    return w;
}

static void draw_entry(entry e, float left, float top, const widths *w) {
    float s = ui_scale(), cap = ui_text_width(e.name) + CAP * s;
    ui_rect key = {left, top, left + cap, top + (ROW - 4) * s};
    ui_fill(key, ui_rgba(UI_LINE, 1), 4 * s);
    ui_label(left + CAP / 2 * s, top + 3 * s, ui_rgba(UI_TEXT, 1), e.name);
    ui_label(left + w->name + GAP * s, top + 3 * s, ui_rgba(UI_TEXT, 0.8f), e.help);
}

static float draw_block(const block *b, float left, float top, const widths *w) {
    float s = ui_scale(), column = w->name + GAP * s + w->help + BETWEEN * s;
    ui_label(left, top, ui_rgba(UI_ACCENT, 1), b->heading);
    top += HEADING * s;
    size_t rows = rows_of(b);
    for (size_t i = 0; i < b->count; i++)
        draw_entry(b->get(b->from, i), left + (float)(i / rows) * column,
                   top + (float)(i % rows) * ROW * s, w);
    return top + (float)rows * ROW * s;
}

void help_draw(live *l) {
    if (!l->help) return;
    float s = ui_scale();
    block blocks[] = {{"Keys", NULL, key_of, 0},
                      {"Mouse", mouse, mouse_of, sizeof mouse / sizeof *mouse}};
    enum { BLOCKS = sizeof blocks / sizeof *blocks };
    blocks[0].from = live_keys(&blocks[0].count);
    widths w = measure(blocks, BLOCKS);
    float width = 2 * (w.name + GAP * s + w.help + PADDING * s) + BETWEEN * s;
    float height = (2 * PADDING + BLOCKS * HEADING + PADDING / 2) * s;
    for (size_t b = 0; b < BLOCKS; b++) height += (float)rows_of(&blocks[b]) * ROW * s;
    float left = floorf((l->view.left + l->view.right - width) / 2);
    float top = floorf((l->view.top + l->view.bottom - height) / 2);
    ui_shade(l->view);
    ui_panel_begin("help", (ui_rect){left, top, left + width, top + height});
    ui_canvas c = ui_canvas_begin("keys", 0, 0);
    (void)c;
    float y = draw_block(&blocks[0], left + PADDING * s, top + PADDING * s, &w);
    draw_block(&blocks[1], left + PADDING * s, y + PADDING / 2 * s, &w);
    ui_canvas_end();
    ui_panel_end();
}
