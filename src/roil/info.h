// What the texts and the JSON of the reference share, for src/roil/info*.c only.
#pragma once
#include "roil/roil_impl.h"
#include "script/reference.h"
#include <jansson.h>

// An option of a kind of field, and a field that a pass takes, as values.
value_desc info_option(const field_option *o);
value_desc info_field(const shader_field *f);
// Appends a line of a list: a name, and in a column of its own what is said of it.
void info_add_entry(strbuf *out, const char *name, const char *help);
json_t *info_effect_json(const roil_effect_info *info);
char *info_finish_json(json_t *root); // NULL with a message: a text is no UTF-8. Takes the tree
const char *info_device_kind(gpu_kind kind); // "discrete GPU"

// The reference as a tree, as roil_info_json describes it; NULL with a message. json_decref()
json_t *info_tree(roil *r);
