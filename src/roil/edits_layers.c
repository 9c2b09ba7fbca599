// Layers of noise come and go: layers { {2, 1}, {7, 0.4} } becomes { {2, 1}, {7, 0.4}, {14, 0.2} }
// in the script's text, as it is written there.
#include "base/error.h"
#include "base/memory.h"
#include "roil/edits_impl.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { MOST_LAYERS = 64, MOST_CALLS = 16 };
static const float FINER = 2, WEAKER = 0.5f; // a layer that is added, beside the last

typedef struct layer_list { // in a text
    roil_effect *effect;
    const effect_layers *own;
    const char *text;
    source_range table;
    source_entry entries[MOST_LAYERS];
} layer_list;

// ---- which there are ----------------------------------------------------------------------------

// Returns whether an earlier list is that of the same call, as in a loop or a function.
static bool is_repeated(const effect *e, size_t index) {
    const effect_place *place = effect_find_place(e, effect_get_layers(e, index));
    for (size_t i = 0; place && i < index; i++)
        if (edits_same_place(effect_find_place(e, effect_get_layers(e, i)), place)) return true;
    return false;
}

size_t roil_list_layers(const roil_effect *e, roil_layers *out, size_t capacity) {
    size_t count = 0;
    for (size_t i = 0; i < effect_layers_count(e->effect); i++) {
        const effect_layers *l = effect_get_layers(e->effect, i);
        if (is_repeated(e->effect, i)) continue;
        if (count < capacity) out[count] = (roil_layers){l->name, l->count};
        count++;
    }
    return count;
}

static const effect_layers *find_layers(const roil_effect *e, const char *name) {
    for (size_t i = 0; i < effect_layers_count(e->effect); i++) {
        const effect_layers *l = effect_get_layers(e->effect, i);
        if (strcmp(l->name, name) == 0) return l;
    }
    return ERR_NULL("the effect has no layers called '%.64s'", name);
}

// ---- in the text --------------------------------------------------------------------------------

static bool find_call(const layer_list *l, const effect_place *place, source_call *out) {
    source_call found[MOST_CALLS];
    size_t count = source_find_calls(l->text, place->call, place->line, found, MOST_CALLS);
    if (count == 0)
        return err_set("line %d has no call of 'layers' with a table of them", place->line);
    for (size_t i = 0; i < count && i < MOST_CALLS; i++) {
        *out = found[i];
        source_range name = source_assigned_name(l->text, out);
        if (count == 1 || edits_text_is(l->text, name, l->own->name)) return true;
    }
    return err_set("line %d has several calls of 'layers'", place->line);
}

static bool read_entries(layer_list *l) {
    source_entry e = {.next = l->table.begin + 1};
    size_t count = 0;
    while (source_read_entry(l->text, l->table, e.next, &e)) {
        if (e.key.end > e.key.begin) continue;
        if (count < MOST_LAYERS) l->entries[count] = e;
        count++;
    }
    char shown[EDITS_SHOWN];
    edits_show(l->text, l->table, shown);
    return count == l->own->count || err_set("they are computed there: %s", shown);
}

// Adds the blanks before layer `i`, or where that is the first one before the second.
static void add_blanks(const layer_list *l, size_t i, strbuf *out) {
    size_t end = l->entries[i == 0 && l->own->count > 1 ? 1 : i].all.begin, at = end;
    while (at > 0 && strchr(" \t\r\n", l->text[at - 1])) at--;
    strbuf_append(out, end > at ? l->text + at : " ", end > at ? end - at : 1);
}

// Returns what goes with an entry: the comma and all that stands before the next, or of the last
// one what stands after the one before.
static source_range reach_of(const layer_list *l, const source_entry *own) {
    source_range reach = own->all;
    source_entry e = {.next = l->table.begin + 1};
    if (source_read_entry(l->text, l->table, own->next, &e)) {
        reach.end = e.all.begin;
        return reach;
    }
    for (e.next = l->table.begin + 1; source_read_entry(l->text, l->table, e.next, &e);)
        if (e.all.begin < own->all.begin) reach.begin = e.all.end;
    return reach;
}

// ---- a layer's own text -------------------------------------------------------------------------

static const effect_control *control_of(const layer_list *l, size_t i, size_t part) {
    char name[32];
    snprintf(name, sizeof name, "%s_%zu", part ? "strength" : "scale", i + 1);
    for (size_t k = 0; k < effect_control_count(l->effect->effect); k++) {
        const effect_control *c = effect_get_control(l->effect->effect, k);
        if (c->layer && strcmp(c->group, l->own->name) == 0 && strcmp(c->desc->name, name) == 0)
            return c;
    }
    return NULL;
}

static bool is_word(const char *text, source_range at) {
    for (size_t i = at.begin; i < at.end; i++)
        if (!strchr("_.", text[i]) && !isalnum((unsigned char)text[i])) return false;
    return true;
}

static bool refuse_layer(const layer_list *l, size_t i) {
    char shown[EDITS_SHOWN];
    edits_show(l->text, l->entries[i].value, shown);
    return err_set("layer %zu is computed there: %s", i + 1, shown);
}

// Adds what is written there, times a factor.
static void add_product(const char *text, source_range at, float factor, strbuf *out) {
    bool times = factor != 1;
    if (times) {
        strbuf_add_float(out, factor);
        strbuf_add(out, " * ");
    }
    strbuf_add(out, times && !is_word(text, at) ? "(%.*s)" : "%.*s", (int)(at.end - at.begin),
               text + at.begin);
}

// Adds the scale or the strength that a layer has now, times a factor.
static bool add_part(const layer_list *l, size_t i, size_t part, float factor, strbuf *out) {
    const effect_control *c = control_of(l, i, part);
    source_range layer = l->entries[i].value, at;
    if (l->text[layer.begin] != '{' || !source_find_value(l->text, layer, NULL, part + 1, &at))
        return refuse_layer(l, i);
    if (c)
        strbuf_add_float(out, effect_control_field(l->effect->effect, c)->value[0] * factor);
    else
        add_product(l->text, at, factor, out);
    return true;
}

static bool add_layer(const layer_list *l, size_t i, float finer, float weaker, strbuf *out) {
    strbuf_add(out, "{");
    if (!add_part(l, i, 0, finer, out)) return false;
    strbuf_add(out, ", ");
    if (!add_part(l, i, 1, weaker, out)) return false;
    strbuf_add(out, "}");
    return true;
}

// ---- changes ------------------------------------------------------------------------------------

// A copy comes before its layer, whose comment may follow it.
static bool find_change(const layer_list *l, size_t i, roil_layer_change how, source_range *at,
                        strbuf *text) {
    const source_entry *own = &l->entries[i];
    switch (how) {
    case ROIL_LAYER_ADD:
        *at = (source_range){own->all.end, own->all.end};
        strbuf_add(text, ",");
        add_blanks(l, i, text);
        return add_layer(l, i, FINER, WEAKER, text);
    case ROIL_LAYER_DUPLICATE:
        *at = (source_range){own->all.begin, own->all.begin};
        if (!add_layer(l, i, 1, 1, text)) return false;
        strbuf_add(text, ",");
        add_blanks(l, i, text);
        return true;
    case ROIL_LAYER_REMOVE:
        break;
    }
    *at = reach_of(l, own);
    return true;
}

static bool change(roil_edits *x, layer_list *l, size_t i, roil_layer_change how) {
    const effect_place *place = effect_find_place(l->effect->effect, l->own);
    source_call call;
    source_range at;
    strbuf text = {0};
    if (how == ROIL_LAYER_REMOVE && l->own->count == 1)
        return err_set("the last layer stays: there is no noise without one");
    if (how != ROIL_LAYER_REMOVE && l->own->count == MOST_LAYERS)
        return err_set("there are %d layers already", MOST_LAYERS);
    if (!place) return err_set("no file of the effect says them");
    edited_file *f = edits_open_file(x, place->file);
    if (!f) return false;
    l->text = f->before;
    bool found = find_call(l, place, &call);
    if (found) l->table = call.table;
    if (!found || !read_entries(l))
        return err_prefix("%s:%d: ", path_name(place->file), place->line);
    bool done = find_change(l, i, how, &at, &text) &&
                edits_replace(x, f, (edits_replacement){l->own->name, at, strbuf_text(&text)});
    strbuf_free(&text);
    return done;
}

static roil_edits *create_layer(roil_effect *e, const char *layers, size_t layer,
                                roil_layer_change how) {
    layer_list l = {.effect = e, .own = find_layers(e, layers)};
    if (!l.own) return NULL;
    if (how == ROIL_LAYER_ADD) layer = l.own->count;
    if (layer < 1 || layer > l.own->count) {
        err_set("'%s' has no layer %zu; it has %zu", layers, layer, l.own->count);
        return NULL;
    }
    roil_edits *x = edits_begin(e);
    if (!x) return NULL;
    if (!change(x, &l, layer - 1, how)) {
        roil_edit *edit = edits_add(x);
        edit->controls = arena_string(&x->memory, layers);
        edit->refusal = arena_string(&x->memory, err_get());
        return x;
    }
    for (size_t i = 0; i < effect_control_count(e->effect); i++) { // which get other numbers
        const effect_control *c = effect_get_control(e->effect, i);
        bool gone = how == ROIL_LAYER_REMOVE && c->layer == layer;
        if (c->moved && c->layer && !gone && strcmp(c->group, layers) == 0)
            edits_add_control(x, e, c);
    }
    edits_end(x);
    return x;
}

roil_edits *roil_edits_create_layer(roil_effect *e, const char *layers, size_t layer,
                                    roil_layer_change how) {
    RETURN_MADE(roil_edits, create_layer(e, layers, layer, how), roil_edits_free(made));
}
