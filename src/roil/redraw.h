// Which parts of a window differ from the picture before, so that no more than these is drawn. A
// processor that draws the window spends most of a picture on what is as it was.
//
// The window is cut into tiles. A hash stands for all that is drawn into a tile: what lies below
// the interface there, and each triangle whose box touches it, in their order. A tile of the same
// hash looks the same.
#pragma once
#include "gpu/gpu.h"
#include "roil.h"

enum { REDRAW_TILE = 64, REDRAW_AREAS = GPU_MAX_AREAS };

typedef struct redraw_below {
    uint64_t ground, pictures; // other numbers than before: it has changed, the latter in `places`
    int32_t places[2][4];      // left, top, width, height in pixels; width 0: none
} redraw_below;

typedef struct redraw_draw { // of a roil_draw, what lies in an area
    size_t of;
    uint32_t first, count; // range of redraw.indices
    gpu_area area;         // nothing is drawn outside
} redraw_draw;

typedef struct redraw_box { // tiles, `right` and `bottom` not included
    uint32_t left, top, right, bottom;
} redraw_box;

typedef struct redraw { // zero: nothing has been drawn
    uint32_t width, height, columns, rows;
    bool known;             // `before` holds
    uint64_t *before, *now; // of each tile
    gpu_area areas[REDRAW_AREAS];
    size_t area_count;  // 0: nothing has changed
    redraw_draw *draws; // of all areas
    size_t draw_count;
    uint32_t *indices;
    size_t index_count;
    redraw_box *boxes; // of each triangle
    size_t before_capacity, now_capacity, draw_capacity, index_capacity, box_capacity;
} redraw;

// Finds what differs from the picture that was kept last. `p` must have no index out of range.
// Areas do not overlap.
void redraw_find(redraw *d, const roil_picture *p, const redraw_below *below);
void redraw_keep(redraw *d);   // what was found has been drawn
void redraw_forget(redraw *d); // the next picture is drawn as a whole
void redraw_free(redraw *d);
