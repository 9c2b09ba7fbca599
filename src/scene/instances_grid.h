// A grid of square cells, seen from above, over places: which are near a point.
#pragma once
#include "shared.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct instances_grid { // zero: to be made
    float low[2];
    float cell;       // metres
    uint32_t size[2]; // cells
    uint32_t *first;  // per cell, and one more: of its places in `order`
    uint32_t *order;  // numbers of places, cell by cell
    bool made;
} instances_grid;

void instances_grid_make(instances_grid *g, const struct instance_entry *places, size_t count);
void instances_grid_forget(instances_grid *g); // a place has moved
void instances_grid_free(instances_grid *g);
// Those within `radius` of a point, the nearest first, of equal ones the first; at most `capacity`
// are written. Returns how many there are.
size_t instances_grid_near(instances_grid *g, const struct instance_entry *places,
                           const float point[3], float radius, uint32_t *out, size_t capacity);
