// The graph of an effect as tools show it: passes, what they read and write, and where the script
// makes them. Part of roil.h, which includes it; its rules on errors, threads and memory hold here
// too. Call all of this after roil_prepare, between frames.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil_graph_pass { // strings live as long as the effect
    const char *name;            // "lighting.shadow": a part of a pass of the script, or all of it
    const char *pass;            // that pass, "lighting": the group of its controls
    const char *file;            // that says it; NULL: not known
    int line;                    // from 1
    bool culled;                 // it does not run, since nothing needs what it writes
} roil_graph_pass;
// Lists the passes in the order in which they run; culled ones come last.
size_t roil_graph_passes(roil_effect *e, roil_graph_pass *out, size_t capacity);

typedef struct roil_graph_link {
    size_t pass, image; // indices in roil_graph_passes and roil_images
    bool writes;        // the pass writes it; else it reads it
} roil_graph_link;
size_t roil_graph_links(roil_effect *e, roil_graph_link *out, size_t capacity);

// Returns the fields that a pass of the script is given, one to a line: "density = sphere(...) *
// 4". Free it with roil_free. NULL with a message: there is no such pass.
char *roil_graph_fields(roil_effect *e, const char *pass);

// Writes a line on what makes the last frame slow and what would make it faster: a noise that is
// most of the work of the pass that takes most of the time, and that a tile would hold. Returns
// whether there is such a thing, as far as is known: it goes by roil_times and roil_counters.
bool roil_slow(roil_effect *e, char *out, size_t capacity);

#ifdef __cplusplus
}
#endif
