// Fields: what fills space. An immutable expression tree over a point p (metres) and the time.
//
// One table of kinds (field_kinds) says for every kind of node its arguments with defaults, ranges,
// units and help, the GLSL function that computes it and its twin in C. The generator, the
// evaluator, the Lua vocabulary and `roil info fields` all read that table.
//
// A value that does not vary in space (a constant, a parameter, a curve, a Lua function of time,
// and arithmetic on these) is a field too: uniforms of passes are such fields.
#pragma once
#include "base/arena.h"
#include "base/maths.h"
#include "base/value.h"
#include "field/curve.h"
#include "field/grid.h"
#include "field/palette.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    FIELD_MAX_ARGS = 16,
    FIELD_MAX_OPTIONS = 4,
    FIELD_MAX_DEPTH = 256,   // nodes on a path: building a deeper expression fails
    FIELD_MAX_NODES = 4096,  // distinct nodes under the fields of one program
    FIELD_MAX_ADVECTED = 64, // nodes holding noise that "advect" can make anew
};

typedef struct field field;
typedef struct field_kind field_kind;

typedef struct field_arg {
    value_desc desc; // whose range is checked for constants
    bool uniform;    // must not vary in space
    bool rate;       // given per second: the node's argument is it times the time
} field_arg;

typedef struct field_option {
    const char *name;
    const char *words[6]; // the first is the default; NULL ends
    const char *help;
} field_option;

typedef struct field_context { // what values depend on besides space
    double time;               // seconds
    const float (*params)[4];  // of the effect, by index
    size_t param_count;
    bool (*call)(void *user, int function, double time, float out[4]); // Lua functions of time
    void *user;
    const struct instance_entry *instance; // that it is evaluated for; NULL: none
    float unread; // of ranges alone: values that grids are taken to have before any is read; 0: any
} field_context;

typedef struct field_point { // where a node is evaluated
    const field *node;
    const field_context *context;
    float3 p;
} field_point;

typedef struct field_box { // where its range is asked for: points in the box `at`
    const field *node;
    const field_context *context;
    const struct intervals *at;
} field_box;

struct field_kind {
    const char *name;               // as Lua names it: "worley"
    const char *group;              // "value", "source", "noise", "shape", "operator"
    const char *summary;            // with its source (paper, section)
    int components;                 // of the result: 1, 3, 4; 0: the widest argument's
    field_arg args[FIELD_MAX_ARGS]; // a NULL name ends
    field_option options[FIELD_MAX_OPTIONS];
    // GLSL: result = function(p, args..., options...) from the include file; p only if `spatial`.
    const char *include;  // "lib/noise.glsl" or NULL
    const char *function; // NULL: the generator and the evaluator have a case of their own
    bool spatial;         // depends on p by itself
    float cost;           // rough arithmetic operations: cheap factors of a product come first
    void (*eval)(const struct field_point *at, const float (*args)[4], float out[4]);
    // Box outside of which the result is zero, from the arguments' boxes. NULL: by what the kind
    // makes of zeros.
    box3 (*bounds)(const field *node, const field_context *context, const box3 *args);
    // Least and greatest value in a box (range.h), in C and in GLSL, where it is a function of
    // ranges in the place of `function`; NULL: the generator has a case of its own.
    struct intervals (*ranges)(const struct field_box *in, const struct intervals *args);
    const char *range_function;
};

extern const field_kind field_kinds[];               // ends with a NULL name
const field_kind *field_kind_find(const char *name); // NULL with a message that suggests

struct field {
    const field_kind *kind;
    int components;
    bool uniform;                       // does not vary in space
    uint16_t depth;                     // nodes on the longest path down from here
    uint32_t size;                      // nodes if written out as a tree, at most UINT32_MAX
    const field *args[FIELD_MAX_ARGS];  // all filled in: defaults became constants
    uint8_t options[FIELD_MAX_OPTIONS]; // index of the word
    float value[4];                     // kind "constant"
    int index; // "param": index; "call": function; "grid": first channel; "swizzle": 2 bits each
    const field
        *velocity; // of what a flow carries, where "advect" made the node (m/s); NULL: not known
    const void
        *object; // "curve": curve; "palette": palette; "grid": field_grid; "glsl": field_glsl
};

typedef struct field_glsl { // a user's function: `float name(vec3 p, arg...)`
    const char *file;       // include name, found in the effect's folder
    const char *function;
    int components; // of the result
    int arg_count;  // of the arguments after p, each 1, 3 or 4 components as given
} field_glsl;

// ---- building; all nodes live in `memory` ------------------------------------------------------

field *field_constant(arena *memory, int components, const float value[4]);
bool field_is_constant(const field *node); // it is such a number, not merely one that stands still
field *field_param(arena *memory, int components, int index);
field *field_curve(arena *memory, const curve *c);
field *field_call(arena *memory, int components, int function);
field *field_time(arena *memory);
field *field_grid_channel(arena *memory, const field_grid *grid, int channel, int components);
field *field_palette(arena *memory, const palette *p, const field *at); // 4 components: rgba
field *field_user(arena *memory, const field_glsl *glsl, const field *const *args);
// Any kind with a row that has `function` or operator semantics. `args` in the row's order, NULL:
// default; `options` NULL: defaults. NULL with a message: wrong component count, constant out of
// range, required argument missing, a `uniform` argument that varies in space. Single components
// widen to the others' count in operators ("add", "mul", "mix", ...).
field *field_make(arena *memory, const char *kind, const field *const *args,
                  const uint8_t *options);
field *field_swizzle(arena *memory, const field *a, const char *components); // "x", "rgb", ...

// Noises as a tile: baked once, it stands for them everywhere (tile.c).
typedef struct field_tile {
    const field *content; // what it holds: repeats, in all directions, after so many cells
    float cells;          // the side of the cube to be baked, from 0; a cell is 1 long
    const field *noise, *frequency, *drift; // the first noise of the expression, and its own
    bool alone;                             // the expression is that noise
    int samples, octaves;                   // of it; octaves in each, where there are several
} field_tile;

// NULL of `content`, with a message: something in `node` does not repeat.
// `octaves`: how many of a lone noise's are in the tile, at whole lacunarities; for the others it
// is sampled again, which rounds their count up.
bool field_tile_create(arena *memory, const field *node, float cells, int octaves, field_tile *out);
// The expression, by samples of a grid that holds the tile and repeats.
field *field_tile_sample(arena *memory, const field_tile *tile, const field *baked);

// Bytes of memory that an "advect" may take: its expression is written out for each pattern.
enum { FIELD_ADVECT_COST = 3 * (FIELD_MAX_ADVECTED + 32) * sizeof(field) };

// ---- asking -----------------------------------------------------------------------------------

// Value at a point, by the kinds' C twins. Grids are sampled trilinearly on the host where they
// keep host data, else this fails. False when a Lua function failed.
bool field_eval(const field *node, const field_context *context, float3 p, float out[4]);
// The same for each of `count` instances, at its place; what does not vary is evaluated once.
bool field_eval_instances(const field *node, const field_context *context,
                          const struct instance_entry *entries, size_t count, float (*out)[4]);
// Box outside of which the field is zero; infinite when unknown.
bool field_bounds(const field *node, const field_context *context, box3 *out);
// Of a tree without bounds, the node to blame: one that is not zero although one of its arguments
// has bounds, else a leaf that has none itself.
const field *field_without_bounds(const field *node, const field_context *context);
// The same where of grids only their boxes are known, and not what lies in them at the time.
bool field_bounds_of_grids(const field *node, const field_context *context, box3 *out);
// Greatest size that a component can have anywhere; INFINITY when unknown.
float field_longest(const field *node, const field_context *context);
// Every grid the tree samples, each once; returns the count (writes at most `capacity`).
size_t field_grids(const field *node, const field_grid **out, size_t capacity);
// Whether the tree samples channels of that image of the grid.
bool field_samples(const field *node, const field_grid *grid, int image);
// The velocity (m/s) by which what the tree says moves, where it is carried by a flow: that of a
// grid with a velocity, of "advect", and of these bent or moved; of a sum the mean by what is
// added. NULL: nothing in it says one. Grids are asked for it, so call it before they play. Nodes
// live in `memory`.
const field *field_velocity(arena *memory, const field *node);
// A grid's velocity in metres by a second of the effect, not of the grid's own time.
const field *field_of_effect_time(arena *memory, const field_grid *grid, const field *velocity);
// Whether it says the same again after so many seconds, from the context's time on, as far as that
// can be told from what it is made of; `why` then gets what does not.
bool field_repeats(const field *node, const field_context *context, double seconds, strbuf *why);
void field_print(const field *node, strbuf *out); // one line, for messages and `roil info graph`
