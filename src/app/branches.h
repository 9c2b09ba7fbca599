// Branches: what goes on from one frame with other settings. Each keeps its settings, its pictures,
// its snapshots and what can be undone in it. Two of them can be compared, side by side.
#pragma once
#include "app/live.h"

branches *branches_create(void);
void branches_destroy(branches *b, roil *r);
void branches_fork(live *l);       // branches off from the frame of now
void branches_next(live *l);       // goes to the next one
void branches_compare(live *l);    // shows this one and another side by side, or ends that
void branches_update(live *l);     // does what was asked for; call it while nothing is at work
bool branches_wait(const live *l); // the effect's own picture of now is needed for that
// The pictures of the others are not as they would be drawn now: the camera has moved.
void branches_forget(live *l);
void branches_reload(live *l); // the effect was loaded anew, and states of the old one do not hold
bool branches_input(live *l, const ui_canvas *view); // true: the pointer is at the line between two
// Draws the line between two that are compared, and their names; and the buttons.
void branches_draw(live *l);
void branches_draw_buttons(live *l);
void branches_show(live *l, roil_picture *out); // the other one, if two are compared
