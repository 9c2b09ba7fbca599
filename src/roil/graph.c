// The graph, for tools that show it, and what makes it slow.
#include "base/error.h"
#include "base/map.h"
#include "base/memory.h"
#include "field/field.h"
#include "roil/roil_impl.h"
#include <inttypes.h>
#include <stdio.h>
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
        const effect_place *place = p ? effect_find_place(e->effect, p) : NULL;
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
    if (!p) return roil_leave_text(ERR_NULL("no pass '%s'", name));
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

// ---- what is slow -----------------------------------------------------------------------------

static const double most = 0.5; // of the time of a frame, or of the work of a pass's fields
static const uint64_t texels = 64 * 64 * 64; // of a tile, unless the script says another resolution

typedef struct work { // rough operations at a point, of all nodes once
    map seen;
    double all, dearest;
    const field *noise; // the dearest one; NULL: none
    int octaves;        // of it
} work;

static void work_add(work *w, const field *node) {
    if (node->uniform || map_find(&w->seen, node, 0)) return;
    map_set(&w->seen, node, 0, 1);
    for (size_t i = 0; i < FIELD_MAX_ARGS && node->args[i]; i++) work_add(w, node->args[i]);
    const bool noise = strcmp(node->kind->group, "noise") == 0;
    const field *octaves = noise ? node->args[1] : NULL; // as in every row of noise
    const int count = octaves && field_is_constant(octaves) ? (int)(octaves->value[0] + 0.5f) : 1;
    const double own = (double)node->kind->cost * count;
    w->all += own;
    if (!noise || own <= w->dearest) return;
    w->noise = node;
    w->dearest = own;
    w->octaves = count;
}

// The pass of the script that takes most by evaluating its fields, and the share of the frame that
// this takes. NULL: none takes much.
static pass *slowest(roil_effect *e, double *share) {
    roil_time times[256];
    size_t count = roil_times(e, times, COUNT_OF(times)), worst = 0;
    double sum = 0;
    if (count > COUNT_OF(times)) count = COUNT_OF(times);
    for (size_t i = 0; i < count; i++) {
        sum += times[i].milliseconds;
        if (times[i].milliseconds > times[worst].milliseconds) worst = i;
    }
    *share = sum > 0 ? times[worst].milliseconds / sum : 0;
    const char *part = *share >= most ? strchr(times[worst].pass, '.') : NULL;
    const bool fields = *share >= most && (!part || strcmp(part, ".medium") == 0);
    return fields ? owner_of(e, times[worst].pass) : NULL;
}

static uint64_t samples_of(pass *p) {
    const shader_interface *face = pass_interface(p);
    uint64_t values[64];
    if (!face->counter_count || face->counter_count > COUNT_OF(values) ||
        !pass_read_counters(p, values))
        return 0;
    for (size_t i = 0; i < face->counter_count; i++)
        if (strcmp(face->counters[i].name, "samples") == 0) return values[i];
    return 0;
}

bool roil_slow(roil_effect *e, char *out, size_t capacity) {
    double share;
    pass *p = slowest(e, &share);
    const uint64_t samples = p ? samples_of(p) : 0;
    if (samples < 2 * texels) return false; // also where they are not counted
    work w = {0};
    for (size_t i = 0; i < pass_interface(p)->field_count; i++) {
        const field *node = pass_get_field(p, i);
        if (node) work_add(&w, node);
    }
    map_free(&w.seen);
    if (!w.noise || w.dearest < most * w.all) return false;
    snprintf(out, capacity,
             "%s takes %.0f %%: %s with %d octave%s is evaluated up to %.1f million times; "
             "`:tile()` evaluates it %" PRIu64 " times",
             pass_label(p), 100 * share, w.noise->kind->name, w.octaves, w.octaves == 1 ? "" : "s",
             (double)samples * 1e-6, texels);
    return true;
}
