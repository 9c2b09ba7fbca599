// Pictures that were drawn, by the number of their frame, kept to be shown again at once.
#pragma once
#include "roil.h"

typedef struct film {
    roil_still **stills; // [i]: of frame `first` + i; NULL: it is not kept
    size_t count;        // frames of the effect
    double first;
    uint64_t bytes; // of all
} film;

void film_set_range(film *f, roil *r, double first, double last); // another one forgets all
void film_clear(film *f, roil *r);
// Makes room for another picture of `bytes` beside the frame `near`: it takes at most a quarter of
// the memory that there is for all, and half of what is left of that. Frames that are farthest from
// `near` go first. False: there is none.
bool film_make_room(film *f, roil *r, double near, uint64_t bytes);
void film_put(film *f, roil *r, double frame, roil_still *still); // takes it over
roil_still *film_get(const film *f, double frame);                // NULL: it is not kept
