// Modules of SPIR-V as words (SPIR-V 1.6, section 2.3): five words of header, then instructions,
// whose first word holds their length above their opcode. For those files that read modules as a
// whole or rewrite them: clamp.c, hide.c, hoist.c, and the gate of src/shader.
#pragma once
#include "base/memory.h"
#include <spirv_cross/spirv.h>
#include <stdbool.h>
#include <stdint.h>

enum {
    SPIRV_HEADER = 5,  // words
    SPIRV_VERSION = 1, // where in them
    SPIRV_BOUND = 3,   // all ids are below it
    SPIRV_MOST_IDS = 1 << 22,
};

// ---- reading ----------------------------------------------------------------------------------

// Words of the instruction at `at`; 0 when what stands there is not one.
static inline uint32_t spirv_length(const uint32_t *words, size_t count, size_t at) {
    uint32_t length = words[at] >> SpvWordCountShift;
    return length <= count - at ? length : 0;
}

typedef struct spirv_id {
    uint32_t at;   // first word of the instruction that defines it; 0: none does
    uint32_t type; // of a value; 0: it is none
    uint32_t size; // of a type: bytes of its numbers, UINT32_MAX: more than that, or not known
    bool array;    // of a type: it is an array or holds one
} spirv_id;

typedef struct spirv_module {
    const uint32_t *words;
    size_t count;
    uint32_t bound;
    spirv_id *ids;
} spirv_module;

// False when an instruction is cut off, or when an id is defined twice, lies beyond the bound, or
// is the type of something before it is defined. `words` must outlive the module.
bool spirv_module_read(spirv_module *m, const uint32_t *words, size_t count);
void spirv_module_free(spirv_module *m);
// The instruction that defines an id; NULL: none does, or one of another opcode.
const uint32_t *spirv_find(const spirv_module *m, uint32_t id, SpvOp op);
// Value of an integer constant of 32 bits.
bool spirv_constant(const spirv_module *m, uint32_t id, uint32_t *value);
// Bytes that a work group shares, of a whole module; false: it is none.
bool spirv_shared_bytes(const uint32_t *words, size_t count, uint32_t *out);

// ---- writing ----------------------------------------------------------------------------------

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
        const uint32_t first = (uint32_t)(COUNT_OF(operands) + 1) << SpvWordCountShift | (op);     \
        spirv_put(out, &first, 1);                                                                 \
        spirv_put(out, operands, COUNT_OF(operands));                                              \
    } while (0)
