// The content of the panel: the controls of an effect in sections, those that match a search, and
// values as text. Needs no window.
#pragma once
#include "base/str.h"
#include "roil.h"

typedef enum panel_part {
    PANEL_PARAMETERS, // parameters without a group
    PANEL_GROUP,      // a group of parameters
    PANEL_SHAPE,      // one palette or curve
    PANEL_FIELD,      // numbers of one field
    PANEL_CAMERA,
    PANEL_SUN,
    PANEL_SKY,
    PANEL_OBJECT, // one light, material, node, mesh or volume
    PANEL_PASS,   // one pass: options, then uniforms
    PANEL_PART_COUNT
} panel_part;

typedef struct panel_section {
    panel_part part;
    const char *title;
    size_t first, count; // range of rows
    size_t moved;        // number of its rows that differ from the script
} panel_section;

typedef struct panel_model { // zero at first
    panel_section *sections;
    size_t section_count, section_capacity;
    size_t *rows; // indices of controls, section by section
    size_t row_count, row_capacity;
    bool *shown; // of each control
    size_t shown_capacity;
} panel_model;

// Fills the model with the controls that match `search`. Empty sections are left out. Titles live
// as long as the controls.
void panel_model_fill(panel_model *m, const roil_control *controls, size_t count,
                      const char *search);
void panel_model_free(panel_model *m);

// Returns whether each word of `search` is part of the name, label, help or group, ignoring case.
bool panel_matches(const roil_control *c, const char *search);

// ---- text -------------------------------------------------------------------------------------

enum { PANEL_NUMBER = 24 };
void panel_number(float value,
                  char out[PANEL_NUMBER]); // the shortest text that reads back the same
// Prints a value as roil_set takes it; nothing for palettes and curves.
void panel_value_text(const roil_control *c, const float value[4], strbuf *out);
// Prints a value for people: four digits and the unit.
void panel_value_shown(const roil_control *c, const float value[4], strbuf *out);
void panel_help_text(const roil_control *c, strbuf *out); // help; name, range, default, unit

// Copies the text, and shortens it with "..." to fit into `width` as measured by `measure`. False
// when it was shortened.
bool panel_shorten(const char *text, float width, float (*measure)(const char *text), char *out,
                   size_t capacity);
