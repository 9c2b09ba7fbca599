// Export: what an effect makes as files for other programs, volumes and sheets. Part of roil.h,
// which includes it; its rules on errors, threads and memory hold here too.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil_export {
    const char *pattern; // a .vdb file, or a glob of a sequence
    const char *grid;    // exact name of a scalar grid; NULL: "density"
    const char *type;    // "u8", "u16" (both scaled to the maximum), "f16" or "f32"; NULL: "u8"
    const char *file;    // output: all frames in one file, x fastest, little-endian
    // Called with the number of frames read and to be read; each is read twice. Returning false
    // cancels the export, which then fails. May be NULL.
    bool (*progress)(void *user, double done, double whole);
    void *user; // passed to progress
} roil_export;
// Resamples every frame into the box that encloses the sequence. Returns a text that says how a
// script reads the file (free it with roil_free), or NULL with a message. Any thread.
char *roil_export_raw(const roil_export *desc);

// Export of what fills space in an effect, sampled at voxels, as OpenVDB files.
typedef struct roil_volume_desc {
    // The name of a grid's variable ("air", "burst"), or of a pass whose medium it is ("march").
    // NULL: the simulated grid, or else the medium of the first pass `march`.
    const char *source;
    const char *fields; // "density,velocity"; NULL: every field that it has or the effect samples
    uint32_t size;      // voxels along the longest side, 1 to 1024; 0: that of the sampled grids
    float box[2][3];    // minimum and maximum corner (m); equal: the grid's box, or the box that is
                        // not empty in the frames `first` to `last`
    double first, last; // frames
    float tolerance;    // values up to it count as empty and are not stored
    bool alone;         // do not draw the effect's pictures
} roil_volume_desc;
typedef struct roil_volume roil_volume;
typedef struct roil_volume_info {
    uint32_t size[3];
    float voxel_size; // metres
    char fields[256]; // "density, velocity"
} roil_volume_info;
// Call it after roil_load and before roil_prepare. The volume must be finished before roil_unload.
roil_volume *roil_volume_create(roil_effect *e, const roil_volume_desc *desc);
roil_volume_info roil_volume_get_info(const roil_volume *v);
// Saves the last frame as a .vdb file: fog volumes of 16-bit floats, z up, metres, metres per
// second. Reads the data back; another thread writes the file. Also returns false when an earlier
// file failed.
bool roil_volume_save(roil_volume *v, const char *file);
bool roil_volume_finish(roil_volume *v); // waits for all files and frees `v`; NULL is allowed

// Export of sheets: frames beside each other in one picture, and maps of what a renderer of sprites
// cannot know, for engines that play them as flipbooks. They show the medium of one march alone,
// before nothing: no mesh, sky, sprite or bloom. Alpha is 1 minus the medium's transmittance.
typedef struct roil_sheet_desc {
    const char *source; // name of a pass march; NULL: the first
    // "color,motion,six-way,normal,depth,temperature", or some of these; NULL: "color"
    const char *maps;
    const char *light; // of the colour: "shown", tone-mapped by the effect's pass final, "scene",
                       // before that and linear, or "both"; NULL: "shown"
    uint32_t columns, rows; // 1 to 64 each; 0: 8
    uint32_t cell;          // pixels along each side of a cell, 16 to 4096; 0: 256
    uint32_t gutter; // pixels along the edges of a cell that the medium stays out of, below half
    bool camera; // keep the effect's camera; else an orthographic one looks the same way and is set
                 // so that all that the density can be fills the cells
    float part[4];      // of that: left, top, right, bottom, 0 to 1 from the top left, as
                        // roil_sheet_find_used gives it; all 0: all
    double first, last; // frames that will be seen
    uint32_t fade;      // the last cells, which dissolve (roil_sheet_dissolve); 0: none
} roil_sheet_desc;
typedef struct roil_sheet_options {
    const char *engine; // whose signs, encodings and alpha: "unity", "unreal", "godot" or "labs";
                        // NULL: none's
    const char *format; // "png", "png16", "exr" or "tga"; NULL: by the name of the file
    const char *alpha;  // "premultiplied", "straight" or "both"; NULL: as the engine wants it, else
                        // premultiplied
    bool crop;          // cut the cells to what is used in any
    double fps;         // cells a second, above 0
    double loop;        // seconds after which it repeats; 0: it does not
    uint32_t count;     // cells that are used; 0: all
    const char *page;   // .html file that plays the sheet; NULL: none
    const char *const *made; // options of the command that makes it, "--cell=64", ending with NULL;
                             // NULL: none. Its files hold them
    const char *const *notes; // lines for the description, such as how a loop was made
    size_t note_count;
} roil_sheet_options;
typedef struct roil_sheet roil_sheet;
// Call it after roil_load (and roil_set_samples) and before roil_prepare, which then takes the size
// of a cell; it sets the effect's camera. NULL with a message, as where nothing says a velocity.
// Free it before the effect.
roil_sheet *roil_sheet_create(roil_effect *e, const roil_sheet_desc *desc);
// Whether the medium of a march (NULL: the first) repeats by itself after so many seconds, as far
// as what it is made of tells: curves and functions, phases and drifts of noise with a `period`.
// Else `why` gets what does not, such as "the drift of 'worley' repeats every 2.5 s".
bool roil_repeats(roil_effect *e, const char *source, double seconds, char *why, size_t capacity);
// Adds the last frame to a cell, times a weight: cells to which several frames are added dissolve
// from one to the other.
bool roil_sheet_add(roil_sheet *s, uint32_t cell, double weight);
// Adds the last frame as what one of the last cells becomes, and how far it has by then, 0 to 1:
// for loops. Both are cross-faded, and moved onto each other along the optical flow between their
// colours where libroil-flow is and that brings them together.
bool roil_sheet_dissolve(roil_sheet *s, uint32_t cell, double part);
// Finds the part of a cell that is used in any of the first `count`, which show frames in rising
// order, and half of the largest step from one to the next beside it. The sheet's light must be
// "both". False: nothing is seen.
bool roil_sheet_find_used(const roil_sheet *s, uint32_t count, float part[4]);
// Writes "fire.png", "fire-motion.png" and so on, and what is in them as "fire.json". Only once.
bool roil_sheet_save(roil_sheet *s, const char *file, const roil_sheet_options *options);
// A sentence on what was written, after roil_sheet_save; valid until roil_sheet_free.
const char *roil_sheet_summary(const roil_sheet *s);
void roil_sheet_free(roil_sheet *s); // NULL is allowed

// Bundles: one file NAME.roil with an effect and all that it reads, which roil_load and
// roil_live_create take like an effect's file. It is never changed. It is a tar archive (POSIX
// ustar) of a folder in which the effect has the folder's name. One that comes from a stranger is
// unpacked into a folder of the process, which is removed with the last `roil`; it reads nothing
// but that and the program's own files, no assets.
typedef struct roil_input {
    const char *name; // from the effect's folder, or from that of the assets in which it lies
    const char *path; // where it is now
    uint64_t size;    // bytes
} roil_input;
typedef struct roil_inputs {
    const char *effect; // the name of its file, one of `files`
    roil_effect_info info;
    const roil_input *files; // by name
    size_t count;
} roil_inputs;
// Lists the files that an effect or a bundle reads, as it is and with every word of its choices,
// and its presets, but not the program's own. NULL with a message.
roil_inputs *roil_collect(roil *r, const char *file);
void roil_free_inputs(roil_inputs *inputs); // NULL is allowed
// Writes a bundle of them. Equal files give equal bytes. False with a message, and no file: a name
// cannot be in a bundle, or what was packed does not load by itself.
bool roil_bundle(roil *r, const roil_inputs *inputs, const char *file);

#ifdef __cplusplus
}
#endif
