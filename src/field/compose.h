// Short ways to build expressions out of expressions; all nodes live in `memory`.
#pragma once
#include "field/field.h"

field *compose_number(arena *memory, float v);
// NULL, with the message that stands, when an operand is NULL; else as field_make.
field *compose_one(arena *memory, const char *kind, const field *a);
field *compose_two(arena *memory, const char *kind, const field *a, const field *b);
