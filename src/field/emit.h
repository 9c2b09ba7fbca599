// Between the two halves of the generator: program.c finds what an expression is made of and where
// its numbers and textures lie, emit.c writes the functions.
#pragma once
#include "base/map.h"
#include "base/str.h"
#include "field/program.h"

enum { NONE = UINT32_MAX };

typedef struct program_node { // a distinct expression
    const field *node;
    uint32_t args[FIELD_MAX_ARGS]; // indices of program_nodes
    uint32_t number; // where its value lies in the block, when it is read: 4 * vec4 + component
    bool needed;     // the host evaluates it
    float cost;      // with its arguments
} program_node;

typedef enum program_slot_kind {
    SLOT_NUMBER,    // value of a node that does not vary in space
    SLOT_GRID,      // 5 vec4: box min, blend; 1 / box size, texels a metre; active min; active max;
                    // bricks along each side. w of the last three: texels along each side. Then,
                    // of slices round an axis, the four of field_extrusion_numbers
    SLOT_PALETTE,   // 1 vec4: min, 1 / (max - min)
    SLOT_TRANSFORM, // 3 vec4: rows of the matrix to where the field is sampled
} program_slot_kind;

typedef struct program_slot {
    program_slot_kind kind;
    uint32_t at;        // 4 * vec4 + component
    uint32_t node;      // SLOT_NUMBER, SLOT_TRANSFORM: program_node
    const void *object; // SLOT_GRID, SLOT_PALETTE
} program_slot;

typedef struct program_grid {
    const field_grid *grid;
    uint32_t at; // slot, in vec4
    bool used[FIELD_GRID_IMAGES];
    bool ranged[FIELD_GRID_IMAGES]; // its ranges are asked for
} program_grid;

typedef struct program_palette {
    const palette *table;
    uint32_t at; // slot, in vec4
} program_palette;

struct field_program {
    const field_root *roots;
    size_t root_count;
    uint32_t *root_nodes;
    program_node *nodes; // arguments come before what uses them
    size_t node_count, node_capacity;
    program_slot *slots;
    size_t slot_count, slot_capacity;
    uint32_t vec4s;   // of the block
    uint32_t scalars; // next free component for a single number, or NONE
    program_grid *grids;
    size_t grid_count, grid_capacity;
    program_palette *palettes;
    size_t palette_count, palette_capacity;
    float (*values)[4]; // of the nodes, while filling
    field_texture *textures;
    size_t texture_count;
    const char *text;
};

// Places in the block and in the lists, made on first use, in order of use.
uint32_t program_number(field_program *p, uint32_t node);
uint32_t program_transform(field_program *p, uint32_t node);
program_grid *program_use_grid(field_program *p, const field_grid *grid, size_t *index);
program_palette *program_use_palette(field_program *p, const palette *table, size_t *index);

bool program_extrudes(const field_program *p); // a grid of it is slices round an axis
const char *program_type(int components);      // "float", "vec3", "vec4"

// The sampler and the function of an image of a grid, the g-th of the program.
void emit_grid_fetch(const program_grid *grid, size_t g, int image, strbuf *out);

// The globals and functions of all roots. False with a message when there are too many operations.
bool program_emit(field_program *p, strbuf *out);
