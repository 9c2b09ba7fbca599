// The reference as annotations for lua-language-server, from its JSON.
#include "base/memory.h"
#include "base/str.h"
#include "roil/info.h"
#include <ctype.h>
#include <string.h>

static const char *text_of(const json_t *item, const char *key) {
    const char *text = json_string_value(json_object_get(item, key));
    return text ? text : "";
}

static bool is_text(const json_t *item, const char *key, const char *text) {
    return strcmp(text_of(item, key), text) == 0;
}

// Appends a text as one line, or, for `comment`, as lines that begin with "---".
static void add_lines(strbuf *out, const char *text, bool comment) {
    if (comment && text[0]) strbuf_add(out, "--- ");
    for (; *text; text++) {
        if (*text == '\n')
            strbuf_add(out, comment && text[1] ? "\n--- " : " ");
        else
            strbuf_append(out, text, 1);
    }
}

// ---- values -----------------------------------------------------------------------------------

static void add_type(strbuf *out, const json_t *value) {
    static const char *const plain[][2] = {
        {"bool", "boolean|roil.field"}, {"color", "roil.color"}, {"whole", "roil.number"}};
    for (size_t i = 0; i < COUNT_OF(plain); i++)
        if (is_text(value, "type", plain[i][0])) {
            strbuf_add(out, "%s", plain[i][1]);
            return;
        }
    const json_t *words = json_object_get(value, "words");
    for (size_t i = 0; i < json_array_size(words); i++)
        strbuf_add(out, "\"%s\"|", json_string_value(json_array_get(words, i)));
    if (words) // dimensions = 4 is dimensions = "4"
        strbuf_add(out, isdigit((unsigned char)json_string_value(json_array_get(words, 0))[0])
                            ? "roil.number"
                            : "roil.field");
    else if (is_text(value, "type", "other"))
        strbuf_add(out, "any");
    else
        strbuf_add(out, json_integer_value(json_object_get(value, "components")) == 1
                            ? "roil.number"
                            : "roil.vector");
}

static void add_number(strbuf *out, const json_t *value) {
    if (json_is_string(value))
        strbuf_add(out, "\"%s\"", json_string_value(value));
    else if (json_is_boolean(value))
        strbuf_add(out, "%s", json_is_true(value) ? "true" : "false");
    else if (json_is_array(value))
        for (size_t i = 0; i < json_array_size(value); i++)
            strbuf_add(out, "%s%g", i ? ", " : "", json_number_value(json_array_get(value, i)));
    else
        strbuf_add(out, "%g", json_number_value(value));
}

// "0.5 [0, 1] m: how far"
static void add_help(strbuf *out, const json_t *value) {
    size_t begin = out->length;
    const json_t *least = json_object_get(value, "min"), *most = json_object_get(value, "max");
    const json_t *given = json_object_get(value, "default");
    if (given) add_number(out, given);
    add_lines(out, text_of(value, "form"), false);
    const char *space = out->length > begin ? " " : "";
    if (least && most)
        strbuf_add(out, "%s[%g, %g]", space, json_number_value(least), json_number_value(most));
    else if (least || most)
        strbuf_add(out, "%s%s %g", space, least ? "at least" : "at most",
                   json_number_value(least ? least : most));
    space = out->length > begin ? " " : "";
    if (text_of(value, "unit")[0]) strbuf_add(out, "%s%s", space, text_of(value, "unit"));
    if (out->length > begin && text_of(value, "help")[0]) strbuf_add(out, ": ");
    add_lines(out, text_of(value, "help"), false);
}

static void add_fields(strbuf *out, const json_t *values, const char *type) {
    for (size_t i = 0; i < json_array_size(values); i++) {
        const json_t *value = json_array_get(values, i);
        bool required = json_is_true(json_object_get(value, "required"));
        strbuf_add(out, "---@field %s%s ", text_of(value, "name"), required ? "" : "?");
        if (type)
            strbuf_add(out, "%s", type);
        else
            add_type(out, value);
        strbuf_add(out, " ");
        add_help(out, value);
        strbuf_add(out, "\n");
    }
}

// ---- what words give --------------------------------------------------------------------------

static const json_t *find(const json_t *list, const char *name) {
    for (size_t i = 0; i < json_array_size(list); i++)
        if (is_text(json_array_get(list, i), "name", name)) return json_array_get(list, i);
    return NULL;
}

// A member is called "density", "set(value)", "source { }", or "NAME" for any.
static void add_member(strbuf *out, const json_t *root, const char *word, const json_t *member) {
    const char *name = text_of(member, "name"), *form = text_of(member, "form");
    size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyz_");
    strbuf plain = {0}, call = {0}, maker = {0};
    strbuf_append(&plain, name, length);
    strbuf_add(&call, ":%s", strbuf_text(&plain));
    strbuf_add(&maker, "%s_%s", word, strbuf_text(&plain));
    bool made = strstr(name, "{ }") && !find(json_object_get(root, "passes"), strbuf_text(&maker));
    if (!length)
        strbuf_add(out, "---@field [string] roil.field ");
    else if (strstr(name, "{ }") && !made)
        strbuf_add(out, "---@field %s fun(self: any, keys: roil.pass.%s): any ",
                   strbuf_text(&plain), strbuf_text(&maker));
    else if (name[length] || strstr(form, strbuf_text(&call)))
        strbuf_add(out, "---@field %s fun(self: any, ...: any): any ", strbuf_text(&plain));
    else
        strbuf_add(out, "---@field %s %s ", strbuf_text(&plain),
                   strncmp(form, "field", 5) == 0 ? "roil.field" : "any");
    if (name[length]) strbuf_add(out, "%s ", name);
    add_help(out, member);
    strbuf_add(out, "\n");
    strbuf_free(&plain);
    strbuf_free(&call);
    strbuf_free(&maker);
}

// Declares the class that an object's constructor gives. What has no members, and is no part of a
// scene, is a field.
static void add_result(strbuf *out, const json_t *root, const json_t *word) {
    const char *name = text_of(word, "name");
    const json_t *members = json_object_get(word, "members");
    const json_t *made = find(json_object_get(root, "passes"), name);
    bool placed = is_text(word, "group", "scene") || is_text(word, "group", "effect");
    bool is_field = is_text(word, "group", "value") || (!placed && !json_array_size(members));
    strbuf_add(out, "---@class roil.%s%s\n", name, is_field ? ": roil.field" : "");
    for (size_t i = 0; i < json_array_size(members); i++)
        add_member(out, root, name, json_array_get(members, i));
    if (!json_array_size(members))
        add_fields(out, json_object_get(made, "outputs"), "roil.texture");
    if (is_field) strbuf_add(out, "---@operator call(any): roil.field\n");
    strbuf_add(out, "\n");
}

// ---- functions --------------------------------------------------------------------------------

static bool takes_places(const json_t *word) { // rgb(red, green, blue)
    const json_t *arguments = json_object_get(word, "arguments");
    for (size_t i = 0; i < json_array_size(arguments); i++)
        if (!str_is_identifier(text_of(json_array_get(arguments, i), "name"))) return false;
    return json_array_size(arguments) > 0;
}

// The form in which arguments go by place: "(red: any, green: any)".
static void add_places(strbuf *out, const json_t *word) {
    const json_t *arguments = json_object_get(word, "arguments");
    bool named = takes_places(word);
    strbuf_add(out, "---@overload fun(");
    for (size_t i = 0; named && i < json_array_size(arguments); i++) {
        const json_t *one = json_array_get(arguments, i);
        bool reserved = is_text(one, "name", "end") || is_text(one, "name", "function");
        strbuf_add(out, "%s%s%s?: ", i ? ", " : "", text_of(one, "name"), reserved ? "_" : "");
        add_type(out, one);
    }
    strbuf_add(out, named ? ", ...: any)" : "...: any)");
}

static void add_documentation(strbuf *out, const json_t *word) {
    const json_t *arguments = json_object_get(word, "arguments");
    add_lines(out, text_of(word, "summary"), true);
    strbuf_add(out, "\n");
    if (text_of(word, "form")[0]) strbuf_add(out, "---\n---     %s\n---\n", text_of(word, "form"));
    for (size_t i = 0; i < json_array_size(arguments); i++) {
        strbuf_add(out, "--- - %s = ", text_of(json_array_get(arguments, i), "name"));
        add_help(out, json_array_get(arguments, i));
        strbuf_add(out, "\n");
    }
}

static void add_word(strbuf *out, const json_t *root, const json_t *word) {
    const char *name = text_of(word, "name");
    bool is_field = is_text(word, "is", "field");
    if (is_text(word, "is", "value")) {
        add_documentation(out, word);
        strbuf_add(out, "---@type roil.field\n%s = nil\n\n", name);
        return;
    }
    bool runs = find(json_object_get(root, "passes"), name);
    strbuf_add(out, "---@class roil.%s.keys%s%s\n", name, runs ? ": roil.pass." : "",
               runs ? name : "");
    if (is_field) add_fields(out, json_object_get(word, "arguments"), NULL);
    add_fields(out, json_object_get(word, "keys"), NULL);
    strbuf_add(out, "\n");
    if (!is_field) add_result(out, root, word);
    add_documentation(out, word);
    const char *result = is_field ? "field" : name;
    strbuf_add(out, "---@param keys roil.%s.keys\n---@return roil.%s\n", name, result);
    if (json_array_size(json_object_get(word, "arguments"))) {
        add_places(out, word);
        strbuf_add(out, ": roil.%s\n", result);
    }
    bool local = is_text(word, "is", "module");
    strbuf_add(out, "%sfunction %s(keys) end\n\n", local ? "local " : "", name);
}

// ---- passes -----------------------------------------------------------------------------------

static void add_pass(strbuf *out, const json_t *root, const json_t *type) {
    const char *name = text_of(type, "name");
    strbuf_add(out, "---@class roil.pass.%s: roil.shader.keys\n", name);
    add_fields(out, json_object_get(type, "inputs"), "any");
    add_fields(out, json_object_get(type, "fields"), NULL);
    add_fields(out, json_object_get(type, "options"), NULL);
    add_fields(out, json_object_get(type, "uniforms"), NULL);
    strbuf_add(out, "\n");
    bool word = find(json_object_get(root, "words"), name);
    if (word || !json_is_true(json_object_get(type, "constructor"))) return;
    strbuf_add(out, "---@class roil.%s: roil.texture\n", name);
    add_fields(out, json_object_get(type, "outputs"), "roil.texture");
    strbuf_add(out, "\n");
    add_documentation(out, type);
    strbuf_add(out,
               "---@param keys roil.pass.%s\n---@return roil.%s\n---@overload fun(...: any): "
               "roil.%s\nfunction %s(keys) end\n\n",
               name, name, name, name);
}

// Operators are methods too, whose first argument stands before the colon.
static void add_field_class(strbuf *out, const json_t *words) {
    static const char *const operators[] = {"add", "sub", "mul", "div", "pow"};
    static const char *const components[] = {"x", "y", "z", "r", "g", "b", "a", "rgb"};
    strbuf_add(out, "---@class roil.field\n");
    for (size_t i = 0; i < COUNT_OF(operators); i++)
        strbuf_add(out, "---@operator %s(any): roil.field\n", operators[i]);
    strbuf_add(out, "---@operator unm: roil.field\n");
    for (size_t i = 0; i < COUNT_OF(components); i++)
        strbuf_add(out, "---@field %s roil.field\n", components[i]);
    for (size_t i = 0; i < json_array_size(words); i++) {
        const json_t *word = json_array_get(words, i);
        if (is_text(word, "is", "field") && is_text(word, "group", "operator"))
            strbuf_add(out, "---@field %s fun(self: roil.field, ...: any): roil.field %s\n",
                       text_of(word, "name"), text_of(word, "summary"));
    }
    static const char *const own[] = {"get", "set", "toggle", "bake", "tile"};
    for (size_t i = 0; i < COUNT_OF(own); i++)
        strbuf_add(out, "---@field %s fun(self: roil.field, ...: any): any\n", own[i]);
    strbuf_add(out, "\n");
}

char *roil_info_lua_meta(roil *r) {
    mem_enter();
    json_t *root = info_tree(r);
    if (!root) return roil_leave_text(NULL);
    const json_t *words = json_object_get(root, "words"), *passes = json_object_get(root, "passes");
    strbuf out = {0};
    strbuf_add(
        &out,
        "---@meta\n"
        "-- The words of effects, of roil %s. `roil info --lua-meta` writes this file, which "
        "lua-language-server reads\n-- and nothing runs.\n\n"
        "---@alias roil.number number|roil.field|fun(t: number): number\n"
        "---@alias roil.vector number|number[]|roil.field|fun(t: number): number[]\n"
        "---@alias roil.color string|number[]|roil.field|fun(t: number): number[]\n\n"
        "---@class roil.texture\n\n",
        text_of(root, "roil"));
    add_field_class(&out, words);
    for (size_t i = 0; i < json_array_size(words); i++)
        add_word(&out, root, json_array_get(words, i));
    for (size_t i = 0; i < json_array_size(passes); i++)
        add_pass(&out, root, json_array_get(passes, i));
    json_decref(root);
    return roil_leave_text(out.text);
}
