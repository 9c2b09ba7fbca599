// Parses the line of GLSL before an annotation: `layout(...) qualifiers uniform|out TYPE
// NAME[..];`. It understands only what annotations need; the compiler checks the rest.
#include "base/words.h"
#include "shader/annotate.h"
#include <ctype.h>
#include <string.h>

enum { SYMBOL_CAP = 64 };

// Returns the next identifier, number or symbol of the code; "" at its end. Long ones are
// truncated, which no keyword is.
static const char *next_symbol(const char *code, char out[SYMBOL_CAP]) {
    size_t length = 0;
    while (isspace((unsigned char)*code)) code++;
    if (isalnum((unsigned char)*code) || *code == '_') {
        for (; isalnum((unsigned char)*code) || *code == '_'; code++)
            if (length + 1 < SYMBOL_CAP) out[length++] = *code;
    } else if (*code) {
        out[length++] = *code++;
    }
    out[length] = '\0';
    return code;
}

static const char *read_layout(const char *code, gpu_format *format) {
    char symbol[SYMBOL_CAP];
    int depth = 0;
    do {
        code = next_symbol(code, symbol);
        depth += symbol[0] == '(' ? 1 : symbol[0] == ')' ? -1 : 0;
        gpu_format named = gpu_format_from_name(symbol);
        if (named != GPU_FORMAT_NONE) *format = named;
    } while (symbol[0] && depth > 0);
    return code;
}

static bool is_qualifier(const char *symbol) {
    static const char *const known[] = {"readonly", "writeonly", "restrict", "coherent",
                                        "volatile", "highp",     "mediump",  "lowp",
                                        "flat",     "smooth",    "centroid"};
    return words_find(known, sizeof known / sizeof *known, symbol) >= 0;
}

bool declaration_read(const cursor *c, const char *code, declaration *out) {
    char symbol[SYMBOL_CAP];
    bool stored = false;
    *out = (declaration){0};
    for (;;) {
        code = next_symbol(code, symbol);
        if (strcmp(symbol, "layout") == 0) {
            code = read_layout(code, &out->format);
        } else if (strcmp(symbol, "uniform") == 0 || strcmp(symbol, "out") == 0) {
            out->uniform = symbol[0] == 'u';
            stored = true;
        } else if (!is_qualifier(symbol)) {
            break;
        }
    }
    if (!stored || !str_is_identifier(symbol))
        return cursor_fail(c, "the annotation must follow `uniform TYPE NAME;` on its line");
    str_copy(out->type, sizeof out->type, symbol);
    code = next_symbol(code, symbol);
    if (!str_is_identifier(symbol))
        return cursor_fail(c, "the annotation must follow `uniform TYPE NAME;` on its line");
    if (strlen(symbol) + 1 == SYMBOL_CAP)
        return cursor_fail(c, "the name is longer than 62 letters: %s...", symbol);
    str_copy(out->name, sizeof out->name, symbol);
    code = next_symbol(code, symbol);
    if (symbol[0] == '[') out->array = true;
    if (symbol[0] == ',' || symbol[0] == '=')
        return cursor_fail(c, "%s: an annotated line declares one name, without initialiser",
                           out->name);
    if (out->array) return true;
    if (symbol[0] != ';') return cursor_fail(c, "expected ; after %s", out->name);
    next_symbol(code, symbol);
    return !symbol[0] || cursor_fail(c, "%s: the annotation must follow its ;", out->name);
}

const char *declaration_public_name(arena *memory, const char *glsl_name) {
    size_t length = strlen(glsl_name);
    if (length > 1 && glsl_name[length - 1] == '_') length--;
    return arena_format(memory, "%.*s", (int)length, glsl_name);
}
