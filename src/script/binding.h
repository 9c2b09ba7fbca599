// Shared by the files l_<object>.c: the state of a script, and functions that read its values. They
// raise Lua errors at the script's line, so callers must not hold anything that needs to be freed.
#pragma once
#include "base/time_limit.h"
#include "effect/effect.h"
#include "effect/things.h"
#include "script/reference.h"
#include "script/script.h"
#include "script/vm.h"

typedef struct script {
    effect *effect;
    vm *vm;
    script_limits limits;
    time_limit frame;    // the limit of this frame
    bool acting;         // functions of frames or events are running, not functions of time
    bool loading;        // the file is running: only then can things be declared
    const char *making;  // what is being made, or was when an error came; or NULL
    const char *unsound; // what an error that the script caught left incomplete; or NULL
    bool declared;       // effect { } was called
    int update;          // registry reference of fx.update, or LUA_NOREF
    int handlers;        // of the lists of functions of fx:on_frame and the like (l_events.c)
    uint64_t seed;       // seed of math.random
    const char *named;   // the last call in the script's text that got a name (naming.c), or NULL
    struct scene_explosions *explosions; // all lists of the script, linked; NULL: there is none
} script;

script *script_of(lua_State *L);
arena *script_memory(lua_State *L);
// Notes that the script makes `made` now, by calling `call` ("march"), so that its values can be
// written back (effect_note_place).
void script_note_place(lua_State *L, const void *made, const char *call);
// Raises unless the file is being loaded; `what` is the constructor's name.
void script_require_loading(lua_State *L, const char *what);
// Raises the current error message.
_Noreturn void script_raise(lua_State *L);
// Calls the script from outside, within the limit of the frame or the load. Like vm_protect.
bool script_protect(script *s, lua_CFunction run, void *argument);
field_context script_context(lua_State *L); // for time 0, with the parameters' current values

// ---- objects ----------------------------------------------------------------------------------

// Metatables, by name: "field", "palette", "image", "pass result", "sequence", ...
void object_type(lua_State *L, const char *name, const luaL_Reg *methods); // NULL: none
void *object_new(lua_State *L, const char *name, size_t size);
void *object_test(lua_State *L, int index, const char *name); // NULL when it is something else
// Describes a value for messages: "a number", "an image", "instances", "nil". May push values.
const char *object_kind(lua_State *L, int index);
// __index of an object that has only methods: pushes the one whose name is at 2.
int object_method(lua_State *L, const char *type, const luaL_Reg *methods);

typedef struct field_object {
    const field *node;
    int param; // index in the effect, or -1
} field_object;
void field_push(lua_State *L, const field *node); // NULL: raises the current error
void field_push_param(lua_State *L, const field *node, int param);
const effect_param *field_param_of(lua_State *L, int index); // NULL when it is no parameter

typedef struct camera_object {
    scene_camera camera;
} camera_object; // NULL: the default
typedef struct sun_object {
    scene_sun sun;
} sun_object;
typedef struct sky_object {
    scene_sky sky;
} sky_object;
typedef struct material_object {
    const struct scene_material *material;
} material_object;
typedef struct mesh_object {
    scene_mesh *mesh;
    bool placed; // it has a place or a colour of its own
    bool at;     // a position
} mesh_object;
typedef struct picture_object { // the picture of a file: image "templates/source.exr"
    const struct picture *picture;
    const char *file; // as the script names it
    pass *pass;       // makes it an image of the graph; NULL: not needed yet
} picture_object;
const picture_object *value_picture(lua_State *L, int index); // NULL: something else
typedef struct slices_object {                                // l_slices.c
    pass *pass;
    field_grid *grid;
    const field *offset; // moves points before they are rotated around the axis; NULL: none
    uint32_t count;
    double time_step;
} slices_object;
typedef struct light_object {
    scene_light light;
} light_object;

// ---- values -----------------------------------------------------------------------------------

// Reads a field: a number, {x, y, z}, "#rrggbb", a field, a parameter, a curve, a function of time.
// `components` are required; 0: any number. `who` and `key` name the value in messages.
const field *value_field(lua_State *L, int index, const char *who, const char *key, int components);
// Refuses {x, y} where `components` is 3.
void value_refuse_two(lua_State *L, int index, const char *who, const char *key, int components);
// As value_field, but the field must not vary in space, and {x, y} is refused.
const field *value_uniform(lua_State *L, int index, const char *who, const char *key,
                           int components);
// Reads numbers or a colour. Returns the number of components, 0 for anything else.
int value_numbers(lua_State *L, int index, float out[4]);
bool value_image(lua_State *L, int index, graph_image *out);
bool value_is_plain_table(lua_State *L, int index); // it is a table and no object
bool value_has_names(lua_State *L, int index);      // it has a key that is a string

// Pushes table[key] and returns its type, without metamethods, which would run code of the script.
int value_get(lua_State *L, int table, const char *key);
// Returns the string keys of a table, sorted. Pushes a value that keeps the array alive.
const char **value_names(lua_State *L, int table, const char *who, size_t *count);
// Raises on a key that is not among those known, with the nearest one that is.
void value_check_keys(lua_State *L, int table, const char *who, const char *const *known,
                      size_t count);
// The same of what a constructor's row says; and that of the constructor itself.
void value_check_row(lua_State *L, int table, const char *who, const script_object *object);
const script_object *value_check_object(lua_State *L, int table, const char *name);
_Noreturn void value_unknown(lua_State *L, const char *who, const char *what, const char *name,
                             const char *const *known, size_t count);

// Read a key of a table; `otherwise` when it is absent.
double value_get_number(lua_State *L, int table, const char *who, const char *key,
                        double otherwise);
uint32_t value_get_count(lua_State *L, int table, const char *who, const char *key,
                         uint32_t otherwise);
bool value_get_bool(lua_State *L, int table, const char *who, const char *key, bool otherwise);
// Returns a copy in the effect's memory. NULL when absent.
const char *value_get_string(lua_State *L, int table, const char *who, const char *key);
// Returns the key `name`; without one, the variable that the script assigns the call to; else
// `who`.
const char *value_name_or_variable(lua_State *L, int table, const char *who); // naming.c
// The same of a palette or a curve: without the key, what its value is for (source_purpose).
const char *value_name_or_purpose(lua_State *L, int table, const char *who);
// Finds the local variable that the script assigns the call of `call` to. False: it is none.
bool value_variable(lua_State *L, const char *call, char *out, size_t capacity);
// Returns NULL when the key is absent.
const scene_node *value_get_node(lua_State *L, int table, const char *who, const char *key);
scene_instances *value_instances(lua_State *L, int index);           // NULL: something else
void instances_push(lua_State *L, const scene_instances *instances); // the object of the script
bool value_get_vector(lua_State *L, int table, const char *who, const char *key, float out[3]);
// The same of a place that is read while the file loads, by `call`, and can be set as "NAME.KEY".
void value_get_place(lua_State *L, int table, const char *call, const char *key, const char *name,
                     float3 *out);
// Reads box = { min, max }; false when absent.
bool value_get_box(lua_State *L, int table, const char *who, box3 *out);
void value_push_box(lua_State *L, box3 box); // { min = {x, y, z}, max = {x, y, z} }
// Set a key of the table at the top of the stack to a number, or to a list of numbers.
void value_put_number(lua_State *L, const char *key, double value);
void value_put_numbers(lua_State *L, const char *key, const float *values, int count);
int value_word(lua_State *L, int index, const char *who, const char *key, const char *const *words,
               size_t count);
// Returns an index in the words of the object's key; that of its default when the key is absent.
int value_get_choice(lua_State *L, int table, const script_object *object, const char *key);
const field *value_get_uniform(lua_State *L, int table, const char *who, const char *key,
                               int components, const field *otherwise);
// Reads the table of a scene object at 1 into the structure at `out`, as its row describes. The
// second raises an error when the table has values without a name.
void value_read_slots(lua_State *L, const char *who, void *out);
void value_refuse_array(lua_State *L, const char *who);
// Reads the key `material` of a mesh's table at 1 (l_material.c).
void value_read_material(lua_State *L, const char *who, scene_mesh *mesh);
// Returns the slices whose method is called with a table at 2. Raises an error for anything else.
const slices_object *slices_self(lua_State *L, const char *method, const char *example);
// Reads a list of lights into the effect's memory. Returns how many there are.
size_t value_lights(lua_State *L, int index, const char *who, scene_light **out);

// An error between these two, if the script catches it, leaves the effect incomplete. The second
// raises the current error unless all is `done`.
void script_make(lua_State *L, const char *who);
void script_made(lua_State *L, bool done);
// A pass of a built-in type by the table at `table`, not declared yet. Keys among `own` are left to
// the caller, which calls script_made when it has declared it.
pass *pass_make(lua_State *L, const char *type, const char *who, int table, const value_desc *own);
// A group of templates by the table at 2 (l_templates.c): pass_make, with its picture and count,
// and its size and lifetime, which are among `own`.
pass *templates_make(lua_State *L, const char *type, const value_desc *own,
                     const struct picture **image, uint32_t *count);
extern const char templates_example[]; // of keys
// `grid` is what a pass fills that is declared after it. NULL: raises the error.
void grid_add(lua_State *L, field_grid *grid, const char *name);
void grid_push_field(lua_State *L, field_grid *grid, const char *name); // raises for no field
// What stands for a pass that is declared: `from` takes it, and its outputs are images by name.
void pass_push(lua_State *L, pass *p);

// ---- globals of the objects -------------------------------------------------------------------

int l_bake(lua_State *L); // functions, also used as methods of fields
int l_tile(lua_State *L);
int l_slices_templates(lua_State *L); // a method of slices

bool events_push_method(lua_State *L, const char *name); // a method of the effect; false: none
void events_assign(lua_State *L);                        // assigns the list at 3 to the effect
void explosions_reset(script *s);                        // resets all lists; l_shell.c
bool script_start(void *user);                           // these three are in effect_hooks
bool script_frame(void *user, double time, double dt);
bool script_event(void *user, const struct effect_happening *what);

// Functions of effect files; their other types and functions are registered by the second.
typedef int script_word(lua_State *L);
script_word l_camera, l_curve, l_image, l_layers, l_material, l_mesh, l_node, l_orbit, l_param,
    l_particles, l_pick, l_point_light, l_point_lights, l_scatter, l_sky, l_sphere_light,
    l_spot_light, l_sun;
typedef void script_opener(lua_State *L);
script_opener l_air_open, l_deposit_open, l_effect_open, l_field_open, l_grid_open,
    l_instances_open, l_palette_open, l_pass_open, l_shell_open, l_slices_open, l_voxels_open;
