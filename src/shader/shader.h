// Compiles GLSL to SPIR-V and describes it. Needs no device.
//
// A shader file describes itself in annotations:
//
//   // Bends the picture where air is hot.                      <- leading comment: summary
//   //@ option mode = fine {coarse, fine} : how the bend is found
//   //@ field float heat = 0 : excess temperature at a point (K)
//   //@ counter samples : field evaluations
//   uniform float strength;             //= 0.2 [0, 1] m : how far a ray is bent
//   uniform vec3 tint;                  //= {1, 0.9, 0.8} color : of hot air
//   uniform int kind;                   //= soft {hard, soft} : an enumeration
//   uniform bool invert;                //= false : a toggle
//   uniform sampler2D input_;           //= input : the picture
//   uniform sampler2D mask;             //= input optional : where to bend (missing: everywhere)
//   uniform sampler2D last;             //= input history color : what `color` held last frame
//   writeonly uniform image2D color;    //= output rgba16f : the bent picture
//   void main() { ... }
//
// The grammar of an annotation is in src/shader/README.md. Loose uniforms are gathered into one
// std140 block "Uniforms"; bindings are assigned by the compiler. A trailing underscore, needed
// where a name is a GLSL keyword, is not part of the public name ("input"). Options and
// enumerations are macros in GLSL (MODE, MODE_FINE, KIND_SOFT), and so are the formats of outputs
// (FORMAT_COLOR, which a define of the same name overrides).
#pragma once
#include "base/arena.h"
#include "base/hash.h"
#include "base/value.h"
#include "gpu/gpu.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// ---- interface: what the annotations say ------------------------------------------------------

typedef enum shader_type {
    SHADER_FLOAT,
    SHADER_VEC2,
    SHADER_VEC3,
    SHADER_VEC4,
    SHADER_INT,
    SHADER_MAT4, // set by the program only (no annotation)
} shader_type;

typedef struct shader_field { // GLSL may call `float field_heat(vec3 p)`
    const char *name;
    const char *glsl_type; // "float", "vec3" or "vec4"
    int components;
    bool required;
    float value[4];    // used when the effect gives none, if not required
    const char *after; // "" or the name of a field: see field_program_desc in field/field.h
    const char *help;
} shader_field;

typedef struct shader_image {
    const char *name; // public name
    const char *glsl_name;
    bool output, optional, volume; // volume: sampler3D, image3D
    bool history; // an input that defaults to last frame's content of output `history_of`
    const char *history_of;
    gpu_format format; // outputs
    const char *help;
} shader_image;

typedef struct shader_counter { // `count_samples(n)` in GLSL adds to it, when counters are on
    const char *name;
    const char *help;
} shader_counter;

typedef struct shader_interface {
    const char *path;
    const char *summary;
    const value_desc *uniforms; // of vec2 to vec4 numbers of so many components
    size_t uniform_count;
    const value_desc *options; // words; structure: chosen when the shader is compiled
    size_t option_count;
    const shader_field *fields;
    size_t field_count;
    const shader_image *images;
    size_t image_count;
    const shader_counter *counters;
    size_t counter_count;
} shader_interface;

// ---- library: where files are found, compiled and cached --------------------------------------

typedef struct shader_library shader_library;

enum { SHADER_MAX_ASSETS = 8 };
typedef struct shader_library_desc {
    const char *shader_root;   // folder of the program's shaders; NULL: none
    const char *effect_root;   // folder of the effect: user shaders and their includes; NULL: none
    const char *const *assets; // folders that are searched after it
    size_t asset_count;        // up to SHADER_MAX_ASSETS
    const char *cache_dir;     // compiled SPIR-V by content hash; NULL: none
    bool remembers;            // files are read once, until shader_library_forget
} shader_library_desc;

shader_library *shader_library_create(const shader_library_desc *desc);
void shader_library_destroy(shader_library *library);
void shader_library_forget(shader_library *library); // files may have changed
// glslang runs since the library was created (cache hits do not count).
uint64_t shader_library_compiles(const shader_library *library);
bool shader_cache_holds_any(const char *cache_dir); // compiled shaders, of any effect or version

// Called with the path of every file that is read, and of every missing file that was looked for,
// so that a reload can watch them. Paths are absolute if the library's folders are.
typedef struct shader_reader {
    void (*read)(void *user, const char *path);
    void *user;
} shader_reader;

// Reads the annotations of a file and of the files it includes. `name` is looked up in the effect's
// folder first, then in the program's; it cannot leave either. NULL with "file:line: message".
// `reader` may be NULL.
const shader_interface *shader_interface_load(shader_library *library, arena *memory,
                                              const char *name, const shader_reader *reader);

// Returns whether the code or the annotations of the file, or of one that it includes, contain a
// name, with or without the trailing underscore. False also when the file cannot be read.
bool shader_mentions(shader_library *library, const char *file, const char *name);

// ---- compile ----------------------------------------------------------------------------------

typedef enum shader_stage { SHADER_COMPUTE, SHADER_VERTEX, SHADER_FRAGMENT } shader_stage;

typedef struct shader_define {
    const char *name, *value;
} shader_define;
typedef struct shader_text {
    const char *name, *text;
} shader_text; // #include "name" finds it

typedef struct shader_compile_desc {
    const char *name; // file, as for shader_interface_load
    shader_stage stage;
    const shader_define *defines;
    size_t define_count;
    const shader_text *texts; // generated include files
    size_t text_count;
    const size_t *options; // one value per option of the interface, in order; NULL: defaults
    size_t option_count;
    bool counters;               // compile the counters in
    const shader_reader *reader; // may be NULL
} shader_compile_desc;

typedef struct shader_member { // a member of the block "Uniforms"
    const char *name;          // public name
    uint32_t offset, size;     // bytes
    shader_type type;          // SHADER_INT for enums, bools and ints alike; SHADER_MAT4 too
    uint32_t array;            // elements, 0: not an array
} shader_member;

// Only resources that the entry point uses have a slot. Bindings of fragment shaders begin at
// GPU_MAX_SLOTS / 2, so that they differ from those of the vertex shader.
typedef struct shader_slot {
    const char *name; // GLSL name: the block's name, or else the variable's
    gpu_slot slot;
    uint32_t size; // bytes of a uniform block
    bool volume;   // image is 3D
} shader_slot;

typedef struct shader_binary {
    const uint32_t *code;
    size_t size; // bytes
    const shader_slot *slots;
    size_t slot_count;
    const shader_member *members; // of "Uniforms", if that block exists
    size_t member_count;
    uint32_t local_size[3];
    const char *const *files; // every file that was read
    size_t file_count;
} shader_binary;

// Compiles a shader. All results live in `memory`. False with "file:line: message" and, below it,
// the source line. Any thread, also several at once for one library.
bool shader_compile(shader_library *library, arena *memory, const shader_compile_desc *desc,
                    shader_binary *out);
