// Templates of slices (pass/templates.h): a group is a pass of the type `slices_templates`; all
// groups of a flow, in all of its slices, are drawn by one dispatch before each step of the solver.
#pragma once
#include "base/str.h"
#include "pass/templates.h"

// A group of `count` templates in each slice of `p`, a pass `slices`; both are declared. The
// picture lives as long as the effect.
bool slices_add_templates(pass *p, pass *group, const picture *image, uint32_t count);
// Whether there are templates of pressure, which are the solver's FlowTemplates, or of velocity,
// which add to its FlowSources, or write these where the flow has no inflow and no force.
bool slices_has_pressing(const pass *p);
bool slices_has_pushing(const pass *p);

// ---- by hand ----------------------------------------------------------------------------------
//
// What the tools of a live window need: a template is put where one clicks, the flow is pushed
// where one drags, and a square of it becomes a picture. Once the window has a template it likes,
// it writes the picture (media/picture.h) and the line for the effect's file.

enum { SLICES_HAND_MOST = 8, SLICES_ALL = -1 };

typedef struct slices_hand {
    const picture *image; // lives until the flow is destroyed; NULL: a push to the upper edge
    bool pushes;          // its velocity, as a force; else its pressure
    int slice;            // from 0, or SLICES_ALL
    float place[2], size; // middle, side (widths of a slice)
    float angle;          // degrees, anticlockwise
    float strength;       // m/s^2, or m^2/s^2
    float blend;          // of the alpha of pressure, as the uniform of that name
    double lifetime;      // seconds of the simulation; 0: one step
} slices_hand;

// Before pass_complete of the flow: templates may be put by hand. A step then takes a little
// longer, whether there are any or not.
void slices_take_hand(pass *p);
// From the next step on. Beyond SLICES_HAND_MOST the one that would end first makes room. False
// with a message: the flow was not made ready for it.
bool slices_put(pass *p, const slices_hand *hand);
// What the flow is like in a square of a slice after the last kept step, as a picture of
// TEMPLATE_TILE pixels a side: velocity, pressure less its mean along the border, and alpha that
// fades as those of the library do. Both kinds reach from -1 to 1; `scale`: what 1 stands for, m/s
// and m^2/s^2. Not in a frame: waits for the device. False with a message.
bool slices_capture(const pass *p, uint32_t slice, const float place[2], float size, arena *memory,
                    picture *out, float scale[2]);
// The line for the effect's file that puts it there all the time: `variable` is that of the
// slices, `file` that of the picture.
void slices_hand_line(const slices_hand *hand, const char *variable, const char *file, strbuf *out);

// ---- on the device ----------------------------------------------------------------------------

// Of the instances on the device; shaders/pass/slices/templates.glsl says how they lie there. NULL:
// not allocated, or there are none but by hand.
gpu_buffer *slices_templates_buffer(const pass *p);
