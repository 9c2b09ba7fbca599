// Lifetimes of images, and the GPU images behind them.
//
// An image lives from the pass that writes it to the last pass that reads it. The order is walked
// once: a written image takes a free slot of its kind (slot_key), or a new one; after a pass, the
// images that it was the last to read free their slots. Invariant: two images of one slot never
// live at the same time. Outputs, kept images and images with a history live forever and never
// share.
//
// An allocation takes over images of an earlier plan: first by name and kind, so that contents
// survive, then by kind alone.
#include "base/memory.h"
#include "graph/internal.h"
#include <assert.h>
#include <string.h>

// ---- plan -------------------------------------------------------------------------------------

typedef struct planning {
    arena scratch;
    lookup kinds;
    uint32_t *free;        // of a kind: first free slot or NONE
    uint32_t *next_free;   // of a slot: next free slot of its kind
    uint32_t *kind;        // of a slot
    uint32_t *ending;      // of a place in the order: first image that is read there last
    uint32_t *next_ending; // of an image
} planning;

static uint32_t *filled(arena *a, size_t count) { // with NONE
    uint32_t *out = arena_alloc(a, count * sizeof *out);
    memset(out, 0xff, count * sizeof *out);
    return out;
}

static bool is_exclusive(const graph_node_image *image) {
    return image->output || image->history_used || image->desc.keep;
}

static bool needs_memory(const graph_node_image *image) {
    return image->read || !image->desc.optional;
}

static void find_lifetimes(const graph *g, planning *p) {
    p->ending = filled(&p->scratch, g->order_count);
    p->next_ending = filled(&p->scratch, g->image_count);
    bool *seen = arena_alloc(&p->scratch, g->image_count * sizeof *seen);
    for (size_t at = g->order_count; at-- > 0;) { // backwards: the first use met is the last one
        const graph_node_pass *pass = &g->passes[g->order[at]];
        for (size_t i = 0; i < pass->read_count + pass->write_count; i++) {
            uint32_t image =
                i < pass->read_count ? pass->reads[i] : pass->writes[i - pass->read_count];
            if (seen[image] || g->images[image].of != NONE) continue;
            seen[image] = true;
            if (is_exclusive(&g->images[image]) || !needs_memory(&g->images[image])) continue;
            p->next_ending[image] = p->ending[at];
            p->ending[at] = image;
        }
    }
}

static slot_key key_of(const graph_node_image *image) {
    return (slot_key){.format = (uint32_t)image->desc.format,
                      .width = image->size[0],
                      .height = image->size[1],
                      .depth = image->desc.depth,
                      .mips = image->desc.mips,
                      .target = image->desc.target};
}

static uint32_t kind_of(planning *p, const slot_key *key) {
    uint32_t kind = lookup_find(&p->kinds, key, sizeof *key);
    if (kind != NONE) return kind;
    return lookup_add(&p->kinds, arena_copy(&p->scratch, key, sizeof *key), sizeof *key);
}

static uint32_t new_slot(graph *g, const graph_node_image *image, bool paired) {
    slot_list *slots = &g->slots;
    MEM_RESERVE(slots->at, slots->count + 1, slots->capacity);
    slots->at[slots->count] = (graph_slot){
        .key = key_of(image),
        .name = image->desc.name,
        .paired = paired,
        .kept = image->desc.keep && !paired,
        .fresh = paired || image->desc.keep,
    };
    return (uint32_t)slots->count++;
}

static void take_slot(graph *g, planning *p, graph_node_image *image) {
    if (is_exclusive(image)) {
        image->slot = new_slot(g, image, image->history_used);
        return;
    }
    slot_key key = key_of(image);
    uint32_t kind = kind_of(p, &key);
    if (p->free[kind] != NONE) {
        image->slot = p->free[kind];
        p->free[kind] = p->next_free[image->slot];
        return;
    }
    image->slot = new_slot(g, image, false);
    p->kind[image->slot] = kind;
}

static void give_slot(planning *p, uint32_t slot) {
    p->next_free[slot] = p->free[p->kind[slot]];
    p->free[p->kind[slot]] = slot;
}

void graph_plan_memory(graph *g) {
    planning p = {0};
    find_lifetimes(g, &p);
    p.free = filled(&p.scratch, g->image_count); // never more slots or kinds than images
    p.next_free = filled(&p.scratch, g->image_count);
    p.kind = filled(&p.scratch, g->image_count);
    for (size_t i = 0; i < g->image_count; i++) g->images[i].slot = NONE;

    for (size_t at = 0; at < g->order_count; at++) {
        const graph_node_pass *pass = &g->passes[g->order[at]];
        for (size_t i = 0; i < pass->write_count; i++) {
            graph_node_image *image = &g->images[pass->writes[i]];
            if (image->slot == NONE && needs_memory(image)) take_slot(g, &p, image);
        }
        for (uint32_t i = p.ending[at]; i != NONE; i = p.next_ending[i])
            give_slot(&p, g->images[i].slot);
    }
    for (size_t i = 0; i < g->image_count; i++)
        if (g->images[i].history_used) {
            graph_node_image *history = &g->images[g->images[i].history];
            history->slot = new_slot(g, history, true);
        }
    lookup_free(&p.kinds);
    arena_free(&p.scratch);
}

// ---- allocation -------------------------------------------------------------------------------

void graph_retire_memory(graph *g) {
    for (size_t i = 0; i < g->slots.count; i++) {
        if (!g->slots.at[i].memory) continue;
        *MEM_ADD(g->kept.at, g->kept.count, g->kept.capacity) = g->slots.at[i];
    }
    g->slots.count = 0;
    g->compiled = g->allocated = false;
}

void graph_free_kept(graph *g, gpu *device) {
    for (size_t i = 0; i < g->kept.count; i++)
        if (g->kept.at[i].memory) {
            assert(device);
            gpu_image_destroy(device, g->kept.at[i].memory);
        }
    g->kept.count = 0;
}

static bool is_same_kind(const graph_slot *a, const graph_slot *b) {
    return memcmp(&a->key, &b->key, sizeof a->key) == 0;
}

static void take_over(graph_slot *to, graph_slot *from) {
    to->memory = from->memory;
    to->fresh = (to->paired || to->kept) && from->fresh;
    from->memory = NULL;
}

// Numbers the slots of a list by name. `slots` (free with mem_free) gives the slot of a number.
static lookup index_names(const slot_list *list, uint32_t **slots) {
    lookup names = {0};
    *slots = mem_alloc(list->count * sizeof **slots);
    for (size_t i = 0; i < list->count; i++) {
        const char *name = list->at[i].name;
        if (lookup_find(&names, name, strlen(name)) == NONE)
            (*slots)[lookup_add(&names, name, strlen(name))] = (uint32_t)i;
    }
    return names;
}

static bool can_be(const graph_slot *a, const graph_slot *b) {
    return a->paired == b->paired && a->kept == b->kept && is_same_kind(a, b);
}

static void take_over_by_name(graph *g) {
    uint32_t *slots;
    lookup names = index_names(&g->kept, &slots);
    for (size_t i = 0; i < g->slots.count; i++) {
        graph_slot *slot = &g->slots.at[i];
        uint32_t name = lookup_find(&names, slot->name, strlen(slot->name));
        if (slot->memory || name == NONE) continue;
        graph_slot *old = &g->kept.at[slots[name]];
        if (old->memory && can_be(slot, old)) take_over(slot, old);
    }
    mem_free(slots);
    lookup_free(&names);
}

static void take_over_by_kind(graph *g) {
    planning p = {0};
    p.free = filled(&p.scratch, g->kept.count);
    p.next_free = filled(&p.scratch, g->kept.count);
    for (size_t i = g->kept.count; i-- > 0;) {
        if (!g->kept.at[i].memory) continue;
        uint32_t kind = kind_of(&p, &g->kept.at[i].key);
        p.next_free[i] = p.free[kind];
        p.free[kind] = (uint32_t)i;
    }
    for (size_t i = 0; i < g->slots.count; i++) {
        graph_slot *slot = &g->slots.at[i];
        uint32_t kind = lookup_find(&p.kinds, &slot->key, sizeof slot->key);
        if (slot->memory || kind == NONE || p.free[kind] == NONE) continue;
        graph_slot *old = &g->kept.at[p.free[kind]];
        p.free[kind] = p.next_free[p.free[kind]];
        old->fresh = true; // what it holds is no history of this image
        take_over(slot, old);
    }
    lookup_free(&p.kinds);
    arena_free(&p.scratch);
}

static gpu_image_desc describe(const graph_slot *slot) {
    uint32_t use = GPU_USE_SAMPLED;
    if (slot->key.target) use |= GPU_USE_TARGET;
    if (slot->key.format != GPU_D32F)
        use |= GPU_USE_STORAGE; // a target may be finished by a dispatch
    return (gpu_image_desc){.label = slot->name,
                            .format = (gpu_format)slot->key.format,
                            .width = slot->key.width,
                            .height = slot->key.height,
                            .depth = slot->key.depth,
                            .mips = slot->key.mips,
                            .use = use};
}

uint64_t graph_list_memory(const graph *g, budget_list *out) {
    uint64_t had = 0;
    for (size_t i = 0; i < g->slots.count; i++) {
        const gpu_image_desc desc = describe(&g->slots.at[i]);
        if (!g->slots.at[i].memory) budget_list_add(out, desc.label, gpu_image_bytes(&desc));
    }
    for (size_t i = 0; i < g->kept.count; i++) {
        const gpu_image_desc desc = describe(&g->kept.at[i]);
        if (g->kept.at[i].memory) had += gpu_image_bytes(&desc);
    }
    return had;
}

void graph_lend(const graph *g, gpu *device) {
    gpu_image_desc *going = mem_alloc(g->slots.count * sizeof *going);
    size_t count = 0;
    for (size_t i = 0; i < g->slots.count; i++)
        if (g->slots.at[i].memory) going[count++] = describe(&g->slots.at[i]);
    gpu_lend_memory(device, going, count);
    mem_free(going);
}

bool graph_allocate(graph *g, gpu *device) {
    assert(g->compiled);
    take_over_by_name(g);
    take_over_by_kind(g);
    graph_free_kept(g, device);
    for (size_t i = 0; i < g->slots.count; i++) {
        graph_slot *slot = &g->slots.at[i];
        if (slot->memory) continue;
        gpu_image_desc desc = describe(slot);
        slot->memory = gpu_image_create(device, &desc);
        if (!slot->memory) return err_prefix("image '%s': ", slot->name);
    }
    g->allocated = true;
    return true;
}

static void swap_memory(graph_slot *a, graph_slot *b) {
    gpu_image *memory = a->memory;
    bool fresh = a->fresh;
    a->memory = b->memory;
    a->fresh = b->fresh;
    b->memory = memory;
    b->fresh = fresh;
}

static bool has_memory(const graph *g) {
    for (size_t i = 0; i < g->slots.count; i++)
        if (!g->slots.at[i].memory) return false;
    return g->compiled;
}

void graph_adopt(graph *g, graph *from) {
    assert(g->compiled);
    uint32_t *slots;
    lookup names = index_names(&from->slots, &slots);
    for (size_t i = 0; i < g->slots.count; i++) {
        graph_slot *slot = &g->slots.at[i];
        uint32_t name = lookup_find(&names, slot->name, strlen(slot->name));
        if (name == NONE) continue;
        graph_slot *old = &from->slots.at[slots[name]];
        if (can_be(slot, old)) swap_memory(slot, old);
    }
    mem_free(slots);
    lookup_free(&names);
    g->allocated = has_memory(g);
    from->allocated = has_memory(from);
}
