// Building expressions. Every way to make a node ends in `finish`, which derives what later walks
// rely on: whether the node varies in space, its depth (so that recursion is bounded) and its size.
#include "field/field.h"
#include "base/error.h"
#include "field/kinds.h"
#include <assert.h>
#include <string.h>

const field_kind *field_kind_find(const char *name) {
    const char *names[128];
    size_t count = 0;
    for (const field_kind *kind = field_kinds; kind->name; kind++) {
        if (strcmp(kind->name, name) == 0) return kind;
        assert(count < sizeof names / sizeof *names);
        names[count++] = kind->name;
    }
    const char *near = str_nearest(name, names, count);
    err_set("unknown field '%.64s'%s%s%s", name, near ? "; did you mean '" : "", near ? near : "",
            near ? "'?" : "");
    return NULL;
}

static field *new_node(arena *memory, int kind, int components) {
    field *node = arena_alloc(memory, sizeof *node);
    node->kind = &field_kinds[kind];
    node->components = components;
    return node;
}

static field *finish(field *node) {
    int deepest = 0;
    uint64_t size = 1;
    // What a point-moving node takes elsewhere is uniform if that is, wherever it is taken.
    bool moves = kind_of(node) == KIND_WARP || kind_of(node) == KIND_TRANSFORM;
    node->uniform = moves ? node->args[0]->uniform : !node->kind->spatial;
    for (size_t i = 0; i < FIELD_MAX_ARGS && node->args[i]; i++) {
        const field *arg = node->args[i];
        if (arg->depth > deepest) deepest = arg->depth;
        size += arg->size;
        if (!moves && !arg->uniform) node->uniform = false;
    }
    if (deepest >= FIELD_MAX_DEPTH)
        return ERR_NULL("%s: the expression is nested deeper than %d", node->kind->name,
                        FIELD_MAX_DEPTH);
    node->depth = (uint16_t)(deepest + 1);
    node->size = size < UINT32_MAX ? (uint32_t)size : UINT32_MAX;
    return node;
}

static bool components_fit(int components) {
    return components == 1 || components == 3 || components == 4;
}

field *field_constant(arena *memory, int components, const float value[4]) {
    assert(components_fit(components));
    field *node = new_node(memory, KIND_CONSTANT, components);
    memcpy(node->value, value, (size_t)components * sizeof *value);
    return finish(node);
}

bool field_is_constant(const field *node) {
    return node->kind == &field_kinds[KIND_CONSTANT];
}

field *field_param(arena *memory, int components, int index) {
    assert(components_fit(components) && index >= 0);
    field *node = new_node(memory, KIND_PARAM, components);
    node->index = index;
    return finish(node);
}

field *field_curve(arena *memory, const curve *c) {
    if (!components_fit(c->components)) {
        err_set("curve: its keys have %d components; a field has 1, 3 or 4", c->components);
        return NULL;
    }
    field *node = new_node(memory, KIND_CURVE, c->components);
    node->object = c;
    return finish(node);
}

field *field_call(arena *memory, int components, int function) {
    assert(components_fit(components));
    field *node = new_node(memory, KIND_CALL, components);
    node->index = function;
    return finish(node);
}

field *field_time(arena *memory) {
    return finish(new_node(memory, KIND_TIME, 1));
}

field *field_grid_channel(arena *memory, const field_grid *grid, int channel, int components) {
    assert(components_fit(components) && channel >= 0 &&
           channel + components <= grid->channel_count);
    assert(grid->channel_count <= 4 * FIELD_GRID_IMAGES);
    field *node = new_node(memory, KIND_GRID, components);
    node->object = grid;
    node->index = channel;
    return finish(node);
}

field *field_palette(arena *memory, const palette *p, const field *at) {
    if (at->components != 1) {
        err_set("palette: it maps a single number; this field has %d components", at->components);
        return NULL;
    }
    field *node = new_node(memory, KIND_PALETTE, 4);
    node->object = p;
    node->args[0] = at;
    return finish(node);
}

field *field_user(arena *memory, const field_glsl *glsl, const field *const *args) {
    if (!components_fit(glsl->components) || glsl->arg_count < 0 ||
        glsl->arg_count > FIELD_MAX_ARGS) {
        err_set("glsl: '%.64s' gives %d components from %d arguments; 1, 3 or 4 components and at "
                "most %d arguments are accepted",
                glsl->function, glsl->components, glsl->arg_count, FIELD_MAX_ARGS);
        return NULL;
    }
    if (!str_is_identifier(glsl->function) || strlen(glsl->function) > 100 ||
        strncmp(glsl->function, "field", 5) == 0) {
        err_set(
            "glsl: '%.64s' cannot name a function; a GLSL identifier of at most 100 letters that "
            "does not begin with 'field' is accepted",
            glsl->function);
        return NULL;
    }
    for (const char *c = glsl->file; *c; c++)
        if ((unsigned char)*c < ' ' || *c == '"' || *c == '\\')
            return ERR_NULL(
                "glsl: the file name '%.64s' holds a character that #include cannot take",
                glsl->file);
    field_glsl *copy = arena_copy(memory, glsl, sizeof *glsl);
    copy->file = arena_string(memory, glsl->file);
    copy->function = arena_string(memory, glsl->function);
    field *node = new_node(memory, KIND_GLSL, glsl->components);
    node->object = copy;
    for (int i = 0; i < glsl->arg_count; i++) node->args[i] = args[i];
    return finish(node);
}

// ---- any kind of the table --------------------------------------------------------------------

static bool check_arg(const field_kind *kind, const field_arg *spec, const field *arg) {
    if (spec->desc.components > 0 && arg->components != 1 &&
        arg->components != spec->desc.components)
        return err_set("%s: '%s' has %d components; %d %s accepted", kind->name, spec->desc.name,
                       arg->components, spec->desc.components,
                       spec->desc.components == 1 ? "is" : "or a single one are");
    if (spec->uniform && !arg->uniform)
        return err_set("%s: '%s' varies in space; a number, a parameter, a curve or a function of "
                       "the time is accepted",
                       kind->name, spec->desc.name);
    int wrong = kind_of(arg) == KIND_CONSTANT
                    ? value_find_wrong(&spec->desc, arg->value, arg->components)
                    : -1;
    return wrong < 0 ||
           value_refuse(&spec->desc, arg->value[wrong], "%s: '%s'", kind->name, spec->desc.name);
}

static bool make_arg(arena *memory, field *node, size_t i, const field *given) {
    const field_arg *spec = &node->kind->args[i];
    if (!given && spec->desc.required)
        return err_set("%s: '%s' is missing (%s)", node->kind->name, spec->desc.name,
                       spec->desc.help);
    const field *arg = given;
    if (!arg)
        arg = field_constant(memory, spec->desc.components ? spec->desc.components : 1,
                             spec->desc.value);
    if (!check_arg(node->kind, spec, arg)) return false;
    if (spec->rate) {
        const field *factors[] = {arg, field_time(memory)};
        arg = field_make(memory, "mul", factors, NULL);
    }
    node->args[i] = arg;
    return arg != NULL;
}

// Arguments that take any number of components share one, or have a single one.
static bool find_width(const field *node, int *width) {
    *width = 1;
    const char *widest = "";
    for (size_t i = 0; node->kind->args[i].desc.name; i++) {
        const field_arg *spec = &node->kind->args[i];
        int components = node->args[i]->components;
        if (spec->desc.components != 0 || components == 1) continue;
        if (*width != 1 && *width != components)
            return err_set("%s: '%s' has %d components but '%s' has %d", node->kind->name, widest,
                           *width, spec->desc.name, components);
        *width = components;
        widest = spec->desc.name;
    }
    return true;
}

static bool set_options(field *node, const uint8_t *options) {
    for (size_t i = 0; options && i < FIELD_MAX_OPTIONS && node->kind->options[i].name; i++) {
        size_t words = 0;
        while (words < 6 && node->kind->options[i].words[words]) words++;
        if (options[i] >= words)
            return err_set("%s: option '%s' has no word %d", node->kind->name,
                           node->kind->options[i].name, (int)options[i]);
        node->options[i] = options[i];
    }
    return true;
}

field *field_with_args(arena *memory, const field *node, const field *const *args) {
    field *copy = arena_copy(memory, node, sizeof *node);
    memcpy(copy->args, args, sizeof copy->args);
    return finish(copy);
}

field *field_make(arena *memory, const char *kind, const field *const *args,
                  const uint8_t *options) {
    const field_kind *row = field_kind_find(kind);
    if (!row) return NULL;
    int index = (int)(row - field_kinds);
    if (index == KIND_TIME) return field_time(memory);
    if (index <= KIND_SWIZZLE)
        return ERR_NULL("a field of kind '%s' cannot be made by its name alone", kind);
    field *node = new_node(memory, index, row->components);
    for (size_t i = 0; i < FIELD_MAX_ARGS && row->args[i].desc.name; i++)
        if (!make_arg(memory, node, i, args ? args[i] : NULL)) return NULL;
    int width;
    if (!find_width(node, &width) || !set_options(node, options)) return NULL;
    if (row->components == 0) node->components = width;
    return index == KIND_ADVECT ? field_advect(memory, node) : finish(node);
}

static int component(char letter) {
    static const char *const sets[] = {"xyzw", "rgba"};
    for (size_t i = 0; i < 2; i++) {
        const char *found = strchr(sets[i], letter);
        if (found && letter) return (int)(found - sets[i]);
    }
    return -1;
}

field *field_swizzle(arena *memory, const field *a, const char *components) {
    size_t count = strlen(components);
    bool right = components_fit((int)count) && count <= 4;
    int index = 0;
    for (size_t i = 0; right && i < count; i++) {
        int c = component(components[i]);
        right = c >= 0 && c < a->components;
        if (right) index |= c << 2 * i;
    }
    if (!right) {
        err_set(
            "'%.16s' does not choose components of a field of %d; 1, 3 or 4 letters of \"%.*s\" "
            "are accepted",
            components, a->components, a->components, "xyzw");
        return NULL;
    }
    if (kind_of(a) == KIND_SWIZZLE) { // of a swizzle: one does it
        int inner = 0;
        for (size_t i = 0; i < count; i++)
            inner |= (a->index >> 2 * (index >> 2 * i & 3) & 3) << 2 * i;
        index = inner;
        a = a->args[0];
    }
    field *node = new_node(memory, KIND_SWIZZLE, (int)count);
    node->index = index;
    node->args[0] = a;
    return finish(node);
}
