// What the views of the live window share: text on a canvas that ends, is centred, or has no more
// room than it is given; a switch that is its own label; where a window is opened.
#pragma once
#include "ui/ui.h"

float label_height(void); // of a line of text
float label_row(void);    // of a row of widgets

void label_right(float right, float y, uint32_t color, const char *text);
void label_center(float x, float y, uint32_t color, const char *text);
// From `left`; what does not fit into `width` is left out, with "..." in its place.
void label_within(float left, float y, float width, uint32_t color, const char *text);

// True when it was switched. `color`: its own while it is on.
bool label_switch(const char *label, bool *on, uint32_t color);

// For a window of that size, in units, in the upper left or right corner of the view; smaller when
// the view is.
ui_rect label_place(ui_rect view, float width, float height, bool right);
