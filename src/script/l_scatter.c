// scatter { count = 500, size = {120, 120}, distance = 2.2 }: a list of places for instances.
#include "scene/instances.h"
#include "scene/scatter.h"
#include "script/binding.h"
#include <math.h>
#include <string.h>

static const char who[] = "scatter";

typedef struct chooser { // of places that have room
    lua_State *L;
    field_context context;
    const field *inside, *density, *height; // NULL: not given
} chooser;

enum { DART_COST = 20, FIELD_COST = 50, NODE_COST = 10 }; // in instructions of the script

static bool value_at(const chooser *c, const field *node, const float place[3], float *out) {
    float value[4];
    vm_charge(c->L, FIELD_COST + (uint64_t)NODE_COST * node->size);
    if (!field_eval(node, &c->context, (float3){place[0], place[1], place[2]}, value)) return false;
    *out = value[0];
    return true;
}

static bool scatter_accept(void *user, float place[3], float chance, bool *stays) {
    const chooser *c = user;
    float inside = 1, density = 1, height = 0;
    if (c->height && !value_at(c, c->height, place, &height)) return false;
    place[2] += height;
    if ((c->inside && !value_at(c, c->inside, place, &inside)) ||
        (c->density && !value_at(c, c->density, place, &density)))
        return false;
    *stays = inside > 0 && chance < density && isfinite(place[2]);
    return true;
}

static const field *get_field(lua_State *L, const char *key) {
    const field *node = NULL;
    if (value_get(L, 1, key) != LUA_TNIL) node = value_field(L, -1, who, key, 1);
    lua_pop(L, 1);
    return node;
}

static void read_size(lua_State *L, scatter_desc *desc) {
    if (value_get(L, 1, "size") == LUA_TNIL)
        vm_error(L, "scatter: 'size' is missing: the sides of what is filled, as in {120, 120} m");
    float size[4];
    int count = value_numbers(L, -1, size);
    if (count == 1) size[1] = size[0];
    for (int a = 0; a < 2; a++)
        if (count > 2 || count < 1 || !(size[a] > 0 && size[a] <= 1e6f))
            vm_error(L, "scatter: 'size' takes one or two lengths above 0, up to 1e6 m");
    desc->size[0] = size[0];
    desc->size[1] = size[1];
    lua_pop(L, 1);
}

static void read_desc(lua_State *L, scatter_desc *desc) {
    read_size(L, desc);
    value_get_vector(L, 1, who, "position", desc->middle);
    double distance = value_get_number(L, 1, who, "distance", 0);
    if (!(distance >= 0 && distance <= 1e6))
        vm_error(L, "scatter: 'distance' is %g; 0 to 1e6 m is accepted", distance);
    desc->distance = (float)distance;
    desc->seed = value_get_count(L, 1, who, "seed", 1);
    uint32_t count = value_get_count(L, 1, who, "count", distance > 0 ? SCENE_INSTANCES_MAX : 0);
    if (count < 1 || count > SCENE_INSTANCES_MAX)
        vm_error(L,
                 "scatter: 'count' is %d; 1 to %d are accepted, and none for as many as have room "
                 "where a 'distance' above 0 is given",
                 (int)count, SCENE_INSTANCES_MAX);
    desc->count = count;
}

static void push_places(lua_State *L, float (*places)[3], size_t count) {
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        lua_createtable(L, 3, 0);
        for (int a = 0; a < 3; a++) {
            lua_pushnumber(L, (lua_Number)places[i][a]);
            lua_rawseti(L, -2, a + 1);
        }
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

int l_scatter(lua_State *L) {
    scatter_desc desc = {0};
    size_t found;
    value_check_object(L, 1, who);
    read_desc(L, &desc);
    chooser c = {.L = L,
                 .context = script_context(L),
                 .inside = get_field(L, "inside"),
                 .density = get_field(L, "density"),
                 .height = get_field(L, "height")};
    vm_charge(L, desc.count * (uint64_t)DART_COST);
    desc.accept = c.inside || c.density || c.height ? scatter_accept : NULL;
    desc.user = &c;
    size_t cells = scatter_cells(&desc) * sizeof *desc.cells;
    desc.cells = memset(lua_newuserdatauv(L, cells, 0), 0, cells); // an error may end it all
    float(*places)[3] = lua_newuserdatauv(L, desc.count * sizeof *places, 0);
    if (!scatter_places(&desc, places, &found)) script_raise(L);
    if (found == 0)
        vm_error(L, "scatter: no place was found: is 'inside' above 0 anywhere within 'size'?");
    push_places(L, places, found);
    return 1;
}
