// Parses one annotation. Private to src/shader.
#pragma once
#include "shader/unit.h"

enum { NAME_CAP = 64, MAX_WORDS = 64 };

// A declaration of GLSL that stands before `//=`.
typedef struct declaration {
    bool uniform; // else `out`
    bool array;
    char type[NAME_CAP], name[NAME_CAP];
    gpu_format format; // in a layout(...), GPU_FORMAT_NONE if none is given
} declaration;

typedef struct cursor { // over the text of one annotation, NUL-terminated
    const char *at;
    const char *label; // position, for messages
    int line;
    arena *memory;
} cursor;

bool cursor_fail(const cursor *c, const char *format, ...) PRINTF_LIKE(2, 3);
// All cursor functions skip blanks first. Takes `symbol` if it comes next.
bool cursor_take(cursor *c, char symbol);
bool cursor_name(cursor *c, char out[NAME_CAP], const char *what); // identifier, or error
bool cursor_word(cursor *c, char out[NAME_CAP], const char *what); // letters, digits, _: or error
bool cursor_is_number(cursor *c);
// Reads one number for all `components`, or {one for each}. They must be finite.
bool cursor_value(cursor *c, int components, float out[4]);
bool cursor_range(cursor *c, float *min, float *max); // "[a, b]", may be absent
bool cursor_unit(cursor *c, const char **out);        // up to the colon, may be absent
// `{a, b}`: each word once, `chosen` (an index) among them.
bool cursor_words(cursor *c, const char *word, const char *const **words, size_t *count,
                  size_t *chosen);
bool cursor_help(cursor *c, const char **out); // ": text", required, to the end

bool declaration_read(const cursor *c, const char *code, declaration *out);
const char *declaration_public_name(arena *memory, const char *glsl_name);

// The parts that say what a shader declares; `kind` selects what is filled in.
bool annotation_uniform(cursor *c, const declaration *d, value_desc *out);
bool annotation_image(cursor *c, const declaration *d, shader_image *out);
bool annotation_option(cursor *c, value_desc *out);
bool annotation_field(cursor *c, shader_field *out);
bool annotation_counter(cursor *c, shader_counter *out);
