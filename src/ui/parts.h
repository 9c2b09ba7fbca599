// What ui*.cpp are made of and needs no ImGui: fonts, icons, numbers as text. Private to these and
// their parts.
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
// The installed font nearest to what the style wants. Only outlines are taken.
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
// A value dragged to, as round as the range allows one to see.
double number_round(const number_range *r, double value);
// Where `pixels` of dragging lead. `width`: of the whole slider.
double number_drag(const number_range *r, double value, double pixels, double width);
void number_text(const number_range *r, double value, char *out, size_t capacity);
// What was typed: a number within the range; false when it is none.
bool number_parse(const number_range *r, const char *text, double *out);

// One number at a time is typed in. It may be left for another before its own widget is asked, so
// what was typed waits until then.
typedef struct number_typing {
    uint32_t id; // of the widget; 0: none
    char text[64], first[64];
    uint32_t left_id; // of one that was left with a change
    char left[64];
} number_typing;
void number_type_begin(number_typing *t, uint32_t id, const number_range *r, double value);
void number_type_leave(number_typing *t);
// True when this widget was left and its value is another now.
bool number_type_take(number_typing *t, uint32_t id, const number_range *r, double *value);

// ---- draw.c: what widgets look like ------------------------------------------------------------

enum { // greys of the style, 0 to 255: neutral, so that they tint no one's judgement of colour
    GREY_RAISED = 54,
    GREY_STEP = 14, // when hovered, and again when held
    GREY_RAISED_HOVER = GREY_RAISED + GREY_STEP,
    GREY_RAISED_ACTIVE = GREY_RAISED_HOVER + GREY_STEP,
    GREY_POPUP = 44,
};
uint32_t draw_grey(int level);
uint32_t draw_enabled(uint32_t color); // the colour, paler where widgets are disabled
// One line within the area, cut with "..."; `align`: 0 left to 1 right. ui_widgets.cpp has it all.
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

// ---- ui_widgets.cpp: what widgets.c is made of ------------------------------------------------

void part_group_begin(const char *id); // one item to what asks about the last one
void part_group_end(const char *id);
void part_space(float width, float height);
void part_same_line(float gap);
bool part_button(const char *label, float width); // 0: as wide as its label
typedef struct part_area {
    ui_rect area;
    bool clicked, hovered, held;
} part_area;
part_area part_area_begin(const char *id, float width); // to be clicked, not drawn; 0: a square
void part_changed(void);                                // the last item's value
bool *part_flag(const char *id, bool initial);          // that the current panel remembers
void part_font_begin(font_kind kind);                   // text from here on
void part_font_end(void);
bool part_bar(const char *id, double *value, const number_range *range, const char *unit,
              float width);
void part_text(uint32_t color, const char *text);
// ui_bare, though the area moves; its pointer says that it can be drawn sideways.
ui_canvas part_bare_sideways(const char *id, ui_rect area);
void part_popup_open(const char *id);
bool part_popup_begin(const char *id);
void part_popup_end(void);

// ---- widgets.c --------------------------------------------------------------------------------

// A group of a label, if it is shown, and a widget, whose width is returned.
float part_row_begin(const char *label);
void part_row_end(const char *label);
void part_forget_width(void); // that ui_width has said

// ---- picture.c: triangles of a frame, as roil_show takes them ---------------------------------

void picture_begin(void);
size_t picture_vertices(const roil_vertex *vertices, size_t count); // where the first one stands
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

// "#ff8000", of an HDR colour with its factor behind: "#ff8000 x 4".
void color_text(const float linear[3], char *out, size_t capacity);
bool color_picker(float *linear, int components); // inside of a popup

#ifdef __cplusplus
}
#endif
