// From fields to GLSL, first half. Nodes are interned: two that compute the same are one. A
// constant is the same only as itself, since its value may change without a new text. Maximal
// subtrees that do not vary in space become numbers of a uniform block, in order of first use;
// single numbers share vec4s. program_emit.c writes the functions; here lies everything around
// them.
#include "field/program.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "field/program_parts.h"
#include <math.h>
#include <string.h>

// ---- interning --------------------------------------------------------------------------------

typedef struct interner {
    field_program *program;
    map by_pointer; // node -> index
    map by_content; // hash -> first index of its chain
    uint32_t *next; // chain of indices with one hash
    size_t next_capacity;
} interner;

static bool same_object(const field *a, const field *b) {
    if (a->object == b->object) return true;
    if (kind_of(a) != KIND_GLSL) return false;
    const field_glsl *x = a->object, *y = b->object;
    return strcmp(x->file, y->file) == 0 && strcmp(x->function, y->function) == 0;
}

static bool same(const program_node *a, const program_node *b) {
    if (a->node->kind != b->node->kind || a->node->components != b->node->components) return false;
    if (kind_of(a->node) == KIND_CONSTANT) return a->node == b->node;
    return a->node->index == b->node->index && same_object(a->node, b->node) &&
           memcmp(a->node->options, b->node->options, sizeof a->node->options) == 0 &&
           memcmp(a->args, b->args, sizeof a->args) == 0;
}

// Nodes that could be the same hash alike; the hash leaves out addresses, so that nothing in the
// text depends on where memory lies.
static uint32_t content_hash(const program_node *n) {
    struct {
        int32_t kind, components, index;
        uint8_t options[FIELD_MAX_OPTIONS];
        uint32_t args[FIELD_MAX_ARGS];
    } key;
    memset(&key, 0, sizeof key);
    key.kind = kind_of(n->node);
    key.components = n->node->components;
    key.index = n->node->index;
    memcpy(key.options, n->node->options, sizeof key.options);
    memcpy(key.args, n->args, sizeof key.args);
    return (uint32_t)hash64(&key, sizeof key);
}

static uint32_t intern_new(interner *in, const program_node *n) {
    field_program *p = in->program;
    uint32_t h = content_hash(n);
    uint32_t *head = map_find(&in->by_content, p, h);
    for (uint32_t i = head ? *head : NONE; i != NONE; i = in->next[i])
        if (same(&p->nodes[i], n)) return i;
    uint32_t index = (uint32_t)p->node_count++;
    MEM_RESERVE(p->nodes, p->node_count, p->node_capacity);
    MEM_RESERVE(in->next, p->node_count, in->next_capacity);
    p->nodes[index] = *n;
    in->next[index] = head ? *head : NONE;
    if (head)
        *head = index;
    else
        map_set(&in->by_content, p, h, index);
    return index;
}

static uint32_t intern(interner *in, const field *node) { // NONE: too many
    const uint32_t *known = map_find(&in->by_pointer, node, 0);
    if (known) return *known;
    program_node n = {.node = node, .number = NONE, .cost = node->uniform ? 0 : node->kind->cost};
    memset(n.args, 0xff, sizeof n.args);
    for (size_t i = 0; i < kind_arg_count(node); i++) {
        n.args[i] = intern(in, node->args[i]);
        if (n.args[i] == NONE) return NONE;
        if (!node->uniform) n.cost += in->program->nodes[n.args[i]].cost;
    }
    if (n.cost > 1e9f) n.cost = 1e9f; // shared nodes count at every use
    if (in->program->node_count >= FIELD_MAX_NODES) {
        err_set("the fields have more than %d operations", FIELD_MAX_NODES);
        return NONE;
    }
    uint32_t index = intern_new(in, &n);
    map_set(&in->by_pointer, node, 0, index);
    return index;
}

// ---- places -----------------------------------------------------------------------------------

static uint32_t add_slot(field_program *p, program_slot slot, uint32_t vec4s) {
    slot.at = 4 * p->vec4s;
    p->vec4s += vec4s;
    *MEM_ADD(p->slots, p->slot_count, p->slot_capacity) = slot;
    return slot.at;
}

uint32_t program_number(field_program *p, uint32_t node) {
    program_node *n = &p->nodes[node];
    if (n->number != NONE) return n->number;
    if (n->node->components > 1 || p->scalars == NONE) {
        n->number = add_slot(p, (program_slot){SLOT_NUMBER, .node = node}, 1);
        if (n->node->components == 1)
            p->scalars = n->number + 1;
        else if (n->node->components == 3 && p->scalars == NONE)
            p->scalars = n->number + 3;
    } else {
        n->number = p->scalars;
        add_slot(p, (program_slot){SLOT_NUMBER, .node = node}, 0);
        p->slots[p->slot_count - 1].at = n->number;
        p->scalars++;
    }
    if (p->scalars != NONE && p->scalars % 4 == 0) p->scalars = NONE;
    return n->number;
}

uint32_t program_transform(field_program *p, uint32_t node) {
    return add_slot(p, (program_slot){SLOT_TRANSFORM, .node = node}, 3) / 4;
}

program_grid *program_use_grid(field_program *p, const field_grid *grid, size_t *index) {
    for (*index = 0; *index < p->grid_count; ++*index)
        if (p->grids[*index].grid == grid) return &p->grids[*index];
    MEM_RESERVE(p->grids, p->grid_count + 1, p->grid_capacity);
    uint32_t size = 5 + (grid->extruded ? EXTRUSION_NUMBERS / 4 : 0);
    uint32_t at = add_slot(p, (program_slot){SLOT_GRID, .object = grid}, size) / 4;
    p->grids[p->grid_count++] = (program_grid){.grid = grid, .at = at};
    return &p->grids[*index];
}

program_palette *program_use_palette(field_program *p, const palette *table, size_t *index) {
    for (*index = 0; *index < p->palette_count; ++*index)
        if (p->palettes[*index].table == table) return &p->palettes[*index];
    MEM_RESERVE(p->palettes, p->palette_count + 1, p->palette_capacity);
    uint32_t at = add_slot(p, (program_slot){SLOT_PALETTE, .object = table}, 1) / 4;
    p->palettes[p->palette_count++] = (program_palette){table, at};
    return &p->palettes[*index];
}

bool program_extrudes(const field_program *p) {
    for (size_t g = 0; g < p->grid_count; g++)
        if (p->grids[g].grid->extruded) return true;
    return false;
}

const char *program_type(int components) {
    return components == 1 ? "float" : components == 3 ? "vec3" : "vec4";
}

// ---- text -------------------------------------------------------------------------------------

static void add_includes(const field_program *p, strbuf *out) {
    for (const field_kind *kind = field_kinds; kind->name; kind++) { // in order of the table
        bool first = kind->include != NULL;
        for (const field_kind *k = field_kinds; first && k < kind; k++)
            if (k->include && strcmp(k->include, kind->include) == 0) first = false;
        bool used = false;
        for (size_t i = 0; first && i < p->node_count && !used; i++)
            used = !p->nodes[i].node->uniform && p->nodes[i].node->kind->include &&
                   strcmp(p->nodes[i].node->kind->include, kind->include) == 0;
        if (used) strbuf_add(out, "#include \"%s\"\n", kind->include);
    }
    if (p->grid_count > 0) strbuf_add(out, "#include \"lib/grid.glsl\"\n");
    if (program_extrudes(p)) strbuf_add(out, "#include \"lib/extrude.glsl\"\n");
    for (size_t i = 0; i < p->node_count; i++) {
        if (kind_of(p->nodes[i].node) != KIND_GLSL) continue;
        const field_glsl *glsl = p->nodes[i].node->object;
        bool again = false;
        for (size_t k = 0; k < i && !again; k++)
            again = kind_of(p->nodes[k].node) == KIND_GLSL &&
                    strcmp(((const field_glsl *)p->nodes[k].node->object)->file, glsl->file) == 0;
        if (!again) strbuf_add(out, "#include \"%s\"\n", glsl->file);
    }
}

static void add_textures(field_program *p, strbuf *out) {
    for (size_t g = 0; g < p->grid_count; g++)
        for (int image = 0; image < FIELD_GRID_IMAGES; image++)
            if (p->grids[g].used[image]) emit_grid_fetch(&p->grids[g], g, image, out);
    for (size_t i = 0; i < p->palette_count; i++)
        strbuf_add(out, "uniform sampler2D field_palette_%zu;\n", i);
}

static void list_grid(arena *memory, field_program *p, size_t g) {
    static const char *const names[2][2] = {{"grid", "next"}, {"ranges", "ranges_next"}};
    const program_grid *grid = &p->grids[g];
    for (int image = 0; image < FIELD_GRID_IMAGES; image++)
        for (int ranges = 0; ranges < 2; ranges++)
            for (int set = 0; set < 1 + grid->grid->blends; set++) {
                if (!(ranges ? grid->ranged : grid->used)[image]) continue;
                p->textures[p->texture_count++] = (field_texture){
                    .glsl_name =
                        arena_format(memory, "field_%s_%zu_%d", names[ranges][set], g, image),
                    .grid = grid->grid,
                    .image = image,
                    .set = set,
                    .ranges = ranges,
                };
            }
}

static void list_index(arena *memory, field_program *p, size_t g) {
    const field_grid *grid = p->grids[g].grid;
    for (int image = 0; image < FIELD_GRID_IMAGES; image++)
        for (int set = 0; set < 1 + grid->blends; set++)
            if (p->grids[g].used[image] && grid->sparse)
                p->textures[p->texture_count++] = (field_texture){
                    .glsl_name =
                        arena_format(memory, "field_index%s_%zu_%d", set ? "_next" : "", g, image),
                    .grid = grid,
                    .image = image,
                    .set = set,
                    .index = true,
                };
}

static void list_textures(arena *memory, field_program *p) {
    size_t most = p->palette_count + p->grid_count * FIELD_GRID_IMAGES * 6;
    p->textures = arena_alloc(memory, (most + 1) * sizeof *p->textures);
    for (size_t g = 0; g < p->grid_count; g++) {
        list_grid(memory, p, g);
        list_index(memory, p, g);
    }
    for (size_t i = 0; i < p->palette_count; i++)
        p->textures[p->texture_count++] = (field_texture){
            .glsl_name = arena_format(memory, "field_palette_%zu", i),
            .palette = p->palettes[i].table,
        };
}

static void assemble(arena *memory, field_program *p, const strbuf *functions) {
    strbuf text = {0};
    strbuf_add(&text, "// Generated from the fields of a pass.\n");
    if (p->vec4s > 0)
        strbuf_add(&text, "layout(std140) uniform FieldNumbers { vec4 field_numbers[%u]; };\n",
                   p->vec4s);
    add_includes(p, &text);
    add_textures(p, &text);
    strbuf_append(&text, strbuf_text(functions), functions->length);
    p->text = arena_string(memory, strbuf_text(&text));
    strbuf_free(&text);
}

// ---- program ----------------------------------------------------------------------------------

static bool check_root(const field_root *roots, size_t i) {
    const field_root *root = &roots[i];
    int have = root->node->components, want = root->components;
    if (have != want && have != 1 && !(have == 4 && want == 3))
        return err_set("field '%s' has %d components; %d %s accepted", root->name, have, want,
                       want == 1 ? "is" : "or a single one are");
    for (size_t k = 0; k < i; k++)
        if (strcmp(roots[k].name, root->name) == 0)
            return err_set("two fields are named '%s'", root->name);
    if (!root->after || !root->after[0]) return true;
    for (size_t k = 0; k < i; k++)
        if (strcmp(roots[k].name, root->after) == 0) return true;
    return err_set("field '%s' comes after '%s', which is no earlier field", root->name,
                   root->after);
}

static bool program_build(arena *memory, field_program *p) {
    interner in = {.program = p};
    bool ok = true;
    for (size_t i = 0; i < p->root_count && ok; i++) {
        ok = check_root(p->roots, i);
        if (!ok) break;
        p->root_nodes[i] = intern(&in, p->roots[i].node);
        ok = p->root_nodes[i] != NONE;
    }
    map_free(&in.by_pointer);
    map_free(&in.by_content);
    mem_free(in.next);
    strbuf functions = {0};
    ok = ok && program_emit(p, &functions);
    if (ok) {
        list_textures(memory, p);
        assemble(memory, p, &functions);
    }
    strbuf_free(&functions);
    return ok;
}

static void need(field_program *p, uint32_t node) {
    if (p->nodes[node].needed) return;
    p->nodes[node].needed = true;
    for (size_t i = 0; i < FIELD_MAX_ARGS && p->nodes[node].args[i] != NONE; i++)
        need(p, p->nodes[node].args[i]);
}

// Moves the working arrays into the arena.
static void settle(arena *memory, field_program *p) {
    for (size_t i = 0; i < p->slot_count; i++) {
        const program_slot *slot = &p->slots[i];
        if (slot->kind == SLOT_NUMBER) need(p, slot->node);
        for (size_t k = 1; slot->kind == SLOT_TRANSFORM && k < 4; k++)
            need(p, p->nodes[slot->node].args[k]);
    }
    program_node *nodes = p->nodes;
    program_slot *slots = p->slots;
    p->nodes = arena_copy(memory, nodes, p->node_count * sizeof *nodes);
    p->slots = arena_copy(memory, slots, p->slot_count * sizeof *slots);
    p->values = arena_alloc(memory, p->node_count * sizeof *p->values);
    mem_free(nodes);
    mem_free(slots);
}

field_program *field_program_create(arena *memory, const field_root *roots, size_t count) {
    field_program *p = arena_alloc(memory, sizeof *p);
    field_root *copy = arena_copy(memory, roots, count * sizeof *roots);
    p->roots = copy;
    p->root_count = count;
    p->root_nodes = arena_alloc(memory, (count + 1) * sizeof *p->root_nodes);
    p->scalars = NONE;
    for (size_t i = 0; i < count; i++) copy[i].name = arena_string(memory, roots[i].name);
    bool ok = program_build(memory, p);
    if (ok)
        settle(memory, p);
    else {
        mem_free(p->nodes);
        mem_free(p->slots);
    }
    mem_free(p->grids);
    mem_free(p->palettes);
    p->grids = NULL;
    p->palettes = NULL;
    return ok ? p : NULL;
}

const char *field_program_text(const field_program *p) {
    return p->text;
}

size_t field_program_textures(const field_program *p, const field_texture **out) {
    *out = p->textures;
    return p->texture_count;
}

size_t field_program_block_size(const field_program *p) {
    return 16 * (size_t)p->vec4s;
}

// ---- numbers ----------------------------------------------------------------------------------

// Nodes after nodes, arguments first: the work is that of the graph, and nothing is allocated.
static bool fill_values(const field_program *p, const field_context *context) {
    for (size_t i = 0; i < p->node_count; i++) {
        const program_node *n = &p->nodes[i];
        float args[FIELD_MAX_ARGS][4];
        if (!n->needed) continue;
        size_t count = kind_arg_count(n->node);
        bool moved = kind_of(n->node) == KIND_WARP || kind_of(n->node) == KIND_TRANSFORM;
        if (moved) { // the same everywhere
            memcpy(p->values[i], p->values[n->args[0]], sizeof p->values[i]);
            continue;
        }
        if (count == 0) {
            if (!field_eval(n->node, context, (float3){0, 0, 0}, p->values[i])) return false;
            continue;
        }
        for (size_t k = 0; k < count; k++) {
            memcpy(args[k], p->values[n->args[k]], sizeof args[k]);
            for (int c = 1; n->node->args[k]->components == 1 && c < 4; c++)
                args[k][c] = args[k][0];
        }
        memset(p->values[i], 0, sizeof p->values[i]);
        n->node->kind->eval(&(field_point){.node = n->node, .context = context},
                            (const float(*)[4])args, p->values[i]);
    }
    return true;
}

static void fill_grid(const field_grid *grid, float *out) {
    if (grid->extruded) field_extrusion_numbers(grid->extruded, out + 20);
    box3 box = grid->box, active = box3_intersect(box, grid->state.active);
    const float size[3] = {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    memcpy(out, &box.min, sizeof box.min);
    out[3] = grid->state.blend;
    for (int i = 0; i < 3; i++) {
        out[4 + i] = size[i] > 0 ? 1 / size[i] : 0;
        out[7] = fmaxf(out[7], out[4 + i] * (float)grid->size[i]);
        out[11 + 4 * i] = (float)grid->size[i];
    }
    for (int i = 0; i < 3; i++)
        out[16 + i] = (float)grid->size[i] / (float)(grid->sparse ? GRID_SPARSE_BRICK : GRID_BRICK);
    if (box3_is_empty(active)) { // no point lies inside
        for (int i = 0; i < 3; i++) out[8 + i] = 1e30f;
        for (int i = 0; i < 3; i++) out[12 + i] = -1e30f;
        return;
    }
    memcpy(out + 8, &active.min, sizeof active.min);
    memcpy(out + 12, &active.max, sizeof active.max);
}

bool field_program_fill(const field_program *p, const field_context *context, void *block) {
    const size_t size = field_program_block_size(p);
    if (!fill_values(p, context)) return false;
    if (size == 0) return true; // without a block
    float *numbers = block, low, high;
    memset(block, 0, size);
    for (size_t i = 0; i < p->slot_count; i++) {
        const program_slot *slot = &p->slots[i];
        float *out = numbers + slot->at;
        switch (slot->kind) {
        case SLOT_NUMBER:
            memcpy(out, p->values[slot->node],
                   (size_t)p->nodes[slot->node].node->components * sizeof *out);
            break;
        case SLOT_GRID:
            fill_grid(slot->object, out);
            break;
        case SLOT_PALETTE:
            palette_range(slot->object, &low, &high);
            out[0] = low;
            out[1] = 1 / (high - low);
            break;
        case SLOT_TRANSFORM: {
            float rows[3][4], back[3][4], args[3][4];
            for (int k = 0; k < 3; k++) {
                uint32_t arg = p->nodes[slot->node].args[k + 1];
                for (int c = 0; c < 4; c++)
                    args[k][c] = p->values[arg][p->nodes[arg].node->components == 1 ? 0 : c];
            }
            kind_transform_matrix(args[0], args[1], args[2], rows, back);
            memcpy(out, rows, sizeof rows);
            break;
        }
        }
    }
    return true;
}
