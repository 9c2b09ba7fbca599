// Uniforms read once, where a shader begins, for a software driver that reads them anew everywhere.
//
// Mesa's lavapipe (22.3) reads a uniform before all branches and loops with one load for all of a
// subgroup's threads; within them with one for each thread, behind a comparison: fifty numbers in
// the loop of the march were a third of its time. Here every number, vector or matrix of a block
// that is reached by constant indices is read at the beginning of the entry point into a variable
// of the module, which is what all functions read. The driver keeps such variables on its stack.
//
// SPIR-V is rewritten word by word. What is used otherwise than to be read stays as it is.
#include "gpu/spirv.h"
#include "gpu/vk.h"
#include <string.h>

enum { MOST_CHAINS = 1024, MOST_IDS = 1 << 24, LISTS_ALL = 0x10400 }; // version 1.4

enum {              // what is known of an id
    PLAIN = 1 << 0, // a type of numbers
    CONSTANT = 1 << 1,
    BLOCK = 1 << 2, // a variable of storage class Uniform
    USED = 1 << 3,  // a chain, otherwise than to be read
};

typedef struct chain { // what constant indices reach
    uint32_t at;       // its first instruction, in words
    uint32_t type;     // of what it points to
    uint32_t variable;
} chain;

typedef struct hoister {
    const uint32_t *in;
    size_t in_count;
    spirv_words out;
    uint32_t bound;     // next free id
    uint32_t known;     // ids of the module
    uint8_t *flags;     // by id
    uint32_t *pointees; // of pointer types to Uniform
    uint32_t *privates; // pointer types to Private, by what they point to
    uint16_t *numbers;  // of chains by the id of their pointers, from 1
    uint32_t entry;     // function
    chain chains[MOST_CHAINS];
    uint32_t chain_count;
} hoister;

// ---- reading ----------------------------------------------------------------------------------

static bool is_chain(uint32_t op) {
    return op == SpvOpAccessChain || op == SpvOpInBoundsAccessChain;
}

static bool has(const hoister *h, uint32_t id, int flag) {
    return id < h->known && h->flags[id] & flag;
}

// Chains are alike when base and indices are.
static uint32_t find_chain(const hoister *h, const uint32_t *w, uint32_t words) {
    for (uint32_t i = 0; i < h->chain_count; i++) {
        const uint32_t *other = h->in + h->chains[i].at;
        if (other[0] >> 16 == words && memcmp(other + 3, w + 3, (words - 3) * sizeof *w) == 0)
            return i + 1;
    }
    return 0;
}

static void note_chain(hoister *h, const uint32_t *w, uint32_t words) {
    uint32_t type = h->pointees[w[1]], number = find_chain(h, w, words);
    if (!has(h, w[3], BLOCK) || !has(h, type, PLAIN)) return;
    for (uint32_t i = 4; i < words; i++)
        if (!has(h, w[i], CONSTANT)) return;
    if (!number && h->chain_count < MOST_CHAINS) {
        h->chains[h->chain_count++] = (chain){.at = (uint32_t)(w - h->in), .type = type};
        number = h->chain_count;
    }
    h->numbers[w[2]] = (uint16_t)number;
}

static void note_pointer(hoister *h, const uint32_t *w) {
    if (w[2] == SpvStorageClassUniform) h->pointees[w[1]] = w[3];
    if (w[2] == SpvStorageClassPrivate && w[3] < h->known) h->privates[w[3]] = w[1];
}

// False where an instruction is shorter than what is looked at, or names ids beyond the bound.
static bool note(hoister *h, uint32_t op, const uint32_t *w, uint32_t words) {
    bool type = op >= SpvOpTypeInt && op <= SpvOpTypeMatrix, pointer = op == SpvOpTypePointer;
    bool typed = op == SpvOpConstant || op == SpvOpVariable || is_chain(op);
    if (op == SpvOpEntryPoint) {
        if (h->entry || words < 4) return false;        // of several entry points nothing is known
        if (words > 0xffff - MOST_CHAINS) return false; // its list must grow
        h->entry = w[2];
    }
    if (op == SpvOpFunction) return words >= 5;
    if (!type && !pointer && !typed) return true;
    if (words < (type ? 3 : 4) || w[1] >= h->known || (typed && w[2] >= h->known)) return false;
    if (type) h->flags[w[1]] |= PLAIN;
    if (pointer) note_pointer(h, w);
    if (op == SpvOpConstant) h->flags[w[2]] |= CONSTANT;
    if (op == SpvOpVariable && w[3] == SpvStorageClassUniform) h->flags[w[2]] |= BLOCK;
    if (is_chain(op)) note_chain(h, w, words);
    return true;
}

// A word that looks like the id of a chain and is none keeps it where it is, no more.
static void note_uses(hoister *h, uint32_t op, const uint32_t *w, uint32_t words, bool body) {
    uint32_t end = body ? words : op == SpvOpName || op == SpvOpDecorate ? 2 : 0;
    for (uint32_t i = 1; i < end && i < words; i++) {
        bool made = i == 2 && is_chain(op), read = i == 3 && op == SpvOpLoad && words == 4;
        if (w[i] < h->known && h->numbers[w[i]] && !made && !read) h->flags[w[i]] |= USED;
    }
}

static bool read_module(hoister *h) {
    for (size_t at = SPIRV_HEADER; at < h->in_count;) {
        uint32_t words = h->in[at] >> 16, op = h->in[at] & 0xffff;
        if (!words || words > h->in_count - at || !note(h, op, h->in + at, words)) return false;
        at += words;
    }
    bool body = false;
    for (size_t at = SPIRV_HEADER; at < h->in_count; at += h->in[at] >> 16) {
        uint32_t op = h->in[at] & 0xffff;
        body = body || op == SpvOpFunction;
        note_uses(h, op, h->in + at, h->in[at] >> 16, body);
    }
    return h->entry && h->chain_count;
}

// ---- writing ----------------------------------------------------------------------------------

static uint32_t fresh(hoister *h) {
    return h->bound++;
}

static void put_entry(hoister *h, const uint32_t *w, uint32_t words) {
    bool listed = h->in[SPIRV_VERSION] >= LISTS_ALL;
    for (uint32_t i = 0; i < h->chain_count; i++) h->chains[i].variable = fresh(h);
    const uint32_t first = (words + (listed ? h->chain_count : 0)) << 16 | SpvOpEntryPoint;
    spirv_put(&h->out, &first, 1);
    spirv_put(&h->out, w + 1, words - 1);
    for (uint32_t i = 0; listed && i < h->chain_count; i++)
        spirv_put(&h->out, &h->chains[i].variable, 1);
}

// Before the first function: the variables.
static void put_globals(hoister *h) {
    for (uint32_t i = 0; i < h->chain_count; i++) {
        uint32_t type = h->chains[i].type, pointer = h->privates[type];
        if (!pointer) {
            pointer = h->privates[type] = fresh(h);
            SPIRV_PUT(&h->out, SpvOpTypePointer, pointer, SpvStorageClassPrivate, type);
        }
        SPIRV_PUT(&h->out, SpvOpVariable, pointer, h->chains[i].variable, SpvStorageClassPrivate);
    }
}

// What the entry point does first.
static void put_reads(hoister *h) {
    for (uint32_t i = 0; i < h->chain_count; i++) {
        const chain *c = &h->chains[i];
        const uint32_t *w = h->in + c->at;
        uint32_t pointer = fresh(h), value = fresh(h);
        spirv_put(&h->out, w, 2);
        spirv_put(&h->out, &pointer, 1);
        spirv_put(&h->out, w + 3, (w[0] >> 16) - 3);
        SPIRV_PUT(&h->out, SpvOpLoad, c->type, value, pointer);
        SPIRV_PUT(&h->out, SpvOpStore, c->variable, value);
    }
}

static const chain *hoisted(const hoister *h, uint32_t id) {
    bool is = id < h->known && h->numbers[id] && !has(h, id, USED);
    return is ? &h->chains[h->numbers[id] - 1] : NULL;
}

static void write_module(hoister *h) {
    bool globals = true, entry = false, begins = false; // the entry point, what it does
    spirv_put(&h->out, h->in, SPIRV_HEADER);
    for (size_t at = SPIRV_HEADER; at < h->in_count;) {
        const uint32_t *w = h->in + at;
        uint32_t words = w[0] >> 16, op = w[0] & 0xffff;
        at += words;
        if (op == SpvOpFunction) {
            if (globals) put_globals(h);
            globals = false;
            entry = w[2] == h->entry;
        }
        if (begins && op != SpvOpVariable && op != SpvOpLine) {
            put_reads(h);
            begins = entry = false;
        }
        const chain *read = op == SpvOpLoad && words == 4 ? hoisted(h, w[3]) : NULL;
        if (op == SpvOpEntryPoint)
            put_entry(h, w, words);
        else if (read)
            SPIRV_PUT(&h->out, SpvOpLoad, w[1], w[2], read->variable);
        else if (!is_chain(op) || !hoisted(h, w[2]))
            spirv_put(&h->out, w, words);
        if (op == SpvOpLabel && entry) begins = true;
    }
    h->out.words[SPIRV_BOUND] = h->bound;
}

uint32_t *vk_hoist_uniforms(const uint32_t *code, size_t size, size_t *out_size) {
    if (size < SPIRV_HEADER * sizeof *code || code[SPIRV_BOUND] > MOST_IDS) return NULL;
    uint32_t known = code[SPIRV_BOUND];
    hoister *h = mem_alloc(sizeof *h);
    *h = (hoister){.in = code, .in_count = size / 4, .known = known, .bound = known};
    h->flags = mem_alloc(known * sizeof *h->flags);
    h->pointees = mem_alloc(known * sizeof *h->pointees);
    h->privates = mem_alloc(known * sizeof *h->privates);
    h->numbers = mem_alloc(known * sizeof *h->numbers);
    if (read_module(h)) write_module(h);
    uint32_t *out = h->out.words;
    if (out) *out_size = h->out.count * 4;
    mem_free(h->flags);
    mem_free(h->pointees);
    mem_free(h->privates);
    mem_free(h->numbers);
    mem_free(h);
    return out;
}
