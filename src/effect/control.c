// The list of all controls, and how they are set.
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "effect/effect_impl.h"
#include <ctype.h>
#include <string.h>

enum { NUMBERS_TEXT = 128 }; // more than four numbers or the longest word

// ---- the list ---------------------------------------------------------------------------------

// Palettes and curves are listed as they are declared, and so are uniforms and options.
static int rank(effect_control_kind kind) {
    if (kind == EFFECT_CONTROL_CURVE) return EFFECT_CONTROL_PALETTE;
    return kind > EFFECT_CONTROL_UNIFORM ? EFFECT_CONTROL_UNIFORM : (int)kind;
}

static void param_reset(effect *e, control *c) {
    effect_set_value(e, c->face.index, e->params[c->face.index]->desc.value);
    effect_forget_moved(e, c->face.index);
}

static void slot_reset(effect *e, control *c) {
    (void)e;
    *c->slot = c->original;
}

static void number_reset(effect *e, control *c) {
    (void)e;
    memcpy(c->nodes[0]->value, c->original->value, sizeof c->original->value);
}

typedef struct control_kind {
    bool (*set)(effect *e, control *c, const char *text);
    void (*print)(const effect *e, const control *c, strbuf *out);
    void (*reset)(effect *e, control *c); // NULL: it is structure
} control_kind;

static const control_kind kinds[] = {
    [EFFECT_CONTROL_PARAM] = {param_set, param_print, param_reset},
    [EFFECT_CONTROL_PALETTE] = {ramp_set, ramp_print, ramp_reset},
    [EFFECT_CONTROL_CURVE] = {ramp_set, ramp_print, ramp_reset},
    [EFFECT_CONTROL_SCENE] = {field_control_set, field_control_print, slot_reset},
    [EFFECT_CONTROL_LIGHT] = {field_control_set, field_control_print, slot_reset},
    [EFFECT_CONTROL_MATERIAL] = {field_control_set, field_control_print, slot_reset},
    [EFFECT_CONTROL_PLACE] = {field_control_set, field_control_print, slot_reset},
    [EFFECT_CONTROL_FIELD] = {field_control_set, field_control_print, number_reset},
    [EFFECT_CONTROL_LOADED] = {field_control_set, field_control_print, NULL},
    [EFFECT_CONTROL_EVENTS] = {events_control_set, events_control_print, events_control_reset},
    [EFFECT_CONTROL_UNIFORM] = {field_control_set, field_control_print, slot_reset},
    [EFFECT_CONTROL_OPTION] = {pass_control_set, pass_control_print, NULL},
    [EFFECT_CONTROL_SCALE] = {pass_control_set, pass_control_print, NULL},
};

static void print(const effect *e, const control *c, strbuf *out) {
    kinds[c->face.kind].print(e, c, out);
}

static void note_initial(effect *e, control *c) {
    strbuf text = {0};
    print(e, c, &text);
    c->face.initial = arena_string(&e->memory, strbuf_text(&text));
    strbuf_free(&text);
}

// Lies in the arena, as all that an effect keeps of its controls: there is nothing to free.
static void grow(effect *e) {
    if (e->control_count < e->control_capacity) return;
    e->control_capacity = e->control_capacity ? e->control_capacity * 2 : 64;
    control **more = arena_alloc(&e->memory, e->control_capacity * sizeof *more);
    if (e->control_count) memcpy(more, e->controls, e->control_count * sizeof *more);
    e->controls = more;
}

control *effect_add_control(effect *e, const control *own) {
    control *c = arena_copy(&e->memory, own, sizeof *own);
    grow(e);
    size_t at = e->control_count++;
    for (; at > 0 && rank(e->controls[at - 1]->face.kind) > rank(c->face.kind); at--)
        e->controls[at] = e->controls[at - 1];
    e->controls[at] = c;
    note_initial(e, c);
    return c;
}

control *effect_add_member(effect *e, const char *group, const value_desc *desc, control own) {
    own.face.name = arena_format(&e->memory, "%s.%s", group, desc->name);
    own.face.group = group;
    own.face.desc = desc;
    return effect_add_control(e, &own);
}

size_t effect_control_count(const effect *e) {
    return e->control_count;
}

const effect_control *effect_get_control(const effect *e, size_t index) {
    return &e->controls[index]->face;
}

const palette *effect_control_palette(const effect_control *c) {
    return ((const control *)c)->palette;
}

const curve *effect_control_curve(const effect_control *c) {
    return ((const control *)c)->curve;
}

bool effect_control_is_over_age(const effect_control *c) {
    return c->kind == EFFECT_CONTROL_CURVE && ((const control *)c)->palette;
}

void effect_print_control(const effect *e, const effect_control *c, strbuf *out) {
    print(e, (const control *)c, out);
}

// ---- names ------------------------------------------------------------------------------------

static void add_passes(effect *e) {
    for (; e->controlled < e->pass_count; e->controlled++) pass_control_add_all(e, e->controlled);
}

control *effect_control_of(effect *e, const char *name) {
    add_passes(e);
    for (size_t i = 0; i < e->control_count; i++)
        if (strcmp(e->controls[i]->face.name, name) == 0) return e->controls[i];
    return NULL;
}

// Sets a message that says why a pass has no control of that name.
static bool unknown_in_pass(pass *p, const char *name) {
    size_t index;
    pass_key key = pass_find_key(p, name, &index);
    if (key == PASS_FIELD || key == PASS_IMAGE)
        return err_set("%s.%s is %s; only the effect file can set it", pass_label(p), name,
                       key == PASS_FIELD ? "a field" : "an image");
    return pass_refuse_uniform(p, name);
}

static pass *pass_named(const effect *e, const char *name, size_t length) {
    for (size_t i = 0; i < e->pass_count; i++) {
        const char *label = pass_label(e->passes[i]);
        if (strlen(label) == length && strncmp(label, name, length) == 0) return e->passes[i];
    }
    return NULL;
}

static bool unknown(effect *e, const char *name) {
    const char *dot = strrchr(name, '.');
    pass *p = dot ? pass_named(e, name, (size_t)(dot - name)) : NULL;
    if (p) return unknown_in_pass(p, dot + 1);
    if (scene_control_unknown(e, name)) return false;
    if (strcmp(name, "effect.events") == 0)
        return err_set("the effect handles no events: its script has no fx:on_key, fx:on_click");
    const char **names = mem_alloc((e->control_count + 1) * sizeof *names);
    for (size_t i = 0; i < e->control_count; i++) names[i] = e->controls[i]->face.name;
    words_refuse(names, e->control_count, name, "`roil info params` lists what can be set",
                 "nothing is named '%s'", name);
    mem_free(names);
    return false;
}

static control *find(effect *e, const char *name) {
    control *c = effect_control_of(e, name);
    if (!c) unknown(e, name);
    return c;
}

const effect_control *effect_find_control(effect *e, const char *name) {
    const control *c = find(e, name);
    return c ? &c->face : NULL;
}

// ---- setting ----------------------------------------------------------------------------------

// Keeps what was set, on one line. The buffer grows with the longest text only.
static void note_moved(effect *e, control *c, const char *text) {
    size_t size = strlen(text) + 1;
    if (size > c->text_capacity) {
        c->text_capacity = 2 * size > 64 ? 2 * size : 64;
        c->text = arena_alloc(&e->memory, c->text_capacity);
    }
    for (size_t i = 0; i < size; i++)
        c->text[i] = text[i] && iscntrl((unsigned char)text[i]) ? ' ' : text[i];
    c->face.moved = true;
    c->as_numbers = false;
}

// The text of numbers is made when somebody asks for it: the recipe of a picture that is saved.
const char *effect_control_setting(const effect_control *face) {
    control *c = (control *)face;
    if (!face->moved) return NULL;
    if (!c->as_numbers) return c->text;
    strbuf text = {0};
    value_print(face->desc, c->numbers, &text);
    str_copy(c->text, c->text_capacity, strbuf_text(&text));
    strbuf_free(&text);
    return c->text;
}

static bool is_structure(const control *c) {
    return !kinds[c->face.kind].reset;
}

const char *effect_get_warning(const effect *e) {
    return e->host.warning[0] ? e->host.warning : NULL;
}

// A setting may remove the cause of a warning. Simulations may have used the old value, so
// snapshots are dropped: none when it is a value of the scene, and those since then when it is an
// event.
static void forget_old(effect *e, const control *c) {
    e->host.warning[0] = '\0';
    if (c->face.kind != EFFECT_CONTROL_SCENE && c->face.kind != EFFECT_CONTROL_LIGHT &&
        c->face.kind != EFFECT_CONTROL_MATERIAL && c->face.kind != EFFECT_CONTROL_EVENTS)
        effect_forget_snapshots(e);
}

void effect_reset_control(effect *e, control *c) {
    forget_old(e, c);
    if (!is_structure(c)) kinds[c->face.kind].reset(e, c);
    c->face.moved = false;
}

static bool control_take(effect *e, control *c, const char *text) {
    forget_old(e, c);
    if (!kinds[c->face.kind].set(e, c, text)) return false;
    if (c->face.kind == EFFECT_CONTROL_PARAM) effect_forget_moved(e, c->face.index);
    note_moved(e, c, text);
    return true;
}

static bool effect_set_control(effect *e, control *c, const char *text) {
    bool same = strcmp(text, c->face.initial) == 0;
    if (same && !is_structure(c)) {
        effect_reset_control(e, c);
        return true;
    }
    if (!control_take(e, c, text)) return false;
    if (same) c->face.moved = false;
    return true;
}

static bool refuse_structure(const char *name) {
    return err_set("%s is structure; it can only be set when the effect is loaded", name);
}

bool effect_set(effect *e, const char *name, const char *text) {
    control *c = find(e, name);
    if (!c) return false;
    return is_structure(c) ? refuse_structure(name) : effect_set_control(e, c, text);
}

// Sets a message that says why numbers cannot be what is set.
static bool check_numbers(const control *c, const float *values, int count) {
    const value_desc *desc = c->face.desc;
    if (is_structure(c)) return refuse_structure(c->face.name);
    if (c->face.kind == EFFECT_CONTROL_PALETTE || c->face.kind == EFFECT_CONTROL_CURVE ||
        c->face.kind == EFFECT_CONTROL_EVENTS)
        return err_set("%s is no number; it is set by its text", c->face.name);
    if (count != desc->components)
        return err_set("%s has %d numbers, not %d", c->face.name, desc->components, count);
    int wrong = value_find_wrong(desc, values, count);
    return wrong < 0 || value_refuse(desc, values[wrong], "%s", c->face.name);
}

bool effect_set_numbers(effect *e, size_t control_index, const float *values, int count) {
    control *c = e->controls[control_index];
    float all[4] = {0};
    if (!check_numbers(c, values, count)) return false;
    memcpy(all, values, (size_t)count * sizeof *all);
    forget_old(e, c);
    if (c->face.kind != EFFECT_CONTROL_PARAM)
        field_control_put(e, c, all);
    else if (effect_set_value(e, c->face.index, all))
        effect_forget_moved(e, c->face.index);
    else
        return false;
    if (!c->text) c->text = arena_alloc(&e->memory, c->text_capacity = NUMBERS_TEXT);
    memcpy(c->numbers, all, sizeof all);
    c->face.moved = c->as_numbers = true;
    return true;
}

bool effect_reset(effect *e, const char *name) {
    control *c = find(e, name);
    if (!c) return false;
    if (is_structure(c)) return refuse_structure(name);
    effect_reset_control(e, c);
    return true;
}

// ---- settings given before the script runs ------------------------------------------------------

void effect_copy_settings(effect *e, const effect_setting *settings, size_t count) {
    effect_setting *own = arena_alloc(&e->memory, count * sizeof *own);
    for (size_t i = 0; i < count; i++) {
        const effect_setting *s = &settings[i];
        own[i] = (effect_setting){
            .name = arena_string(&e->memory, s->name),
            .text = arena_string(&e->memory, s->text),
            .initial = s->initial ? arena_string(&e->memory, s->initial) : NULL,
        };
    }
    e->settings = own;
    e->setting_count = count;
    e->applied = arena_alloc(&e->memory, count * sizeof *e->applied);
}

// What the command line says of a uniform that the script leaves open is said, even where it is
// what the uniform is now: a source may give it another value later.
static bool control_apply(effect *e, control *c, const char *text) {
    bool open = c->face.kind == EFFECT_CONTROL_UNIFORM && !c->original;
    return open ? control_take(e, c, text) : effect_set_control(e, c, text);
}

bool effect_apply_to(effect *e, control *c) {
    for (size_t i = 0; i < e->setting_count; i++) {
        const effect_setting *s = &e->settings[i];
        if (strcmp(s->name, c->face.name) != 0) continue;
        e->applied[i] = true;
        if (s->initial && strcmp(s->initial, c->face.initial) != 0) continue;
        if (!control_apply(e, c, s->text) && !s->initial) return false;
    }
    return true;
}

bool effect_apply_settings(void *user, pass *p) {
    effect *e = user;
    size_t length = strlen(pass_label(p));
    add_passes(e);
    for (size_t i = 0; i < e->control_count; i++) {
        control *c = e->controls[i];
        if (rank(c->face.kind) != EFFECT_CONTROL_UNIFORM || e->passes[c->face.pass] != p) continue;
        if (c->slot && !c->face.moved) c->original = *c->slot; // the script has said all about it
        note_initial(e, c);
        if (!effect_apply_to(e, c)) return false;
    }
    for (size_t i = 0; i < e->setting_count; i++) {
        const effect_setting *s = &e->settings[i];
        bool meant = strncmp(s->name, pass_label(p), length) == 0 && s->name[length] == '.';
        if (meant && pass_ignores(p, s->name + length + 1)) e->applied[i] = true;
        if (meant && !e->applied[i] && !s->initial) return unknown(e, s->name);
    }
    return true;
}

bool effect_check_settings(effect *e) {
    if (!effect_antialias(e) || !scene_control_add_all(e) || !events_add_control(e)) return false;
    for (size_t i = 0; i < e->setting_count; i++)
        if (!e->applied[i] && !e->settings[i].initial) return unknown(e, e->settings[i].name);
    return true;
}
