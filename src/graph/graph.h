// Pass graph: declare images and passes, compile (order, culling, lifetimes), execute.
//
// An image is written by exactly one pass and read by any number; passes run in an order that
// respects this, else in order of declaration. A pass whose outputs nobody reads, directly or
// not, on the way to an output of the graph is never recorded. Declaring and compiling need no
// device. Barriers are the gpu layer's business: each pass binds what it uses.
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
    bool target;                   // drawn to by a graphics pipeline
    bool optional;                 // has no memory while nothing reads it, though its writer runs
    bool keep; // keeps its content while its writer leaves it alone (graph_has_content)
} graph_image_desc;

typedef struct graph_pass_desc {
    const char *name;         // label of its GPU time; unique in the graph; copied
    const graph_image *reads; // zero handles are passed over
    size_t read_count;
    const graph_image *writes;
    size_t write_count;
    bool keep;      // has an effect besides its images: never culled
    bool simulates; // goes on from where it was: runs for frames that are not drawn, too
    bool (*record)(void *user, graph *g, gpu *device); // between gpu_pass_begin and _end
    void *user;
} graph_pass_desc;

graph *graph_create(void);
void graph_destroy(graph *g, gpu *device); // device may be NULL when nothing was allocated

graph_image graph_add_image(graph *g, const graph_image_desc *desc);
// Last frame's content of `image`: all zero in the first frame and after a change of size. It is
// named "<image> history"; asking again gives the same handle.
graph_image graph_add_history(graph *g, graph_image image);
bool graph_add_pass(graph *g, const graph_pass_desc *desc);
bool graph_add_output(graph *g, graph_image image); // wanted after execution
void graph_remove_output(graph *g, graph_image image);

// Orders, culls, computes sizes and lifetimes, and decides which images share memory (same format
// and size, lifetimes apart, no history, not an output, not kept). Errors: a cycle (named pass by
// pass), an image that is read and never written, an image with two writers, a size beyond 16384.
bool graph_compile(graph *g, uint32_t width, uint32_t height);
// After compile: adds all images that it lacks. Returns the bytes of those that graph_allocate may
// take over or frees.
uint64_t graph_list_memory(const graph *g, budget_list *out);
// What it has is about to go: see gpu_lend_memory.
void graph_lend(const graph *g, gpu *device);
bool graph_allocate(graph *g, gpu *device); // after compile; frees what an earlier compile had
// Exchanges the images of both that match by name, format and size, so that what `from` has drawn,
// its histories above all, goes on in `g`; the other way round undoes it. `g` is compiled for the
// same device. What lacks images after that must be allocated before it executes.
void graph_adopt(graph *g, graph *from);
// Makes every history zero again, as before the first frame.
void graph_reset_history(graph *g);

bool graph_execute(graph *g, gpu *device); // inside an open frame; swaps histories afterwards
// The passes that simulate, and what they read; histories stay as they are. False when one failed.
bool graph_execute_simulation(graph *g, gpu *device);
bool graph_simulates(const graph *g); // after compile: such a pass runs
// Whether graph_execute_simulation runs a pass that reads it.
bool graph_feeds_simulation(const graph *g, graph_image image);
// After graph_execute the images keep their content until the next one: history images are swapped
// at the start of graph_execute.

// NULL when culled, and when it is optional and nobody reads it
gpu_image *graph_get_image(const graph *g, graph_image image);
// As declared, except that after compiling `mips` is the true number of levels.
const graph_image_desc *graph_get_desc(const graph *g, graph_image image);
// After compile: whether an output of the graph, or a pass that runs, reads it.
bool graph_is_read(const graph *g, graph_image image);
void graph_get_size(const graph *g, graph_image image, uint32_t size[3]); // texels, depth >= 1
graph_image graph_find_image(const graph *g, const char *name);           // zero when unknown
size_t graph_images(const graph *g, graph_image *out, size_t capacity);
// Names of the passes that run, in order; returns the count.
size_t graph_order(const graph *g, const char **out, size_t capacity);
bool graph_shares_memory(const graph *g, graph_image a, graph_image b);
// Of an image that is kept, while its writer records: whether it still holds what that wrote last.
bool graph_has_content(const graph *g, graph_image image);
// False: it is culled, or its memory is another image's too, which may have overwritten it.
bool graph_is_alone(const graph *g, graph_image image);
void graph_print_dot(const graph *g, const char *title, strbuf *out); // culled passes are grey
