// The reference as JSON, from the tables that the library itself uses.
#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "roil/info.h"
#include "roil/sheet.h"
#include <assert.h>
#include <math.h>
#include <string.h>

char *info_finish_json(json_t *root) {
    char *text = json_text(root, JSON_INDENT(1) | JSON_REAL_PRECISION(7));
    json_decref(root);
    if (!text) err_set("the reference cannot be written as JSON");
    return text;
}

// ---- values -----------------------------------------------------------------------------------

static void set_text(json_t *out, const char *key, const char *text) {
    if (text && text[0]) json_object_set_new(out, key, json_string(text));
}

static void set_true(json_t *out, const char *key, bool value) {
    if (value) json_object_set_new(out, key, json_true());
}

static json_t *number_json(float value) {
    bool whole = value == rintf(value) && fabsf(value) < 0x1p24f;
    return whole ? json_integer((json_int_t)value) : json_real((double)value);
}

static json_t *value_json(const value_desc *d, const float *value) {
    if (d->type == VALUE_BOOL) return json_boolean(value[0] != 0);
    if (d->type == VALUE_WORD) return json_string(d->words[(size_t)value[0]]);
    if (d->components <= 1) return number_json(value[0]);
    json_t *all = json_array();
    for (int i = 0; i < d->components; i++) json_array_append_new(all, number_json(value[i]));
    return all;
}

// {"name", "type", "components", "default" or "form", "min", "max", "unit", "help", "words",
// "required"}: what there is of these.
static json_t *desc_json(const value_desc *d) {
    static const char *const types[] = {"number", "whole", "bool", "word", "color", "other"};
    json_t *out = json_pack("{s:s, s:s}", "name", d->name, "type", types[d->type]);
    bool numbers = d->type <= VALUE_WHOLE || d->type == VALUE_COLOR;
    if (numbers && d->components)
        json_object_set_new(out, "components", json_integer(d->components));
    if (d->form)
        set_text(out, "form", d->form);
    else if (!d->required && d->type != VALUE_OTHER)
        json_object_set_new(out, "default", value_json(d, d->value));
    bool range = numbers && (d->min != 0 || d->max != 0);
    if (range && isfinite(d->min)) json_object_set_new(out, "min", number_json(d->min));
    if (range && isfinite(d->max)) json_object_set_new(out, "max", number_json(d->max));
    set_text(out, "unit", d->unit);
    set_text(out, "help", d->help);
    json_t *words = d->word_count ? json_array() : NULL;
    for (size_t i = 0; i < d->word_count; i++)
        json_array_append_new(words, json_string(d->words[i]));
    if (words) json_object_set_new(out, "words", words);
    set_true(out, "required", d->required);
    return out;
}

static json_t *descs_json(const value_desc *list) {
    json_t *all = json_array();
    for (; list && list->name; list++) json_array_append_new(all, desc_json(list));
    return all;
}

// ---- words ------------------------------------------------------------------------------------

static json_t *kind_json(const field_kind *kind) {
    json_t *arguments = json_array(), *keys = json_array();
    for (int i = 0; i < FIELD_MAX_ARGS && kind->args[i].desc.name; i++) {
        json_t *argument = desc_json(&kind->args[i].desc);
        set_true(argument, "uniform", kind->args[i].uniform);
        json_array_append_new(arguments, argument);
    }
    for (int i = 0; i < FIELD_MAX_OPTIONS && kind->options[i].name; i++) {
        value_desc option = info_option(&kind->options[i]);
        json_array_append_new(keys, desc_json(&option));
    }
    return json_pack("{s:s, s:s, s:s, s:s, s:o, s:o, s:[]}", "name", kind->name, "is",
                     kind->args[0].desc.name ? "field" : "value", "group", kind->group, "summary",
                     kind->summary, "arguments", arguments, "keys", keys, "members");
}

static json_t *object_json(const script_object *object) {
    json_t *keys = json_array();
    const value_desc *key;
    for (size_t i = 0; (key = script_object_key(object, i)); i++)
        json_array_append_new(keys, desc_json(key));
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:o, s:o, s:o}", "name", object->name, "is",
                     object->module ? "module" : "object", "group", object->group, "form",
                     object->form, "summary", object->summary, "arguments",
                     descs_json(object->args), "keys", keys, "members",
                     descs_json(object->members));
}

static json_t *words_json(void) {
    json_t *all = json_array();
    for (const field_kind *kind = field_kinds; kind->name; kind++)
        if (script_has_kind(kind)) json_array_append_new(all, kind_json(kind));
    const script_object *object;
    for (size_t i = 0; (object = script_object_at(i)); i++)
        json_array_append_new(all, object_json(object));
    return all;
}

// ---- passes -----------------------------------------------------------------------------------

static json_t *image_json(const shader_image *image) {
    json_t *out = json_pack("{s:s}", "name", image->name);
    if (image->output) set_text(out, "format", gpu_format_name(image->format));
    set_text(out, "help", image->help);
    set_true(out, "optional", image->optional || image->history);
    set_true(out, "volume", image->volume);
    return out;
}

static json_t *interface_json(const pass_type *type, const shader_interface *face) {
    json_t *inputs = json_array(), *outputs = json_array(), *fields = json_array();
    json_t *options = json_array(), *uniforms = json_array(), *counters = json_array();
    for (size_t i = 0; i < face->image_count; i++)
        json_array_append_new(face->images[i].output ? outputs : inputs,
                              image_json(&face->images[i]));
    for (size_t i = 0; i < face->field_count; i++) {
        value_desc own = info_field(&face->fields[i]);
        json_array_append_new(fields, desc_json(&own));
    }
    for (size_t i = 0; i < face->option_count; i++)
        json_array_append_new(options, desc_json(&face->options[i]));
    for (size_t i = 0; i < face->uniform_count; i++)
        json_array_append_new(uniforms, desc_json(&face->uniforms[i]));
    for (size_t i = 0; i < face->counter_count; i++)
        json_array_append_new(counters, json_pack("{s:s, s:s}", "name", face->counters[i].name,
                                                  "help", face->counters[i].help));
    return json_pack("{s:s, s:b, s:s, s:o, s:o, s:o, s:o, s:o, s:o}", "name", type->name,
                     "constructor", !type->constructed, "summary", face->summary, "inputs", inputs,
                     "fields", fields, "options", options, "uniforms", uniforms, "outputs", outputs,
                     "counters", counters);
}

static json_t *passes_json(roil *r) {
    shader_library *library =
        shader_library_create(&(shader_library_desc){.shader_root = r->shaders});
    if (!library) return NULL;
    size_t count;
    const pass_type *const *types = pass_types(&count);
    arena memory = {0};
    json_t *all = json_array();
    for (size_t i = 0; all && i < count; i++) {
        const shader_interface *face =
            shader_interface_load(library, &memory, types[i]->shader, NULL);
        if (face) {
            json_array_append_new(all, interface_json(types[i], face));
        } else {
            json_decref(all);
            all = NULL;
        }
    }
    arena_free(&memory);
    shader_library_destroy(library);
    return all;
}

json_t *info_tree(roil *r) {
    json_t *passes = passes_json(r);
    if (!passes) return NULL;
    return json_pack("{s:s, s:o, s:o}", "roil", roil_version(), "words", words_json(), "passes",
                     passes);
}

// Leaves the entry of that name alone in a list. False: there is none.
static bool keep_one(json_t *list, const char *name) {
    for (size_t i = json_array_size(list); i-- > 0;) {
        const json_t *own = json_object_get(json_array_get(list, i), "name");
        if (strcmp(json_string_value(own), name) != 0) json_array_remove(list, i);
    }
    return json_array_size(list) > 0;
}

char *roil_info_json(roil *r, const char *list, const char *name) {
    mem_enter();
    json_t *root = info_tree(r);
    if (!root) return roil_leave_text(NULL);
    if (list) json_object_del(root, strcmp(list, "words") == 0 ? "passes" : "words");
    if (list && name && !keep_one(json_object_get(root, list), name)) {
        json_decref(root);
        char *text =
            strcmp(list, "words") == 0 ? roil_info_fields(name) : roil_info_passes(r, name);
        assert(!text); // it says what is near
        roil_free(text);
        return roil_leave_text(NULL);
    }
    return roil_leave_text(info_finish_json(root));
}

// ---- devices, one effect ----------------------------------------------------------------------

char *roil_info_devices_json(void) {
    mem_enter();
    gpu_info infos[16];
    int count = gpu_list(infos, COUNT_OF(infos));
    if (count < 0) return roil_leave_text(NULL);
    json_t *all = json_array();
    for (int i = 0; i < count && i < (int)COUNT_OF(infos); i++) {
        const gpu_info *d = &infos[i];
        json_t *one = json_pack("{s:i, s:s, s:s, s:s, s:s, s:I, s:b}", "index", i, "name", d->name,
                                "uuid", d->uuid, "kind", info_device_kind(d->kind), "driver",
                                d->driver, "memory", (json_int_t)d->memory, "usable", d->usable);
        if (!d->usable) set_text(one, "missing", d->missing);
        json_array_append_new(all, one);
    }
    return roil_leave_text(
        info_finish_json(json_pack("{s:s, s:o}", "roil", roil_version(), "devices", all)));
}

static json_t *control_json(roil_effect *e, size_t index) {
    static const char *const types[] = {"number", "whole",   "bool",  "word",  "vector",
                                        "color",  "palette", "curve", "events"};
    roil_control c;
    roil_get_control(e, index, &c);
    const effect_control *own = effect_get_control(e->effect, index);
    json_t *out = desc_json(own->desc);
    json_object_set_new(out, "name", json_string(c.name));
    json_object_set_new(out, "type", json_string(types[c.type]));
    json_object_del(out, "default");
    if (c.type < ROIL_PALETTE) {
        json_object_set_new(out, "value", value_json(own->desc, c.value));
        json_object_set_new(out, "initial", value_json(own->desc, c.initial));
    }
    char *text = roil_control_text(e, c.name);
    set_text(out, "text", text);
    roil_free(text);
    set_text(out, "label", c.label);
    set_text(out, "group", c.group);
    if (c.layer) json_object_set_new(out, "layer", json_integer((json_int_t)c.layer));
    set_true(out, "parameter", c.parameter);
    set_true(out, "log", c.log_scale);
    set_true(out, "structural", c.structural);
    set_true(out, "driven", c.driven);
    set_true(out, "moved", c.moved);
    return out;
}

json_t *info_effect_json(const roil_effect_info *info) {
    json_t *out =
        json_pack("{s:o, s:f, s:i, s:i}", "name", sheet_text(info->name), "fps", info->fps,
                  "first_frame", (int)info->first_frame, "frames", (int)info->frames);
    if (info->author) json_object_set_new(out, "author", sheet_text(info->author));
    if (info->licence) json_object_set_new(out, "licence", sheet_text(info->licence));
    return out;
}

char *roil_info_params_json(roil_effect *e) {
    mem_enter();
    roil_effect_info info = roil_get_info(e);
    json_t *controls = json_array();
    for (size_t i = 0; i < roil_control_count(e); i++)
        json_array_append_new(controls, control_json(e, i));
    return roil_leave_text(
        info_finish_json(json_pack("{s:s, s:o, s:o}", "roil", roil_version(), "effect",
                                   info_effect_json(&info), "controls", controls)));
}
