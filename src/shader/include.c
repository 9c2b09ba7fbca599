// The include resolver.
//
// A file is copied line by line; `#include "x"` is replaced by the file it names, between `#line`
// directives, so that every message of the compiler carries the true file (as a number) and line.
// Where x is looked for, in this order: the generated texts, beside the includer, the effect's
// folder, those of assets, the program's folder. Files of the program see neither the effect's
// folder nor assets, so nothing a user names can replace a part of a built-in shader.
//
// Invariants: a file is in a unit at most once; every file's block comments are closed, so text
// never runs from one file into the next; conditions are not evaluated, an #include in a branch
// that is not taken is read all the same. The compiler has an include resolver of its own, which
// knows no folders to stay in: it must never see an #include. So it gets no comments, no lone
// carriage returns, and no directive whose name is not complete on its line.
#include "base/file.h"
#include "base/memory.h"
#include "base/words.h"
#include "shader/unit.h"
#include <ctype.h>
#include <string.h>

#define BLANKS " \t\v\f"

typedef struct loader {
    const shader_library *library;
    const unit_desc *desc;
    shader_unit *unit;
    strbuf code; // scratch of scan_line
} loader;

typedef struct place { // of an #include; file -1: the unit itself
    int file, line;
} place;

static bool fail(const loader *l, place at, const char *message) {
    if (at.file < 0) return err_set("%s: %s", l->desc->name, message);
    return err_set("%s:%d: %s", l->unit->files[at.file].where.label, at.line, message);
}

// ---- finding ----------------------------------------------------------------------------------

static const shader_text *find_text(const loader *l, const char *name) {
    for (size_t i = 0; i < l->desc->text_count; i++)
        if (strcmp(l->desc->texts[i].name, name) == 0) return &l->desc->texts[i];
    return NULL;
}

int unit_find(const shader_library *library, const library_file *from, const char *name,
              arena *memory, library_file *out) {
    library_root home = from ? from->root : ROOT_NONE;
    int escaped = 0;
    if (home != ROOT_NONE) {
        char folder[PATH_CAP];
        path_folder(folder, from->name);
        int found = library_find(library, home, folder, name, memory, out);
        if (found > 0) return found;
        if (found < 0) escaped = found;
    }
    for (library_root root = ROOT_EFFECT; root < ROOT_COUNT && !escaped; root++) {
        if (root < ROOT_PROGRAM && home == ROOT_PROGRAM) continue;
        int found = library_find(library, root, "", name, memory, out);
        if (found) return found;
    }
    return escaped;
}

static int find_file(const loader *l, place at, const char *name, library_file *out) {
    const library_file *from = at.file < 0 ? NULL : &l->unit->files[at.file].where;
    return unit_find(l->library, from, name, &l->unit->memory, out);
}

static void note_include(shader_unit *unit, place at, const char *name, int target) {
    *MEM_ADD(unit->includes, unit->include_count, unit->include_capacity) =
        (unit_include){at.file, target, arena_string(&unit->memory, name)};
}

static void tell(const loader *l, const char *path) {
    if (l->desc->reader) l->desc->reader->read(l->desc->reader->user, path);
}

// Sets a message that says where a user may put the missing file.
static void tell_missing(const loader *l, place at, const char *name) {
    const char *top = l->library->roots[ROOT_EFFECT];
    char folder[PATH_CAP], beside[PATH_CAP], path[PATH_CAP];
    if (!top) return;
    if (path_join(path, top, name)) tell(l, path);
    if (at.file < 0 || l->unit->files[at.file].where.root != ROOT_EFFECT) return;
    path_folder(folder, l->unit->files[at.file].where.name);
    if (path_join(beside, folder, name) && path_join(path, top, beside)) tell(l, path);
}

static bool fail_missing(const loader *l, place at, const char *name) {
    tell_missing(l, at, name);
    strbuf message = {0};
    strbuf_add(&message, at.file < 0 ? "no such shader" : "include file \"%s\" not found", name);
    library_root home = at.file < 0 ? ROOT_NONE : l->unit->files[at.file].where.root;
    const char *joint = "; looked in ";
    for (library_root root = ROOT_EFFECT; root < ROOT_COUNT; root++) {
        if (!l->library->roots[root] || (root < ROOT_PROGRAM && home == ROOT_PROGRAM)) continue;
        strbuf_add(&message, "%s%s", joint, l->library->roots[root]);
        joint = " and ";
    }
    fail(l, at, message.text);
    strbuf_free(&message);
    return false;
}

// ---- adding -----------------------------------------------------------------------------------

static void chain(const shader_unit *unit, int file, strbuf *out) {
    if (unit->files[file].includer >= 0) {
        chain(unit, unit->files[file].includer, out);
        strbuf_add(out, " -> ");
    }
    strbuf_add(out, "%s", unit->files[file].where.label);
}

static bool fail_cycle(const loader *l, place at, int target) {
    strbuf message = {0};
    strbuf_add(&message, "include cycle: ");
    chain(l->unit, at.file, &message);
    strbuf_add(&message, " -> %s", l->unit->files[target].where.label);
    fail(l, at, message.text);
    strbuf_free(&message);
    return false;
}

// Turns every kind of line end into a newline.
static size_t unify_newlines(char *text, size_t size) {
    size_t kept = 0;
    for (size_t i = 0; i < size; i++) {
        bool pair = text[i] == '\r' && i + 1 < size && text[i + 1] == '\n';
        if (!pair) text[kept++] = text[i] == '\r' ? '\n' : text[i];
    }
    text[kept] = '\0';
    return kept;
}

// Index of a file already in the unit, or -1. Generated texts have no path, only a name.
static int find_known(const shader_unit *unit, const library_file *where) {
    for (size_t i = 0; i < unit->file_count; i++) {
        const library_file *known = &unit->files[i].where;
        bool same = where->path ? known->path && strcmp(known->path, where->path) == 0
                                : !known->path && strcmp(known->name, where->name) == 0;
        if (same) return (int)i;
    }
    return -1;
}

static bool read_file(loader *l, const library_file *where, char **text, size_t *size) {
    arena *memory = &l->unit->memory;
    const char *root = l->library->roots[where->root];
    if (l->library->memo) return memo_read(l->library->memo, root, where->path, memory, text, size);
    void *data;
    if (!file_read_inside(root, where->path, UNIT_MAX_SIZE, &data, size)) return false;
    *text = arena_copy(memory, data, *size + 1);
    mem_free(data);
    return true;
}

static bool read_text(loader *l, place at, unit_file *out) {
    char *text;
    size_t size;
    if (!read_file(l, &out->where, &text, &size)) return fail(l, at, err_get());
    if (memchr(text, '\0', size)) {
        err_set("%s: holds a zero byte, so it is not a text", out->where.label);
        return fail(l, at, err_get());
    }
    out->size = unify_newlines(text, size);
    out->text = text;
    return true;
}

static bool add_file(loader *l, int file, int depth);

static bool add_name(loader *l, place at, const char *name, int depth) {
    const shader_text *text = find_text(l, name);
    if (!text && l->desc->without_fields && strcmp(name, UNIT_FIELDS) == 0) return true;
    unit_file file = {.includer = at.file};
    if (text) {
        char *copy = arena_string(&l->unit->memory, text->name);
        file.where = (library_file){.root = ROOT_NONE, .name = copy, .label = copy};
        char *lines = arena_string(&l->unit->memory, text->text);
        file.size = unify_newlines(lines, strlen(lines));
        file.text = lines;
    } else {
        int found = find_file(l, at, name, &file.where);
        if (found < 0) return fail(l, at, err_get());
        if (!found) return fail_missing(l, at, name);
    }
    if (file.where.path) tell(l, file.where.path);
    int known = find_known(l->unit, &file.where);
    if (!text) note_include(l->unit, at, name, known >= 0 ? known : (int)l->unit->file_count);
    if (known >= 0) return !l->unit->files[known].open || fail_cycle(l, at, known);
    if (depth > UNIT_MAX_DEPTH) return fail(l, at, "includes are nested more than 32 deep");
    if (l->unit->file_count == UNIT_MAX_FILES) return fail(l, at, "more than 1000 files included");
    if (!text && !read_text(l, at, &file)) return false;
    *MEM_ADD(l->unit->files, l->unit->file_count, l->unit->file_capacity) = file;
    return add_file(l, (int)l->unit->file_count - 1, depth);
}

// ---- directives -------------------------------------------------------------------------------

// Tells the compiler that line `line` of `file` comes next.
static void add_position(shader_unit *unit, int line, int file) {
    size_t begin = unit->text.length;
    strbuf_add(&unit->text, "#line %d %d\n", line, file + 1);
    strbuf_append(&unit->code, unit->text.text + begin, unit->text.length - begin);
}

static bool include(loader *l, place at, const char *code, int depth) {
    const char *end = *code == '"' ? strchr(code + 1, '"') : NULL;
    if (!end || end == code + 1 || end[1 + strspn(end + 1, BLANKS)])
        return fail(l, at, "malformed #include; accepted is #include \"file\"");
    if (end - code >= PATH_CAP) return fail(l, at, "the name of the include file is too long");
    char name[PATH_CAP]; // a copy: the included file reuses `code`
    memcpy(name, code + 1, (size_t)(end - code - 1));
    name[end - code - 1] = '\0';
    if (!add_name(l, at, name, depth + 1)) return false;
    add_position(l->unit, at.line + 1, at.file);
    return true;
}

static void add_line(shader_unit *unit, place at, const char *line, const char *code, size_t length,
                     size_t comment) {
    *MEM_ADD(unit->lines, unit->line_count, unit->line_capacity) =
        (unit_line){.file = at.file,
                    .number = at.line,
                    .start = unit->text.length,
                    .length = length,
                    .comment = comment};
    strbuf_append(&unit->text, line, length);
    strbuf_append(&unit->text, "\n", 1);
    strbuf_append(&unit->code, code, length);
    strbuf_append(&unit->code, "\n", 1);
}

// Returns a copy of the directive's name; "" for a lone #; NULL when the code is no directive.
static const char *directive(const char *code, char out[16]) {
    code += strspn(code, BLANKS);
    if (*code != '#') return NULL;
    code++;
    code += strspn(code, BLANKS);
    size_t length = 0;
    while (isalnum((unsigned char)code[length]) || code[length] == '_') length++;
    str_copy(out, 16, code);
    if (length < 15) out[length] = '\0'; // longer ones stay longer than any that is known
    return code + length;
}

static bool is_known(const char *name, const char *rest) {
    static const char *const known[] = {"define", "undef",   "if",       "ifdef", "ifndef",
                                        "else",   "elif",    "endif",    "error", "pragma",
                                        "line",   "version", "extension"};
    return words_find(known, COUNT_OF(known), name) >= 0 ||
           (!name[0] && !rest[strspn(rest, BLANKS)]); // a lone # means nothing
}

static bool add_source_line(loader *l, place at, const char *line, size_t length, bool *in_comment,
                            int depth) {
    char name[16] = "";
    size_t comment = scan_line(&l->code, line, length, in_comment);
    char *code = l->code.text;
    const char *rest = directive(code, name);
    if (strstr(code, "local_size_")) l->unit->has_local_size = true;
    if (rest && strcmp(name, "include") == 0 && rest[strspn(rest, BLANKS)] != '<') {
        if (*in_comment) return fail(l, at, "a comment begins on a line with #include");
        return include(l, at, rest + strspn(rest, BLANKS), depth);
    }
    // <x> belongs to C, in the branch of a shared file that GLSL does not take.
    if (rest && strcmp(name, "include") == 0)
        memset(code, ' ', length);
    else if (rest && !is_known(name, rest))
        return fail(l, at, "unknown directive");
    // The prelude has the version and `#line` would spoil the positions in messages.
    if (strcmp(name, "version") == 0 || strcmp(name, "line") == 0) memset(code, ' ', length);
    add_line(l->unit, at, line, code, length, comment);
    if (l->unit->text.length > UNIT_MAX_SIZE)
        return fail(l, at, "the shader with its includes is larger than 4 MiB");
    return true;
}

static bool add_file(loader *l, int file, int depth) {
    const char *text = l->unit->files[file].text, *end = text + l->unit->files[file].size;
    bool in_comment = false;
    place at = {.file = file, .line = 0};
    l->unit->files[file].open = true;
    add_position(l->unit, 1, file);
    while (text < end) {
        const char *newline = memchr(text, '\n', (size_t)(end - text));
        size_t length = (size_t)((newline ? newline : end) - text);
        at.line++;
        if (!add_source_line(l, at, text, length, &in_comment, depth)) return false;
        text += length + 1;
    }
    if (in_comment) return fail(l, at, "a comment is not closed: */ is missing");
    l->unit->files[file].open = false;
    return true;
}

// ---- public -----------------------------------------------------------------------------------

bool unit_load(const shader_library *library, const unit_desc *desc, shader_unit *out) {
    *out = (shader_unit){0};
    loader l = {.library = library, .desc = desc, .unit = out};
    bool done = add_name(&l, (place){.file = -1}, desc->name, 0);
    strbuf_free(&l.code);
    if (!done) unit_free(out);
    return done;
}

void unit_free(shader_unit *unit) {
    mem_free(unit->files);
    mem_free(unit->includes);
    mem_free(unit->lines);
    strbuf_free(&unit->text);
    strbuf_free(&unit->code);
    arena_free(&unit->memory);
    *unit = (shader_unit){0};
}

void unit_source_line(const shader_unit *unit, int file, int number, char *out, size_t capacity) {
    const char *text = unit->files[file].text, *end = text + unit->files[file].size;
    for (int i = 1; i < number && text < end; i++) {
        const char *newline = memchr(text, '\n', (size_t)(end - text));
        text = newline ? newline + 1 : end;
    }
    while (text < end && (*text == ' ' || *text == '\t')) text++;
    size_t length = 0;
    for (; text < end && *text != '\n' && length + 1 < capacity; text++)
        out[length++] = iscntrl((unsigned char)*text) ? ' ' : *text;
    out[length] = '\0';
}
