// What ui.cpp is made of and needs no ImGui: fonts, icons, numbers as text. Private to ui.cpp and
// its parts.
#pragma once
#include "app/ui.h"
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

// ---- icons.c ----------------------------------------------------------------------------------

void icon_draw(int icon, ui_rect area, uint32_t color);

// ---- color_picker.c ---------------------------------------------------------------------------

// "#ff8000", of an HDR colour with its factor behind: "#ff8000 x4".
void color_text(const float linear[3], char *out, size_t capacity);
bool color_picker(float *linear, int components); // inside of a popup

#ifdef __cplusplus
}
#endif
