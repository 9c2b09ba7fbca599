// Edits of a palette's stops. Needs no window.
#pragma once
#include "roil.h"

// Adds a stop and returns its index; ROIL_MAX_STOPS when there is no room.
size_t palette_stops_add(roil_palette *p, float at, const float color[4]);
bool palette_stops_remove(roil_palette *p, size_t index);         // false: only two are left
void palette_stops_move(roil_palette *p, size_t index, float at); // stops at its neighbours
// Fits `count` stops (2 to ROIL_MAX_STOPS) to `sample_count` colours that are evenly spaced from
// p->min to p->max. Stops are denser where the colours bend.
void palette_stops_fit(roil_palette *p, const float (*samples)[4], size_t sample_count,
                       size_t count);
