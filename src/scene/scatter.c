// Dart throwing: a random place is kept if no other is too near. This is tested with a grid whose
// cells hold at most one place (Bridson, "Fast Poisson disk sampling in arbitrary dimensions",
// 2007, section 2). Unlike in his method, places do not grow from each other, so that a few are
// spread as evenly as many.
#include "scene/scatter.h"
#include <math.h>

enum {
    EMPTY = 0,                          // of a cell; else the number of its place, from 1 on
    MOST_CELLS = SCATTER_MAX_CELLS / 4, // larger ones than need be hold one place all the same
    MOST_MISSES = 3000,                 // one after the other: there is no room left
    MOST_DARTS = 100,                   // for each place
};

typedef struct board {
    const scatter_desc *desc;
    float cell;
    int32_t size[2]; // cells
    float (*places)[3];
    size_t count;
} board;

float scatter_chance(uint32_t seed, uint32_t index, uint32_t what) {
    uint32_t h = seed * 0x9e3779b9u + what;
    for (int i = 0; i < 2; i++) { // Wellons, "Prospecting for hash functions", 2018: lowbias32
        h ^= h >> 16;
        h *= 0x7feb352du;
        h ^= h >> 15;
        h *= 0x846ca68bu;
        h ^= h >> 16;
        if (i == 0) h += index;
    }
    return (float)(h >> 8) / 16777216.0f;
}

static board board_open(const scatter_desc *desc, float (*out)[3]) {
    board b = {.desc = desc, .places = out};
    double area = (double)desc->size[0] * (double)desc->size[1];
    // A cell's diagonal is the distance.
    double cell = fmax((double)desc->distance / sqrt(2.0), sqrt(area / MOST_CELLS));
    double longest = fmax((double)desc->size[0], (double)desc->size[1]);
    b.cell = (float)fmax(cell, longest / MOST_CELLS);
    for (int a = 0; a < 2; a++) b.size[a] = (int32_t)(desc->size[a] / b.cell) + 1;
    return b;
}

size_t scatter_cells(const scatter_desc *desc) {
    board b = board_open(desc, NULL);
    return (size_t)b.size[0] * (size_t)b.size[1];
}

static int32_t cell_along(const board *b, int axis, float at) {
    int32_t cell = (int32_t)((at - (b->desc->middle[axis] - 0.5f * b->desc->size[axis])) / b->cell);
    return cell < 0 ? 0 : cell < b->size[axis] ? cell : b->size[axis] - 1;
}

static bool is_near(const board *b, uint32_t place, const float at[2]) {
    if (place == EMPTY) return false;
    const float *other = b->places[place - 1];
    float x = at[0] - other[0], y = at[1] - other[1];
    return x * x + y * y < b->desc->distance * b->desc->distance;
}

static bool has_room(const board *b, const float at[2]) {
    int32_t x = cell_along(b, 0, at[0]), y = cell_along(b, 1, at[1]);
    if (b->desc->cells[(size_t)y * (size_t)b->size[0] + (size_t)x] != EMPTY) return false;
    for (int32_t v = y > 2 ? y - 2 : 0; v <= y + 2 && v < b->size[1]; v++)
        for (int32_t u = x > 2 ? x - 2 : 0; u <= x + 2 && u < b->size[0]; u++)
            if (is_near(b, b->desc->cells[(size_t)v * (size_t)b->size[0] + (size_t)u], at))
                return false;
    return true;
}

static void board_add(board *b, const float at[3]) {
    for (int a = 0; a < 3; a++) b->places[b->count][a] = at[a];
    b->count++;
    if (b->desc->distance == 0) return; // cells would hold several, and nobody asks
    int32_t x = cell_along(b, 0, at[0]), y = cell_along(b, 1, at[1]);
    b->desc->cells[(size_t)y * (size_t)b->size[0] + (size_t)x] = (uint32_t)b->count;
}

static bool board_throw(board *b, uint32_t dart, bool *stays) {
    const scatter_desc *d = b->desc;
    float at[3] = {0, 0, d->middle[2]};
    for (uint32_t a = 0; a < 2; a++)
        at[a] = d->middle[a] + (scatter_chance(d->seed, dart, a) - 0.5f) * d->size[a];
    *stays = has_room(b, at);
    if (*stays && d->accept && !d->accept(d->user, at, scatter_chance(d->seed, dart, 2), stays))
        return false;
    if (*stays) board_add(b, at);
    return true;
}

bool scatter_places(const scatter_desc *desc, float (*out)[3], size_t *found) {
    board b = board_open(desc, out);
    bool fine = true;
    int misses = 0;
    size_t most = MOST_DARTS * desc->count + MOST_MISSES;
    for (uint32_t dart = 0; fine && b.count < desc->count && misses < MOST_MISSES && dart < most;
         dart++) {
        bool stays;
        fine = board_throw(&b, dart, &stays);
        misses = stays ? 0 : misses + 1;
    }
    *found = b.count;
    return fine;
}
