// Sweeps: the functions of their files, axis { }, zip { } and sweep { }, and reading a file.
#include "base/memory.h"
#include "base/words.h"
#include "script/binding.h"
#include "script/sweep_parts.h"
#include <string.h>

enum {
    MEMORY_LIMIT = 64 << 20,
    INSTRUCTION_LIMIT = 100000000,
    MAX_NOTES = 64,
    MAX_SAMPLES = 65536,
    MAX_COMPARED = 64,
};

static const char axis_type[] = "axis", zip_type[] = "zip", sweep_type[] = "sweep";

sweep_reader *sweep_reader_of(lua_State *L) {
    return vm_user(L);
}

void *sweep_reserve(lua_State *L, size_t count, size_t size) {
    vm_charge_memory(L, count * size);
    return arena_alloc(sweep_reader_of(L)->memory, count * size);
}

// ---- axis { } ---------------------------------------------------------------------------------

static void read_axis_name(lua_State *L, sweep_list *axis) {
    size_t count;
    const char **names = value_names(L, 1, "axis", &count);
    static const char *const known[] = {"label"};
    for (size_t i = 0; i < count; i++)
        if (strcmp(names[i], "label") != 0) value_unknown(L, "axis", "key", names[i], known, 1);
    lua_pop(L, 1);
    if (lua_rawgeti(L, 1, 1) != LUA_TSTRING)
        vm_error(L, "axis: begins with the name of what it varies, as axis { \"steps\", 16, 32 }");
    axis->name = axis->label = sweep_take_text(L, "axis", "name");
    if (!axis->name[0] || strlen(axis->name) > 64)
        vm_error(L, "axis: its name has %d characters; 1 to 64 are accepted",
                 (int)strlen(axis->name));
    lua_pop(L, 1);
    if (value_get(L, 1, "label") != LUA_TNIL) axis->label = sweep_take_text(L, "axis", "label");
    lua_pop(L, 1);
}

static void refuse_twice(lua_State *L, const char *who, const sweep_list *axis, size_t i) {
    for (size_t k = 0; k < i; k++)
        if (strcmp(axis->values[k].text, axis->values[i].text) == 0)
            vm_error(L, "%s: has the value '%.64s' twice", who, axis->values[i].text);
}

static int l_axis(lua_State *L) {
    if (!value_is_plain_table(L, 1))
        vm_error(L, "axis takes a table, as axis { \"steps\", 16, 32 }");
    sweep_list axis = {0};
    read_axis_name(L, &axis);
    const char *who = lua_pushfstring(L, "axis '%s'", axis.name);
    lua_Unsigned count = lua_rawlen(L, 1) - 1;
    if (count < 1) vm_error(L, "%s: has no values", who);
    if (count > SWEEP_MAX_VALUES)
        vm_error(L, "%s: has %d values; at most %d are accepted", who, (int)count,
                 SWEEP_MAX_VALUES);
    axis.values = sweep_reserve(L, count, sizeof *axis.values);
    for (; axis.count < count; axis.count++) {
        lua_rawgeti(L, 1, (lua_Integer)axis.count + 2);
        sweep_value_take(L, who, &axis, &axis.values[axis.count]);
        refuse_twice(L, who, &axis, axis.count);
        lua_pop(L, 1);
    }
    *(sweep_list *)object_new(L, axis_type, sizeof axis) = axis;
    return 1;
}

// ---- zip { } ----------------------------------------------------------------------------------

static int l_zip(lua_State *L) {
    lua_Unsigned count = value_is_plain_table(L, 1) ? lua_rawlen(L, 1) : 0;
    if (count < 2 || count > SWEEP_MAX_AXES || value_has_names(L, 1))
        vm_error(L, "zip takes 2 to %d axes, as zip { axis { ... }, axis { ... } }",
                 SWEEP_MAX_AXES);
    const sweep_list **lists = sweep_reserve(L, count, sizeof *lists);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        const sweep_list *axis = object_test(L, -1, axis_type);
        if (!axis) vm_error(L, "zip: part %d is no axis { }", (int)i + 1);
        lists[i] = memcpy(sweep_reserve(L, 1, sizeof *axis), axis, sizeof *axis);
        if (axis->count != lists[0]->count)
            vm_error(L, "zip: '%s' has %d values and '%s' %d; axes that go together have as many",
                     lists[0]->name, (int)lists[0]->count, axis->name, (int)axis->count);
        lua_pop(L, 1);
    }
    sweep_group *zip = object_new(L, zip_type, sizeof *zip);
    *zip = (sweep_group){lists, count};
    return 1;
}

// ---- sweep { } --------------------------------------------------------------------------------

static const char *const sweep_keys[] = {
    "name",    "title",    "notes",  "set",     "axes",    "reference", "skip",   "published",
    "measure", "counters", "settle", "compare", "effect",  "size",      "frames", "time",
    "warmup",  "repeats",  "limit",  "edit",    "command", "cache"};

static void check_keys(lua_State *L) {
    if (!value_is_plain_table(L, 1))
        vm_error(L, "sweep takes a table, as sweep { name = \"steps\", ... }");
    if (lua_rawlen(L, 1) > 0)
        vm_error(L, "sweep: a value has no name; axes stand in axes = { axis { ... } }");
    size_t count;
    const char **names = value_names(L, 1, "sweep", &count);
    for (size_t i = 0; i < count; i++)
        if (words_find(sweep_keys, COUNT_OF(sweep_keys), names[i]) < 0)
            value_unknown(L, "sweep", "key", names[i], sweep_keys, COUNT_OF(sweep_keys));
    lua_pop(L, 1);
}

static const char *get_text(lua_State *L, const char *key, const char *otherwise) {
    const char *text =
        value_get(L, 1, key) == LUA_TNIL ? otherwise : sweep_take_text(L, "sweep", key);
    lua_pop(L, 1);
    return text;
}

static void read_notes(lua_State *L, sweep *s) {
    if (value_get(L, 1, "notes") != LUA_TNIL) {
        lua_Unsigned count = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
        if (count < 1 || count > MAX_NOTES)
            vm_error(L, "sweep: 'notes' is a list of 1 to %d texts", MAX_NOTES);
        s->notes = sweep_reserve(L, count, sizeof *s->notes);
        for (; s->note_count < count; s->note_count++) {
            lua_rawgeti(L, -1, (lua_Integer)s->note_count + 1);
            s->notes[s->note_count] = sweep_take_text(L, "sweep", "notes");
            lua_pop(L, 1);
        }
    }
    lua_pop(L, 1);
}

static sweep_measure read_measure(lua_State *L) {
    static const char *const words[] = {"frames", "reload", "start"};
    const char *word = get_text(L, "measure", words[0]);
    int found = words_find(words, COUNT_OF(words), word);
    if (found >= 0) return (sweep_measure)found;
    value_unknown(L, "sweep", "value of 'measure'", word, words, COUNT_OF(words));
}

static void read_head(lua_State *L, sweep *s) {
    s->name = get_text(L, "name", NULL);
    if (!s->name || !s->name[0]) vm_error(L, "sweep: has no name, as in name = \"steps\"");
    s->title = get_text(L, "title", s->name);
    read_notes(L, s);
    s->measure = read_measure(L);
    s->counters = true;
    if (value_get(L, 1, "counters") != LUA_TNIL) {
        if (!lua_isboolean(L, -1)) vm_error(L, "sweep: 'counters' must be true or false");
        s->counters = lua_toboolean(L, -1);
    }
    s->settle = 0.25;
    if (value_get(L, 1, "settle") != LUA_TNIL)
        s->settle = sweep_take_number(L, "sweep", "settle", 0, 60);
    s->compared = 1;
    if (value_get(L, 1, "compare") != LUA_TNIL)
        s->compared = sweep_take_count(L, "sweep", "compare", 1, MAX_COMPARED);
    lua_pop(L, 3);
}

static void read_base(lua_State *L, sweep_reader *r) {
    const sweep_options *o = r->options;
    for (size_t i = 0; i < COUNT_OF(sweep_keys); i++) {
        if (!sweep_is_special(sweep_keys[i])) continue;
        if (value_get(L, 1, sweep_keys[i]) != LUA_TNIL)
            sweep_patch_take(L, "sweep", sweep_keys[i], &r->base);
        lua_pop(L, 1);
    }
    if (value_get(L, 1, "set") != LUA_TNIL)
        sweep_patch_take_settings(L, -1, "sweep: set", &r->base);
    lua_pop(L, 1);
    if (!o->frames) return;
    r->base.first = r->base.last = 0;
    r->base.frames = arena_copy(r->memory, o->frames, o->frame_count * sizeof *o->frames);
    r->base.frame_count = o->frame_count;
}

// ---- axes -------------------------------------------------------------------------------------

static void refuse_equal(lua_State *L, const sweep_list *a, const sweep_list *b) {
    if (strcmp(a->name, b->name) == 0 || strcmp(a->label, b->label) == 0 ||
        strcmp(a->name, b->label) == 0 || strcmp(a->label, b->name) == 0)
        vm_error(L, "sweep: axes '%s' and '%s' have the same name or label", a->name, b->name);
}

static const sweep_list *axis_at(const sweep_reader *r, size_t index) {
    for (size_t g = 0; g < r->group_count; g++) {
        if (index < r->groups[g].list_count) return r->groups[g].lists[index];
        index -= r->groups[g].list_count;
    }
    return NULL;
}

static sweep_group group_at(lua_State *L, int number) {
    const sweep_list *axis = object_test(L, -1, axis_type);
    const sweep_group *zip = object_test(L, -1, zip_type);
    if (zip) return *zip;
    if (!axis) vm_error(L, "sweep: part %d of 'axes' is no axis { } and no zip { }", number);
    const sweep_list **lists = sweep_reserve(L, 1, sizeof *lists);
    lists[0] = memcpy(sweep_reserve(L, 1, sizeof *axis), axis, sizeof *axis);
    return (sweep_group){lists, 1};
}

static size_t read_axes(lua_State *L, sweep_reader *r) {
    int type = value_get(L, 1, "axes");
    lua_Unsigned count = type == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (type != LUA_TNIL && (count < 1 || count > SWEEP_MAX_AXES || value_has_names(L, -1)))
        vm_error(L, "sweep: 'axes' is a list of 1 to %d axis { } and zip { }", SWEEP_MAX_AXES);
    sweep_group *groups = sweep_reserve(L, count, sizeof *groups);
    size_t axes = 0;
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        groups[i] = group_at(L, (int)i + 1);
        axes += groups[i].list_count;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    r->groups = groups;
    r->group_count = count;
    if (axes > SWEEP_MAX_AXES) vm_error(L, "sweep: more than %d axes", SWEEP_MAX_AXES);
    for (size_t i = 0; i < axes; i++)
        for (size_t k = 0; k < i; k++) refuse_equal(L, axis_at(r, k), axis_at(r, i));
    return axes;
}

// ---- reference --------------------------------------------------------------------------------

static size_t find_axis(const sweep_reader *r, const char *name, size_t axes) {
    for (size_t i = 0; i < axes; i++)
        if (strcmp(axis_at(r, i)->name, name) == 0 || strcmp(axis_at(r, i)->label, name) == 0)
            return i;
    return axes;
}

static bool is_plain(const sweep_list *axis) { // one setting, of the axis's name
    const sweep_patch *p = &axis->values[0].patch;
    return p->setting_count == 1 && strcmp(p->settings[0].name, axis->name) == 0;
}

static void refuse_value(lua_State *L, const sweep_list *axis, const char *text) {
    const char **known = lua_newuserdatauv(L, axis->count * sizeof *known, 0);
    for (size_t i = 0; i < axis->count; i++) known[i] = axis->values[i].text;
    value_unknown(L, "reference", lua_pushfstring(L, "value of axis '%s'", axis->name), text, known,
                  axis->count);
}

// Reads the value at the top of the stack, which replaces those of an axis in the reference.
static void read_reference_axis(lua_State *L, sweep_reader *r, size_t index) {
    const sweep_list *axis = axis_at(r, index);
    lua_pushvalue(L, -1);
    const char *text = lua_tostring(L, -1);
    for (size_t i = 0; text && i < axis->count; i++)
        if (strcmp(axis->values[i].text, text) == 0) r->reference_axes[index] = &axis->values[i];
    lua_pop(L, 1);
    if (r->reference_axes[index]) return;
    if (!is_plain(axis)) refuse_value(L, axis, text ? text : "?");
    r->reference_drops[index] = true;
    sweep_patch_take(L, "reference", axis->name, &r->reference);
}

static void read_reference_key(lua_State *L, sweep_reader *r, const char *name, size_t axes) {
    size_t axis = find_axis(r, name, axes);
    bool shape =
        strcmp(name, "size") == 0 || strcmp(name, "frames") == 0 || strcmp(name, "time") == 0;
    if (shape)
        vm_error(L, "reference: has the frames and the size of its row; '%s' is not accepted",
                 name);
    if (strcmp(name, "samples") == 0) {
        r->out->samples = sweep_take_count(L, "reference", name, 1, MAX_SAMPLES);
        return;
    }
    if (axis < axes)
        read_reference_axis(L, r, axis);
    else
        sweep_patch_take(L, "reference", name, &r->reference);
    lua_pushvalue(L, -1);
    sweep_pair *said = &r->out->reference[r->out->reference_setting_count++];
    *said = (sweep_pair){name, luaL_tolstring(L, -1, NULL)};
    if (lua_type(L, -2) == LUA_TTABLE)
        said->text = r->reference.settings[r->reference.setting_count - 1].text;
    vm_charge_memory(L, strlen(name) + strlen(said->text) + 2);
    *said = (sweep_pair){arena_string(r->memory, name), arena_string(r->memory, said->text)};
    lua_pop(L, 2);
}

static void read_reference(lua_State *L, sweep_reader *r, size_t axes) {
    r->reference_axes = sweep_reserve(L, axes, sizeof *r->reference_axes);
    r->reference_drops = sweep_reserve(L, axes, sizeof *r->reference_drops);
    if (value_get(L, 1, "reference") != LUA_TNIL) {
        int table = lua_gettop(L);
        size_t count;
        if (!value_is_plain_table(L, table) || lua_rawlen(L, table) > 0)
            vm_error(L, "sweep: 'reference' is a table, as { steps = 1024 } or { samples = 512 }");
        const char **names = value_names(L, table, "reference", &count);
        r->out->reference = sweep_reserve(L, count, sizeof *r->out->reference);
        for (size_t i = 0; i < count; i++) {
            value_get(L, table, names[i]);
            read_reference_key(L, r, names[i], axes);
            lua_pop(L, 1);
        }
        r->has_reference = true;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

static int read_function(lua_State *L, const char *key) {
    int type = value_get(L, 1, key);
    if (type != LUA_TNIL && type != LUA_TFUNCTION)
        vm_error(L, "sweep: '%s' is a function, as in %s = function(row) ... end", key, key);
    if (type == LUA_TFUNCTION) return luaL_ref(L, LUA_REGISTRYINDEX);
    lua_pop(L, 1);
    return LUA_NOREF;
}

static int l_sweep(lua_State *L) {
    sweep_reader *r = sweep_reader_of(L);
    if (r->out->name) vm_error(L, "sweep: a file has one sweep");
    lua_settop(L, 1);
    check_keys(L);
    read_head(L, r->out);
    read_base(L, r);
    size_t axes = read_axes(L, r);
    read_reference(L, r, axes);
    if (r->options->no_reference) {
        r->has_reference = false;
        r->out->samples = 0;
    }
    r->skip = read_function(L, "skip");
    r->published = read_function(L, "published");
    if (r->out->measure != SWEEP_FRAMES && r->has_reference)
        vm_error(L, "sweep: pictures are compared where measure = \"frames\" only");
    sweep_expand(L, r);
    object_new(L, sweep_type, 0);
    return 1;
}

// ---- reading ----------------------------------------------------------------------------------

static int run_file(lua_State *L) {
    sweep_reader *r = lua_touserdata(L, 1);
    static const luaL_Reg words[] = {{"axis", l_axis}, {"zip", l_zip}, {"sweep", l_sweep}};
    static const char *const types[] = {axis_type, zip_type, sweep_type};
    for (size_t i = 0; i < COUNT_OF(words); i++) {
        object_type(L, types[i], NULL);
        lua_pushcfunction(L, words[i].func);
        lua_setglobal(L, words[i].name);
    }
    vm_load_chunk(L, NULL, r->out->file, r->out->file, false);
    lua_call(L, 0, 1);
    if (!object_test(L, -1, sweep_type))
        vm_error(L, "%s: a sweep's file ends with return sweep { ... }", r->out->file);
    return 0;
}

bool sweep_read(const char *file, const sweep_options *options, arena *memory, sweep *out) {
    *out = (sweep){.file = arena_string(memory, file)};
    sweep_reader r = {.memory = memory,
                      .options = options,
                      .out = out,
                      .base = sweep_patch_empty(),
                      .reference = sweep_patch_empty(),
                      .skip = LUA_NOREF,
                      .published = LUA_NOREF};
    path_folder(r.folder, file);
    vm *v = vm_create(&(vm_desc){.root = r.folder, .memory = MEMORY_LIMIT, .user = &r});
    if (!v) return false;
    bool done = vm_protect(v, run_file, &r, INSTRUCTION_LIMIT);
    vm_destroy(v);
    strbuf_free(&r.text);
    if (options->settle >= 0) out->settle = options->settle;
    return done;
}
