// Edits of a palette's stops. Knows no window.
#pragma once
#include "roil.h"

// Index of the new stop; ROIL_MAX_STOPS when there is no room.
size_t palette_stops_add(roil_palette *p, float at, const float color[4]);
bool palette_stops_remove(roil_palette *p, size_t index);         // false: two stay
void palette_stops_move(roil_palette *p, size_t index, float at); // as far as its neighbours
// `count` stops (2 to ROIL_MAX_STOPS) that follow the `sample_count` colours, evenly spread over
// p->min to p->max: denser where the colours bend.
void palette_stops_fit(roil_palette *p, const float (*samples)[4], size_t sample_count,
                       size_t count);
