// The scene around the volume: mesh { "file" }, orbit { } and camera { }, sun { }, sky { }. Every
// number may change over time. Keys that are not given keep the scene's default.
#include "base/file.h"
#include "script/binding.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

void value_read_slots(lua_State *L, const char *who, void *out) {
    script_require_loading(L, who);
    const script_object *object = value_check_object(L, 1, who);
    for (const scene_value *v = NULL; (v = script_object_value(object, v));) {
        const value_desc *desc = &v->desc;
        const field *node = value_get_uniform(L, 1, who, desc->name, desc->components, NULL);
        if (!node) continue;
        int wrong = field_is_constant(node) // what moves is limited instead
                        ? value_find_wrong(desc, node->value, node->components)
                        : -1;
        if (wrong >= 0) {
            value_refuse(desc, node->value[wrong], "%s: '%s'", who, desc->name);
            script_raise(L);
        }
        *scene_slot(out, v) = node;
        script_note_place(L, node, who);
    }
}

void value_refuse_array(lua_State *L, const char *who) {
    if (value_is_plain_table(L, 1) && lua_rawlen(L, 1) > 0)
        vm_error(L, "%s takes only named values, as in %s { %s = ... }", who, who,
                 script_object_key(script_object_find(who), 0)->name);
}

int l_orbit(lua_State *L) {
    value_refuse_array(L, "orbit");
    camera_object *object = object_new(L, "camera", sizeof *object);
    value_read_slots(L, "orbit", &object->camera);
    return 1;
}

int l_camera(lua_State *L) {
    value_refuse_array(L, "camera");
    camera_object *object = object_new(L, "camera", sizeof *object);
    value_read_slots(L, "camera", &object->camera);
    if (!object->camera.eye)
        vm_error(L, "camera: 'eye' is missing: where it stands, {x, y, z} in metres; orbit { } "
                    "circles a target instead");
    return 1;
}

int l_sun(lua_State *L) {
    value_refuse_array(L, "sun");
    sun_object *object = object_new(L, "sun", sizeof *object);
    value_read_slots(L, "sun", &object->sun);
    return 1;
}

int l_sky(lua_State *L) {
    value_refuse_array(L, "sky");
    sky_object *object = object_new(L, "sky", sizeof *object);
    scene_sky *sky = &object->sky;
    value_read_slots(L, "sky", sky);
    const char *image = value_get_string(L, 1, "sky", "image");
    if (!image) return 1;
    if (sky->zenith || sky->horizon)
        vm_error(L, "sky: 'image' is given, and '%s' too; an image stands for both colours",
                 sky->zenith ? "zenith" : "horizon");
    sky->image = effect_add_sky_image(script_of(L)->effect, image);
    if (!sky->image) script_raise(L);
    if (!sky->strength) {
        vm_charge_memory(L, sizeof(field));
        sky->strength = field_constant(script_memory(L), 1, (float[4]){1});
    }
    return 1;
}

enum { MOST_NODES = 64 };    // one in the other
enum { PLACE_CONTROLS = 4 }; // of a mesh or a node

typedef struct node_object {
    const scene_node *node;
} node_object;

const scene_node *value_get_node(lua_State *L, int table, const char *who, const char *key) {
    const scene_node *node = NULL;
    if (value_get(L, table, key) != LUA_TNIL) {
        const node_object *object = object_test(L, -1, "node");
        if (!object) vm_error(L, "%s: '%s' takes node { }; got %s", who, key, object_kind(L, -1));
        node = object->node;
    }
    lua_pop(L, 1);
    return node;
}

// node { position = {0, 0, 2}, parent = ... }: a transform for meshes and instances.
int l_node(lua_State *L) {
    value_refuse_array(L, "node");
    node_object *object = object_new(L, "node", sizeof *object);
    vm_charge_memory(L,
                     sizeof(scene_node) + 3 * sizeof(field) + PLACE_CONTROLS * EFFECT_CONTROL_COST);
    arena *memory = script_memory(L);
    scene_node *node = arena_alloc(memory, sizeof *node);
    *node = (scene_node){.name = value_name_or_variable(L, 1, "node"),
                         .parent = value_get_node(L, 1, "node", "parent")};
    int depth = 1;
    for (const scene_node *n = node->parent; n; n = n->parent) depth++;
    if (depth > MOST_NODES)
        vm_error(L, "node: %d stand in each other; at most %d are possible", depth, MOST_NODES);
    value_read_slots(L, "node", node);
    scene_set_defaults(scene_node_values, SCENE_ALL, node, memory);
    script_note_place(L, node, "node");
    effect_add_node(script_of(L)->effect, node);
    object->node = node;
    return 1;
}

// What a mesh's numbers are set by: its variable, else its file: "data/pine-2.obj" is "pine_2".
static const char *name_mesh(lua_State *L, const char *file, bool table) {
    char name[64];
    if (table && value_variable(L, "mesh", name, sizeof name))
        return arena_string(script_memory(L), name);
    const char *stem = path_name(file);
    snprintf(name, sizeof name, "%s%.*s", isdigit((unsigned char)stem[0]) ? "mesh_" : "",
             (int)strcspn(stem, "."), stem);
    for (char *at = name; *at; at++)
        if (!isalnum((unsigned char)*at)) *at = '_';
    return name[0] ? arena_string(script_memory(L), name) : "mesh";
}

// mesh { "data/ground.obj", ... }, or mesh "data/ground.obj".
int l_mesh(lua_State *L) {
    scene_mesh values = {0};
    bool table = lua_type(L, 1) != LUA_TSTRING;
    if (!table) {
        lua_createtable(L, 1, 0);
        lua_insert(L, 1);
        lua_rawseti(L, 1, 1);
    }
    value_read_slots(L, "mesh", &values);
    if (lua_rawlen(L, 1) != 1 || lua_rawgeti(L, 1, 1) != LUA_TSTRING)
        vm_error(L, "mesh: its file comes first, as in mesh { \"data/ground.obj\" }");
    size_t length;
    const char *file = lua_tolstring(L, -1, &length);
    if (strlen(file) != length) vm_error(L, "mesh: the file name contains a zero byte");
    mesh_object *object = object_new(L, "mesh", sizeof *object);
    scene_mesh *mesh = effect_add_mesh(script_of(L)->effect, file);
    if (!mesh) script_raise(L);
    vm_charge_memory(L, (size_t)mesh->data.vertex_count * sizeof(mesh_vertex) +
                            (size_t)mesh->data.index_count * sizeof(uint32_t) +
                            PLACE_CONTROLS * EFFECT_CONTROL_COST);
    if (values.position) mesh->position = values.position;
    if (values.rotation) mesh->rotation = values.rotation;
    if (values.scale) mesh->scale = values.scale;
    if (values.color) mesh->color = values.color;
    value_read_material(L, "mesh", mesh);
    mesh->parent = value_get_node(L, 1, "mesh", "parent");
    object->placed =
        values.position || values.rotation || values.scale || values.color || mesh->parent;
    object->at = values.position;
    object->mesh = mesh;
    mesh->called = name_mesh(L, file, table);
    script_note_place(L, mesh, "mesh");
    return 1;
}
