// Turns the compiler's log into one message with the real file and line, and the source line below
// it.
#include "shader/unit.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

// Turns "'' : text " and "'x' : text " into "text" and "'x': text", in one line.
static void message_tidy(const char *text, char *out, size_t capacity) {
    size_t length = strcspn(text, "\r\n");
    if (strncmp(text, "'' : ", 5) == 0) {
        text += 5;
        length -= 5;
    }
    while (length && isspace((unsigned char)*text)) {
        text++;
        length--;
    }
    while (length && isspace((unsigned char)text[length - 1])) length--;
    snprintf(out, capacity, "%.*s", (int)(length < 1000 ? length : 1000), text);
    char *colon = strstr(out, "' : ");
    if (out[0] == '\'' && colon) memmove(colon + 1, colon + 2, strlen(colon + 2) + 1);
}

// Sets the message from the first line of `log` that contains `mark` ("ERROR: ").
static bool fail_log(const shader_unit *unit, const char *log, const char *mark) {
    const char *label = unit->files[0].where.label, *found = strstr(log, mark);
    char message[1024], source[240];
    int file, line, begin = 0;
    const char *text = found ? found + strlen(mark) : log;
    if (sscanf(text, "%d:%d: %n", &file, &line, &begin) < 2 || !begin) {
        message_tidy(text, message, sizeof message);
        return err_set("%s: %s", label, message[0] ? message : "the compiler gave no reason");
    }
    message_tidy(text + begin, message, sizeof message);
    if (file < 1 || (size_t)file > unit->file_count)
        return err_set("%s: in what roil puts before it: %s", label, message);
    unit_source_line(unit, file - 1, line, source, sizeof source);
    label = unit->files[file - 1].where.label;
    return err_set("%s:%d: %s\n    %s", label, line, message, source);
}

bool glsl_explain(const shader_unit *unit, const glsl_answer *answer) {
    const char *label = unit->files[0].where.label;
    switch (answer->outcome) {
    case GLSL_DONE:
        return true;
    case GLSL_REFUSED:
        return fail_log(unit, answer->data, "ERROR: ");
    case GLSL_INITIALISER:
        fail_log(unit, answer->data, "WARNING: ");
        return err_set("%s\n    a uniform takes its default from an annotation: //= value : help",
                       err_get());
    case GLSL_LONG_STATEMENT:
        return err_set("%s: a statement has more than %d operators", label, GLSL_MAX_OPERATORS);
    case GLSL_LARGE:
        return err_set("%s: it compiles to more than %d MiB", label, SPIRV_MAX_SIZE >> 20);
    case GLSL_INVALID:
        return err_set("%s: %s", label, (const char *)answer->data);
    case GLSL_NO_CODE:
        break;
    }
    return err_set("%s: no code was generated", label);
}
