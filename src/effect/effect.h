// A loaded effect: parameters, objects of fields, passes, timeline, outputs. The script layer fills
// it; everything else (program, tests, an engine) renders it. Needs no Lua.
//
// Order of calls: effect_create, declarations, effect_set (command line), effect_build,
// effect_render ... An effect belongs to one thread at a time.
#pragma once
#include "base/content_cache.h"
#include "pass/pass.h"
#include "scene/view.h"

typedef struct effect effect;
struct effect_happening; // events.h

typedef struct effect_param {
    value_desc desc;
    float value[4]; // of now
    const char *group;
    bool log_scale;
    bool structural; // the script read its value while it ran (p:get()): changing it is a reload
} effect_param;

typedef struct effect_setting { // see effect_set
    const char *name, *text;
    // What the script itself must say there (effect_control.initial) for the setting to hold; then
    // it is no error if nothing has that name or takes that text. NULL: holds always.
    const char *initial;
} effect_setting;

enum { EFFECT_MAX_ASSETS = 8 };
typedef struct effect_desc {
    gpu *device;        // NULL: check only
    const char *file;   // the effect's .lua file
    const char *inside; // folder that it must lie in when it is opened; NULL: its user named it
    const char *bundle; // what it was unpacked from, as its user named it; NULL: it is no bundle's
    const char *const *assets; // folders that it may read besides its own
    size_t asset_count;        // up to EFFECT_MAX_ASSETS
    const char *project;       // the file that names some of them, which is watched; NULL: none
    const char *shader_root;   // the program's shaders
    const char *cache_dir;     // NULL: no caches
    bool counters;
    bool interaction; // pass_host.interaction
    bool never_waits; // field_grid.never_waits, of all grids
    // Above 0: each pass `march` is replaced by a `reference`, up to so many samples per pixel
    // (effect_samples).
    uint32_t reference;
    const effect_setting *settings; // each is applied when what it names is declared
    size_t setting_count;
    double
        seconds; // that a load may take, and a part of it a frame's script; 0: as base/time_limit.h
    // Shared with other loads of the same file, so that nothing is read twice; NULL: its own.
    shader_library *library;
    content_cache *contents;
} effect_desc;

typedef struct effect_facts {    // what it is; of the script's numbers, as far as it has run
    const char *file, *root;     // its file, and that one's folder
    const char *inside, *bundle; // effect_desc
    const char *source;          // what its user named: its bundle, else its file
    double seconds;              // that a load may take
    const char *name;
    const char *author, *licence; // NULL: not said
    double fps;
    uint32_t frames, first; // how many, and the number of the first
} effect_facts;

effect *effect_create(const effect_desc *desc);
void effect_destroy(effect *e);
const effect_facts *effect_get_facts(const effect *e);

// ---- declaring (script) -----------------------------------------------------------------------

arena *effect_memory(effect *e);                               // lives as long as the effect
size_t effect_roots(const effect *e, const char *const **out); // that, and those of assets
// Finds a file of the effect by its name: in its folder, else in those of assets. `path`, which may
// have a wildcard in its last component, is watched from now on even if there is no such file.
// Returns the folder, in which whoever reads it must stay. NULL with a message.
const char *effect_find_file(effect *e, const char *name, char path[4096]);
bool effect_draws(const effect *e); // false: it is only checked
scene *effect_scene(effect *e);
pass_host *effect_pass_host(effect *e);

void effect_set_name(effect *e, const char *name);
void effect_set_author(effect *e, const char *author, const char *licence);       // NULL: not said
bool effect_set_timeline(effect *e, double fps, uint32_t frames, uint32_t first); // > 0
void effect_set_seed(effect *e, uint32_t seed);

// Checks name, range, default. Returns its index, or -1.
int effect_add_param(effect *e, const effect_param *param);
pass *effect_add_pass(effect *e, const char *type, const char *shader,
                      const char *label);          // label NULL: type's name, numbered
void effect_add_grid(effect *e, field_grid *grid); // the effect owns it from now on
// Makes a grid's time the sum of `speed` over the frames of the effect, beginning at `start` (s).
// Both are numbers that do not vary in space.
void effect_add_clock(effect *e, const field_grid *grid, const field *speed, const field *start);
// Names a grid, for effect_add_volume. A name that is taken gets a number.
void effect_name_grid(effect *e, field_grid *grid, const char *name);
bool effect_playback(const effect *e, field_playback *out); // false: no grid is played
// The files of these and the next functions must lie in the effect's folder. NULL with a message.
scene_mesh *effect_add_mesh(effect *e, const char *file);
const mesh_texture *effect_add_texture(effect *e, const char *file); // PNG or JPEG
// Adds a material. If it has a name, its numbers become controls. It must live as long as the
// effect.
void effect_add_material(effect *e, scene_material *material);
enum { EFFECT_MAX_PLACES = 64 };                   // nodes and meshes whose numbers are controls
void effect_add_node(effect *e, scene_node *node); // must live as long as the effect
// The effect owns the result. NULL with a message when it has too many instances.
scene_instances *effect_add_instances(effect *e, const scene_instances_desc *desc);
// Reads the panorama of the sky; an effect has one.
const struct sky_image *effect_add_sky_image(effect *e, const char *file);
// Reads a picture as data (media/picture.h), of at most `side_max` pixels a side. It lives as long
// as the effect.
const struct picture *effect_read_picture(effect *e, const char *file, uint32_t side_max);
typedef struct effect_bake_desc {
    uint32_t size[3];     // voxels
    box3 box;             // the box that they cover
    bool repeats;         // the grid repeats outside of the box, in all directions
    bool levels;          // with mip levels; for a grid that repeats
    const char *sampling; // of grids: a word of the pass `bake`; NULL: its default
} effect_bake_desc;
// Bakes a field to a grid (pass type "bake"), again whenever it changes. Returns the grid.
field_grid *effect_add_bake(effect *e, const field *node, const effect_bake_desc *desc);
typedef struct effect_tile_desc {
    uint32_t size;  // voxels along each side
    uint32_t cells; // of the noise, along each side
    int octaves;    // of a single noise, how many are in the tile
    bool levels;    // with mip levels
} effect_tile_desc;
// Replaces an expression of noises by samples of a baked tile that repeats (field_tile).
const field *effect_add_tile(effect *e, const field *noise, const effect_tile_desc *desc);
// ---- volumes: what fills space, sampled at voxels and read back -------------------------------

typedef struct effect_volume_desc {
    const char *source; // name of a grid, or label of a pass whose medium it is; NULL: the
                        // simulated grid, or else the medium of the first pass `march`
    const char *fields; // "density,velocity"; NULL: all fields
    uint32_t size;      // voxels along the longest side, at most 1024; 0: voxels as large as those
                        // of the source's grids, or 64
    box3 box;           // empty: the box in which the source is not zero in these frames
    double first, last; // frames
} effect_volume_desc;
typedef struct effect_volume_field {
    const char *name;
    int components;    // 1: an image of halves; 3: of four halves a voxel
    graph_image image; // the caller must keep it (graph_add_output)
} effect_volume_field;
enum { EFFECT_VOLUME_FIELDS = 16 };
typedef struct effect_volume {
    box3 box;         // box of all voxels
    uint32_t size[3]; // number of voxels
    float voxel;      // side of a voxel, which is a cube (m)
    effect_volume_field fields[EFFECT_VOLUME_FIELDS];
    size_t count;
} effect_volume;
// Adds passes that compute the volume in every frame. Call it after the script has run and before
// the effect is built.
bool effect_add_volume(effect *e, const effect_volume_desc *desc, effect_volume *out);
// ---- sheets: the medium of a march as engines want it, cell by cell ---------------------------

typedef enum effect_map { // what is kept of a medium; all premultiplied, with opacity in alpha
    EFFECT_MAP_COLOR,     // radiance, scene-linear
    EFFECT_MAP_SHOWN,     // the same by the effect's pass `final`: exposed and tone-mapped
    EFFECT_MAP_MOTION,    // heights of the picture a second to the right and up, m/s towards the
                          // camera; not premultiplied; alpha: weight of opacity and light
    EFFECT_MAP_RIGHT_TOP_BACK,    // radiance by a white light from there, in each channel
    EFFECT_MAP_LEFT_BOTTOM_FRONT, // the same
    EFFECT_MAP_EMISSION,          // radiance of the medium itself
    EFFECT_MAP_NORMAL,            // to the right, up, towards the camera; not premultiplied
    EFFECT_MAP_HEAT, // temperature (K), depth from the camera (m); neither premultiplied
    EFFECT_MAPS
} effect_map;
typedef struct effect_sheet_desc {
    const char *source; // label of a march; NULL: the first
    bool wanted[EFFECT_MAPS];
    bool temperature;   // of EFFECT_MAP_HEAT: not the depth alone
    double first, last; // frames
} effect_sheet_desc;
typedef struct effect_sheet {
    graph_image images[EFFECT_MAPS]; // zero: not wanted; the caller must keep them
    box3 box;                        // that the medium can be in, in these frames (m)
    const char *source;              // label of the march
    bool moves; // EFFECT_MAP_MOTION is known: a grid with a velocity is in the density, or what
                // `advect` carries; else the image is zero
} effect_sheet;
// Adds passes that see the medium of a march alone: no mesh, sky or sprite shows in it or hides
// it, though meshes shadow it in EFFECT_MAP_COLOR. Of samples (effect_set_samples, before it) the
// images are the means. Call it as effect_add_volume. False with a message, as where nothing tells
// a temperature.
bool effect_add_sheet(effect *e, const effect_sheet_desc *desc, effect_sheet *out);

// Whether the medium of that march (NULL: the first) is the same again after so many seconds, by
// what it is made of (field_repeats).
bool effect_repeats(effect *e, const char *source, double seconds, strbuf *why);

// ---- layers: the media of marches as a part of a host's picture --------------------------------

enum {                          // images of a layer
    EFFECT_LAYER_COLOR,         // premultiplied radiance, and opacity
    EFFECT_LAYER_TRANSMITTANCE, // by colour
    EFFECT_LAYER_DEPTH,         // m, where the opacity is on average
    EFFECT_LAYER_MOTION,        // of that place, since the frame before, in parts of the picture
    EFFECT_LAYER_IMAGES
};
typedef struct effect_layer {
    graph_image images[EFFECT_LAYER_IMAGES]; // the caller must keep those that it wants
    bool moves; // a medium has a motion of its own, which the image has besides the camera's
} effect_layer;
// Adds passes that see media alone, in front of the depths of effect_give_depth: that of the march
// `source`; NULL: of all marches that the effect's picture shows as they are, at most three, or
// else of its first. Call it as effect_add_volume. `motion`: the image is wanted.
bool effect_add_layer(effect *e, const char *source, bool motion, effect_layer *out);
// From the next frame on: the camera (NULL: the script's own). False with a message.
bool effect_set_view(effect *e, const scene_view *view);
bool effect_has_view(const effect *e); // one that was set
// The sun and the lights, instead of the script's, at most as many as it declares. 0: the script's.
bool effect_set_lights(effect *e, const struct light_entry *lights, size_t count);
// The depth buffer of the host, which effect_set_view's projection made, for the frame at work;
// NULL: there is none.
void effect_give_depth(effect *e, gpu_image *depth);
// Calls that are made in each frame that is drawn, on the device, before all else and after it:
// `done` is false when something failed. Both or none.
void effect_around_frame(effect *e, bool (*begin)(void *user), bool (*end)(void *user, bool done),
                         void *user);

// Makes the effect draw only kept images and no pictures. Call it before the effect is built.
void effect_skip_pictures(effect *e);

// Smooths edges over frames, where `on` and a setting of "effect.antialias" say so: the camera is
// moved by a part of a pixel in each frame after the first, and a pass `accumulate`, called
// "antialias", gathers the picture that the last `final` takes. With a reference, which has samples
// of its own, it does nothing. False with a message when that setting is wrong.
bool effect_set_antialias(effect *e, bool on);
typedef enum effect_picture {
    EFFECT_OUTPUT, // display-referred
    EFFECT_LINEAR, // scene-linear, for EXR
    EFFECT_DEPTH,  // linear depth in metres, for EXR
} effect_picture;
bool effect_set_picture(effect *e, effect_picture which, graph_image image);

typedef struct effect_hooks {                                          // calls back into the script
    bool (*call)(void *user, int function, double time, float out[4]); // function of time
    bool (*update)(void *user, double time, double dt); // `update(t, dt)` of the effect, or NULL
    bool (*start)(void *user);                          // its systems (events.h), or NULL
    bool (*frame)(void *user, double time, double dt);
    bool (*event)(void *user, const struct effect_happening *what);
    // Writes the line that is running, "file:line: "; "" for none.
    void (*locate)(void *user, char *out, size_t size);
    void (*renew)(void *user); // a new frame begins, with a new time limit; or NULL
    void (*destroy)(void *user);
    void *user;
} effect_hooks;
void effect_set_hooks(effect *e, const effect_hooks *hooks);
void effect_add_file(effect *e, const char *path); // a file a reload should watch

typedef struct effect_place { // where a script makes something
    const char *file;         // path
    int line;                 // from 1
    const char *call;         // the function that it calls: "march", "param"
} effect_place;
// Notes the place of a pass, a parameter, a palette, a curve, or a field that the script gave to
// the scene, a light or a material. `call` must live as long as the effect.
void effect_note_place(effect *e, const void *made, const char *file, int line, const char *call);
const effect_place *effect_find_place(const effect *e, const void *made); // NULL: not known
enum {
    EFFECT_MAX_RAMPS = 256,    // palettes and curves that get a name; later ones get none
    EFFECT_CONTROL_COST = 512, // approximate bytes of a control
};
// Add palettes and curves that can be edited by name. `name` is made unique. Return the final name
// ("" when there are too many), or NULL with a message when a setting of that name is wrong.
const char *effect_add_palette(effect *e, palette *p, const char *name);
const char *effect_add_curve(effect *e, curve *c, const char *name);
// Adds a number over a particle's life: a curve over age, 0 to 1, linear between its keys. `shown`,
// the palette that fields read, is updated whenever the curve changes.
const char *effect_add_age_curve(effect *e, curve *c, palette *shown, const char *name);
enum { EFFECT_MAX_FIELDS = 256 }; // fields whose numbers are controls; those of later ones are not
bool effect_has_room_for_field(const effect *e);
// Makes controls of numbers that a field was given: "lumps.frequency". `values`: by argument of its
// kind a constant of its own, whose value settings change, or NULL. `name` is made unique. A shape
// is listed among those that stand in space (things.h). False with a message when a setting of such
// a name is wrong.
bool effect_add_field(effect *e, const char *name, const field *node, field *const *values);
// Layers of noise that one call of the script lists: layers { {2, 1}, {7, 0.4} }.
typedef struct effect_layers {
    const char *name; // of their controls: the variable, or "layers"
    size_t count;
} effect_layers;
// Makes controls of the numbers that a list of layers was given: those of `values` (NULL: it is
// none), of each layer its scale and its strength, as "lumps.scale_1" and "lumps.strength_1"; and
// `shared_count` others of them all, as "lumps.seed". It counts as a field, for which there must be
// room; effect_note_place may be told the result. NULL with a message: a setting of such a name is
// wrong.
const effect_layers *effect_add_layers(effect *e, const char *name, field *const (*values)[2],
                                       size_t count, const value_desc *const *shared,
                                       field *const *shared_values, size_t shared_count);
size_t effect_layers_count(const effect *e);
const effect_layers *effect_get_layers(const effect *e, size_t index);
// Makes a control "GROUP.NAME" of numbers that are read while the effect loads, of which `value`
// has as many as `desc` says: a setting replaces them. `made` is what effect_note_place was told;
// both and `desc` must live as long as the effect. False with a message when a setting is wrong.
bool effect_add_loaded(effect *e, const char *group, const value_desc *desc, const void *made,
                       float *value);
// Returns whether tiles were made, whose size and octaves follow from numbers of fields: another
// number then needs another load.
bool effect_has_tiles(const effect *e);
void effect_mark_structural(effect *e, size_t param);

// ---- asking -----------------------------------------------------------------------------------

size_t effect_param_count(const effect *e);
const effect_param *effect_get_param(const effect *e, size_t index);
size_t effect_pass_count(const effect *e);
pass *effect_get_pass(effect *e, size_t index);
graph *effect_graph(effect *e);
shader_library *effect_library(effect *e);
content_cache *effect_content_cache(effect *e);

// ---- controls: all that can be set by name ----------------------------------------------------

typedef enum effect_control_kind {
    EFFECT_CONTROL_PARAM,
    EFFECT_CONTROL_PALETTE,
    EFFECT_CONTROL_CURVE,
    EFFECT_CONTROL_SCENE,    // "camera.fov", "sun.azimuth", "sky.strength"
    EFFECT_CONTROL_LIGHT,    // "lamp.power"
    EFFECT_CONTROL_MATERIAL, // "rust.roughness"
    EFFECT_CONTROL_PLACE,    // "rock.position", of a mesh or a node
    EFFECT_CONTROL_FIELD,    // "lumps.frequency"
    EFFECT_CONTROL_LOADED,   // "air.position"
    EFFECT_CONTROL_EVENTS,   // "effect.events"
    EFFECT_CONTROL_UNIFORM,  // "march.steps"
    EFFECT_CONTROL_OPTION,   // "march.mode"
    EFFECT_CONTROL_SCALE,    // "march.resolution"
} effect_control_kind;

typedef struct effect_control {
    effect_control_kind kind;
    const char *name;
    const char *group;      // "camera", the name of a light, a pass ...; of a parameter as declared
    const value_desc *desc; // of a palette, a curve and events only what it is for
    size_t pass, index;     // of a pass, and of its uniform or option; of a parameter
    size_t layer;           // of a list of layers, from 1, that the number is of; 0: of none
    const char *initial;    // as text, before any setting
    bool moved;             // a setting holds: effect_control_setting
} effect_control;
// Parameters, palettes and curves, the scene, then pass by pass; complete once the script has run.
size_t effect_control_count(const effect *e);
const effect_control *effect_get_control(const effect *e, size_t index);
const effect_control *effect_find_control(effect *e, const char *name); // NULL: suggests
// Where the script makes what the control belongs to. NULL: that is not known.
const effect_place *effect_control_place(const effect *e, const effect_control *c);
// The palette or curve of a control of that kind.
const palette *effect_control_palette(const effect_control *c);
const curve *effect_control_curve(const effect_control *c);
bool effect_control_is_over_age(const effect_control *c); // a curve of effect_add_age_curve
// The field that holds a uniform or a value of the scene now, and what the script gave (NULL: the
// default). Both NULL for other kinds.
const field *effect_control_field(const effect *e, const effect_control *c);
const field *effect_control_original(const effect_control *c);
// What counts where there is no field: the default of a uniform, here or in the pass that it is
// taken from.
const float *effect_control_default(const effect *e, const effect_control *c);
// The setting that holds, as text, until the next one; NULL: the script's own value does.
const char *effect_control_setting(const effect_control *c);
// The value of now, as effect_set takes it; of what the script moves how it does.
void effect_print_control(const effect *e, const effect_control *c, strbuf *out);

// Sets a parameter ("density"), a uniform of a pass ("march.steps"), a value of the scene
// ("camera.fov"), a palette or a curve. `text`: a number, "1,2,3", "#ff8800", a word, true or
// false; stops and keys as palette_parse and curve_parse take them. The text that the script itself
// says (effect_control.initial) resets. What is structure, an option ("march.mode") or the
// resolution of a pass ("march.resolution"), can be set by effect_desc.settings only. Names not
// known get a suggestion. Repeating it takes no memory.
bool effect_set(effect *e, const char *name, const char *text);
// The same of a control in the list, to numbers, as many as it has: of a word its number, of true
// and false 1 and 0. False with a message where text alone can say it. Makes no text.
bool effect_set_numbers(effect *e, size_t control, const float *values, int count);
bool effect_reset(effect *e, const char *name); // to what the script says
bool effect_set_value(effect *e, size_t param, const float value[4]);

// Call it when the script has run: applies the settings of the command line about the scene. False
// with a message when a setting is wrong, or names nothing that the script declared.
bool effect_check_settings(effect *e);

// ---- rendering --------------------------------------------------------------------------------

// Checks without a device what effect_build needs: shaders, fields, the graph.
bool effect_check(effect *e);
// Compiles shaders and pipelines. Any thread may call it, also while another effect is rendered,
// but only one at a time for a library.
bool effect_compile(effect *e);
// After graph_compile: adds what the first picture lacks of memory, of the host's and the device's,
// but for single texels and what is known only when numbers are. Returns the bytes of images that
// it does not need any more.
uint64_t effect_list_memory(const effect *e, budget_list *host, budget_list *device);
// All of that is asked for before the first part of it is taken.
bool effect_allocate(effect *e, uint32_t width, uint32_t height); // after compile, or again
bool effect_build(effect *e, uint32_t width, uint32_t height);    // both
// Evaluates all that a frame needs (update, functions, curves) and draws nothing. Any thread.
bool effect_rehearse(effect *e, double frame);
// Call it instead of the first effect_allocate: takes over from `from` what `e` would otherwise
// make again: images that match by name, format and size, with their contents, so that histories
// continue; decoded grids; meshes. `from` can then only be destroyed. On failure `from` is
// unchanged.
bool effect_adopt(effect *e, effect *from, uint32_t width, uint32_t height);
// Averages so many pictures of each frame, at moments that are evenly spread over the part
// `shutter` of a frame after it, each with a camera that is moved by a part of a pixel and within
// its lens. What comes before the tone map is averaged (each picture that a pass `final` takes, and
// the output and `linear` where none makes them), in linear light. 1 to 65536 of them, 0 to 1 of a
// frame. Call it after the script has run and before the effect is built.
bool effect_set_samples(effect *e, uint32_t samples, double shutter);
// From now on frames bring what simulates to their time, and draw nothing that it does not need.
void effect_only_simulate(effect *e);
// How many frames were drawn in a row before the last, if pictures depend on that.
uint32_t effect_frames_before(const effect *e);
size_t effect_files(const effect *e, const char *const **out); // absolute paths of all files read

// Records and submits one frame. Frame numbers start at effect_first_frame; time = (frame - first)
// / fps. Histories are cleared when `frame` does not follow the last one, unless `jump` is set.
// Returns the GPU's frame number; 0 with a message.
uint64_t effect_render(effect *e, double frame, bool jump);

typedef struct effect_simulation {
    bool waiting;        // they have not reached the last frame: render it again (never_waits)
    double reached;      // time that they have reached (s); -INFINITY: none
    const char *trouble; // trouble of the pass `where`, and the key to change; NULL: none
    const char *where;
} effect_simulation;
bool effect_get_simulation(const effect *e, effect_simulation *out); // false: nothing simulates
// GPU times by label, at most `capacity`, of what was simulated for the frame rendered last before
// it was recorded. Waits for that. 0 in an effect that never waits.
size_t effect_times_ahead(effect *e, gpu_pass_time *out, size_t capacity);
// Submits a part of the steps that simulations need to come to a frame, of which recording the
// frame would not do the rest; `more`: there was one. With never_waits.
bool effect_catch_up(effect *e, double frame, bool *more);
// Frames of which a snapshot was kept, in rising order.
size_t effect_list_snapshots(const effect *e, double *frames, size_t capacity);
// Snapshots that are none of an effect's now, and the state that they began with, which is kept
// whatever numbers are set. NULL: nothing simulates, or there is no memory for its state.
typedef struct effect_branch effect_branch;
effect_branch *effect_branch_begin(effect *e);         // of the state after the last frame
effect_branch *effect_branch_leave(effect *e);         // takes the effect's
void effect_branch_enter(effect *e, effect_branch *b); // gives it these, frees `b`; NULL: none
void effect_branch_destroy(effect_branch *b);
void effect_restart(effect *e); // simulations start from the beginning with the next frame
// Save and load the state of all simulations, between frames, after effect_allocate. When a state
// cannot be loaded, they start from the beginning. `frame` is the one that was rendered last.
bool effect_save_state(effect *e, const char *path);
bool effect_load_state(effect *e, const char *path, double *frame);
// Sets a callback, which effect_render calls while skipped frames are simulated, with the steps
// done and the steps needed. Returning false cancels the frame.
void effect_on_progress(effect *e, bool (*call)(void *user, double done, double whole), void *user);

// A number that moved beyond its range, or lengths that do not fit together (hints.c), since the
// effect was made or a control was last set; NULL: nothing.
const char *effect_get_warning(const effect *e);

// Returns the samples per pixel of the last frame, of the pass `reference` that has the fewest; 0:
// there is no such pass.
uint32_t effect_samples(const effect *e);

graph_image effect_get_picture(const effect *e, effect_picture which); // zero when there is none
