// Random places in a rectangle with a minimum distance between them.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct scatter_desc {
    size_t count;    // maximum number of places
    float middle[3]; // middle of the rectangle (m)
    float size[2];   // sides of the rectangle (m)
    float distance;  // minimum distance between places (m)
    uint32_t seed;
    // Called for each place with enough room: sets `*stays`, and may change the height of the
    // place. It may leave by longjmp. Returns false with a message on an error. NULL: all places
    // stay.
    bool (*accept)(void *user, float place[3], float chance, bool *stays);
    void *user;      // passed to accept
    uint32_t *cells; // working memory: scatter_cells() elements, all zero
} scatter_desc;

size_t scatter_cells(const scatter_desc *desc); // at most SCATTER_MAX_CELLS
enum { SCATTER_MAX_CELLS = 1 << 22 };
// Finds places, fewer than `count` when there is no more room. The result depends only on the desc.
bool scatter_places(const scatter_desc *desc, float (*out)[3], size_t *found);
// Returns a random number, uniform in [0, 1), which depends only on the arguments.
float scatter_chance(uint32_t seed, uint32_t index, uint32_t what);
