// A row of the panel: a control's name, hints, and the widget that sets it.
#include "app/panel_parts.h"
#include "base/clock.h"
#include "base/str.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const float ROW = 24, TEXT = 16;            // units: heights of a widget and of a letter
static const float MARK = 14, RESET = 24, GAP = 8; // units, at the right of the label
static const double PENDING = 10;                  // seconds that a build may take

void panel_table_begin(const char *id) {
    ui_table_begin(id, 2, (const float[]){2, 3});
}

// ---- what happens to it -----------------------------------------------------------------------

static void row_set_value(live *l, const roil_control *c, const float value[4]) {
    strbuf text = {0};
    panel_value_text(c, value, &text);
    live_set(l, c->name, strbuf_text(&text));
    strbuf_free(&text);
}

void panel_reset(live *l, const char *name) {
    l->panel->pending = (pending_value){.sent = true};
    live_reset(l, name);
}

static void panel_copy_lua(live *l, const char *name) {
    char *text = roil_control_lua(l->effect, name);
    if (text) {
        ui_copy(text);
        live_notice(l, "copied %s as Lua", name);
    } else {
        live_notice(l, "%s", roil_error());
    }
    roil_free(text);
}

static void menu(live *l, const roil_control *c, const char *id) {
    if (!ui_menu_begin(id)) return;
    if (c->driven && ui_item("Override")) row_set_value(l, c, c->value);
    if (c->moved && ui_item("Reset")) panel_reset(l, c->name);
    if (c->moved && ui_item("Write into the file")) write_back_ask(l, c->name);
    if (!c->parameter && !c->driven && ui_item("Make it a parameter")) write_back_pin(l, c->name);
    if (ui_item("Copy as Lua")) panel_copy_lua(l, c->name);
    if (ui_item("Copy name")) ui_copy(c->name);
    ui_menu_end();
}

static void help(const roil_control *c) {
    if (!ui_hovered()) return;
    strbuf text = {0};
    panel_help_text(c, &text);
    ui_tooltip(strbuf_text(&text));
    strbuf_free(&text);
}

// ---- label ------------------------------------------------------------------------------------

// Draws text in the middle of a line as high as the widgets beside it; it takes clicks.
static ui_rect text_cell(const char *id, const char *text, ui_color color, float width) {
    ui_canvas cell = ui_canvas_begin(id, width, ROW * ui_scale());
    float spare = ROW - TEXT;
    ui_label(cell.area.left, cell.area.top + 0.5f * spare * ui_scale(), ui_rgba(color, 1), text);
    ui_canvas_end();
    return cell.area;
}

static ui_rect label_text(const char *label, float width, float marks, ui_color color) {
    char words[PANEL_NAME], text[PANEL_NAME];
    str_copy(words, sizeof words, label);
    for (char *at = words; *at; at++)
        if (*at == '_') *at = ' ';
    panel_shorten(words, width - marks, ui_text_width, text, sizeof text);
    return text_cell("label", text, color, width);
}

static void structural_mark(ui_rect cell) {
    float scale = ui_scale(), half = 2.5f * scale;
    float x = cell.right - 0.5f * MARK * scale, y = 0.5f * (cell.top + cell.bottom);
    ui_frame((ui_rect){x - half, y - half, x + half, y + half}, ui_rgba(UI_DIM, 0.9f), scale,
             scale);
}

static void reset_button(live *l, const roil_control *c) {
    ui_same_line();
    ui_align_right(RESET * ui_scale());
    if (ui_icon_button("reset", UI_ICON_RESET, false, "reset to what the effect file says"))
        panel_reset(l, c->name);
}

static void label_cell(live *l, const roil_control *c) {
    ui_rect space = ui_space();
    float width = space.right - space.left - (c->moved ? RESET + GAP : 0) * ui_scale();
    float mark = (c->structural ? MARK : 0) * ui_scale();
    ui_rect cell = label_text(c->label, width, mark, c->moved ? UI_ACCENT : UI_TEXT);
    help(c);
    menu(l, c, "label menu");
    if (c->structural) structural_mark(cell);
    if (c->moved) reset_button(l, c);
}

void panel_label(const char *label) {
    ui_push(label);
    ui_table_next();
    ui_rect space = ui_space();
    label_text(label, space.right - space.left, 0, UI_DIM);
    ui_table_next();
    ui_width(0);
    ui_pop();
}

// ---- value ------------------------------------------------------------------------------------

static int whole(float value) {
    if (value <= (float)INT_MIN) return INT_MIN;
    return value >= (float)INT_MAX ? INT_MAX : (int)lrintf(value);
}

static bool whole_widget(const roil_control *c, float *value) {
    int number = whole(*value);
    if (!ui_whole("##value", &number, whole(c->min), whole(c->max), c->unit)) return false;
    *value = (float)number;
    return true;
}

static bool choice_widget(const roil_control *c, float *value) {
    size_t index = *value > 0 ? (size_t)*value : 0;
    if (!ui_choice("##value", &index, c->words, c->word_count)) return false;
    *value = (float)index;
    return true;
}

static bool toggle_widget(float *value) {
    bool on = *value != 0;
    if (!ui_toggle("##value", &on)) return false;
    *value = on;
    return true;
}

static bool widget(const roil_control *c, float value[4]) {
    switch (c->type) {
    case ROIL_FLOAT:
    case ROIL_VECTOR:
        return ui_number("##value", value, c->components, c->min, c->max, c->log_scale, c->unit);
    case ROIL_INT:
        return whole_widget(c, value);
    case ROIL_BOOL:
        return toggle_widget(value);
    case ROIL_ENUM:
        return choice_widget(c, value);
    case ROIL_COLOR:
        return ui_color_edit("##value", value, c->components);
    default: // has an editor of its own
        return false;
    }
}

// Returns the value to show: the one that was set, until the effect has it or it is given up.
static const float *structural_value(pending_value *v, const roil_control *c) {
    if (strcmp(v->name, c->name) != 0) return c->value;
    bool over = memcmp(v->value, c->value, sizeof c->value) == 0 || clock_seconds() > v->until;
    if (!v->sent || !over) return v->value;
    v->name[0] = 0;
    return c->value;
}

static void keep_pending(pending_value *v, const char *name, const float value[4]) {
    str_copy(v->name, sizeof v->name, name);
    memcpy(v->value, value, sizeof v->value);
    v->sent = false;
}

// Builds the effect when the widget is released, since a build for each step of a drag would be too
// many.
static void structural_widget(live *l, const roil_control *c) {
    pending_value *v = &l->panel->pending;
    float value[4];
    memcpy(value, structural_value(v, c), sizeof value);
    if (widget(c, value)) keep_pending(v, c->name, value);
    bool at_once = c->type == ROIL_BOOL || c->type == ROIL_ENUM;
    if (v->sent || strcmp(v->name, c->name) != 0 || (ui_active() && !at_once)) return;
    v->sent = true;
    v->until = clock_seconds() + PENDING;
    row_set_value(l, c, v->value);
}

static void driven_value(const roil_control *c) {
    strbuf text = {0};
    panel_value_shown(c, c->value, &text);
    char shown[64];
    snprintf(shown, sizeof shown, "~ %s", strbuf_text(&text));
    strbuf_free(&text);
    text_cell("driven", shown, UI_DIM, 0);
}

static void value_cell(live *l, const roil_control *c) {
    float value[4];
    memcpy(value, c->value, sizeof value);
    ui_width(0);
    if (c->driven)
        driven_value(c);
    else if (c->structural)
        structural_widget(l, c);
    else if (widget(c, value))
        row_set_value(l, c, value);
    help(c);
    menu(l, c, "value menu");
}

void panel_row(live *l, const roil_control *c) {
    ui_push(c->name);
    ui_table_next();
    label_cell(l, c);
    ui_table_next();
    value_cell(l, c);
    ui_pop();
}

// ---- palettes and curves ----------------------------------------------------------------------

shape_state shape_state_take(const shape_state *kept, const char *name) {
    if (strcmp(kept->name, name) == 0) return *kept;
    shape_state fresh = {.selected = ROIL_MAX_STOPS};
    str_copy(fresh.name, sizeof fresh.name, name);
    return fresh;
}

void shape_state_give(shape_state *kept, const shape_state *state) {
    bool mine = strcmp(kept->name, state->name) == 0;
    if (mine || state->selected != ROIL_MAX_STOPS) *kept = *state;
}

void panel_shape_buttons(live *l, const char *name) {
    size_t index;
    roil_control c = {0};
    if (roil_find_control(l->effect, name, &index)) roil_get_control(l->effect, index, &c);
    ui_disable_begin(!c.moved);
    if (ui_small_button("Reset")) panel_reset(l, name);
    ui_disable_end();
    ui_same_line();
    if (ui_small_button("Copy as Lua")) panel_copy_lua(l, name);
    ui_same_line();
    ui_disable_begin(!c.moved);
    if (ui_small_button("Write")) write_back_ask(l, name);
    ui_disable_end();
    ui_tooltip("writes it into the file");
    ui_gap(10 * ui_scale());
}
