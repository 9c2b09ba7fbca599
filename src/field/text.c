// Palettes and curves as text: one line that a setting, a preset or a picture's metadata can hold.
// Items stand between semicolons, what belongs to an item between blanks, components of a value
// between commas.
#include "base/error.h"
#include "base/value.h"
#include "field/curve.h"
#include "field/palette.h"
#include <math.h>
#include <string.h>

static void skip_blanks(const char **at) {
    *at += strspn(*at, " ");
}

static bool read_number(const char **at, float *out) {
    char *end;
    skip_blanks(at);
    *out = str_float(*at, &end);
    if (end == *at || !isfinite(*out)) return false;
    *at = end;
    return true;
}

// "1,2,3"; returns how many, 0 when it is anything else.
static int read_numbers(const char **at, float out[4]) {
    for (int count = 0; count < 4; *at += 1) {
        if (!read_number(at, &out[count++])) return 0;
        if (**at != ',') return count;
    }
    return 0;
}

// Whether an item ends here; goes behind its semicolon.
static bool end_item(const char **at) {
    skip_blanks(at);
    if (**at == ';') {
        *at += 1;
        skip_blanks(at);
        return true;
    }
    return !**at;
}

// ---- palettes ---------------------------------------------------------------------------------

static bool read_color(const char **at, float out[4]) {
    skip_blanks(at);
    if (**at != '#') return read_numbers(at, out) == 3;
    char hex[16];
    size_t length = strcspn(*at, " ;");
    if (length >= sizeof hex) return false;
    memcpy(hex, *at, length);
    hex[length] = '\0';
    *at += length;
    return value_parse_color(hex, out);
}

static bool read_stop(const char **at, palette_stop *out) {
    *out = (palette_stop){.color = {0, 0, 0, 1}};
    if (!read_number(at, &out->at) || !read_color(at, out->color)) return false;
    if (end_item(at)) return true;
    return read_number(at, &out->color[3]) && end_item(at);
}

bool palette_parse(const char *text, palette_stop out[PALETTE_MAX_STOPS], size_t *count) {
    const char *at = text;
    skip_blanks(&at);
    for (*count = 0; *at; ++*count) {
        if (*count == PALETTE_MAX_STOPS)
            return err_set("palette: at most %d stops are accepted", PALETTE_MAX_STOPS);
        if (!read_stop(&at, &out[*count]))
            return err_set("palette: stop %zu of '%.64s' is wrong; accepted: position, colour and "
                           "alpha, as in '0 #000000; 0.5 #7a1500 0.5; 1 4,2,0.5'",
                           *count + 1, text);
    }
    return true;
}

void palette_print(const palette_stop *stops, size_t count, strbuf *out) {
    for (size_t i = 0; i < count; i++) {
        const palette_stop *stop = &stops[i];
        char hex[8];
        if (i > 0) strbuf_add(out, "; ");
        strbuf_add_float(out, stop->at);
        strbuf_add(out, " ");
        if (value_color_hex(stop->color, hex)) {
            strbuf_add(out, "%s", hex);
        } else {
            for (int c = 0; c < 3; c++) {
                if (c > 0) strbuf_add(out, ",");
                strbuf_add_float(out, stop->color[c]);
            }
        }
        if (stop->color[3] == 1) continue;
        strbuf_add(out, " ");
        strbuf_add_float(out, stop->color[3]);
    }
}

// ---- curves -----------------------------------------------------------------------------------

static bool read_shape(const char **at, curve_shape *out) {
    skip_blanks(at);
    size_t length = strcspn(*at, " ;");
    for (int i = 0; i < CURVE_SHAPE_COUNT; i++) {
        const char *name = curve_shape_name((curve_shape)i);
        if (strlen(name) != length || strncmp(name, *at, length) != 0) continue;
        *out = (curve_shape)i;
        *at += length;
        skip_blanks(at);
        return true;
    }
    return err_set("curve: '%.*s' is no shape; accepted: step, linear, cubic, ease_in, ease_out, "
                   "ease_in_out, then keys, as in 'cubic 0 1; 2.5 0.5'",
                   (int)(length < 32 ? length : 32), *at);
}

bool curve_parse(const char *text, curve_key *keys, curve *out) {
    const char *at = text;
    *out = (curve){.keys = keys};
    if (!read_shape(&at, &out->shape)) return false;
    while (*at) {
        if (out->count == CURVE_MAX_KEYS)
            return err_set("curve: at most %d keys are accepted", CURVE_MAX_KEYS);
        curve_key *key = &keys[out->count++];
        *key = (curve_key){0};
        int components = read_number(&at, &key->time) ? read_numbers(&at, key->value) : 0;
        if (out->count == 1) out->components = components;
        if (!components || components != out->components || !end_item(&at))
            return err_set("curve: key %zu of '%.64s' is wrong; accepted: time and value, of as "
                           "many components in each key, as in 'cubic 0 1,0,0; 2.5 0,1,0'",
                           out->count, text);
    }
    return true;
}

void curve_print(const curve *c, strbuf *out) {
    strbuf_add(out, "%s", curve_shape_name(c->shape));
    for (size_t i = 0; i < c->count; i++) {
        strbuf_add(out, i > 0 ? "; " : " ");
        strbuf_add_float(out, c->keys[i].time);
        for (int k = 0; k < c->components; k++) {
            strbuf_add(out, k > 0 ? "," : " ");
            strbuf_add_float(out, c->keys[i].value[k]);
        }
    }
}
