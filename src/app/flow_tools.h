// Shared by the parts of the window "Slices": flow_tools.c is the window, flow_canvas.c the slice
// that a user works in, flow_list.c the templates as icons.
#pragma once
#include "app/live.h"

enum { FLOW_TEMPLATES = 256, FLOW_FLOWS = 8 };

typedef enum flow_tool { FLOW_PUSH, FLOW_SELECT, FLOW_PUT, FLOW_TOOLS } flow_tool;

typedef struct flow_icon {
    roil_template of;
    bool velocity, failed;
    roil_texture *texture; // NULL: not made yet
} flow_icon;

struct flow_tools {
    // The flows of the effect in this frame; view.flow is one of them.
    roil_slices flows[FLOW_FLOWS];
    size_t flow_count;

    roil_slices_view view;
    size_t fitted;     // flow and field that the range was fitted to; SIZE_MAX: none
    char failure[256]; // why nothing is shown; "": it is shown
    roil_texture *texture;
    uint32_t width, height, wanted[2]; // size of the texture, and the size wanted now

    flow_tool tool;
    float push_side;       // widths of a slice
    float last[2];         // position of the pointer in the last frame,
    double looked;         // and clock_seconds of it
    bool pushing;          // the button was held then
    float corner[2];       // first corner of the square
    float middle[2], side; // the square; side 0: none
    char name[48];         // for a captured template

    flow_icon icons[FLOW_TEMPLATES];
    size_t icon_count;
    double next_look;      // clock_seconds when the folders are read again
    roil_template_use use; // how the chosen template is used
    char file[64];         // the chosen template; "": none
    bool put;              // it was put into the flow, by `use`
    char line[512];        // of Lua, for the effect's file; "": not asked for
};

// Draws a flow's slice on the canvas and handles the pointer there.
void flow_canvas_draw(live *l, flow_tools *t, float height);

void flow_list_look(flow_tools *t, live *l); // reads the folders from time to time; makes icons
void flow_list_draw(flow_tools *t);
void flow_list_choose(flow_tools *t, const char *file);
roil_texture *flow_list_icon(const flow_tools *t); // of the chosen template; NULL: none
void flow_list_free(flow_tools *t, roil *r);
