// Widgets for the live window: a C face of Dear ImGui (only ui*.cpp know it).
//
// Between ui_begin and ui_end the window's contents are said anew each frame; what a user did comes
// back as return values. There is one window, so there is one state, and it is of one thread.
// Positions and lengths are window pixels; think of lengths in units of the style and multiply them
// by ui_scale().
// Labels follow ImGui: what stands behind "##" is not shown but tells equal labels apart.
// A label that is shown stands left of its choice, input, number or colour, in a column of 2/5 of
// the width, so that those below each other align; a toggle's does so when ui_width was called for
// it, and else stands behind it.
#pragma once
#include "roil.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct GLFWwindow GLFWwindow;

typedef struct ui_rect {
    float left, top, right, bottom;
} ui_rect;

typedef enum ui_color { // of the style; ui_rgba gives it as a number
    UI_TEXT,
    UI_DIM,    // secondary text: units, hints
    UI_ACCENT, // what is active or was changed
    UI_GOOD,
    UI_WARNING,
    UI_ERROR,
    UI_PANEL, // background of panels
    UI_FIELD, // background of sliders, plots, canvases
    UI_LINE,  // separators, grids
    UI_COLOR_COUNT
} ui_color;

// ---- life -------------------------------------------------------------------------------------

// `layout`: file that keeps where floating windows lie, or NULL. Takes the window's input
// callbacks, calling those that were set before. False with a message when there is no font at all.
bool ui_open(GLFWwindow *window, roil *r, const char *layout);
void ui_close(void);
void ui_set_scale(float scale); // pixels a unit, as of a high-DPI display; between frames
float ui_scale(void);
// Calls back, in ui_begin, for each key that went down or repeats, in its turn among all that the
// user does.
void ui_on_key(void (*key)(void *user, int key, int mods, bool again), void *user);
bool ui_pending(void); // more was done than the last frame could tell apart: draw another
void ui_begin(void);
void ui_end(roil_picture *out); // fills in what is drawn; valid until the next ui_begin
bool ui_wants_keys(void);       // text is being typed
void ui_copy(const char *text); // to the clipboard

// ---- windows and layout -----------------------------------------------------------------------

// A part of the window that does not move. Content scrolls when it does not fit.
void ui_panel_begin(const char *name, ui_rect where);
void ui_panel_end(void);
// The same for what is said over all the rest: it lies on top, and is moved into the window.
// `edge`: colour of a line along its left side; 0: none.
void ui_card_begin(const char *name, ui_rect where, uint32_t edge);
void ui_card_end(void);
// A window that the user moves; `*open` becomes false when it is closed. False: nothing to draw,
// but end it all the same. `where` holds for the first time only. fixed: as large as its content.
bool ui_window_begin(const char *title, bool *open, ui_rect where, bool fixed);
void ui_window_end(void);
ui_rect ui_space(void); // what is left of the current panel or window, from the cursor
void ui_same_line(void);
void ui_align_right(float width); // the next widget, of that width, ends at the right edge
void ui_gap(float height);
void ui_separator(void);
// Of the next widget, with its label; 0: the rest of the line; negative: leave that much.
void ui_width(float width);
void ui_push(const char *id); // tells widgets of equal labels apart, with ui_pop
void ui_pop(void);
void ui_disable_begin(bool disabled);
void ui_disable_end(void);
// A heading that opens and closes; true while it is open. `open`: at first.
bool ui_section(const char *label, bool open);
// Rows of `columns` cells of the given relative widths.
void ui_table_begin(const char *id, int columns, const float *widths);
void ui_table_next(void); // cell
void ui_table_end(void);

// ---- text -------------------------------------------------------------------------------------

void ui_text(const char *format, ...) __attribute__((format(printf, 1, 2)));
void ui_text_color(ui_color color, const char *format, ...) __attribute__((format(printf, 2, 3)));
void ui_text_wrapped(const char *text);
void ui_text_mono(ui_color color, const char *text); // code, of fixed width, lines kept
void ui_tooltip(const char *text);                   // over the last widget
float ui_text_width(const char *text);
float ui_line_height(void);

// ---- widgets; true when the user changed the value in this frame ------------------------------

bool ui_button(const char *label);
bool ui_small_button(const char *label);
bool ui_icon_button(const char *id, int icon, bool active, const char *tooltip); // a ui_icon
bool ui_toggle(const char *label, bool *value);
bool ui_choice(const char *label, size_t *index, const char *const *words, size_t count);
bool ui_input(const char *label, const char *hint, char *text, size_t capacity);
// `unit` is shown behind the number. A finite range makes a slider, else a field to drag in; both
// take a typed value on a double click.
bool ui_number(const char *label, float *value, int components, float min, float max,
               bool log_scale, const char *unit);
// INT_MIN and INT_MAX stand for no end.
bool ui_whole(const char *label, int *value, int min, int max, const char *unit);
bool ui_color_edit(const char *label, float *linear, int components); // linear Rec.709, HDR
bool ui_active(void);  // the last widget is being used
bool ui_hovered(void); // the last widget
// On a right click of the last widget; when true: ui_item, then ui_menu_end.
bool ui_menu_begin(const char *id);
void ui_menu_end(void);
bool ui_item(const char *label);

typedef enum ui_icon {
    UI_ICON_PLAY,
    UI_ICON_PAUSE,
    UI_ICON_BACK, // one frame
    UI_ICON_FORWARD,
    UI_ICON_START,
    UI_ICON_END,
    UI_ICON_LOOP,
    UI_ICON_RESET,
    UI_ICON_COPY,
    UI_ICON_COUNT
} ui_icon;

// ---- canvas: a place to draw in and to be clicked ---------------------------------------------

typedef struct ui_canvas {
    ui_rect area;
    float x, y; // of the pointer
    bool hovered;
    bool pressed, held, released; // left button, pressed on the canvas
    bool right_pressed, double_clicked;
    bool middle_held;
    float dx, dy; // pointer's way since the last frame
    float wheel;
    bool shift, control;
} ui_canvas;
// Width 0: the rest of the line; height 0: the rest of the panel. In a window that moves, the wheel
// is the canvas's own; in a panel it scrolls the panel too.
ui_canvas ui_canvas_begin(const char *id, float width, float height);
void ui_canvas_end(void);
// What a user does in a part of the window that no panel covers. Outside of panels.
ui_canvas ui_bare(ui_rect area);
// Tells programs that work the window, as its tests do, where something is that has no id of its
// own: rectangles of all that can be used go to the file $ROIL_WIDGETS, if that is set.
void ui_mark(const char *name, ui_rect area);
// An upright bar between panels, `position` is its middle; true while it is dragged.
bool ui_splitter(ui_rect area, float *position);

uint32_t ui_rgba(ui_color color, float alpha);
uint32_t ui_pack(const float rgb[3], float alpha); // linear Rec.709, clamped
void ui_line(float x0, float y0, float x1, float y1, uint32_t color, float width);
void ui_polyline(const float *xy, size_t count, uint32_t color, float width);
void ui_fill(ui_rect area, uint32_t color, float rounding);
void ui_frame(ui_rect area, uint32_t color, float rounding, float width);
void ui_gradient(ui_rect area, uint32_t left, uint32_t right);
void ui_checkers(ui_rect area, float size); // what is seen through transparency
void ui_triangle(float x0, float y0, float x1, float y1, float x2, float y2, uint32_t color);
void ui_disc(float x, float y, float radius, uint32_t color);
void ui_ring(float x, float y, float radius, uint32_t color, float width);
void ui_label(float x, float y, uint32_t color, const char *text);
void ui_image(ui_rect area, const roil_texture *texture);
void ui_shade(ui_rect area); // dims all that was drawn behind the panels, as under a message

#ifdef __cplusplus
}
#endif
