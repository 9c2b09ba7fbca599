// Finds comments, the only part of GLSL that must be understood to find directives and annotations.
#include "shader/unit.h"

size_t scan_line(strbuf *code, const char *line, size_t length, bool *in_comment) {
    bool quoted = false;
    code->length = 0;
    strbuf_append(code, line, length);
    char *out = code->text;
    for (size_t i = 0; i < length; i++) {
        bool pair = i + 1 < length;
        if (*in_comment) {
            bool end = pair && line[i] == '*' && line[i + 1] == '/';
            out[i] = ' ';
            if (end) {
                out[++i] = ' ';
                *in_comment = false;
            }
        } else if (line[i] == '"') {
            quoted = !quoted;
        } else if (!quoted && pair && line[i] == '/' && line[i + 1] == '/') {
            for (size_t j = i; j < length; j++) out[j] = ' ';
            return i;
        } else if (!quoted && pair && line[i] == '/' && line[i + 1] == '*') {
            out[i] = out[i + 1] = ' ';
            i++;
            *in_comment = true;
        }
    }
    return length;
}
