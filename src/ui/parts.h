// Parts of the interface that need no ImGui: fonts, icons, numbers as text. Private to src/ui.
#pragma once
#include "ui/ui.h"
#ifdef __cplusplus
extern "C" {
#endif

// ---- font.c -----------------------------------------------------------------------------------

typedef struct font_file {
    void *data; // free with font_free; NULL: no such font is installed
    size_t size;
    int face; // of a collection
} font_file;
typedef enum font_kind { FONT_TEXT, FONT_STRONG, FONT_MONO, FONT_KIND_COUNT } font_kind;
// Reads the installed font that is nearest to the style's. Only outline fonts are used.
font_file font_read(font_kind kind);
void font_free(font_file *file);

// ---- number.c ---------------------------------------------------------------------------------

typedef struct number_range {
    double min, max; // infinite: none
    bool log_scale, whole;
} number_range;
bool number_is_bounded(const number_range *r);
double number_to_share(const number_range *r, double value); // 0 at min to 1 at max
double number_from_share(const number_range *r, double share);
// Rounds a dragged value to the precision that is visible in the range.
double number_round(const number_range *r, double value);
// Returns the value after dragging by `pixels`. `width` is that of the whole slider.
double number_drag(const number_range *r, double value, double pixels, double width);
void number_text(const number_range *r, double value, char *out, size_t capacity);
// Parses a typed number and clamps it to the range. False when it is no number.
bool number_parse(const number_range *r, const char *text, double *out);

// One number at a time is being typed. The user may leave it for another before its own widget is
// drawn, so the typed text waits until then.
typedef struct number_typing {
    uint32_t id; // of the widget; 0: none
    char text[64], first[64];
    uint32_t left_id; // widget that was left with a change
    char left[64];
} number_typing;
void number_type_begin(number_typing *t, uint32_t id, const number_range *r, double value);
void number_type_leave(number_typing *t);
// Returns true when this widget was left and its value has changed.
bool number_type_take(number_typing *t, uint32_t id, const number_range *r, double *value);

// ---- draw.c: the look of widgets ----------------------------------------------------------------

enum { // greys of the style, 0 to 255: neutral, so that they do not affect the judgement of colours
    GREY_RAISED = 54,
    GREY_STEP = 14, // when hovered, and again when held
    GREY_RAISED_HOVER = GREY_RAISED + GREY_STEP,
    GREY_RAISED_ACTIVE = GREY_RAISED_HOVER + GREY_STEP,
    GREY_POPUP = 44,
};
void draw_set_contrast(bool on);
bool draw_contrast(void);
uint32_t draw_grey(int level);
uint32_t draw_enabled(uint32_t color); // the colour, paler where widgets are disabled
// Draws one line within the area, shortened with "...". `align`: 0 left to 1 right.
// (ui_widgets.cpp)
void draw_text(ui_rect area, ui_color color, const char *text, float align);
void draw_text_in(ui_rect area, uint32_t color, const char *text, float align);
void draw_clipped(ui_rect area, ui_rect clip, uint32_t color, float rounding);
void draw_heading(ui_rect area, bool open, bool hovered);
void draw_chevron(float x, float y, bool down);
void draw_switch(ui_rect area, bool on, bool hovered);
void draw_bar(ui_rect area, double value, const number_range *range, const char *unit, bool hovered,
              bool held);
void draw_swatch(ui_rect area, const float *linear, int components);
void draw_icon(int icon, ui_rect area, uint32_t color); // icons.c

// ---- ui_widgets.cpp: parts of widgets.c -------------------------------------------------------

void part_group_begin(const char *id); // a group counts as one item for ui_active, ui_hovered
void part_group_end(const char *id);
void part_space(float width, float height);
void part_same_line(float gap);
bool part_button(const char *label, float width); // 0: as wide as its label
typedef struct part_area {
    ui_rect area;
    bool clicked, hovered, held;
} part_area;
part_area part_area_begin(const char *id, float width); // an invisible button; width 0: a square
void part_changed(void);                                // marks the last item's value as changed
bool *part_flag(const char *id, bool initial);          // a flag stored with the current panel
void part_font_begin(font_kind kind);                   // the font of the following text
void part_font_end(void);
bool part_bar(const char *id, double *value, const number_range *range, const char *unit,
              float width);
void part_text(uint32_t color, const char *text, bool wrapped);
// Like ui_bare, for an area that moves. The pointer's shape shows that it can be dragged sideways.
ui_canvas part_bare_sideways(const char *id, ui_rect area);
void part_popup_open(const char *id);
bool part_popup_begin(const char *id);
void part_popup_end(void);

// ---- widgets.c --------------------------------------------------------------------------------

// Begins a group of a label, if it is shown, and a widget, whose width is returned.
float part_row_begin(const char *label);
void part_row_end(const char *label);
void part_forget_width(void); // drops the width set by ui_width

// ---- picture.c: triangles of a frame for roil_show --------------------------------------------

void picture_begin(void);
size_t picture_vertices(const roil_vertex *vertices, size_t count); // returns the first one's index
void picture_draw(const roil_texture *texture, const float clip[4], const uint16_t *indices,
                  size_t count, size_t first_vertex);
void picture_end(roil_picture *out); // valid until the next begin
void picture_free(void);

// ---- marks.c: $ROIL_WIDGETS, with ui_mark -----------------------------------------------------

void marks_push(const char *id);
void marks_pop(void);
void marks_write(void); // at the end of a frame
void marks_free(void);

// ---- color_picker.c ---------------------------------------------------------------------------

// Prints "#ff8000", and a factor for a colour brighter than white: "#ff8000 x 4".
void color_text(const float linear[3], char *out, size_t capacity);
bool color_picker(float *linear, int components); // inside of a popup

#ifdef __cplusplus
}
#endif
