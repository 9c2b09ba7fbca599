// The whole way from hostile text to SPIR-V and its description: every failure has a message that
// names the shader. The compiler runs in the reader, where it may run out of time or memory, since
// no check before it can tell what a macro will become; a crash there is one here.
#include "base/error.h"
#include "base/memory.h"
#include "shader/compiler.h"
#include "whole_way.h"
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MILLISECONDS = 500, MEGABYTES = 128 };

static void check(const shader_binary *binary) {
    uint64_t bindings = 0;
    if (!binary->size || binary->size % 4) abort();
    for (size_t i = 0; i < binary->slot_count; i++) {
        uint32_t binding = binary->slots[i].slot.binding;
        if (binding >= GPU_MAX_SLOTS || bindings >> binding & 1) abort();
        bindings |= (uint64_t)1 << binding;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (fuzz_has_word_of_crash(data, size)) return 0;
    static shader_library *library;
    if (!library) {
        library = shader_library_create(&(shader_library_desc){0});
        compiler_set_limits(MILLISECONDS, MEGABYTES);
    }
    char *copy = mem_alloc(size + 1);
    if (size) memcpy(copy, data, size);
    const shader_text text = {"fuzz.comp", copy};
    arena memory = {0};
    shader_binary binary;
    shader_compile_desc desc = {.name = text.name, .texts = &text, .text_count = 1};
    err_clear();
    if (shader_compile(library, &memory, &desc, &binary))
        check(&binary);
    else if (!strstr(err_get(), text.name) || strstr(err_get(), "crashed"))
        abort();
    arena_free(&memory);
    mem_free(copy);
    return 0;
}
