// The graph of passes: declare images and passes, compile (order, culling, lifetimes), execute.
//
// An image is written by exactly one pass and read by any number. Passes run in an order that
// respects this, and otherwise in the order of declaration. A pass that contributes to no output of
// the graph is culled: it is never recorded. Declaring and compiling need no device. The gpu layer
// places barriers; each pass binds what it uses. A graph belongs to one thread.
#pragma once
#include "base/str.h"
#include "gpu/gpu.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct graph graph;
typedef struct graph_image {
    uint32_t id;
} graph_image; // zero: none

enum { GRAPH_ALL_MIPS = 0xffff };

typedef struct graph_image_desc {
    const char *name; // unique in the graph; copied
    gpu_format format;
    float scale;                   // size relative to the output, rounded up; 0: fixed size below
    uint32_t width, height, depth; // fixed size in texels; depth 0: 2D
    uint32_t mips;                 // 0 means 1; GRAPH_ALL_MIPS: down to 1x1; at most that many
    bool target;                   // a graphics pipeline draws to it
    bool optional; // it has no memory while nothing reads it, even if its writer runs
    bool keep; // its content survives frames in which its writer does nothing (graph_has_content)
} graph_image_desc;

typedef struct graph_pass_desc {
    const char *name;         // label of its GPU time; unique in the graph; copied
    const graph_image *reads; // zero handles are skipped
    size_t read_count;
    const graph_image *writes;
    size_t write_count;
    bool keep;      // never culled, because it has an effect besides its images
    bool simulates; // it advances a state: it also runs for frames that are not drawn
    bool (*record)(void *user, graph *g, gpu *device); // called between gpu_pass_begin and _end
    void *user;
} graph_pass_desc;

graph *graph_create(void);
void graph_destroy(graph *g, gpu *device); // device may be NULL when nothing was allocated

graph_image graph_add_image(graph *g, const graph_image_desc *desc);
// Returns an image with last frame's content of `image`, named "<image> history". It is zero in the
// first frame and after a change of size. Further calls return the same handle.
graph_image graph_add_history(graph *g, graph_image image);
bool graph_add_pass(graph *g, const graph_pass_desc *desc);
// Lets every pass that reads `from`, but for the pass `but`, read `to` instead.
void graph_redirect(graph *g, graph_image from, graph_image to, const char *but);
void graph_add_output(graph *g, graph_image image); // its content is needed after execution
void graph_remove_output(graph *g, graph_image image);

// Orders and culls passes, computes sizes and lifetimes, and decides which images share memory
// (same format and size, separate lifetimes, no history, neither outputs nor kept). Errors: a cycle
// (the message names its passes), an image that is read but never written, an image with two
// writers, a size above 16384.
bool graph_compile(graph *g, uint32_t width, uint32_t height);
// After compile: adds all images that it lacks. Returns the bytes of those that graph_allocate may
// take over or frees.
uint64_t graph_list_memory(const graph *g, budget_list *out);
// What it has is about to go: see gpu_lend_memory.
void graph_lend(const graph *g, gpu *device);
// Allocates the images after graph_compile, and frees those of earlier compilations.
bool graph_allocate(graph *g, gpu *device);
// Exchanges images that match by name, format and size between two graphs, so that the content of
// `from`, above all its histories, continues in `g`; the reverse call undoes it. `g` must be
// compiled for the same device. A graph that lacks images afterwards must be allocated before it
// executes.
void graph_adopt(graph *g, graph *from);
bool graph_has_history(const graph *g); // after graph_compile: a pass that runs reads one
// Makes every history zero again, as before the first frame.
void graph_reset_history(graph *g);

// Swaps the histories, then records all passes in order. Call it inside an open frame. The images
// keep their content until the next call.
bool graph_execute(graph *g, gpu *device);
// Records only the passes that simulate, and those they read from. Histories are not swapped. False
// when a pass failed.
bool graph_execute_simulation(graph *g, gpu *device);
bool graph_simulates(const graph *g); // after graph_compile: a pass that simulates runs
// Returns whether graph_execute_simulation runs a pass that reads the image.
bool graph_feeds_simulation(const graph *g, graph_image image);

// NULL when the image is culled, and when it is optional and nothing reads it.
gpu_image *graph_get_image(const graph *g, graph_image image);
// Returns the desc as declared, except that `mips` is the real number of levels after
// graph_compile.
const graph_image_desc *graph_get_desc(const graph *g, graph_image image);
// After graph_compile: returns whether an output of the graph, or a pass that runs, reads it.
bool graph_is_read(const graph *g, graph_image image);
void graph_get_size(const graph *g, graph_image image, uint32_t size[3]); // texels, depth >= 1
graph_image graph_find_image(const graph *g, const char *name);           // zero when unknown
size_t graph_images(const graph *g, graph_image *out, size_t capacity);
// Lists the names of the passes that run, in order. Returns their number.
size_t graph_order(const graph *g, const char **out, size_t capacity);
typedef struct graph_pass_info { // lives as long as the graph
    const char *name;
    const uint32_t *reads, *writes; // places in the list of graph_images
    size_t read_count, write_count;
    bool runs; // else it is culled
} graph_pass_info;
// Lists all passes after graph_compile: those that run, in order, and then the others.
size_t graph_passes(const graph *g, graph_pass_info *out, size_t capacity);
bool graph_shares_memory(const graph *g, graph_image a, graph_image b);
// For the writer of a kept image, while it records: returns whether the image still holds what the
// writer wrote last.
bool graph_has_content(const graph *g, graph_image image);
// Returns whether the image has memory that no other image shares and may overwrite.
bool graph_is_alone(const graph *g, graph_image image);
void graph_print_dot(const graph *g, const char *title, strbuf *out); // culled passes are grey
