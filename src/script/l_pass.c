// Passes: one function per built-in type, and shader { "file.comp", ... } for a user's own. What a
// call may set is read from the shader's declarations, so nothing here knows any pass.
//
// The result stands for the pass's first output where an image is wanted; result.name is the output
// of that name. history(image) is its content in the last frame.
#include "pass/picture/picture.h"
#include "script/binding.h"
#include <string.h>

enum { PASS_COST = 64 << 10, SHAPE_COST = 4 << 10 }; // bytes of host memory charged for one

typedef struct image_object {
    graph_image image;
} image_object;

typedef struct result_object {
    pass *pass;
} result_object;

typedef struct pass_call {
    pass *pass;
    const shader_interface *face;
    const char *who;       // type or file, for messages
    size_t next_input;     // image that the next positional value is for
    bool *taken;           // of the interface's images
    const value_desc *own; // of the constructor, which reads them itself; NULL: none
} pass_call;

// ---- images -----------------------------------------------------------------------------------

static void image_push(lua_State *L, graph_image image) {
    image_object *object = object_new(L, "image", sizeof *object);
    object->image = image;
}

static const shader_image *first_output(const shader_interface *face) {
    for (size_t i = 0; i < face->image_count; i++)
        if (face->images[i].output) return &face->images[i];
    return NULL;
}

// Makes an image from a picture; all calls that use the picture share one pass.
static bool picture_image(lua_State *L, int index, graph_image *out) {
    script *s = script_of(L);
    picture_object *object = object_test(L, index, "picture");
    if (!object) return false;
    if (!object->pass) {
        const char *making = s->making;
        script_require_loading(L, "an image of a file");
        vm_charge_memory(L, PASS_COST);
        s->making = "image";
        pass *made = effect_add_pass(s->effect, "picture", NULL, NULL);
        if (!made) script_raise(L);
        pass_picture_open(made, object->picture);
        if (!pass_declare(made)) script_raise(L);
        s->making = making;
        object->pass = made;
    }
    *out = pass_output(object->pass, "color");
    return true;
}

bool value_image(lua_State *L, int index, graph_image *out) {
    if (picture_image(L, index, out)) return true;
    const image_object *image = object_test(L, index, "image");
    if (image) {
        *out = image->image;
        return true;
    }
    const result_object *result = object_test(L, index, "pass result");
    if (!result) return false;
    const shader_image *output = first_output(pass_interface(result->pass));
    if (output) *out = pass_output(result->pass, output->name);
    return output && out->id;
}

static int l_result_index(lua_State *L) {
    const result_object *result = luaL_checkudata(L, 1, "pass result");
    const char *name = luaL_checkstring(L, 2);
    const shader_interface *face = pass_interface(result->pass);
    const char **names = lua_newuserdatauv(L, (face->image_count + 1) * sizeof *names, 0);
    size_t count = 0;
    for (size_t i = 0; i < face->image_count; i++)
        if (face->images[i].output) names[count++] = face->images[i].name;
    graph_image image = pass_output(result->pass, name);
    if (!image.id) value_unknown(L, pass_label(result->pass), "output", name, names, count);
    image_push(L, image);
    return 1;
}

static int l_history(lua_State *L) {
    graph_image image;
    script_require_loading(L, "history");
    if (!value_image(L, 1, &image))
        vm_error(L, "history takes an image, as in history(volume.color); got %s",
                 object_kind(L, 1));
    image = graph_add_history(effect_graph(script_of(L)->effect), image);
    if (!image.id) script_raise(L);
    image_push(L, image);
    return 1;
}

// ---- setting what a pass takes ----------------------------------------------------------------

static void set_image(lua_State *L, pass_call *call, size_t index, int value) {
    const shader_image *slot = &call->face->images[index];
    graph_image image;
    if (!value_image(L, value, &image))
        vm_error(L, "%s: input '%s' takes an image, such as the result of a pass; got %s",
                 call->who, slot->name, object_kind(L, value));
    if (call->taken[index]) vm_error(L, "%s: input '%s' is given twice", call->who, slot->name);
    call->taken[index] = true;
    if (!pass_set_image(call->pass, slot->name, image)) script_raise(L);
}

static bool is_input(const shader_image *image) {
    return !image->output && !image->history;
}

// Adds the next positional image. Inputs are in the order of declaration in the shader.
static void add_image(lua_State *L, pass_call *call, int value) {
    const shader_interface *face = call->face;
    size_t i = call->next_input;
    while (i < face->image_count && !is_input(&face->images[i])) i++;
    if (i == face->image_count)
        vm_error(L, "%s: too many images; it takes %d without a name", call->who,
                 (int)call->next_input);
    call->next_input = i + 1;
    set_image(L, call, i, value);
}

static void add_positional(lua_State *L, pass_call *call, int value) {
    const mesh_object *mesh = object_test(L, value, "mesh");
    scene_instances *instances = value_instances(L, value);
    graph_image image;
    if (mesh) {
        vm_charge_memory(L, sizeof mesh);
        if (!pass_add_mesh(call->pass, mesh->mesh)) script_raise(L);
        if (strcmp(call->who, "pieces") == 0) mesh->mesh->repeated = true;
    } else if (instances) {
        if (!pass_draws_meshes(call->pass))
            vm_charge_memory(L, scene_instances_count(instances) * SHAPE_COST);
        if (!pass_add_instances(call->pass, instances)) script_raise(L);
    } else if (value_image(L, value, &image)) {
        add_image(L, call, value);
    } else {
        vm_error(L,
                 "%s: values without a name are images, or meshes and instances for geometry; got "
                 "%s",
                 call->who, object_kind(L, value));
    }
}

static void set_uniform(lua_State *L, pass_call *call, size_t index, int value) {
    const value_desc *uniform = &call->face->uniforms[index];
    const char *name = uniform->name;
    const effect_param *param = field_param_of(L, value);
    const field *node;
    if (uniform->type == VALUE_WORD && lua_type(L, value) == LUA_TSTRING) {
        int word = value_word(L, value, call->who, name, uniform->words, uniform->word_count);
        vm_charge_memory(L, sizeof(field));
        node = field_constant(script_memory(L), 1, (float[4]){(float)word});
    } else {
        if (uniform->type == VALUE_WORD && param && param->desc.word_count != uniform->word_count)
            vm_error(L, "%s: '%s' has %d words, but parameter '%s' has %d", call->who, name,
                     (int)uniform->word_count, param->desc.name, (int)param->desc.word_count);
        node = value_uniform(L, value, call->who, name, 0);
    }
    if (!pass_set_uniform(call->pass, name, node)) script_raise(L);
}

// An option is structural: a parameter gives the word that it has while the file loads.
static void set_option(lua_State *L, pass_call *call, size_t index, int value) {
    const char *name = call->face->options[index].name;
    const effect_param *param = field_param_of(L, value);
    const char *word;
    if (param && param->desc.type == VALUE_WORD) {
        const field_object *object = object_test(L, value, "field");
        effect_mark_structural(script_of(L)->effect, (size_t)object->param);
        word = param->desc.words[(size_t)param->value[0]];
    } else if (lua_isstring(L, value)) { // or a number: words like 64
        word = lua_tostring(L, value);
    } else if (lua_isboolean(L, value)) { // of off and on
        word = lua_toboolean(L, value) ? "on" : "off";
    } else {
        vm_error(L, "%s: option '%s' takes a word in quotes, or a parameter with words; got %s",
                 call->who, name, object_kind(L, value));
    }
    if (!pass_set_option(call->pass, name, word)) script_raise(L);
}

// The keys that every pass has stand in the row of `shader`.
static const value_desc *reserved_keys(void) {
    return script_object_find("shader")->keys;
}

static void unknown_key(lua_State *L, const pass_call *call, const char *key) {
    size_t total = pass_most_keys(call->pass);
    for (const value_desc *k = reserved_keys(); k->name; k++) total++;
    for (const value_desc *k = call->own; k && k->name; k++) total++;
    const char **known = lua_newuserdatauv(L, total * sizeof *known, 0);
    size_t count = pass_list_keys(call->pass, known);
    for (const value_desc *k = reserved_keys(); k->name; k++) known[count++] = k->name;
    for (const value_desc *k = call->own; k && k->name; k++)
        if (!script_key_find(reserved_keys(), k->name)) known[count++] = k->name;
    value_unknown(L, call->who, "key", key, known, count);
}

static void set_key(lua_State *L, pass_call *call, const char *key) {
    size_t index;
    int value = lua_gettop(L);
    switch (pass_find_key(call->pass, key, &index)) {
    case PASS_UNIFORM:
        set_uniform(L, call, index, value);
        break;
    case PASS_OPTION:
        set_option(L, call, index, value);
        break;
    case PASS_FIELD: {
        const field *node =
            value_field(L, value, call->who, key, call->face->fields[index].components);
        if (!pass_set_field(call->pass, key, node)) script_raise(L);
        break;
    }
    case PASS_IMAGE:
        set_image(L, call, index, value);
        break;
    case PASS_UNKNOWN:
        if (strcmp(key, "input") == 0 && call->next_input == 0)
            add_image(L, call, value);
        else if (!pass_ignores(call->pass, key))
            unknown_key(L, call, key);
    }
}

// ---- reserved keys ----------------------------------------------------------------------------

static gpu_format read_format(lua_State *L, const pass_call *call) {
    const char *name = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    gpu_format format = gpu_format_from_name(name);
    if (format == GPU_FORMAT_NONE)
        vm_error(L, "%s: '%s' is no format; rgba16f, r32f, rgba8 and the like are accepted",
                 call->who, name);
    return format;
}

// format = "rgba32f" for the first output, or { color = "rgba32f", ... }.
static void set_formats(lua_State *L, pass_call *call, int table) {
    if (value_get(L, table, "format") == LUA_TSTRING) {
        const shader_image *output = first_output(call->face);
        if (!output) vm_error(L, "%s: it has no output to give a format", call->who);
        if (!pass_set_format(call->pass, output->name, read_format(L, call))) script_raise(L);
    } else if (value_is_plain_table(L, -1)) {
        size_t count;
        int formats = lua_gettop(L);
        const char **names = value_names(L, formats, call->who, &count);
        for (size_t i = 0; i < count; i++) {
            value_get(L, formats, names[i]);
            if (!pass_set_format(call->pass, names[i], read_format(L, call))) script_raise(L);
            lua_pop(L, 1);
        }
        lua_pop(L, 1);
    } else if (!lua_isnil(L, -1)) {
        vm_error(L, "%s: 'format' takes a name, or a table of names by output", call->who);
    }
    lua_pop(L, 1);
}

static void add_source(lua_State *L, pass_call *call, int value) {
    const result_object *source = object_test(L, value, "pass result");
    if (!source) {
        const char *got = object_kind(L, value);
        if (object_test(L, value, "image")) got = "an image";
        if (object_test(L, value, "instances")) got = "instances { }, which geometry { } takes";
        vm_error(L,
                 "%s: 'from' takes a pass or a list of passes, as in from = {lit, scene}; got %s",
                 call->who, got);
    }
    vm_charge_memory(L, 2 * sizeof source);
    pass_add_source(call->pass, source->pass);
}

// from = {lit, scene}, or one pass: provides what this call does not set.
static void add_sources(lua_State *L, pass_call *call, int table) {
    int type = value_get(L, table, "from");
    int list = lua_gettop(L);
    if (type == LUA_TTABLE) {
        size_t names;
        value_names(L, list, call->who, &names);
        if (names) vm_error(L, "%s: 'from' takes a list without names", call->who);
        lua_pop(L, 1);
        lua_Integer length = (lua_Integer)lua_rawlen(L, list);
        for (lua_Integer i = 1; i <= length; i++) {
            lua_rawgeti(L, list, i);
            add_source(L, call, lua_gettop(L));
            lua_pop(L, 1);
        }
    } else if (type != LUA_TNIL) {
        add_source(L, call, list);
    }
    lua_pop(L, 1);
}

static void read_table(lua_State *L, pass_call *call, int table, lua_Integer first) {
    lua_Integer length = (lua_Integer)lua_rawlen(L, table);
    for (lua_Integer i = first; i <= length; i++) {
        lua_rawgeti(L, table, i);
        add_positional(L, call, lua_gettop(L));
        lua_pop(L, 1);
    }
    bool scaled = !script_key_find(call->own, "resolution");
    double scale = scaled ? value_get_number(L, table, call->who, "resolution", 1) : 1;
    if (scale != 1 && !pass_set_scale(call->pass, (float)scale)) script_raise(L);
    set_formats(L, call, table);
    add_sources(L, call, table);
    size_t count;
    const char **names = value_names(L, table, call->who, &count);
    for (size_t i = 0; i < count; i++) {
        if (script_key_find(reserved_keys(), names[i]) || script_key_find(call->own, names[i]))
            continue;
        value_get(L, table, names[i]);
        set_key(L, call, names[i]);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

// ---- calling ----------------------------------------------------------------------------------

// Reads the arguments: images, then at most one table of settings. Returns the table's index or 0.
static int settings_table(lua_State *L) {
    int n = lua_gettop(L);
    return n > 0 && value_is_plain_table(L, n) ? n : 0;
}

// Creates the pass. The effect is invalid until it is declared.
static void begin_pass(lua_State *L, pass_call *call, const char *type, const char *file,
                       int table) {
    script *s = script_of(L);
    const char *label = table ? value_get_string(L, table, call->who, "name") : NULL;
    vm_charge_memory(L, PASS_COST);
    script_make(L, call->who);
    call->pass = effect_add_pass(s->effect, type, file, label);
    if (!call->pass) script_raise(L);
    script_note_place(L, call->pass, file ? "shader" : call->who);
    call->face = pass_interface(call->pass);
    vm_charge_memory(L, (call->face->uniform_count + call->face->option_count + 1) *
                            EFFECT_CONTROL_COST);
    call->taken = lua_newuserdatauv(L, call->face->image_count + 1, 0);
    memset(call->taken, 0, call->face->image_count + 1);
}

void pass_push(lua_State *L, pass *p) {
    result_object *result = object_new(L, "pass result", sizeof *result);
    result->pass = p;
}

pass *pass_make(lua_State *L, const char *type, const char *who, int table, const value_desc *own) {
    pass_call call = {.who = who, .own = own};
    begin_pass(L, &call, type, NULL, table);
    read_table(L, &call, table, 1);
    return call.pass;
}

static int make_pass(lua_State *L, const char *type, const char *file, int first_positional,
                     lua_Integer first_element) {
    int n = lua_gettop(L), table = settings_table(L);
    pass_call call = {.who = type ? type : file};
    begin_pass(L, &call, type, file, table);
    for (int i = first_positional; i <= n - (table != 0); i++) add_positional(L, &call, i);
    if (table) read_table(L, &call, table, first_element);
    script_made(L, pass_declare(call.pass));
    pass_push(L, call.pass);
    return 1;
}

// Upvalue: name of the type.
static int l_pass(lua_State *L) {
    const char *type = lua_tostring(L, lua_upvalueindex(1));
    script_require_loading(L, type);
    return make_pass(L, type, NULL, 1, 1);
}

// shader { "haze.comp", image, strength = 0.2 } or shader("haze.comp", image, { strength = 0.2 }).
static int l_shader(lua_State *L) {
    script_require_loading(L, "shader");
    bool direct = lua_type(L, 1) == LUA_TSTRING;
    if (direct)
        lua_pushvalue(L, 1);
    else if (!value_is_plain_table(L, 1) || lua_gettop(L) != 1 ||
             lua_rawgeti(L, 1, 1) != LUA_TSTRING)
        vm_error(L, "shader: its file comes first, as in shader { \"haze.comp\", image }");
    size_t length;
    const char *text = lua_tolstring(L, -1, &length);
    if (strlen(text) != length) vm_error(L, "shader: the file name contains a zero byte");
    vm_charge_memory(L, length + 1);
    const char *file = arena_string(script_memory(L), text);
    lua_pop(L, 1);
    return make_pass(L, NULL, file, direct ? 2 : 1, direct ? 1 : 2);
}

void l_pass_open(lua_State *L) {
    static const luaL_Reg result[] = {{"__index", l_result_index}, {NULL, NULL}};
    object_type(L, "image", NULL);
    object_type(L, "pass result", result);
    size_t count;
    const pass_type *const *types = pass_types(&count);
    for (size_t i = 0; i < count; i++) {
        if (types[i]->constructed) continue; // bake(field), lbm { }, air:source { }
        lua_pushstring(L, types[i]->name);
        lua_pushcclosure(L, l_pass, 1);
        lua_setglobal(L, types[i]->name);
    }
    lua_register(L, "shader", l_shader);
    lua_register(L, "history", l_history);
}
