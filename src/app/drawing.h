// The effect's pictures: when they are drawn, and which of them is shown (drawing.c). A turn of the
// window's loop finishes, may use the effect if nothing is at work, begins, and shows.
#pragma once
#include "app/live.h"

drawing *drawing_create(void);
void drawing_destroy(drawing *d, roil *r);
// Takes the frame that is at work, if it is done. False: it is not, and nothing of the effect may
// use the device.
bool drawing_finish(live *l);
void drawing_begin(live *l);                   // draws the frame of now, if it is wanted
void drawing_show(live *l, roil_picture *out); // puts the picture of now, or the nearest, there
void drawing_end(live *l);             // waits a moment for the frame at work, then gives it up
bool drawing_is_wanted(const live *l); // there is no picture of now, or it is an old one
bool drawing_is_there(const live *l);  // the effect has a picture
bool drawing_is_whole(const live *l);  // ... of now, for which nothing was late
// Finds the next frames, one after the other, whose pictures are kept. False: none from `from` on.
bool drawing_find_kept(const live *l, double from, double *first, double *last);
// Something other than time has changed, so that no picture is as it would be drawn now.
void drawing_forget(live *l);
void drawing_lose(live *l, bool keep); // the effect has no picture; `keep`: others still hold
// Returns whether a frame is at work. `frame` and `seconds` receive which, and for how long;
// `usual` how long the last one took, 0: not known.
// Another branch goes on: what is kept is put into `from`, and `to` is what is kept from now on.
typedef struct film film;
void drawing_exchange(live *l, film *from, film *to);
bool drawing_is_busy(const live *l, double *frame, double *seconds, double *usual);
uint64_t drawing_count(const live *l); // frames that were drawn so far
bool drawing_works(const live *l);     // a frame is at work
bool drawing_is_behind(const live *l); // a simulation has not come to the time of now
