// The tree over everything that is placed. When something has moved, its boxes are refitted. When
// their cost has grown too much, the tree is rebuilt (Lauterbach et al., "RT-DEFORM: Interactive
// ray tracing of dynamic scenes using BVHs", 2006, section 3.3). A few items form a single leaf.
#include "base/memory.h"
#include "scene/bvh_impl.h"
#include "scene/runs.h"
#include <string.h>

enum {
    ONE_LEAF = 8, // items that need no tree
    LOOK = 8,     // part of the items that must have moved before the cost is looked at
};
static const float node_cost = 0.25f; // a ray is turned into the space of each item that it meets
static const float worn_out = 1.5f;   // costs by those of the tree when it was built

size_t bvh_top_nodes(size_t items) {
    return items <= ONE_LEAF ? 1 : 2 * items - 1;
}

size_t bvh_top_wide(size_t items) {
    return 1 + bvh_top_nodes(items) / 2;
}

bool bvh_is_nowhere(const struct bvh_instance *item) {
    return item->low.v[0] >= 1e30f;
}

static bvh_bounds item_box(const struct bvh_instance *item) {
    bvh_bounds box = bvh_bounds_empty();
    if (bvh_is_nowhere(item)) return box;
    memcpy(box.low, item->low.v, sizeof box.low);
    memcpy(box.high, item->high.v, sizeof box.high);
    return box;
}

// An empty box is placed where no ray goes.
static void set_box(struct bvh_node *node, const bvh_bounds *box) {
    for (int a = 0; a < 3; a++) {
        bool empty = box->low[a] > box->high[a];
        node->low.v[a] = empty ? 1e30f : box->low[a];
        node->high.v[a] = empty ? 1e30f : box->high[a];
    }
}

static bvh_bounds node_box(const struct bvh_node *node) {
    bvh_bounds box = bvh_bounds_empty();
    if (node->low.v[0] >= 1e30f) return box;
    memcpy(box.low, node->low.v, sizeof box.low);
    memcpy(box.high, node->high.v, sizeof box.high);
    return box;
}

static bvh_bounds leaf_box(const scene_bvh *b, uint32_t below) {
    bvh_bounds box = bvh_bounds_empty();
    for (uint32_t i = bvh_leaf_first(below); i < bvh_leaf_end(below); i++) {
        bvh_bounds one = item_box(&b->items[i]);
        bvh_bounds_add(&box, &one);
    }
    return box;
}

void bvh_top_moved(scene_bvh *b, size_t place) {
    b->top_moved++;
    if (b->top_count) b->stale[b->leaf_of[place]] = 1;
}

// Children are stored after their parents, so the order is walked backwards.
static void top_fit(scene_bvh *b) {
    struct bvh_node *nodes = b->forest.nodes;
    for (uint32_t i = b->top_count; i-- > 0;) {
        if (!b->stale[i]) continue;
        b->stale[i] = 0;
        struct bvh_node before = nodes[i];
        bvh_bounds box;
        if (bvh_is_leaf(before.below)) {
            box = leaf_box(b, before.below);
        } else {
            bvh_bounds second = node_box(&nodes[before.below + 1]);
            box = node_box(&nodes[before.below]);
            bvh_bounds_add(&box, &second);
        }
        set_box(&nodes[i], &box);
        if (memcmp(&before, &nodes[i], sizeof before) == 0) continue;
        if (b->slots[i] != BVH_NO_SLOT) {
            bvh_wide_set_box(b->wide, b->slots[i], &nodes[i]);
            run_mark(b->wide_marks, b->slots[i] / 4);
        }
        b->stale[b->parents[i]] = i > 0;
    }
}

// Returns the area of all boxes relative to that of the items. It does not change when everything
// moves, or when one item moves far away.
static float cost(const scene_bvh *b) {
    double nodes = 0, items = 0;
    for (uint32_t i = 0; i < b->top_count; i++) {
        bvh_bounds box = node_box(&b->forest.nodes[i]);
        nodes += (double)bvh_bounds_area(&box);
    }
    for (size_t i = 0; i < b->item_count; i++) {
        bvh_bounds box = item_box(&b->items[i]);
        items += (double)bvh_bounds_area(&box);
    }
    return items > 0 ? (float)(nodes / items) : 0;
}

// ---- building ---------------------------------------------------------------------------------

typedef struct top_build {
    uint32_t *order; // items, leaf by leaf
    uint32_t count;
} top_build;

static uint32_t add_leaf(void *user, const bvh_piece *pieces, size_t count) {
    top_build *t = user;
    uint32_t first = t->count;
    for (size_t i = 0; i < count; i++) t->order[t->count++] = pieces[i].first;
    return first;
}

// An item that is not visible still has a place in the tree, in the middle of the others.
static bvh_piece *make_pieces(const scene_bvh *b) {
    bvh_piece *pieces = mem_alloc(b->item_count * sizeof *pieces);
    for (size_t i = 0; i < b->item_count; i++) {
        bvh_piece *p = &pieces[i];
        p->box = item_box(&b->items[b->item_at[i]]);
        p->first = (uint32_t)i;
        if (p->box.low[0] > p->box.high[0]) continue;
        for (int a = 0; a < 3; a++) p->middle[a] = 0.5f * p->box.low[a] + 0.5f * p->box.high[a];
    }
    return pieces;
}

static void top_reorder(scene_bvh *b, const uint32_t *order) {
    struct bvh_instance *before = mem_copy(b->items, b->item_count * sizeof *before);
    uint32_t *place = mem_copy(b->item_at, b->item_count * sizeof *place);
    for (uint32_t k = 0; k < b->item_count; k++) {
        b->items[k] = before[place[order[k]]];
        b->item_at[order[k]] = k;
    }
    mem_free(before);
    mem_free(place);
    memset(b->changed, 1, run_marks(b->item_count));
}

// Records the position of every node and item. All of the tree is new.
static void top_link(scene_bvh *b) {
    for (uint32_t i = 0; i < b->top_count; i++) {
        const struct bvh_node *node = &b->forest.nodes[i];
        for (uint32_t k = bvh_leaf_first(node->below); k < bvh_leaf_end(node->below); k++)
            b->leaf_of[k] = i;
        if (bvh_is_leaf(node->below)) continue;
        b->parents[node->below] = b->parents[node->below + 1] = i;
    }
    memset(b->stale, 1, b->top_count);
    memset(b->slots, 0xff, b->top_count * sizeof *b->slots);
    bvh_widening made = {.nodes = b->forest.nodes, .out = b->wide, .count = 1, .slots = b->slots};
    b->top_below = bvh_widen(&made, 0);
    memset(b->wide_marks, 1, run_marks(bvh_top_wide(b->item_count)));
    b->headed = false;
}

static void top_rebuild(scene_bvh *b) {
    if (b->item_count <= ONE_LEAF) {
        b->top_count = 1;
        b->forest.nodes[0] =
            (struct bvh_node){.next = BVH_DONE, .below = bvh_leaf(0, b->item_count)};
    } else {
        top_build t = {.order = mem_alloc(b->item_count * sizeof *t.order)};
        bvh_build made = {.add_leaf = add_leaf, .user = &t, .node_cost = node_cost};
        bvh_piece *pieces = make_pieces(b);
        bvh_build_tree(&made, pieces, b->item_count);
        memcpy(b->forest.nodes, made.nodes, made.node_count * sizeof *made.nodes);
        b->top_count = (uint32_t)made.node_count;
        top_reorder(b, t.order);
        mem_free(pieces);
        mem_free(made.nodes);
        mem_free(t.order);
    }
    top_link(b);
    top_fit(b);
    b->top_cost = cost(b);
    b->top_moved = 0;
}

void bvh_top_update(scene_bvh *b) {
    if (b->item_count == 0) return;
    if (b->top_count == 0) top_rebuild(b);
    if (b->top_moved == 0) return;
    top_fit(b);
    if (b->top_moved < b->item_count / LOOK || b->item_count <= ONE_LEAF) return;
    b->top_moved = 0;
    if (cost(b) > worn_out * b->top_cost) top_rebuild(b);
}
