// What stands around the volume: mesh { "file" }, orbit { } and camera { }, sun { }, sky { }. Every
// number may move. What is not given keeps the scene's default.
#include "base/memory.h"
#include "script/binding.h"
#include <stddef.h>
#include <string.h>

typedef struct slot { // a key and the field that it sets
    const char *key;
    int components;
    size_t offset;
} slot;

#define CAMERA(KEY, COMPONENTS)                                                                    \
    { #KEY, COMPONENTS, offsetof(scene_camera, KEY) }
#define SUN(KEY, COMPONENTS)                                                                       \
    { #KEY, COMPONENTS, offsetof(scene_sun, KEY) }
#define SKY(KEY, COMPONENTS)                                                                       \
    { #KEY, COMPONENTS, offsetof(scene_sky, KEY) }
#define MESH(KEY, COMPONENTS)                                                                      \
    { #KEY, COMPONENTS, offsetof(scene_mesh, KEY) }

// Sets what the table at 1 holds in the structure at `out`.
static void read_slots(lua_State *L, const char *who, const slot *slots, size_t count, void *out) {
    const char *keys[16];
    script_require_loading(L, who);
    for (size_t i = 0; i < count; i++) keys[i] = slots[i].key;
    value_check_keys(L, 1, who, keys, count);
    for (size_t i = 0; i < count; i++) {
        const field *node = value_get_uniform(L, 1, who, slots[i].key, slots[i].components, NULL);
        if (node) memcpy((char *)out + slots[i].offset, &node, sizeof node);
    }
}

static void refuse_array(lua_State *L, const char *who) {
    if (value_is_plain_table(L, 1) && lua_rawlen(L, 1) > 0)
        vm_error(L, "%s takes only named values, as in %s { fov = 40 }", who, who);
}

static int l_orbit(lua_State *L) {
    static const slot slots[] = {CAMERA(target, 3), CAMERA(distance, 1), CAMERA(yaw, 1),
                                 CAMERA(pitch, 1),  CAMERA(fov, 1),      CAMERA(near, 1),
                                 CAMERA(far, 1)};
    refuse_array(L, "orbit");
    camera_object *object = object_new(L, "camera", sizeof *object);
    read_slots(L, "orbit", slots, COUNT_OF(slots), &object->camera);
    return 1;
}

static int l_camera(lua_State *L) {
    static const slot slots[] = {CAMERA(eye, 3), CAMERA(target, 3), CAMERA(fov, 1), CAMERA(near, 1),
                                 CAMERA(far, 1)};
    refuse_array(L, "camera");
    camera_object *object = object_new(L, "camera", sizeof *object);
    read_slots(L, "camera", slots, COUNT_OF(slots), &object->camera);
    if (!object->camera.eye)
        vm_error(L, "camera: 'eye' is missing: where it stands, {x, y, z} in metres; orbit { } "
                    "circles a target instead");
    return 1;
}

static int l_sun(lua_State *L) {
    static const slot slots[] = {SUN(azimuth, 1), SUN(elevation, 1), SUN(color, 3),
                                 SUN(strength, 1)};
    refuse_array(L, "sun");
    sun_object *object = object_new(L, "sun", sizeof *object);
    read_slots(L, "sun", slots, COUNT_OF(slots), &object->sun);
    return 1;
}

static int l_sky(lua_State *L) {
    static const slot slots[] = {SKY(zenith, 3), SKY(horizon, 3), SKY(strength, 1)};
    refuse_array(L, "sky");
    sky_object *object = object_new(L, "sky", sizeof *object);
    read_slots(L, "sky", slots, COUNT_OF(slots), &object->sky);
    return 1;
}

static int l_mesh(lua_State *L) {
    static const slot slots[] = {MESH(position, 3), MESH(rotation, 3), MESH(scale, 1),
                                 MESH(color, 3)};
    scene_mesh values = {0};
    read_slots(L, "mesh", slots, COUNT_OF(slots), &values);
    if (lua_rawlen(L, 1) != 1 || lua_rawgeti(L, 1, 1) != LUA_TSTRING)
        vm_error(L, "mesh: its file comes first, as in mesh { \"data/ground.obj\" }");
    size_t length;
    const char *file = lua_tolstring(L, -1, &length);
    if (strlen(file) != length) vm_error(L, "mesh: the file name contains a zero byte");
    mesh_object *object = object_new(L, "mesh", sizeof *object);
    scene_mesh *mesh = effect_add_mesh(script_of(L)->effect, file);
    if (!mesh) script_raise(L);
    vm_charge_memory(L, (size_t)mesh->data.vertex_count * sizeof(mesh_vertex) +
                            (size_t)mesh->data.index_count * sizeof(uint32_t));
    if (values.position) mesh->position = values.position;
    if (values.rotation) mesh->rotation = values.rotation;
    if (values.scale) mesh->scale = values.scale;
    if (values.color) mesh->color = values.color;
    object->mesh = mesh;
    return 1;
}

void l_scene_open(lua_State *L) {
    static const char *const types[] = {"camera", "sun", "sky", "mesh"};
    static const luaL_Reg none[] = {{NULL, NULL}};
    for (size_t i = 0; i < COUNT_OF(types); i++) object_type(L, types[i], none);
    lua_register(L, "orbit", l_orbit);
    lua_register(L, "camera", l_camera);
    lua_register(L, "sun", l_sun);
    lua_register(L, "sky", l_sky);
    lua_register(L, "mesh", l_mesh);
}
