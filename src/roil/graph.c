// The graph, for tools that show it.
#include "base/error.h"
#include "base/memory.h"
#include "roil/roil_impl.h"
#include <string.h>

// A part of a pass is called "LABEL.PART"; labels have no dots.
static pass *owner_of(roil_effect *e, const char *name) {
    size_t length = strcspn(name, ".");
    for (size_t i = 0; i < effect_pass_count(e->effect); i++) {
        pass *p = effect_get_pass(e->effect, i);
        if (strncmp(pass_label(p), name, length) == 0 && !pass_label(p)[length]) return p;
    }
    return NULL;
}

static size_t list_passes(roil_effect *e, roil_graph_pass *out, size_t capacity) {
    const graph *g = effect_graph(e->effect);
    size_t count = graph_passes(g, NULL, 0);
    graph_pass_info *all = mem_alloc(count * sizeof *all);
    graph_passes(g, all, count);
    for (size_t i = 0; i < count && i < capacity; i++) {
        const pass *p = owner_of(e, all[i].name);
        const effect_place *place = p ? effect_pass_place(e->effect, p) : NULL;
        out[i] = (roil_graph_pass){.name = all[i].name,
                                   .pass = p ? pass_label(p) : all[i].name,
                                   .file = place ? place->file : NULL,
                                   .line = place ? place->line : 0,
                                   .culled = !all[i].runs};
    }
    mem_free(all);
    return count;
}

size_t roil_graph_passes(roil_effect *e, roil_graph_pass *out, size_t capacity) {
    mem_enter();
    return roil_leave_count(list_passes(e, out, capacity));
}

static size_t list_links(roil_effect *e, roil_graph_link *out, size_t capacity) {
    const graph *g = effect_graph(e->effect);
    size_t count = graph_passes(g, NULL, 0), links = 0;
    graph_pass_info *all = mem_alloc(count * sizeof *all);
    graph_passes(g, all, count);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < all[i].read_count; k++, links++)
            if (links < capacity) out[links] = (roil_graph_link){i, all[i].reads[k], false};
        for (size_t k = 0; k < all[i].write_count; k++, links++)
            if (links < capacity) out[links] = (roil_graph_link){i, all[i].writes[k], true};
    }
    mem_free(all);
    return links;
}

size_t roil_graph_links(roil_effect *e, roil_graph_link *out, size_t capacity) {
    mem_enter();
    return roil_leave_count(list_links(e, out, capacity));
}

char *roil_graph_fields(roil_effect *e, const char *name) {
    mem_enter();
    const pass *p = owner_of(e, name);
    if (!p) {
        err_set("no pass '%s'", name);
        return roil_leave_text(NULL);
    }
    const shader_interface *face = pass_interface(p);
    strbuf text = {0};
    for (size_t i = 0; i < face->field_count; i++) {
        const field *node = pass_get_field(p, i);
        if (!node) continue;
        strbuf_add(&text, "%s%s = ", text.length ? "\n" : "", face->fields[i].name);
        field_print(node, &text);
    }
    strbuf_append(&text, "", 0);
    return roil_leave_text(text.text);
}
