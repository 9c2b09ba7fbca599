// The window "Slices": shows a flow in slices, lets the user push it and put templates into it, and
// captures parts of it as templates (Krueger and Westermann 2005, section 3).
#include "app/flow_tools.h"
#include "app/label.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const float WIDTH = 660, HEIGHT = 590, FOOT = 64, MIN_CANVAS = 120; // units
static const float COLUMNS[2] = {1.15f, 1};

flow_tools *flow_tools_create(void) {
    flow_tools *t = mem_alloc(sizeof *t);
    t->view = (roil_slices_view){.range = 1};
    t->fitted = SIZE_MAX;
    t->push_side = 0.15f;
    t->use =
        (roil_template_use){.where.side = 0.25f, .strength = 5, .blend = 0.02f, .lifetime = 0.25};
    return t;
}

void flow_tools_destroy(flow_tools *t, roil *r) {
    roil_texture_destroy(r, t->texture);
    flow_list_free(t, r);
    mem_free(t);
}

// ---- before the interface -----------------------------------------------------------------------

static void list_flows(flow_tools *t, const live *l) {
    size_t count = l->effect ? roil_slices_list(l->effect, t->flows, FLOW_FLOWS) : 0;
    t->flow_count = count < FLOW_FLOWS ? count : FLOW_FLOWS;
    if (t->view.flow >= t->flow_count) t->view.flow = 0;
    if (t->flow_count && t->view.slice >= t->flows[t->view.flow].count) t->view.slice = 0;
}

static bool resize_texture(flow_tools *t, roil *r) {
    if (t->texture && t->width == t->wanted[0] && t->height == t->wanted[1]) return true;
    roil_texture_destroy(r, t->texture);
    t->width = t->wanted[0];
    t->height = t->wanted[1];
    t->texture = roil_texture_create(r, t->width, t->height, NULL);
    return t->texture != NULL;
}

// Rounds up to two digits.
static float round_up(float value) {
    double unit = pow(10, floor(log10((double)value)) - 1);
    return (float)(ceil((double)value / unit) * unit);
}

// Fits the range of a field to its values when it is first shown.
static bool flow_fit_range(flow_tools *t, live *l) {
    size_t wanted = t->view.flow * ROIL_SLICES_FIELDS + (size_t)t->view.field;
    float most;
    if (t->fitted == wanted) return true;
    if (!roil_slices_greatest(l->effect, &t->view, &most)) return false;
    if (most > 0) t->view.range = round_up(most);
    t->fitted = most > 0 ? wanted : SIZE_MAX; // else again, when something flows
    return true;
}

void flow_tools_update(live *l) {
    flow_tools *t = l->flow_tools;
    if (!l->session.slices || !l->effect) return;
    list_flows(t, l);
    flow_list_look(t, l);
    if (!t->flow_count || !t->wanted[0]) return;
    bool done = resize_texture(t, l->r) && flow_fit_range(t, l) &&
                roil_slices_draw(l->effect, &t->view, t->texture);
    str_copy(t->failure, sizeof t->failure, done ? "" : roil_error());
}

// ---- what is seen -------------------------------------------------------------------------------

static const char *unit_of(roil_slices_field field) {
    return field == ROIL_SLICES_PRESSURE   ? "m\u00b2/s\u00b2"
           : field == ROIL_SLICES_VELOCITY ? "m/s"
                                           : "";
}

static void draw_flow(flow_tools *t) {
    const char *names[FLOW_FLOWS];
    for (size_t i = 0; i < t->flow_count; i++) names[i] = t->flows[i].name;
    if (t->flow_count > 1 && ui_choice("flow", &t->view.flow, names, t->flow_count)) t->side = 0;
    const roil_slices *flow = &t->flows[t->view.flow];
    int slice = (int)t->view.slice + 1;
    ui_disable_begin(flow->count < 2);
    if (ui_whole("slice", &slice, 1, (int)flow->count, "")) t->view.slice = (uint32_t)slice - 1;
    ui_disable_end();
}

static void draw_view(flow_tools *t) {
    size_t field = (size_t)t->view.field;
    if (ui_choice("view", &field, roil_slices_fields, ROIL_SLICES_FIELDS)) {
        t->view.field = (roil_slices_field)field;
        // What is captured and put is of the kind that is seen.
        bool velocity = t->view.field == ROIL_SLICES_VELOCITY;
        if (velocity || t->view.field == ROIL_SLICES_PRESSURE) {
            t->use.velocity = velocity;
            t->next_look = 0;
        }
    }
    ui_number("range", &t->view.range, 1, 1e-4f, 1e4f, true, unit_of(t->view.field));
}

static void draw_switches(live *l, flow_tools *t) {
    static const char *const words[FLOW_TOOLS] = {"Push", "Select", "Put"};
    static const char *const tips[FLOW_TOOLS] = {"Drag in the slice to push what flows",
                                                 "Draw a square in the slice, and capture it",
                                                 "Click in the slice to put a template there"};
    for (int i = 0; i < FLOW_TOOLS; i++) {
        bool on = (int)t->tool == i;
        if (label_switch(words[i], &on, ui_rgba(UI_ACCENT, 1))) t->tool = (flow_tool)i;
        ui_tooltip(tips[i]);
        ui_same_line();
    }
    timeline *time = &l->time;
    if (ui_icon_button("flow stop", time->playing ? UI_ICON_PAUSE : UI_ICON_PLAY, time->playing,
                       time->playing ? "Stop the flow (Space)" : "Let it flow (Space)"))
        time->playing = !time->playing;
    ui_same_line();
    if (ui_button("Fit")) t->fitted = SIZE_MAX;
    ui_tooltip("The greatest value of now becomes the brightest");
}

// ---- tools --------------------------------------------------------------------------------------

static void draw_kind(flow_tools *t) {
    static const char *const words[] = {"pressure", "velocity"};
    size_t kind = t->use.velocity ? 1 : 0;
    if (!ui_choice("kind", &kind, words, 2)) return;
    t->use.velocity = kind == 1;
    t->next_look = 0;
    t->line[0] = '\0';
}

static bool write_capture(live *l, void *scale) {
    const flow_tools *t = l->flow_tools;
    const roil_slices_square where = {
        t->view.flow, t->view.slice, {t->middle[0], t->middle[1]}, t->side};
    return roil_slices_capture(l->effect, &where, t->name, scale);
}

static void flow_capture(live *l, flow_tools *t) {
    float scale[2];
    char file[sizeof t->name + 8], path[sizeof file + 16], label[sizeof file + 16];
    snprintf(file, sizeof file, "%s.exr", t->name);
    snprintf(path, sizeof path, "templates/%s", file);
    snprintf(label, sizeof label, "captured %s", t->name);
    if (!live_write(l, path, label, write_capture, scale)) return;
    live_notice(l, "Saved templates/%s", file);
    log_write(LOG_DEBUG, "live: captured templates/%s, %.3g m/s, %.3g m^2/s^2", file,
              (double)scale[0], (double)scale[1]);
    flow_list_choose(t, file);
    t->next_look = 0;
    t->use.where.side = t->side;
    // A force that gives what lies there the speed of what was captured while it acts.
    double acts = fmax(t->use.lifetime, t->flows[t->view.flow].time_step);
    t->use.strength = t->use.velocity ? scale[0] / (float)acts : scale[1];
    t->name[0] = '\0';
    t->tool = FLOW_PUT;
}

static void draw_select(live *l, flow_tools *t) {
    ui_text_wrapped("Stop the flow, draw a square round what you like, and give it a name.");
    draw_kind(t);
    ui_input("##template name", "Name of the template", t->name, sizeof t->name);
    ui_disable_begin(t->side <= 0 || !t->name[0]);
    if (ui_button("Capture")) flow_capture(l, t);
    ui_disable_end();
    ui_tooltip("Writes templates/NAME.exr beside the effect's file");
}

static void copy_line(live *l, flow_tools *t) {
    t->use.file = t->file;
    char *line = roil_template_lua(l->effect, &t->use);
    if (!line) {
        live_notice(l, "%s", roil_error());
        return;
    }
    size_t length = strcspn(line, "\n");
    snprintf(t->line, sizeof t->line, "%.*s", (int)length, line);
    ui_copy(line);
    roil_free(line);
    t->next_look = 0; // the file may be the effect's own now
    live_notice(l, "Copied the line for the effect's file");
    log_write(LOG_DEBUG, "live: line %s", t->line);
}

static void draw_put(live *l, flow_tools *t) {
    roil_template_use *use = &t->use;
    float lifetime = (float)use->lifetime;
    draw_kind(t);
    ui_number("size", &use->where.side, 1, 0.01f, 1, true, "widths");
    ui_number("angle", &use->angle, 1, -180, 180, false, "\u00b0");
    ui_number("strength", &use->strength, 1, 0.001f, 1000, true,
              use->velocity ? "m/s\u00b2" : "m\u00b2/s\u00b2");
    ui_disable_begin(use->velocity);
    ui_number("blend", &use->blend, 1, 0.001f, 1, true, "");
    ui_tooltip("How firmly pressure is held: 0.002 nudges what flows, 0.1 blows it apart");
    ui_disable_end();
    if (ui_number("lifetime", &lifetime, 1, 0, 10, false, "s")) use->lifetime = (double)lifetime;
    ui_toggle("in all slices", &use->everywhere);
    flow_list_draw(t);
    ui_disable_begin(!t->put);
    if (ui_button("Copy as Lua")) copy_line(l, t);
    ui_disable_end();
    ui_tooltip("The line of the effect's file that puts it there all the time");
}

static void draw_tool(live *l, flow_tools *t) {
    if (t->tool == FLOW_SELECT) draw_select(l, t);
    if (t->tool == FLOW_PUT) draw_put(l, t);
    if (t->tool != FLOW_PUSH) return;
    ui_text_wrapped("Drag in the slice to push what flows there.");
    ui_number("size", &t->push_side, 1, 0.01f, 1, true, "widths");
}

// ---- the window ---------------------------------------------------------------------------------

static void draw_columns(live *l, flow_tools *t) {
    ui_rect space = ui_space();
    float height = space.bottom - space.top - FOOT * ui_scale();
    ui_table_begin("slices columns", 2, COLUMNS);
    ui_table_next();
    flow_canvas_draw(l, t, floorf(fmaxf(height, MIN_CANVAS * ui_scale())));
    ui_table_next();
    if (t->flow_count) {
        draw_flow(t);
        draw_view(t);
        draw_switches(l, t);
        ui_separator();
        draw_tool(l, t);
    }
    ui_table_end();
    if (t->line[0]) ui_text_wrapped(t->line);
}

void flow_tools_draw(live *l) {
    if (!l->session.slices) return;
    flow_tools *t = l->flow_tools;
    const ui_rect where = label_place(l->view, WIDTH, HEIGHT, false);
    if (ui_window_begin("Slices", &l->session.slices, where, false)) {
        list_flows(t, l);
        ui_push("slices");
        draw_columns(l, t);
        ui_pop();
    }
    ui_window_end();
}
