// Helpers of the live window's views: text on a canvas that is aligned or shortened, a switch, and
// the places of new windows.
#pragma once
#include "ui/ui.h"

float label_height(void); // of a line of text
float label_row(void);    // of a row of widgets

void label_right(float right, float y, uint32_t color, const char *text);
void label_center(float x, float y, uint32_t color, const char *text);
// Draws text from `left`. What does not fit into `width` is replaced by "...".
void label_within(float left, float y, float width, uint32_t color, const char *text);

// Draws a switch. True when the user switched it. `color` is used while it is on.
bool label_switch(const char *label, bool *on, uint32_t color);

// Returns the area of a new window of that size (units) in the upper left or right corner of the
// view. It is smaller when the view is, down to what its texts need.
ui_rect label_place(ui_rect view, float width, float height, bool right);
