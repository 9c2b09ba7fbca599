// A horizontal grid of square cells, to find places near a point.
#pragma once
#include "shared.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct instances_grid { // zero: not made yet
    float low[2];
    float cell;       // side of a cell (m)
    uint32_t size[2]; // cells
    uint32_t *first;  // for each cell and one more: start of its places in `order`
    uint32_t *order;  // numbers of places, cell by cell
    bool made;
} instances_grid;

void instances_grid_make(instances_grid *g, const struct instance_entry *places, size_t count);
void instances_grid_forget(instances_grid *g); // a place has moved
void instances_grid_free(instances_grid *g);
// Lists the places within `radius` of a point, the nearest first, equally near ones by number;
// writes at most `capacity`. Returns how many there are.
size_t instances_grid_near(instances_grid *g, const struct instance_entry *places,
                           const float point[3], float radius, uint32_t *out, size_t capacity);
