// Widgets that ImGui does not have, or not as an artist wants them: headings, icons, toggles,
// numbers, colours.
#include "ui/parts.h"
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MAX_LABEL = 256, MAX_TEXT = 4096 };
static const float LABEL_SHARE = 0.4f, SWITCH = 30, INSET = 0.18f;

static struct {
    bool given;
    float width;
} next; // of the next widget, as ui_width said

static bool is_shown(const char *label) {
    return label[0] && strncmp(label, "##", 2) != 0;
}

// ---- rows -------------------------------------------------------------------------------------

void ui_width(float width) {
    next.given = true;
    next.width = width;
}

void part_forget_width(void) {
    next.given = false;
}

static float take_width(void) {
    ui_rect space = ui_space();
    float room = space.right - space.left, wanted = next.given ? next.width : 0;
    next.given = false;
    return floorf(fmaxf(wanted > 0 ? wanted : room + wanted, 1));
}

float part_row_begin(const char *label) {
    float width = take_width();
    part_group_begin(label);
    if (!is_shown(label)) return width;
    ui_rect at = ui_space();
    float column = floorf(width * LABEL_SHARE), height = ui_line_height() + 2 * ui_scale();
    part_space(column, height);
    draw_text((ui_rect){at.left, at.top, at.left + column - 6 * ui_scale(), at.top + height},
              UI_TEXT, label, 0);
    part_same_line(0);
    return width - column;
}

void part_row_end(const char *label) {
    part_group_end(label);
}

void ui_gap(float height) { // besides the gap that is between all lines
    part_space(0, fmaxf(height - 6 * ui_scale(), 0));
}

bool ui_button(const char *label) {
    return part_button(label, next.given ? take_width() : 0);
}

// ---- text and layout --------------------------------------------------------------------------

static void text_of(ui_color color, const char *format, va_list args) {
    char text[MAX_TEXT];
    vsnprintf(text, sizeof text, format, args);
    part_text(ui_rgba(color, 1), text, false);
}

void ui_text(const char *format, ...) {
    va_list args;
    va_start(args, format);
    text_of(UI_TEXT, format, args);
    va_end(args);
}

void ui_text_color(ui_color color, const char *format, ...) {
    va_list args;
    va_start(args, format);
    text_of(color, format, args);
    va_end(args);
}

void ui_text_mono(ui_color color, const char *text, bool wrapped) {
    part_font_begin(FONT_MONO);
    part_text(ui_rgba(color, 1), text, wrapped);
    part_font_end();
}

float ui_mono_width(void) {
    part_font_begin(FONT_MONO);
    static const char ten[] = "mmmmmmmmmm"; // the width of a text is rounded
    float width = ui_text_width(ten) / (float)(sizeof ten - 1);
    part_font_end();
    return width;
}

bool ui_splitter(ui_rect area, float *position) {
    ui_canvas c = part_bare_sideways("splitter", area);
    ui_fill(area, ui_rgba(UI_FIELD, 1), 0);
    if (c.hovered || c.held) ui_fill(area, ui_rgba(UI_ACCENT, c.held ? 1 : 0.6f), 0);
    if (c.held) *position = c.x;
    return c.held;
}

bool ui_section(const char *label, bool open) {
    bool *is_open = part_flag(label, open);
    ui_rect space = ui_space();
    part_area a = part_area_begin(label, fmaxf(space.right - space.left, 1));
    if (a.clicked) *is_open = !*is_open;
    draw_heading(a.area, *is_open, a.hovered);
    ui_rect text = {a.area.left + 26 * ui_scale(), a.area.top, a.area.right, a.area.bottom};
    part_font_begin(FONT_STRONG);
    draw_text(text, UI_TEXT, label, 0);
    part_font_end();
    return *is_open;
}

// ---- values ------------------------------------------------------------------------------------

bool ui_icon_button(const char *id, int icon, bool active, const char *tooltip) {
    part_area a = part_area_begin(id, 0);
    ui_rect inside = a.area;
    float inset = floorf((a.area.bottom - a.area.top) * INSET);
    inside.left += inset;
    inside.top += inset;
    inside.right -= inset;
    inside.bottom -= inset;
    if (a.hovered)
        ui_fill(a.area, draw_grey(a.held ? GREY_RAISED_ACTIVE : GREY_RAISED_HOVER), 4 * ui_scale());
    ui_color color = active ? UI_ACCENT : a.hovered ? UI_TEXT : UI_DIM;
    draw_icon(icon, inside, draw_enabled(ui_rgba(color, 1)));
    ui_tooltip(tooltip);
    return a.clicked;
}

bool ui_toggle(const char *label, bool *value) {
    float gap = 7 * ui_scale(), track = SWITCH * ui_scale(), text = 0;
    bool column = next.given;
    char name[MAX_LABEL];
    if (column || !is_shown(label)) {
        part_row_begin(label);
    } else { // its row has no label of its own
        snprintf(name, sizeof name, "##%s", label);
        part_row_begin(name);
        snprintf(name, sizeof name, "%.*s", (int)strcspn(label, "#"), label);
        text = gap + ui_text_width(name);
    }
    part_area a = part_area_begin("##value", track + text);
    if (a.clicked) {
        *value = !*value;
        part_changed();
    }
    ui_rect box = a.area;
    box.right = box.left + track;
    draw_switch(box, *value, a.hovered);
    if (text > 0)
        draw_text((ui_rect){box.right + gap, box.top, a.area.right + 1, box.bottom}, UI_TEXT, name,
                  0);
    part_row_end(label);
    return a.clicked;
}

bool ui_number(const char *label, float *value, int components, float min, float max,
               bool log_scale, const char *unit) {
    const number_range range = {(double)min, (double)max, log_scale, false};
    float width = part_row_begin(label), gap = 3 * ui_scale();
    bool changed = false;
    for (int i = 0; i < components; i++) {
        char name[16];
        snprintf(name, sizeof name, "##%d", i);
        int left = components - i; // they share what is left, in whole pixels
        float part = floorf((width - gap * (float)(left - 1)) / (float)left);
        if (i) part_same_line(gap);
        double v = (double)value[i];
        if (part_bar(name, &v, &range, unit, fmaxf(part, 1))) {
            value[i] = (float)v;
            changed = true;
        }
        width -= part + gap;
    }
    part_row_end(label);
    return changed;
}

bool ui_whole(const char *label, int *value, int min, int max, const char *unit) {
    number_range range = {min, max, false, true};
    if (min == INT_MIN) range.min = -INFINITY;
    if (max == INT_MAX) range.max = INFINITY;
    double v = *value;
    bool changed = part_bar("##value", &v, &range, unit, part_row_begin(label));
    if (changed) *value = (int)fmin(fmax(v, INT_MIN), INT_MAX);
    part_row_end(label);
    return changed;
}

bool ui_color_edit(const char *label, float *linear, int components) {
    bool changed = false;
    part_area a = part_area_begin("##swatch", part_row_begin(label));
    draw_swatch(a.area, linear, components);
    if (a.clicked) part_popup_open("picker");
    if (part_popup_begin("picker")) {
        changed = color_picker(linear, components);
        part_popup_end();
    }
    part_row_end(label);
    return changed;
}
