// Finds how large a module is once every call is inlined, which is what drivers do. Thirty
// functions that call each other twice are a few hundred bytes of SPIR-V and a billion calls:
// SPIRV-Cross and drivers walk all of them, so such modules are refused.
//
// The size of a function is its own words and the sizes of the functions that it calls. Each is
// found once, by a depth-first walk over the calls with a stack of its own. The memory of a
// thread's arrays is found in the same way, because a driver that inlines a call twice may allocate
// its arrays twice.
#include "shader/unit.h"

typedef struct function {
    size_t at, end; // words not walked yet
    size_t size;    // words
    size_t arrays;  // bytes
    bool open, done;
} function;

typedef struct expansion {
    const spirv_module *code;
    function *functions;
    size_t count, capacity;
    uint32_t *index_of; // id -> index + 1, 0: no function
    uint32_t *stack;
    size_t depth;
} expansion;

static void list_functions(expansion *e) {
    const spirv_module *code = e->code;
    for (size_t i = SPIRV_HEADER; i < code->count; i += code->words[i] >> SpvWordCountShift) {
        const uint32_t *w = code->words + i;
        uint32_t opcode = w[0] & SpvOpCodeMask, length = w[0] >> SpvWordCountShift;
        if (opcode == SpvOpFunction) {
            *MEM_ADD(e->functions, e->count, e->capacity) =
                (function){.at = i + length, .end = i + length};
            e->index_of[w[2]] = (uint32_t)e->count;
        } else if (opcode == SpvOpFunctionEnd && e->count) {
            e->functions[e->count - 1].end = i;
        }
    }
}

static size_t array_size(const spirv_module *m, const uint32_t *variable) {
    const uint32_t *pointer = spirv_find(m, variable[1], SpvOpTypePointer);
    const spirv_id *type = pointer && pointer[3] < m->bound ? &m->ids[pointer[3]] : NULL;
    return type && type->array ? type->size : 0;
}

static bool expand_check(const function *f) {
    if (f->size > SPIRV_MAX_EXPANDED)
        return err_set("with every call inlined, the code has more than %d million instruction "
                       "words",
                       SPIRV_MAX_EXPANDED >> 20);
    return f->arrays <= SPIRV_MAX_PRIVATE ||
           err_set("with every call inlined, a thread has arrays of more than %d KiB",
                   SPIRV_MAX_PRIVATE >> 10);
}

// Walks the function on top of the stack up to a call whose size is not known yet.
static bool expand_walk(expansion *e) {
    const spirv_module *code = e->code;
    function *f = &e->functions[e->stack[e->depth - 1]];
    for (size_t length; f->at < f->end; f->at += length) {
        const uint32_t *w = code->words + f->at;
        uint32_t opcode = w[0] & SpvOpCodeMask;
        length = w[0] >> SpvWordCountShift;
        f->size += length;
        if (opcode == SpvOpVariable) f->arrays += array_size(code, w);
        if (opcode == SpvOpFunctionCall) {
            uint32_t id = length > 3 ? w[3] : code->bound;
            uint32_t index = id < code->bound ? e->index_of[id] : 0;
            if (!index) return err_set("SPIR-V: a call of no function");
            function *callee = &e->functions[index - 1];
            if (callee->open) return err_set("SPIR-V: a function calls itself");
            if (!callee->done) {
                f->size -= length; // seen again once the callee is known
                callee->open = true;
                e->stack[e->depth++] = index - 1;
                return true;
            }
            f->size += callee->size;
            f->arrays += callee->arrays;
        }
        if (!expand_check(f)) return false;
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
            if (!expand_walk(e)) return false;
    }
    return true;
}

bool spirv_can_expand(const spirv_module *code) {
    expansion e = {.code = code};
    e.index_of = mem_alloc(code->bound * sizeof *e.index_of);
    list_functions(&e);
    e.stack = mem_alloc(e.count * sizeof *e.stack);
    bool done = walk_all(&e);
    mem_free(e.stack);
    mem_free(e.index_of);
    mem_free(e.functions);
    return done;
}
