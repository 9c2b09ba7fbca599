// From fields to GLSL: one include file with a function per root, the numbers it needs as one
// uniform block, the textures it needs as samplers. Needs no device. Changing a number never
// changes the text; equal structure gives equal text.
#pragma once
#include "field/field.h"

typedef struct field_root {
    const char *name; // the text defines `T field_NAME(vec3 p)`
    const field *node;
    int components; // T: float, vec3, vec4; the node has as many, or one (widened); a node of
                    // four under a root of three drops its alpha
    // Name of an earlier root, or "": this root is only called right after that one, at the same
    // point, and only when that one was not zero. It then reuses what that one computed.
    const char *after;
} field_root;

typedef struct field_program field_program;

field_program *field_program_create(arena *memory, const field_root *roots, size_t count);
const char *field_program_text(const field_program *p); // #include as "fields.glsl"

// The uniform block "FieldNumbers" (std140): maximal subtrees that do not vary in space are
// evaluated here, on the host, once a frame. Size in bytes, 0 when there are none.
size_t field_program_block_size(const field_program *p);
bool field_program_fill(const field_program *p, const field_context *context, void *block);

typedef struct field_texture { // one sampler of the text
    const char *glsl_name;
    const field_grid *grid; // with `image` and `set`: grid->state.images[set][image]
    int image, set;
    bool ranges;            // instead: least and greatest values of that image (pass/ranges.h)
    bool index;             // of that image, instead: state.index[set][image]
    const palette *palette; // or a palette's texture (2D, PALETTE_SIZE x 1)
} field_texture;
size_t field_program_textures(const field_program *p, const field_texture **out);
// User files included by the text, for a reload to watch, are reported by shader_compile.
