#include "field/compose.h"

field *compose_number(arena *memory, float v) {
    return field_constant(memory, 1, (const float[4]){v});
}

field *compose_one(arena *memory, const char *kind, const field *a) {
    const field *args[FIELD_MAX_ARGS] = {a};
    return a ? field_make(memory, kind, args, NULL) : NULL;
}

field *compose_two(arena *memory, const char *kind, const field *a, const field *b) {
    const field *args[FIELD_MAX_ARGS] = {a, b};
    return a && b ? field_make(memory, kind, args, NULL) : NULL;
}
