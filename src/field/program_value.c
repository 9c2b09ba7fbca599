// Values of operations: GLSL expressions for nodes, fetches and moved points. Everything that is
// worth a name becomes an operation (program_emit.c); numbers, swizzles and grid channels are
// written where they are used.
#include "field/program_parts.h"
#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MAX_FACTORS = 32 };

static void declare(emitter *e, uint32_t index, const char *format, ...) PRINTF_LIKE(3, 4);
static void declare(emitter *e, uint32_t index, const char *format, ...) {
    char name[EXPR], value[1000];
    va_list args;
    va_start(args, format);
    vsnprintf(value, sizeof value, format, args);
    va_end(args);
    emit_op_name(e, index, name);
    bool local = name[0] == 'v';
    emit_line(e, "%s%s%s = %s;", local ? program_type(e->ops[index].components) : "",
              local ? " " : "", name, value);
}

// ---- values -----------------------------------------------------------------------------------

static void write_number(uint32_t at, int components, char out[EXPR]) {
    if (components == 1)
        snprintf(out, EXPR, "field_numbers[%u].%c", at / 4, "xyzw"[at % 4]);
    else
        snprintf(out, EXPR, "field_numbers[%u]%s", at / 4, components == 3 ? ".xyz" : "");
}

void emit_widen(char text[EXPR], int from, int to) {
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
    emit_widen(out, n->node->args[i]->components, kind_arg_width(n->node, i));
}

static void emit_point(emitter *e, uint32_t at, char out[EXPR]) {
    if (at == 0) {
        snprintf(out, EXPR, "p");
        return;
    }
    const point *q = &e->points[at];
    float cost = q->by == NONE ? 6 : e->p->nodes[q->by].cost + e->p->nodes[q->amount].cost + 2;
    emit_op(e, emit_find_op(e, OP_POINT, at, q->parent, 3, cost), out);
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

static uint32_t fetch_op(emitter *e, size_t grid, int image, uint32_t at) {
    return emit_find_op(e, OP_FETCH, 4 * (uint32_t)grid + (uint32_t)image, at, 4, 30);
}

static void emit_fetch(emitter *e, size_t grid, int image, uint32_t at, char out[EXPR]) {
    e->p->grids[grid].used[image] = true;
    emit_op(e, fetch_op(e, grid, image, at), out);
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
        emit_widen(out, 1, count);
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

typedef struct factors { // of a product and of those unfolded into it, cheap ones first
    factor items[MAX_FACTORS];
    size_t count;
    size_t promised; // what `count` will be: every product that is unfolded makes it one more
} factors;

static float remaining_cost(emitter *e, uint32_t node, uint32_t at) { // nothing if visible
    const program_node *n = &e->p->nodes[node];
    uint32_t index;
    size_t grid;
    if (n->node->uniform) return 0;
    switch (kind_of(n->node)) {
    case KIND_SWIZZLE:
        return remaining_cost(e, n->args[0], at);
    case KIND_POSITION:
    case KIND_WARP:
    case KIND_TRANSFORM:
        return n->cost;
    case KIND_GRID:
        program_use_grid(e->p, n->node->object, &grid);
        index = fetch_op(e, grid, n->node->index / 4, at);
        break;
    default:
        index = emit_find_op(e, OP_NODE, node, at, n->node->components, n->cost);
        break;
    }
    return !e->failed && emit_is_visible(e, index) ? 0 : n->cost;
}

static void collect_factors(emitter *e, uint32_t node, uint32_t at, factors *out) {
    for (size_t i = 0; i < 2; i++) {
        uint32_t arg = e->p->nodes[node].args[i];
        const field *a = e->p->nodes[arg].node;
        bool unfold = kind_of(a) == KIND_MUL && !a->uniform && e->uses[arg] == 1;
        if (unfold && out->promised < MAX_FACTORS) {
            out->promised++;
            collect_factors(e, arg, at, out);
            continue;
        }
        factor f = {arg, remaining_cost(e, arg, at)};
        size_t place = out->count++;
        for (; place > 0 && out->items[place - 1].cost > f.cost; place--)
            out->items[place] = out->items[place - 1];
        out->items[place] = f;
    }
}

// Whether a factor is worth a branch on the product of those before it. What does not vary in space
// is seldom zero, and then everywhere: only for what is very dear it is asked.
static bool is_worth_asking(const emitter *e, const factors *all, size_t i) {
    if (i == 0) return false;
    bool varies = false;
    for (size_t k = 0; k < i; k++)
        varies = varies || !e->p->nodes[all->items[k].node].node->uniform;
    return all->items[i].cost >= (varies ? dear : very_dear);
}

// `name = cheap; if (name != 0) { ...; name *= dear; }`, one block in another.
static void compute_product(emitter *e, uint32_t index) {
    uint32_t at = e->ops[index].point;
    int components = e->ops[index].components;
    bool sure = e->top == index && e->scopes[e->current].sure;
    factors all = {.promised = 2};
    size_t opened = 0;
    collect_factors(e, e->ops[index].id, at, &all);
    char name[EXPR], value[EXPR];
    for (size_t i = 0; i < all.count; i++) {
        if (is_worth_asking(e, &all, i)) {
            emit_op_name(e, index, name);
            if (components == 1)
                emit_line(e, "if (%s != 0.0) {", name);
            else
                emit_line(e, "if (%s != %s(0.0)) {", name, program_type(components));
            emit_open(e, sure);
            opened++;
        }
        emit_node(e, all.items[i].node, at, value);
        if (i == 0) {
            emit_widen(value, e->p->nodes[all.items[i].node].node->components, components);
            declare(e, index, "%s", value);
        } else {
            emit_op_name(e, index, name);
            emit_line(e, "%s *= %s;", name, value);
        }
    }
    while (opened-- > 0) emit_close(e);
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

// The width of a sample, in the space of a moved point: as far as transforms, which scale, say it.
void emit_width(const emitter *e, const char *width, uint32_t at, strbuf *out) {
    const int most = 8;
    strbuf_add(out, ", %s", width);
    for (int i = 0; at != 0 && i < most; at = e->points[at].parent, i++)
        if (e->points[at].by == NONE)
            strbuf_add(out, " * length(field_numbers[%u].xyz)", e->points[at].matrix);
}

static void compute_fetch(emitter *e, uint32_t index) {
    op o = e->ops[index];
    char from[EXPR];
    strbuf width = {0};
    emit_point(e, o.point, from);
    if (e->p->grids[o.id / 4].grid->levels) emit_width(e, "grid_width", o.point, &width);
    declare(e, index, "field_fetch_%u_%u(%s%s)", o.id / 4, o.id % 4, from, strbuf_text(&width));
    strbuf_free(&width);
}

void emit_compute(emitter *e, uint32_t index) {
    op o = e->ops[index];
    switch (o.type) {
    case OP_NODE:
        compute_node(e, index);
        break;
    case OP_POINT:
        compute_point(e, index);
        break;
    case OP_FETCH:
        compute_fetch(e, index);
        break;
    }
}

void emit_node(emitter *e, uint32_t node, uint32_t at, char out[EXPR]) {
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
        emit_node(e, n->args[0], emit_find_point(e, node, at), out);
        return;
    default:
        emit_op(e, emit_find_op(e, OP_NODE, node, at, n->node->components, n->cost), out);
        return;
    }
}
