// The inside of libroil's objects, for src/roil*.c only.
#pragma once
#include "base/file.h"
#include "base/memory.h"
#include "base/time_limit.h"
#include "effect/effect.h"
#include "roil.h"

typedef struct view view;                   // roil/view.h
typedef struct template_file template_file; // roil/template.c

struct roil {
    gpu *device; // NULL: no_device
    gpu *shown;  // what draws the window: `device`, or one beside it (profile.h: shows_apart)
    char *home, *shaders, *scripts, *cache;
    char *assets[EFFECT_MAX_ASSETS]; // of roil_desc and the environment
    size_t asset_count;
    bool counters, window, never_waits, interaction;
    bool stuck; // an abandoned thread still uses it (roil_live_destroy)
    uint32_t reference;
    uint64_t textures; // how often one was made or drawn into
    double seconds;    // roil_desc.time_limit
    bool (*loading)(void *user, double done, double whole);
    void *user; // for `loading`
    view *view; // NULL until something is shown or inspected
};

struct roil_effect {
    roil *owner;
    effect *effect;
    uint32_t width, height;
    uint64_t frame;    // number of the last GPU frame; 0: none
    double speed;      // of simulations in the last frame that had steps (roil_readouts)
    uint32_t averaged; // roil_set_samples; 0: it was not called
    double shutter;    // the same
    double shown;      // number of the effect's frame that is shown
    char **kept;       // names given to roil_keep, for roil_apply_kept
    size_t kept_count, kept_capacity;
    template_file **templates; // that were read so far
    size_t template_count, template_capacity;
    bool has_layer;
    effect_layer layer;
    char inputs[33]; // hash of all files that it reads; "": not asked for yet
};

// Appends the value of a control as Lua. `whole`: of palettes and curves also what no setting can
// change, such as the period. (roil/lua.c)
void roil_add_lua(const roil_effect *e, const effect_control *c, bool whole, strbuf *out);
// Appends "param { "NAME", ... }" with the control's value, range, unit and help.
void roil_add_param_lua(const roil_effect *e, const effect_control *c, const char *name,
                        strbuf *out);
void roil_add_lua_key(const char *name, strbuf *out); // "name = ", in brackets where it must be
graph_image roil_find_image(roil_effect *e, const char *name); // zero with a message
// Reads an image of the last frame: four floats a pixel, to be freed. NULL with a message.
float *roil_read_linear(roil_effect *e, graph_image image, uint32_t *width, uint32_t *height);
// Converts texels of a format of the graph: four floats each. Missing channels are 0, and alpha 1.
void roil_expand(const void *texels, gpu_format format, size_t count, float *out);
float roil_srgb(float linear); // 0 to 1, encoded for a display
// Tables from linear values to sRGB codes, indexed by the square root: entry i is the code of
// (i / ROIL_SRGB_STEPS)^2. Values of the fine table have 8 fractional bits. The first call fills
// them and must not run on two threads at once.
enum { ROIL_SRGB_STEPS = 4096, ROIL_SRGB_FINE = 255 << 8 };
const uint8_t *roil_srgb_table(void);
const uint16_t *roil_srgb_fine_table(void);
// Returns the dither threshold of a pixel; v stands for (v + 0.5) / 256.
uint8_t roil_dither_noise(size_t x, size_t y, int channel);

// The folders besides its own that an effect may read.
typedef struct roil_assets {
    arena memory;
    const char *folders[EFFECT_MAX_ASSETS], *project; // the file that names some; NULL: none
    size_t count;
} roil_assets;
// Takes those of roil_desc and the environment into `r`. False with a message.
bool roil_take_assets(roil *r, const roil_desc *desc);
bool roil_is_project(const char *file); // "roil.json"

// Where the file of an effect is that its user named. A bundle is unpacked into a folder of the
// process, which is removed with the last `roil`.
typedef struct roil_origin {            // strings live as long as that
    const char *file, *inside, *bundle; // as those of effect_desc
} roil_origin;
// `inside`: the folder that `file` must lie in; NULL: anywhere. False with a message.
bool roil_find_origin(const char *inside, const char *file, roil_origin *out);
void roil_count_users(int change); // of the folders: 1 or -1 with each `roil`
// False with a message: the file "roil.json" is wrong. A bundle has no assets. Call
// arena_free(&out->memory) in either case.
bool roil_find_assets(const roil *r, const roil_origin *origin, roil_assets *out);
// Opens a file that an effect has read, in the folders that it may read and those of the program;
// no link that was put there meanwhile leads out. -1: there is none.
int roil_open_input(const roil_effect *e, const char *path, size_t *size);

struct json_t;
typedef struct roil_making {    // of an output, besides the effect and its size
    const char *kind;           // "picture", "film", "volume", "sheet"
    const char *sheet, *part;   // of a sheet, as in roil_made
    struct json_t *settings;    // of roil_list_settings; NULL: those of now
    double first, last, step;   // frames; of volumes those that the box was chosen by
    const char *const *options; // of the command that makes it, ending with NULL
} roil_making;
// Returns the recipe of an output that shows the last frame, or ends with it, as a line of JSON
// that begins with ROIL_RECIPE_BEGIN: every format holds it as it is. NULL: a text of it is no
// UTF-8. Free it with mem_free.
char *roil_describe(roil_effect *e, const roil_making *how);
struct json_t *
roil_list_settings(const roil_effect *e); // what differs from the script; json_decref
roil_made *roil_parse_made(const char *line, const char *name); // `name` is for messages
#define ROIL_RECIPE_BEGIN "{\"roil-recipe\":1,"

// Opens the host's device. NULL with a message. (roil/vulkan.c)
gpu *roil_open_host(const gpu_desc *how, const roil_vulkan *vulkan);

// The whole of a call that makes an object, which it returns. When memory was short, it is
// destroyed, as `made`, and NULL.
#define RETURN_MADE(type, make, destroy)                                                           \
    do {                                                                                           \
        mem_enter();                                                                               \
        type *made = (make);                                                                       \
        if (made && mem_is_short()) {                                                              \
            destroy;                                                                               \
            made = NULL;                                                                           \
        }                                                                                          \
        mem_leave(made != NULL);                                                                   \
        return made;                                                                               \
    } while (0)
char *roil_leave_text(char *text);     // ends a call that makes a text, likewise
size_t roil_leave_count(size_t count); // and of a call that counts: 0 when memory was short

time_limit roil_time_limit(const roil *r); // a new limit for a load
// What an effect is created with, by the options of `r`; the other members are zero.
effect_desc roil_effect_desc(const roil *r, const roil_origin *origin, const roil_assets *assets,
                             const effect_setting *settings, size_t count);
bool roil_may_write(const roil_effect *e); // false with a message: it is a bundle's

void roil_free_view(roil *r);
void roil_free_templates(roil_effect *e); // after the effect itself
// Marks the outputs of the graph: the effect's pictures, and those images of roil_keep that exist.
// Call it before the graph is compiled for a size.
void roil_apply_kept(roil_effect *e);
// Returns the path of a preset, which need not exist: a name stands for a file beside the effect, a
// path for itself.
bool roil_preset_path(char out[PATH_CAP], const char *effect_file, const char *preset);
