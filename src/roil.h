// roil: a runtime for volumetric effects. This is the whole public interface of libroil; the
// program `roil` does everything through it.
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

typedef struct roil_desc {
    const char *device; // part of a device's name, or its number; NULL: a real GPU before software
    const char *home; // folder that holds shaders/ and scripts/; NULL: $ROIL_HOME, else found from
                      // where the program lies
    bool no_device;   // only load and check effects
    bool no_cache;    // neither read nor write compiled shaders on disk
    bool validate;    // Vulkan validation layers; also by $ROIL_VALIDATE=1
    bool counters;    // count samples (see roil_counters); costs a little time
} roil_desc;

roil *roil_create(const roil_desc *desc);
void roil_destroy(roil *r); // after its effects; NULL is fine
const char *roil_device_name(const roil *r);
const char *roil_device_driver(const roil *r);
uint64_t roil_validation_messages(const roil *r);

// ---- effects ----------------------------------------------------------------------------------

typedef struct roil_setting { // "steps" = "64", "march.mode" = "paper", "tint" = "#ff8000"
    const char *name, *value;
} roil_setting;

// Runs the effect file. Settings override what it declares, structure included; a name that the
// effect does not have is an error.
roil_effect *roil_load(roil *r, const char *file, const roil_setting *settings, size_t count);
void roil_unload(roil_effect *e); // NULL is fine
// Compiles every shader and checks the graph, without a device.
bool roil_check(roil_effect *e);

typedef struct roil_effect_info {
    const char *name;
    double fps;
    uint32_t first_frame, frames;
} roil_effect_info;
roil_effect_info roil_get_info(const roil_effect *e);

// Sets a parameter or a uniform of a pass; takes effect with the next frame.
bool roil_set(roil_effect *e, const char *name, const char *value);

// Keeps an image of the graph ("march.color", or "march" for its first) so that it can be saved.
// Before the first roil_prepare.
bool roil_keep(roil_effect *e, const char *image);
// Compiles and allocates for a picture size, 1 to 16384 each; again for a new size.
bool roil_prepare(roil_effect *e, uint32_t width, uint32_t height);
// Renders one frame; returns when it is submitted.
bool roil_render(roil_effect *e, double frame);

typedef struct roil_time { // GPU time of a pass in the last frame
    char pass[64];
    double milliseconds;
} roil_time;
typedef struct roil_counter { // what a pass counted in the last frame, if counters are on
    char pass[64], name[64];
    uint64_t value;
} roil_counter;
// Both wait for the frame and return how many there are; at most `capacity` are written.
size_t roil_times(roil_effect *e, roil_time *out, size_t capacity);
size_t roil_counters(roil_effect *e, roil_counter *out, size_t capacity);

// ---- pictures ---------------------------------------------------------------------------------

// Picture of the last frame: width * height * 4 bytes, sRGB, opaque or with straight alpha.
bool roil_read(roil_effect *e, bool alpha, uint8_t *out);

typedef struct roil_save_options {
    const char *image; // NULL: the effect's picture; else an image that was kept
    bool alpha;        // PNG: keep alpha
    bool sixteen;      // PNG: 16 bits a channel
    bool full;         // EXR: 32-bit float; else half
} roil_save_options;
// .png: display-referred sRGB; .exr: scene-linear with A, and depth as Z where the effect gives it.
bool roil_save(roil_effect *e, const char *file, const roil_save_options *options);

typedef struct roil_video roil_video;
roil_video *roil_video_create(roil_effect *e, const char *file, double fps); // .mp4
bool roil_video_add(roil_video *v);     // the last frame of its effect
bool roil_video_finish(roil_video *v);  // writes the file; frees
void roil_video_abandon(roil_video *v); // frees, leaves no file; NULL is fine

// ---- export -----------------------------------------------------------------------------------

typedef struct roil_export {
    const char *pattern; // .vdb file, or a glob of a sequence
    const char *grid;    // exact name of a grid of numbers; NULL: "density"
    const char *type;    // "u8", "u16" (0 to the greatest value), "f16", "f32"; NULL: "u8"
    const char *file;    // one file of all frames, x fastest, little-endian
} roil_export;
// Resamples every frame into the box that encloses the sequence. Returns a text that says how Lua
// reads the file back (free with roil_free), or NULL.
char *roil_export_raw(const roil_export *desc);

// ---- reference --------------------------------------------------------------------------------
// Text for people, made from the tables that the program itself uses. Free with roil_free.

char *roil_info_devices(void);
char *roil_info_passes(roil *r, const char *name); // NULL: one line each
char *roil_info_fields(const char *name);          // NULL: one line each
char *roil_info_params(roil_effect *e);            // parameters, uniforms and options of its passes
char *roil_info_graph(roil_effect *e);             // Graphviz dot; needs roil_check or roil_prepare
char *roil_info_vdb(const char *file);
void roil_free(void *text);

#ifdef __cplusplus
}
#endif
