// Widgets for the live window: a C interface to Dear ImGui, which only ui*.cpp use.
//
// Each frame, the window's contents are declared between ui_begin and ui_end; what the user did is
// returned by the widgets. There is one window and one state, which belongs to one thread.
// Positions and lengths are window pixels; multiply lengths in units of the style by ui_scale().
// Labels follow ImGui: text after "##" is not shown, and distinguishes equal labels. A visible
// label is drawn to the left of its choice, input, number or colour, in a column of 2/5 of the
// width, so that labels below each other align. A toggle's label is drawn so when ui_width was
// called for it, and else to the right of the toggle.
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

typedef enum ui_color { // colours of the style; ui_rgba returns them as numbers
    UI_TEXT,
    UI_DIM,    // secondary text: units, hints
    UI_ACCENT, // active or changed
    UI_GOOD,
    UI_WARNING,
    UI_ERROR,
    UI_PANEL, // background of panels
    UI_FIELD, // background of sliders, plots, canvases
    UI_LINE,  // separators, grids
    UI_COLOR_COUNT
} ui_color;

// ---- lifetime ---------------------------------------------------------------------------------

// Opens the interface. `layout` is a file that stores the positions of floating windows, or NULL.
// It installs input callbacks, which also call those that were set before. False with a message
// when there is no font.
bool ui_open(GLFWwindow *window, roil *r, const char *layout);
void ui_close(void);
void ui_set_scale(float scale); // pixels per unit, for high-DPI displays; call between frames
float ui_scale(void);
void ui_set_contrast(bool on); // black, white and lines; call between frames
// Lets keys walk through the widgets of a panel: arrows and Tab from one to the next, Enter uses
// it.
void ui_walk(const char *panel); // NULL: no longer
bool ui_walks(void);
bool ui_types(void); // text is being typed
// Sets a callback for each key that goes down or repeats. ui_begin calls it, in order with the
// other input.
void ui_on_key(void (*key)(void *user, int key, int mods, bool again), void *user);
bool ui_pending(void); // there is input that the last frame could not take: draw another frame
bool ui_acts(void);    // ... and it is more than moves of the pointer
void ui_begin(void);
void ui_end(roil_picture *out); // fills in the triangles; valid until the next ui_begin
bool ui_wants_keys(void);       // text is being typed, a popup is open, or they walk
bool ui_held(void); // a mouse button that was pressed before is down, or was let go just now
void ui_copy(const char *text); // copies to the clipboard

// ---- windows and layout -----------------------------------------------------------------------

// A panel is a fixed part of the window. Its content scrolls when it does not fit.
void ui_panel_begin(const char *name, ui_rect where);
void ui_panel_end(void);
// A card is a panel above everything else, which is moved to lie within the window. `edge` is the
// colour of a line along its left side; 0: none.
void ui_card_begin(const char *name, ui_rect where, uint32_t edge);
void ui_card_end(void);
// A floating window; `*open` becomes false when the user closes it. False: there is nothing to
// draw, but ui_window_end must be called. `where` is its first position. fixed: it is as large as
// its content.
bool ui_window_begin(const char *title, bool *open, ui_rect where, bool fixed);
void ui_window_end(void);
void ui_scroll_to_top(void); // of the panel or window
ui_rect ui_space(void);      // the rest of the current panel or window, from the cursor
void ui_same_line(void);
void ui_align_right(float width); // the next widget, of that width, ends at the right edge
void ui_gap(float height);
void ui_separator(void);
// Sets the width of the next widget with its label. 0: the rest of the line; negative: the rest
// without so much.
void ui_width(float width);
void ui_push(const char *id); // until ui_pop: distinguishes widgets with equal labels
void ui_pop(void);
void ui_disable_begin(bool disabled);
void ui_disable_end(void);
// Draws a heading that can be opened and closed; true while it is open. `open` is its first state.
bool ui_section(const char *label, bool open);
// A table has rows of `columns` cells with relative widths.
void ui_table_begin(const char *id, int columns, const float *widths);
void ui_table_next(void); // goes to the next cell
void ui_table_end(void);

// ---- text -------------------------------------------------------------------------------------

void ui_text(const char *format, ...) __attribute__((format(printf, 1, 2)));
void ui_text_color(ui_color color, const char *format, ...) __attribute__((format(printf, 2, 3)));
void ui_text_wrapped(const char *text);
void ui_text_mono(ui_color color, const char *text, bool wrapped); // code: a monospaced font
float ui_mono_width(void);                                         // of a letter of it
void ui_tooltip(const char *text);                                 // of the last widget
float ui_text_width(const char *text);
float ui_line_height(void);

// ---- widgets; true when the user changed the value in this frame ------------------------------

bool ui_button(const char *label);
bool ui_small_button(const char *label);
bool ui_icon_button(const char *id, int icon, bool active, const char *tooltip); // a ui_icon
bool ui_toggle(const char *label, bool *value);
bool ui_choice(const char *label, size_t *index, const char *const *words, size_t count);
bool ui_input(const char *label, const char *hint, char *text, size_t capacity);
// `unit` is shown after the number. With a finite range this is a slider, else a field to drag in.
// A double click lets the user type a value.
bool ui_number(const char *label, float *value, int components, float min, float max,
               bool log_scale, const char *unit);
// INT_MIN and INT_MAX mean no limit.
bool ui_whole(const char *label, int *value, int min, int max, const char *unit);
bool ui_color_edit(const char *label, float *linear, int components); // linear Rec.709, HDR
bool ui_active(void);  // the user is changing the last widget
bool ui_hovered(void); // the pointer is over the last widget
// Opens a menu on a right click of the last widget. If it is open (true), add ui_item and call
// ui_menu_end.
bool ui_menu_begin(const char *id);
void ui_menu_end(void);
bool ui_item(const char *label);
// A row of a list, as wide as the window. True: it was clicked.
bool ui_row(const char *label, bool chosen, bool dim);

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
    UI_ICON_REMOVE,
    UI_ICON_COUNT
} ui_icon;

// ---- canvas: an area that is drawn to and takes clicks ----------------------------------------

typedef struct ui_canvas {
    ui_rect area;
    float x, y; // position of the pointer
    bool hovered;
    bool pressed, held, released; // left button, if it went down on the canvas
    bool right_pressed, double_clicked;
    bool middle_held;
    float dx, dy; // movement of the pointer since the last frame
    float wheel;
    bool shift, control;
} ui_canvas;
// Width 0: the rest of the line; height 0: the rest of the panel. In a floating window only the
// canvas gets the wheel; in a panel the wheel also scrolls the panel.
ui_canvas ui_canvas_begin(const char *id, float width, float height);
void ui_canvas_end(void);
// Returns the input in an area that no panel covers. Call it outside of panels.
ui_canvas ui_bare(ui_rect area);
// Records the area of something without an id, for programs that operate the window, such as tests:
// the areas of all widgets are written to the file $ROIL_WIDGETS, if that is set.
void ui_mark(const char *name, ui_rect area);
// A vertical bar between panels; `position` is its middle. True while the user drags it.
bool ui_splitter(ui_rect area, float *position);

uint32_t ui_rgba(ui_color color, float alpha);
uint32_t ui_pack(const float rgb[3], float alpha); // linear Rec.709, clamped
void ui_line(float x0, float y0, float x1, float y1, uint32_t color, float width);
void ui_polyline(const float *xy, size_t count, uint32_t color, float width);
void ui_fill(ui_rect area, uint32_t color, float rounding);
void ui_frame(ui_rect area, uint32_t color, float rounding, float width);
void ui_gradient(ui_rect area, uint32_t left, uint32_t right);
void ui_checkers(ui_rect area, float size); // a checkerboard behind transparent content
void ui_triangle(float x0, float y0, float x1, float y1, float x2, float y2, uint32_t color);
void ui_disc(float x, float y, float radius, uint32_t color);
void ui_ring(float x, float y, float radius, uint32_t color, float width);
void ui_label(float x, float y, uint32_t color, const char *text);
void ui_image(ui_rect area, const roil_texture *texture);
void ui_shade(ui_rect area); // dims what was drawn behind the panels, as under a message

#ifdef __cplusplus
}
#endif
