// Declares a graph, and answers questions about it.
//
// Every declaration invalidates the last compilation: handles stay valid, the order and the memory
// do not.
#include "graph/graph.h"
#include "base/memory.h"
#include "graph/internal.h"
#include <assert.h>
#include <string.h>

graph *graph_create(void) {
    return mem_alloc(sizeof(graph));
}

void graph_destroy(graph *g, gpu *device) {
    if (!g) return;
    graph_retire_memory(g);
    graph_free_kept(g, device);
    mem_free(g->slots.at);
    mem_free(g->kept.at);
    mem_free(g->order);
    mem_free(g->images);
    mem_free(g->passes);
    lookup_free(&g->image_names);
    lookup_free(&g->pass_names);
    arena_free(&g->names);
    mem_free(g);
}

static uint32_t index_of(const graph *g, graph_image image) {
    assert(image.id != 0 && image.id <= g->image_count);
    (void)g;
    return image.id - 1;
}

static void make_stale(graph *g) {
    g->compiled = g->allocated = false;
}

// ---- images -----------------------------------------------------------------------------------

static bool check_image(const graph *g, const graph_image_desc *d) {
    if (lookup_find(&g->image_names, d->name, strlen(d->name)) != NONE)
        return err_set("two images are named '%s'; names of images are unique", d->name);
    if (d->format <= GPU_FORMAT_NONE || d->format >= GPU_FORMAT_COUNT)
        return err_set("image '%s' has no format", d->name);
    if (d->format == GPU_RGBA8_SRGB)
        return err_set("image '%s': passes cannot write rgba8_srgb; use rgba8", d->name);
    bool fixed = d->width || d->height || d->depth;
    if (!(d->scale >= 0)) return err_set("image '%s': scale must be above 0", d->name);
    if (d->scale > 0 && fixed)
        return err_set("image '%s' has a scale and a fixed size; give one of them", d->name);
    if (d->scale == 0 && !(d->width && d->height))
        return err_set("image '%s' has no size; give a scale, or width and height", d->name);
    if (d->depth && (d->target || d->format == GPU_D32F))
        return err_set("image '%s' is 3D; only 2D images can be drawn to", d->name);
    return true;
}

static graph_image image_append(graph *g, const graph_image_desc *desc, uint32_t of) {
    assert(g->image_count < NONE - 1);
    graph_node_image *image = MEM_ADD(g->images, g->image_count, g->image_capacity);
    *image = (graph_node_image){.desc = *desc,
                                .mips = desc->mips ? desc->mips : 1,
                                .of = of,
                                .history = NONE,
                                .writer = NONE,
                                .slot = NONE};
    if (desc->format == GPU_D32F) image->desc.target = true;
    lookup_add(&g->image_names, desc->name, strlen(desc->name));
    make_stale(g);
    return (graph_image){(uint32_t)g->image_count};
}

graph_image graph_add_image(graph *g, const graph_image_desc *desc) {
    assert(desc->name);
    if (!check_image(g, desc)) return (graph_image){0};
    graph_image_desc copy = *desc;
    copy.name = arena_string(&g->names, desc->name);
    return image_append(g, &copy, NONE);
}

bool graph_has_history(const graph *g) {
    for (size_t i = 0; i < g->image_count; i++)
        if (g->images[i].history_used) return true;
    return false;
}

graph_image graph_add_history(graph *g, graph_image image) {
    uint32_t index = index_of(g, image);
    const graph_node_image *node = &g->images[index];
    if (node->of != NONE) {
        err_set("image '%s' is a history already; only one frame is kept", node->desc.name);
        return (graph_image){0};
    }
    if (node->history != NONE) return (graph_image){node->history + 1};

    graph_image_desc desc = node->desc;
    desc.mips = node->mips;
    desc.name = arena_format(&g->names, "%s history", node->desc.name);
    if (lookup_find(&g->image_names, desc.name, strlen(desc.name)) != NONE) {
        err_set("an image is named '%s'; the history of '%s' needs that name", desc.name,
                node->desc.name);
        return (graph_image){0};
    }
    graph_image history = image_append(g, &desc, index);
    g->images[index].history = history.id - 1;
    return history;
}

void graph_add_output(graph *g, graph_image image) {
    g->images[index_of(g, image)].output = true;
    make_stale(g);
}

void graph_remove_output(graph *g, graph_image image) {
    g->images[index_of(g, image)].output = false;
    make_stale(g);
}

// ---- passes -----------------------------------------------------------------------------------

static uint32_t *copy_handles(graph *g, const graph_image *images, size_t *count) {
    uint32_t *out = arena_alloc(&g->names, *count * sizeof *out);
    size_t used = 0;
    for (size_t i = 0; i < *count; i++)
        if (images[i].id) out[used++] = index_of(g, images[i]);
    *count = used;
    return out;
}

bool graph_add_pass(graph *g, const graph_pass_desc *desc) {
    assert(desc->name && g->pass_count < NONE);
    if (lookup_find(&g->pass_names, desc->name, strlen(desc->name)) != NONE)
        return err_set("two passes are named '%s'; names of passes are unique", desc->name);
    for (size_t i = 0; i < desc->write_count; i++) {
        if (desc->writes[i].id == 0) continue;
        const graph_node_image *image = &g->images[index_of(g, desc->writes[i])];
        if (image->of != NONE)
            return err_set("pass '%s' writes '%s'; a history can only be read", desc->name,
                           image->desc.name);
    }
    graph_node_pass pass = {.name = arena_string(&g->names, desc->name),
                            .read_count = desc->read_count,
                            .write_count = desc->write_count,
                            .keep = desc->keep,
                            .simulates = desc->simulates,
                            .record = desc->record,
                            .user = desc->user};
    pass.reads = copy_handles(g, desc->reads, &pass.read_count);
    pass.writes = copy_handles(g, desc->writes, &pass.write_count);
    *MEM_ADD(g->passes, g->pass_count, g->pass_capacity) = pass;
    lookup_add(&g->pass_names, pass.name, strlen(pass.name));
    make_stale(g);
    return true;
}

void graph_redirect(graph *g, graph_image from, graph_image to, const char *but) {
    const uint32_t old = index_of(g, from), new = index_of(g, to);
    for (size_t i = 0; i < g->pass_count; i++) {
        graph_node_pass *pass = &g->passes[i];
        for (size_t k = 0; k < pass->read_count && strcmp(pass->name, but) != 0; k++)
            if (pass->reads[k] == old) pass->reads[k] = new;
    }
    make_stale(g);
}

// ---- questions --------------------------------------------------------------------------------

static const graph_slot *slot_of(const graph *g, graph_image image) {
    uint32_t slot = g->images[index_of(g, image)].slot;
    return g->compiled && slot != NONE ? &g->slots.at[slot] : NULL;
}

gpu_image *graph_get_image(const graph *g, graph_image image) {
    const graph_slot *slot = slot_of(g, image);
    return slot ? slot->memory : NULL;
}

const graph_image_desc *graph_get_desc(const graph *g, graph_image image) {
    return &g->images[index_of(g, image)].desc;
}

bool graph_is_read(const graph *g, graph_image image) {
    assert(g->compiled);
    return g->images[index_of(g, image)].read;
}

void graph_get_size(const graph *g, graph_image image, uint32_t size[3]) {
    assert(g->compiled);
    memcpy(size, g->images[index_of(g, image)].size, 3 * sizeof *size);
}

graph_image graph_find_image(const graph *g, const char *name) {
    uint32_t index = lookup_find(&g->image_names, name, strlen(name));
    return (graph_image){index == NONE ? 0 : index + 1};
}

size_t graph_images(const graph *g, graph_image *out, size_t capacity) {
    for (size_t i = 0; i < g->image_count && i < capacity; i++)
        out[i] = (graph_image){(uint32_t)i + 1};
    return g->image_count;
}

size_t graph_order(const graph *g, const char **out, size_t capacity) {
    if (!g->compiled) return 0;
    for (size_t i = 0; i < g->order_count && i < capacity; i++)
        out[i] = g->passes[g->order[i]].name;
    return g->order_count;
}

static graph_pass_info info_of(const graph_node_pass *p) {
    return (graph_pass_info){p->name, p->reads, p->writes, p->read_count, p->write_count, p->live};
}

size_t graph_passes(const graph *g, graph_pass_info *out, size_t capacity) {
    size_t count = 0;
    if (!g->compiled) return 0;
    for (size_t i = 0; i < g->order_count; i++, count++)
        if (count < capacity) out[count] = info_of(&g->passes[g->order[i]]);
    for (size_t i = 0; i < g->pass_count; i++) {
        if (g->passes[i].live) continue;
        if (count < capacity) out[count] = info_of(&g->passes[i]);
        count++;
    }
    return count;
}

bool graph_shares_memory(const graph *g, graph_image a, graph_image b) {
    const graph_slot *slot = slot_of(g, a);
    return slot && slot == slot_of(g, b);
}

bool graph_has_content(const graph *g, graph_image image) {
    uint32_t slot = g->images[index_of(g, image)].slot;
    return slot != NONE && g->slots.at[slot].kept && !g->slots.at[slot].fresh;
}

bool graph_is_alone(const graph *g, graph_image image) {
    if (!slot_of(g, image)) return false;
    uint32_t index = index_of(g, image);
    for (size_t i = 0; i < g->image_count; i++)
        if (i != index && g->images[i].slot == g->images[index].slot) return false;
    return true;
}
