// Data of a graph, shared by the files of this layer only.
#pragma once
#include "base/arena.h"
#include "graph/graph.h"
#include "graph/lookup.h"

#define NONE UINT32_MAX

// Two images can use the same memory one after the other only if their keys are equal.
typedef struct slot_key { // all uint32_t: no padding, so it can be compared as bytes
    uint32_t format, width, height, depth, mips, target; // depth 0: 2D
} slot_key;

// One GPU image, used by one or more images of the graph.
typedef struct graph_slot {
    slot_key key;
    const char *name;  // of the first image that uses it
    gpu_image *memory; // NULL until allocated
    bool paired;       // half of an image with history; it is never shared and keeps its content
    bool kept;         // of a kept image; it is never shared, and not written in every frame
    bool fresh;        // paired or kept, and neither cleared nor written yet
} graph_slot;

typedef struct graph_node_image {
    graph_image_desc desc; // name in the arena; mips resolved by graph_compile
    uint32_t mips;         // as declared
    uint32_t of;           // of a history: index of its image; else NONE
    uint32_t history;      // index of its history image or NONE
    bool output;
    // from here: results of graph_compile
    bool read;         // it or its history is an output or read by a pass that runs
    bool history_used; // its history is read by a pass that runs, or is an output
    bool feeds;        // read by a pass that is needed
    uint32_t writer;   // index of a pass or NONE
    uint32_t size[3];
    uint32_t slot; // NONE when culled
} graph_node_image;

typedef struct graph_node_pass {
    const char *name;
    uint32_t *reads, *writes; // indices of images, in the arena
    size_t read_count, write_count;
    bool keep, simulates;
    bool (*record)(void *user, graph *g, gpu *device);
    void *user;
    bool live;   // it runs; result of graph_compile
    bool needed; // it simulates, or a pass that simulates needs it; result of graph_compile
} graph_node_pass;

typedef struct slot_list {
    graph_slot *at;
    size_t count, capacity;
} slot_list;

struct graph {
    arena names; // names and the lists of the passes
    lookup image_names, pass_names;
    graph_node_image *images; // handle id - 1 is the index
    graph_node_pass *passes;
    size_t image_count, image_capacity, pass_count, pass_capacity;

    bool compiled;   // `order` and `slots` match the declarations
    bool allocated;  // every slot has memory
    uint32_t *order; // passes that run
    size_t order_count;
    slot_list slots; // plan of the last compile
    slot_list kept;  // memory of earlier plans that graph_allocate may take over
};

void graph_plan_memory(graph *g);   // lifetimes -> slots
void graph_retire_memory(graph *g); // moves the memory of the current plan to `kept`
void graph_free_kept(graph *g, gpu *device);
