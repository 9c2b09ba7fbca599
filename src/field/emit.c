// From fields to GLSL, second half: the functions. An operation is a node, a texture fetch or a
// moved point, at a point; each is computed once where it is visible.
//
// A product computes its cheap factors first and the dear ones inside `if (product != 0)`, so that
// noise costs nothing in empty space. What is computed inside such a block is not visible after
// it. Dear operations wanted again become
//   - global, where the block has surely run: in a root `after` this one, which is called only if
//     the product of this one was not zero, so that every block of that product was entered;
//   - lazy, elsewhere: a global with a flag beside it that says whether it was computed.
// Whether an operation is wanted again is known at the end, so the functions are written again with
// the flags found until no flag is new. Flags only grow, hence this ends.
//
// Invariant: cheap operations, which are written again instead, have fewer than DEAR nodes below
// them; products are only unfolded where nobody else uses them. So the text grows linearly.
#include "field/emit.h"
#include "base/error.h"
#include "base/memory.h"
#include "field/kinds.h"
#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MAX_FACTORS = 32, EXPR = 96, MAX_INDENT = 40 };
static const float dear = 16; // cost from which an operation is worth a branch

typedef enum op_type { OP_NODE, OP_FETCH, OP_POINT } op_type;

typedef struct op {
    op_type type;
    uint32_t id, point; // node, 4 * grid + image or point; where it is taken
    int components;
    float cost;
    bool global, lazy;
    // As last written:
    uint32_t round, scope;
    size_t owner; // root that computes it first
    bool sure;    // and does so whenever it is not zero
} op;

typedef struct point {                 // index 0: the argument of the root
    uint32_t parent, node, by, amount; // by, amount: NONE for a "transform"
    uint32_t matrix;
} point;

typedef struct scope {
    uint32_t parent;
    bool open, sure;
} scope;

typedef struct emitter {
    field_program *p;
    strbuf body;
    uint32_t *uses; // of nodes, by others
    op *ops;
    size_t op_count, op_capacity;
    map op_places;
    point *points;
    size_t point_count, point_capacity;
    scope *scopes;
    size_t scope_count, scope_capacity;
    uint32_t current; // scope
    int indent;
    uint32_t round;
    size_t root;
    uint32_t top; // operation whose blocks are sure, or NONE
    bool again, failed;
} emitter;

static void emit_node(emitter *e, uint32_t node, uint32_t at, char out[EXPR]);

static void line(emitter *e, const char *format, ...) PRINTF_LIKE(2, 3);
static void line(emitter *e, const char *format, ...) {
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    int indent = e->indent < MAX_INDENT ? e->indent : MAX_INDENT;
    strbuf_add(&e->body, "%*s%s\n", 4 * indent, "", text);
}

static void open_scope(emitter *e, bool sure) {
    MEM_RESERVE(e->scopes, e->scope_count + 1, e->scope_capacity);
    e->scopes[e->scope_count] = (scope){e->current, true, sure};
    e->current = (uint32_t)e->scope_count++;
    e->indent++;
}

static void close_scope(emitter *e) {
    e->scopes[e->current].open = false;
    e->current = e->scopes[e->current].parent;
    e->indent--;
    line(e, "}");
}

// ---- operations and points --------------------------------------------------------------------

static uint32_t find_op(emitter *e, op_type type, uint32_t id, uint32_t at, int components,
                        float cost) {
    const void *key = (const void *)(uintptr_t)((uint64_t)(type + 1) << 32 | id);
    const uint32_t *known = map_find(&e->op_places, key, at);
    if (known) return *known;
    uint32_t index = (uint32_t)e->op_count;
    if (index >= FIELD_MAX_NODES) { // writes on, bounded, and fails at the end
        e->failed = true;
        index = 0;
        return index;
    }
    MEM_RESERVE(e->ops, e->op_count + 1, e->op_capacity);
    e->ops[e->op_count++] = (op){type, id, at, components, cost, .round = 0};
    map_set(&e->op_places, key, at, index);
    return index;
}

static uint32_t find_point(emitter *e, uint32_t node, uint32_t parent) {
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

static void op_name(const emitter *e, uint32_t index, char out[EXPR]) {
    const op *o = &e->ops[index];
    snprintf(out, EXPR, "%sv%u", o->global || o->lazy ? "fields_" : "", index);
}

static bool comes_after(const emitter *e, size_t root, size_t earlier) {
    while (root != earlier) {
        const char *after = e->p->roots[root].after;
        if (!after || !after[0]) return false;
        for (root = 0; strcmp(e->p->roots[root].name, after) != 0;) root++;
    }
    return true;
}

static void declare(emitter *e, uint32_t index, const char *format, ...) PRINTF_LIKE(3, 4);
static void declare(emitter *e, uint32_t index, const char *format, ...) {
    char name[EXPR], value[900];
    va_list args;
    va_start(args, format);
    vsnprintf(value, sizeof value, format, args);
    va_end(args);
    op_name(e, index, name);
    const op *o = &e->ops[index];
    bool declared = o->global || o->lazy;
    line(e, "%s%s%s = %s;", declared ? "" : program_type(o->components), declared ? "" : " ", name,
         value);
}

// ---- values -----------------------------------------------------------------------------------

static void write_number(uint32_t at, int components, char out[EXPR]) {
    if (components == 1)
        snprintf(out, EXPR, "field_numbers[%u].%c", at / 4, "xyzw"[at % 4]);
    else
        snprintf(out, EXPR, "field_numbers[%u]%s", at / 4, components == 3 ? ".xyz" : "");
}

static void widen(char text[EXPR], int from, int to) {
    if (from == to) return;
    char wide[EXPR];
    if (from == 1)
        snprintf(wide, EXPR, "%s(%.80s)", program_type(to), text);
    else
        snprintf(wide, EXPR, "%.80s.rgb", text);
    memcpy(text, wide, EXPR);
}

static void emit_arg(emitter *e, uint32_t node, size_t i, uint32_t at, char out[EXPR]) {
    const program_node *n = &e->p->nodes[node];
    emit_node(e, n->args[i], at, out);
    widen(out, n->node->args[i]->components, kind_arg_width(n->node, i));
}

static void emit_op(emitter *e, uint32_t index, char out[EXPR]);

static void emit_point(emitter *e, uint32_t at, char out[EXPR]) {
    if (at == 0) {
        snprintf(out, EXPR, "p");
        return;
    }
    const point *q = &e->points[at];
    float cost = q->by == NONE ? 6 : e->p->nodes[q->by].cost + e->p->nodes[q->amount].cost + 2;
    emit_op(e, find_op(e, OP_POINT, at, q->parent, 3, cost), out);
}

static void compute_point(emitter *e, uint32_t index) {
    point q = e->points[e->ops[index].id];
    char from[EXPR], by[EXPR], amount[EXPR];
    emit_point(e, q.parent, from);
    if (q.by == NONE) {
        unsigned m = q.matrix;
        declare(e, index,
                "vec3(dot(field_numbers[%u].xyz, %s) + field_numbers[%u].w, "
                "dot(field_numbers[%u].xyz, %s) + field_numbers[%u].w, "
                "dot(field_numbers[%u].xyz, %s) + field_numbers[%u].w)",
                m, from, m, m + 1, from, m + 1, m + 2, from, m + 2);
        return;
    }
    emit_arg(e, q.node, 1, q.parent, by);
    emit_arg(e, q.node, 2, q.parent, amount);
    declare(e, index, "%s + %s * %s", from, amount, by);
}

static void emit_fetch(emitter *e, size_t grid, int image, uint32_t at, char out[EXPR]) {
    uint32_t id = 4 * (uint32_t)grid + (uint32_t)image;
    e->p->grids[grid].used[image] = true;
    emit_op(e, find_op(e, OP_FETCH, id, at, 4, 30), out);
}

static void emit_grid(emitter *e, const field *node, uint32_t at, char out[EXPR]) {
    size_t grid;
    program_use_grid(e->p, node->object, &grid);
    int first = node->index, last = first + node->components - 1;
    char a[EXPR], b[EXPR];
    emit_fetch(e, grid, first / 4, at, a);
    if (first / 4 == last / 4) {
        snprintf(out, EXPR, "%.80s.%.*s", a, node->components, "xyzw" + first % 4);
        return;
    }
    emit_fetch(e, grid, last / 4, at, b); // channels in two images
    int split = 4 - first % 4;
    snprintf(out, EXPR, "%s(%.30s.%.*s, %.30s.%.*s)", program_type(node->components), a, split,
             "xyzw" + first % 4, b, node->components - split, "xyzw");
}

static void emit_swizzle(emitter *e, uint32_t node, uint32_t at, char out[EXPR]) {
    const program_node *n = &e->p->nodes[node];
    int count = n->node->components, from = n->node->args[0]->components;
    emit_node(e, n->args[0], at, out);
    if (from == 1) {
        widen(out, 1, count);
        return;
    }
    size_t length = strlen(out);
    assert(length + 6 < EXPR);
    out[length++] = '.';
    for (int i = 0; i < count; i++) out[length++] = "xyzw"[n->node->index >> 2 * i & 3];
    out[length] = '\0';
}

// ---- products ---------------------------------------------------------------------------------

typedef struct factor {
    uint32_t node;
    float cost;
} factor;

static float remaining_cost(emitter *e, uint32_t node, uint32_t at) { // nothing if visible
    const program_node *n = &e->p->nodes[node];
    if (n->node->uniform) return 0;
    const void *key = (const void *)(uintptr_t)((uint64_t)(OP_NODE + 1) << 32 | node);
    const uint32_t *known = map_find(&e->op_places, key, at);
    bool written = known && e->ops[*known].round == e->round;
    return written && e->scopes[e->ops[*known].scope].open ? 0 : n->cost;
}

static void collect_factors(emitter *e, uint32_t node, uint32_t at, factor out[MAX_FACTORS],
                            size_t *count) {
    for (size_t i = 0; i < 2; i++) {
        uint32_t arg = e->p->nodes[node].args[i];
        const field *a = e->p->nodes[arg].node;
        bool unfold = kind_of(a) == KIND_MUL && !a->uniform && e->uses[arg] == 1;
        if (unfold && *count + 4 < MAX_FACTORS) {
            collect_factors(e, arg, at, out, count);
            continue;
        }
        factor f = {arg, remaining_cost(e, arg, at)};
        size_t place = (*count)++;
        for (; place > 0 && out[place - 1].cost > f.cost; place--) out[place] = out[place - 1];
        out[place] = f;
    }
}

static void compute_product(emitter *e, uint32_t index) {
    uint32_t at = e->ops[index].point;
    int components = e->ops[index].components;
    bool sure = e->top == index && e->scopes[e->current].sure;
    factor factors[MAX_FACTORS];
    size_t count = 0, opened = 0;
    collect_factors(e, e->ops[index].id, at, factors, &count);
    char name[EXPR], value[EXPR];
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && factors[i].cost >= dear) {
            op_name(e, index, name);
            if (components == 1)
                line(e, "if (%s != 0.0) {", name);
            else
                line(e, "if (%s != %s(0.0)) {", name, program_type(components));
            open_scope(e, sure);
            opened++;
        }
        emit_node(e, factors[i].node, at, value);
        if (i == 0) {
            widen(value, e->p->nodes[factors[i].node].node->components, components);
            declare(e, index, "%s", value);
        } else {
            op_name(e, index, name);
            line(e, "%s *= %s;", name, value);
        }
    }
    while (opened-- > 0) close_scope(e);
}

// ---- nodes ------------------------------------------------------------------------------------

static void compute_call(emitter *e, uint32_t index) {
    op o = e->ops[index];
    const field *node = e->p->nodes[o.id].node;
    bool user = kind_of(node) == KIND_GLSL;
    strbuf call = {0};
    char text[EXPR];
    const char *comma = "";
    if (user || node->kind->spatial) {
        emit_point(e, o.point, text);
        strbuf_add(&call, "%s", text);
        comma = ", ";
    }
    for (size_t i = 0; i < kind_arg_count(node); i++, comma = ", ") {
        emit_arg(e, o.id, i, o.point, text);
        strbuf_add(&call, "%s%s", comma, text);
    }
    for (size_t i = 0; !user && i < FIELD_MAX_OPTIONS && node->kind->options[i].name; i++)
        strbuf_add(&call, ", %d", node->options[i]);
    const char *function = node->kind->function;
    if (user) function = ((const field_glsl *)node->object)->function;
    declare(e, index, "%s(%s)", function, strbuf_text(&call));
    strbuf_free(&call);
}

static void compute_node(emitter *e, uint32_t index) {
    op o = e->ops[index];
    const field *node = e->p->nodes[o.id].node;
    char a[EXPR], b[EXPR];
    size_t table;
    switch (kind_of(node)) {
    case KIND_MUL:
        compute_product(e, index);
        return;
    case KIND_ADD:
    case KIND_SUB:
        emit_arg(e, o.id, 0, o.point, a);
        emit_arg(e, o.id, 1, o.point, b);
        declare(e, index, "%s %c %s", a, kind_of(node) == KIND_ADD ? '+' : '-', b);
        return;
    case KIND_NEGATE:
        emit_arg(e, o.id, 0, o.point, a);
        declare(e, index, "-%s", a);
        return;
    case KIND_PALETTE: {
        emit_arg(e, o.id, 0, o.point, a);
        unsigned at = program_use_palette(e->p, node->object, &table)->at;
        declare(e, index,
                "textureLod(field_palette_%zu, vec2((%s - field_numbers[%u].x) * "
                "field_numbers[%u].y, 0.5), 0.0)",
                table, a, at, at);
        return;
    }
    default:
        compute_call(e, index);
        return;
    }
}

static void compute(emitter *e, uint32_t index) {
    op o = e->ops[index];
    char from[EXPR];
    switch (o.type) {
    case OP_NODE:
        compute_node(e, index);
        break;
    case OP_POINT:
        compute_point(e, index);
        break;
    case OP_FETCH:
        emit_point(e, o.point, from);
        declare(e, index, "field_fetch_%u_%u(%s)", o.id / 4, o.id % 4, from);
        break;
    }
}

// True when the operation's value can be read as it stands.
static bool reuse(emitter *e, uint32_t index) {
    op *o = &e->ops[index];
    if (o->round != e->round) return false;
    if (e->scopes[o->scope].open) return true;
    if (o->cost < dear || !comes_after(e, e->root, o->owner)) {
        o->round = 0;
        return false;
    }
    if (o->lazy) return false;
    if (o->owner != e->root && o->sure) {
        if (!o->global) e->again = true;
        o->global = true;
        return true;
    }
    o->lazy = e->again = true;
    return false;
}

static void emit_op(emitter *e, uint32_t index, char out[EXPR]) {
    if (e->failed) {
        snprintf(out, EXPR, "0");
        return;
    }
    if (!reuse(e, index)) {
        bool lazy = e->ops[index].lazy, first = e->ops[index].round != e->round;
        if (first) {
            e->ops[index].owner = e->root;
            e->ops[index].sure = e->scopes[e->current].sure;
        }
        if (lazy) {
            line(e, "if (!fields_done%u) {", index);
            open_scope(e, false);
            line(e, "fields_done%u = true;", index);
        }
        compute(e, index);
        if (lazy) close_scope(e);
        e->ops[index].round = e->round;
        e->ops[index].scope = e->current;
    }
    op_name(e, index, out);
}

static void emit_node(emitter *e, uint32_t node, uint32_t at, char out[EXPR]) {
    const program_node *n = &e->p->nodes[node];
    if (n->node->uniform) {
        write_number(program_number(e->p, node), n->node->components, out);
        return;
    }
    switch (kind_of(n->node)) {
    case KIND_GRID:
        emit_grid(e, n->node, at, out);
        return;
    case KIND_SWIZZLE:
        emit_swizzle(e, node, at, out);
        return;
    case KIND_POSITION:
        emit_point(e, at, out);
        return;
    case KIND_WARP:
    case KIND_TRANSFORM:
        emit_node(e, n->args[0], find_point(e, node, at), out);
        return;
    default:
        emit_op(e, find_op(e, OP_NODE, node, at, n->node->components, n->cost), out);
        return;
    }
}

// ---- functions --------------------------------------------------------------------------------

static void emit_root(emitter *e, size_t index) {
    const field_root *root = &e->p->roots[index];
    uint32_t node = e->p->root_nodes[index], inner = node, at = 0;
    char value[EXPR];
    e->root = index;
    e->current = 0;
    e->top = NONE;
    while (kind_of(e->p->nodes[inner].node) == KIND_WARP ||
           kind_of(e->p->nodes[inner].node) == KIND_TRANSFORM) {
        if (e->p->nodes[inner].node->uniform) break;
        at = find_point(e, inner, at);
        inner = e->p->nodes[inner].args[0];
    }
    const program_node *n = &e->p->nodes[inner];
    if (kind_of(n->node) == KIND_MUL && !n->node->uniform)
        e->top = find_op(e, OP_NODE, inner, at, n->node->components, n->cost);
    line(e, "%s field_%s(vec3 p) {", program_type(root->components), root->name);
    open_scope(e, true);
    size_t start = e->body.length;
    emit_node(e, node, 0, value);
    widen(value, e->p->nodes[node].node->components, root->components);
    line(e, "return %s;", value);
    strbuf resets = {0}; // what is lazy here has not been computed at this point yet
    for (uint32_t i = 0; i < e->op_count; i++)
        if (e->ops[i].lazy && e->ops[i].round == e->round && e->ops[i].owner == index)
            strbuf_add(&resets, "    fields_done%u = false;\n", i);
    strbuf tail = {0};
    strbuf_append(&tail, strbuf_text(&e->body) + start, e->body.length - start);
    e->body.length = start;
    strbuf_append(&e->body, strbuf_text(&resets), resets.length);
    strbuf_append(&e->body, strbuf_text(&tail), tail.length);
    strbuf_free(&resets);
    strbuf_free(&tail);
    close_scope(e);
}

static void emit_round(emitter *e) {
    e->again = false;
    e->round++;
    e->scope_count = 0;
    e->indent = 0;
    strbuf_free(&e->body);
    MEM_RESERVE(e->scopes, 1, e->scope_capacity);
    e->scopes[e->scope_count++] = (scope){0, false, false};
    for (size_t i = 0; i < e->p->root_count && !e->failed; i++) emit_root(e, i);
}

static void add_globals(const emitter *e, strbuf *out) {
    for (uint32_t i = 0; i < e->op_count; i++) {
        const op *o = &e->ops[i];
        if (!o->global && !o->lazy) continue;
        strbuf_add(out, "%s fields_v%u;\n", program_type(o->components), i);
        if (o->lazy) strbuf_add(out, "bool fields_done%u;\n", i);
    }
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
    do emit_round(&e);
    while (e.again && !e.failed);
    if (e.failed) err_set("the fields have more than %d operations", FIELD_MAX_NODES);
    add_globals(&e, out);
    strbuf_append(out, strbuf_text(&e.body), e.body.length);
    mem_free(e.uses);
    mem_free(e.ops);
    mem_free(e.points);
    mem_free(e.scopes);
    map_free(&e.op_places);
    strbuf_free(&e.body);
    return !e.failed;
}
