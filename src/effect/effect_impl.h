// Data of an effect, for the files of this layer only.
#pragma once
#include "effect/effect.h"
#include <pthread.h>

void effect_copy_settings(effect *e, const effect_setting *settings, size_t count);
// Applies the settings that name this pass; called before it enters the graph.
bool effect_apply_settings(void *user, pass *p);

// ---- a frame ------------------------------------------------------------------------------------

bool effect_runs(const effect *e, const pass *p); // some part of it; after the graph was compiled
// The box in which the density of a medium can be nonzero at one of these frames, whatever its
// grids show now. False with a message.
bool effect_medium_box(effect *e, const field *density, double first, double last, box3 *out);
void effect_tell_hints(effect *e); // once, then: lengths that do not fit together
// Evaluates a frame. `again`: the same as the last, for which `update` ran.
bool effect_evaluate(effect *e, double frame, gpu *device, bool again);
void effect_reset_instances(effect *e); // to their initial state, since time has gone back
// Simulates up to the frame. `*again`: `update` need not run for it.
bool effect_simulate(effect *e, double frame, bool *again);
// Adds the times of a submission of this frame to those ahead of the last.
void effect_add_times(effect *e, uint64_t number);

// samples.c: a frame as several moments that are averaged, and cameras that are moved for it.
uint32_t effect_moments(const effect *e);            // of a frame, at least 1
double effect_moment(const effect *e, double frame); // the time of the present one, in frames
// Puts a pass `mean` behind an image, for all that read it; `weighted`: its alpha is what a colour
// counts in the mean.
bool effect_add_mean(effect *e, graph_image *image, bool weighted);
bool effect_antialias(effect *e);                // where it is wanted; see samples.c
void effect_move_sight(effect *e, double frame); // in e->frame, which is evaluated

// ---- states -----------------------------------------------------------------------------------

struct checkpoint;
struct checkpoint_list;
bool effect_can_save(const effect *e); // all simulations have a state now
void effect_list_state(const effect *e, double frame, struct checkpoint_list *out); // after it
bool effect_take_state(effect *e, struct checkpoint *c); // false: all start from the beginning

// Snapshots of simulations in a window, for going back and forth in time (snapshots.c).
void effect_keep_snapshot(effect *e, double frame); // which has just been simulated
// To the last one until a frame, if that is after another frame. False: there is none.
bool effect_take_snapshot(effect *e, double frame, double after);
void effect_forget_snapshots(effect *e);                   // numbers have changed
void effect_forget_snapshots_from(effect *e, double time); // events of this time or later (s)
typedef struct effect_snapshot {
    double frame;
    bool root; // a branch began here: it holds whatever numbers are set
    struct checkpoint *state;
} effect_snapshot;
typedef struct effect_snapshots {
    effect_snapshot *list; // by frame
    size_t count, capacity;
    double gap; // frames from one to the next at least; 0: a second
} effect_snapshots;
void effect_free_snapshots(effect_snapshots *s);
void effect_stop_simulations(effect *e); // they have no state: the next frame finds one

// ---- systems.c: functions of the script that run from frame to frame (events.h) -----------------

typedef struct effect_systems effect_systems;
void effect_free_systems(effect *e);
bool effect_run_systems(effect *e, double frame); // runs what has not run yet, up to the frame
void effect_restart_systems(effect *e);           // the next frame starts from the first one
void effect_resize_systems(effect *e, uint32_t width, uint32_t height); // before the effect is
void effect_forget_moved(effect *e, size_t param);                      // a user has set it

// ---- controls ---------------------------------------------------------------------------------

typedef struct control {
    effect_control face; // first: effect_get_control gives it out
    char *text;          // of the setting that holds
    size_t text_capacity;
    float numbers[4]; // the setting, where there is no text yet
    bool as_numbers;
    // Of a uniform and a value of the scene: where its field is held, what the script gave (NULL:
    // the default), and two constants that settings take in turn. Of a number of a field and one
    // that is read while it loads: a constant, whose value settings change, and a copy before any.
    const field **slot, *original;
    field *nodes[2];
    int turn;
    const void *owner; // what has the value, where the script may leave all of its values open
    // Beside each, its state before any setting. A curve over age has both: fields read the
    // palette.
    palette *palette;
    palette_desc palette_original;
    curve *curve;
    curve curve_original;
} control;

control *effect_control_of(effect *e, const char *name); // NULL without a message
// Puts a control behind those of its kind, and notes what the script says.
control *effect_add_control(effect *e, const control *own);
// Applies what the command line says about a control that was declared just now.
bool effect_apply_to(effect *e, control *c);
void effect_reset_control(effect *e, control *c); // but for structure

// Names a control "GROUP.NAME" by its description, and adds it.
control *effect_add_member(effect *e, const char *group, const value_desc *desc, control own);

// By kind: param.c, control_field.c (all that has a slot), control_pass.c (what else passes have),
// control_scene.c, control_ramp.c (palettes, curves). `set` changes nothing when it fails; `print`
// says the value of now as `set` takes it, or how the script moves it.
bool param_set(effect *e, control *c, const char *text);
void param_print(const effect *e, const control *c, strbuf *out);
// Of numbers that were checked.
void field_control_put(effect *e, control *c, const float value[4]);
bool field_control_set(effect *e, control *c, const char *text);
void field_control_print(const effect *e, const control *c, strbuf *out);
void pass_control_add_all(effect *e, size_t pass);
bool pass_control_set(effect *e, control *c, const char *text);
void pass_control_print(const effect *e, const control *c, strbuf *out);
bool scene_control_add_all(effect *e); // also of lights, materials, meshes and nodes
bool scene_control_unknown(const effect *e, const char *name); // true with a message of its own
void effect_add_shape(effect *e, const char *name, const field *node); // where it is one; things.c
bool ramp_set(effect *e, control *c, const char *text);
void ramp_reset(effect *e, control *c);
void ramp_print(const effect *e, const control *c, strbuf *out);
bool ramp_rename(effect *e, control *c); // because a parameter takes its name
bool events_add_control(effect *e);      // of one that hears any; systems.c
bool events_control_set(effect *e, control *c, const char *text);
void events_control_reset(effect *e, control *c);
void events_control_print(const effect *e, const control *c, strbuf *out);

// sheet.c, for layer.c too.
bool effect_is_medium(const pass *p); // it marches through one
// The march that is called so, or the first; NULL with a message.
pass *effect_find_march(effect *e, const char *label);
const field *effect_find_velocity(effect *e, const pass *march); // of its medium; NULL: not known
// Gives a pass the images of light that a march has. False with a message.
bool effect_take_light(const pass *march, pass *maps);
// layer.c: as the scene says, or a host.
bool effect_fill_frame(effect *e, struct frame_block *out);
bool effect_fill_lights(effect *e, struct light_block *out);

typedef struct effect_given { // by a host
    bool has_view, has_lights;
    scene_view view;
    struct light_block lights;
    bool (*begin)(void *user);
    bool (*end)(void *user, bool done);
    void *user;
} effect_given;

struct effect {
    arena memory;
    gpu *device;
    effect_facts facts;
    const char *roots[1 + EFFECT_MAX_ASSETS]; // folders that it may read, its own first
    size_t root_count;
    shader_library *library, *own_library; // the latter NULL when it is shared
    scene scene;
    graph *graph;
    pass_host host;

    uint32_t seed;

    effect_param **params;
    float (*values)[4]; // of the params, as field_context wants them
    size_t param_count, param_capacity, value_capacity;
    pass **passes;
    size_t pass_count, pass_capacity;
    field_grid **grids;
    size_t grid_count, grid_capacity;
    struct effect_clock *clocks; // of those whose speed or start moves
    size_t clock_count, clock_capacity;
    size_t clocked;                         // frames since the first that they know
    content_cache *contents, *own_contents; // as the library
    content_cache_item **held;              // data of meshes
    size_t held_count, held_capacity;
    scene_material **materials;
    size_t material_count, material_capacity;
    scene_mesh **meshes;
    size_t mesh_count, mesh_capacity;
    scene_instances **instances;
    size_t instances_count, instances_capacity;
    struct sky_image *sky;   // of the scene, where it has one
    const char *sky_file;    // whose it is
    shader_reader reader;    // adds to `files`
    pthread_mutex_t reading; // held by it
    const char **files;      // absolute
    size_t file_count, file_capacity;

    graph_image pictures[3]; // by effect_picture
    effect_hooks hooks;
    effect_systems *systems; // NULL: none

    // Of the frame being recorded.
    field_context context;
    struct frame_block frame;
    struct light_block lights;
    uint32_t width, height;
    uint32_t counter;            // frames rendered so far
    double last_frame;           // number of the frame rendered last
    double last_moment;          // the moment of it that was drawn last, in frames
    uint32_t samples;            // moments that a frame is averaged of (effect_set_samples); 0: one
    uint32_t moment;             // which of these is drawn, from 0
    double shutter;              // frames that they are spread over
    bool wants_antialias;        // effect_set_antialias
    bool antialiased;            // effect_antialias
    graph_image antialias_depth; // that it gathers by; zero: none
    double updated;              // frame that `update` ran for last; NAN: none
    double rendered_at;          // clock_seconds at its end
    bool behind;                 // simulations have not reached the frame rendered last
    uint64_t
        ahead; // the submission simulated last before the frame; 0: none, or its times are known
    gpu_pass_time *ahead_times; // of those before it, by label
    size_t ahead_count, ahead_capacity;
    bool stepped;  // they went on since then (effect_catch_up) ...
    double partly; // ... and some of the steps of this frame were done; NAN: of none
    bool (*progress)(void *user, double done, double whole); // effect_on_progress
    void *progress_user;
    effect_given given;
    float jitter[2], last_jitter[2]; // of a host's camera, parts of the picture
    shared_mat4 clip, last_clip;     // world to clip of the frame being recorded, of the one before
    bool only_simulates;             // effect_only_simulate
    uint32_t in_a_row;               // frames before the last one that histories tell of
    bool has_last;                   // there is one before, of which histories tell
    bool compiled, allocated;
    uint32_t reference; // effect_desc
    bool never_waits;   // effect_desc
    bool unseen;        // its pictures are not drawn
    effect_snapshots snapshots;
    const effect_setting *settings;
    bool *applied; // one per setting
    size_t setting_count;

    effect_layers **layers;
    size_t layers_count, layers_capacity;
    struct effect_shape *shapes; // things.h
    size_t shape_count, shape_capacity;
    struct effect_reading *readings;
    size_t reading_count;
    pass *probe;                            // probe.c; NULL: not made yet
    const char *no_probe;                   // why it cannot be; NULL: it can
    const struct effect_reading *probed[8]; // what it is asked for
    size_t probed_count;
    scene_node **nodes;
    size_t node_count, node_capacity;

    struct noted_place *places; // place.c
    size_t place_count, place_capacity;
    control **controls; // in the order of their list
    size_t control_count, control_capacity;
    size_t controlled;  // passes that have theirs
    size_t ramp_count;  // palettes and curves among them
    size_t field_count; // fields whose numbers are among them
    bool tiled;         // effect_add_tile was called
};

// Reports progress while frames without a picture run. False with a message: the user cancelled.
bool effect_tell_progress(effect *e, double done, double whole);

// clock.c: grids that are played at a speed that moves.
typedef struct effect_clock effect_clock;
void effect_free_clocks(effect *e);
void effect_restart_clocks(effect *e);
// Returns the next frame, up to this one, that the clocks have not counted; INFINITY: none. False
// with a message.
bool effect_aim_clocks(effect *e, double frame, double *next);
bool effect_tick(effect *e); // counts one more frame with the speeds of now
// Returns the time that a grid shows at a time of the effect.
bool effect_grid_time(const effect *e, const field_grid *grid, double now, double *out);
