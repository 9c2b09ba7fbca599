// Places spread by chance over a rectangle, none nearer to another than a distance.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct scatter_desc {
    size_t count;    // at most
    float middle[3]; // of the rectangle, metres
    float size[2];   // its sides
    float distance;  // between places, at least
    uint32_t seed;
    // Whether a place may stay; it may lift it. Called for those that have room; it need not
    // return. False of the result: an error, with a message. NULL: all stay.
    bool (*accept)(void *user, float place[3], float chance, bool *stays);
    void *user;
    uint32_t *cells; // scatter_cells of them, all zero: memory to work in
} scatter_desc;

size_t scatter_cells(const scatter_desc *desc); // that it takes, at most SCATTER_MAX_CELLS
enum { SCATTER_MAX_CELLS = 1 << 22 };
// Fewer than asked for when no more find room. The same for the same description.
bool scatter_places(const scatter_desc *desc, float (*out)[3], size_t *found);
// Evenly spread over [0, 1): the same for the same three.
float scatter_chance(uint32_t seed, uint32_t index, uint32_t what);
