// The state: populations, the moments of the last two kept states, present and earlier kinds of
// cells, and waves at open faces. Buffers are saved as they are in memory, with a clock that says
// which of them is next.
#include "sim/lbm_state.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "sim/lbm_impl.h"
#include <string.h>

typedef struct state_clock { // as it lies in the file
    uint64_t steps, kept;
    uint32_t current, filled; // of the cells
} state_clock;

enum {
    PARTS = LBM_MAX_BUFFERS + 5,
    // To be raised when values come to lie elsewhere in buffers of the same sizes, or mean
    // something else there, in a way that describe_layout does not tell.
    LAYOUT_VERSION = 3
};

static void describe_layout(const lbm_layout *l, strbuf *out) {
    strbuf_add(out, "layout = %d: elements of %u cells, bundles of %u, ", LAYOUT_VERSION, l->lanes,
               l->bundle);
    if (l->block)
        strbuf_add(out, "blocks of %u", l->block);
    else
        strbuf_add(out, "directions as a whole");
    strbuf_add(out, ", up to %u in a buffer\n", l->run);
}

static void lbm_describe(const lbm *l, const char *more, strbuf *out) {
    const lbm_desc *desc = &l->desc;
    static const char *const sets[] = {"d3q19", "d3q27"}, *const scalar_sets[] = {"d3q7", "d3q27"};
    static const char *const precisions[] = {"f32", "f16"};
    static const char *const faces[] = {"left", "right", "front", "back", "bottom", "top"};
    static const char *const kinds[] = {"periodic", "wall", "slip", "open", "inflow"};
    strbuf_add(out, "size = %u x %u x %u\n", desc->size[0], desc->size[1], desc->size[2]);
    strbuf_add(out, "velocity_set = %s\n", sets[desc->set]);
    strbuf_add(out, "scalar_set = %s\n", scalar_sets[desc->scalar_set]);
    strbuf_add(out, "precision = %s\n", precisions[desc->precision]);
    strbuf_add(out, "scalars = %u\n", desc->scalars);
    describe_layout(&l->layout, out);
    strbuf_add(out, "colliders = %s\n", desc->bodies ? "yes" : "no");
    for (int i = 0; i < 6; i++)
        strbuf_add(out, "boundary.%s = %s\n", faces[i], kinds[desc->faces[i]]);
    strbuf_add(out, "%s", more);
}

static const char *name(arena *memory, const char *label, const char *part) {
    return arena_format(memory, "%s/%s", label, part);
}

// Lists the buffers that exist; moments exist only once states were kept.
static size_t list_buffers(const lbm *l, arena *memory, const char *label,
                           checkpoint_part out[PARTS]) {
    const lbm_walls *w = &l->walls;
    const uint32_t wide = l->desc.precision == LBM_F16 ? 2 : 4;
    const checkpoint_part others[] = {
        {.name = "moments0", .width = 2, .buffer = l->kept > 0 ? l->moments[0] : NULL},
        {.name = "moments1", .width = 2, .buffer = l->kept > 1 ? l->moments[1] : NULL},
        {.name = "cells0", .width = 1, .buffer = w->cells[0]},
        {.name = "cells1", .width = 1, .buffer = w->cells[1]},
        {.name = "waves", .width = 4, .buffer = w->waves},
    };
    size_t count = 0;
    for (uint32_t i = 0; i < l->layout.buffers; i++)
        out[count++] = (checkpoint_part){.name = arena_format(memory, "%s/state%u", label, i),
                                         .width = wide,
                                         .buffer = l->state[i]};
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        if (!others[i].buffer) continue;
        out[count] = others[i];
        out[count++].name = name(memory, label, others[i].name);
    }
    for (size_t i = 0; i < count; i++) out[i].size = gpu_buffer_size(out[i].buffer);
    return count;
}

void lbm_state_list(const lbm *l, const char *label, const char *more, checkpoint_list *out) {
    strbuf text = {0};
    lbm_describe(l, more, &text);
    const state_clock clock = {l->steps, l->kept, l->walls.current, l->walls.filled};
    checkpoint_add_text(out, label, "lattice", strbuf_text(&text));
    checkpoint_add_clock(out, label, &clock, sizeof clock);
    strbuf_free(&text);
    checkpoint_part buffers[PARTS];
    size_t count = list_buffers(l, &out->memory, label, buffers);
    for (size_t i = 0; i < count; i++) checkpoint_add(out, &buffers[i]);
}

// Allocates what a state with this clock needs.
static bool take_clock(lbm *l, gpu *g, const state_clock *clock) {
    if (clock->steps > UINT64_C(1) << 60 || clock->kept > clock->steps || clock->current > 1)
        return err_set("the checkpoint's clock is damaged");
    for (uint64_t i = 0; i < 2 && i < clock->kept; i++)
        if (!lbm_make_moments(l, g, (uint32_t)i)) return false;
    l->steps = clock->steps;
    l->kept = clock->kept;
    l->walls.current = clock->current;
    l->walls.filled = clock->filled != 0;
    l->walls.known = false;
    l->walls.restored = true;
    return true;
}

bool lbm_state_load(lbm *l, gpu *g, const char *label, const char *more, checkpoint *c) {
    arena memory = {0};
    strbuf text = {0};
    state_clock clock;
    checkpoint_part buffers[PARTS];
    lbm_describe(l, more, &text);
    bool done = checkpoint_require(c, name(&memory, label, "lattice"), strbuf_text(&text)) &&
                checkpoint_load_clock(c, label, &clock, sizeof clock) && take_clock(l, g, &clock);
    size_t count = done ? list_buffers(l, &memory, label, buffers) : 0;
    for (size_t i = 0; done && i < count; i++) done = checkpoint_load(c, g, &buffers[i]);
    strbuf_free(&text);
    arena_free(&memory);
    return done;
}
