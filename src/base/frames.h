// Frames as people write them: "30", "10,30,50", "1-100", "1-100:2", or a list of such.
#pragma once
#include <stdbool.h>
#include <stddef.h>

enum { FRAMES_MAX = 1000000 };

// `*numbers`: mem_free. False with a message that says what is accepted.
bool frames_parse(const char *text, double **numbers, size_t *count);
