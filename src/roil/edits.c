// Writing back: values that were set are put in the place of those in the script's files, which are
// found by where the script made what they belong to (effect/place.c) and by the tokens of its text
// (script/source.h). All else in a file stays as it is.
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "roil/edits_impl.h"
#include <math.h>
#include <string.h>

enum { SOURCE_MAX = 4 << 20, MOST_CALLS = 16 };

// ---- files --------------------------------------------------------------------------------------

edited_file *edits_open_file(roil_edits *x, const char *path) {
    for (size_t i = 0; i < x->file_count; i++)
        if (strcmp(x->files[i].path, path) == 0) return &x->files[i];
    void *text;
    size_t size;
    if (!file_read_inside(x->root, path, SOURCE_MAX, &text, &size)) return NULL;
    edited_file *f = MEM_ADD(x->files, x->file_count, x->file_capacity);
    *f = (edited_file){.path = arena_string(&x->memory, path), .before = text};
    return f;
}

bool edits_replace(roil_edits *x, edited_file *f, edits_replacement r) {
    size_t at = f->count;
    while (at > 0 && f->list[at - 1].at.begin > r.at.begin) at--;
    bool overlaps = (at > 0 && f->list[at - 1].at.end > r.at.begin) ||
                    (at < f->count && f->list[at].at.begin < r.at.end);
    if (overlaps) return err_set("its place is that of another value");
    MEM_RESERVE(f->list, f->count + 1, f->capacity);
    memmove(&f->list[at + 1], &f->list[at], (f->count - at) * sizeof r);
    f->list[at] = r;
    f->list[at].text = arena_string(&x->memory, r.text);
    f->count++;
    return true;
}

// ---- finding the value --------------------------------------------------------------------------

bool edits_same_place(const effect_place *a, const effect_place *b) {
    return a && b && a->line == b->line && strcmp(a->file, b->file) == 0 &&
           strcmp(a->call, b->call) == 0;
}

static bool is_ramp(const effect_control *c) {
    return c->kind == EFFECT_CONTROL_PALETTE || c->kind == EFFECT_CONTROL_CURVE;
}

static bool is_param(const effect_control *c) {
    return c->kind == EFFECT_CONTROL_PARAM;
}

static bool is_loaded(const effect_control *c) { // beside those of a pass that the call makes too
    return c->kind == EFFECT_CONTROL_LOADED;
}

// Returns whether the same call makes another object too, as in a loop or a function.
static bool is_shared(const effect *e, const effect_control *c, const effect_place *place) {
    for (size_t i = 0; i < effect_control_count(e); i++) {
        const effect_control *other = effect_get_control(e, i);
        bool alone = is_param(c) || is_ramp(c); // each is an object of its own
        if (other == c || is_param(other) != is_param(c) || is_ramp(other) != is_ramp(c) ||
            is_loaded(other) != is_loaded(c))
            continue;
        if (!alone && strcmp(other->group, c->group) == 0) continue;
        if (edits_same_place(effect_control_place(e, other), place)) return true;
    }
    return false;
}

bool edits_text_is(const char *text, source_range at, const char *word) {
    size_t length = at.end - at.begin;
    return length == strlen(word) && strncmp(text + at.begin, word, length) == 0;
}

static bool quoted_is(const char *text, source_range at, const char *word) {
    return at.end - at.begin > 2 && strchr("\"'", text[at.begin]) &&
           edits_text_is(text, (source_range){at.begin + 1, at.end - 1}, word);
}

// Returns whether a name is another one, or that with a number, as in "size_2".
static bool is_numbered(const char *name, const char *other) {
    size_t length = strlen(other);
    const char *rest = name + length;
    if (strncmp(name, other, length) != 0) return false;
    return *rest == 0 ||
           (*rest == '_' && rest[1] && strspn(rest + 1, "0123456789") == strlen(rest + 1));
}

// Returns whether the call says the name itself.
static bool names(const char *text, const source_call *call, const effect_control *c) {
    source_range value;
    if (is_param(c))
        return source_find_value(text, call->table, NULL, 1, &value) &&
               quoted_is(text, value, c->name);
    if (source_find_value(text, call->table, "name", 0, &value))
        return quoted_is(text, value, is_ramp(c) ? c->name : c->group);
    char purpose[64];
    return is_ramp(c) && source_purpose(text, call->name.begin, purpose, sizeof purpose) &&
           is_numbered(c->name, purpose);
}

static bool find_call(const roil_effect *e, const effect_control *c, const effect_place *place,
                      const char *text, source_call *out) {
    source_call found[MOST_CALLS];
    size_t count = source_find_calls(text, place->call, place->line, found, MOST_CALLS);
    if (count == 0)
        return err_set("line %d has no call of '%s' with a table of values", place->line,
                       place->call);
    *out = found[0];
    if (count == 1)
        return !is_shared(e->effect, c, place) ||
               err_set("line %d makes several by one '%s'", place->line, place->call);
    for (size_t i = 0; i < count && i < MOST_CALLS; i++) {
        *out = found[i];
        if (names(text, &found[i], c)) return true;
    }
    return err_set("line %d has several calls of '%s'", place->line, place->call);
}

// Copies what is written there, shortened, for messages.
void edits_show(const char *text, source_range at, char out[EDITS_SHOWN]) {
    size_t length = at.end - at.begin, line = strcspn(text + at.begin, "\n");
    bool whole = length < EDITS_SHOWN - 4 && line >= length;
    if (line < length) length = line;
    if (length > EDITS_SHOWN - 4) length = EDITS_SHOWN - 4;
    memcpy(out, text + at.begin, length);
    strcpy(out + length, whole ? "" : "...");
}

// Returns whether a value that is written out is the one that the script was found to have.
static bool is_initial(const effect_control *c, const char *text, source_range at) {
    if (is_ramp(c) || c->desc->type == VALUE_OTHER || c->desc->type == VALUE_WORD) return true;
    if (strchr("{\"'", text[at.begin])) at = (source_range){at.begin + 1, at.end - 1};
    strbuf written = {0};
    float there[4], initial[4];
    strbuf_append(&written, text + at.begin, at.end - at.begin);
    bool same = value_parse(c->desc, c->name, strbuf_text(&written), there) &&
                value_parse(c->desc, c->name, c->initial, initial) &&
                memcmp(there, initial, sizeof there) == 0;
    strbuf_free(&written);
    return same;
}

// Finds the scale or the strength of a layer of noise.
static bool find_in_layer(const effect_control *c, const char *text, const source_call *call,
                          source_range *out) {
    source_range layer;
    size_t part = strncmp(c->desc->name, "scale", strlen("scale")) == 0 ? 1 : 2;
    return source_find_value(text, call->table, NULL, c->layer, &layer) &&
           text[layer.begin] == '{' && source_find_value(text, layer, NULL, part, out);
}

static bool find_value(const effect_control *c, const char *text, const source_call *call,
                       const char *key, source_range *out) {
    if (is_ramp(c)) {
        *out = call->table;
        return true;
    }
    if (c->layer) return find_in_layer(c, text, call, out);
    return is_param(c) ? source_find_value(text, call->table, NULL, 2, out)
                       : source_find_value(text, call->table, key, 0, out);
}

// ---- one control --------------------------------------------------------------------------------

// Adds an entry of a table that is written anew. `between` begins with the comma before each but
// the first.
static void add_entry(strbuf *out, const char *text, source_range entry, const char *between) {
    strbuf_add(out, "%s%.*s", between + (out->length == 1), (int)(entry.end - entry.begin),
               text + entry.begin);
}

// Returns the blanks that the line of `at` begins with.
static source_range indent_of(const char *text, size_t at) {
    while (at > 0 && text[at - 1] != '\n') at--;
    return (source_range){at, at + strspn(text + at, " \t")};
}

// Writes the table of a palette or a curve anew: below each other, where the old one's entries are,
// and with its name.
static void print_ramp(const roil_effect *e, const effect_control *c, const char *text,
                       source_range old, strbuf *out) {
    strbuf made = {0}, between = {0};
    roil_add_lua(e, c, true, &made);
    const char *line = memchr(text + old.begin, '\n', old.end - old.begin);
    if (line)
        strbuf_add(&between, ",\n%.*s", (int)strspn(line + 1, " \t"), line + 1);
    else
        strbuf_add(&between, ", ");
    strbuf_add(out, "{");
    source_entry entry = {.next = 1};
    while (source_read_entry(made.text, (source_range){0, made.length}, entry.next, &entry))
        add_entry(out, made.text, entry.all, strbuf_text(&between));
    for (entry.next = old.begin + 1; source_read_entry(text, old, entry.next, &entry);)
        if (edits_text_is(text, entry.key, "name"))
            add_entry(out, text, entry.all, strbuf_text(&between));
    source_range indent = indent_of(text, old.end - 1);
    if (line)
        strbuf_add(out, ",\n%.*s}", (int)(indent.end - indent.begin), text + indent.begin);
    else
        strbuf_add(out, " }");
    strbuf_free(&made);
    strbuf_free(&between);
}

// Puts a value where `key` has one, or where the call's table ends.
static bool put(roil_edits *x, edited_file *f, const effect_control *c, const source_call *call,
                const char *key, const char *value) {
    source_range at;
    strbuf text = {0};
    if (find_value(c, f->before, call, key, &at)) {
        strbuf_add(&text, "%s", value);
    } else {
        bool first;
        at.begin = at.end = source_table_end(f->before, call->table, &first);
        strbuf_add(&text, "%s%s = %s%s", first ? " " : ", ", key, value,
                   first && f->before[at.end] == '}' ? " " : "");
    }
    bool done = edits_replace(x, f, (edits_replacement){c->name, at, strbuf_text(&text)});
    strbuf_free(&text);
    return done;
}

// What is for all layers of noise always has a name.
static bool is_of_layers(const source_call *call, const char *text, const effect_control *c) {
    return !c->layer && edits_text_is(text, call->name, "layers");
}

// False with a message that says why the value of `key` cannot be replaced.
static bool check_value(const effect_control *c, const char *text, const source_call *call,
                        const char *key, bool compare) {
    char shown[EDITS_SHOWN];
    source_range at;
    if (!find_value(c, text, call, key, &at))
        return (!is_param(c) && c->kind != EFFECT_CONTROL_FIELD) || is_of_layers(call, text, c) ||
               err_set("it is not written there by its name");
    edits_show(text, at, shown);
    if (!source_is_literal(text, at)) return err_set("it is computed there: %s", shown);
    if (compare && !is_initial(c, text, at))
        return err_set("what is written there, %s, is not what the effect began with", shown);
    return true;
}

// A camera that circles its target stands where its distance, yaw and pitch say.
static bool write_orbit(roil_edits *x, roil_effect *e, edited_file *f, const effect_control *c,
                        const source_call *call) {
    roil_camera camera;
    if (!roil_get_camera(e, &camera)) return false;
    const struct {
        const char *key;
        float value, digits;
    } parts[] = {{"distance", camera.distance, 1e4f},
                 {"yaw", camera.yaw, 1e2f},
                 {"pitch", camera.pitch, 1e2f}};
    for (size_t i = 0; i < COUNT_OF(parts); i++)
        if (!check_value(c, f->before, call, parts[i].key, false))
            return err_prefix("'%s': ", parts[i].key);
    for (size_t i = 0; i < COUNT_OF(parts); i++) {
        strbuf value = {0};
        strbuf_add_float(&value, roundf(parts[i].value * parts[i].digits) / parts[i].digits);
        bool done = put(x, f, c, call, parts[i].key, strbuf_text(&value));
        strbuf_free(&value);
        if (!done) return false;
    }
    return true;
}

// "march.steps" becomes the parameter "march_steps".
static bool add_parameter(roil_effect *e, const effect_control *c, strbuf *out) {
    strbuf name = {0};
    strbuf_add(&name, "%s", c->name);
    for (char *at = name.text; (at = strchr(at, '.'));) *at = '_';
    bool taken = effect_find_control(e->effect, name.text) != NULL;
    if (taken)
        err_set("there is a '%s' already", name.text);
    else
        roil_add_param_lua(e, c, name.text, out);
    strbuf_free(&name);
    return !taken;
}

static bool add_value(const roil_edits *x, roil_effect *e, const effect_control *c,
                      const edited_file *f, const source_call *call, strbuf *out) {
    if (x->pins) return add_parameter(e, c, out);
    if (is_ramp(c))
        print_ramp(e, c, f->before, call->table, out);
    else
        roil_add_lua(e, c, true, out);
    return true;
}

static bool write_control(roil_edits *x, roil_effect *e, const effect_control *c) {
    const effect_place *place = effect_control_place(e->effect, c);
    source_call call;
    if (c->kind == EFFECT_CONTROL_EVENTS) return err_set("clicks and keys are no part of a script");
    if (!place) return err_set("no file of the effect says it, or not in a table of its own");
    edited_file *f = edits_open_file(x, place->file);
    if (!f) return false;
    if (!find_call(e, c, place, f->before, &call))
        return err_prefix("%s: ", path_name(place->file));
    const char *key = c->desc->name;
    bool orbit = strcmp(place->call, "orbit") == 0;
    if (orbit && !x->pins && strcmp(c->name, "camera.eye") == 0)
        return write_orbit(x, e, f, c, &call);
    if (!check_value(c, f->before, &call, key, true))
        return err_prefix("%s:%d: ", path_name(place->file), place->line);
    strbuf value = {0};
    bool done =
        add_value(x, e, c, f, &call, &value) && put(x, f, c, &call, key, strbuf_text(&value));
    strbuf_free(&value);
    return done;
}

// ---- what will be written -----------------------------------------------------------------------

roil_edit *edits_add(roil_edits *x) {
    MEM_RESERVE(x->list, x->count + 1, x->capacity);
    x->list[x->count] = (roil_edit){.controls = ""};
    return &x->list[x->count++];
}

static size_t line_begin(const char *text, size_t at) {
    while (at > 0 && text[at - 1] != '\n') at--;
    return at;
}

static size_t line_end(const char *text, size_t at) {
    return at + strcspn(text + at, "\n");
}

// Adds the text from `begin` to `end` with the replacements that lie in it.
static void add_replaced(const edited_file *f, size_t begin, size_t end, strbuf *out) {
    for (size_t i = 0; i < f->count; i++) {
        const edits_replacement *r = &f->list[i];
        if (r->at.begin < begin || r->at.end > end) continue;
        strbuf_append(out, f->before + begin, r->at.begin - begin);
        strbuf_add(out, "%s", r->text);
        begin = r->at.end;
    }
    strbuf_append(out, f->before + begin, end - begin);
}

// Lists the lines of a file that change, those with several replacements once.
static void list_lines(roil_edits *x, const edited_file *f) {
    for (size_t i = 0; i < f->count;) {
        size_t begin = line_begin(f->before, f->list[i].at.begin);
        size_t end = line_end(f->before, f->list[i].at.end);
        strbuf controls = {0}, after = {0};
        const char *last = "";
        for (; i < f->count && f->list[i].at.begin <= end; i++) {
            if (strcmp(f->list[i].control, last) != 0)
                strbuf_add(&controls, "%s%s", last[0] ? ", " : "", f->list[i].control);
            last = f->list[i].control;
            size_t reach = line_end(f->before, f->list[i].at.end);
            end = reach > end ? reach : end;
        }
        add_replaced(f, begin, end, &after);
        roil_edit *edit = edits_add(x);
        edit->controls = arena_string(&x->memory, strbuf_text(&controls));
        edit->file = f->path;
        for (size_t k = 0; k < begin; k++) edit->line += f->before[k] == '\n';
        edit->line++;
        edit->before = arena_format(&x->memory, "%.*s", (int)(end - begin), f->before + begin);
        edit->after = arena_string(&x->memory, strbuf_text(&after));
        strbuf_free(&controls);
        strbuf_free(&after);
    }
}

void edits_add_control(roil_edits *x, roil_effect *e, const effect_control *c) {
    if (write_control(x, e, c)) return;
    roil_edit *edit = edits_add(x);
    edit->controls = arena_string(&x->memory, c->name);
    edit->refusal = arena_string(&x->memory, err_get());
}

// Distance, yaw and pitch of an orbit that an eye was set for are not where it stands.
static bool is_overruled(roil_effect *e, const effect_control *c) {
    static const char *const parts[] = {"camera.distance", "camera.yaw", "camera.pitch"};
    const bool part = words_find(parts, COUNT_OF(parts), c->name) >= 0;
    const effect_control *eye = part ? effect_find_control(e->effect, "camera.eye") : NULL;
    return eye && eye->moved;
}

roil_edits *edits_begin(const roil_effect *e) {
    if (!roil_may_write(e)) return NULL;
    roil_edits *x = mem_alloc(sizeof *x);
    x->root = arena_string(&x->memory, effect_get_facts(e->effect)->root); // which may end before
    return x;
}

void edits_end(roil_edits *x) {
    for (size_t i = 0; i < x->file_count; i++) {
        edited_file *f = &x->files[i];
        list_lines(x, f);
        add_replaced(f, 0, strlen(f->before), &f->after);
    }
}

// `one`: NULL for all that were moved.
static roil_edits *create_edits(roil_effect *e, const effect_control *one, bool pins) {
    roil_edits *x = edits_begin(e);
    if (!x) return NULL;
    x->pins = pins;
    for (size_t i = 0; i < effect_control_count(e->effect); i++) {
        const effect_control *c = effect_get_control(e->effect, i);
        if ((c->moved || pins) && (!one || one == c) && !is_overruled(e, c))
            edits_add_control(x, e, c);
    }
    edits_end(x);
    return x;
}

static roil_edits *create_chosen(roil_effect *e, const char *control) {
    const effect_control *one = control ? effect_find_control(e->effect, control) : NULL;
    return control && !one ? NULL : create_edits(e, one, false);
}

roil_edits *roil_edits_create(roil_effect *e, const char *control) {
    RETURN_MADE(roil_edits, create_chosen(e, control), roil_edits_free(made));
}

static roil_edits *create_parameter(roil_effect *e, const char *control) {
    const effect_control *c = effect_find_control(e->effect, control);
    if (!c) return NULL;
    if (is_param(c) || is_ramp(c) || c->kind == EFFECT_CONTROL_EVENTS ||
        c->kind == EFFECT_CONTROL_LOADED)
        return ERR_NULL(
            "'%s' cannot become a parameter; numbers and words of passes, fields, camera, sun, "
            "sky, lights, materials, meshes and nodes can",
            control);
    return create_edits(e, c, true);
}

roil_edits *roil_edits_create_parameter(roil_effect *e, const char *control) {
    RETURN_MADE(roil_edits, create_parameter(e, control), roil_edits_free(made));
}

size_t roil_edits_list(const roil_edits *x, roil_edit *out, size_t capacity) {
    for (size_t i = 0; i < x->count && i < capacity; i++) out[i] = x->list[i];
    return x->count;
}

// ---- writing ------------------------------------------------------------------------------------

static bool is_still(const roil_edits *x, const char *path, const char *text) {
    void *now;
    size_t size;
    if (!file_read_inside(x->root, path, SOURCE_MAX, &now, &size)) return false;
    bool same = size == strlen(text) && memcmp(now, text, size) == 0;
    mem_free(now);
    return same || err_set("%s has changed meanwhile; nothing was written", path);
}

// Writes `back`: the texts of before, else those of after; all files are looked at before.
static bool write_files(const roil_edits *x, bool back) {
    for (size_t i = 0; i < x->file_count; i++) {
        const edited_file *f = &x->files[i];
        if (f->count && !is_still(x, f->path, back ? strbuf_text(&f->after) : f->before))
            return false;
    }
    for (size_t i = 0; i < x->file_count; i++) {
        const edited_file *f = &x->files[i];
        const char *text = back ? f->before : strbuf_text(&f->after);
        if (f->count && !file_write_inside(x->root, f->path, text, strlen(text))) return false;
    }
    return true;
}

bool roil_edits_write(const roil_edits *x) {
    return MEM_CALL(write_files(x, false));
}

bool roil_edits_undo(const roil_edits *x) {
    return MEM_CALL(write_files(x, true));
}

void roil_edits_free(roil_edits *x) {
    if (!x) return;
    for (size_t i = 0; i < x->file_count; i++) {
        mem_free(x->files[i].before);
        mem_free(x->files[i].list);
        strbuf_free(&x->files[i].after);
    }
    mem_free(x->files);
    mem_free(x->list);
    arena_free(&x->memory);
    mem_free(x);
}
