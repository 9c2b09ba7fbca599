// Runs a compiled graph: swaps the histories, then records the passes in order.
//
// The two images behind an image with history are swapped before the first pass. Between two
// executions the handles therefore show the frame that was just made and the one before it.
#include "base/swap.h"
#include "graph/internal.h"
#include <assert.h>

static void turn_history(graph *g, gpu *device, const graph_node_image *image) {
    static const float zero[4] = {0};
    graph_slot *now = &g->slots.at[image->slot];
    graph_slot *past = &g->slots.at[g->images[image->history].slot];
    SWAP(now->memory, past->memory);
    if (!now->fresh && !past->fresh) return;
    gpu_image_clear(device, now->memory, zero);
    gpu_image_clear(device, past->memory, zero);
    now->fresh = past->fresh = false;
}

static void make_fresh(slot_list *slots) {
    for (size_t i = 0; i < slots->count; i++)
        if (slots->at[i].paired) slots->at[i].fresh = true;
}

void graph_reset_history(graph *g) {
    make_fresh(&g->slots);
    make_fresh(&g->kept);
}

static void settle_kept(graph *g, const graph_node_pass *pass) {
    for (size_t i = 0; i < pass->write_count; i++) {
        uint32_t slot = g->images[pass->writes[i]].slot;
        if (slot != NONE && g->slots.at[slot].kept) g->slots.at[slot].fresh = false;
    }
}

static bool graph_run(graph *g, gpu *device, bool all) {
    for (size_t i = 0; i < g->order_count; i++) {
        const graph_node_pass *pass = &g->passes[g->order[i]];
        if (!all && !pass->needed) continue;
        assert(pass->record);
        gpu_pass_begin(device, pass->name);
        bool done = pass->record(pass->user, g, device);
        gpu_pass_end(device);
        if (!done) return err_prefix("pass '%s': ", pass->name);
        settle_kept(g, pass);
    }
    return true;
}

bool graph_execute(graph *g, gpu *device) {
    assert(g->compiled && g->allocated);
    for (size_t i = 0; i < g->image_count; i++)
        if (g->images[i].history_used) turn_history(g, device, &g->images[i]);
    return graph_run(g, device, true);
}

bool graph_execute_simulation(graph *g, gpu *device) {
    assert(g->compiled && g->allocated);
    return graph_run(g, device, false);
}

bool graph_simulates(const graph *g) {
    for (size_t i = 0; i < g->order_count; i++)
        if (g->passes[g->order[i]].simulates) return true;
    return false;
}

bool graph_feeds_simulation(const graph *g, graph_image image) {
    return image.id && g->images[image.id - 1].feeds;
}
