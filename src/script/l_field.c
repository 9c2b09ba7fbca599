// Fields: one object over the expression trees of the field layer. Constructors, functions and
// methods are made from the table of kinds, so a new kind needs no code here.
#include "base/memory.h"
#include "base/str.h"
#include "effect/events.h"
#include "script/binding.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- objects ----------------------------------------------------------------------------------

void field_push_param(lua_State *L, const field *node, int param) {
    if (!node) script_raise(L);
    script_require_loading(L, "a field");
    vm_charge_memory(L, sizeof(field));
    field_object *object = object_new(L, "field", sizeof *object);
    *object = (field_object){node, param};
}

void field_push(lua_State *L, const field *node) {
    field_push_param(L, node, -1);
}

const effect_param *field_param_of(lua_State *L, int index) {
    const field_object *object = object_test(L, index, "field");
    if (!object || object->param < 0) return NULL;
    return effect_get_param(script_of(L)->effect, (size_t)object->param);
}

static const field_object *self(lua_State *L) {
    const field_object *object = object_test(L, 1, "field");
    if (!object) vm_error(L, "a method of fields needs a field, as in f:warp(...): mind the ':'");
    return object;
}

// ---- calling a kind ---------------------------------------------------------------------------

typedef struct kind_call {
    const field_kind *kind;
    const field *args[FIELD_MAX_ARGS];
    uint8_t options[FIELD_MAX_OPTIONS];
    bool chosen[FIELD_MAX_OPTIONS]; // the script gave the option
    bool written[FIELD_MAX_ARGS];   // the argument is a number, and no field
    size_t arg_count;               // of the kind
    size_t next;                    // argument that the next positional value is for
} kind_call;

static void take_arg(lua_State *L, kind_call *call, size_t i, int index) {
    const field_kind *kind = call->kind;
    if (i >= call->arg_count)
        vm_error(L, "%s takes at most %d arguments", kind->name, (int)call->arg_count);
    if (lua_isnil(L, index)) return;
    const field_arg *arg = &kind->args[i];
    if (call->args[i]) vm_error(L, "%s: '%s' is given twice", kind->name, arg->desc.name);
    value_refuse_two(L, index, kind->name, arg->desc.name, arg->desc.components);
    call->written[i] = lua_type(L, index) != LUA_TUSERDATA;
    call->args[i] = value_field(L, index, kind->name, arg->desc.name, arg->desc.components);
}

static size_t word_count(const field_option *option) {
    size_t n = 0;
    while (n < COUNT_OF(option->words) && option->words[n]) n++;
    return n;
}

static void take_named(lua_State *L, kind_call *call, const char *name) {
    const field_kind *kind = call->kind;
    for (size_t i = 0; i < call->arg_count; i++)
        if (strcmp(kind->args[i].desc.name, name) == 0) {
            take_arg(L, call, i, lua_gettop(L));
            return;
        }
    const char *known[FIELD_MAX_ARGS + FIELD_MAX_OPTIONS];
    size_t count = 0;
    for (size_t i = 0; i < call->arg_count; i++) known[count++] = kind->args[i].desc.name;
    for (size_t i = 0; i < FIELD_MAX_OPTIONS && kind->options[i].name; i++) {
        const field_option *option = &kind->options[i];
        known[count++] = option->name;
        if (strcmp(option->name, name) != 0) continue;
        if (lua_type(L, -1) == LUA_TNUMBER) lua_tostring(L, -1); // dimensions = 4
        call->chosen[i] = true;
        call->options[i] =
            (uint8_t)value_word(L, -1, kind->name, name, option->words, word_count(option));
        return;
    }
    value_unknown(L, kind->name, "key", name, known, count);
}

static void take_table(lua_State *L, kind_call *call, int table) {
    lua_Integer length = (lua_Integer)lua_rawlen(L, table);
    for (lua_Integer i = 1; i <= length; i++) {
        lua_rawgeti(L, table, i);
        take_arg(L, call, call->next++, lua_gettop(L));
        lua_pop(L, 1);
    }
    size_t count;
    const char **names = value_names(L, table, call->kind->name, &count);
    for (size_t i = 0; i < count; i++) {
        value_get(L, table, names[i]);
        take_named(L, call, names[i]);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

// `speed` and `w` move through a fourth dimension, so they imply one.
static void imply_dimensions(kind_call *call) {
    for (size_t a = 0; a < call->arg_count; a++) {
        const char *name = call->kind->args[a].desc.name;
        if (!call->args[a] || (strcmp(name, "speed") != 0 && strcmp(name, "w") != 0)) continue;
        for (size_t i = 0; i < FIELD_MAX_OPTIONS && call->kind->options[i].name; i++)
            if (!call->chosen[i] && strcmp(call->kind->options[i].name, "dimensions") == 0)
                call->options[i] = 1; // the word "4"
    }
}

// Functions of numbers return numbers, so that functions of time can use them in every frame.
static bool push_number(lua_State *L, const field_kind *kind, int count) {
    if (strcmp(kind->group, "operator") != 0 || kind->spatial || count == 0) return false;
    for (int i = 1; i <= count; i++)
        if (lua_type(L, i) != LUA_TNUMBER) return false;
    if (count > FIELD_MAX_ARGS || kind->components > 1 || !kind->args[count - 1].desc.name)
        return false;
    arena scratch = {0};
    field_context context = script_context(L);
    const field *args[FIELD_MAX_ARGS] = {0};
    float value[4];
    for (int i = 0; i < count; i++) {
        value[0] = (float)lua_tonumber(L, i + 1);
        args[i] = field_constant(&scratch, 1, value);
    }
    const field *node = field_make(&scratch, kind->name, args, NULL);
    bool done = node && field_eval(node, &context, (float3){0}, value);
    arena_free(&scratch);
    if (!done) script_raise(L);
    lua_pushnumber(L, (double)value[0]);
    return true;
}

// Numbers that are written out in the call become controls, named after the variable. A shape has a
// name also where all of its numbers come from elsewhere.
static void declare_numbers(lua_State *L, const kind_call *call, const field *node) {
    effect *e = script_of(L)->effect;
    field *values[FIELD_MAX_ARGS] = {0};
    size_t count = 0;
    if (strcmp(call->kind->group, "operator") == 0 || !effect_has_room_for_field(e)) return;
    for (size_t i = 0; i < call->arg_count; i++) {
        if (!call->args[i] || !call->written[i] || !field_is_constant(call->args[i])) continue;
        values[i] = (field *)(uintptr_t)call->args[i];
        script_note_place(L, values[i], call->kind->name);
        count++;
    }
    if (count == 0 && strcmp(call->kind->group, "shape") != 0) return;
    char name[64];
    vm_charge_memory(L, count * EFFECT_CONTROL_COST);
    if (!value_variable(L, call->kind->name, name, sizeof name))
        str_copy(name, sizeof name, call->kind->name);
    if (!effect_add_field(e, name, node, values)) script_raise(L);
}

// Upvalue: the kind. If the last argument is a table with names, it holds arguments and options.
static int l_kind(lua_State *L) {
    const field_kind *kind = lua_touserdata(L, lua_upvalueindex(1));
    kind_call call = {.kind = kind};
    while (call.arg_count < FIELD_MAX_ARGS && kind->args[call.arg_count].desc.name)
        call.arg_count++;
    int n = lua_gettop(L);
    if (push_number(L, kind, n)) return 1;
    script_require_loading(L, kind->name);
    bool is_operator = strcmp(kind->group, "operator") == 0;
    bool table = n > 0 && value_is_plain_table(L, n);
    bool named =
        table && ((n == 1 && (!is_operator || call.arg_count > 1)) || value_has_names(L, n));
    for (int i = 1; i <= n - named; i++) take_arg(L, &call, call.next++, i);
    if (named) take_table(L, &call, n);
    imply_dimensions(&call);
    if (strcmp(kind->name, "advect") == 0) vm_charge_memory(L, FIELD_ADVECT_COST);
    const field *node = field_make(script_memory(L), kind->name, call.args, call.options);
    field_push(L, node);
    declare_numbers(L, &call, node);
    return 1;
}

// ---- arithmetic -------------------------------------------------------------------------------

typedef struct arithmetic {
    const char *metamethod, *kind, *sign;
    int count; // of operands
} arithmetic;

// Its upvalue says which.
static int l_arithmetic(lua_State *L) {
    const arithmetic *a = lua_touserdata(L, lua_upvalueindex(1));
    const field *args[FIELD_MAX_ARGS] = {0};
    script_require_loading(L, "arithmetic on a field or parameter");
    for (int i = 0; i < a->count; i++)
        args[i] = value_field(L, i + 1, a->sign, i == 0 ? "left side" : "right side", 0);
    field_push(L, field_make(script_memory(L), a->kind, args, NULL));
    return 1;
}

static int l_compare(lua_State *L) {
    vm_error(L, "fields and parameters cannot be compared: their values are not known while the "
                "file loads; use step, smoothstep, min or max");
}

static int l_tostring(lua_State *L) {
    strbuf text = {0};
    field_print(self(L)->node, &text);
    lua_pushlstring(L, strbuf_text(&text), text.length < 1000 ? text.length : 1000);
    strbuf_free(&text);
    return 1;
}

// ---- methods ----------------------------------------------------------------------------------

enum { WALK_MAX = 4096 }; // nodes; a larger expression is taken to hold every parameter

static void mark_params(effect *e, const field *node) {
    if (strcmp(node->kind->name, "param") == 0) effect_mark_structural(e, (size_t)node->index);
    for (size_t i = 0; i < FIELD_MAX_ARGS && node->args[i]; i++) mark_params(e, node->args[i]);
}

// A value that the file reads while it loads may decide what it declares.
static void mark_structural(script *s, const field *node) {
    if (!s->loading) return;
    if (node->size <= WALK_MAX)
        mark_params(s->effect, node);
    else
        for (size_t i = 0; i < effect_param_count(s->effect); i++)
            effect_mark_structural(s->effect, i);
}

enum { FIELD_COST = 50, NODE_COST = 10 }; // in instructions of the script

// f:get { x, y, z }: where the value of a field that varies in space is asked for.
static float3 read_place(lua_State *L, const field *node) {
    float at[4];
    if (lua_isnoneornil(L, 2))
        vm_error(L, "get: this field varies in space; say where, as in get { 0, 0, 1 }");
    if (value_numbers(L, 2, at) != 3 || !isfinite(at[0] + at[1] + at[2]))
        vm_error(L, "get: the place is three numbers (m), as in get { 0, 0, 1 }");
    vm_charge(L, FIELD_COST + (uint64_t)NODE_COST * node->size);
    return (float3){at[0], at[1], at[2]};
}

// Returns the value of now; at time 0 while the file loads. A parameter of words returns its word.
static int l_get(lua_State *L) {
    const field_object *object = self(L);
    const effect_param *param = field_param_of(L, 1);
    mark_structural(script_of(L), object->node);
    if (param && param->desc.type == VALUE_WORD) {
        size_t word = (size_t)param->value[0];
        lua_pushstring(L, param->desc.words[word]);
        return 1;
    }
    if (param && param->desc.type == VALUE_BOOL) {
        lua_pushboolean(L, param->value[0] != 0);
        return 1;
    }
    float3 place = {0, 0, 0};
    if (!param && !object->node->uniform) place = read_place(L, object->node);
    field_context context = script_context(L);
    float value[4] = {0};
    if (!field_eval(object->node, &context, place, value)) script_raise(L);
    if (object->node->components == 1) {
        lua_pushnumber(L, (double)value[0]);
        return 1;
    }
    lua_createtable(L, object->node->components, 0);
    for (int i = 0; i < object->node->components; i++) {
        lua_pushnumber(L, (double)value[i]);
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

// p:set(value), for `update` and handlers of events. It holds until time goes back.
static int l_set(lua_State *L) {
    const field_object *object = self(L);
    const effect_param *param = field_param_of(L, 1);
    if (!param) vm_error(L, "set: only a parameter can be set");
    float value[4] = {0};
    if (param->desc.type == VALUE_WORD && lua_type(L, 2) == LUA_TSTRING) {
        value[0] = (float)value_word(L, 2, param->desc.name, "value", param->desc.words,
                                     param->desc.word_count);
    } else {
        int wanted = object->node->components, count = value_numbers(L, 2, value);
        if (count != wanted)
            vm_error(L, "set: '%s' takes %d number%s", param->desc.name, wanted,
                     wanted > 1 ? "s" : "");
    }
    if (!effect_move_param(script_of(L)->effect, (size_t)object->param, value)) script_raise(L);
    return 0;
}

// p:toggle() inverts true and false, and goes to the next word.
static int l_toggle(lua_State *L) {
    const field_object *object = self(L);
    const effect_param *param = field_param_of(L, 1);
    if (!param || (param->desc.type != VALUE_BOOL && param->desc.type != VALUE_WORD))
        vm_error(L, "toggle: only a parameter of true and false, or of words, has another value");
    float value[4] = {param->value[0] < param->desc.max ? param->value[0] + 1 : 0};
    if (!effect_move_param(script_of(L)->effect, (size_t)object->param, value)) script_raise(L);
    return 0;
}

// Upvalue: methods by name. Other names choose components: f.x, f.rgb.
static int l_index(lua_State *L) {
    const field_object *object = self(L);
    if (lua_type(L, 2) != LUA_TSTRING)
        vm_error(L, "a field has no element [%s]", luaL_typename(L, 2));
    const char *name = lua_tostring(L, 2);
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) return 1;
    if (name[0] && strlen(name) <= 4 && strspn(name, "xyzwrgba") == strlen(name)) {
        script_require_loading(L, "a component of a field");
        field_push(L, field_swizzle(script_memory(L), object->node, name));
        return 1;
    }
    size_t count;
    const char **names = value_names(L, lua_upvalueindex(1), "field", &count);
    value_unknown(L, "field", "method", name, names, count);
}

// ---- a user's GLSL function -------------------------------------------------------------------

// glsl { "swirl.glsl", "swirl", argument, ..., components = 1 }
static int l_glsl(lua_State *L) {
    script_require_loading(L, "glsl");
    value_check_object(L, 1, "glsl");
    const char *names[2];
    for (int i = 0; i < 2; i++) {
        if (lua_rawgeti(L, 1, i + 1) != LUA_TSTRING)
            vm_error(L, "glsl: wanted are a file and a function, as in glsl { \"swirl.glsl\", "
                        "\"swirl\" }");
        names[i] = lua_tostring(L, -1); // stays on the stack
    }
    field_glsl glsl = {.file = names[0],
                       .function = names[1],
                       .components = (int)value_get_number(L, 1, "glsl", "components", 1)};
    lua_Unsigned length = lua_rawlen(L, 1);
    if (length - 2 > FIELD_MAX_ARGS)
        vm_error(L, "glsl: at most %d arguments are accepted", FIELD_MAX_ARGS);
    glsl.arg_count = (int)length - 2;
    const field *args[FIELD_MAX_ARGS] = {0};
    for (int i = 0; i < glsl.arg_count; i++) {
        lua_rawgeti(L, 1, i + 3);
        args[i] = value_field(L, -1, "glsl", "argument", 0);
        lua_pop(L, 1);
    }
    vm_charge_memory(L, strlen(names[0]) + strlen(names[1]) + sizeof glsl);
    field_push(L, field_user(script_memory(L), &glsl, args));
    return 1;
}

// ---- globals ----------------------------------------------------------------------------------

// Makes a function for each kind, a value for each kind without arguments, and methods for
// operators.
static void open_kinds(lua_State *L, int methods) {
    for (const field_kind *kind = field_kinds; kind->name; kind++) {
        if (!script_has_kind(kind)) continue;
        if (!kind->args[0].desc.name) {
            field_push(L, field_make(script_memory(L), kind->name, NULL, NULL));
            lua_setglobal(L, kind->name);
            continue;
        }
        lua_pushlightuserdata(L, (void *)(uintptr_t)kind);
        lua_pushcclosure(L, l_kind, 1);
        if (strcmp(kind->group, "operator") == 0) {
            lua_pushvalue(L, -1);
            lua_setfield(L, methods, kind->name);
        }
        lua_setglobal(L, kind->name);
    }
}

void l_field_open(lua_State *L) {
    static const arithmetic operators[] = {{"__add", "add", "+", 2}, {"__sub", "sub", "-", 2},
                                           {"__mul", "mul", "*", 2}, {"__div", "div", "/", 2},
                                           {"__pow", "pow", "^", 2}, {"__unm", "negate", "-", 1}};
    static const luaL_Reg others[] = {
        {"__lt", l_compare}, {"__le", l_compare}, {"__tostring", l_tostring}, {NULL, NULL}};
    static const luaL_Reg own[] = {{"get", l_get},   {"set", l_set},   {"toggle", l_toggle},
                                   {"bake", l_bake}, {"tile", l_tile}, {NULL, NULL}};
    object_type(L, "field", others);
    lua_newtable(L);
    int methods = lua_gettop(L);
    luaL_setfuncs(L, own, 0);
    open_kinds(L, methods);
    luaL_getmetatable(L, "field");
    lua_pushvalue(L, methods);
    lua_pushcclosure(L, l_index, 1);
    lua_setfield(L, -2, "__index");
    for (size_t i = 0; i < COUNT_OF(operators); i++) {
        lua_pushlightuserdata(L, (void *)(uintptr_t)&operators[i]);
        lua_pushcclosure(L, l_arithmetic, 1);
        lua_setfield(L, -2, operators[i].metamethod);
    }
    lua_pop(L, 2);
    lua_register(L, "glsl", l_glsl);
}
