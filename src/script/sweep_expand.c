// Expands sweeps: axes are combined, and each combination becomes a row; so do the rows that
// pictures are compared with.
#include "base/hash.h"
#include "script/binding.h"
#include "script/sweep_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_COMBINATIONS = 65536, COMBINATION_COST = 100, LABEL_MAX = 64, MAX_PUBLISHED = 32 };

typedef struct combination { // one value of each axis, axes in order
    const sweep_list *lists[SWEEP_MAX_AXES];
    const sweep_value *values[SWEEP_MAX_AXES];
    size_t count;
} combination;

// ---- one row ----------------------------------------------------------------------------------

static void set(sweep_row *row, const sweep_pair *setting) {
    for (size_t i = 0; i < row->setting_count; i++)
        if (strcmp(row->settings[i].name, setting->name) == 0) {
            row->settings[i] = *setting;
            return;
        }
    row->settings[row->setting_count++] = *setting;
}

// The row's settings have room for those of the patch.
static void apply(sweep_row *row, const sweep_patch *p) {
    if (p->effect) {
        row->effect = p->effect;
        row->inside = p->inside;
    }
    if (p->width) row->width = p->width;
    if (p->height) row->height = p->height;
    if (p->frames || p->last > p->first) {
        row->frames = p->frames;
        row->frame_count = p->frame_count;
        row->first = p->first;
        row->last = p->last;
    }
    if (p->warmup >= 0) row->warmup = (uint32_t)p->warmup;
    if (p->repeats >= 0) row->repeats = (uint32_t)p->repeats;
    if (p->limit >= 0) row->limit = p->limit;
    if (p->edits) {
        row->edits = p->edits;
        row->edit_count = p->edit_count;
    }
    if (p->command) row->command = p->command;
    if (p->empty_cache >= 0) row->empty_cache = p->empty_cache;
    for (size_t i = 0; i < p->setting_count; i++) set(row, &p->settings[i]);
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const sweep_pair *)a)->name, ((const sweep_pair *)b)->name);
}

static void require_complete(lua_State *L, const sweep_reader *r, const sweep_row *row) {
    if (!row->effect) vm_error(L, "sweep: no effect is named, as in effect = \"puff.lua\"");
    if (r->out->measure == SWEEP_FRAMES && !row->frames && !(row->last > row->first))
        vm_error(L, "sweep: nothing says which frames are drawn, as frames = \"28-34\" or time = "
                    "{1, 1.5} do");
    if (r->out->measure == SWEEP_RELOAD && !row->edits)
        vm_error(L, "sweep: nothing says what is edited, as edit = {\"1400\", \"1500\", \"1600\"} "
                    "does");
}

// Applies the values one after the other to what the sweep sets for all rows.
static sweep_row make_row(lua_State *L, sweep_reader *r, const combination *c, bool reference) {
    const sweep_options *o = r->options;
    sweep_row row = {.width = 960,
                     .height = 540,
                     .warmup = 1,
                     .repeats = 1,
                     .command = "check",
                     .reference = SWEEP_NO_REFERENCE};
    size_t room = r->base.setting_count + r->reference.setting_count;
    for (size_t i = 0; i < c->count; i++) room += c->values[i]->patch.setting_count;
    row.settings = sweep_reserve(L, room, sizeof *row.settings);
    apply(&row, &r->base);
    for (size_t i = 0; i < c->count; i++) {
        const sweep_value *stands_in = reference ? r->reference_axes[i] : NULL;
        if (!(reference && r->reference_drops[i]))
            apply(&row, stands_in ? &stands_in->patch : &c->values[i]->patch);
    }
    if (reference) apply(&row, &r->reference);
    if (o->warmup >= 0) row.warmup = (uint32_t)o->warmup;
    if (o->repeats >= 0) row.repeats = (uint32_t)o->repeats;
    if (o->limit >= 0) row.limit = o->limit;
    qsort(row.settings, row.setting_count, sizeof *row.settings, by_name);
    require_complete(L, r, &row);
    return row;
}

static void name_row(lua_State *L, sweep_reader *r, const combination *c, sweep_row *row) {
    r->text.length = 0;
    strbuf_append(&r->text, "", 0);
    row->axes = sweep_reserve(L, c->count, sizeof *row->axes);
    for (size_t i = 0; i < c->count; i++) {
        row->axes[row->axis_count++] = (sweep_pair){c->lists[i]->name, c->values[i]->text};
        strbuf_add(&r->text, "%s%.*s", i ? ", " : "", LABEL_MAX, c->values[i]->label);
    }
    if (!c->count) strbuf_add(&r->text, "%s", r->out->name);
    vm_charge_memory(L, r->text.length + 1);
    row->label = arena_string(r->memory, strbuf_text(&r->text));
}

// ---- functions of the file --------------------------------------------------------------------

// Pushes a table of the combination's values, by name and by label.
static void push_combination(lua_State *L, const combination *c) {
    lua_createtable(L, 0, (int)c->count * 2);
    for (size_t i = 0; i < c->count; i++) {
        const sweep_value *v = c->values[i];
        if (v->type == LUA_TNUMBER)
            lua_pushnumber(L, v->number);
        else if (v->type == LUA_TBOOLEAN)
            lua_pushboolean(L, v->number != 0);
        else
            lua_pushstring(L, v->said);
        lua_pushvalue(L, -1);
        lua_setfield(L, -3, c->lists[i]->name);
        lua_setfield(L, -2, c->lists[i]->label);
    }
}

static bool is_skipped(lua_State *L, const sweep_reader *r, const combination *c) {
    if (r->skip == LUA_NOREF) return false;
    lua_rawgeti(L, LUA_REGISTRYINDEX, r->skip);
    push_combination(L, c);
    lua_call(L, 1, 1);
    bool skipped = lua_toboolean(L, -1);
    lua_pop(L, 1);
    return skipped;
}

// Reads { ["GTX 1650"] = 7.21 }: times that others report, in milliseconds.
static void ask_published(lua_State *L, sweep_reader *r, const combination *c, sweep_row *row) {
    if (r->published == LUA_NOREF) return;
    int top = lua_gettop(L);
    lua_rawgeti(L, LUA_REGISTRYINDEX, r->published);
    push_combination(L, c);
    lua_call(L, 1, 1);
    if (!lua_isnil(L, -1)) {
        if (!value_is_plain_table(L, -1))
            vm_error(L,
                     "sweep: 'published' must return a table, as { [\"GTX 1650\"] = 7.21 }, or "
                     "nil; it returned %s",
                     object_kind(L, -1));
        size_t count;
        int table = lua_gettop(L);
        const char **names = value_names(L, table, "published", &count);
        if (count > MAX_PUBLISHED)
            vm_error(L, "sweep: 'published' returned %d figures; at most %d are accepted",
                     (int)count, MAX_PUBLISHED);
        row->published = sweep_reserve(L, count, sizeof *row->published);
        for (size_t i = 0; i < count; i++) {
            lua_pushstring(L, names[i]);
            const char *name = sweep_take_text(L, "sweep", "published");
            value_get(L, table, names[i]);
            row->published[row->published_count++] =
                (sweep_number){name, sweep_take_number(L, "published", name, 0, 1e12)};
            lua_pop(L, 2);
        }
    }
    lua_settop(L, top);
}

// ---- references -------------------------------------------------------------------------------

// Hashes everything that the row's pictures depend on.
static hash128 row_hash(const sweep_row *row) {
    double numbers[] = {row->width, row->height, row->first, row->last, row->warmup};
    hash128 h = hash_combine(hash_bytes(numbers, sizeof numbers),
                             hash_bytes(row->frames, row->frame_count * sizeof *row->frames));
    h = hash_add_text(h, row->effect);
    for (size_t i = 0; i < row->setting_count; i++)
        h = hash_add_text(hash_add_text(h, row->settings[i].name), row->settings[i].text);
    return h;
}

// Returns the number of a combination's reference; equal ones are stored once.
static size_t find_reference(lua_State *L, sweep_reader *r, const combination *c, hash128 *known) {
    sweep *s = r->out;
    sweep_row row = make_row(L, r, c, true);
    hash128 h = row_hash(&row);
    for (size_t i = 0; i < s->reference_count; i++)
        if (hash_equal(known[i], h)) return i;
    row.label = "reference";
    known[s->reference_count] = h;
    s->references[s->reference_count] = row;
    return s->reference_count++;
}

// ---- all rows ---------------------------------------------------------------------------------

static size_t group_length(const sweep_group *g) {
    return g->lists[0]->count;
}

static size_t count_combinations(lua_State *L, const sweep_reader *r) {
    size_t count = 1;
    for (size_t i = 0; i < r->group_count; i++) {
        count *= group_length(&r->groups[i]);
        if (count > MAX_COMBINATIONS)
            vm_error(L, "sweep: its axes have more than %d combinations", MAX_COMBINATIONS);
    }
    return count;
}

// Number `at` of all combinations; the first axis is the slowest.
static combination pick(const sweep_reader *r, size_t at) {
    size_t place[SWEEP_MAX_AXES];
    for (size_t g = r->group_count; g-- > 0;) {
        place[g] = at % group_length(&r->groups[g]);
        at /= group_length(&r->groups[g]);
    }
    combination c = {0};
    for (size_t g = 0; g < r->group_count; g++)
        for (size_t k = 0; k < r->groups[g].list_count; k++) {
            c.lists[c.count] = r->groups[g].lists[k];
            c.values[c.count++] = &r->groups[g].lists[k]->values[place[g]];
        }
    return c;
}

typedef struct scale {
    double width, height;
} scale;

static void grow(uint32_t *most, uint32_t side) {
    if (side > *most) *most = side;
}

static void scale_patch(sweep_patch *p, scale by) {
    if (p->width) p->width = (uint32_t)fmax(1, round(p->width * by.width));
    if (p->height) p->height = (uint32_t)fmax(1, round(p->height * by.height));
}

static void scale_value(lua_State *L, const sweep_list *of, sweep_value *v, scale by) {
    scale_patch(&v->patch, by);
    if (strcmp(of->name, "size") != 0 || v->named) return;
    vm_charge_memory(L, LABEL_MAX);
    v->text = v->label =
        arena_format(sweep_reader_of(L)->memory, "%ux%u", v->patch.width, v->patch.height);
}

// Scales all sizes so that the largest is the one that the user asks for. Functions of the file
// still get the sizes in the file.
static void scale_sizes(lua_State *L, sweep_reader *r) {
    uint32_t width = r->base.width, height = r->base.height;
    if (!r->options->width) return;
    for (size_t g = 0; g < r->group_count; g++)
        for (size_t k = 0; k < r->groups[g].list_count; k++) {
            const sweep_list *l = r->groups[g].lists[k];
            for (size_t i = 0; i < l->count; i++) {
                grow(&width, l->values[i].patch.width);
                grow(&height, l->values[i].patch.height);
            }
        }
    if (!width) { // none is said
        r->base.width = r->options->width;
        r->base.height = r->options->height;
        return;
    }
    scale by = {(double)r->options->width / width, (double)r->options->height / height};
    scale_patch(&r->base, by);
    for (size_t g = 0; g < r->group_count; g++)
        for (size_t k = 0; k < r->groups[g].list_count; k++) {
            const sweep_list *l = r->groups[g].lists[k];
            for (size_t i = 0; i < l->count; i++) scale_value(L, l, &l->values[i], by);
        }
}

static void keep_axes(lua_State *L, sweep_reader *r) {
    sweep *s = r->out;
    combination any = pick(r, 0);
    s->axes = sweep_reserve(L, any.count, sizeof *s->axes);
    for (size_t i = 0; i < any.count; i++) {
        const sweep_list *l = any.lists[i];
        const char **values = sweep_reserve(L, l->count, sizeof *values);
        for (size_t k = 0; k < l->count; k++) values[k] = l->values[k].text;
        s->axes[s->axis_count++] = (sweep_axis){l->name, l->label, values, l->count};
    }
}

void sweep_expand(lua_State *L, sweep_reader *r) {
    sweep *s = r->out;
    size_t all = count_combinations(L, r);
    size_t room = all < SWEEP_MAX_ROWS ? all : SWEEP_MAX_ROWS;
    scale_sizes(L, r);
    keep_axes(L, r);
    s->rows = sweep_reserve(L, room, sizeof *s->rows);
    s->references = sweep_reserve(L, room, sizeof *s->references);
    hash128 *known = sweep_reserve(L, room, sizeof *known);
    for (size_t i = 0; i < all; i++) {
        vm_charge(L, COMBINATION_COST);
        combination c = pick(r, i);
        if (is_skipped(L, r, &c)) continue;
        if (s->row_count == room)
            vm_error(L, "sweep: more than %d rows; 'skip' or fewer values make them fewer",
                     SWEEP_MAX_ROWS);
        sweep_row row = make_row(L, r, &c, false);
        name_row(L, r, &c, &row);
        ask_published(L, r, &c, &row);
        if (r->has_reference) row.reference = find_reference(L, r, &c, known);
        s->rows[s->row_count++] = row;
    }
    if (!s->row_count) vm_error(L, "sweep: 'skip' leaves no row");
}
