// A shader unit: one shader file with everything it includes, flattened to one text.
// Private to src/shader.
#pragma once
#include "base/stack.h"
#include "base/str.h"
#include "gpu/spirv.h"
#include "shader/shader.h"
#include <stdatomic.h>

// ---- library ----------------------------------------------------------------------------------

typedef enum library_root { // those of a user first, in the order in which they are searched
    ROOT_EFFECT,
    ROOT_ASSETS,
    ROOT_PROGRAM = ROOT_ASSETS + SHADER_MAX_ASSETS,
    ROOT_COUNT,
    ROOT_NONE
} library_root;

typedef struct library_memo library_memo;
typedef struct binary_memo binary_memo;

struct shader_library {
    arena memory;
    library_memo *memo;            // NULL: nothing is remembered
    binary_memo *binaries;         // likewise
    const char *roots[ROOT_COUNT]; // NULL: none
    const char *cache_dir;         // NULL: none
    atomic_uint_fast64_t compiles;
};

typedef struct library_file { // the file that a name stands for
    library_root root;
    const char *name;  // inside the root, without "." and ".."
    const char *path;  // absolute, symbolic links followed
    const char *label; // for messages: the root as it was given, then the name
} library_file;

// Finds `name` in a root. 1: found; 0: no such file; -1: refused, with a message that has no
// position. `folder` is put before the name ("" for none).
int library_find(const shader_library *library, library_root root, const char *folder,
                 const char *name, arena *memory, library_file *out);

// A memo remembers which files were found (or not: `found` 0) and read. What is older than the last
// memo_forget holds when the file system says so at its next use. Results are copied to `memory`.
// memo_find returns false for a name that is not known; `label` is the name below its root as
// given. memo_read reads a file that is not known; false with a message when that fails. Any
// thread.
library_memo *memo_create(void);
void memo_destroy(library_memo *m); // NULL is allowed
void memo_forget(library_memo *m);
bool memo_find(library_memo *m, library_root root, const char *name, const char *label,
               arena *memory, int *found, library_file *out);
void memo_keep(library_memo *m, library_root root, const char *name, int found,
               const library_file *file);
bool memo_read(library_memo *m, const char *root, const char *path, arena *memory, char **text,
               size_t *size);
// Of what memo_read gives.
bool memo_hash(library_memo *m, const char *root, const char *path, hash128 *out);

// ---- scanning ---------------------------------------------------------------------------------

// Copies a line to `code` (emptied first) with its comments turned to spaces. Returns where its
// `//` comment begins, or `length`. `in_comment` carries over from line to line.
size_t scan_line(strbuf *code, const char *line, size_t length, bool *in_comment);

// ---- unit -------------------------------------------------------------------------------------

enum {
    UNIT_MAX_SIZE = 4 << 20, // bytes, of one file and of the whole
    UNIT_MAX_DEPTH = 32,     // nested includes
    UNIT_MAX_FILES = 1000,
};

// The generated text of a pass's fields. It exists only once an effect is built, so an interface is
// read without it.
#define UNIT_FIELDS "fields.glsl"

typedef struct unit_file {
    library_file where; // `path` NULL: a generated text
    const char *text;
    size_t size;
    int includer; // the file that first included this one; -1: the unit's main file
    bool open;    // being included right now
} unit_file;

typedef struct unit_include { // a name and the file that it led to
    int file, target;         // `file`: the includer; -1: the unit itself
    const char *name;         // as written
} unit_include;

typedef struct unit_line { // a line of the text that came from a file
    int file, number;
    size_t start, length; // in `text` and `code`, without the newline
    size_t comment;       // where its `//` begins; `length` if nowhere
} unit_line;

typedef struct shader_unit {
    arena memory;
    unit_file *files; // the first is the main file; GLSL knows file i as source string i + 1
    size_t file_count, file_capacity;
    unit_include *includes;
    size_t include_count, include_capacity;
    unit_line *lines;
    size_t line_count, line_capacity;
    strbuf text; // as written
    strbuf code; // byte for byte beside `text`, comments turned to spaces: what is compiled
    bool has_local_size;
} shader_unit;

typedef struct unit_desc {
    const char *name;
    const shader_text *texts; // searched before folders; the name itself may be one of them
    size_t text_count;
    bool without_fields;         // UNIT_FIELDS is an empty file
    const shader_reader *reader; // may be NULL
} unit_desc;

bool unit_load(const shader_library *library, const unit_desc *desc, shader_unit *out);
// Looks for a name as an #include of `from` does; NULL: as the unit itself is looked for. 1: found;
// 0: missing; -1: refused, with a message that has no position.
int unit_find(const shader_library *library, const library_file *from, const char *name,
              arena *memory, library_file *out);
void unit_free(shader_unit *unit);
// Line `number` of file `file` without indentation, at most `capacity` - 1 bytes of it.
void unit_source_line(const shader_unit *unit, int file, int number, char *out, size_t capacity);

// ---- annotations ------------------------------------------------------------------------------

typedef struct unit_insert { // text to put into the unit's code at `offset`
    size_t offset;
    const char *text;
} unit_insert;

typedef struct unit_inserts {
    unit_insert *items; // in order of offset; free with mem_free
    size_t count, capacity;
} unit_inserts;

// Reads the annotations of a unit. `inserts` gets the layouts that images need; may be NULL.
const shader_interface *unit_annotations(const shader_unit *unit, arena *memory,
                                         unit_inserts *inserts);
// "mode_2" -> "MODE_2", appended.
void unit_add_upper(strbuf *out, const char *name);

// ---- from text to SPIR-V ----------------------------------------------------------------------

// Prints the text before the unit's own: version, extensions, macros, counters.
bool unit_prelude(const shader_unit *unit, const shader_interface *interface,
                  const shader_compile_desc *desc, strbuf *out);

typedef struct spirv {
    uint32_t *words; // free with mem_free
    size_t count;
} spirv;

enum {
    GLSL_MAX_OPERATORS = 20000,    // per statement; a table of 5000 negative numbers has 10000
    SPIRV_MAX_SIZE = 16 << 20,     // bytes
    SPIRV_MAX_EXPANDED = 4 << 20,  // words, every call inlined
    SPIRV_MAX_VARIABLE = 32 << 10, // bytes
    // Bytes of a thread's arrays, every call inlined. A step of a lattice that carries three
    // scalars in 27 directions counts 48,840.
    SPIRV_MAX_PRIVATE = 48 << 10,
};

typedef enum glsl_outcome {
    GLSL_DONE,
    GLSL_REFUSED,        // the log says why
    GLSL_INITIALISER,    // a uniform has one; the log begins with the warning
    GLSL_LONG_STATEMENT, // of more than GLSL_MAX_OPERATORS
    GLSL_LARGE,          // more than SPIRV_MAX_SIZE
    GLSL_NO_CODE,
    GLSL_INVALID, // the log says why
    GLSL_LAST = GLSL_INVALID,
} glsl_outcome;

typedef struct glsl_answer {
    glsl_outcome outcome;
    void *data; // SPIR-V when done, else the log, NUL-terminated
    size_t size;
} glsl_answer;

typedef void glsl_receiver(void *user, const glsl_answer *answer); // valid during the call

// Runs glslang in this process, where the text of a stranger can make it hang or crash. See
// compiler.h.
void glsl_run(const char *source, shader_stage stage, glsl_receiver *receive, void *user);
// Returns true for GLSL_DONE. Else sets a message with the real file and line, and the source line
// below it, and returns false.
bool glsl_explain(const shader_unit *unit, const glsl_answer *answer);
uint32_t glsl_version(void); // version of the compiler, for cache keys

// Returns whether the code may be given to a driver: see gate.c. The message has no position, nor
// has that of spirv_reflect, which calls this first.
bool spirv_gate(const spirv *code);
// A part of the gate: returns false when the code is recursive, or too large once calls are
// inlined.
bool spirv_can_expand(const spirv_module *code);
// Returns whether the module is valid (validate.c). This takes 7 ms for the median of our modules
// and 130 ms for the largest. It is called for code with a stranger's text, in the compiler's
// process.
bool spirv_validate(const spirv *code);
// Assigns bindings in place, removes unused resources, and describes the others.
bool spirv_reflect(spirv *code, shader_stage stage, arena *memory, shader_binary *out);
// Turns LocalSizeId into LocalSize, which needs no device feature, and removes all resources but
// the `live` ones.
void spirv_clean(spirv *code, const uint32_t local_size[3], const uint32_t *live,
                 size_t live_count);

// What was compiled or read of annotations before, and what it was made of, for a library that
// remembers: an edit of a number compiles nothing anew, and expanding and reflecting 38 shaders
// took most of such a reload. Any thread. binary_memo_find is true, and interface_memo_find not
// NULL, with a copy in `memory`, when every name would lead to the same text again.
binary_memo *binary_memo_create(void);
void binary_memo_destroy(binary_memo *m); // NULL is fine
bool binary_memo_find(const shader_library *library, const shader_compile_desc *desc, arena *memory,
                      shader_binary *out);
void binary_memo_keep(const shader_library *library, const shader_compile_desc *desc,
                      const shader_unit *unit, const shader_binary *binary);
const shader_interface *interface_memo_find(const shader_library *library, const char *name,
                                            arena *memory, const shader_reader *reader);
void interface_memo_keep(const shader_library *library, const char *name, const shader_unit *unit,
                         const shader_interface *interface);

bool cache_load(const shader_library *library, hash128 key, spirv *out);
void cache_store(const shader_library *library, hash128 key, const spirv *code);
