// Results of checks as a file and a page.
#pragma once
#include "theory.h"
#include <jansson.h>

json_t *write_check(const theory_check *c, double seconds);
void write_text(const theory_check *c, double seconds); // to stdout
// Runs a test program and gives what it printed, line by line, and whether it passed. NULL: it is
// not there.
json_t *write_test(const char *folder, const char *name);
