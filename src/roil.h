// roil: a runtime for volumetric effects. This header and those that it includes at its end are the
// whole public interface of libroil. The program `roil` is built on it and uses nothing else.
//
//   roil *r = roil_create(&(roil_desc){0});
//   roil_effect *e = r ? roil_load(r, "effects/explosion.lua", NULL, 0) : NULL;
//   if (!e || !roil_prepare(e, 960, 540) || !roil_render(e, 30) || !roil_save(e, "30.png", NULL))
//       fprintf(stderr, "%s\n", roil_error());
//   roil_unload(e);
//   roil_destroy(r);
//
// Errors: a function that can fail returns NULL or false. roil_error() then gives the reason in one
// message that names the file, the line and the object.
//
// Threads: a roil, its effects and all objects made from them belong to the thread that called
// roil_create. Functions that take none of these, or NULL, may be called from any thread, and what
// they give by one thread at a time; each thread may have roils of its own. Callbacks are called on
// the thread that made the call, unless they say otherwise.
//
// The host's process: nothing is written to stdout or stderr (roil_set_log), no signal handler or
// locale is set, nothing is forked, and exit() is not called. Files of strangers are read by a
// child process, roil-reader, whose end the host may see as SIGCHLD, and may ignore.
//
// Out of memory is an error of the call (roil_set_allocator). What a call has begun is ended with a
// reserve of 8 MiB; what is large is asked for before. Then the call fails, and what it was to make
// is destroyed; one that counts returns 0. Calls that end no earlier than one of another thread of
// roil's that found no memory fail too. Only when the reserve is used up as well is abort() called.
//
// Arrays and strings: those passed to a function are only read during the call, unless a comment
// says otherwise. Functions that fill an array take its capacity, write at most that many elements
// and return how many there are, so that a call with a capacity of 0 counts them. Every *_desc and
// *_options struct may be zero; what 0 means is written at each field.
//
// Units: metres, seconds, degrees; z points up. Colours are linear Rec.709 unless sRGB is named.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil roil;                 // a device and the folders of the library's files
typedef struct roil_effect roil_effect;   // one loaded effect file
typedef struct roil_vulkan roil_vulkan;   // a Vulkan device of the host (roil_vulkan.h)
typedef struct roil_texture roil_texture; // 8-bit sRGB with alpha, on the device (roil_window.h)

// Semantic: programs built with a version run with later ones of the same major, or while that is 0
// of the same minor, number. roil_version is that of the library in use, such as "1.2.3"; static.
#define ROIL_VERSION_MAJOR 0
#define ROIL_VERSION_MINOR 1
#define ROIL_VERSION_PATCH 0
const char *roil_version(void);

// Returns the message of the last error of the calling thread, or "" when there was none. It is
// valid until the thread's next call of a roil function.
const char *roil_error(void);
void roil_free(void *text); // a text that a function gave for it; NULL is allowed

typedef struct roil_place {
    char file[4096]; // as the message names it
    int line;        // from 1
    int column;      // bytes, from 1: of the word at fault, else of the line's first; 0: unknown
} roil_place;
// Finds the place that a message of roil_error names ("smoke.lua:12: ..."); of several the
// innermost whose file can be read, as of a shader that the script uses. `r` knows where the
// library's own files lie, and may be NULL. False: it names none.
bool roil_find_place(const roil *r, const char *message, roil_place *out);

// ---- the host's process -------------------------------------------------------------------------

typedef enum roil_level { ROIL_DEBUG, ROIL_INFO, ROIL_WARNING, ROIL_ERROR } roil_level;
// Sets who takes messages of at least this level (`level`: a roil_level): `text` is one line or
// several, without a last newline. Called on any thread, by one at a time; it must not call roil.
// NULL: nobody, as at the start, unless $ROIL_LOG (debug, info, warning, error) asks for them on
// stderr. Any thread.
void roil_set_log(void (*write)(void *user, int level, const char *text), void *user,
                  roil_level least);

typedef struct roil_allocator {
    // As realloc of C, and at size 0 as free. Blocks are aligned to 16 bytes. NULL: there is no
    // memory. Called on any thread. The driver and libraries (libpng, OpenEXR, Jansson) do not use
    // it.
    void *(*allocate)(void *user, void *block, size_t size);
    void *user; // passed to allocate
} roil_allocator;
// Sets where the process's roils get memory; NULL: from malloc. False with a message while anything
// is allocated: call it before all other functions, or when all that they gave is destroyed. Not
// while another thread is in a function of roil.
bool roil_set_allocator(const roil_allocator *allocator);

// ---- device -----------------------------------------------------------------------------------

typedef struct roil_window_desc {  // a window to show pictures in; any window library can make it
    const char *const *extensions; // instance extensions that its Vulkan surface needs
    uint32_t extension_count;
    // Creates a VkSurfaceKHR for the VkInstance `instance` and writes it to `*surface`. Returns
    // false when that fails. Called once, by roil_create.
    bool (*create_surface)(void *user, void *instance, void *surface);
    void *user; // passed to create_surface
} roil_window_desc;

typedef struct roil_desc {
    // The host's own Vulkan device, which roil uses instead of one that it makes: `device`,
    // `validate` and `window` are then ignored. NULL: it makes one.
    const roil_vulkan *vulkan;
    // Part of a device's name, its UUID, or its number in the list of roil_info_devices. NULL: the
    // first real GPU, or a software device where there is none.
    const char *device;
    // Folder with shaders/ and scripts/. NULL: $ROIL_HOME, or else a folder found from where the
    // program lies.
    const char *home;
    // Path of the program roil-reader. It runs as a child process and reads shaders, meshes and
    // pictures. NULL: $ROIL_READER, or else the one beside the program.
    const char *reader;
    // Folders that effects may read files of, by their names there, besides the effect's own
    // folder: at most 8, ending with NULL. Those of $ROIL_ASSETS (separated by ':') come after
    // these, and then those that the file roil.json names, {"assets": ["models"]}, which lies in
    // the effect's folder or above it, and whose folders lie below it. Of several files of a name
    // the first counts. NULL: none.
    const char *const *assets;
    bool no_device;     // use no device: effects can only be loaded and checked
    bool no_cache;      // do not read or write compiled shaders on disk
    bool validate;      // enable Vulkan's validation layers; $ROIL_VALIDATE=1 does too
    bool counters;      // count samples (roil_counters); costs a little time
    uint32_t reference; // above 0: passes `march` of effects are replaced by a path tracer without
                        // approximations, up to this many samples per pixel (roil_samples)
    // Seconds that a frame may take on the device before the device counts as lost. 0: 30, or 300
    // on a software device.
    double timeout;
    // Limit on the memory taken from the host, and from the device where it has its own: a share
    // such as "60%", or an amount such as "512M" or "8G". NULL: "60%". An effect that needs more is
    // refused with a message that names the sum and its three largest parts. The limit belongs to
    // the process: the last roil_create that sets it decides.
    const char *memory;
    // Limit on what this roil takes of the device's memory, besides that one: "512M", "2G". An
    // effect that needs more fails in roil_prepare, with such a message; what is only ahead of its
    // time becomes less. NULL: none.
    const char *device_memory;
    // Called ten times a second, on the thread of roil_create, while that thread waits for a frame
    // that has taken more than a second. `seconds` is the time waited so far. Returning false gives
    // up the device, which is then lost. May be NULL.
    bool (*waiting)(void *user, double seconds);
    // Called on the thread that loads an effect, while it reads the files of a sequence, with the
    // number of files read and to be read. Returning false cancels the load, which then fails. May
    // be NULL.
    bool (*loading)(void *user, double done, double whole);
    void *user; // passed to waiting and loading
    // Seconds that a load may take, and again its compilation, by the clock; other threads and
    // processes that work for it may use eight times as much in sum. The script of one frame may
    // use a tenth of both. 0: 120.
    double time_limit;
    const roil_window_desc *window; // NULL: no window
    // A frame never waits for data. Where a sequence has not decoded its frame yet, the nearest
    // decoded one is drawn instead (roil_playback.late); where a simulation has not caught up, an
    // earlier state is drawn (roil_simulation.waiting). For players.
    bool never_waits;
    // Flows in slices can be changed by roil_slices.h. Each of their steps takes a little longer.
    bool interaction;
} roil_desc;

roil *roil_create(const roil_desc *desc); // NULL with a message
void roil_destroy(roil *r);               // its effects must be unloaded before; NULL is allowed

// Returns false once a device was abandoned because it hangs. exit() could then wait for it forever
// or free memory that it still uses, so the process must end with _exit().
bool roil_can_exit(void);
const char *roil_device_name(const roil *r);
const char *roil_device_driver(const roil *r);
bool roil_wants_preview(const roil *r); // its live pictures had better begin at less than full size
bool roil_is_software(const roil *r);   // the device is the processor; false without one
// Returns whether roil_show never waits for effects, with never_waits: a device draws the window,
// another one like it the effects.
bool roil_shows_apart(const roil *r);
uint64_t roil_validation_messages(const roil *r);
const char *roil_home(const roil *r); // the folder with shaders/ and scripts/
// For effects that are loaded from now on: as `counters` and `reference` of roil_desc.
void roil_set_counters(roil *r, bool counters);
void roil_set_reference(roil *r, uint32_t samples);
// Returns true when the device hangs or is gone. Nothing can be drawn any more: unload the effects
// and call roil_destroy.
bool roil_is_lost(const roil *r);
// Returns how many pieces of work the effects' device has not finished. Never waits. Who asks again
// and again finds a device that has finished nothing for roil_desc.timeout lost.
uint64_t roil_pending(roil *r);
void roil_give_up(roil *r); // what it works on takes too long: the device is then lost

typedef struct roil_memory {
    uint64_t device, reserved; // bytes in use on the device, and allocated from the driver
    // Bytes counted against roil_desc.memory, and the limit. They are the device's where it has
    // memory of its own; else device and host share one account. Without a device: the host's.
    uint64_t sum, limit;
    struct {
        char label[64];
        uint64_t bytes; // 0: fewer parts than three
    } largest[3];
} roil_memory;
roil_memory roil_get_memory(const roil *r);

// ---- effects ----------------------------------------------------------------------------------

typedef struct roil_setting { // "steps" = "64", "march.mode" = "paper", "tint" = "#ff8000"
    const char *name, *value;
} roil_setting;

// Runs an effect file, or the one of a bundle ("smoke.roil", roil_export.h), and returns the
// effect, or NULL with a message. `settings` (may be NULL when
// `count` is 0) replace values that the script declares, including those that change its structure.
// A name that the effect does not have is an error.
roil_effect *roil_load(roil *r, const char *file, const roil_setting *settings, size_t count);
// The same of a file that its user did not name: when it is opened it lies in `folder`, wherever
// links lead by then. NULL: roil_load.
roil_effect *roil_load_inside(roil *r, const char *folder, const char *file,
                              const roil_setting *settings, size_t count);
void roil_unload(roil_effect *e); // NULL is fine
// Lists the files that the effect has read until now, or looked for: absolute paths, which live as
// long as the effect.
size_t roil_files(const roil_effect *e, const char **out, size_t capacity);
// Compiles every shader and checks the graph, without a device.
bool roil_check(roil_effect *e);

typedef struct roil_effect_info {
    const char *name;             // this and the next two live as long as the effect
    const char *author, *licence; // NULL: it does not say
    double fps;                   // frames per second
    uint32_t first_frame, frames;
} roil_effect_info;
roil_effect_info roil_get_info(const roil_effect *e);

// Sets a control (see below) from the next frame on. A structural one, such as "march.mode", can
// only be set by roil_load or roil_live_set. On failure nothing changes.
bool roil_set(roil_effect *e, const char *name, const char *value);
bool roil_reset(roil_effect *e, const char *name); // back to the script's own value
// The same for an engine that sets many numbers in each frame: of a control by its number
// (roil_find_control), which stays the same as long as the effect. `count` is its components, 1 to
// 4: numbers in its unit, linear Rec.709 of a colour, 0 or 1 of a bool, of an enum the index of the
// word. False with a message, and nothing changes: the control has another count of numbers, or
// none (a palette, a curve, events), or one of them is out of range.
bool roil_set_floats(roil_effect *e, size_t control, const float *values, int count);

// Keeps an image of the graph, so that it can be saved or inspected: "march.color", or "march" for
// the pass's first output. Takes effect with the next roil_prepare, which preserves histories.
bool roil_keep(roil_effect *e, const char *image);
// Keeps this image and no other. NULL: none.
void roil_keep_only(roil_effect *e, const char *image);

// Averages so many pictures of each frame that roil_render draws, in linear light before the tone
// map: 1 to 65536, each with the camera moved by a part of a pixel and within its lens, at moments
// spread over `shutter` frames, 0 to 1, from the frame on. What a simulation, a sequence with
// `blend`, a curve or a function moves is blurred by its way; what a script sets frame by frame is
// not. Call it once, before roil_sheet_create and roil_prepare. False with a message, as for an
// effect with a reference.
bool roil_set_samples(roil_effect *e, uint32_t samples, double shutter);

// Compiles the effect and allocates its images for a picture size in pixels, 1 to 16384 each. Call
// it again to change the size. Pictures rendered before cannot be read any more.
bool roil_prepare(roil_effect *e, uint32_t width, uint32_t height);
// Renders one frame and returns once it is submitted. Histories (images that passes keep from frame
// to frame) are cleared unless `frame` follows the last rendered frame.
bool roil_render(roil_effect *e, double frame);
// Renders one frame for a player, whose steps are uneven: histories are preserved. `frame` may be
// the last one again.
bool roil_advance(roil_effect *e, double frame);

// Returns the samples per pixel that the last frame has gathered, where it is path traced; another
// roil_advance to the same frame adds more. 0: the picture is not path traced.
uint32_t roil_samples(const roil_effect *e);

// A number that moved beyond its range, or lengths that do not fit together, as where a file's unit
// is no metre, since the load or since a control was last set; NULL: nothing. It was logged too,
// once.
const char *roil_warning(const roil_effect *e);

// Simulations advance from frame to frame in steps of their own. When a rendered frame does not
// follow the last one, the skipped frames are simulated first: from the last frame on, or from the
// beginning when time went back. With roil_desc.never_waits this work is spread over several calls
// of roil_advance, and going back starts from the nearest of the snapshots that are kept about
// every second, as long as no number was changed since it was taken.
typedef struct roil_simulation {
    bool waiting;   // the last rendered frame shows an earlier state: render it again (never_waits)
    double reached; // time of the effect that is simulated, seconds; -INFINITY: none yet
    const char *trouble; // what went wrong and which key to change; NULL: nothing
    const char *pass;    // the pass in trouble
} roil_simulation;
bool roil_get_simulation(const roil_effect *e, roil_simulation *out); // false: nothing simulates
// Begins a part of the steps that simulations need to come to a frame, and returns at once. `more`
// receives whether there was something to begin: the frame, drawn by roil_advance, would show an
// earlier state. Snapshots are kept on the way. With roil_desc.never_waits.
bool roil_catch_up(roil_effect *e, double frame, bool *more);
// Lists the frames of which a window has kept a snapshot, in rising order.
size_t roil_snapshots(const roil_effect *e, double *frames, size_t capacity);
// A branch goes on from a state, whatever numbers are set afterwards, and has snapshots of its own.
// roil_branch_begin makes one of the state after the last frame; NULL with a message: nothing
// simulates, or there is no memory. roil_branch_leave takes the effect's snapshots, so that numbers
// can be set without losing them. roil_branch_enter gives it those of a branch, which is gone then;
// the next frame starts from them. NULL: from none. A branch outlives effects, not the roil.
typedef struct roil_branch roil_branch;
roil_branch *roil_branch_begin(roil_effect *e);
roil_branch *roil_branch_leave(roil_effect *e);
void roil_branch_enter(roil_effect *e, roil_branch *b);
void roil_branch_destroy(roil_branch *b); // NULL is allowed
void roil_restart(roil_effect *e); // simulations start from the beginning with the next frame

// From now on roil_render brings simulations to a frame and draws no picture: for checkpoints.
void roil_only_simulate(roil_effect *e);
// Writes the state of all simulations after the last frame to a file. On failure there is no file,
// or the previous one.
bool roil_checkpoint(roil_effect *e, const char *file);
// Loads such a state, after roil_prepare. The frames that follow are those of a run that was never
// interrupted. `frame` (may be NULL) receives the frame that was rendered last before the state was
// saved. A file that does not fit the effect is refused with a message that names the difference;
// simulations then start from the beginning.
bool roil_restore(roil_effect *e, const char *file, double *frame);

// Sets a callback, or removes it (NULL). Called while skipped frames are simulated, with the steps
// done and the steps needed, and while the script runs skipped frames, with the frames done and the
// frames needed. Returning false cancels the frame, whose rendering then fails.
void roil_on_progress(roil_effect *e, bool (*call)(void *user, double done, double whole),
                      void *user);

typedef struct roil_readout { // a value that a pass reports: "Mach", "time step"
    const char *pass, *name, *unit;
    double value;
} roil_readout;
// After roil_prepare. Values that the script reports by fx:status come last, with the pass
// "effect". Strings live until the next frame.
size_t roil_readouts(roil_effect *e, roil_readout *out, size_t capacity);

typedef struct roil_time { // time of a pass on the GPU in the last frame
    char pass[64];
    double milliseconds;
} roil_time;
typedef struct roil_counter { // a counter of a pass in the last frame (roil_desc.counters)
    char pass[64], name[64];
    uint64_t value;
} roil_counter;
// Both wait for the last frame. Parts of a pass that have one name are added up; times have what
// was simulated for the frame in submissions before it, except in a live effect.
size_t roil_times(roil_effect *e, roil_time *out, size_t capacity);
size_t roil_counters(roil_effect *e, roil_counter *out, size_t capacity);

typedef struct roil_playback {  // all sequences of an effect, since they were opened
    uint64_t shown;             // how often a new frame of a sequence was shown
    uint64_t late;              // rendered frames that show another frame instead (never_waits)
    uint64_t decoded, uploaded; // frames
    uint64_t decoded_bytes, uploaded_bytes; // size as stored on the device
    double decode_seconds;                  // processor time of all threads together
    uint32_t threads;                       // threads that decode ahead
    uint64_t device_bytes;                  // size of their textures now
    uint64_t frame_bytes, frame_voxels;     // bytes and nonzero voxels of the largest frame
    bool waiting; // the last rendered frame shows another frame: render it again
} roil_playback;
bool roil_get_playback(const roil_effect *e, roil_playback *out); // false: it has no sequence

// ---- pictures ---------------------------------------------------------------------------------

// Reads the picture of the last frame, rows from the top: `out` must hold width * height * 4 bytes,
// sRGB, opaque or with straight alpha. Values are rounded to the nearest code, for measurements;
// PNG files of 8 bits, videos and roil_show are dithered. Waits for the device.
bool roil_read(roil_effect *e, bool alpha, uint8_t *out);

typedef struct roil_save_options {
    const char *image; // an image that was kept; NULL: the effect's picture
    bool alpha;        // PNG: write straight alpha, colours divided by it. Bright light with little
                       // alpha, such as fire, is clipped at white
    bool premultiplied; // PNG: write alpha with colours as they appear on black. Nothing is
                        // clipped, but whoever composes the picture must know. Wins over `alpha`
    bool sixteen;       // PNG: 16 bits per channel instead of 8
    bool full;          // EXR: 32-bit float instead of half
    bool shown; // EXR: the tone-mapped picture, still linear, instead of the scene-linear one
} roil_save_options;
// Saves the last frame and returns when the file is written. A .png file is display-referred sRGB
// and holds a recipe (see below) of how it was made. An .exr file is scene-linear, with alpha in A,
// and depth (m) in Z where the effect has it. Missing folders are created. `options` may be NULL.
bool roil_save(roil_effect *e, const char *file, const roil_save_options *options);

// Saves many pictures: roil_writer_save reads the last frame back, and other threads encode and
// write the file while the next frame is drawn. It blocks while many pictures wait for that, and
// also returns false when an earlier picture failed.
typedef struct roil_writer roil_writer;
roil_writer *roil_writer_create(void);
bool roil_writer_save(roil_writer *w, roil_effect *e, const char *file,
                      const roil_save_options *options);
bool roil_writer_finish(roil_writer *w); // waits for all files and frees `w`; NULL is allowed

// Returns whether a .png or .exr file can be read to its end. False with a message.
bool roil_is_whole(const char *file);

typedef struct roil_recipe { // how a picture was made
    // The effect's file as it was given. NULL: it lies outside of the current folder; a picture
    // from a stranger must not open a file that the user did not name.
    const char *effect;
    double frame;
    uint32_t width, height;
    const roil_setting *settings; // every control that differs from the script
    size_t setting_count;
} roil_recipe;
roil_recipe *roil_read_recipe(const char *png); // free with roil_free_recipe; NULL: it holds none
void roil_free_recipe(roil_recipe *r);          // NULL is allowed

// Every picture, film, volume and sheet says in a line of JSON how it was made; `roil repro` makes
// it again.
typedef struct roil_made {
    const char *kind;         // "picture", "film", "volume", "sheet"
    const char *sheet, *part; // of a sheet the names of its first file and of this one; else ""
    const char *version;      // of roil
    const char *effect;       // as in roil_recipe
    const char *device, *driver;
    const char *inputs; // a hash of all files that the effect had read, wherever they lay
    double frame, first, last, step; // frames: of a volume those that its box was chosen by
    uint32_t width, height;
    const roil_setting *settings;
    size_t setting_count;
    const char *const *options; // of `roil render`, `roil export vdb` or `sheet`, "--warmup=3"
    size_t option_count;
} roil_made;
roil_made *roil_read_made(const char *file); // of a stranger, too; NULL with a message
void roil_free_made(roil_made *m);           // NULL is allowed
// The hash of all files that an effect has read, as its outputs have it; lives as long. NULL
// without memory.
const char *roil_hash_inputs(roil_effect *e);

typedef struct roil_video roil_video;
// Begins a film of the effect's pictures in their size now: .mp4, .webm (VP9), .mov (ProRes 4444),
// .gif or .apng. `alpha`: straight, as these formats define it; an .mp4 keeps none.
roil_video *roil_video_create(roil_effect *e, const char *file, double fps, bool alpha);
bool roil_is_film(const char *file);    // its extension is one of these
bool roil_video_add(roil_video *v);     // adds the last frame; another thread encodes it
bool roil_video_finish(roil_video *v);  // completes the file and frees `v`
void roil_video_abandon(roil_video *v); // frees `v` and leaves no file; NULL is allowed

// ---- controls: everything of an effect that can be set by name --------------------------------

typedef enum roil_type {
    ROIL_FLOAT,
    ROIL_INT,
    ROIL_BOOL,
    ROIL_ENUM,
    ROIL_VECTOR, // 2 to 4 components
    ROIL_COLOR,  // linear Rec.709
    ROIL_PALETTE,
    ROIL_CURVE,
    ROIL_EVENTS, // "effect.events"
} roil_type;

typedef struct roil_control { // strings live as long as the effect
    const char *name;  // as roil_set takes it: "density", "march.steps", "sun.azimuth", "fire"
    const char *label; // the part after the dot
    const char *group; // of a parameter: as declared, "" for none; else the part before the dot
    bool parameter;    // declared by the script, for its users
    bool field;        // a number that a field was given, such as "lumps.frequency"
    size_t layer;      // of layers of noise: which of the group's, from 1; 0: of none
    bool object;       // of a light, a material, a node, a mesh, a volume: "lamp.power"
    roil_type type;
    int components;
    float value[4];   // now: of bool 0 or 1, of enum its index; of palette and curve nothing
    float initial[4]; // by the script
    float min, max;   // of each component; -INFINITY, INFINITY when not given
    const char *unit, *help;
    const char *const *words; // of an enum
    size_t word_count;
    bool log_scale;  // its bar had better be logarithmic: the script says so, or the range is wide
    bool structural; // a change loads the effect anew (roil_live does)
    bool driven; // the script moves it, by a curve, a function or a parameter; setting it ends that
    bool moved;  // differs from the script, by a setting
} roil_control;

// Controls are listed in this order: parameters as declared; palettes and curves; camera, sun, sky,
// lights, materials, nodes and meshes; numbers of fields; places of volumes; then the uniforms and
// options of each pass.
size_t roil_control_count(const roil_effect *e);
void roil_get_control(roil_effect *e, size_t index, roil_control *out); // index below the count
// Finds a control by name. Returns false with a message, which suggests a similar name.
bool roil_find_control(roil_effect *e, const char *name, size_t *index);
// Return the value of now as text: as roil_set takes it, and as Lua to be pasted into the effect.
// Free it with roil_free. NULL with a message: there is no such control.
char *roil_control_text(roil_effect *e, const char *name);
char *roil_control_lua(roil_effect *e, const char *name);

enum { ROIL_MAX_STOPS = 64 };
typedef struct roil_stop {
    float at;       // position in the palette's range
    float color[4]; // linear Rec.709, may exceed 1; then alpha, 0 to 1
} roil_stop;
typedef struct roil_palette {
    roil_stop stops[ROIL_MAX_STOPS]; // in rising order; of a palette with keys, those of the first
    size_t count;                    // 0: a blackbody palette
    float min, max;                  // the range that it covers
    bool keyed;                      // it changes over time
} roil_palette;
typedef struct roil_key {
    float time; // seconds; of a curve over age 0 (birth) to 1 (death)
    float value[4];
} roil_key;
typedef struct roil_curve {
    roil_key keys[ROIL_MAX_STOPS]; // in strictly rising order of time
    size_t count;
    int components;    // used of each value, 1 to 4
    const char *shape; // "step", "linear", "cubic", "ease_in", "ease_out", "ease_in_out"; static
    float period;      // seconds after which it repeats; 0: it does not
    bool over_age;     // its times are a particle's age; its shape is "linear"
} roil_curve;
// False with a message: there is no palette or curve of that name.
bool roil_get_palette(roil_effect *e, const char *name, roil_palette *out);
bool roil_get_curve(roil_effect *e, const char *name, roil_curve *out);
// Evaluate `count` colours evenly spaced over the palette's range at a time (s), and a curve at
// `count` times.
bool roil_sample_palette(roil_effect *e, const char *name, double time, float (*out)[4],
                         size_t count);
bool roil_sample_curve(roil_effect *e, const char *name, const double *times, float (*out)[4],
                       size_t count);
// Return the text that roil_set takes: "0 #000000; 0.5 #7a1500 0.5; 1 4,2,0.5" (position, then a
// colour as sRGB or as three linear numbers, then alpha), and "cubic 0 1; 2.5 0,1,0" (shape, then
// time and value of each key). Free it with roil_free.
char *roil_palette_text(const roil_palette *palette);
char *roil_curve_text(const roil_curve *curve);

typedef struct roil_camera {
    float eye[3], target[3];    // metres
    float fov;                  // vertical, degrees
    float orthographic;         // height of what it sees (m), whatever `fov` says; 0: perspective
    float distance, yaw, pitch; // of the eye from the target, as of orbit { } (m, degrees)
} roil_camera;
// Returns the camera of the last frame. Its controls are "camera.eye", "camera.target",
// "camera.fov" and "camera.orthographic".
bool roil_get_camera(roil_effect *e, roil_camera *out);
// Returns the box that encloses the effect's volumes (m). False: it has none.
bool roil_get_bounds(roil_effect *e, float low[3], float high[3]);
// Returns whether a point (m) of the last frame lies below the ground: a mesh that is open below
// and not an instance. `height` receives the height (m) of the ground there.
bool roil_is_under_ground(roil_effect *e, const float at[3], float *height);

// ---- events: key presses and clicks that an effect's script handles ----------------------------
// All events of an effect form one control, "effect.events", in rising order of time:
// "2.5 click 0.4 0.6; 3 key f; 4 key f 12 -3 0". Each has a time (s), a name, and a place: two
// numbers are a position in the picture, 0 to 1 from the top left; three a point (m); six the
// origin and direction of a ray. Like any control they can be set and reset, and a picture's recipe
// holds them.
//
// The result of an event does not depend on which frames are drawn: the script also runs the frames
// that are skipped, and going back in time runs it from the beginning. A checkpoint holds no
// events; after roil_restore the script runs from the first frame on.

typedef struct roil_hotkey { // strings live as long as the effect
    const char *key;         // "f", "space"; "": clicks
    const char *help;
} roil_hotkey;
// Lists what the script handles.
size_t roil_hotkeys(const roil_effect *e, roil_hotkey *out, size_t capacity);
// Returns the text of all events with one more, as roil_set takes it: at the time of the last
// frame, along the camera's ray through x, y (0 to 1 from the top left). key "": a click. Free it
// with roil_free. NULL with a message: there is no room for another event.
char *roil_event_text(roil_effect *e, const char *key, float x, float y);

// ---- presets: named values in a small Lua file, "explosion.presets/NAME.lua" beside the effect --

typedef struct roil_preset { // what a preset sets
    roil_setting *settings;
    size_t count;
} roil_preset;
// Reads a preset, given by its name or by the path of a .lua file. Free it with roil_free_preset.
roil_preset *roil_read_preset(roil *r, const char *effect_file, const char *preset);
void roil_free_preset(roil_preset *preset); // NULL is allowed
// Writes every control that was changed, except for the camera and the events. Replaces a preset of
// that name. A name has letters, digits, _ and -.
bool roil_write_preset(roil_effect *e, const char *name);
// Lists the names of an effect's presets, sorted. Any thread.
size_t roil_presets(const char *effect_file, char (*names)[64], size_t capacity);

// ---- comparison -------------------------------------------------------------------------------

typedef struct roil_comparison {
    const char *a, *b;        // .png or .exr files of the same size
    float exposure;           // applied to .exr files, stops, -64 to 64
    double pixels_per_degree; // FLIP's viewing distance, 1 to 1000; 0: 67
    // .png file to write: FLIP of each pixel, from black (0) to pale yellow (1). May be NULL.
    const char *difference;
    const char *beside; // .png file to write: a, b and that picture side by side. May be NULL
} roil_comparison;
typedef struct roil_difference {
    uint32_t width, height;
    double psnr; // dB over R, G and B with a peak of 1; INFINITY: equal
    double ssim; // mean over the luma; 1: equal
    double flip; // mean of LDR-FLIP; 0: equal, 1: the maximum
} roil_difference;
// Compares two files as sRGB pictures on a display. EXR files are exposed, clamped to 0 to 1 and
// encoded, without an effect's tone mapping; PNG files with alpha are shown on black, as EXR files
// are. Needs no device. Any thread.
bool roil_compare(const roil_comparison *how, roil_difference *out);

#ifdef __cplusplus
}
#endif

#include "roil_edits.h"  // what was set, written into the script
#include "roil_export.h" // volumes and sheets for other programs
#include "roil_graph.h"  // passes and images, shown
#include "roil_host.h"   // an effect in the picture of a host's renderer
#include "roil_info.h"   // what there is to be asked for
#include "roil_live.h"   // an effect that is rebuilt when its files change
#include "roil_slices.h" // flows in slices, shown and changed
#include "roil_space.h"  // where things are, and what moves them
#include "roil_window.h" // the content of a window
