// The children of a node that rays visit most often, the largest, are replaced by their own
// children until there are four.
#include "scene/bvh_wide.h"
#include <string.h>

enum { LANES = 4 };

typedef struct attempt {
    bvh_widening *w;
    int lanes;     // children at most
    uint32_t most; // kept for later by a walk that is where most is
} attempt;

static float area(const struct bvh_node *node) {
    bvh_bounds box;
    memcpy(box.low, node->low.v, sizeof box.low);
    memcpy(box.high, node->high.v, sizeof box.high);
    return bvh_bounds_area(&box);
}

// Returns the largest child that has children of its own; -1: none has.
static int choose_child(const struct bvh_node *nodes, const uint32_t *children, int count) {
    int chosen = -1;
    float largest = -1;
    for (int i = 0; i < count; i++) {
        const struct bvh_node *node = &nodes[children[i]];
        if (bvh_is_leaf(node->below) || !(area(node) > largest)) continue;
        largest = area(node);
        chosen = i;
    }
    return chosen;
}

static int list_children(const attempt *a, const struct bvh_node *node, uint32_t children[LANES]) {
    int count = 2;
    children[0] = node->below;
    children[1] = node->below + 1;
    while (count < a->lanes) {
        int i = choose_child(a->w->nodes, children, count);
        if (i < 0) break;
        uint32_t first = a->w->nodes[children[i]].below;
        children[i] = first;
        children[count++] = first + 1;
    }
    return count;
}

void bvh_wide_set_box(struct bvh_wide *out, uint32_t slot, const struct bvh_node *node) {
    for (int a = 0; a < 3; a++) {
        out[slot / LANES].low[a].v[slot % LANES] = node->low.v[a];
        out[slot / LANES].high[a].v[slot % LANES] = node->high.v[a];
    }
}

// `kept`: by a walk that comes to the node.
static uint32_t widen(attempt *a, uint32_t index, uint32_t kept) {
    static const struct bvh_node nowhere = {.low = {{1e30f, 1e30f, 1e30f}},
                                            .high = {{1e30f, 1e30f, 1e30f}}};
    bvh_widening *w = a->w;
    const struct bvh_node *node = &w->nodes[index];
    if (bvh_is_leaf(node->below)) return node->below;
    uint32_t children[LANES], place = w->count++;
    int count = list_children(a, node, children);
    kept += (uint32_t)count - 1;
    if (kept > a->most) a->most = kept;
    for (int i = 0; i < LANES; i++) {
        uint32_t slot = LANES * place + (uint32_t)i;
        bvh_wide_set_box(w->out, slot, i < count ? &w->nodes[children[i]] : &nowhere);
        w->out[place].below.v[i] = i < count ? widen(a, children[i], kept) : 0;
        if (w->slots && i < count) w->slots[children[i]] = slot;
    }
    return place;
}

uint32_t bvh_widen(bvh_widening *w, uint32_t root) {
    uint32_t first = w->count;
    attempt four = {.w = w, .lanes = LANES}, two = {.w = w, .lanes = 2};
    uint32_t below = widen(&four, root, 0);
    if (four.most < BVH_KEPT) return below;
    w->count = first; // a tree that is that deep keeps one node on each level
    return widen(&two, root, 0);
}
