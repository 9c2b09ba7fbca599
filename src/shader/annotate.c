// Parses each kind of annotation. The grammar is in README.md; cursor.c reads the tokens.
#include "shader/annotate.h"
#include <math.h>
#include <string.h>

// ---- uniforms ---------------------------------------------------------------------------------

static const struct {
    const char *glsl;
    value_type type;
    int components;
} uniform_types[] = {
    {"float", VALUE_NUMBER, 1}, {"vec2", VALUE_NUMBER, 2}, {"vec3", VALUE_NUMBER, 3},
    {"vec4", VALUE_NUMBER, 4},  {"int", VALUE_WHOLE, 1},   {"uint", VALUE_WHOLE, 1},
    {"bool", VALUE_BOOL, 1},
};

// After the default's first word.
static bool read_words(cursor *c, const char *word, value_desc *out) {
    size_t chosen;
    if (!cursor_words(c, word, &out->words, &out->word_count, &chosen)) return false;
    out->type = VALUE_WORD;
    out->components = 1;
    out->value[0] = (float)chosen;
    out->max = (float)(out->word_count - 1);
    return true;
}

static bool read_enum(cursor *c, const declaration *d, value_desc *out) {
    char word[NAME_CAP];
    if (!cursor_name(c, word, "a number or a word") || !read_words(c, word, out)) return false;
    return d->type[0] != 'u' || cursor_fail(c, "%s: an enumeration is an int", d->name);
}

static bool read_bool(cursor *c, value_desc *out) {
    char word[NAME_CAP];
    if (!cursor_word(c, word, "true or false")) return false;
    bool on = strcmp(word, "true") == 0;
    if (!on && strcmp(word, "false") != 0)
        return cursor_fail(c, "expected true or false, not \"%s\"", word);
    out->value[0] = on ? 1 : 0;
    out->max = 1;
    return true;
}

// Integers are stored as floats, which represent all of them up to 2^24.
static bool is_exact(float value) {
    return isinf(value) || (floorf(value) == value && fabsf(value) <= 0x1p24f);
}

static bool read_number(cursor *c, const declaration *d, value_desc *out) {
    if (!cursor_value(c, out->components, out->value) || !cursor_range(c, &out->min, &out->max))
        return false;
    if (strcmp(d->type, "uint") == 0 && out->min < 0) {
        if (isfinite(out->min)) return cursor_fail(c, "%s: a uint cannot be negative", d->name);
        out->min = 0;
    }
    bool whole = is_exact(out->value[0]) && is_exact(out->min) && is_exact(out->max);
    if (out->type == VALUE_WHOLE && !whole)
        return cursor_fail(c, "%s: whole numbers up to 2^24 are accepted", d->name);
    int wrong = value_find_wrong(out, out->value, out->components);
    return wrong < 0 || cursor_fail(c, "%s: the default %g is outside its range [%g, %g]", d->name,
                                    (double)out->value[wrong], (double)out->min, (double)out->max);
}

// A unit, or that three numbers are a colour.
static bool read_unit(cursor *c, const declaration *d, value_desc *out) {
    cursor_unit(c, &out->unit);
    if (strcmp(out->unit, "color") != 0) return true;
    if (out->components != 3) return cursor_fail(c, "%s: a color is a vec3", d->name);
    out->type = VALUE_COLOR;
    out->unit = "";
    return true;
}

bool annotation_uniform(cursor *c, const declaration *d, value_desc *out) {
    const size_t count = sizeof uniform_types / sizeof *uniform_types;
    size_t i = 0;
    while (i < count && strcmp(uniform_types[i].glsl, d->type) != 0) i++;
    if (i == count || d->array || !d->uniform)
        return cursor_fail(c,
                           "%s: only uniforms of type float, vec2, vec3, vec4, int, uint, bool, "
                           "no arrays, take a value",
                           d->name);
    *out = (value_desc){.name = declaration_public_name(c->memory, d->name),
                        .type = uniform_types[i].type,
                        .components = uniform_types[i].components};
    bool words = out->type == VALUE_WHOLE && !cursor_is_number(c);
    bool read = words                     ? read_enum(c, d, out)
                : out->type == VALUE_BOOL ? read_bool(c, out)
                                          : read_number(c, d, out);
    return read && read_unit(c, d, out) && cursor_help(c, &out->help);
}

// ---- images -----------------------------------------------------------------------------------

typedef struct image_type {
    const char *glsl;
    bool storage, volume, integer;
} image_type;

static const image_type image_types[] = {
    {"sampler2D", false, false, false}, {"sampler3D", false, true, false},
    {"usampler2D", false, false, true}, {"usampler3D", false, true, true},
    {"image2D", true, false, false},    {"image3D", true, true, false},
    {"uimage2D", true, false, true},    {"uimage3D", true, true, true},
};

static bool read_format(cursor *c, const declaration *d, const image_type *type,
                        shader_image *out) {
    char word[NAME_CAP];
    if (!cursor_word(c, word, "a format such as rgba16f")) return false;
    out->format = gpu_format_from_name(word);
    bool storable =
        out->format != GPU_FORMAT_NONE && out->format != GPU_D32F && out->format != GPU_RGBA8_SRGB;
    if (!storable)
        return cursor_fail(c,
                           "%s: unknown format \"%s\"; accepted are r8, rgba8, r16f, rg16f, "
                           "rgba16f, r32f, rg32f, rgba32f, r32ui",
                           d->name, word);
    if ((out->format == GPU_R32U) != (type && type->integer))
        return cursor_fail(c, "%s: %s does not hold %s", d->name, d->type, word);
    if (d->format != GPU_FORMAT_NONE && d->format != out->format)
        return cursor_fail(c, "%s: the layout says %s, the annotation %s", d->name,
                           gpu_format_name(d->format), word);
    return true;
}

static bool read_history(cursor *c, shader_image *out) {
    char word[NAME_CAP];
    if (!cursor_name(c, word, "the output whose last frame is read")) return false;
    out->history = true;
    out->history_of = arena_string(c->memory, word);
    return true;
}

static bool read_image_words(cursor *c, const declaration *d, shader_image *out) {
    while (!cursor_take(c, ':')) {
        char word[NAME_CAP];
        if (!cursor_word(c, word,
                         out->output ? "optional or \": help\""
                                     : "optional, history or \": help\""))
            return false;
        if (strcmp(word, "optional") == 0)
            out->optional = true;
        else if (strcmp(word, "history") != 0 || out->output)
            return cursor_fail(c, "%s: unknown word \"%s\"", d->name, word);
        else if (!read_history(c, out))
            return false;
    }
    c->at--; // cursor_help takes the colon
    return true;
}

bool annotation_image(cursor *c, const declaration *d, shader_image *out) {
    char word[NAME_CAP];
    if (!cursor_word(c, word, "input or output")) return false;
    const image_type *type = NULL;
    for (size_t i = 0; i < sizeof image_types / sizeof *image_types; i++)
        if (strcmp(image_types[i].glsl, d->type) == 0) type = &image_types[i];
    *out = (shader_image){.name = declaration_public_name(c->memory, d->name),
                          .glsl_name = arena_string(c->memory, d->name),
                          .output = strcmp(word, "output") == 0,
                          .volume = type && type->volume};
    bool target = out->output && !d->uniform && strcmp(d->type, "vec4") == 0;
    bool fits = target || (type && d->uniform && type->storage == out->output);
    if (!fits || d->array)
        return cursor_fail(c, "%s: an %s is a %s, no array; this is %s%s", d->name, word,
                           out->output ? "uniform image2D or image3D, or an out vec4"
                                       : "uniform sampler2D or sampler3D",
                           d->type, d->array ? "[]" : "");
    if (out->output && !read_format(c, d, type, out)) return false;
    return read_image_words(c, d, out) && cursor_help(c, &out->help);
}

// ---- directives -------------------------------------------------------------------------------

bool annotation_option(cursor *c, value_desc *out) {
    char name[NAME_CAP], word[NAME_CAP];
    if (!cursor_name(c, name, "the option's name")) return false;
    if (!cursor_take(c, '=')) return cursor_fail(c, "expected = and the option's default");
    *out = (value_desc){.name = arena_string(c->memory, name), .unit = ""};
    return cursor_word(c, word, "the option's default") && read_words(c, word, out) &&
           cursor_help(c, &out->help);
}

bool annotation_field(cursor *c, shader_field *out) {
    char type[NAME_CAP], name[NAME_CAP], word[NAME_CAP];
    if (!cursor_name(c, type, "float, vec3 or vec4") || !cursor_name(c, name, "the field's name"))
        return false;
    *out = (shader_field){.name = arena_string(c->memory, name), .required = true, .after = ""};
    out->components = strcmp(type, "float") == 0  ? 1
                      : strcmp(type, "vec3") == 0 ? 3
                      : strcmp(type, "vec4") == 0 ? 4
                                                  : 0;
    if (!out->components)
        return cursor_fail(c, "field %s: %s is not a field's type; accepted are float, vec3, vec4",
                           name, type);
    out->glsl_type = arena_string(c->memory, type);
    while (!cursor_take(c, ':')) {
        if (cursor_take(c, '=')) {
            if (!cursor_value(c, out->components, out->value)) return false;
            out->required = false;
            continue;
        }
        if (!cursor_word(c, word, "= value, after NAME or \": help\"")) return false;
        if (strcmp(word, "after") != 0)
            return cursor_fail(c, "field %s: unknown word \"%s\"", name, word);
        if (!cursor_name(c, word, "the name of a field above")) return false;
        out->after = arena_string(c->memory, word);
    }
    c->at--; // cursor_help takes the colon
    return cursor_help(c, &out->help);
}

bool annotation_counter(cursor *c, shader_counter *out) {
    char name[NAME_CAP];
    if (!cursor_name(c, name, "the counter's name")) return false;
    out->name = arena_string(c->memory, name);
    return cursor_help(c, &out->help);
}
