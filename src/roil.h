// roil: a runtime for volumetric effects. This is, with roil_slices.h, which it includes, the whole
// public interface of libroil; the program `roil` does everything through it.
//
//   roil *r = roil_create(&(roil_desc){0});
//   roil_effect *e = r ? roil_load(r, "effects/explosion.lua", NULL, 0) : NULL;
//   if (!e || !roil_prepare(e, 960, 540) || !roil_render(e, 30) || !roil_save(e, "30.png", NULL))
//       fprintf(stderr, "%s\n", roil_error());
//   roil_unload(e);
//   roil_destroy(r);
//
// Functions that can fail return NULL, false or a negative number; roil_error() then says why, in
// one message that names file, line and object. A roil and its effects belong to one thread.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil roil;               // a device, and where things are found
typedef struct roil_effect roil_effect; // one loaded effect file

const char *roil_version(void);
const char *roil_error(void); // of the calling thread; "" when there was none

// ---- device -----------------------------------------------------------------------------------

typedef struct roil_window_desc {  // a window to show effects in, whichever library made it
    const char *const *extensions; // of the Vulkan instance, that its surface needs
    uint32_t extension_count;
    // Makes the VkSurfaceKHR `*surface` for the VkInstance `instance`; false when it cannot.
    bool (*create_surface)(void *user, void *instance, void *surface);
    void *user;
} roil_window_desc;

typedef struct roil_desc {
    const char *device; // part of a device's name, or its number; NULL: a real GPU before software
    const char *home; // folder that holds shaders/ and scripts/; NULL: $ROIL_HOME, else found from
                      // where the program lies
    const char *reader; // the program roil-reader, a child process that reads shaders, meshes and
                        // pictures; NULL: $ROIL_READER, else beside the program
    bool no_device;     // only load and check effects
    bool no_cache;      // neither read nor write compiled shaders on disk
    bool validate;      // Vulkan validation layers; also by $ROIL_VALIDATE=1
    bool counters;      // count samples (see roil_counters); costs a little time
    uint32_t reference; // above 0: passes `march` of effects are traced instead, without
                        // approximations, to that many samples a pixel (roil_samples)
    double timeout; // seconds that a frame may take on the device before it counts as lost; 0: 30,
                    // 300 on a software device
    // What may be taken of the host's memory, and of the device's: a share, "60%" (NULL), or an
    // amount, "512M" or "8G". What an effect wants beyond that is refused with a message that has
    // the sum and its largest parts. Of the whole process: the last roil that says it decides.
    const char *memory;
    // Called ten times a second by the thread of roil_create, while that waits for a frame that
    // takes the device longer than a second. False gives the device up: it is lost. May be NULL.
    bool (*waiting)(void *user, double seconds);
    // Called by the thread that loads, while it reads the files of a sequence: how many it has
    // read, and has to read. False gives the load up, which fails then. May be NULL.
    bool (*loading)(void *user, double done, double whole);
    void *user;        // of both
    double time_limit; // seconds that a load may take, and then its compiling: its script and all
                       // that works for it, by the clock; eight times as many of other threads and
                       // processes; the script of a frame gets a tenth of both. 0: 120
    const roil_window_desc *window; // NULL: nothing is shown
    bool never_waits; // no frame waits for a frame of a sequence that is not decoded yet: the
                      // nearest one that is stands in for it (roil_playback.late)
    bool interaction; // flows in slices can be touched (roil_slices.h); each of their steps takes a
                      // little longer then
} roil_desc;

roil *roil_create(const roil_desc *desc);
void roil_destroy(roil *r); // after its effects; NULL is fine
// False once a device was left behind because it hangs or cannot be waited for: exit() may then
// wait for it without end, or free what it works with. End the process by _exit().
bool roil_can_exit(void);
const char *roil_device_name(const roil *r);
const char *roil_device_driver(const roil *r);
bool roil_wants_preview(const roil *r); // its live pictures had better begin at less than full size
uint64_t roil_validation_messages(const roil *r);
const char *roil_home(const roil *r); // the folder with shaders/ and scripts/
// For effects that are loaded from now on: as `counters` and `reference` of roil_desc.
void roil_set_counters(roil *r, bool counters);
void roil_set_reference(roil *r, uint32_t samples);
bool roil_is_lost(const roil *r); // the device hangs or is gone: only roil_destroy is left to do

typedef struct roil_memory {
    uint64_t device, reserved; // bytes in use on the device, and taken from the driver
    // The account that roil_desc.memory limits. Where device and host share their memory it is one;
    // else these are the device's, unless there is none.
    uint64_t sum, limit;
    struct {
        char label[64];
        uint64_t bytes; // 0: there are no more
    } largest[3];
} roil_memory;
roil_memory roil_get_memory(const roil *r);

// ---- effects ----------------------------------------------------------------------------------

typedef struct roil_setting { // "steps" = "64", "march.mode" = "paper", "tint" = "#ff8000"
    const char *name, *value;
} roil_setting;

// Runs the effect file. Settings override what it declares, structure included; a name that the
// effect does not have is an error.
roil_effect *roil_load(roil *r, const char *file, const roil_setting *settings, size_t count);
// The same of a file that its user did not name: when it is opened it lies in `folder`, wherever
// links lead by then. NULL: roil_load.
roil_effect *roil_load_inside(roil *r, const char *folder, const char *file,
                              const roil_setting *settings, size_t count);
void roil_unload(roil_effect *e); // NULL is fine
// Compiles every shader and checks the graph, without a device.
bool roil_check(roil_effect *e);

typedef struct roil_effect_info {
    const char *name;
    double fps;
    uint32_t first_frame, frames;
} roil_effect_info;
roil_effect_info roil_get_info(const roil_effect *e);

// Sets a control (below); takes effect with the next frame. What is structure ("march.mode") can
// only be set when the effect is loaded.
bool roil_set(roil_effect *e, const char *name, const char *value);
bool roil_reset(roil_effect *e, const char *name); // to what the script says

// Keeps an image of the graph ("march.color", or "march" for its first) so that it can be saved or
// inspected. Takes effect with the next roil_prepare, which keeps histories.
bool roil_keep(roil_effect *e, const char *image);
void roil_keep_only(roil_effect *e, const char *image); // no others any more; NULL: none at all
// Compiles and allocates for a picture size, 1 to 16384 each; again for a new size. What was
// rendered before cannot be read any more.
bool roil_prepare(roil_effect *e, uint32_t width, uint32_t height);
// Renders one frame; returns when it is submitted. Histories (what passes keep from frame to frame)
// start anew unless `frame` is the one after the last.
bool roil_render(roil_effect *e, double frame);
// The same for a player, whose steps are uneven: histories go on; `frame` may be the last one
// again.
bool roil_advance(roil_effect *e, double frame);

// Samples a pixel that the last frame has gathered where it is traced; roil_advance to the same
// frame adds to them. 0: nothing in the picture is.
uint32_t roil_samples(const roil_effect *e);

// A number that moved beyond its range, or lengths that do not fit together, as where a file's unit
// is no metre, since the load or since a control was last set; NULL: nothing. It was logged too,
// once.
const char *roil_warning(const roil_effect *e);

typedef struct roil_simulation { // what goes on from frame to frame in steps of its own
    bool waiting;   // the last rendered frame shows an earlier state: render it again (never_waits)
    double reached; // seconds of the effect; -INFINITY: nothing yet
    const char *trouble; // which key to change; NULL: none
    const char *pass;    // of the trouble
} roil_simulation;
// A frame that does not follow the last has the frames between simulated first: from the last one
// on, or, back in time, from the beginning. One that never waits does that over several frames, and
// goes back to one of the snapshots that it keeps, about a second apart, while numbers stay as they
// are.
bool roil_get_simulation(const roil_effect *e, roil_simulation *out); // false: nothing simulates
void roil_restart(roil_effect *e); // simulations begin anew with the next frame
// The state of all that simulates, after the last frame, as one file: there whole or not at all.
// And back, after roil_prepare: the next frames are then those of a run that never stopped. `frame`
// (NULL is fine) is the one rendered last before it was saved. A file that does not fit the effect
// is refused with a message that says what differs; simulations then begin anew.
bool roil_checkpoint(roil_effect *e, const char *file);
bool roil_restore(roil_effect *e, const char *file, double *frame);
// Is told, while frames that were left out are simulated, of the steps done and wanted,
// or of frames that the script ran. When it returns false the frame is given up, and
// fails.
void roil_on_progress(roil_effect *e, bool (*call)(void *user, double done, double whole),
                      void *user);

typedef struct roil_readout { // what a pass tells of itself: "Mach", "time step"
    const char *pass, *name, *unit;
    double value;
} roil_readout;
// After roil_prepare; returns how many there are. At most `capacity` are written. What the script
// says by its fx:status comes last, as of the pass "effect".
size_t roil_readouts(roil_effect *e, roil_readout *out, size_t capacity);

typedef struct roil_time { // GPU time of a pass in the last frame
    char pass[64];
    double milliseconds;
} roil_time;
typedef struct roil_counter { // what a pass counted in the last frame, if counters are on
    char pass[64], name[64];
    uint64_t value;
} roil_counter;
// A pass that is several pieces of work under one name counts as one. Both wait for the frame and
// return how many there are; at most `capacity` are written.
size_t roil_times(roil_effect *e, roil_time *out, size_t capacity);
size_t roil_counters(roil_effect *e, roil_counter *out, size_t capacity);

typedef struct roil_playback {  // of all sequences of an effect, since they were opened
    uint64_t shown;             // frames of theirs that came on
    uint64_t late;              // rendered frames that show another one instead (never_waits)
    uint64_t decoded, uploaded; // frames
    uint64_t decoded_bytes, uploaded_bytes; // as they lie on the device
    double decode_seconds;                  // of processor time, all threads together
    uint32_t threads;                       // that decode ahead
    uint64_t device_bytes;                  // of their textures now
    uint64_t frame_bytes, frame_voxels;     // of the largest frame: what it takes, what is not 0
    bool waiting; // the last rendered frame shows another one: render it again
} roil_playback;
bool roil_get_playback(const roil_effect *e, roil_playback *out); // false: it has no sequence

// ---- pictures ---------------------------------------------------------------------------------

// Picture of the last frame: width * height * 4 bytes, sRGB, opaque or with straight alpha. Values
// are rounded to the nearest code, for what measures; PNG files of 8 bits, videos and roil_show are
// dithered, for eyes.
bool roil_read(roil_effect *e, bool alpha, uint8_t *out);

typedef struct roil_save_options {
    const char *image;  // NULL: the effect's picture; else an image that was kept
    bool alpha;         // PNG: keep alpha, colours divided by it (straight), as PNG has it: light
                        // over little cover, as of fire, is cut off at white
    bool premultiplied; // PNG: keep alpha, colours as they lie on black, so that nothing is cut
                        // off; who lays them over something has to be told
    bool sixteen;       // PNG: 16 bits a channel
    bool full;          // EXR: 32-bit float; else half
    bool shown; // EXR: the tone-mapped picture, still linear, in place of the scene-linear one
} roil_save_options;
// PNG files hold a recipe (below) of how they were made.
// .png: display-referred sRGB; .exr: scene-linear with A, and depth as Z where the effect gives it.
bool roil_save(roil_effect *e, const char *file, const roil_save_options *options);

// The same for many pictures: reads the last frame back and leaves the file to other threads, while
// the next frame is drawn. Waits while many pictures wait. False also when an earlier one failed.
typedef struct roil_writer roil_writer;
roil_writer *roil_writer_create(void);
bool roil_writer_save(roil_writer *w, roil_effect *e, const char *file,
                      const roil_save_options *options);
bool roil_writer_finish(roil_writer *w); // when all is written; frees; NULL is fine

typedef struct roil_recipe { // what made a picture
    const char *effect; // its file, as it was given; NULL: outside of the current folder, so that
                        // a stranger's picture has it opened only by a user who names it
    double frame;
    uint32_t width, height;
    const roil_setting *settings; // all that differs from the script
    size_t setting_count;
} roil_recipe;
roil_recipe *roil_read_recipe(const char *png); // NULL when the file holds none
void roil_free_recipe(roil_recipe *r);          // NULL is fine

typedef struct roil_video roil_video;
roil_video *roil_video_create(roil_effect *e, const char *file, double fps); // .mp4
bool roil_video_add(roil_video *v);     // the last frame of its effect; encoded on another thread
bool roil_video_finish(roil_video *v);  // writes the file; frees
void roil_video_abandon(roil_video *v); // frees, leaves no file; NULL is fine

// ---- controls: all of an effect that can be turned --------------------------------------------

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
    roil_type type;
    int components;
    float value[4];   // now: of bool 0 or 1, of enum its index; of palette and curve nothing
    float initial[4]; // by the script
    float min, max;   // of each component; -INFINITY, INFINITY when not given
    const char *unit, *help;
    const char *const *words; // of an enum
    size_t word_count;
    bool log_scale;
    bool structural; // a change loads the effect anew (roil_live does)
    bool driven; // the script moves it, by a curve, a function or a parameter; setting it ends that
    bool moved;  // differs from the script, by a setting
} roil_control;

// Parameters in order of declaration, palettes and curves of the script, then camera, sun, sky and
// lights, then uniforms and options pass by pass.
size_t roil_control_count(const roil_effect *e);
void roil_get_control(roil_effect *e, size_t index, roil_control *out);
bool roil_find_control(roil_effect *e, const char *name, size_t *index); // false with a message
// As roil_set takes it; and as Lua to be pasted into the effect. Free with roil_free.
char *roil_control_text(roil_effect *e, const char *name);
char *roil_control_lua(roil_effect *e, const char *name);

enum { ROIL_MAX_STOPS = 64 };
typedef struct roil_stop {
    float at;       // position, in the palette's range
    float color[4]; // linear Rec.709, any brightness; alpha
} roil_stop;
typedef struct roil_palette {
    roil_stop stops[ROIL_MAX_STOPS]; // rising; of a keyed palette those of its first key
    size_t count;                    // 0: blackbody
    float min, max;                  // the range that it covers
    bool keyed;                      // moves in time
} roil_palette;
typedef struct roil_key {
    float time; // seconds, or of a curve over age: 0 to 1
    float value[4];
} roil_key;
typedef struct roil_curve {
    roil_key keys[ROIL_MAX_STOPS]; // strictly rising in time
    size_t count;
    int components;
    const char *shape; // "step", "linear", "cubic", "ease_in", "ease_out", "ease_in_out"
    float period;      // seconds; 0: does not repeat
    bool over_age;     // over a particle's life, not over time; its shape is "linear"
} roil_curve;
bool roil_get_palette(roil_effect *e, const char *name, roil_palette *out);
bool roil_get_curve(roil_effect *e, const char *name, roil_curve *out);
// `count` colours across its range at a time, and values of a curve at `count` times.
bool roil_sample_palette(roil_effect *e, const char *name, double time, float (*out)[4],
                         size_t count);
bool roil_sample_curve(roil_effect *e, const char *name, const double *times, float (*out)[4],
                       size_t count);
// The text that roil_set takes: "0 #000000; 0.5 #7a1500 0.5; 1 4,2,0.5" (position, colour as sRGB
// or three linear numbers, alpha), and "cubic 0 1; 2.5 0,1,0" (shape, then time and value of each
// key).
char *roil_palette_text(const roil_palette *palette);
char *roil_curve_text(const roil_curve *curve);

// Camera of the last frame, metres; "camera.eye", "camera.target", "camera.fov" are its controls.
typedef struct roil_camera {
    float eye[3], target[3];
    float fov; // vertical, degrees
} roil_camera;
bool roil_get_camera(roil_effect *e, roil_camera *out);
bool roil_get_bounds(roil_effect *e, float low[3], float high[3]); // of its volumes; false: none
// Whether a point of the last frame lies under a mesh that is open below, and so is ground (not an
// instance); then `height` is how high it is there (m).
bool roil_is_under_ground(roil_effect *e, const float at[3], float *height);

// ---- events: what happens to an effect, where its script hears it -------------------------------
// They are one control, "effect.events": "2.5 click 0.4 0.6; 3 key f; 4 key f 12 -3 0" (seconds,
// what, and where: 0 to 1 from the top left of the picture, a point in metres, or the six numbers
// of a ray). So they are set, undone and kept like any other, and a picture's recipe has them. What
// the script makes of them is the same whichever frames are drawn: frames that were left out are
// run by it, and back in time is from the beginning. A checkpoint holds none of it; after
// roil_restore the script runs from the first frame again.

typedef struct roil_hotkey { // strings live as long as the effect
    const char *key;         // "f", "space"; "": clicks
    const char *help;
} roil_hotkey;
// What the script hears; returns how many there are. At most `capacity` are written.
size_t roil_hotkeys(const roil_effect *e, roil_hotkey *out, size_t capacity);
// The events with one more, at the time of the last frame and along the ray through a place in it,
// as roil_set takes them; key "": a click. Free with roil_free. NULL when there can be no more.
char *roil_event_text(roil_effect *e, const char *key, float x, float y);

// ---- presets: named values in a small Lua file, "explosion.presets/NAME.lua" beside the effect --

typedef struct roil_preset { // what a preset sets; free with roil_free_preset
    roil_setting *settings;
    size_t count;
} roil_preset;
// `preset`: a name, or a path to a .lua file.
roil_preset *roil_read_preset(roil *r, const char *effect_file, const char *preset);
void roil_free_preset(roil_preset *preset);
bool roil_write_preset(roil_effect *e, const char *name); // all that is moved, and not the camera
size_t roil_presets(const char *effect_file, char (*names)[64],
                    size_t capacity); // sorted; the count

// ---- live: an effect that follows its files ---------------------------------------------------

typedef struct roil_live roil_live;

typedef struct roil_live_desc {
    const char *file;
    const char *const *presets; // as roil_read_preset takes them; read again when they change
    size_t preset_count;
    const roil_setting *settings; // win over presets
    size_t setting_count;
    void (*wake)(void *user); // from another thread: roil_live_update has something to do; or NULL
    void *user;
} roil_live_desc;

// Watches the effect's files and builds it in the background whenever one changes. What is broken
// from the start is watched too: NULL only when the file's folder cannot be watched.
roil_live *roil_live_create(roil *r, const roil_live_desc *desc);
// A build that runs is told to end. False: it hangs, and stays behind with the device, so that a
// roil_destroy leaves these as they are.
bool roil_live_destroy(roil_live *l); // NULL is fine
// Between frames: takes over what the background has finished, prepared for the size of the last
// one and with its histories. True when the effect or the message changed. `frame` is the one that
// will be drawn next: an effect whose `update` or functions fail there is not taken.
bool roil_live_update(roil_live *l, uint32_t width, uint32_t height, double frame);
void roil_live_wait(roil_live *l);           // until the background has nothing left to do
roil_effect *roil_live_effect(roil_live *l); // the last good one; NULL: none yet
const char *roil_live_message(roil_live *l); // why the newest is not good; NULL when it is
// Sets a control for this effect and those that follow, until the script's own value changes. What
// is structural is built in the background.
bool roil_live_set(roil_live *l, const char *name, const char *value);
bool roil_live_reset(roil_live *l, const char *name); // NULL: everything
typedef struct roil_live_count {
    uint64_t reloads, failures; // builds that were taken over, and that were not
    double last; // seconds from the event of the file to the take-over of the last build
} roil_live_count;
roil_live_count roil_live_counts(const roil_live *l);

// ---- window -----------------------------------------------------------------------------------

typedef struct roil_texture roil_texture; // 8-bit sRGB with alpha
// `rgba`: rows from the top; NULL: transparent.
roil_texture *roil_texture_create(roil *r, uint32_t width, uint32_t height, const uint8_t *rgba);
void roil_texture_destroy(roil *r, roil_texture *t); // NULL is fine

typedef struct roil_vertex {
    float x, y;     // pixels from the top left
    float u, v;     // of the texture, 0 to 1
    uint32_t color; // sRGB with straight alpha, red in the lowest byte; multiplies the texture
} roil_vertex;
typedef struct roil_draw {       // triangles of one texture
    const roil_texture *texture; // NULL: white
    uint32_t first, count;       // indices
    float clip[4];               // left, top, right, bottom in pixels
} roil_draw;
typedef struct roil_picture { // what a window shows
    uint32_t width, height;   // pixels
    float background[3];      // sRGB
    roil_effect *effect;      // its last picture, as a PNG file without alpha has it; NULL: none
    float view[4];            // left, top, right, bottom of where it goes; it keeps its aspect
    const roil_vertex *vertices;
    const uint32_t *indices;
    const roil_draw *draws; // in order, over the effect
    size_t vertex_count, index_count, draw_count;
} roil_picture;
// Draws and, when there is a window, shows it; waits for the display's turn. A width or height of 0
// (minimised) shows nothing. False on indices that do not exist, and when the device is lost.
bool roil_show(roil *r, const roil_picture *picture);
// What was shown last: width * height * 4 bytes.
bool roil_read_shown(roil *r, uint8_t *out);

// Volumes are seen as slices with +z upwards, along z with +y. Outside of the image lies a dark
// field; what is infinite or no number is magenta; behind alpha, with other channels, are checkers.
typedef struct roil_inspection { // how an image of the graph is looked at
    const char *image;           // must be kept (roil_keep), unless it shares no memory
    uint32_t mip;
    int axis;          // of a volume: 0 x, 1 y, 2 z is the direction of sight
    float slice;       // of a volume: 0 to 1 along it
    float exposure;    // stops
    unsigned channels; // bits: 1 red, 2 green, 4 blue, 8 alpha; one alone is shown in grey, also
                       // when the image has no other
    bool negative;     // show the sign of the largest channel: positive orange, negative blue
    float center[2];   // of the view in the image or slice, 0 to 1 from the top left
    float zoom;        // pixels of the texture for one of the image
    float cursor[2];   // pixel of the texture whose value is wanted; negative: none
} roil_inspection;
typedef struct roil_texel {
    bool valid;     // false: no value yet, or the cursor is beside the image
    uint32_t at[3]; // texel of the level
    float value[4]; // as stored; missing channels 0, alpha 1
} roil_texel;
typedef struct roil_image_info {
    char name[96];
    const char *format;     // "rgba16f"
    uint32_t size[3], mips; // depth 1: 2D
    bool volume, culled;    // culled: nothing needs it, so it is not drawn
} roil_image_info;
// After roil_prepare; returns how many there are, 0 before. At most `capacity` are written.
size_t roil_images(roil_effect *e, roil_image_info *out, size_t capacity);
// Draws it into `target`. `texel`: under the cursor, of an earlier call whose frame has finished.
bool roil_inspect(roil_effect *e, const roil_inspection *how, roil_texture *target,
                  roil_texel *texel);

// ---- comparison -------------------------------------------------------------------------------

typedef struct roil_comparison {
    const char *a, *b;        // .png or .exr, of one size
    float exposure;           // stops, -64 to 64, of what is .exr
    double pixels_per_degree; // of the observer whom FLIP imitates, 1 to 1000; 0: 67
    const char *difference; // .png: FLIP at each pixel, from black (0) to pale yellow (1); or NULL
    const char *beside;     // .png: a, b and that picture next to each other; or NULL
} roil_comparison;
typedef struct roil_difference {
    uint32_t width, height;
    double psnr; // dB over R, G and B, with a peak of 1; INFINITY: equal
    double ssim; // of luma, mean; 1: equal
    double flip; // LDR-FLIP, mean; 0: equal, 1: the greatest
} roil_difference;
// Of sRGB as a display gets it: EXR pictures are exposed, clamped to 0 to 1 and encoded, without
// the tone mapping of an effect; behind the alpha of PNG pictures is black, as it is in EXR. Needs
// no device.
bool roil_compare(const roil_comparison *how, roil_difference *out);

// ---- export -----------------------------------------------------------------------------------

typedef struct roil_export {
    const char *pattern; // .vdb file, or a glob of a sequence
    const char *grid;    // exact name of a grid of numbers; NULL: "density"
    const char *type;    // "u8", "u16" (0 to the greatest value), "f16", "f32"; NULL: "u8"
    const char *file;    // one file of all frames, x fastest, little-endian
    // Is told of the frames that were read, each twice, and of those that will be. False gives the
    // export up, which fails then. May be NULL.
    bool (*progress)(void *user, double done, double whole);
    void *user;
} roil_export;
// Resamples every frame into the box that encloses the sequence. Returns a text that says how Lua
// reads the file back (free with roil_free), or NULL.
char *roil_export_raw(const roil_export *desc);

// What fills space in an effect, voxel by voxel, as OpenVDB files.
typedef struct roil_volume_desc {
    const char *source; // a grid by the name of its variable ("air", "burst"), or a pass whose
                        // medium it is ("march"); NULL: the grid that is simulated, else the medium
                        // of the first pass `march`
    const char *fields; // "density,velocity"; NULL: all that it has, or that the effect samples
    uint32_t size;   // voxels along the longest side, 1 to 1024; 0: of the grids that are sampled
    float box[2][3]; // least and greatest corner, metres; equal: the grid's, or where there is
                     // something in the frames `first` to `last`
    double first, last;
    float tolerance; // values that are no greater are left out of the files
    bool alone;      // draw no picture
} roil_volume_desc;
typedef struct roil_volume roil_volume;
typedef struct roil_volume_info {
    uint32_t size[3];
    float voxel_size; // metres
    char fields[256]; // "density, velocity"
} roil_volume_info;
// After roil_load, before roil_prepare; to be finished before roil_unload.
roil_volume *roil_volume_create(roil_effect *e, const roil_volume_desc *desc);
roil_volume_info roil_volume_get_info(const roil_volume *v);
// The last frame as a .vdb file: fog volumes in halves, Z up, metres, metres a second. Reads it
// back and leaves the file to another thread; false also when an earlier one failed.
bool roil_volume_save(roil_volume *v, const char *file);
bool roil_volume_finish(roil_volume *v); // when all is written; frees; NULL is fine

// ---- reference --------------------------------------------------------------------------------
// Text for people, made from the tables that the program itself uses. Free with roil_free.

char *roil_info_devices(void);
char *roil_info_passes(roil *r, const char *name); // NULL: one line each
char *roil_info_fields(const char *name);          // NULL: one line each
char *roil_info_params(roil_effect *e); // memory; parameters, uniforms, options of passes
char *roil_info_graph(roil_effect *e);  // Graphviz dot; needs roil_check or roil_prepare
char *roil_info_vdb(const char *file);
void roil_free(void *text);

#ifdef __cplusplus
}
#endif

#include "roil_slices.h" // flows in a user's hands
