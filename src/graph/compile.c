// Compiles declarations into an order of passes.
//
// The order is that of Kahn's algorithm (Communications of the ACM 5, 1962). Of the passes that
// could run, the one declared first runs. An order that was right as written is therefore kept, and
// the result does not depend on addresses or hashes. What Kahn leaves over depends on a cycle:
// every leftover pass reads from another leftover pass, so walking back from any of them finds the
// cycle. A history image has no writer: reading it orders nothing, but keeps the writer of its
// image from being culled.
//
// The cost is O(images + passes log passes + uses).
#include "base/memory.h"
#include "graph/internal.h"
#include <assert.h>
#include <math.h>
#include <string.h>

enum { MAX_SIZE = 16384 };

// ---- writers ----------------------------------------------------------------------------------

static bool find_writers(graph *g) {
    for (size_t i = 0; i < g->image_count; i++) g->images[i].writer = NONE;
    for (size_t p = 0; p < g->pass_count; p++) {
        const graph_node_pass *pass = &g->passes[p];
        for (size_t i = 0; i < pass->write_count; i++) {
            graph_node_image *image = &g->images[pass->writes[i]];
            if (image->writer != NONE && image->writer != p)
                return err_set("image '%s' is written by pass '%s' and by pass '%s'; an image has "
                               "one writer",
                               image->desc.name, g->passes[image->writer].name, pass->name);
            image->writer = (uint32_t)p;
        }
    }
    return true;
}

// Returns the pass that writes image `index`, or writes the image whose history it is.
static uint32_t source(const graph *g, uint32_t index) {
    const graph_node_image *image = &g->images[index];
    return image->of == NONE ? image->writer : g->images[image->of].writer;
}

// Finds the writer of each image; false, with a message that names the image, where there is none
// or a second.
static bool graph_link(graph *g) {
    if (!find_writers(g)) return false;
    for (size_t p = 0; p < g->pass_count; p++)
        for (size_t i = 0; i < g->passes[p].read_count; i++) {
            uint32_t image = g->passes[p].reads[i];
            if (source(g, image) == NONE)
                return err_set("image '%s' is read by pass '%s' and never written",
                               g->images[image].desc.name, g->passes[p].name);
        }
    for (size_t i = 0; i < g->image_count; i++)
        if (g->images[i].output && source(g, (uint32_t)i) == NONE)
            return err_set("image '%s' is an output and never written", g->images[i].desc.name);
    return true;
}

// ---- order ------------------------------------------------------------------------------------

typedef struct heap { // smallest on top
    uint32_t *at;
    size_t count;
} heap;

static void heap_push(heap *h, uint32_t value) {
    size_t i = h->count++;
    for (; i && h->at[(i - 1) / 2] > value; i = (i - 1) / 2) h->at[i] = h->at[(i - 1) / 2];
    h->at[i] = value;
}

static uint32_t heap_pop(heap *h) {
    uint32_t top = h->at[0], value = h->at[--h->count];
    size_t i = 0;
    for (size_t child = 1; child < h->count; child = 2 * i + 1) {
        if (child + 1 < h->count && h->at[child + 1] < h->at[child]) child++;
        if (h->at[child] >= value) break;
        h->at[i] = h->at[child];
        i = child;
    }
    h->at[i] = value;
    return top;
}

typedef struct sorting {
    arena scratch;
    uint32_t *waits; // of a pass: reads whose writer has not been placed yet
    uint32_t *first; // of a pass: where its readers begin in `readers`; one more at the end
    uint32_t *readers;
    heap ready;
} sorting;

static void sorting_begin(sorting *s, const graph *g) {
    size_t passes = g->pass_count, uses = 0;
    s->waits = arena_alloc(&s->scratch, passes * sizeof *s->waits);
    s->first = arena_alloc(&s->scratch, (passes + 2) * sizeof *s->first);
    s->ready.at = arena_alloc(&s->scratch, passes * sizeof *s->ready.at);
    for (size_t p = 0; p < passes; p++)
        for (size_t i = 0; i < g->passes[p].read_count; i++) {
            uint32_t writer = g->images[g->passes[p].reads[i]].writer;
            if (writer == NONE) continue;
            s->first[writer + 2]++;
            s->waits[p]++;
            uses++;
        }
    assert(uses < NONE);
    for (size_t p = 2; p < passes + 2; p++) s->first[p] += s->first[p - 1];
    // While filling, first[w + 1] is the next free place of w; afterwards it is w's end.
    s->readers = arena_alloc(&s->scratch, uses * sizeof *s->readers);
    for (size_t p = 0; p < passes; p++)
        for (size_t i = 0; i < g->passes[p].read_count; i++) {
            uint32_t writer = g->images[g->passes[p].reads[i]].writer;
            if (writer != NONE) s->readers[s->first[writer + 1]++] = (uint32_t)p;
        }
}

// Returns a pass that `pass` reads from and that could not be placed.
static uint32_t blocker(const graph *g, const sorting *s, uint32_t pass) {
    for (size_t i = 0; i < g->passes[pass].read_count; i++) {
        uint32_t writer = g->images[g->passes[pass].reads[i]].writer;
        if (writer != NONE && s->waits[writer]) return writer;
    }
    assert(!"a pass waits for passes that ran");
    return pass;
}

static bool report_cycle(const graph *g, sorting *s) {
    uint32_t pass = 0;
    while (!s->waits[pass]) pass++;
    bool *seen = arena_alloc(&s->scratch, g->pass_count * sizeof *seen);
    for (; !seen[pass]; pass = blocker(g, s, pass)) seen[pass] = true;

    // The walk went against the flow of data: fill the ring from its end.
    uint32_t *ring = arena_alloc(&s->scratch, g->pass_count * sizeof *ring);
    size_t begin = g->pass_count, lowest;
    uint32_t start = pass;
    do {
        ring[--begin] = pass;
        pass = blocker(g, s, pass);
    } while (pass != start);
    lowest = begin;
    for (size_t i = begin; i < g->pass_count; i++)
        if (ring[i] < ring[lowest]) lowest = i;

    strbuf text = {0};
    size_t length = g->pass_count - begin;
    for (size_t i = 0; i <= length; i++)
        strbuf_add(&text, "%s%s", i ? " -> " : "",
                   g->passes[ring[begin + (lowest - begin + i) % length]].name);
    err_set("cycle: %s; use a history to read what was written in the last frame",
            strbuf_text(&text));
    strbuf_free(&text);
    return false;
}

// Fills `order` with all passes; false, with a message, when they wait for each other.
static bool graph_sort(graph *g) {
    sorting s = {0};
    sorting_begin(&s, g);
    g->order = mem_resize(g->order, g->order_count * sizeof *g->order,
                          (g->pass_count + 1) * sizeof *g->order);
    g->order_count = 0;
    for (size_t p = 0; p < g->pass_count; p++)
        if (!s.waits[p]) heap_push(&s.ready, (uint32_t)p);
    while (s.ready.count) {
        uint32_t pass = heap_pop(&s.ready);
        g->order[g->order_count++] = pass;
        for (uint32_t i = s.first[pass]; i < s.first[pass + 1]; i++)
            if (--s.waits[s.readers[i]] == 0) heap_push(&s.ready, s.readers[i]);
    }
    bool done = g->order_count == g->pass_count || report_cycle(g, &s);
    arena_free(&s.scratch);
    return done;
}

// ---- culling ----------------------------------------------------------------------------------

typedef struct marking {
    uint32_t *stack; // live passes whose reads were not followed yet
    size_t count;
} marking;

static void mark_pass(graph *g, marking *m, uint32_t pass) {
    if (g->passes[pass].live) return;
    g->passes[pass].live = true;
    m->stack[m->count++] = pass;
}

static void mark_image(graph *g, marking *m, uint32_t image) {
    uint32_t of = g->images[image].of;
    if (of != NONE) g->images[of].history_used = true;
    g->images[of != NONE ? of : image].read = true;
    mark_pass(g, m, source(g, image));
}

// Readers come after the passes they read from, so one walk against the order is enough.
static void mark_needed(graph *g) {
    for (size_t p = 0; p < g->pass_count; p++) g->passes[p].needed = false;
    for (size_t i = 0; i < g->image_count; i++) g->images[i].feeds = false;
    for (size_t i = g->order_count; i-- > 0;) {
        graph_node_pass *pass = &g->passes[g->order[i]];
        pass->needed = pass->needed || pass->simulates;
        for (size_t k = 0; pass->needed && k < pass->read_count; k++) {
            uint32_t writer = g->images[pass->reads[k]].writer;
            g->images[pass->reads[k]].feeds = true;
            if (writer != NONE) g->passes[writer].needed = true;
        }
    }
}

// Marks the passes that an output needs, and drops the others from `order`.
static void graph_cull(graph *g) {
    marking m = {.stack = mem_alloc(g->pass_count * sizeof *m.stack)};
    for (size_t p = 0; p < g->pass_count; p++) g->passes[p].live = false;
    for (size_t i = 0; i < g->image_count; i++)
        g->images[i].read = g->images[i].history_used = false;

    for (size_t p = 0; p < g->pass_count; p++)
        if (g->passes[p].keep) mark_pass(g, &m, (uint32_t)p);
    for (size_t i = 0; i < g->image_count; i++)
        if (g->images[i].output) mark_image(g, &m, (uint32_t)i);
    while (m.count) {
        const graph_node_pass *pass = &g->passes[m.stack[--m.count]];
        for (size_t i = 0; i < pass->read_count; i++) mark_image(g, &m, pass->reads[i]);
    }
    mem_free(m.stack);

    size_t live = 0;
    for (size_t i = 0; i < g->order_count; i++)
        if (g->passes[g->order[i]].live) g->order[live++] = g->order[i];
    g->order_count = live;
    mark_needed(g);
}

// ---- sizes ------------------------------------------------------------------------------------

// Rounds up, except for the error of floats: 1920 * 0.1 is 192, although 0.1f is a little more than
// a tenth.
static double scaled(uint32_t size, float scale) {
    double exact = (double)size * (double)scale;
    return fmax(1, ceil(exact - exact * 0x1p-23));
}

static bool resolve_size(graph_node_image *image, uint32_t width, uint32_t height) {
    const graph_image_desc *d = &image->desc;
    double w = d->scale > 0 ? scaled(width, d->scale) : (double)d->width;
    double h = d->scale > 0 ? scaled(height, d->scale) : (double)d->height;
    double depth = d->depth ? (double)d->depth : 1;
    if (!(w <= MAX_SIZE && h <= MAX_SIZE && depth <= MAX_SIZE))
        return err_set("image '%s' would be %.0f x %.0f x %.0f texels; at most %d each way",
                       d->name, w, h, depth, MAX_SIZE);
    image->size[0] = (uint32_t)w;
    image->size[1] = (uint32_t)h;
    image->size[2] = (uint32_t)depth;

    uint32_t full = 1;
    while (image->size[0] >> full || image->size[1] >> full || image->size[2] >> full) full++;
    image->desc.mips = image->mips < full ? image->mips : full;
    return true;
}

static bool resolve_sizes(graph *g, uint32_t width, uint32_t height) {
    for (size_t i = 0; i < g->image_count; i++)
        if (!resolve_size(&g->images[i], width, height)) return false;
    return true;
}

bool graph_compile(graph *g, uint32_t width, uint32_t height) {
    graph_retire_memory(g);
    if (width < 1 || height < 1 || width > MAX_SIZE || height > MAX_SIZE)
        return err_set("output of %u x %u texels; accepted are 1 to %d each way", width, height,
                       MAX_SIZE);
    if (!graph_link(g) || !graph_sort(g)) return false;
    graph_cull(g);
    if (!resolve_sizes(g, width, height)) return false;
    graph_plan_memory(g);
    g->compiled = true;
    return true;
}
