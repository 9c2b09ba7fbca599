// What commands print for programs, with --json.
#include "app/app.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/str.h"
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

// A text of a file need not be UTF-8.
static json_t *text_json(char *text) {
    str_make_printable(text);
    json_t *made = json_string(text);
    return made ? made : json_string("?");
}

json_t *app_error_json(const roil *r, const char *file) {
    roil_place place;
    char *message = strdup(roil_error());
    if (!message) err_out_of_memory(1);
    bool found = roil_find_place(r, message, &place);
    if (!found) str_copy(place.file, sizeof place.file, file);
    json_t *out =
        json_pack("{s:o, s:o}", "file", text_json(place.file), "message", text_json(message));
    if (found) json_object_set_new(out, "line", json_integer(place.line));
    if (place.column) json_object_set_new(out, "column", json_integer(place.column));
    free(message);
    return out;
}

int app_print_json(json_t *root, int status) {
    char *text = json_text(root, JSON_INDENT(1));
    json_decref(root);
    puts(text ? text : "{}");
    mem_free(text);
    return status;
}
