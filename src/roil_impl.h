// The inside of libroil's objects, for src/roil*.c only.
#pragma once
#include "effect/effect.h"
#include "roil.h"

struct roil {
    gpu *device; // NULL: no_device
    char *home, *shaders, *scripts, *cache;
    bool counters;
};

struct roil_effect {
    roil *owner;
    effect *effect;
    uint32_t width, height;
    uint64_t frame; // number of the last GPU frame, 0: none
};

// Reads an image of the graph as RGBA floats, rows from the top; free with mem_free.
float *roil_read_image(roil_effect *e, graph_image image, uint32_t *width, uint32_t *height);
graph_image roil_find_image(roil_effect *e, const char *name); // zero with a message
