// What the parts of the window "Slices" share: flow_tools.c has the window, flow_canvas.c the slice
// that one works in, flow_list.c the templates as icons.
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
    // Of the effect, as of this frame: `flow` is one of them.
    roil_slices flows[FLOW_FLOWS];
    size_t flow_count;

    roil_slices_view view;
    size_t fitted;     // flow and field that the range was fitted to; SIZE_MAX: to none
    char failure[256]; // why nothing is seen; "": it is
    roil_texture *texture;
    uint32_t width, height, wanted[2]; // of it, and by now

    flow_tool tool;
    float push_side;       // widths of a slice
    float last[2];         // place of the pointer when it was looked at last,
    double looked;         // and when: clock_seconds
    bool pushing;          // it was held then
    float corner[2];       // where the square was begun
    float middle[2], side; // the square; side 0: none
    char name[48];         // for what is captured

    flow_icon icons[FLOW_TEMPLATES];
    size_t icon_count;
    double next_look;      // at the folders
    roil_template_use use; // of the chosen template: file[] below
    char file[64];         // "": none
    bool put;              // it has been, with `use`
    char line[512];        // for the effect's file; "": none was asked for
};

// Where a flow's slice is on the canvas, and what is done there.
void flow_canvas_draw(live *l, flow_tools *t, float height);

void flow_list_look(flow_tools *t, live *l); // at the folders, now and then; makes some icons
void flow_list_draw(flow_tools *t);
void flow_list_choose(flow_tools *t, const char *file);
roil_texture *flow_list_icon(const flow_tools *t); // of the chosen one; NULL: none
void flow_list_free(flow_tools *t, roil *r);
