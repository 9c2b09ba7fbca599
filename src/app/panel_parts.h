// What the parts of the panel share: panel.c, panel_row.c, presets_panel.c and the two editors.
#pragma once
#include "app/curve_keys.h"
#include "app/live.h"
#include "app/panel_model.h"

enum { PANEL_NAME = 96, PANEL_PRESETS = 64 };

typedef struct shape_state { // what is selected in the editor of a palette or a curve
    char name[PANEL_NAME];
    size_t selected; // stop or key; ROIL_MAX_STOPS: none
    int component;   // of the key
    bool dragging;
    bool leaving;           // dragged so far away that it goes when it is let go
    float grab_x, grab_y;   // from the pointer to the middle of the handle, pixels
    plot_range time, value; // of the plot, held while dragging; of a palette `value` is positions
} shape_state;

typedef struct preset_list {
    char names[PANEL_PRESETS][64];
    size_t count;
    double next_look; // clock_seconds at which the folder is read again
    char name[64];    // typed, or loaded last
    bool asked;       // whether it may be written over
} preset_list;

// A structural value that is shown though the effect does not have it yet.
typedef struct pending_value {
    char name[PANEL_NAME];
    float value[4];
    bool sent;    // being built; else its widget is still held
    double until; // clock_seconds at which it is given up: it may never be built
} pending_value;

struct panel {
    char search[128];
    roil_control *controls;
    size_t control_count, control_capacity;
    panel_model model;
    shape_state palette, curve;
    pending_value pending;
    preset_list presets;
};

// ---- panel_row.c ------------------------------------------------------------------------------

// Two cells of a table: the label, and the widget of the control's type.
void panel_row(live *l, const roil_control *c);
// A row of an editor: leaves its second cell to be drawn.
void panel_label(const char *label);
void panel_reset(live *l, const char *name); // NULL: all
void panel_copy_lua(live *l, const char *name);
// Buttons that reset a palette or a curve, and copy it.
void panel_shape_buttons(live *l, const char *name);
void panel_table_begin(const char *id); // of rows; end with ui_table_end

// ---- presets_panel.c --------------------------------------------------------------------------

void presets_draw(live *l); // two lines of widgets

// ---- editors ----------------------------------------------------------------------------------

// Several editors are drawn, and one of them was used last: its state is kept, the others have a
// fresh one. Given back when the editor is drawn.
shape_state shape_state_take(const shape_state *kept, const char *name);
void shape_state_give(shape_state *kept, const shape_state *state);
