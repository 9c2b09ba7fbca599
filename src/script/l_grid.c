// Volumes: vdb { "data/x/*.vdb" } and raw { "data/x.raw", ... } give a sequence, whose grids are
// fields by name (burst.density). bake(field, { size = 128 }) computes a field once and keeps it in
// a grid; tile(noise, { resolution = 64 }) does so for noise, which then fills all of space.
#include "base/file.h"
#include "base/memory.h"
#include "field/sequence.h"
#include "script/binding.h"
#include <math.h>
#include <string.h>

enum { SEQUENCE_COST = 64 << 10 }; // bytes of host memory charged for one
enum { TILE_RESOLUTION = 64, TILE_CELLS = 8 };

typedef struct sequence_object {
    sequence *sequence;
} sequence_object;

// ---- sequences --------------------------------------------------------------------------------

// Sets the pattern of the files, and the folder that they are in.
static void read_pattern(lua_State *L, const char *who, sequence_desc *desc) {
    if (lua_rawlen(L, 1) != 1 || lua_rawgeti(L, 1, 1) != LUA_TSTRING)
        vm_error(L, "%s: its files come first, as in %s { \"data/name.%s\" }", who, who, who);
    char path[PATH_CAP];
    size_t length;
    const char *name = lua_tolstring(L, -1, &length);
    if (strlen(name) != length) vm_error(L, "%s: the file name contains a zero byte", who);
    desc->root = effect_find_file(script_of(L)->effect, name, path);
    if (!desc->root) script_raise(L);
    vm_charge_memory(L, SEQUENCE_COST);
    lua_pop(L, 1);
    desc->pattern = arena_string(script_memory(L), path);
}

// Reads a number that must not be zero, which a sequence_desc takes for its default.
static double read_factor(lua_State *L, const char *who, const char *key, double missing) {
    double value = value_get_number(L, 1, who, key, missing);
    if (value == 0) vm_error(L, "%s: '%s' is 0; any other number is accepted", who, key);
    return value;
}

// Reads a number, or with `moves` anything that does not vary in space.
static const field *read_moving(lua_State *L, const char *who, const char *key, float missing,
                                bool *moves) {
    const float values[4] = {missing};
    int type = value_get(L, 1, key);
    *moves = *moves || (type != LUA_TNIL && type != LUA_TNUMBER);
    const field *made = type == LUA_TNIL ? field_constant(script_memory(L), 1, values)
                                         : value_uniform(L, lua_gettop(L), who, key, 1);
    lua_pop(L, 1);
    return made;
}

typedef struct played {
    const char *name;           // of the sequence
    const field *speed, *start; // NULL: neither moves
} played;

static void read_speed(lua_State *L, const char *who, sequence_desc *desc, played *out) {
    bool moves = false;
    vm_charge_memory(L, 2 * sizeof(field));
    out->speed = read_moving(L, who, "speed", 1, &moves);
    out->start = read_moving(L, who, "start", 0, &moves);
    if (moves) return;
    desc->start = value_get_number(L, 1, who, "start", 0);
    desc->speed = read_factor(L, who, "speed", 1);
    out->speed = out->start = NULL;
}

static played read_playback(lua_State *L, const script_object *row, sequence_desc *desc) {
    const char *who = row->name;
    read_pattern(L, who, desc);
    desc->contents = effect_content_cache(script_of(L)->effect);
    desc->fps = read_factor(L, who, "fps", 24);
    desc->loop = (sequence_loop)value_get_choice(L, 1, row, "loop");
    desc->blend = value_get_bool(L, 1, who, "blend", false);
    desc->y_up = value_get_bool(L, 1, who, "y_up", false);
    desc->up_by_creator = value_get(L, 1, "y_up") == LUA_TNIL;
    lua_pop(L, 1);
    desc->scale = (float)read_factor(L, who, "scale", 1);
    played out = {.name = value_name_or_variable(L, 1, who)};
    value_get_place(L, 1, who, "offset", out.name, &desc->offset);
    read_speed(L, who, desc, &out);
    return out;
}

static int push_sequence(lua_State *L, const sequence_desc *desc, const played *how) {
    sequence_object *object = object_new(L, "sequence", sizeof *object);
    effect *e = script_of(L)->effect;
    object->sequence = sequence_create(script_memory(L), desc);
    if (!object->sequence) script_raise(L);
    effect_add_grid(e, sequence_grid(object->sequence));
    effect_name_grid(e, sequence_grid(object->sequence), how->name);
    if (how->speed) effect_add_clock(e, sequence_grid(object->sequence), how->speed, how->start);
    const char *const *files;
    size_t count = sequence_files(object->sequence, &files);
    for (size_t i = 0; i < count; i++) effect_add_file(e, files[i]);
    return 1;
}

static int l_vdb(lua_State *L) {
    script_require_loading(L, "vdb");
    sequence_desc desc = {0};
    const script_object *row = value_check_object(L, 1, "vdb");
    const played how = read_playback(L, row, &desc);
    desc.storage = (sequence_storage)value_get_choice(L, 1, row, "storage");
    desc.level_set = (vdb_set)value_get_choice(L, 1, row, "level_set");
    if (effect_draws(script_of(L)->effect)) vdb_warm_up();
    return push_sequence(L, &desc, &how);
}

static uint64_t bytes_of(lua_State *L, const char *key) {
    double value = value_get_number(L, 1, "raw", key, 0);
    if (!(value >= 0 && value <= 0x1p53 && value == floor(value)))
        vm_error(L, "raw: '%s' is %g; a whole number of bytes is accepted", key, value);
    return (uint64_t)value;
}

static int l_raw(lua_State *L) {
    script_require_loading(L, "raw");
    const script_object *row = value_check_object(L, 1, "raw");
    sequence_desc desc = {0};
    const played how = read_playback(L, row, &desc);
    float size[3] = {0};
    if (!value_get_vector(L, 1, "raw", "size", size))
        vm_error(L, "raw: 'size' is missing: the voxels of a frame, as in {32, 32, 32}");
    for (int i = 0; i < 3; i++) {
        if (!(size[i] >= 1 && size[i] <= 4096 && size[i] == floorf(size[i])))
            vm_error(L, "raw: 'size' has %g; whole numbers from 1 to 4096 are accepted",
                     (double)size[i]);
        desc.raw.size[i] = (uint32_t)size[i];
    }
    desc.raw.type = script_key_find(row->keys, "type")->words[value_get_choice(L, 1, row, "type")];
    desc.raw.frames = value_get_count(L, 1, "raw", "frames", 0);
    desc.raw.offset = bytes_of(L, "skip");
    desc.raw.stride = bytes_of(L, "stride");
    desc.raw.voxel_size = (float)value_get_number(L, 1, "raw", "voxel_size", 0);
    desc.raw.axes = value_get_string(L, 1, "raw", "axes");
    if (value_get_box(L, 1, "raw", &desc.raw.box) && desc.raw.voxel_size != 0)
        vm_error(L, "raw: 'box' and 'voxel_size' both say how large a voxel is; one is accepted");
    desc.raw.padding = value_get_count(L, 1, "raw", "padding", 0);
    desc.raw.value_scale = (float)read_factor(L, "raw", "value_scale", 1);
    desc.raw.channel = value_get_string(L, 1, "raw", "channel");
    return push_sequence(L, &desc, &how);
}

// ---- what a grid has --------------------------------------------------------------------------

void grid_add(lua_State *L, field_grid *grid, const char *name) {
    effect *e = script_of(L)->effect;
    if (!grid) script_raise(L);
    effect_add_grid(e, grid);
    effect_name_grid(e, grid, name);
}

void grid_push_field(lua_State *L, field_grid *grid, const char *name) {
    int components, channel = grid->find_field(grid, name, &components);
    if (channel < 0) script_raise(L);
    const field *node = field_grid_channel(script_memory(L), grid, channel, components);
    effect_note_reading(script_of(L)->effect, grid, name, node);
    field_push(L, node);
}

void value_push_box(lua_State *L, box3 box) {
    lua_createtable(L, 0, 2);
    value_put_numbers(L, "min", (const float[]){box.min.x, box.min.y, box.min.z}, 3);
    value_put_numbers(L, "max", (const float[]){box.max.x, box.max.y, box.max.z}, 3);
}

// burst.box, burst.frames, burst.duration; every other name is a grid.
static int l_sequence_index(lua_State *L) {
    const sequence_object *object = luaL_checkudata(L, 1, "sequence");
    const char *name = luaL_checkstring(L, 2);
    if (strcmp(name, "box") == 0) {
        value_push_box(L, sequence_grid(object->sequence)->box);
    } else if (strcmp(name, "frames") == 0) {
        lua_pushinteger(L, sequence_frame_count(object->sequence));
    } else if (strcmp(name, "duration") == 0) {
        lua_pushnumber(L, sequence_duration(object->sequence));
    } else {
        script_require_loading(L, "a grid of a sequence");
        grid_push_field(L, sequence_grid(object->sequence), name);
    }
    return 1;
}

// ---- bake and tile ----------------------------------------------------------------------------

static float3 corner(lua_State *L, const char *who, const char *key) {
    float v[3];
    if (!value_get_vector(L, -1, who, key, v))
        vm_error(L, "%s: 'box' must be { min = {x, y, z}, max = {x, y, z} }", who);
    return (float3){v[0], v[1], v[2]};
}

bool value_get_box(lua_State *L, int table, const char *who, box3 *out) {
    static const char *const corners[] = {"min", "max"};
    bool given = value_get(L, table, "box") != LUA_TNIL;
    if (given) {
        int box = lua_gettop(L);
        value_check_keys(L, box, lua_pushfstring(L, "%s: box", who), corners, COUNT_OF(corners));
        lua_pop(L, 1);
        *out = (box3){corner(L, who, "min"), corner(L, who, "max")};
    }
    lua_pop(L, 1);
    return given;
}

static box3 read_box(lua_State *L, const field *node) {
    box3 box;
    field_context context = script_context(L);
    if (!value_get_box(L, 2, "bake", &box) && !field_bounds_of_grids(node, &context, &box))
        script_raise(L);
    return box;
}

// Reads a field and a table, which may be missing.
static const field *read_arguments(lua_State *L, const char *who, const char *argument) {
    script_require_loading(L, who);
    lua_settop(L, 2);
    const field *node = value_field(L, 1, who, argument, 0);
    if (lua_isnil(L, 2)) {
        lua_newtable(L);
        lua_replace(L, 2);
    }
    value_check_object(L, 2, who);
    return node;
}

static uint32_t read_whole(lua_State *L, const char *who, const char *key, uint32_t otherwise,
                           uint32_t least, uint32_t most) {
    uint32_t value = value_get_count(L, 2, who, key, otherwise);
    if (value < least || value > most)
        vm_error(L, "%s: '%s' is %d; %d to %d are accepted", who, key, (int)value, (int)least,
                 (int)most);
    return value;
}

static void read_size(lua_State *L, uint32_t out[3]) {
    float size[3] = {64, 64, 64};
    value_get_vector(L, 2, "bake", "size", size);
    for (int i = 0; i < 3; i++) {
        if (!(size[i] >= 1 && size[i] <= 1024))
            vm_error(L, "bake: 'size' is %g; 1 to 1024 voxels are accepted", (double)size[i]);
        out[i] = (uint32_t)size[i];
    }
}

int l_bake(lua_State *L) {
    const field *node = read_arguments(L, "bake", "field");
    effect *e = script_of(L)->effect;
    effect_bake_desc desc = {
        .box = read_box(L, node),
        .repeats = value_get_bool(L, 2, "bake", "repeats", false),
        .levels = value_get_bool(L, 2, "bake", "levels", false),
    };
    read_size(L, desc.size);
    const char *name = value_name_or_variable(L, 2, "bake");
    vm_charge_memory(L, SEQUENCE_COST);
    script_make(L, "bake");
    field_grid *grid = effect_add_bake(e, node, &desc);
    script_made(L, grid);
    effect_name_grid(e, grid, name);
    field_push(L, field_grid_channel(script_memory(L), grid, 0, node->components));
    return 1;
}

// tile(noise, { ... }), and as a method noise:tile { ... }.
int l_tile(lua_State *L) {
    const field *noise = read_arguments(L, "tile", "noise");
    effect_tile_desc desc = {
        .size = read_whole(L, "tile", "resolution", TILE_RESOLUTION, 4, 512),
        .cells = read_whole(L, "tile", "cells", TILE_CELLS, 1, 256),
        .octaves = (int)read_whole(L, "tile", "octaves", 1, 1, 12),
        .levels = value_get_bool(L, 2, "tile", "levels", true),
    };
    vm_charge_memory(L, SEQUENCE_COST);
    script_make(L, "tile");
    const field *made = effect_add_tile(script_of(L)->effect, noise, &desc);
    script_made(L, true); // what is not made is refused below
    field_push(L, made);
    return 1;
}

void l_grid_open(lua_State *L) {
    static const luaL_Reg methods[] = {{"__index", l_sequence_index}, {NULL, NULL}};
    object_type(L, "sequence", methods);
    lua_register(L, "vdb", l_vdb);
    lua_register(L, "raw", l_raw);
    lua_register(L, "bake", l_bake);
    lua_register(L, "tile", l_tile);
}
