// Presets: named values beside the effect file, to be loaded and saved.
#include "app/panel_parts.h"
#include "base/clock.h"
#include "base/str.h"
#include <string.h>

static const double LOOK = 2; // seconds between looks at the folder

static void look(live *l, preset_list *list) {
    if (clock_seconds() < list->next_look) return;
    size_t count = roil_presets(l->file, list->names, PANEL_PRESETS);
    list->count = count < PANEL_PRESETS ? count : PANEL_PRESETS;
    list->next_look = clock_seconds() + LOOK;
}

// ---- loading ----------------------------------------------------------------------------------

static bool sets(const roil_preset *preset, const char *name) {
    for (size_t i = 0; i < preset->count; i++)
        if (strcmp(preset->settings[i].name, name) == 0) return true;
    return false;
}

// A preset is all that was moved when it was saved: what it does not name is as the script has it.
// Where the camera stands is no part of it.
static void reset_others(live *l, const roil_preset *preset) {
    const panel *p = l->panel;
    for (size_t i = 0; i < p->control_count; i++) {
        const roil_control *c = &p->controls[i];
        bool camera = !c->parameter && strcmp(c->group, "camera") == 0;
        if (c->moved && !camera && !sets(preset, c->name)) live_reset(l, c->name);
    }
}

static void apply(live *l, const roil_preset *preset, const char *name) {
    strbuf unknown = {0};
    size_t index;
    reset_others(l, preset);
    for (size_t i = 0; i < preset->count; i++) {
        const roil_setting *s = &preset->settings[i];
        if (roil_find_control(l->effect, s->name, &index))
            live_set(l, s->name, s->value);
        else
            strbuf_add(&unknown, "%s%s", unknown.length ? ", " : "", s->name);
    }
    if (unknown.length)
        live_notice(l, "preset %s: the effect has no %s", name, strbuf_text(&unknown));
    strbuf_free(&unknown);
}

static void load(live *l, const char *name) {
    roil_preset *preset = roil_read_preset(l->r, l->file, name);
    if (preset)
        apply(l, preset, name);
    else
        live_notice(l, "%s", roil_error());
    roil_free_preset(preset);
    str_copy(l->panel->presets.name, sizeof l->panel->presets.name, name);
    l->panel->presets.asked = false;
}

static void draw_list(live *l, preset_list *list) {
    if (!list->count) ui_text_color(UI_DIM, "None are saved yet.");
    for (size_t i = 0; i < list->count; i++) {
        if (ui_selectable(list->names[i], strcmp(list->names[i], list->name) == 0))
            load(l, list->names[i]);
        ui_tooltip("load; all else returns to what the effect file says");
    }
}

// ---- saving -----------------------------------------------------------------------------------

static bool exists(const preset_list *list) {
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->names[i], list->name) == 0) return true;
    return false;
}

static void save(live *l, preset_list *list) {
    if (exists(list) && !list->asked) {
        list->asked = true;
        return;
    }
    list->asked = false;
    list->next_look = 0;
    if (roil_write_preset(l->effect, list->name))
        live_notice(l, "saved preset %s", list->name);
    else
        live_notice(l, "%s", roil_error());
}

static void draw_saving(live *l, preset_list *list) {
    ui_width(-100 * ui_scale());
    if (ui_input("##name", "Name", list->name, sizeof list->name)) list->asked = false;
    ui_same_line();
    ui_disable_begin(!list->name[0]);
    if (ui_button(list->asked ? "Overwrite?###save" : "Save###save")) save(l, list);
    ui_disable_end();
}

void presets_draw(live *l) {
    preset_list *list = &l->panel->presets;
    look(l, list);
    draw_list(l, list);
    draw_saving(l, list);
    if (ui_button("Reset all")) live_reset(l, NULL);
    ui_tooltip("everything returns to what the effect file says");
}
