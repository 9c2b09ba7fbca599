// The user's editor, opened at a line of a file. Needs no window.
#pragma once
#include "base/str.h"

// Splits a command at its blanks and puts file and line in: where %f and %l are, or else as
// "+LINE FILE", at the end. `out` holds at most `most` words and NULL; free each of them. False
// with a message: there are more, or none.
bool editor_words(const char *command, const char *file, int line, char **out, size_t most);
// Starts the editor, which is left to itself. False with a message that says how one is set.
bool editor_open(const char *file, int line);
