// A file that was made or replaced, to be taken back and done again. Needs no window.
#pragma once
#include <stdbool.h>

typedef struct file_change file_change;
// Call it before the file is written; `root` is the folder that it lies in, however deep. NULL with
// a message: what is there cannot be read.
file_change *file_change_begin(const char *root, const char *path);
bool file_change_end(file_change *c); // and this after it was written
// Puts back what was there, or what was written. False with a message: the file is another one by
// now, and stays.
bool file_change_apply(const file_change *c, bool back);
void file_change_free(file_change *c); // NULL is allowed
