// Words of SPIR-V 1.6 (section 3), for those files that rewrite modules: hide.c, hoist.c.
#pragma once
#include "base/memory.h"
#include <stdint.h>

enum {
    SPIRV_HEADER = 5,
    SPIRV_VERSION = 1,
    SPIRV_BOUND = 3
}; // words; where in them: all ids are below the bound

enum {
    OP_NAME = 5,
    OP_LINE = 8,
    OP_ENTRY_POINT = 15,
    OP_CAPABILITY = 17,
    OP_TYPE_FIRST = 19, // OpTypeVoid, up to
    OP_TYPE_LAST = 39,  // OpTypeForwardPointer
    OP_TYPE_INT = 21,
    OP_TYPE_FLOAT = 22,
    OP_TYPE_VECTOR = 23,
    OP_TYPE_MATRIX = 24,
    OP_TYPE_ARRAY = 28,
    OP_TYPE_POINTER = 32,
    OP_CONSTANT = 43,
    OP_FUNCTION = 54,
    OP_FUNCTION_CALL = 57,
    OP_VARIABLE = 59,
    OP_LOAD = 61,
    OP_STORE = 62,
    OP_COPY_MEMORY = 63,
    OP_ACCESS_CHAIN = 65,
    OP_IN_BOUNDS_ACCESS_CHAIN = 66,
    OP_DECORATE = 71,
    OP_COMPOSITE_EXTRACT = 81,
    OP_COPY_OBJECT = 83,
    OP_CONVERT_F_TO_U = 109,
    OP_SHIFT_RIGHT_LOGICAL = 194,
    OP_LABEL = 248,
    MODEL_FRAGMENT = 4,
    STORAGE_INPUT = 1,
    STORAGE_UNIFORM = 2,
    STORAGE_PRIVATE = 6,
    CAPABILITY_UNIFORM_INDEXING = 28,
    DECORATION_BUILT_IN = 11,
    BUILT_IN_FRAG_COORD = 15,
    BUILT_IN_GROUP_COUNT = 24,
    BUILT_IN_WORKGROUP = 26,
};

typedef struct spirv_words {
    uint32_t *words;
    size_t count, capacity;
} spirv_words;

static inline void spirv_put(spirv_words *out, const uint32_t *words, size_t count) {
    MEM_RESERVE(out->words, out->count + count, out->capacity);
    for (size_t i = 0; i < count; i++) out->words[out->count++] = words[i];
}

// An instruction, whole.
#define SPIRV_PUT(out, op, ...)                                                                    \
    do {                                                                                           \
        const uint32_t operands[] = {__VA_ARGS__};                                                 \
        const uint32_t first = (uint32_t)(COUNT_OF(operands) + 1) << 16 | (op);                    \
        spirv_put(out, &first, 1);                                                                 \
        spirv_put(out, operands, COUNT_OF(operands));                                              \
    } while (0)
