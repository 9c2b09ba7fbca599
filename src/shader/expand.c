// How large a module is once every call is inlined, which is what drivers do. Thirty functions
// that call each other twice are a few hundred bytes of SPIR-V and a billion calls: SPIRV-Cross and
// drivers walk all of them, so such modules are refused.
//
// The size of a function is its own words and the sizes of what it calls; each is found once, by
// a walk in depth over the calls that keeps its own stack.
#include "base/memory.h"
#include "shader/unit.h"
#include <spirv_cross/spirv.h>

enum { HEADER_WORDS = 5, BOUND = 3 };

typedef struct function {
    size_t at, end; // words not walked yet
    size_t size;
    bool open, done;
} function;

typedef struct expansion {
    const spirv *code;
    function *functions;
    size_t count, capacity;
    uint32_t *index_of; // id -> index + 1, 0: no function
    uint32_t bound;
    uint32_t *stack;
    size_t depth;
} expansion;

// Words of the instruction at `i`; 0 when the rest is not an instruction.
static size_t length_at(const spirv *code, size_t i) {
    size_t length = code->words[i] >> SpvWordCountShift;
    return length <= code->count - i ? length : 0;
}

static bool list_functions(expansion *e) {
    const spirv *code = e->code;
    for (size_t i = HEADER_WORDS, length; i < code->count; i += length) {
        length = length_at(code, i);
        uint32_t opcode = code->words[i] & SpvOpCodeMask;
        if (!length) return false;
        if (opcode == SpvOpFunction) {
            if (length != 5 || code->words[i + 2] >= e->bound) return false;
            MEM_RESERVE(e->functions, e->count + 1, e->capacity);
            e->functions[e->count++] = (function){.at = i + length, .end = i + length};
            e->index_of[code->words[i + 2]] = (uint32_t)e->count;
        } else if (opcode == SpvOpFunctionEnd && e->count) {
            e->functions[e->count - 1].end = i;
        }
    }
    return true;
}

// Walks the function on top of the stack up to a call whose size is not known yet.
static bool walk(expansion *e) {
    const spirv *code = e->code;
    function *f = &e->functions[e->stack[e->depth - 1]];
    for (size_t length; f->at < f->end; f->at += length) {
        length = length_at(code, f->at);
        f->size += length;
        if ((code->words[f->at] & SpvOpCodeMask) != SpvOpFunctionCall) continue;
        uint32_t id = length > 3 ? code->words[f->at + 3] : e->bound;
        uint32_t index = id < e->bound ? e->index_of[id] : 0;
        if (!index) return err_set("SPIR-V: a call of no function");
        const function *callee = &e->functions[index - 1];
        if (callee->open) return err_set("SPIR-V: a function calls itself");
        if (!callee->done) {
            f->size -= length; // seen again once the callee is known
            e->functions[index - 1].open = true;
            e->stack[e->depth++] = index - 1;
            return true;
        }
        f->size += callee->size;
        if (f->size > SPIRV_MAX_EXPANDED)
            return err_set("with every call inlined, the code has more than %d million "
                           "instruction words",
                           SPIRV_MAX_EXPANDED >> 20);
    }
    f->open = false;
    f->done = true;
    e->depth--;
    return true;
}

static bool walk_all(expansion *e) {
    for (size_t i = 0; i < e->count; i++) {
        if (e->functions[i].done) continue;
        e->functions[i].open = true;
        e->stack[e->depth++] = (uint32_t)i;
        while (e->depth)
            if (!walk(e)) return false;
    }
    return true;
}

bool spirv_can_expand(const spirv *code) {
    expansion e = {.code = code};
    if (code->count <= HEADER_WORDS || code->words[BOUND] > SPIRV_MAX_SIZE / sizeof(uint32_t))
        return err_set("SPIR-V: not a module");
    e.bound = code->words[BOUND];
    e.index_of = mem_alloc(e.bound * sizeof *e.index_of);
    bool done = list_functions(&e) || err_set("SPIR-V: not a module");
    if (done) {
        e.stack = mem_alloc(e.count * sizeof *e.stack);
        done = walk_all(&e);
    }
    mem_free(e.stack);
    mem_free(e.index_of);
    mem_free(e.functions);
    return done;
}
