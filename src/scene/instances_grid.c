// A counting sort into cells with about one place each. Results are collected completely and then
// sorted, since the nearest come first.
#include "scene/instances_grid.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

typedef struct near_place {
    float square; // of its distance
    uint32_t index;
} near_place;

static uint32_t cell_along(const instances_grid *g, int axis, float at) {
    float cell = floorf((at - g->low[axis]) / g->cell);
    return cell > 0 ? (uint32_t)fminf(cell, (float)(g->size[axis] - 1)) : 0;
}

static uint32_t cell_of(const instances_grid *g, const float place[3]) {
    return cell_along(g, 1, place[1]) * g->size[0] + cell_along(g, 0, place[0]);
}

static void grid_fit(instances_grid *g, const struct instance_entry *places, size_t count) {
    float high[2] = {0}, side[2];
    for (size_t i = 0; i < count; i++) {
        for (int a = 0; a < 2; a++) {
            float at = places[i].place.v[a];
            g->low[a] = i ? fminf(g->low[a], at) : at;
            high[a] = i ? fmaxf(high[a], at) : at;
        }
    }
    for (int a = 0; a < 2; a++) side[a] = high[a] - g->low[a];
    float longest = fmaxf(fmaxf(side[0], side[1]), 1e-3f);
    // Of places along a line as many cells as of places in a square.
    g->cell = fmaxf(sqrtf(side[0] * side[1] / (float)count), longest / (float)count);
    for (int a = 0; a < 2; a++) g->size[a] = (uint32_t)fminf(side[a] / g->cell, (float)count) + 1;
}

void instances_grid_make(instances_grid *g, const struct instance_entry *places, size_t count) {
    if (g->made) return;
    instances_grid_free(g);
    grid_fit(g, places, count);
    size_t cells = (size_t)g->size[0] * g->size[1];
    g->first = mem_alloc((cells + 1) * sizeof *g->first);
    g->order = mem_alloc(count * sizeof *g->order);
    for (size_t i = 0; i < count; i++) g->first[cell_of(g, places[i].place.v) + 1]++;
    for (size_t i = 0; i < cells; i++) g->first[i + 1] += g->first[i];
    uint32_t *next = mem_copy(g->first, cells * sizeof *next);
    for (size_t i = 0; i < count; i++)
        g->order[next[cell_of(g, places[i].place.v)]++] = (uint32_t)i;
    mem_free(next);
    g->made = true;
}

void instances_grid_forget(instances_grid *g) {
    g->made = false;
}

void instances_grid_free(instances_grid *g) {
    mem_free(g->first);
    mem_free(g->order);
    *g = (instances_grid){0};
}

static int by_distance(const void *a, const void *b) {
    const near_place *x = a, *y = b;
    if (x->square != y->square) return x->square < y->square ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

static float square_between(const float a[3], const float b[3]) {
    float sum = 0;
    for (int i = 0; i < 3; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

size_t instances_grid_near(instances_grid *g, const struct instance_entry *places,
                           const float point[3], float radius, uint32_t *out, size_t capacity) {
    size_t count = 0, room = 0;
    near_place *found = NULL;
    uint32_t low[2], high[2];
    for (int a = 0; a < 2; a++) {
        low[a] = cell_along(g, a, point[a] - radius);
        high[a] = cell_along(g, a, point[a] + radius);
    }
    for (uint32_t y = low[1]; y <= high[1]; y++) {
        const uint32_t *row = g->first + (size_t)y * g->size[0];
        for (uint32_t i = row[low[0]]; i < row[high[0] + 1]; i++) {
            uint32_t index = g->order[i];
            float square = square_between(places[index].place.v, point);
            if (!(square <= radius * radius)) continue;
            *MEM_ADD(found, count, room) = (near_place){square, index};
        }
    }
    if (count) qsort(found, count, sizeof *found, by_distance);
    for (size_t i = 0; i < count && i < capacity; i++) out[i] = found[i].index;
    mem_free(found);
    return count;
}
