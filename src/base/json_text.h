// Trees of Jansson as text.
#pragma once
#include <jansson.h>

// Returns the tree as text, to be freed by mem_free: Jansson's own memory is another in a host than
// in the program. `flags` are those of json_dumps. NULL: there is no tree, or it cannot be written.
char *json_text(const json_t *root, size_t flags);
