// Lists of frames as people write them: "30", "10,30,50", "1-100", "1-100:2", or several of these.
#pragma once
#include <stdbool.h>
#include <stddef.h>

enum { FRAMES_MAX = 1000000 };

// Free `*numbers` with mem_free. False with a message that says what is accepted.
bool frames_parse(const char *text, double **numbers, size_t *count);
