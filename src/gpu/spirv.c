#define SPV_ENABLE_UTILITY_CODE
#include "gpu/spirv.h"

extern inline void SpvHasResultAndType(SpvOp opcode, bool *has_id, bool *has_type);

static uint32_t add(uint32_t a, uint32_t b) {
    return a > UINT32_MAX - b ? UINT32_MAX : a + b;
}

static uint32_t times(uint32_t a, uint32_t b) {
    uint64_t product = (uint64_t)a * b;
    return a == UINT32_MAX || product > UINT32_MAX ? UINT32_MAX : (uint32_t)product;
}

static uint32_t size_of(const spirv_module *m, uint32_t type) {
    return type < m->bound && m->ids[type].at ? m->ids[type].size : UINT32_MAX;
}

// Types come before what is made of them, so that no size is asked for before it is known.
static void measure_type(spirv_module *m, const uint32_t *w, uint32_t length, spirv_id *id) {
    uint32_t count = 0;
    switch (w[0] & SpvOpCodeMask) {
    case SpvOpTypeBool:
        id->size = 4;
        break;
    case SpvOpTypeInt:
    case SpvOpTypeFloat:
        if (length >= 3) id->size = w[2] / 8;
        break;
    case SpvOpTypeVector:
    case SpvOpTypeMatrix:
        if (length == 4) id->size = times(size_of(m, w[2]), w[3]);
        break;
    case SpvOpTypeArray:
        id->array = true;
        if (length == 4 && spirv_constant(m, w[3], &count))
            id->size = times(size_of(m, w[2]), count);
        break;
    case SpvOpTypeStruct:
        id->size = 0;
        for (uint32_t i = 2; i < length; i++) {
            id->size = add(id->size, size_of(m, w[i]));
            id->array = id->array || (w[i] < m->bound && m->ids[w[i]].array);
        }
        break;
    default:
        break;
    }
}

static bool define(spirv_module *m, const uint32_t *w, uint32_t length) {
    bool has_id, has_type;
    SpvHasResultAndType((SpvOp)(w[0] & SpvOpCodeMask), &has_id, &has_type);
    if (!has_id) return true;
    uint32_t place = has_type ? 2 : 1;
    if (length <= place || w[place] >= m->bound || m->ids[w[place]].at) return false;
    if (has_type && (w[1] >= m->bound || !m->ids[w[1]].at)) return false;
    spirv_id *id = &m->ids[w[place]];
    *id =
        (spirv_id){.at = (uint32_t)(w - m->words), .type = has_type ? w[1] : 0, .size = UINT32_MAX};
    if (!has_type) measure_type(m, w, length, id);
    return true;
}

bool spirv_module_read(spirv_module *m, const uint32_t *words, size_t count) {
    *m = (spirv_module){.words = words, .count = count};
    if (count <= SPIRV_HEADER || count > UINT32_MAX || words[0] != SpvMagicNumber ||
        words[SPIRV_BOUND] > SPIRV_MOST_IDS)
        return false;
    m->bound = words[SPIRV_BOUND];
    m->ids = mem_alloc(m->bound * sizeof *m->ids);
    for (size_t at = SPIRV_HEADER; at < count;) {
        uint32_t length = spirv_length(words, count, at);
        if (!length || !define(m, words + at, length)) return false;
        at += length;
    }
    return true;
}

void spirv_module_free(spirv_module *m) {
    mem_free(m->ids);
    m->ids = NULL;
}

const uint32_t *spirv_find(const spirv_module *m, uint32_t id, SpvOp op) {
    if (id >= m->bound || !m->ids[id].at) return NULL;
    const uint32_t *w = m->words + m->ids[id].at;
    return (w[0] & SpvOpCodeMask) == (uint32_t)op ? w : NULL;
}

bool spirv_constant(const spirv_module *m, uint32_t id, uint32_t *value) {
    const uint32_t *w = spirv_find(m, id, SpvOpConstant);
    if (!w || w[0] >> SpvWordCountShift != 4 || !spirv_find(m, w[1], SpvOpTypeInt)) return false;
    *value = w[3];
    return true;
}

// Returns the bytes of all variables of a storage class, in or out of functions; saturates.
static uint32_t spirv_storage_size(const spirv_module *m, SpvStorageClass storage) {
    uint32_t sum = 0;
    for (uint32_t id = 0; id < m->bound; id++) {
        const uint32_t *variable = spirv_find(m, id, SpvOpVariable);
        if (!variable || variable[0] >> SpvWordCountShift < 4 || variable[3] != storage) continue;
        const uint32_t *pointer = spirv_find(m, variable[1], SpvOpTypePointer);
        bool whole = pointer && pointer[0] >> SpvWordCountShift == 4;
        sum = add(sum, whole ? size_of(m, pointer[3]) : UINT32_MAX);
    }
    return sum;
}

bool spirv_shared_bytes(const uint32_t *words, size_t count, uint32_t *out) {
    spirv_module m;
    const bool known = spirv_module_read(&m, words, count);
    *out = known ? spirv_storage_size(&m, SpvStorageClassWorkgroup) : 0;
    spirv_module_free(&m);
    return known;
}
