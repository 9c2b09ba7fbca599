// Text on a canvas that ends, is centred, or has no more room than it is given.
#pragma once
#include "app/ui.h"

void label_right(float right, float y, uint32_t color, const char *text);
void label_center(float x, float y, uint32_t color, const char *text);
// From `left`; what does not fit into `width` is left out, with "..." in its place.
void label_within(float left, float y, float width, uint32_t color, const char *text);
