// From fields to GLSL, second half: the functions. An operation is a node, a texture fetch or a
// moved point, at a point; each is computed once where it is visible.
//
// A product computes its cheap factors first and the dear ones inside `if (product != 0)`, so that
// noise costs nothing in empty space. What is computed inside such a block is not visible after
// it. Dear operations wanted again become
//   - global, where the block has surely run: in a root `after` this one, which is called only if
//     the product of this one was not zero, so that every block of that product was entered;
//   - lazy, elsewhere: a function of their own that remembers its result until the next point;
//   - hoisted, where lazy functions would nest deeper than LEVELS (compilers unfold every call):
//     computed at the beginning of every root.
// Whether an operation is wanted again is known at the end, so the functions are written again with
// the flags found until no flag is new. Flags only grow, hence this ends.
//
// Invariant: a dear operation is computed in one place of a root and what comes after it; cheap
// ones have fewer than `dear` nodes below them; products are only unfolded where nobody else uses
// them. So the text grows linearly.
#include "base/error.h"
#include "base/memory.h"
#include "field/program_parts.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_INDENT = 40, LEVELS = 3 };

void emit_line(emitter *e, const char *format, ...) {
    char text[1200];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    int indent = e->indent < MAX_INDENT ? e->indent : MAX_INDENT;
    strbuf_add(&e->body, "%*s%s\n", 4 * indent, "", text);
}

void emit_open(emitter *e, bool sure) {
    MEM_RESERVE(e->scopes, e->scope_count + 1, e->scope_capacity);
    e->scopes[e->scope_count] = (scope){e->current, e->unit, true, sure};
    e->current = (uint32_t)e->scope_count++;
    e->indent++;
}

void emit_close(emitter *e) {
    e->scopes[e->current].open = false;
    e->current = e->scopes[e->current].parent;
    e->indent--;
    emit_line(e, "}");
}

// ---- operations and points --------------------------------------------------------------------

uint32_t emit_find_op(emitter *e, op_type type, uint32_t id, uint32_t at, int components,
                      float cost) {
    const void *key = (const void *)(uintptr_t)((uint64_t)(type + 1) << 32 | id);
    const uint32_t *known = map_find(&e->op_places, key, at);
    if (known) return *known;
    if (e->op_count >= FIELD_MAX_NODES) { // emit_op writes nothing from here on
        e->failed = true;
        return 0;
    }
    uint32_t index = (uint32_t)e->op_count;
    *MEM_ADD(e->ops, e->op_count, e->op_capacity) =
        (op){type, id, at, components, cost, .round = 0};
    map_set(&e->op_places, key, at, index);
    return index;
}

uint32_t emit_find_point(emitter *e, uint32_t node, uint32_t parent) {
    const program_node *n = &e->p->nodes[node];
    bool warp = kind_of(n->node) == KIND_WARP;
    for (uint32_t i = 1; i < e->point_count; i++) {
        const point *other = &e->points[i];
        if (other->parent != parent || (other->by == NONE) == warp) continue;
        const uint32_t *args = e->p->nodes[other->node].args;
        if (memcmp(args + 1, n->args + 1, (FIELD_MAX_ARGS - 1) * sizeof *args) == 0) return i;
    }
    MEM_RESERVE(e->points, e->point_count + 1, e->point_capacity);
    point made = {parent, node, NONE, NONE, NONE};
    if (warp) {
        made.by = n->args[1];
        made.amount = n->args[2];
    } else {
        made.matrix = program_transform(e->p, node);
    }
    e->points[e->point_count] = made;
    return (uint32_t)e->point_count++;
}

void emit_op_name(const emitter *e, uint32_t index, char out[EXPR]) {
    const op *o = &e->ops[index];
    snprintf(out, EXPR, "%sv%u", o->global || o->lazy || o->hoisted ? "fields_" : "", index);
}

bool emit_is_visible(const emitter *e, uint32_t index) {
    const op *o = &e->ops[index];
    return o->round == e->round && e->scopes[o->scope].open && e->scopes[o->scope].unit == e->unit;
}

static bool is_root(const emitter *e, uint32_t unit) {
    return unit < e->p->root_count;
}

static bool comes_after(const emitter *e, size_t root, size_t earlier) {
    while (root != earlier) {
        const char *after = e->p->roots[root].after;
        if (!after || !after[0]) return false;
        for (root = 0; strcmp(e->p->roots[root].name, after) != 0;) root++;
    }
    return true;
}

// ---- where an operation is computed -----------------------------------------------------------

// True when the operation's value can be read as it stands, or will be once this round's new flags
// are heeded.
static bool reuse(emitter *e, uint32_t index) {
    op *o = &e->ops[index];
    if (emit_is_visible(e, index)) return true;
    if (o->round != e->round || o->lazy || o->cost < dear) return false;
    if (is_root(e, o->unit) && is_root(e, e->unit) && o->unit != e->unit) {
        if (!comes_after(e, e->unit, o->unit)) return false; // functions that share nothing
        if (o->sure) {
            e->again = e->again || !o->global;
            o->global = true;
            return true;
        }
    }
    o->lazy = e->again = true;
    return true;
}

static void compute_here(emitter *e, uint32_t index) {
    uint32_t unit = e->unit;
    bool sure = e->scopes[e->current].sure;
    emit_compute(e, index);
    op *o = &e->ops[index];
    o->unit = unit;
    o->sure = sure;
    o->round = e->round;
    o->scope = e->current;
    if (o->finished == 0) o->finished = ++e->finished;
}

// What is visible where a function is called is so after the call, though the function may have
// computed the same for itself.
typedef struct place {
    uint32_t index, scope, unit;
    bool sure;
} place;

static place *list_visible(const emitter *e, size_t *count) {
    place *list = NULL;
    size_t capacity = 0;
    *count = 0;
    for (uint32_t i = 0; i < e->op_count; i++) {
        const op *o = &e->ops[i];
        if (!emit_is_visible(e, i)) continue;
        *MEM_ADD(list, *count, capacity) = (place){i, o->scope, o->unit, o->sure};
    }
    return list;
}

static void restore_visible(emitter *e, const place *list, size_t count) {
    for (size_t i = 0; i < count; i++) {
        op *o = &e->ops[list[i].index];
        o->round = e->round;
        o->scope = list[i].scope;
        o->unit = list[i].unit;
        o->sure = list[i].sure;
    }
}

// Writes the function of a lazy operation, beside the function being written.
static void write_lazy(emitter *e, uint32_t index) {
    emitter outer = *e;
    size_t visible_count;
    place *visible = list_visible(e, &visible_count);
    e->ops[index].function_round = e->round;
    memset(&e->body, 0, sizeof e->body);
    e->unit = e->units++;
    e->current = 0;
    e->indent = e->level = 0;
    emit_line(e, "void fields_lazy%u(vec3 p) {", index);
    emit_open(e, false);
    emit_line(e, "if (fields_done%u != fields_turn) {", index);
    emit_open(e, false);
    compute_here(e, index);
    emit_line(e, "fields_done%u = fields_turn;", index);
    emit_close(e);
    emit_close(e);
    strbuf_append(&e->functions, strbuf_text(&e->body), e->body.length);
    strbuf_free(&e->body);
    op *o = &e->ops[index];
    o->level = e->level + 1;
    if (o->level > LEVELS) {
        o->hoisted = e->again = true;
        o->lazy = false;
    }
    e->body = outer.body;
    e->unit = outer.unit;
    e->current = outer.current;
    e->indent = outer.indent;
    e->level = outer.level;
    restore_visible(e, visible, visible_count);
    mem_free(visible);
}

void emit_op(emitter *e, uint32_t index, char out[EXPR]) {
    if (e->failed) {
        snprintf(out, EXPR, "0");
        return;
    }
    // Hoisted operations come in order of need, so that here all but the one at hand are known.
    if (!e->ops[index].hoisted && !reuse(e, index)) {
        if (e->ops[index].lazy) {
            if (e->ops[index].function_round != e->round) write_lazy(e, index);
            if (e->ops[index].level > e->level) e->level = e->ops[index].level;
            emit_line(e, "fields_lazy%u(p);", index);
            e->ops[index].round = e->round;
            e->ops[index].scope = e->current;
        } else {
            compute_here(e, index);
        }
    }
    emit_op_name(e, index, out);
}

// ---- functions --------------------------------------------------------------------------------

typedef struct hoist {
    uint32_t index, finished;
} hoist;

static int by_finish(const void *a, const void *b) {
    const hoist *x = a, *y = b;
    return x->finished < y->finished ? -1 : x->finished > y->finished;
}

static void write_hoisted(emitter *e) {
    hoist *list = NULL;
    size_t count = 0, capacity = 0;
    for (uint32_t i = 0; i < e->op_count; i++) {
        if (!e->ops[i].hoisted) continue;
        *MEM_ADD(list, count, capacity) = (hoist){i, e->ops[i].finished};
    }
    if (count > 1) qsort(list, count, sizeof *list, by_finish);
    for (size_t i = 0; i < count && !e->failed; i++) compute_here(e, list[i].index);
    mem_free(list);
}

// A product at the heart of a root: its blocks have run when the root is not zero.
static uint32_t find_top(emitter *e, uint32_t node) {
    uint32_t at = 0;
    const program_node *n = &e->p->nodes[node];
    while (!n->node->uniform &&
           (kind_of(n->node) == KIND_WARP || kind_of(n->node) == KIND_TRANSFORM)) {
        at = emit_find_point(e, node, at);
        node = n->args[0];
        n = &e->p->nodes[node];
    }
    if (kind_of(n->node) != KIND_MUL || n->node->uniform) return NONE;
    return emit_find_op(e, OP_NODE, node, at, n->node->components, n->cost);
}

static void write_root(emitter *e, uint32_t index) {
    const field_root *root = &e->p->roots[index];
    uint32_t node = e->p->root_nodes[index];
    char value[EXPR];
    e->unit = index;
    e->current = 0;
    e->indent = e->level = 0;
    e->top = find_top(e, node);
    emit_line(e, "%s field_%s(vec3 p) {", program_type(root->components), root->name);
    emit_open(e, true);
    if (!root->after || !root->after[0]) { // another point
        if (e->turns) emit_line(e, "fields_turn++;");
        write_hoisted(e);
    }
    emit_node(e, node, 0, value);
    emit_widen(value, e->p->nodes[node].node->components, root->components);
    emit_line(e, "return %s;", value);
    emit_close(e);
    strbuf_append(&e->functions, strbuf_text(&e->body), e->body.length);
    strbuf_free(&e->body);
}

// A root, then what comes after it: between them nobody else computes the same operations.
static void write_family(emitter *e, uint32_t index) {
    if (e->failed) return;
    write_root(e, index);
    for (uint32_t i = index + 1; i < e->p->root_count; i++) {
        const char *after = e->p->roots[i].after;
        if (after && strcmp(after, e->p->roots[index].name) == 0) write_family(e, i);
    }
}

static void write_all(emitter *e) {
    e->again = false;
    e->round++;
    e->scope_count = 0;
    e->units = (uint32_t)e->p->root_count;
    strbuf_free(&e->functions);
    MEM_RESERVE(e->scopes, 1, e->scope_capacity);
    e->scopes[e->scope_count++] = (scope){0, NONE, false, false};
    e->turns = false;
    for (size_t i = 0; i < e->op_count; i++) e->turns = e->turns || e->ops[i].lazy;
    for (uint32_t i = 0; i < e->p->root_count; i++) {
        const char *after = e->p->roots[i].after;
        if (!after || !after[0]) write_family(e, i);
    }
}

static void add_globals(const emitter *e, strbuf *out) {
    for (uint32_t i = 0; i < e->op_count; i++) {
        const op *o = &e->ops[i];
        if (!o->global && !o->lazy && !o->hoisted) continue;
        strbuf_add(out, "%s fields_v%u;\n", program_type(o->components), i);
        if (o->lazy) strbuf_add(out, "uint fields_done%u = 0u;\n", i);
    }
    if (e->turns) strbuf_add(out, "uint fields_turn = 0u;\n");
}

static void count_uses(emitter *e) {
    for (size_t i = 0; i < e->p->node_count; i++)
        for (size_t k = 0; k < FIELD_MAX_ARGS && e->p->nodes[i].args[k] != NONE; k++)
            e->uses[e->p->nodes[i].args[k]]++;
    for (size_t i = 0; i < e->p->root_count; i++) e->uses[e->p->root_nodes[i]]++;
}

bool program_emit(field_program *p, strbuf *out) {
    emitter e = {.p = p};
    e.uses = mem_alloc((p->node_count + 1) * sizeof *e.uses);
    MEM_RESERVE(e.points, 1, e.point_capacity);
    e.points[e.point_count++] = (point){0, NONE, NONE, NONE, NONE};
    count_uses(&e);
    do write_all(&e);
    while (e.again && !e.failed);
    if (e.failed) err_set("the fields have more than %d operations", FIELD_MAX_NODES);
    add_globals(&e, out);
    strbuf_append(out, strbuf_text(&e.functions), e.functions.length);
    if (!e.failed) emit_ranges(&e, out);
    mem_free(e.uses);
    mem_free(e.ops);
    mem_free(e.points);
    mem_free(e.scopes);
    map_free(&e.op_places);
    strbuf_free(&e.body);
    strbuf_free(&e.functions);
    return !e.failed;
}
