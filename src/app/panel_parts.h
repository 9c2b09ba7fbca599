// Shared by the parts of the panel: panel.c, panel_row.c, presets_panel.c and the two editors.
#pragma once
#include "app/curve_keys.h"
#include "app/live.h"
#include "app/panel_model.h"

enum { PANEL_NAME = 96, PANEL_PRESETS = 64 };

typedef struct shape_state { // the selection in the editor of a palette or a curve
    char name[PANEL_NAME];
    size_t selected; // stop or key; ROIL_MAX_STOPS: none
    int component;   // of the key
    bool dragging;
    bool leaving;         // dragged so far away that releasing removes it
    float grab_x, grab_y; // from the pointer to the middle of the handle, pixels
    plot_range time,
        value; // ranges of the plot, fixed while dragging; `value` of a palette: positions
} shape_state;

typedef struct preset_list {
    char names[PANEL_PRESETS][64];
    size_t count;
    double next_look; // clock_seconds at which the folder is read again
    char name[64];    // typed, or loaded last
    bool asked;       // the user was asked whether to replace it
} preset_list;

// A structural value that is shown before the effect has it.
typedef struct pending_value {
    char name[PANEL_NAME];
    float value[4];
    bool sent;    // it is being built; else its widget is still held
    double until; // clock_seconds when it is given up, since it may never be built
} pending_value;

struct panel {
    char search[128], searched[128]; // the latter: when it was drawn last
    roil_control *controls;
    size_t control_count, control_capacity;
    panel_model model;
    shape_state palette, curve;
    pending_value pending;
    preset_list presets;
};

// ---- panel_row.c ------------------------------------------------------------------------------

// Draws two cells of a table: the label, and the widget for the control's type.
void panel_row(live *l, const roil_control *c);
// Draws the label of an editor's row; the caller draws the second cell.
void panel_label(const char *label);
void panel_reset(live *l, const char *name); // NULL: all controls
// Draws the buttons that reset a palette or a curve, and copy it.
void panel_shape_buttons(live *l, const char *name);
void panel_table_begin(const char *id); // begins a table of rows; end it with ui_table_end

// ---- presets_panel.c --------------------------------------------------------------------------

void presets_draw(live *l); // two lines of widgets

// ---- editors ----------------------------------------------------------------------------------

// Several editors are drawn. Only the state of the one that was used last is kept; the others get a
// new one. Each gives its state back when it was drawn.
shape_state shape_state_take(const shape_state *kept, const char *name);
void shape_state_give(shape_state *kept, const shape_state *state);
