// Reads values of a single instance from a script.
#include "script/instances.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const instance_key_names[INSTANCE_KEYS] = {"position", "rotation", "yaw",  "scale",
                                                       "kind",     "color",    "glow", "state"};

enum { FARTHEST = 1000000 }; // metres from the origin, as of most numbers here

// Returns a number, a text or a list of numbers as it is written, else the type of the value.
static const char *shown(lua_State *L, int index) {
    if (lua_isnumber(L, index)) {
        char text[32];
        lua_Number number = lua_tonumber(L, index);
        snprintf(text, sizeof text, "%.9g", isnan(number) ? fabs(number) : number);
        return lua_pushstring(L, text);
    }
    if (lua_isstring(L, index)) return lua_pushfstring(L, "string '%s'", lua_tostring(L, index));
    size_t count = lua_istable(L, index) ? lua_rawlen(L, index) : 0;
    if (count < 1 || count > 8) return object_kind(L, index);
    const char *list = "";
    for (size_t i = 1; i <= count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i);
        bool nested = lua_istable(L, -1);
        list = lua_pushfstring(L, i == 1 ? "%s%s" : "%s, %s", list,
                               nested ? "{...}" : shown(L, lua_gettop(L)));
    }
    return lua_pushfstring(L, "{%s}", list);
}

static _Noreturn void refuse_value(lua_State *L, int index, const char *who, instance_key key,
                                   const char *accepted) {
    luaL_checkstack(L, 2 * LUA_MINSTACK, NULL);
    index = lua_absindex(L, index);
    vm_error(L, "%s: '%s' of an instance is %s; got %s", who, instance_key_names[key], accepted,
             shown(L, index));
}

static int read_numbers(lua_State *L, int index, const char *who, instance_key key, int least,
                        int most, const char *accepted, float out[4]) {
    int count = value_numbers(L, index, out);
    bool fine = count >= least && count <= most;
    for (int i = 0; i < count; i++) fine = fine && fabsf(out[i]) <= (float)FARTHEST;
    if (!fine) refuse_value(L, index, who, key, accepted);
    return count;
}

float instance_yaw(const struct instance_entry *entry) {
    return 2 * atan2f(entry->turn.v[2], entry->turn.v[3]) * 57.29577951f;
}

// A rotation is a yaw followed by a tilt; the yaw is its part about +Z.
void instance_set_yaw(struct instance_entry *entry, float degrees) {
    versor turn, yaw, lean;
    memcpy(turn, entry->turn.v, sizeof entry->turn.v);
    glm_quatv(yaw, glm_rad(-instance_yaw(entry)), (vec3){0, 0, 1});
    glm_quat_mul(turn, yaw, lean);
    glm_quatv(yaw, glm_rad(degrees), (vec3){0, 0, 1});
    glm_quat_mul(lean, yaw, turn);
    glm_quat_normalize(turn);
    memcpy(entry->turn.v, turn, sizeof entry->turn.v);
}

static void set_rotation(struct instance_entry *entry, const float degrees[3]) {
    mat4 turn;
    versor q;
    glm_euler_zyx((vec3){glm_rad(degrees[0]), glm_rad(degrees[1]), glm_rad(degrees[2])}, turn);
    glm_mat4_quat(turn, q);
    memcpy(entry->turn.v, q, sizeof entry->turn.v);
}

static void read_kind(lua_State *L, int index, const char *who, size_t kinds,
                      struct instance_entry *out) {
    index = lua_absindex(L, index);
    lua_Number kind = lua_type(L, index) == LUA_TNUMBER ? lua_tonumber(L, index) : -1;
    if (!(kind >= 0 && kind <= (lua_Number)kinds && kind == floor(kind)))
        refuse_value(L, index, who, INSTANCE_KIND,
                     lua_pushfstring(L, "a whole number from 1 to %d, by its meshes; 0: not shown",
                                     (int)kinds));
    out->kind.v[0] = kind > 0 ? (uint32_t)kind - 1 : INSTANCE_HIDDEN;
}

static void read_color(lua_State *L, int index, const char *who, struct instance_entry *out) {
    float value[4];
    int count = value_numbers(L, index, value);
    for (int i = 0; i < count; i++) count = value[i] >= 0 && value[i] <= 1e4f ? count : 0;
    if (count == 1) value[1] = value[2] = value[0];
    if (count != 1 && count != 3)
        refuse_value(L, index, who, INSTANCE_COLOR,
                     "\"#rrggbb\" or {r, g, b} of numbers from 0 to 1e4");
    memcpy(out->color.v, value, 3 * sizeof *value);
}

void instance_read(lua_State *L, int index, const char *who, instance_key key, size_t kinds,
                   struct instance_entry *out) {
    float v[4];
    int count;
    switch (key) {
    case INSTANCE_POSITION:
        read_numbers(L, index, who, key, 2, 3, "{x, y, z} in metres, up to 1e6", v);
        memcpy(out->place.v, v, 3 * sizeof *v); // of two numbers the third is 0
        break;
    case INSTANCE_ROTATION:
        read_numbers(L, index, who, key, 3, 3, "{x, y, z} in degrees", v);
        set_rotation(out, v);
        break;
    case INSTANCE_YAW:
        read_numbers(L, index, who, key, 1, 1, "a number of degrees", v);
        instance_set_yaw(out, v[0]);
        break;
    case INSTANCE_SCALE:
        read_numbers(L, index, who, key, 1, 1, "a number, up to 1e6", v);
        out->place.v[3] = v[0];
        break;
    case INSTANCE_KIND:
        read_kind(L, index, who, kinds, out);
        break;
    case INSTANCE_COLOR:
        read_color(L, index, who, out);
        break;
    case INSTANCE_GLOW:
        read_numbers(L, index, who, key, 1, 1, "a number from 0 on, up to 1e6", v);
        if (v[0] < 0) refuse_value(L, index, who, key, "a number from 0 on, up to 1e6");
        out->color.v[3] = v[0];
        break;
    case INSTANCE_STATE:
        count = read_numbers(L, index, who, key, 1, 4, "a number, or up to four, up to 1e6", v);
        memcpy(out->state.v, v, (size_t)count * sizeof *v); // the others stay
        break;
    case INSTANCE_KEYS:
        break;
    }
}

bool instance_is_list(lua_State *L, int index, instance_key key) {
    if (!value_is_plain_table(L, index)) return false;
    bool of_numbers = key == INSTANCE_YAW || key == INSTANCE_SCALE || key == INSTANCE_KIND ||
                      key == INSTANCE_GLOW;
    lua_rawgeti(L, index, 1);
    bool number = lua_type(L, -1) == LUA_TNUMBER;
    lua_pop(L, 1);
    return of_numbers || !number;
}
