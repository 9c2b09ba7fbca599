// Controls that are fields in a slot: uniforms of passes, values of the scene, lights, materials;
// and numbers that fields in space were given.
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <string.h>

const field *effect_control_field(const effect *e, const effect_control *c) {
    const control *own = (const control *)c;
    if (own->nodes[0] && !own->slot) return own->nodes[0];
    if (!own->slot || *own->slot || c->kind != EFFECT_CONTROL_UNIFORM)
        return own->slot ? *own->slot : NULL;
    const value_desc *declared;
    return pass_inherited_uniform(e->passes[c->pass], c->index, &declared);
}

const field *effect_control_original(const effect_control *c) {
    return ((const control *)c)->original;
}

const float *effect_control_default(const effect *e, const effect_control *c) {
    const value_desc *declared = c->desc;
    if (c->kind == EFFECT_CONTROL_UNIFORM)
        pass_inherited_uniform(e->passes[c->pass], c->index, &declared);
    return declared->value;
}

// ---- numbers of fields --------------------------------------------------------------------------

bool effect_has_room_for_field(const effect *e) {
    return e->field_count < EFFECT_MAX_FIELDS;
}

bool effect_has_tiles(const effect *e) {
    return e->tiled;
}

static bool is_taken(effect *e, const char *name) {
    for (size_t i = 0; i < e->control_count; i++) {
        const effect_control *c = &e->controls[i]->face;
        if (strcmp(c->name, name) == 0) return true;
        if (c->kind >= EFFECT_CONTROL_SCENE && strcmp(c->group, name) == 0) return true;
    }
    for (size_t i = 0; i < e->layers_count; i++)
        if (strcmp(e->layers[i]->name, name) == 0) return true;
    return false;
}

// Names a group of controls after what it belongs to, with a number where that is taken.
static const char *free_group(effect *e, const char *name) {
    const char *group = arena_string(&e->memory, name);
    for (int i = 2; is_taken(e, group); i++) group = arena_format(&e->memory, "%s_%d", name, i);
    return group;
}

// A constant in the place of numbers, of which settings change the value.
static control control_of_constant(effect *e, effect_control_kind kind, field *value) {
    return (control){
        .face.kind = kind,
        .nodes = {value},
        .original = field_constant(&e->memory, value->components, value->value),
    };
}

bool effect_add_field(effect *e, const char *name, const field *node, field *const *values) {
    const field_kind *kind = node->kind;
    if (!effect_has_room_for_field(e)) return true;
    e->field_count++;
    const char *group = free_group(e, name);
    effect_add_shape(e, group, node);
    for (size_t i = 0; i < FIELD_MAX_ARGS && kind->args[i].desc.name; i++) {
        if (!values[i]) continue;
        value_desc *desc = arena_copy(&e->memory, &kind->args[i].desc, sizeof *desc);
        desc->components = values[i]->components;
        control *c = effect_add_member(e, group, desc,
                                       control_of_constant(e, EFFECT_CONTROL_FIELD, values[i]));
        if (!effect_apply_to(e, c)) return false;
    }
    return true;
}

// ---- layers -------------------------------------------------------------------------------------

static bool add_number(effect *e, const char *group, const value_desc *desc, field *value,
                       size_t layer) {
    control own = control_of_constant(e, EFFECT_CONTROL_FIELD, value);
    own.face.layer = layer;
    return effect_apply_to(e, effect_add_member(e, group, desc, own));
}

// The scale (`part` 0) or the strength of a layer, from 1.
static const value_desc *describe_layer(effect *e, size_t layer, size_t part) {
    static const value_desc parts[] = {
        {.name = "scale",
         .components = 1,
         .min = 1e-6f,
         .max = 1e6f,
         .unit = "",
         .help = "lumps of this layer in a metre; of a shell across its radius"},
        {.name = "strength",
         .components = 1,
         .min = -1e6f,
         .max = 1e6f,
         .unit = "",
         .help = "what this layer counts for beside the others"},
    };
    value_desc *desc = arena_copy(&e->memory, &parts[part], sizeof *desc);
    desc->name = arena_format(&e->memory, "%s_%zu", parts[part].name, layer);
    return desc;
}

const effect_layers *effect_add_layers(effect *e, const char *name, field *const (*values)[2],
                                       size_t count, const value_desc *const *shared,
                                       field *const *shared_values, size_t shared_count) {
    effect_layers *l = arena_alloc(&e->memory, sizeof *l);
    *l = (effect_layers){free_group(e, name), count};
    *MEM_ADD(e->layers, e->layers_count, e->layers_capacity) = l;
    e->field_count++;
    for (size_t i = 0; i < 2 * count; i++) {
        field *value = values[i / 2][i % 2];
        const value_desc *desc = value ? describe_layer(e, i / 2 + 1, i % 2) : NULL;
        if (value && !add_number(e, l->name, desc, value, i / 2 + 1)) return NULL;
    }
    for (size_t i = 0; i < shared_count; i++)
        if (!add_number(e, l->name, shared[i], shared_values[i], 0)) return NULL;
    return l;
}

size_t effect_layers_count(const effect *e) {
    return e->layers_count;
}

const effect_layers *effect_get_layers(const effect *e, size_t index) {
    return e->layers[index];
}

// ---- numbers that are read while the file loads -------------------------------------------------

bool effect_add_loaded(effect *e, const char *group, const value_desc *desc, const void *made,
                       float *value) {
    field *node = field_constant(&e->memory, desc->components, value);
    control own = control_of_constant(e, EFFECT_CONTROL_LOADED, node);
    own.owner = made;
    if (!effect_apply_to(e, effect_add_member(e, arena_string(&e->memory, group), desc, own)))
        return false;
    memcpy(value, node->value, (size_t)desc->components * sizeof *value);
    return true;
}

// ---- setting and saying -------------------------------------------------------------------------

void field_control_put(effect *e, control *c, const float value[4]) {
    const value_desc *desc = c->face.desc;
    const size_t size = sizeof c->numbers;
    if (!c->slot) { // programs and the host read it in each frame, or when it is loaded
        memcpy(c->nodes[0]->value, value, size);
        return;
    }
    field **node = &c->nodes[!c->turn];
    if (!*node) *node = field_constant(&e->memory, 4, value);
    (*node)->components = desc->components == 2 ? 3 : desc->components; // of a field: 1, 3 or 4
    memcpy((*node)->value, value, size);
    *c->slot = *node;
    c->turn = !c->turn;
}

bool field_control_set(effect *e, control *c, const char *text) {
    float value[4];
    if (!value_parse(c->face.desc, c->face.name, text, value)) return false;
    field_control_put(e, c, value);
    return true;
}

static void print_field(const value_desc *desc, const field *node, strbuf *out) {
    float value[4];
    for (int i = 0; i < 4; i++) value[i] = node->value[node->components == 1 ? 0 : i];
    if (field_is_constant(node))
        value_print(desc, value, out);
    else
        field_print(node, out);
}

// Where the eye of an orbit stands follows from these.
static void print_orbit(const scene_camera *camera, strbuf *out) {
    static const value_desc number = {.components = 1};
    const field *const parts[] = {camera->distance, camera->yaw, camera->pitch};
    strbuf_add(out, "orbit");
    for (size_t i = 0; i < COUNT_OF(parts); i++) {
        strbuf_add(out, " ");
        print_field(&number, parts[i], out);
    }
}

void field_control_print(const effect *e, const control *c, strbuf *out) {
    const field *node = effect_control_field(e, &c->face);
    if (node)
        print_field(c->face.desc, node, out);
    else if (c->slot == &e->scene.camera.eye)
        print_orbit(&e->scene.camera, out);
    else
        value_print(c->face.desc, effect_control_default(e, &c->face), out);
}
