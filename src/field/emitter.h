// Inside the writer of functions: emit.c decides where an operation is computed, emit_value.c
// writes the computation.
#pragma once
#include "field/emit.h"
#include "field/kinds.h"

enum { EXPR = 96 };                 // bytes of a written expression
static const float dear = 16;       // cost from which an operation is worth a branch
static const float very_dear = 100; // and from which a number is worth being tested for zero

typedef enum op_type { OP_NODE, OP_FETCH, OP_POINT } op_type;

typedef struct op {
    op_type type;
    uint32_t id, point; // node, 4 * grid + image or point; where it is taken
    int components;
    float cost;
    bool global, lazy, hoisted; // see emit.c
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

// ---- emit.c -----------------------------------------------------------------------------------

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

// ---- emit_value.c -----------------------------------------------------------------------------

void emit_node(emitter *e, uint32_t node, uint32_t at, char out[EXPR]);
void emit_compute(emitter *e, uint32_t index); // writes "name = value;" and what it needs
void emit_widen(char text[EXPR], int from, int to);
// ", width" in the space of a point, of what a sample stands for at the argument of the function.
void emit_width(const emitter *e, const char *width, uint32_t at, strbuf *out);

// ---- emit_range.c -----------------------------------------------------------------------------

void emit_ranges(emitter *e, strbuf *out); // after the functions of all values
