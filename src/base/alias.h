// Folders that hold what was unpacked from a file: people know them by that file's name. Messages
// call them by it (err_set and log_write see to that). Any thread.
#pragma once
#include <stddef.h>

void alias_add(const char *folder, const char *name); // both are copied
void alias_remove(const char *folder);
// Replaces each of these folders in a text, where it is followed by '/' or the text ends, by its
// name. What does not fit into `capacity` bytes is cut off.
void alias_hide(char *text, size_t capacity);
