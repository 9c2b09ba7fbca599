// The inside of the generator. program.c finds what an expression is made of and where its numbers
// and textures lie. Of the functions, program_emit.c decides where an operation is computed,
// program_value.c writes the computation, program_range.c that of ranges, and program_grid.c how a
// grid is sampled.
#pragma once
#include "base/map.h"
#include "base/str.h"
#include "field/kinds.h"
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

// ---- functions, while they are written ---------------------------------------------------------

enum { EXPR = 96 };                 // bytes of a written expression
static const float dear = 16;       // cost from which an operation is worth a branch
static const float very_dear = 100; // and from which a number is worth being tested for zero

typedef enum op_type { OP_NODE, OP_FETCH, OP_POINT } op_type;

typedef struct op {
    op_type type;
    uint32_t id, point; // node, 4 * grid + image or point; where it is taken
    int components;
    float cost;
    bool global, lazy, hoisted; // see program_emit.c
    uint32_t finished;          // order in which operations were first written, from 1
    // As last written:
    uint32_t round, scope;
    uint32_t unit;           // function that computes it
    bool sure;               // and does so whenever its result is not zero
    uint32_t function_round; // lazy: when its function was written
    int level;               // lazy: lazy operations nested in it, itself included
} op;

typedef struct point {                 // index 0: the argument of the function
    uint32_t parent, node, by, amount; // by, amount: NONE for a "transform"
    uint32_t matrix;
} point;

typedef struct scope {
    uint32_t parent, unit;
    bool open, sure;
} scope;

typedef struct emitter {
    field_program *p;
    strbuf body, functions; // of the function being written; those written
    uint32_t *uses;         // of nodes, by others
    op *ops;
    size_t op_count, op_capacity;
    map op_places;
    point *points;
    size_t point_count, point_capacity;
    scope *scopes;
    size_t scope_count, scope_capacity;
    uint32_t current; // scope
    int indent;
    uint32_t round, finished;
    uint32_t unit; // function being written: of root i, i; lazy ones follow
    uint32_t units;
    int level;    // greatest of the lazy operations called by it
    uint32_t top; // operation whose blocks are sure, or NONE
    bool turns;   // there are lazy operations
    bool again, failed;
} emitter;

// ---- program_emit.c ----------------------------------------------------------------------------

void emit_line(emitter *e, const char *format, ...) PRINTF_LIKE(2, 3);
void emit_open(emitter *e, bool sure); // after a line that ends in "{"
void emit_close(emitter *e);

uint32_t emit_find_op(emitter *e, op_type type, uint32_t id, uint32_t at, int components,
                      float cost);
uint32_t emit_find_point(emitter *e, uint32_t node, uint32_t parent);
void emit_op_name(const emitter *e, uint32_t index, char out[EXPR]);
bool emit_is_visible(const emitter *e, uint32_t index);
// The operation's value, computed before if need be.
void emit_op(emitter *e, uint32_t index, char out[EXPR]);

// ---- program_value.c ---------------------------------------------------------------------------

void emit_node(emitter *e, uint32_t node, uint32_t at, char out[EXPR]);
void emit_compute(emitter *e, uint32_t index); // writes "name = value;" and what it needs
void emit_widen(char text[EXPR], int from, int to);
// ", width" in the space of a point, of what a sample stands for at the argument of the function.
void emit_width(const emitter *e, const char *width, uint32_t at, strbuf *out);

// ---- program_range.c ---------------------------------------------------------------------------

void emit_ranges(emitter *e, strbuf *out); // after the functions of all values
