// SPIR-V as roil itself reads and rewrites it: any words, such as a damaged cache could hold, give
// a module whose instructions are whole, or are left as they are; what passes the gate and is valid
// is described through SPIRV-Cross. The seeds are modules of small shaders.
#include "base/error.h"
#include "base/memory.h"
#include "gpu/spirv.h"
#include "gpu/vk.h"
#include "shader/unit.h"
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST_IDS = 1 << 16 }; // tables of as many are made: more cost time and find nothing new

static bool is_whole(const uint32_t *words, size_t count) {
    size_t at = SPIRV_HEADER;
    while (at < count) {
        uint32_t length = words[at] >> 16;
        if (!length || length > count - at) return false;
        at += length;
    }
    return at == count;
}

typedef uint32_t *rewriter(const uint32_t *code, size_t size, size_t *out_size);

// `code` of the exact size: an overrun is caught. For mem_free, or NULL.
static uint32_t *rewrite(rewriter *how, const uint32_t *code, size_t size, size_t *out_size) {
    *out_size = size;
    uint32_t *made = how(code, size, out_size);
    if (!made) return NULL;
    if (*out_size % 4 || *out_size / 4 < SPIRV_HEADER || !is_whole(made, *out_size / 4)) abort();
    return made;
}

static void clean(const uint32_t *code, size_t count) {
    spirv copy = {.words = mem_copy(code, count * 4), .count = count};
    spirv_module module;
    bool read = spirv_module_read(&module, copy.words, count);
    err_clear();
    if (read && spirv_can_expand(&module)) {
        const uint32_t local_size[3] = {8, 8, 1}, live[] = {3, 5, 8, 13, 21, 34};
        spirv_clean(&copy, local_size, live, COUNT_OF(live));
        if (copy.count > count || !is_whole(copy.words, copy.count)) abort();
    } else if (read && !err_get()[0]) {
        abort();
    }
    spirv_module_free(&module);
    mem_free(copy.words);
}

// What has passed the gate gives a whole module, or says that it cannot be made safe.
static void clamp(const uint32_t *code, size_t count) {
    spirv whole = {.words = (uint32_t *)code, .count = count};
    uint32_t *clamped = NULL;
    size_t size;
    err_clear();
    bool passed = spirv_gate(&whole);
    if (!passed && !err_get()[0]) abort();
    if (passed && vk_clamp_indices(code, count * 4, &clamped, &size) && clamped &&
        !is_whole(clamped, size / 4))
        abort();
    mem_free(clamped);
}

// What has also been found valid is described, of whatever stage it is taken for, or refused.
static void reflect(const uint32_t *code, size_t count) {
    spirv whole = {.words = (uint32_t *)code, .count = count};
    if (!spirv_gate(&whole) || !spirv_validate(&whole)) return;
    for (int stage = SHADER_COMPUTE; stage <= SHADER_FRAGMENT; stage++) {
        spirv copy = {.words = mem_copy(code, count * 4), .count = count};
        arena memory = {0};
        shader_binary out;
        err_clear();
        bool done = spirv_reflect(&copy, (shader_stage)stage, &memory, &out);
        if (done ? out.slot_count > GPU_MAX_SLOTS || !is_whole(copy.words, copy.count)
                 : !err_get()[0])
            abort();
        arena_free(&memory);
        mem_free(copy.words);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    size_t count = size / 4, hoisted_size, hidden_size;
    uint32_t *code = malloc(count ? count * 4 : 1);
    if (!code) abort();
    if (count) memcpy(code, data, count * 4);
    if (count > SPIRV_BOUND && code[SPIRV_BOUND] > MOST_IDS) code[SPIRV_BOUND] %= MOST_IDS;
    clean(code, count);
    clamp(code, count);
    reflect(code, count);
    uint32_t *hoisted = rewrite(vk_hoist_uniforms, code, count * 4, &hoisted_size);
    uint32_t *hidden = rewrite(vk_hide_uniforms, code, count * 4, &hidden_size);
    mem_free(hidden);
    if (hoisted) mem_free(rewrite(vk_hide_uniforms, hoisted, hoisted_size, &hidden_size));
    mem_free(hoisted);
    free(code);
    return 0;
}
