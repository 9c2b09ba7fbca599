// The content of the panel, without a window: sections, search, text.
#include "app/panel_model.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- search -----------------------------------------------------------------------------------

static bool has_word(const roil_control *c, const char *word) {
    return strcasestr(c->name, word) || strcasestr(c->label, word) || strcasestr(c->help, word) ||
           strcasestr(c->group, word);
}

bool panel_matches(const roil_control *c, const char *search) {
    char word[64];
    for (const char *at = search; *at;) {
        at += strspn(at, " \t");
        size_t length = strcspn(at, " \t");
        if (length) {
            snprintf(word, sizeof word, "%.*s", (int)length, at);
            if (!has_word(c, word)) return false;
        }
        at += length;
    }
    return true;
}

// ---- sections ---------------------------------------------------------------------------------

static panel_part part_of(const roil_control *c) {
    if (c->parameter) return c->group[0] ? PANEL_GROUP : PANEL_PARAMETERS;
    if (c->type == ROIL_PALETTE || c->type == ROIL_CURVE) return PANEL_SHAPE;
    if (c->field) return PANEL_FIELD;
    if (strcmp(c->group, "camera") == 0) return PANEL_CAMERA;
    if (strcmp(c->group, "sun") == 0) return PANEL_SUN;
    if (strcmp(c->group, "sky") == 0) return PANEL_SKY;
    return c->object ? PANEL_OBJECT : PANEL_PASS;
}

static const char *title_of(const roil_control *c) {
    switch (part_of(c)) {
    case PANEL_PARAMETERS:
        return "Parameters";
    case PANEL_SHAPE:
        return c->label;
    case PANEL_CAMERA:
        return "Camera";
    case PANEL_SUN:
        return "Sun";
    case PANEL_SKY:
        return "Sky";
    default:
        return c->group;
    }
}

static bool belongs(const panel_section *s, const roil_control *c) {
    return s->part == part_of(c) && strcmp(s->title, title_of(c)) == 0;
}

static bool is_option(const roil_control *c) {
    return c->structural && !c->parameter;
}

static void add_rows(panel_model *m, panel_section *s, const roil_control *controls, size_t count,
                     bool options) {
    for (size_t i = 0; i < count; i++) {
        if (!m->shown[i] || is_option(&controls[i]) != options || !belongs(s, &controls[i]))
            continue;
        *MEM_ADD(m->rows, m->row_count, m->row_capacity) = i;
        s->count++;
        s->moved += controls[i].moved;
    }
}

static bool has_section(const panel_model *m, const roil_control *c) {
    for (size_t i = 0; i < m->section_count; i++)
        if (belongs(&m->sections[i], c)) return true;
    return false;
}

static void add_section(panel_model *m, const roil_control *first, const roil_control *controls,
                        size_t count) {
    panel_section s = {.part = part_of(first), .title = title_of(first), .first = m->row_count};
    add_rows(m, &s, controls, count, true);
    add_rows(m, &s, controls, count, false);
    *MEM_ADD(m->sections, m->section_count, m->section_capacity) = s;
}

void panel_model_fill(panel_model *m, const roil_control *controls, size_t count,
                      const char *search) {
    m->section_count = m->row_count = 0;
    MEM_RESERVE(m->shown, count, m->shown_capacity);
    for (size_t i = 0; i < count; i++) m->shown[i] = panel_matches(&controls[i], search);
    for (panel_part part = 0; part < PANEL_PART_COUNT; part++)
        for (size_t i = 0; i < count; i++)
            if (m->shown[i] && part_of(&controls[i]) == part && !has_section(m, &controls[i]))
                add_section(m, &controls[i], controls, count);
}

void panel_model_free(panel_model *m) {
    mem_free(m->sections);
    mem_free(m->rows);
    mem_free(m->shown);
    *m = (panel_model){0};
}

// ---- text -------------------------------------------------------------------------------------

void panel_number(float value, char out[PANEL_NUMBER]) {
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(out, PANEL_NUMBER, "%.*g", digits, (double)value);
        if (strtof(out, NULL) == value) return;
    }
}

static const char *word_of(const roil_control *c, float value) {
    size_t index = value > 0 ? (size_t)value : 0;
    return index < c->word_count ? c->words[index] : "";
}

void panel_value_text(const roil_control *c, const float value[4], strbuf *out) {
    char number[PANEL_NUMBER];
    if (c->type == ROIL_BOOL) {
        strbuf_add(out, "%s", value[0] != 0 ? "true" : "false");
    } else if (c->type == ROIL_ENUM) {
        strbuf_add(out, "%s", word_of(c, value[0]));
    } else if (c->type != ROIL_PALETTE && c->type != ROIL_CURVE) {
        for (int i = 0; i < c->components; i++) {
            panel_number(value[i], number);
            strbuf_add(out, "%s%s", i ? "," : "", number);
        }
    }
}

void panel_value_shown(const roil_control *c, const float value[4], strbuf *out) {
    if (c->type == ROIL_BOOL) {
        strbuf_add(out, "%s", value[0] != 0 ? "on" : "off");
    } else if (c->type == ROIL_ENUM) {
        strbuf_add(out, "%s", word_of(c, value[0]));
    } else if (c->type != ROIL_PALETTE && c->type != ROIL_CURVE) {
        for (int i = 0; i < c->components; i++)
            strbuf_add(out, "%s%.4g", i ? ", " : "", (double)value[i]);
        if (c->unit[0]) strbuf_add(out, " %s", c->unit);
    }
}

static void add_range(const roil_control *c, strbuf *out) {
    if (isfinite(c->min) && isfinite(c->max))
        strbuf_add(out, ", %g to %g", (double)c->min, (double)c->max);
    else if (isfinite(c->min))
        strbuf_add(out, ", at least %g", (double)c->min);
    else if (isfinite(c->max))
        strbuf_add(out, ", at most %g", (double)c->max);
    else
        return;
    if (c->unit[0]) strbuf_add(out, " %s", c->unit);
}

void panel_help_text(const roil_control *c, strbuf *out) {
    if (c->help[0]) strbuf_add(out, "%s\n", c->help);
    strbuf_add(out, "%s", c->name);
    if (c->type == ROIL_PALETTE || c->type == ROIL_CURVE) return;
    if (c->type != ROIL_BOOL && c->type != ROIL_ENUM) add_range(c, out);
    if (c->driven) {
        strbuf_add(out, "\nmoved by the effect file; right click to override");
        return;
    }
    strbuf_add(out, ", default ");
    panel_value_shown(c, c->initial, out);
    if (c->structural) strbuf_add(out, "\nread while the effect loads: a change rebuilds it");
}

bool panel_shorten(const char *text, float width, float (*measure)(const char *text), char *out,
                   size_t capacity) {
    bool whole = str_copy(out, capacity, text);
    if (whole && measure(out) <= width) return true;
    for (size_t length = strlen(out); length-- > 0;) {
        while (length && ((unsigned char)text[length] & 0xc0) == 0x80) length--; // within a letter
        snprintf(out, capacity, "%.*s...", (int)length, text);
        if (length + 4 <= capacity && measure(out) <= width) break;
    }
    return false;
}
