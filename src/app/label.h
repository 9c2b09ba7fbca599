// Text on a canvas that ends, is centred, or has no more room than it is given; and a switch that
// is its own label.
#pragma once
#include "app/ui.h"

float label_height(void); // of a line of text
float label_row(void);    // of a row of widgets

void label_right(float right, float y, uint32_t color, const char *text);
void label_center(float x, float y, uint32_t color, const char *text);
// From `left`; what does not fit into `width` is left out, with "..." in its place.
void label_within(float left, float y, float width, uint32_t color, const char *text);

// True when it was switched. `color`: its own while it is on.
bool label_switch(const char *label, bool *on, uint32_t color);
