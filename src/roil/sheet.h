// What the parts of sheets share: their maps (sheet.c), files (sheet_write.c), what engines expect
// (sheet_engines.c), the description (sheet_json.c) and the page (sheet_page.c).
#pragma once
#include "media/sheet.h"
#include "roil/roil_impl.h"
#include <jansson.h>

#define SHEET_LEAST (1.0f / 512) // that is seen in a pixel of 8 bits

typedef enum sheet_map {
    SHEET_SHOWN,
    SHEET_SCENE,
    SHEET_MOTION,
    SHEET_RIGHT_TOP_BACK,
    SHEET_LEFT_BOTTOM_FRONT,
    SHEET_EMISSION,
    SHEET_NORMAL,
    SHEET_HEAT, // temperature and depth
    SHEET_MAPS
} sheet_map;

typedef struct sheet_engine { // a row of sheet_engines.c
    const char *name, *title;
    float motion_right, motion_up; // signs of the red and the green channel
    float normal_up;               // sign of the green channel
    const char *alpha;
    const char *steps[8]; // to take there; %s: the file's stem. NULL ends
} sheet_engine;
// NULL with a message that lists them. `name` NULL: the row without signs turned.
const sheet_engine *sheet_find_engine(const char *name);

struct roil_sheet {
    roil_effect *owner;
    effect_sheet passes;
    bool depth, temperature; // are wanted
    sheet maps[SHEET_MAPS];  // premultiplied; `pixels` NULL: not wanted
    uint32_t columns, rows, cell, gutter;
    float height;        // metres, from the lower edge of a cell to the upper
    float distance;      // metres, from the camera's place to the plane of the pivot
    float pivot[2];      // of a cell, 0 to 1 from the top left: where the world's origin is seen
    float axes[3][3];    // in the world: right, up, towards the camera
    budget_part *memory; // of the maps
    // Of a loop: the last cells, what each becomes, and how far it has.
    uint32_t fade;
    sheet before[SHEET_MAPS];
    float *parts;
    bool flows; // these are moved onto each other
    // As written.
    sheet_area area;          // of the cell as it was rendered
    uint32_t used;            // cells
    json_t *files, *settings; // entries of the description; what was set before the camera was
    const char *const *made, *name; // of roil_sheet_options; the name of the first file
    strbuf summary;
    bool saved;
};

typedef struct sheet_file { // one that is being written: values between 0 and 1, or as they are
    const char *suffix;     // "", "-motion"
    const char *what;       // for the description
    const sheet *pixels;
    bool srgb;  // encode red, green and blue for a display
    bool alpha; // has a meaningful fourth channel
} sheet_file;
bool sheet_write_all(roil_sheet *s, const char *file, const roil_sheet_options *options,
                     const sheet_engine *engine);
// Adds the last frame, times a weight, to a cell of `maps`.
bool sheet_take(roil_sheet *s, sheet *maps, uint32_t cell, float weight);
bool sheet_blend(roil_sheet *s, double fps); // the last cells into what they become
void sheet_picture(const sheet *s, uint32_t cell, uint8_t *out); // grey, as an eye sees it
// Fills SHEET_MOTION from the colours of the first `count` cells.
bool sheet_find_flow(roil_sheet *s, uint32_t count, bool loops, double fps);
// Returns how it was made as a line of JSON, for one of its files. mem_free
char *sheet_recipe(const roil_sheet *s, const char *file);
json_t *sheet_text(const char *from); // as UTF-8, which JSON wants: names can be anything
// The description, which the caller owns.
json_t *sheet_describe(const roil_sheet *s, const char *file, const roil_sheet_options *options,
                       const sheet_engine *engine);
// Appends a description as text, with how it was made in a line, as other outputs have it.
void sheet_add_recipe(const roil_sheet *s, const char *file, const char *text, strbuf *out);
bool sheet_write_page(const roil_sheet *s, const char *page, const char *file,
                      json_t *description);     // which gets the page's own `made`
void sheet_stem(const char *file, strbuf *out); // without its extension
