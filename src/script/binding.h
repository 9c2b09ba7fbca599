// What the files l_<object>.c share: the state behind a script and readers of its values. All raise
// Lua errors at the script's line, so callers hold nothing that would need freeing.
#pragma once
#include "base/time_limit.h"
#include "effect/effect.h"
#include "script/reference.h"
#include "script/script.h"
#include "script/vm.h"

typedef struct script {
    effect *effect;
    vm *vm;
    script_limits limits;
    time_limit frame;    // what this frame has left
    bool acting;         // frames and events run; not functions of time, which others wait for
    bool loading;        // things are declared only while the file runs, not in functions of time
    const char *unsound; // what was left half made by an error that the script caught; or NULL
    bool declared;       // effect { } was called
    int update;          // registry reference of fx.update, or LUA_NOREF
    int handlers;        // of the lists of functions of fx:on_frame and the like (l_events.c)
    uint64_t seed;       // of math.random
    const char *named;   // the call in the script's text that was named last (naming.c), or NULL
    struct scene_explosions *explosions; // all lists of the script, linked; NULL: there is none
} script;

script *script_of(lua_State *L);
arena *script_memory(lua_State *L);
// Raises unless the file is being loaded; `what` is the constructor's name.
void script_require_loading(lua_State *L, const char *what);
// Raises the current error message.
_Noreturn void script_raise(lua_State *L);
// A function of time, as effect_hooks and field_context call it. `user` is the script.
bool script_call(void *user, int function, double time, float out[4]);
// A call from outside: within the frame's budget, or the load's. As vm_call and vm_protect.
bool script_enter(script *s, int args, int results);
bool script_protect(script *s, lua_CFunction run, void *argument);
field_context script_context(lua_State *L); // of time 0, with the parameters' current values

// ---- objects ----------------------------------------------------------------------------------

// Metatables, by name: "field", "palette", "image", "pass result", "sequence", ...
void object_type(lua_State *L, const char *name, const luaL_Reg *methods);
void *object_new(lua_State *L, const char *name, size_t size);
void *object_test(lua_State *L, int index, const char *name); // NULL when it is something else
// What stands there, for messages: "a number", "an image", "instances", "nil". Leaves values above.
const char *object_kind(lua_State *L, int index);
// __index of an object that has nothing but methods: pushes the one that 2 names.
int object_method(lua_State *L, const char *type, const luaL_Reg *methods);

typedef struct field_object {
    const field *node;
    int param; // index in the effect, or -1
} field_object;
void field_push(lua_State *L, const field *node); // NULL: raises the current error
void field_push_param(lua_State *L, const field *node, int param);
const effect_param *field_param_of(lua_State *L, int index); // NULL when it is no parameter

void image_push(lua_State *L, graph_image image);

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
typedef struct picture_object { // a file's: image "templates/source.exr"
    const struct picture *picture;
    const char *file; // as the script says it
    pass *pass;       // that gives it as an image of the graph; NULL: nobody asked yet
} picture_object;
const picture_object *value_picture(lua_State *L, int index); // NULL: something else
typedef struct slices_object {                                // l_slices.c
    pass *pass;
    field_grid *grid;
    const field *offset; // of points, for what is turned round the axis; NULL: none
    uint32_t count;
    double time_step;
} slices_object;
typedef struct light_object {
    scene_light light;
} light_object;

// ---- values -----------------------------------------------------------------------------------

// A number, {x, y, z}, "#rrggbb", a field, a parameter, a curve, a function of time. `components`:
// wanted, 0: any. `who` and `key` name the value in messages.
const field *value_field(lua_State *L, int index, const char *who, const char *key, int components);
// As above, and it must not vary in space.
const field *value_uniform(lua_State *L, int index, const char *who, const char *key,
                           int components);
// Numbers and colours only. Returns the count of components, 0 for anything else.
int value_numbers(lua_State *L, int index, float out[4]);
bool value_image(lua_State *L, int index, graph_image *out);
bool value_is_plain_table(lua_State *L, int index); // no object
bool value_has_names(lua_State *L, int index);      // has a key that is a string

// Pushes table[key] and returns its type. Never runs code of the script, as metamethods would.
int value_get(lua_State *L, int table, const char *key);
// Keys of a table that are strings, sorted. The array is kept alive by a value that is pushed.
const char **value_names(lua_State *L, int table, const char *who, size_t *count);
// Raises on a key that is not among those known, with the nearest one that is.
void value_check_keys(lua_State *L, int table, const char *who, const char *const *known,
                      size_t count);
// The same of what a constructor's row says; and that of the constructor itself.
void value_check_row(lua_State *L, int table, const char *who, const script_object *object);
const script_object *value_check_object(lua_State *L, int table, const char *name);
_Noreturn void value_unknown(lua_State *L, const char *who, const char *what, const char *name,
                             const char *const *known, size_t count);

// Fields of a table; absent ones give `otherwise`.
double value_get_number(lua_State *L, int table, const char *who, const char *key,
                        double otherwise);
uint32_t value_get_count(lua_State *L, int table, const char *who, const char *key,
                         uint32_t otherwise);
bool value_get_bool(lua_State *L, int table, const char *who, const char *key, bool otherwise);
// In the effect's memory. NULL when absent.
const char *value_get_string(lua_State *L, int table, const char *who, const char *key);
// The key `name`; without one, the variable that the script assigns the call to; else `who`.
const char *value_name_or_variable(lua_State *L, int table, const char *who); // naming.c
// NULL when absent.
const scene_node *value_get_node(lua_State *L, int table, const char *who, const char *key);
scene_instances *value_instances(lua_State *L, int index);           // NULL: something else
void instances_push(lua_State *L, const scene_instances *instances); // the object of the script
bool value_get_vector(lua_State *L, int table, const char *who, const char *key, float out[3]);
// The table's box = { min, max }; false when absent.
bool value_get_box(lua_State *L, int table, const char *who, box3 *out);
void value_push_box(lua_State *L, box3 box); // { min = {x, y, z}, max = {x, y, z} }
// key = number, key = {number, ...} of the table at the top of the stack.
void value_put_number(lua_State *L, const char *key, double value);
void value_put_numbers(lua_State *L, const char *key, const float *values, int count);
int value_word(lua_State *L, int index, const char *who, const char *key, const char *const *words,
               size_t count);
// Index among the words of the object's key; that of its default when absent.
int value_get_choice(lua_State *L, int table, const script_object *object, const char *key);
const field *value_get_uniform(lua_State *L, int table, const char *who, const char *key,
                               int components, const field *otherwise);
// Of a scene object's call: sets what the table at 1 holds in the structure at `out`, as its row
// says where. And raises when the table holds values without a name.
void value_read_slots(lua_State *L, const char *who, void *out);
void value_refuse_array(lua_State *L, const char *who);
// The key `material` of a mesh's call, the table at 1 (l_material.c).
void value_read_material(lua_State *L, const char *who, scene_mesh *mesh);
// The slices that a method is called of, with a table at 2; raises when it is anything else.
const slices_object *slices_self(lua_State *L, const char *method, const char *example);
// A list of lights, in the effect's memory; returns how many.
size_t value_lights(lua_State *L, int index, const char *who, scene_light **out);

// A pass of a built-in type by the table at `table`, not declared yet. Keys among `own` are left to
// the caller. script.unsound is `who` until the caller has declared it.
pass *pass_make(lua_State *L, const char *type, const char *who, int table, const value_desc *own);
// What stands for a pass that is declared: `from` takes it, and its outputs are images by name.
void pass_push(lua_State *L, pass *p);

// ---- the objects' globals ---------------------------------------------------------------------

int l_bake(lua_State *L); // functions, and methods of fields
int l_tile(lua_State *L);
int l_slices_templates(lua_State *L); // a method of slices

bool events_push_method(lua_State *L, const char *name); // of the effect; false: it has none
void events_assign(lua_State *L);                        // of the list at 3 to the effect
void explosions_reset(script *s);                        // of all lists; l_shell.c
bool script_start(void *user);                           // as effect_hooks has them
bool script_frame(void *user, double time, double dt);
bool script_event(void *user, const struct effect_happening *what);

void l_effect_open(lua_State *L);
void l_events_open(lua_State *L);
void l_param_open(lua_State *L);
void l_field_open(lua_State *L);
void l_curve_open(lua_State *L);
void l_palette_open(lua_State *L);
void l_grid_open(lua_State *L);
void l_scene_open(lua_State *L);
void l_light_open(lua_State *L);
void l_material_open(lua_State *L);
void l_instances_open(lua_State *L);
void l_scatter_open(lua_State *L);
void l_pass_open(lua_State *L);
void l_lbm_open(lua_State *L);
void l_slices_open(lua_State *L);
void l_lamps_open(lua_State *L);
void l_particles_open(lua_State *L);
void l_shell_open(lua_State *L);
void l_voxels_open(lua_State *L);
void l_deposit_open(lua_State *L);
void l_image_open(lua_State *L);
