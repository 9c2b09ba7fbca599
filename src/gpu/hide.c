// Uniform blocks hidden from a software driver that would make them constants.
//
// Mesa's lavapipe (22.3) puts the values of uniforms that branches and loops depend on into a
// shader as constants, and compiles that: at every dispatch, whatever the values were before, and
// what it made stays in memory for the life of the pipeline. Only where a shader says outright
// which block and member it reads can it do so. Here each block becomes an array of one block, and
// its index is computed: always 0, which a compiler cannot know. Of what is drawn fragment shaders
// need it, too: with loops by uniforms of two blocks lavapipe reads beside its own table of blocks.
//
// SPIR-V is rewritten word by word; a module with anything unforeseen is left as it is.
#include "gpu/spirv.h"
#include "gpu/vk.h"

typedef struct block { // a variable of storage class Uniform
    uint32_t id, type; // and of what it points to
} block;

typedef struct hider {
    const uint32_t *in;
    size_t in_count;
    spirv_words out;
    uint32_t bound;     // next free id
    uint32_t *pointees; // of pointer types to Uniform, by id; or 0
    bool fragment;
    // As the module has them; 0: it does not. `place` is a variable that says where a thread is, a
    // vector of `scalar`: the work group's, or a fragment's.
    uint32_t uint_type, scalar_type, vector_type, place;
    uint32_t own_uint, own_scalar, own_vector, own_place, top; // made here; `top` is the number 31
    bool decorated;
    block blocks[GPU_MAX_SLOTS];
    size_t block_count;
} hider;

static void put(hider *h, uint32_t word) {
    spirv_put(&h->out, &word, 1);
}

static const block *find_block(const hider *h, uint32_t id) {
    for (size_t i = 0; i < h->block_count; i++)
        if (h->blocks[i].id == id) return &h->blocks[i];
    return NULL;
}

// ---- reading ----------------------------------------------------------------------------------

// Whether it uses a block in another way than to reach a member of it.
static bool is_unforeseen(const hider *h, uint32_t op, const uint32_t *w, uint32_t words) {
    if (op != SpvOpLoad && op != SpvOpCopyMemory && op != SpvOpCopyObject &&
        op != SpvOpFunctionCall)
        return false;
    for (uint32_t i = 1; i < words; i++)
        if (find_block(h, w[i])) return true;
    return false;
}

static uint32_t built_in(const hider *h) {
    return h->fragment ? SpvBuiltInFragCoord : SpvBuiltInWorkgroupId;
}

static uint32_t vector_size(const hider *h) {
    return h->fragment ? 4 : 3;
}

static bool note(hider *h, uint32_t op, const uint32_t *w, uint32_t words) {
    if (op == SpvOpEntryPoint) h->fragment = w[1] == SpvExecutionModelFragment;
    if (op == SpvOpTypeInt && w[2] == 32 && w[3] == 0) h->uint_type = w[1];
    if (op == SpvOpTypeFloat && w[2] == 32 && h->fragment) h->scalar_type = w[1];
    if (!h->fragment) h->scalar_type = h->uint_type;
    if (op == SpvOpTypeVector && w[2] == h->scalar_type && w[3] == vector_size(h))
        h->vector_type = w[1];
    if (op == SpvOpDecorate && words == 4 && w[2] == SpvDecorationBuiltIn && w[3] == built_in(h))
        h->place = w[1];
    if (op == SpvOpTypePointer && w[2] == SpvStorageClassUniform && w[1] < h->bound)
        h->pointees[w[1]] = w[3];
    if (op == SpvOpVariable && w[3] == SpvStorageClassUniform) {
        if (h->block_count == COUNT_OF(h->blocks) || w[1] >= h->bound || !h->pointees[w[1]])
            return false;
        h->blocks[h->block_count++] = (block){w[2], h->pointees[w[1]]};
    }
    return !is_unforeseen(h, op, w, words);
}

// The least words of an instruction that is looked at.
static bool is_whole(uint32_t op, uint32_t words) {
    if (words == 0xffff) return false; // nothing can be added to it
    if (op == SpvOpTypeFloat || op == SpvOpEntryPoint) return words >= 3;
    uint32_t least = op == SpvOpTypeInt || op == SpvOpTypeVector || op == SpvOpTypePointer ||
                             op == SpvOpVariable || op == SpvOpAccessChain ||
                             op == SpvOpInBoundsAccessChain
                         ? 4
                         : 1;
    return words >= least;
}

static bool read_module(hider *h) {
    for (size_t at = SPIRV_HEADER; at < h->in_count;) {
        uint32_t words = h->in[at] >> 16, op = h->in[at] & 0xffff;
        if (!words || words > h->in_count - at || !is_whole(op, words) ||
            !note(h, op, h->in + at, words))
            return false;
        at += words;
    }
    return h->block_count > 0;
}

// ---- writing ----------------------------------------------------------------------------------

static uint32_t fresh(hider *h) {
    return h->bound++;
}

static void choose_ids(hider *h) {
    h->own_uint = h->uint_type ? h->uint_type : fresh(h);
    h->own_scalar = h->scalar_type ? h->scalar_type : h->fragment ? fresh(h) : h->own_uint;
    h->own_vector = h->vector_type ? h->vector_type : fresh(h);
    h->own_place = h->place ? h->place : fresh(h);
    h->top = fresh(h);
}

// Before the first function: types that are missing, and the blocks.
static void put_globals(hider *h) {
    if (!h->uint_type) SPIRV_PUT(&h->out, SpvOpTypeInt, h->own_uint, 32, 0);
    if (h->fragment && !h->scalar_type) SPIRV_PUT(&h->out, SpvOpTypeFloat, h->own_scalar, 32);
    if (!h->vector_type)
        SPIRV_PUT(&h->out, SpvOpTypeVector, h->own_vector, h->own_scalar, vector_size(h));
    if (!h->place) {
        uint32_t pointer = fresh(h);
        SPIRV_PUT(&h->out, SpvOpTypePointer, pointer, SpvStorageClassInput, h->own_vector);
        SPIRV_PUT(&h->out, SpvOpVariable, pointer, h->own_place, SpvStorageClassInput);
    }
    uint32_t one = fresh(h);
    SPIRV_PUT(&h->out, SpvOpConstant, h->own_uint, one, 1);
    SPIRV_PUT(&h->out, SpvOpConstant, h->own_uint, h->top, 31);
    for (size_t i = 0; i < h->block_count; i++) {
        uint32_t array = fresh(h), pointer = fresh(h);
        SPIRV_PUT(&h->out, SpvOpTypeArray, array, h->blocks[i].type, one);
        SPIRV_PUT(&h->out, SpvOpTypePointer, pointer, SpvStorageClassUniform, array);
        SPIRV_PUT(&h->out, SpvOpVariable, pointer, h->blocks[i].id, SpvStorageClassUniform);
    }
}

// The index, in a function: groups, and pixels, are counted to less than 2^31.
static uint32_t put_zero(hider *h) {
    uint32_t place = fresh(h), x = fresh(h), zero = fresh(h);
    SPIRV_PUT(&h->out, SpvOpLoad, h->own_vector, place, h->own_place);
    SPIRV_PUT(&h->out, SpvOpCompositeExtract, h->own_scalar, x, place, 0);
    if (h->fragment) {
        uint32_t whole = fresh(h);
        SPIRV_PUT(&h->out, SpvOpConvertFToU, h->own_uint, whole, x);
        x = whole;
    }
    SPIRV_PUT(&h->out, SpvOpShiftRightLogical, h->own_uint, zero, x, h->top);
    return zero;
}

static void put_entry(hider *h, const uint32_t *w, uint32_t words) {
    put(h, (words + !h->place) << 16 | SpvOpEntryPoint);
    spirv_put(&h->out, w + 1, words - 1);
    if (!h->place) put(h, h->own_place);
}

static void put_chain(hider *h, const uint32_t *w, uint32_t words, uint32_t zero) {
    put(h, w[0] + (1u << 16));
    spirv_put(&h->out, w + 1, 3);
    put(h, zero);
    spirv_put(&h->out, w + 4, words - 4);
}

static void write_module(hider *h) {
    bool globals = true, begins = false; // before all functions; in one, before what it does
    uint32_t zero = 0;
    spirv_put(&h->out, h->in, SPIRV_HEADER);
    SPIRV_PUT(&h->out, SpvOpCapability, SpvCapabilityUniformBufferArrayDynamicIndexing);
    choose_ids(h);
    for (size_t at = SPIRV_HEADER; at < h->in_count;) {
        const uint32_t *w = h->in + at;
        uint32_t words = w[0] >> 16, op = w[0] & 0xffff;
        at += words;
        if (op >= SpvOpTypeVoid && op <= SpvOpTypeForwardPointer && !h->decorated) {
            if (!h->place)
                SPIRV_PUT(&h->out, SpvOpDecorate, h->own_place, SpvDecorationBuiltIn, built_in(h));
            h->decorated = true;
        }
        if (op == SpvOpFunction && globals) {
            put_globals(h);
            globals = false;
        }
        if (begins && op != SpvOpVariable && op != SpvOpLine) {
            zero = put_zero(h);
            begins = false;
        }
        if (op == SpvOpFunction) zero = 0;
        bool chain = op == SpvOpAccessChain || op == SpvOpInBoundsAccessChain;
        if (op == SpvOpEntryPoint)
            put_entry(h, w, words);
        else if (chain && find_block(h, w[3]))
            put_chain(h, w, words, zero);
        else if (!globals || op != SpvOpVariable || !find_block(h, w[2]))
            spirv_put(&h->out, w, words);
        if (op == SpvOpLabel && !zero) begins = true;
    }
    h->out.words[SPIRV_BOUND] = h->bound;
}

uint32_t *vk_hide_uniforms(const uint32_t *code, size_t size, size_t *out_size) {
    enum { MOST_IDS = 1 << 24 };
    if (size < SPIRV_HEADER * sizeof *code || code[SPIRV_BOUND] > MOST_IDS) return NULL;
    hider h = {.in = code, .in_count = size / 4, .bound = code[SPIRV_BOUND]};
    h.pointees = mem_alloc(h.bound * sizeof *h.pointees);
    bool known = read_module(&h);
    if (known) write_module(&h);
    mem_free(h.pointees);
    if (known) *out_size = h.out.count * 4;
    return known ? h.out.words : NULL;
}
