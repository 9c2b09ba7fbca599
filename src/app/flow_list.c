// The templates of the effect's folder and of the library, as icons to choose from.
#include "app/flow_tools.h"
#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <string.h>

enum { ICON = 64, AT_ONCE = 8 };       // pixels; made in one frame
static const double LOOK = 2;          // seconds between looks at the folders
static const float SIDE = 52, GAP = 6; // units
static const float EDGE = 2;

// ---- files --------------------------------------------------------------------------------------

static bool is_same(const flow_icon *icon, const roil_template *of, bool velocity) {
    return icon->velocity == velocity && icon->of.changed == of->changed &&
           icon->of.library == of->library && strcmp(icon->of.file, of->file) == 0;
}

// Lists the templates again; icons of files that still exist are kept.
static void flow_list_templates(flow_tools *t, live *l) {
    roil_template *found = mem_alloc(FLOW_TEMPLATES * sizeof *found);
    size_t count = roil_templates(l->effect, found, FLOW_TEMPLATES);
    if (count > FLOW_TEMPLATES) count = FLOW_TEMPLATES;
    flow_icon *icons = mem_alloc(FLOW_TEMPLATES * sizeof *icons);
    for (size_t i = 0; i < count; i++) {
        icons[i] = (flow_icon){.of = found[i], .velocity = t->use.velocity};
        for (size_t k = 0; k < t->icon_count; k++) {
            if (!is_same(&t->icons[k], &found[i], t->use.velocity)) continue;
            icons[i] = t->icons[k];
            t->icons[k].texture = NULL;
        }
    }
    for (size_t k = 0; k < t->icon_count; k++) roil_texture_destroy(l->r, t->icons[k].texture);
    memcpy(t->icons, icons, sizeof t->icons);
    t->icon_count = count;
    mem_free(icons);
    mem_free(found);
}

static void make_icon(flow_icon *icon, live *l) {
    uint8_t rgba[ICON * ICON * 4];
    if (roil_template_icon(l->effect, icon->of.file, icon->velocity, ICON, rgba))
        icon->texture = roil_texture_create(l->r, ICON, ICON, rgba);
    icon->failed = !icon->texture;
    if (icon->failed) log_write(LOG_DEBUG, "live: no icon: %s", roil_error());
}

void flow_list_look(flow_tools *t, live *l) {
    if (clock_seconds() >= t->next_look) {
        flow_list_templates(t, l);
        t->next_look = clock_seconds() + LOOK;
    }
    int made = 0;
    for (size_t i = 0; i < t->icon_count && made < AT_ONCE; i++) {
        if (t->icons[i].texture || t->icons[i].failed) continue;
        make_icon(&t->icons[i], l);
        made++;
    }
}

void flow_list_free(flow_tools *t, roil *r) {
    for (size_t i = 0; i < t->icon_count; i++) roil_texture_destroy(r, t->icons[i].texture);
}

// ---- choosing -----------------------------------------------------------------------------------

void flow_list_choose(flow_tools *t, const char *file) {
    str_copy(t->file, sizeof t->file, file);
    t->put = false;
    t->line[0] = '\0';
}

roil_texture *flow_list_icon(const flow_tools *t) {
    for (size_t i = 0; i < t->icon_count; i++)
        if (strcmp(t->icons[i].of.file, t->file) == 0) return t->icons[i].texture;
    return NULL;
}

static bool draw_one(flow_tools *t, const flow_icon *icon) {
    float s = ui_scale();
    bool chosen = strcmp(icon->of.file, t->file) == 0;
    ui_canvas c = ui_canvas_begin(icon->of.file, SIDE * s, SIDE * s);
    if (icon->texture) ui_image(c.area, icon->texture);
    if (chosen || c.hovered)
        ui_frame(c.area, ui_rgba(chosen ? UI_ACCENT : UI_LINE, 1), 2 * s, EDGE * s);
    ui_canvas_end();
    ui_tooltip(icon->of.file);
    return c.pressed;
}

void flow_list_draw(flow_tools *t) {
    float s = ui_scale(), left = ui_space().left, right = ui_space().right;
    float next = left;
    for (size_t i = 0; i < t->icon_count; i++) {
        if (t->icons[i].failed) continue;
        if (next > left && next + SIDE * s <= right) ui_same_line();
        if (next + SIDE * s > right) next = left;
        if (draw_one(t, &t->icons[i])) flow_list_choose(t, t->icons[i].of.file);
        next += (SIDE + GAP) * s;
    }
    if (t->icon_count == 0) ui_text_color(UI_DIM, "No templates yet");
}
