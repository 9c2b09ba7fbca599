// Declared parameters, and setting anything by name from text (`--set`, presets, sweeps).
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t effect_param_count(const effect *e) {
    return e->param_count;
}
const effect_param *effect_get_param(const effect *e, size_t index) {
    return &e->params[index];
}

static int components(effect_param_type type) {
    return type == EFFECT_VEC3 || type == EFFECT_COLOR ? 3 : 1;
}

static bool check_value(const effect_param *param, const float value[4]) {
    for (int i = 0; i < components(param->type); i++) {
        if (isfinite(value[i]) && value[i] >= param->min && value[i] <= param->max) continue;
        return err_set("parameter '%s' is %g; accepted: %g to %g%s%s", param->name,
                       (double)value[i], (double)param->min, (double)param->max,
                       param->unit[0] ? " " : "", param->unit);
    }
    return true;
}

bool effect_set_value(effect *e, size_t param, const float value[4]) {
    effect_param *p = &e->params[param];
    if (!check_value(p, value)) return false;
    memcpy(p->value, value, sizeof p->value);
    memcpy(e->values[param], value, sizeof p->value);
    return true;
}

// ---- values from text -------------------------------------------------------------------------

// "1.5", "1,2,3" or "1 2 3". Returns how many numbers, 0 when it is anything else.
static int parse_numbers(const char *text, float out[4]) {
    int count = 0;
    while (count < 4) {
        char *end;
        errno = 0;
        out[count] = strtof(text, &end);
        if (end == text || !isfinite(out[count])) return 0;
        count++;
        text = end + strspn(end, ", ");
        if (!*text) return count;
    }
    return 0;
}

static int find_word(const char *const *words, size_t count, const char *text) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(words[i], text) == 0) return (int)i;
    return -1;
}

static bool parse_bool(const char *text, float *out) {
    static const char *const words[] = {"false", "true", "off", "on", "no", "yes", "0", "1"};
    int index = find_word(words, COUNT_OF(words), text);
    if (index < 0) return false;
    *out = (float)(index & 1);
    return true;
}

static bool wrong(const char *name, const char *text, const char *accepted) {
    return err_set("'%s' cannot be '%s'; accepted: %s", name, text, accepted);
}

static bool wrong_word(const char *name, const char *text, const char *const *words, size_t count) {
    strbuf list = {0};
    for (size_t i = 0; i < count; i++) strbuf_add(&list, "%s%s", i ? ", " : "", words[i]);
    wrong(name, text, strbuf_text(&list));
    strbuf_free(&list);
    return false;
}

static bool set_param(effect *e, size_t index, const char *text) {
    const effect_param *p = &e->params[index];
    float value[4] = {0};
    int count = parse_numbers(text, value);
    switch (p->type) {
    case EFFECT_BOOL:
        if (!parse_bool(text, &value[0])) return wrong(p->name, text, "true, false");
        break;
    case EFFECT_ENUM: {
        int word = find_word(p->words, p->word_count, text);
        if (word < 0) return wrong_word(p->name, text, p->words, p->word_count);
        value[0] = (float)word;
        break;
    }
    case EFFECT_INT:
        if (count != 1 || value[0] != rintf(value[0]))
            return wrong(p->name, text, "a whole number");
        break;
    case EFFECT_FLOAT:
        if (count != 1) return wrong(p->name, text, "a number");
        break;
    case EFFECT_COLOR:
        if (text[0] == '#') {
            if (!palette_parse_color(text, value)) return err_prefix("%s: ", p->name);
            break;
        }
        if (count != 3) return wrong(p->name, text, "#rrggbb or three numbers, as 1,0.5,0.1");
        break;
    case EFFECT_VEC3:
        if (count != 3) return wrong(p->name, text, "three numbers, as 1,0,2.5");
        break;
    }
    return effect_set_value(e, index, value);
}

int effect_add_param(effect *e, const effect_param *param) {
    if (!str_is_identifier(param->name)) {
        err_set("parameter name '%s' is not a name (letters, digits and _)", param->name);
        return -1;
    }
    for (size_t i = 0; i < e->param_count; i++) {
        if (strcmp(e->params[i].name, param->name) != 0) continue;
        err_set("parameter '%s' is declared twice", param->name);
        return -1;
    }
    if (!(param->min <= param->max)) {
        err_set("parameter '%s': min %g is above max %g", param->name, (double)param->min,
                (double)param->max);
        return -1;
    }
    if (!check_value(param, param->initial)) return -1;
    MEM_RESERVE(e->params, e->param_count + 1, e->param_capacity);
    MEM_RESERVE(e->values, e->param_count + 1, e->value_capacity);
    effect_param *own = &e->params[e->param_count];
    *own = *param;
    memcpy(own->value, param->initial, sizeof own->value);
    memcpy(e->values[e->param_count], own->value, sizeof own->value);
    e->param_count++;
    e->context.params = (const float(*)[4])e->values;
    e->context.param_count = e->param_count;
    for (size_t i = 0; i < e->setting_count; i++) {
        if (strcmp(e->settings[i].name, param->name) != 0) continue;
        e->applied[i] = true;
        if (!set_param(e, e->param_count - 1, e->settings[i].text)) return -1;
    }
    return (int)e->param_count - 1;
}

static bool set_uniform(effect *e, pass *p, const shader_uniform *uniform, const char *text) {
    float value[4] = {0};
    int count = parse_numbers(text, value);
    int word = find_word(uniform->words, uniform->word_count, text);
    if (uniform->type == SHADER_ENUM) {
        if (word < 0) return wrong_word(uniform->name, text, uniform->words, uniform->word_count);
        value[0] = (float)word;
        count = 1;
    } else if (uniform->type == SHADER_BOOL) {
        if (!parse_bool(text, &value[0])) return wrong(uniform->name, text, "true, false");
        count = 1;
    } else if (text[0] == '#') {
        if (!palette_parse_color(text, value)) return err_prefix("%s: ", uniform->name);
        count = 3;
    }
    if (!count) return wrong(uniform->name, text, "a number, or numbers as 1,2,3");
    int width = count == 2 ? 3 : count; // a field has 1, 3 or 4 components
    return pass_set_uniform(p, uniform->name, field_constant(&e->memory, width, value));
}

static bool set_in_pass(effect *e, pass *p, const char *name, const char *text) {
    size_t index;
    if (strcmp(name, "resolution") == 0) {
        float value[4];
        if (parse_numbers(text, value) != 1) return wrong(name, text, "a number, as 0.25");
        return pass_set_scale(p, value[0]);
    }
    switch (pass_find_key(p, name, &index)) {
    case PASS_UNIFORM:
        return set_uniform(e, p, &pass_interface(p)->uniforms[index], text);
    case PASS_OPTION:
        return pass_set_option(p, name, text);
    case PASS_FIELD:
        return err_set("%s.%s is a field; only the effect file can set it", pass_label(p), name);
    case PASS_IMAGE:
        return err_set("%s.%s is an image; only the effect file can set it", pass_label(p), name);
    case PASS_UNKNOWN:
        break;
    }
    return pass_set_uniform(p, name, field_constant(&e->memory, 1, (float[4]){0})); // its message
}

// Names of all that can be set, for a suggestion.
static bool unknown(effect *e, const char *name) {
    size_t count = 0, capacity = 0;
    const char **names = NULL;
    arena scratch = {0};
    for (size_t i = 0; i < e->param_count; i++) {
        MEM_RESERVE(names, count + 1, capacity);
        names[count++] = e->params[i].name;
    }
    for (size_t i = 0; i < e->pass_count; i++) {
        const shader_interface *face = pass_interface(e->passes[i]);
        for (size_t u = 0; u < face->uniform_count; u++) {
            MEM_RESERVE(names, count + 1, capacity);
            names[count++] =
                arena_format(&scratch, "%s.%s", pass_label(e->passes[i]), face->uniforms[u].name);
        }
    }
    const char *near = str_nearest(name, names, count);
    if (near)
        err_set("nothing is named '%s'; did you mean '%s'?", name, near);
    else
        err_set("nothing is named '%s'; `roil info params` lists what can be set", name);
    arena_free(&scratch);
    mem_free(names);
    return false;
}

bool effect_set(effect *e, const char *name, const char *text) {
    for (size_t i = 0; i < e->param_count; i++)
        if (strcmp(e->params[i].name, name) == 0) return set_param(e, i, text);
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < e->pass_count; i++) {
        const char *label = pass_label(e->passes[i]);
        if (strlen(label) != (size_t)(dot - name) || strncmp(label, name, strlen(label)) != 0)
            continue;
        size_t index;
        pass_key key = pass_find_key(e->passes[i], dot + 1, &index);
        if (key == PASS_OPTION || strcmp(dot + 1, "resolution") == 0)
            return err_set("%s is structure; it can only be set when the effect is loaded", name);
        return set_in_pass(e, e->passes[i], dot + 1, text);
    }
    return unknown(e, name);
}

// ---- settings given before the script runs ------------------------------------------------------

void effect_copy_settings(effect *e, const effect_setting *settings, size_t count) {
    effect_setting *own = arena_alloc(&e->memory, count * sizeof *own);
    for (size_t i = 0; i < count; i++)
        own[i] = (effect_setting){arena_string(&e->memory, settings[i].name),
                                  arena_string(&e->memory, settings[i].text)};
    e->settings = own;
    e->setting_count = count;
    e->applied = arena_alloc(&e->memory, count * sizeof *e->applied);
}

bool effect_apply_settings(void *user, pass *p) {
    effect *e = user;
    size_t length = strlen(pass_label(p));
    for (size_t i = 0; i < e->setting_count; i++) {
        const char *name = e->settings[i].name;
        if (strncmp(name, pass_label(p), length) != 0 || name[length] != '.') continue;
        e->applied[i] = true;
        if (!set_in_pass(e, p, name + length + 1, e->settings[i].text)) return false;
    }
    return true;
}

bool effect_check_settings(effect *e) {
    for (size_t i = 0; i < e->setting_count; i++)
        if (!e->applied[i]) return unknown(e, e->settings[i].name);
    return true;
}
