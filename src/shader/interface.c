// Turns the lines of a unit into its shader_interface: finds annotations, checks names against each
// other, and notes which image declarations still need a format.
//
// `//@ ` and `//= ` with the blank are annotations; `//===` and the like are ordinary comments.
#include "base/memory.h"
#include "shader/annotate.h"
#include <ctype.h>
#include <string.h>

enum { MAX_NAMES = 1000 };

typedef struct reader {
    const shader_unit *unit;
    arena *memory;
    unit_inserts *inserts;
    value_desc *uniforms;
    value_desc *options;
    shader_field *fields;
    shader_image *images;
    shader_counter *counters;
    size_t uniform_count, option_count, field_count, image_count, counter_count;
    size_t uniform_capacity, option_capacity, field_capacity, image_capacity, counter_capacity;
} reader;

// ---- names ------------------------------------------------------------------------------------

// Uniforms, options, fields and images are all set by name, so they share one set of names.
static const char *kind_of_name(const reader *r, const char *name) {
    for (size_t i = 0; i < r->uniform_count; i++)
        if (strcmp(r->uniforms[i].name, name) == 0) return "a uniform";
    for (size_t i = 0; i < r->option_count; i++)
        if (strcmp(r->options[i].name, name) == 0) return "an option";
    for (size_t i = 0; i < r->field_count; i++)
        if (strcmp(r->fields[i].name, name) == 0) return "a field";
    for (size_t i = 0; i < r->image_count; i++)
        if (strcmp(r->images[i].name, name) == 0) return "an image";
    return NULL;
}

static bool name_is_free(const reader *r, const cursor *c, const char *name) {
    const char *kind = kind_of_name(r, name);
    size_t count = r->uniform_count + r->option_count + r->field_count + r->image_count;
    if (count == MAX_NAMES) return cursor_fail(c, "%s: more than %d names", name, MAX_NAMES);
    return !kind || cursor_fail(c, "%s: there is already %s of this name", name, kind);
}

static bool after_is_known(const reader *r, const cursor *c, const shader_field *field) {
    if (!field->after[0]) return true;
    for (size_t i = 0; i < r->field_count; i++)
        if (strcmp(r->fields[i].name, field->after) == 0) return true;
    return cursor_fail(c, "field %s: no field \"%s\" stands above it", field->name, field->after);
}

// ---- annotations ------------------------------------------------------------------------------

static bool add_option(reader *r, cursor *c) {
    value_desc option = {0};
    if (!annotation_option(c, &option) || !name_is_free(r, c, option.name)) return false;
    *MEM_ADD(r->options, r->option_count, r->option_capacity) = option;
    return true;
}

static bool add_field(reader *r, cursor *c) {
    shader_field field;
    if (!annotation_field(c, &field) || !name_is_free(r, c, field.name) ||
        !after_is_known(r, c, &field))
        return false;
    *MEM_ADD(r->fields, r->field_count, r->field_capacity) = field;
    return true;
}

static bool add_counter(reader *r, cursor *c) {
    shader_counter counter = {0};
    if (!annotation_counter(c, &counter)) return false;
    if (r->counter_count == MAX_NAMES) return cursor_fail(c, "more than %d counters", MAX_NAMES);
    for (size_t i = 0; i < r->counter_count; i++)
        if (strcmp(r->counters[i].name, counter.name) == 0)
            return cursor_fail(c, "%s: there is already a counter of this name", counter.name);
    *MEM_ADD(r->counters, r->counter_count, r->counter_capacity) = counter;
    return true;
}

static bool add_directive(reader *r, cursor *c) {
    static const char *const known[] = {"option", "field", "counter"};
    char word[NAME_CAP];
    if (!cursor_word(c, word, "option, field or counter")) return false;
    if (strcmp(word, "option") == 0) return add_option(r, c);
    if (strcmp(word, "field") == 0) return add_field(r, c);
    if (strcmp(word, "counter") == 0) return add_counter(r, c);
    const char *nearest = str_nearest(word, known, COUNT_OF(known));
    if (nearest) return cursor_fail(c, "unknown //@ %s; did you mean %s?", word, nearest);
    return cursor_fail(c, "unknown //@ %s; accepted are option, field, counter", word);
}

// Writes the format as a macro, so that a pass can choose another one.
static void insert_format(reader *r, const shader_image *image, size_t offset) {
    if (!r->inserts) return;
    strbuf text = {0};
    strbuf_add(&text, "layout(FORMAT_");
    unit_add_upper(&text, image->name);
    strbuf_add(&text, ") ");
    *MEM_ADD(r->inserts->items, r->inserts->count, r->inserts->capacity) =
        (unit_insert){.offset = offset, .text = arena_string(r->memory, text.text)};
    strbuf_free(&text);
}

static bool add_image(reader *r, cursor *c, const declaration *d, size_t offset) {
    shader_image image;
    if (!annotation_image(c, d, &image) || !name_is_free(r, c, image.name)) return false;
    if (image.output && d->uniform && d->format == GPU_FORMAT_NONE)
        insert_format(r, &image, offset);
    *MEM_ADD(r->images, r->image_count, r->image_capacity) = image;
    return true;
}

static bool add_uniform(reader *r, cursor *c, const declaration *d) {
    value_desc uniform;
    if (!annotation_uniform(c, d, &uniform) || !name_is_free(r, c, uniform.name)) return false;
    *MEM_ADD(r->uniforms, r->uniform_count, r->uniform_capacity) = uniform;
    return true;
}

static bool is_word(const char *text, const char *word) {
    size_t length = strlen(word);
    text += strspn(text, " \t");
    return strncmp(text, word, length) == 0 && !isalnum((unsigned char)text[length]) &&
           text[length] != '_';
}

static bool add_declared(reader *r, cursor *c, const char *code, size_t offset) {
    declaration d;
    if (!declaration_read(c, code, &d)) return false;
    if (is_word(c->at, "input") || is_word(c->at, "output")) return add_image(r, c, &d, offset);
    return add_uniform(r, c, &d);
}

static bool read_line(reader *r, const unit_line *line) {
    const char *text = r->unit->text.text + line->start;
    size_t comment = line->comment, length = line->length - comment;
    bool marked = length >= 4 && (text[comment + 2] == '@' || text[comment + 2] == '=') &&
                  (text[comment + 3] == ' ' || text[comment + 3] == '\t');
    if (!marked) return true;
    if (length > 4096) length = 4096;
    cursor c = {.at = arena_format(r->memory, "%.*s", (int)(length - 3), text + comment + 3),
                .label = r->unit->files[line->file].where.label,
                .line = line->number,
                .memory = r->memory};
    const char *code =
        arena_format(r->memory, "%.*s", (int)comment, r->unit->code.text + line->start);
    size_t blank = strspn(code, " \t");
    if (text[comment + 2] == '=') return add_declared(r, &c, code, line->start + blank);
    if (code[blank]) return cursor_fail(&c, "//@ must stand on a line of its own");
    return add_directive(r, &c);
}

// ---- the whole --------------------------------------------------------------------------------

// Returns the comment at the beginning of the main file, up to its first empty line.
static const char *summary(const shader_unit *unit, arena *memory) {
    const char *text = unit->files[0].text;
    strbuf joined = {0};
    text += strspn(text, " \t\r\n");
    while (strncmp(text, "//", 2) == 0 && text[2] != '@') {
        text += 2;
        text += strspn(text, " \t");
        size_t length = strcspn(text, "\r\n");
        if (!length) break;
        if (joined.length) strbuf_append(&joined, " ", 1);
        strbuf_append(&joined, text, length);
        text += length;
        text += strspn(text, "\r");
        text += *text == '\n';
    }
    const char *copy = arena_string(memory, strbuf_text(&joined));
    strbuf_free(&joined);
    return copy;
}

// Checks history inputs at the end, because one may stand above the output that it refers to.
static bool check_history(const reader *r) {
    for (size_t i = 0; i < r->image_count; i++) {
        const shader_image *image = &r->images[i];
        size_t j = 0;
        if (!image->history) continue;
        while (j < r->image_count &&
               !(r->images[j].output && strcmp(r->images[j].name, image->history_of) == 0))
            j++;
        if (j == r->image_count)
            return err_set("%s: input %s: there is no output \"%s\" to keep a history of",
                           r->unit->files[0].where.label, image->name, image->history_of);
    }
    return true;
}

static bool read_lines(reader *r) {
    for (size_t i = 0; i < r->unit->line_count; i++) {
        const unit_line *line = &r->unit->lines[i];
        if (line->comment < line->length && !read_line(r, line)) return false;
    }
    return true;
}

const shader_interface *unit_annotations(const shader_unit *unit, arena *memory,
                                         unit_inserts *inserts) {
    reader r = {.unit = unit, .memory = memory, .inserts = inserts};
    shader_interface *out = NULL;
    if (read_lines(&r) && check_history(&r)) {
        shader_interface all = {
            .path = arena_string(memory, unit->files[0].where.label),
            .summary = summary(unit, memory),
            .uniforms = arena_copy(memory, r.uniforms, r.uniform_count * sizeof *r.uniforms),
            .uniform_count = r.uniform_count,
            .options = arena_copy(memory, r.options, r.option_count * sizeof *r.options),
            .option_count = r.option_count,
            .fields = arena_copy(memory, r.fields, r.field_count * sizeof *r.fields),
            .field_count = r.field_count,
            .images = arena_copy(memory, r.images, r.image_count * sizeof *r.images),
            .image_count = r.image_count,
            .counters = arena_copy(memory, r.counters, r.counter_count * sizeof *r.counters),
            .counter_count = r.counter_count};
        out = arena_copy(memory, &all, sizeof all);
    }
    mem_free(r.uniforms);
    mem_free(r.options);
    mem_free(r.fields);
    mem_free(r.images);
    mem_free(r.counters);
    return out;
}

const shader_interface *shader_interface_load(shader_library *library, arena *memory,
                                              const char *name, const shader_reader *report) {
    shader_unit unit;
    unit_desc desc = {.name = name, .without_fields = true, .reader = report};
    const shader_interface *interface =
        library->binaries ? interface_memo_find(library, name, memory, report) : NULL;
    if (interface) return interface;
    if (!unit_load(library, &desc, &unit)) return NULL;
    interface = unit_annotations(&unit, memory, NULL);
    if (interface && library->binaries) interface_memo_keep(library, name, &unit, interface);
    unit_free(&unit);
    return interface;
}

static bool is_letter(char c) {
    return isalnum((unsigned char)c) || c == '_';
}

// Returns whether the text is no comment, or is an annotation of an option or a field.
static bool is_code(const shader_unit *unit, size_t at, size_t length) {
    if (memcmp(unit->code.text + at, unit->text.text + at, length) == 0) return true;
    while (at > 0 && unit->text.text[at - 1] != '\n') at--;
    return strncmp(unit->text.text + at, "//@", 3) == 0;
}

// Finds the name as a word, with or without a trailing underscore.
static bool has_word(const shader_unit *unit, const char *name) {
    const size_t length = strlen(name);
    const char *text = strbuf_text(&unit->text);
    for (const char *at = text; (at = strstr(at, name)); at += length) {
        const char *end = at + length;
        if (*end == '_') end++;
        if ((at == text || !is_letter(at[-1])) && !is_letter(*end) &&
            is_code(unit, (size_t)(at - text), length))
            return true;
    }
    return false;
}

bool shader_mentions(shader_library *library, const char *file, const char *name) {
    shader_unit unit;
    if (!unit_load(library, &(unit_desc){.name = file, .without_fields = true}, &unit))
        return false;
    const bool found = has_word(&unit, name);
    unit_free(&unit);
    return found;
}
