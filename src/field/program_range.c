// From fields to GLSL, ranges: for every root of one component a function
//   vec2 field_NAME_range(vec3 low, vec3 high)
// of the least and the greatest value over a box, where a shader says WITH_RANGES before it
// includes the fields. It goes over the same operations at the same points as program_value.c, in
// intervals (shaders/lib/range.glsl). It is called for bricks of space, not for samples: everything
// is computed where it is first wanted, in one function for each root.
#include "base/memory.h"
#include "field/program_parts.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void range_node(emitter *e, uint32_t node, uint32_t at, char out[EXPR]);

// ---- uses -------------------------------------------------------------------------------------

// How often each node is used below `node`, by others there; `seen` is all false before and after.
static void count_below(const emitter *e, uint32_t node, uint32_t *uses, bool *seen) {
    seen[node] = true;
    const uint32_t *args = e->p->nodes[node].args;
    for (size_t i = 0; i < FIELD_MAX_ARGS && args[i] != NONE; i++) {
        uses[args[i]]++;
        if (!seen[args[i]]) count_below(e, args[i], uses, seen);
    }
}

static uint32_t *count_uses(const emitter *e, uint32_t node) {
    uint32_t *uses = mem_alloc(e->p->node_count * sizeof *uses);
    bool *seen = mem_alloc(e->p->node_count * sizeof *seen);
    count_below(e, node, uses, seen);
    uses[node]++;
    mem_free(seen);
    return uses;
}

typedef struct factor {
    const uint32_t *uses; // below it
    map seen;             // (node, point)
} factor;

// Computes what of `node`, in the factor, is wanted elsewhere too.
static void range_shared(emitter *e, uint32_t node, uint32_t at, factor *f) {
    const program_node *n = &e->p->nodes[node];
    char unused[EXPR];
    if (n->node->uniform || e->failed || map_find(&f->seen, n->node, at)) return;
    map_set(&f->seen, n->node, at, 0);
    if (f->uses[node] < e->uses[node]) {
        range_node(e, node, at, unused);
        return;
    }
    bool moves = kind_of(n->node) == KIND_WARP || kind_of(n->node) == KIND_TRANSFORM;
    for (size_t i = 0; i < FIELD_MAX_ARGS && n->args[i] != NONE; i++)
        range_shared(e, n->args[i], moves && i == 0 ? emit_find_point(e, node, at) : at, f);
}

static void name_range(uint32_t index, char out[EXPR]) {
    snprintf(out, EXPR, "r%u", index);
}

static void declare_range(emitter *e, uint32_t index, const char *format, ...) PRINTF_LIKE(3, 4);
static void declare_range(emitter *e, uint32_t index, const char *format, ...) {
    char value[1000];
    va_list args;
    va_start(args, format);
    vsnprintf(value, sizeof value, format, args);
    va_end(args);
    op *o = &e->ops[index];
    emit_line(e, "range%d r%u = %s;", o->components, index, value);
    o->round = e->round;
    o->scope = e->current;
    o->unit = e->unit;
}

// ---- points and arguments ---------------------------------------------------------------------

static void widen_range(char text[EXPR], int from, int to) {
    char wide[EXPR];
    if (from == to) return;
    snprintf(wide, EXPR, "range_vec%d(%.70s)", to, text);
    memcpy(text, wide, EXPR);
}

static void range_arg(emitter *e, uint32_t node, size_t i, uint32_t at, char out[EXPR]) {
    const program_node *n = &e->p->nodes[node];
    range_node(e, n->args[i], at, out);
    widen_range(out, n->node->args[i]->components, kind_arg_width(n->node, i));
}

static void range_point(emitter *e, uint32_t at, char out[EXPR]) {
    if (at == 0) {
        snprintf(out, EXPR, "p");
        return;
    }
    point q = e->points[at];
    uint32_t index = emit_find_op(e, OP_POINT, at, q.parent, 3, 0);
    name_range(index, out);
    if (e->failed || emit_is_visible(e, index)) return;
    char from[EXPR], by[EXPR], amount[EXPR];
    range_point(e, q.parent, from);
    if (q.by == NONE) {
        declare_range(e, index,
                      "range_transform(%s, field_numbers[%u], field_numbers[%u], "
                      "field_numbers[%u])",
                      from, q.matrix, q.matrix + 1, q.matrix + 2);
        return;
    }
    range_node(e, q.amount, q.parent, amount);
    const program_node *n = &e->p->nodes[q.by];
    if (!n->node->uniform && kind_is_displacement(n->node)) {
        range_node(e, n->args[0], q.parent, by);
        widen_range(by, n->node->args[0]->components, 3);
        declare_range(e, index, "range_mix(%s, %s, range_vec3(%s))", from, by, amount);
        return;
    }
    range_arg(e, q.node, 1, q.parent, by);
    declare_range(e, index, "range_move(%s, %s, %s)", from, by, amount);
}

// ---- nodes ------------------------------------------------------------------------------------

static void range_call(emitter *e, uint32_t index) {
    op o = e->ops[index];
    const program_node *n = &e->p->nodes[o.id];
    const field_kind *kind = n->node->kind;
    strbuf call = {0};
    char text[EXPR];
    const char *comma = "";
    if (kind->spatial) {
        range_point(e, o.point, text);
        strbuf_add(&call, "%s", text);
        comma = ", ";
    }
    for (size_t i = 0; i < kind_arg_count(n->node); i++, comma = ", ") {
        if (kind->args[i].uniform) { // a number as it is
            emit_node(e, n->args[i], o.point, text);
            emit_widen(text, n->node->args[i]->components, kind_arg_width(n->node, i));
        } else {
            range_arg(e, o.id, i, o.point, text);
        }
        strbuf_add(&call, "%s%s", comma, text);
    }
    for (size_t i = 0; i < FIELD_MAX_OPTIONS && kind->options[i].name; i++)
        strbuf_add(&call, ", %d", n->node->options[i]);
    declare_range(e, index, "%s(%s)", kind->range_function, strbuf_text(&call));
    strbuf_free(&call);
}

// Of a tile, how wide the samples are, too: those of levels reach farther.
static void range_fetch(emitter *e, size_t grid, int image, uint32_t at, char out[EXPR]) {
    char from[EXPR];
    strbuf width = {0};
    uint32_t index = emit_find_op(e, OP_FETCH, 4 * (uint32_t)grid + (uint32_t)image, at, 4, 0);
    name_range(index, out);
    if (e->failed || emit_is_visible(e, index)) return;
    e->p->grids[grid].ranged[image] = true;
    range_point(e, at, from);
    const field_grid *made = e->p->grids[grid].grid;
    if (made->levels)
        emit_width(e, "range_width", at, &width);
    else if (made->repeats)
        strbuf_add(&width, ", 0.0");
    declare_range(e, index, "field_fetch_range_%zu_%d(%s%s)", grid, image, from,
                  strbuf_text(&width));
    strbuf_free(&width);
}

static void range_grid(emitter *e, uint32_t index) {
    op o = e->ops[index];
    const field *node = e->p->nodes[o.id].node;
    size_t grid;
    program_use_grid(e->p, node->object, &grid);
    int first = node->index, last = first + node->components - 1;
    char a[EXPR], b[EXPR];
    range_fetch(e, grid, first / 4, o.point, a);
    if (first / 4 == last / 4) {
        const char *part = "xyzw" + first % 4;
        declare_range(e, index, "range%d(%s.low.%.*s, %s.high.%.*s)", node->components, a,
                      node->components, part, a, node->components, part);
        return;
    }
    range_fetch(e, grid, last / 4, o.point, b);
    int split = 4 - first % 4, rest = node->components - split;
    const char *part = "xyzw" + first % 4, *type = program_type(node->components);
    declare_range(e, index, "range%d(%s(%s.low.%.*s, %s.low.%.*s), %s(%s.high.%.*s, %s.high.%.*s))",
                  node->components, type, a, split, part, b, rest, "xyzw", type, a, split, part, b,
                  rest, "xyzw");
}

static void range_swizzle(emitter *e, uint32_t index) {
    op o = e->ops[index];
    const program_node *n = &e->p->nodes[o.id];
    int count = n->node->components;
    char from[EXPR], part[5] = "";
    range_node(e, n->args[0], o.point, from);
    if (n->node->args[0]->components == 1) {
        widen_range(from, 1, count);
        declare_range(e, index, "%s", from);
        return;
    }
    for (int i = 0; i < count; i++) part[i] = "xyzw"[n->node->index >> 2 * i & 3];
    declare_range(e, index, "range%d(%s.low.%s, %s.high.%s)", count, from, part, from, part);
}

static void range_palette(emitter *e, uint32_t index) {
    op o = e->ops[index];
    char value[EXPR];
    size_t table;
    range_arg(e, o.id, 0, o.point, value);
    unsigned at = program_use_palette(e->p, e->p->nodes[o.id].node->object, &table)->at;
    declare_range(e, index,
                  "range_palette(field_palette_%zu, range_mul(range_sub(%s, "
                  "range_number(field_numbers[%u].x)), range_number(field_numbers[%u].y)))",
                  table, value, at, at);
}

// The cheaper factor, then the other one where that is not zero.
static void range_product(emitter *e, uint32_t index) {
    op o = e->ops[index];
    const program_node *n = &e->p->nodes[o.id];
    size_t dearer = e->p->nodes[n->args[1]].cost >= e->p->nodes[n->args[0]].cost;
    char value[EXPR];
    range_arg(e, o.id, 1 - dearer, o.point, value);
    declare_range(e, index, "%s", value);
    bool branch = e->p->nodes[n->args[dearer]].cost >= dear;
    if (branch) {
        uint32_t *uses = count_uses(e, n->args[dearer]);
        factor f = {.uses = uses};
        range_shared(e, n->args[dearer], o.point, &f);
        map_free(&f.seen);
        mem_free(uses);
        emit_line(e, "if (!range_is_zero(r%u)) {", index);
        emit_open(e, false);
    }
    range_arg(e, o.id, dearer, o.point, value);
    emit_line(e, "r%u = range_mul(r%u, %s);", index, index, value);
    if (branch) emit_close(e);
}

static void compute_range(emitter *e, uint32_t index) {
    const field *node = e->p->nodes[e->ops[index].id].node;
    switch (kind_of(node)) {
    case KIND_MUL:
        range_product(e, index);
        return;
    case KIND_GRID:
        range_grid(e, index);
        return;
    case KIND_SWIZZLE:
        range_swizzle(e, index);
        return;
    case KIND_PALETTE:
        range_palette(e, index);
        return;
    case KIND_GLSL:
        declare_range(e, index, "range_unknown%d()", node->components);
        return;
    default:
        range_call(e, index);
        return;
    }
}

static void range_node(emitter *e, uint32_t node, uint32_t at, char out[EXPR]) {
    const program_node *n = &e->p->nodes[node];
    if (n->node->uniform) {
        char value[EXPR];
        emit_node(e, node, at, value);
        snprintf(out, EXPR, "range_number(%.70s)", value);
        return;
    }
    switch (kind_of(n->node)) {
    case KIND_POSITION:
        range_point(e, at, out);
        return;
    case KIND_WARP:
    case KIND_TRANSFORM:
        range_node(e, n->args[0], emit_find_point(e, node, at), out);
        return;
    default: {
        uint32_t index = emit_find_op(e, OP_NODE, node, at, n->node->components, n->cost);
        if (!e->failed && !emit_is_visible(e, index)) compute_range(e, index);
        name_range(index, out);
        return;
    }
    }
}

// ---- functions --------------------------------------------------------------------------------

static void write_root(emitter *e, uint32_t index) {
    char value[EXPR];
    e->round++;
    e->unit = index;
    e->current = 0;
    e->indent = 0;
    emit_line(e, "vec2 field_%s_range(vec3 low, vec3 high) {", e->p->roots[index].name);
    emit_open(e, false);
    emit_line(e, "range3 p = range3(low, high);");
    e->uses = count_uses(e, e->p->root_nodes[index]);
    range_node(e, e->p->root_nodes[index], 0, value);
    mem_free(e->uses);
    emit_line(e, "range1 all = %s;", value);
    emit_line(e, "return vec2(all.low, all.high);");
    emit_close(e);
}

static void add_tile_fetch(const program_grid *grid, size_t g, int image, strbuf *out) {
    unsigned at = grid->at;
    strbuf_add(out,
               "uniform sampler3D field_ranges_%zu_%d;\n"
               "range4 field_fetch_range_%zu_%d(range3 p, float width) {\n"
               "    return range_tile(field_ranges_%zu_%d, field_grid_%zu_%d, p, "
               "width * field_numbers[%u].w, field_numbers[%u].xyz, field_numbers[%u].xyz, "
               "field_numbers[%u].xyz);\n}\n",
               g, image, g, image, g, image, g, image, at + 1, at, at + 1, at + 4);
}

static void add_extruded_fetch(const program_grid *grid, size_t g, int image, strbuf *out) {
    unsigned at = grid->at, own = at + 5;
    bool vectors = grid->grid->extruded->vectors >> image & 1;
    strbuf_add(out,
               "uniform sampler3D field_ranges_%zu_%d;\n"
               "range4 field_fetch_range_%zu_%d(range3 p) {\n"
               "    return extrude_%srange(field_ranges_%zu_%d, field_grid_%zu_%d, "
               "field_numbers[%u], field_numbers[%u], field_numbers[%u], field_numbers[%u], p, "
               "field_numbers[%u].xyz);\n}\n",
               g, image, g, image, vectors ? "vector_" : "", g, image, g, image, own, own + 1,
               own + 2, own + 3, at + 4);
}

// Of a grid, by what is known of its bricks, and in small boxes by its texels.
static void add_fetch(const program_grid *grid, size_t g, int image, strbuf *out) {
    if (grid->grid->repeats) {
        add_tile_fetch(grid, g, image, out);
        return;
    }
    if (grid->grid->extruded) {
        add_extruded_fetch(grid, g, image, out);
        return;
    }
    static const char *const sets[] = {"field_ranges", "field_ranges_next"};
    static const char *const values[] = {"field_grid", "field_next"};
    static const char *const indices[] = {"field_index", "field_index_next"};
    const field_grid *made = grid->grid;
    unsigned at = grid->at;
    strbuf calls[2] = {{0}};
    for (int set = 0; set < 1 + made->blends; set++) {
        strbuf_add(out, "uniform sampler3D %s_%zu_%d;\n", sets[set], g, image);
        strbuf_add(&calls[set], "range_fetch(%s_%zu_%d, %s_%zu_%d, ", sets[set], g, image,
                   values[set], g, image);
        if (made->sparse)
            strbuf_add(&calls[set],
                       "%s_%zu_%d, ivec3(field_numbers[%u].w, field_numbers[%u].w, "
                       "field_numbers[%u].w), ",
                       indices[set], g, image, at + 2, at + 3, at + 4);
        strbuf_add(&calls[set], "p");
        for (unsigned i = 0; i < 5; i++) strbuf_add(&calls[set], ", field_numbers[%u].xyz", at + i);
        strbuf_add(&calls[set], ")");
    }
    strbuf_add(out, "range4 field_fetch_range_%zu_%d(range3 p) {\n", g, image);
    if (made->blends)
        strbuf_add(out,
                   "    range4 now = %s;\n"
                   "    return field_numbers[%u].w > 0.0 ? range_union(now, %s) : now;\n",
                   strbuf_text(&calls[0]), grid->at, strbuf_text(&calls[1]));
    else
        strbuf_add(out, "    return %s;\n", strbuf_text(&calls[0]));
    strbuf_add(out, "}\n");
    for (int set = 0; set < 2; set++) strbuf_free(&calls[set]);
}

static void add_libraries(const field_program *p, strbuf *out) {
    static const char *const groups[] = {"shape", "noise", "blast"};
    strbuf_add(out, "#include \"lib/range_operator.glsl\"\n#include \"lib/range_grid.glsl\"\n");
    for (size_t g = 0; g < COUNT_OF(groups); g++) {
        bool used = false;
        for (size_t i = 0; i < p->node_count; i++)
            used = used || (!p->nodes[i].node->uniform &&
                            strcmp(p->nodes[i].node->kind->group, groups[g]) == 0);
        if (used) strbuf_add(out, "#include \"lib/range_%s.glsl\"\n", groups[g]);
    }
    if (program_extrudes(p)) strbuf_add(out, "#include \"lib/range_extrude.glsl\"\n");
}

// Where there are more operations than can be told apart, nothing is known.
static void write_unknown(emitter *e) {
    strbuf_free(&e->body);
    for (uint32_t i = 0; i < e->p->root_count; i++)
        if (e->p->roots[i].components == 1)
            emit_line(e, "vec2 field_%s_range(vec3 low, vec3 high) { return vec2(%s); }",
                      e->p->roots[i].name, "-RANGE_END, RANGE_END");
}

void emit_ranges(emitter *e, strbuf *out) {
    uint32_t *uses = e->uses;
    strbuf_free(&e->body);
    for (uint32_t i = 0; i < e->p->root_count && !e->failed; i++)
        if (e->p->roots[i].components == 1) write_root(e, i);
    if (e->failed) write_unknown(e);
    e->failed = false;
    e->uses = uses;
    strbuf_add(out, "#ifdef WITH_RANGES\n");
    add_libraries(e->p, out);
    for (size_t g = 0; g < e->p->grid_count; g++)
        for (int image = 0; image < FIELD_GRID_IMAGES; image++)
            if (e->p->grids[g].ranged[image]) add_fetch(&e->p->grids[g], g, image, out);
    strbuf_append(out, strbuf_text(&e->body), e->body.length);
    strbuf_add(out, "#endif\n");
}
