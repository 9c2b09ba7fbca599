// Presets: named values beside the effect's file, which can be loaded and saved.
#include "app/panel_parts.h"
#include "base/clock.h"
#include "base/str.h"
#include <string.h>

static const double LOOK = 2;    // seconds between looks at the folder
static const float BUTTON = 104; // units that a button at the right takes

static void preset_list_refresh(live *l, preset_list *list) {
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

// A preset has every control that was changed when it was saved, so all others are reset. The
// camera is not part of it.
static void reset_others(live *l, const roil_preset *preset) {
    const panel *p = l->panel;
    for (size_t i = 0; i < p->control_count; i++) {
        const roil_control *c = &p->controls[i];
        bool camera = !c->parameter && strcmp(c->group, "camera") == 0;
        if (c->moved && !camera && !sets(preset, c->name)) panel_reset(l, c->name);
    }
}

static void preset_apply(live *l, const roil_preset *preset, const char *name) {
    strbuf unknown = {0};
    size_t index;
    l->panel->pending = (pending_value){.sent = true};
    reset_others(l, preset);
    for (size_t i = 0; i < preset->count; i++) {
        const roil_setting *s = &preset->settings[i];
        if (roil_find_control(l->effect, s->name, &index))
            live_set(l, s->name, s->value);
        else
            strbuf_add(&unknown, "%s%s", unknown.length ? ", " : "", s->name);
    }
    undo_label(&l->undo, "preset %s", name);
    if (unknown.length)
        live_notice(l, "preset %s: the effect has no %s", name, strbuf_text(&unknown));
    strbuf_free(&unknown);
}

static void preset_load(live *l, const char *name) {
    roil_preset *preset = roil_read_preset(l->r, l->file, name);
    if (preset)
        preset_apply(l, preset, name);
    else
        live_notice(l, "%s", roil_error());
    roil_free_preset(preset);
    preset_list *list = &l->panel->presets;
    str_copy(list->name, sizeof list->name, name);
    list->asked = false;
}

// The choice returns to its first word, so that the same preset can be loaded again.
static void draw_choice(live *l, preset_list *list) {
    const char *words[PANEL_PRESETS + 1] = {list->count ? "Load a preset" : "No presets yet"};
    size_t index = 0;
    for (size_t i = 0; i < list->count; i++) words[i + 1] = list->names[i];
    ui_width(-BUTTON * ui_scale());
    if (ui_choice("##preset", &index, words, list->count + 1) && index > 0)
        preset_load(l, list->names[index - 1]);
    ui_tooltip("what a preset does not name returns to what the effect file says");
}

// ---- saving -----------------------------------------------------------------------------------

static bool exists(const preset_list *list) {
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->names[i], list->name) == 0) return true;
    return false;
}

static void preset_save(live *l, preset_list *list) {
    if (exists(list) && !list->asked) {
        list->asked = true;
        return;
    }
    list->asked = false;
    list->next_look = 0;
    if (live_write_preset(l, list->name))
        live_notice(l, "saved preset %s, without the camera", list->name);
}

static void draw_saving(live *l, preset_list *list) {
    ui_width(-BUTTON * ui_scale());
    if (ui_input("##preset name", "Name of a preset", list->name, sizeof list->name))
        list->asked = false;
    ui_same_line();
    ui_width(0);
    ui_rect button = ui_space();
    button.bottom = button.top + ui_line_height();
    ui_mark("preset save", button);
    ui_disable_begin(!list->name[0]);
    if (ui_button(list->asked ? "Overwrite?###save" : "Save###save")) preset_save(l, list);
    ui_disable_end();
    ui_tooltip("keeps all that was changed, but not the camera");
}

void presets_draw(live *l) {
    preset_list *list = &l->panel->presets;
    preset_list_refresh(l, list);
    draw_choice(l, list);
    ui_same_line();
    ui_width(0);
    if (ui_button("Reset all")) panel_reset(l, NULL);
    ui_tooltip("everything returns to what the effect file says");
    draw_saving(l, list);
    ui_width(0);
    if (ui_button("Write into the file")) write_back_ask(l, NULL);
    ui_tooltip("everything that was changed becomes what the effect file says");
}
