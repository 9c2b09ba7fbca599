// Indices kept inside of what they index, for a driver that does not check them.
//
// Vulkan's robust access covers buffers and images. It leaves out the memory that a work group
// shares, variables, and what stages hand on: there an index out of bounds is undefined, and Mesa's
// lavapipe (22.3) reads and writes the memory of the process. Here each index into an array, a
// matrix or a vector of such storage that is not a constant inside of its bounds becomes the lesser
// of it and the last index, both taken as unsigned, so that a negative one becomes the last, too.
//
// It adds 43 words to the 22000 of a step of lbm, 25 to the 16400 of a march, up to 4 % to a part
// of the lighting. In times it cannot be told from noise: a step of 64^3 cells takes 28.8 ms with
// it and 29.8 without in halves, 40.0 and 38.3 in floats (2 busy cores, the best of five pairs).
//
// SPIR-V is rewritten word by word. The module has passed the gate of src/shader.
#include "gpu/spirv.h"
#include "gpu/vk.h"
#include <spirv_cross/GLSL.std.450.h>
#include <string.h>

typedef struct bound { // the last index, as a constant of the type of an index
    uint32_t type, last, id;
} bound;

typedef struct clamper {
    spirv_module in;
    spirv_words out;
    uint32_t next; // free id
    uint32_t set;  // of extended instructions; 0: the module has none
    bound *bounds;
    size_t bound_count, bound_capacity;
} clamper;

static bool is_chain(uint32_t op) {
    return op == SpvOpAccessChain || op == SpvOpInBoundsAccessChain;
}

static bool is_unchecked(uint32_t storage) {
    return storage == SpvStorageClassWorkgroup || storage == SpvStorageClassPrivate ||
           storage == SpvStorageClassFunction || storage == SpvStorageClassInput ||
           storage == SpvStorageClassOutput;
}

// ---- reading ----------------------------------------------------------------------------------

static uint32_t obtain_bound(clamper *c, uint32_t type, uint32_t last) {
    for (size_t i = 0; i < c->bound_count; i++)
        if (c->bounds[i].type == type && c->bounds[i].last == last) return c->bounds[i].id;
    *MEM_ADD(c->bounds, c->bound_count, c->bound_capacity) = (bound){type, last, c->next};
    return c->next++;
}

static uint32_t type_of(const spirv_module *m, uint32_t id) {
    return id < m->bound ? m->ids[id].type : 0;
}

// The type that a chain goes through, or the pointer that it starts from; NULL: another type.
static const uint32_t *type_at(const spirv_module *m, uint32_t id) {
    if (id >= m->bound || !m->ids[id].at) return NULL;
    const uint32_t *w = m->words + m->ids[id].at;
    switch (w[0] & SpvOpCodeMask) {
    case SpvOpTypeArray:
    case SpvOpTypeVector:
    case SpvOpTypeMatrix:
    case SpvOpTypePointer:
        return w[0] >> SpvWordCountShift == 4 ? w : NULL;
    case SpvOpTypeStruct:
        return w;
    default:
        return NULL;
    }
}

// How many elements or members it has, and the type of an element.
static bool count_of(const spirv_module *m, const uint32_t *type, uint32_t *count,
                     uint32_t *element) {
    uint32_t op = type[0] & SpvOpCodeMask;
    *element = op == SpvOpTypeStruct ? 0 : type[2];
    *count = op == SpvOpTypeStruct ? (type[0] >> SpvWordCountShift) - 2 : type[3];
    return op != SpvOpTypeArray || spirv_constant(m, type[3], count);
}

enum { MOST_STEPS = 255 }; // indices of a chain, by SPIR-V's limits (section 2.17)

// What the indices of the chain at `w` become: 0 for one that stays, else its last value. False
// where the chain leads to something unforeseen.
static bool follow(clamper *c, const uint32_t *w, uint32_t lasts[MOST_STEPS], bool *clamps) {
    const spirv_module *m = &c->in;
    uint32_t length = w[0] >> SpvWordCountShift;
    const uint32_t *pointer = length > 3 ? type_at(m, type_of(m, w[3])) : NULL;
    *clamps = false;
    if (!pointer || length - 4 > MOST_STEPS || (pointer[0] & SpvOpCodeMask) != SpvOpTypePointer)
        return false;
    if (!is_unchecked(pointer[2])) return true;
    const uint32_t *type = type_at(m, pointer[3]);
    for (uint32_t i = 4; i < length; i++) {
        uint32_t value = 0, count = 0, element = 0;
        bool known = spirv_constant(m, w[i], &value);
        if (!type || !count_of(m, type, &count, &element)) return false;
        bool inside = known && value < count;
        bool member = (type[0] & SpvOpCodeMask) == SpvOpTypeStruct;
        if (!count || (member && !inside)) return false;
        lasts[i - 4] = inside ? 0 : obtain_bound(c, type_of(m, w[i]), count - 1);
        *clamps = *clamps || !inside;
        type = type_at(m, member ? type[2 + value] : element);
    }
    return true;
}

static bool read_module(clamper *c) {
    const spirv_module *m = &c->in;
    for (size_t at = SPIRV_HEADER; at < m->count; at += m->words[at] >> SpvWordCountShift) {
        const uint32_t *w = m->words + at;
        uint32_t op = w[0] & SpvOpCodeMask, lasts[MOST_STEPS];
        bool clamps = false;
        if (op == SpvOpExtInstImport) c->set = w[1]; // the gate lets one pass
        if (is_chain(op) && !follow(c, w, lasts, &clamps)) return false;
    }
    return true;
}

// ---- writing ----------------------------------------------------------------------------------

static void put_import(clamper *c) {
    static const char name[16] = "GLSL.std.450";
    uint32_t words[4];
    memcpy(words, name, sizeof words);
    c->set = c->next++;
    SPIRV_PUT(&c->out, SpvOpExtInstImport, c->set, words[0], words[1], words[2], words[3]);
}

static void put_bounds(clamper *c) {
    for (size_t i = 0; i < c->bound_count; i++) {
        const bound *b = &c->bounds[i];
        const uint32_t *type = spirv_find(&c->in, b->type, SpvOpTypeInt);
        if (type && type[2] == 64)
            SPIRV_PUT(&c->out, SpvOpConstant, b->type, b->id, b->last, 0);
        else
            SPIRV_PUT(&c->out, SpvOpConstant, b->type, b->id, b->last);
    }
}

static void put_chain(clamper *c, const uint32_t *w) {
    uint32_t length = w[0] >> SpvWordCountShift, lasts[MOST_STEPS], chain[4 + MOST_STEPS];
    bool clamps;
    follow(c, w, lasts, &clamps);
    if (!clamps) {
        spirv_put(&c->out, w, length);
        return;
    }
    memcpy(chain, w, length * sizeof *w);
    for (uint32_t i = 4; i < length; i++) {
        if (!lasts[i - 4]) continue;
        chain[i] = c->next++;
        SPIRV_PUT(&c->out, SpvOpExtInst, type_of(&c->in, w[i]), chain[i], c->set, GLSLstd450UMin,
                  w[i], lasts[i - 4]);
    }
    spirv_put(&c->out, chain, length);
}

static void write_module(clamper *c) {
    const spirv_module *m = &c->in;
    bool globals = true;
    spirv_put(&c->out, m->words, SPIRV_HEADER);
    for (size_t at = SPIRV_HEADER; at < m->count; at += m->words[at] >> SpvWordCountShift) {
        const uint32_t *w = m->words + at;
        uint32_t op = w[0] & SpvOpCodeMask;
        if (op == SpvOpMemoryModel && !c->set) put_import(c);
        if (op == SpvOpFunction && globals) {
            put_bounds(c);
            globals = false;
        }
        if (is_chain(op))
            put_chain(c, w);
        else
            spirv_put(&c->out, w, w[0] >> SpvWordCountShift);
    }
    c->out.words[SPIRV_BOUND] = c->next;
}

bool vk_clamp_indices(const uint32_t *code, size_t size, uint32_t **out, size_t *out_size) {
    clamper c = {0};
    bool known = spirv_module_read(&c.in, code, size / 4);
    c.next = c.in.bound;
    known = known && read_module(&c);
    if (known && c.bound_count) write_module(&c);
    *out = c.out.words;
    *out_size = c.out.words ? c.out.count * 4 : size;
    mem_free(c.bounds);
    spirv_module_free(&c.in);
    return known;
}
