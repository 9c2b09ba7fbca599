// What the picture of the live window shows of space besides the effect: handles of things, that
// can be dragged, a ground grid, and paths.
#pragma once
#include "app/lens.h"
#include "app/live.h"

bool view_lens(const live *l, lens *out); // false: there is no effect
// How far the eye would be from what it looks at with a lens of 40 degrees (m).
float near_distance(const roil_camera *c);
float ground_step(const live *l); // between two lines of the grid (m)
void ground_draw(const live *l, const lens *view);
