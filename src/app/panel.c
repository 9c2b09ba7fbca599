// The panel: all controls of the effect in sections, with a search.
#include "app/panel_parts.h"
#include "base/memory.h"
#include "base/str.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PANEL_READOUTS = 64, PANEL_LAYERS = 64 };
static const float SEARCH = 48, PRESETS = 108; // heights of the parts that do not scroll, units
static const float LAYER_BUTTON = 26;          // units that one takes

panel *panel_create(void) {
    panel *p = mem_alloc(sizeof *p);
    p->palette.selected = p->curve.selected = ROIL_MAX_STOPS;
    p->pending.sent = true;
    return p;
}

void panel_destroy(panel *p) {
    if (!p) return;
    mem_free(p->controls);
    panel_model_free(&p->model);
    mem_free(p);
}

static void panel_gather(panel *p, roil_effect *e) {
    p->control_count = roil_control_count(e);
    MEM_RESERVE(p->controls, p->control_count, p->control_capacity);
    size_t count = p->control_count;
    p->control_count = 0;
    for (size_t i = 0; i < count; i++) {
        roil_control *next = &p->controls[p->control_count];
        roil_get_control(e, i, next);
        p->control_count += next->type != ROIL_EVENTS; // they are made in the picture
    }
    panel_model_fill(&p->model, p->controls, p->control_count, p->search);
}

// ---- sections ---------------------------------------------------------------------------------

static void draw_rows(live *l, const panel_section *s) {
    const panel *p = l->panel;
    panel_table_begin(s->title);
    for (size_t i = 0; i < s->count; i++) panel_row(l, &p->controls[p->model.rows[s->first + i]]);
    ui_table_end();
}

// Draws the values that a pass reports, below its controls.
static void draw_readouts(live *l, const char *pass) {
    roil_readout all[PANEL_READOUTS];
    size_t count = roil_readouts(l->effect, all, PANEL_READOUTS);
    for (size_t i = 0; i < count && i < PANEL_READOUTS; i++) {
        if (strcmp(all[i].pass, pass) != 0) continue;
        char value[96];
        app_format_readout(&all[i], value, sizeof value);
        ui_text_color(UI_DIM, "%s  %s", all[i].name, value);
    }
}

static void draw_shape(live *l, const roil_control *c) {
    if (c->type == ROIL_PALETTE)
        palette_draw(l, c->name);
    else
        curve_draw(l, c->name);
}

// ---- layers of noise --------------------------------------------------------------------------

// Draws the rows of one layer, from 1; 0: what is for all.
static void draw_layer_rows(live *l, const panel_section *s, size_t layer) {
    const panel *p = l->panel;
    for (size_t i = 0; i < s->count; i++) {
        const roil_control *c = &p->controls[p->model.rows[s->first + i]];
        if (c->layer == layer) panel_row(l, c);
    }
}

static void draw_layer(live *l, const panel_section *s, size_t layer, size_t count) {
    char label[32];
    snprintf(label, sizeof label, "layer %zu", layer);
    panel_label(label);
    ui_push(label);
    ui_align_right(2 * LAYER_BUTTON * ui_scale());
    if (ui_icon_button("duplicate", UI_ICON_COPY, false, "the same layer once more"))
        write_back_layer(l, s->title, layer, ROIL_LAYER_DUPLICATE);
    ui_same_line();
    ui_disable_begin(count < 2);
    if (ui_icon_button("remove", UI_ICON_REMOVE, false, "takes this layer out of the file"))
        write_back_layer(l, s->title, layer, ROIL_LAYER_REMOVE);
    ui_disable_end();
    ui_pop();
    draw_layer_rows(l, s, layer);
}

static void draw_layers(live *l, const panel_section *s, size_t count) {
    panel_table_begin(s->title);
    for (size_t i = 1; i <= count; i++) draw_layer(l, s, i, count);
    ui_table_end();
    if (ui_button("Add a layer")) write_back_layer(l, s->title, count, ROIL_LAYER_ADD);
    ui_tooltip(
        "twice as fine as the last, and half as strong; the file is shown before it changes");
    panel_table_begin("all");
    draw_layer_rows(l, s, 0);
    ui_table_end();
}

// Returns whether a search has found nothing of a section's layers but what is for all.
static bool leaves_layers_out(const panel *p, const panel_section *s) {
    for (size_t i = 0; i < s->count; i++)
        if (p->controls[p->model.rows[s->first + i]].layer) return false;
    return p->search[0];
}

// Returns how many layers of noise a group lists; 0: it is none.
static size_t count_layers(const live *l, const panel_section *s) {
    roil_layers all[PANEL_LAYERS];
    if (s->part != PANEL_FIELD || leaves_layers_out(l->panel, s)) return 0;
    size_t count = roil_list_layers(l->effect, all, PANEL_LAYERS);
    for (size_t i = 0; i < count && i < PANEL_LAYERS; i++)
        if (strcmp(all[i].name, s->title) == 0) return all[i].count;
    return 0;
}

static void draw_content(live *l, const panel_section *s) {
    size_t layers = count_layers(l, s);
    if (s->part == PANEL_SHAPE)
        draw_shape(l, &l->panel->controls[l->panel->model.rows[s->first]]);
    else if (layers)
        draw_layers(l, s, layers);
    else
        draw_rows(l, s);
    if (s->part == PANEL_PASS) draw_readouts(l, s->title);
}

// Returns the common title of successive sections; NULL: they have none.
static const char *chapter(panel_part part) {
    switch (part) {
    case PANEL_SHAPE:
        return "Palettes and curves";
    case PANEL_FIELD:
        return "Fields";
    case PANEL_CAMERA:
    case PANEL_SUN:
    case PANEL_SKY:
    case PANEL_OBJECT:
        return "Scene";
    case PANEL_PASS:
        return "Passes";
    default:
        return "";
    }
}

static void chapter_heading(const char *title) {
    ui_gap(8 * ui_scale());
    ui_text_color(UI_DIM, "%s", title);
}

static bool opens_at_first(panel_part part) {
    return part == PANEL_PARAMETERS || part == PANEL_GROUP || part == PANEL_SHAPE;
}

// `id` stays the same when the count in the heading changes.
static bool section_heading(const panel_section *s, const char *id) {
    char label[320], changed[32] = "";
    if (s->moved && s->part == PANEL_SHAPE)
        snprintf(changed, sizeof changed, " (changed)");
    else if (s->moved)
        snprintf(changed, sizeof changed, " (%zu changed)", s->moved);
    snprintf(label, sizeof label, "%s%s###%s", s->title, changed, id);
    return ui_section(label, opens_at_first(s->part));
}

static void draw_section(live *l, const panel_section *s) {
    char id[128]; // a pass may have the name of a group
    snprintf(id, sizeof id, "%s.%d", s->title, (int)s->part);
    bool open = true;
    if (l->panel->search[0]) {
        ui_gap(4 * ui_scale());
        ui_text_color(UI_DIM, "%s", s->title);
    } else {
        open = section_heading(s, id);
    }
    ui_push(id);
    if (open) draw_content(l, s);
    ui_pop();
}

static void draw_sections(live *l) {
    const panel_model *m = &l->panel->model;
    const char *last = "";
    for (size_t i = 0; i < m->section_count; i++) {
        const char *title = chapter(m->sections[i].part);
        if (strcmp(title, last) != 0 && !l->panel->search[0]) chapter_heading(title);
        last = title;
        draw_section(l, &m->sections[i]);
    }
}

// ---- search -----------------------------------------------------------------------------------

static void draw_search(panel *p, ui_rect where) {
    float clear = p->search[0] ? 30 * ui_scale() : 0;
    ui_panel_begin("search", where);
    ui_width(-clear);
    ui_input("##search", "Search", p->search, sizeof p->search);
    if (clear > 0) {
        ui_same_line();
        if (ui_button("\u00d7")) p->search[0] = 0;
        ui_tooltip("show everything");
    }
    ui_panel_end();
}

static void draw_list(live *l, ui_rect where) {
    const panel *p = l->panel;
    if (where.bottom <= where.top) return; // a very low window
    ui_panel_begin("panel", where);
    if (strcmp(p->search, p->searched) != 0) ui_scroll_to_top(); // what was found first
    draw_sections(l);
    if (!p->control_count)
        ui_text_color(UI_DIM, "The effect has nothing to turn.");
    else if (!p->model.row_count)
        ui_text_color(UI_DIM, "Nothing matches \"%s\".", p->search);
    ui_panel_end();
}

void panel_find(live *l, const char *search) {
    str_copy(l->panel->search, sizeof l->panel->search, search);
    l->session.panel_hidden = false;
}

void panel_draw(live *l, ui_rect where) {
    panel *p = l->panel;
    ui_rect top = where, middle = where, foot = where;
    top.bottom = middle.top = where.top + SEARCH * ui_scale();
    foot.top = middle.bottom = fmaxf(where.bottom - PRESETS * ui_scale(), top.bottom);
    draw_search(p, top);
    if (!l->effect) {
        middle.bottom = where.bottom;
        ui_panel_begin("panel", middle);
        ui_text_color(UI_DIM, "No effect is loaded yet.");
        ui_panel_end();
        return;
    }
    panel_gather(p, l->effect);
    draw_list(l, middle);
    str_copy(p->searched, sizeof p->searched, p->search);
    ui_panel_begin("presets", foot);
    presets_draw(l);
    ui_panel_end();
}
