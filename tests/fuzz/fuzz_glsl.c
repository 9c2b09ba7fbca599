// The whole way from hostile text to SPIR-V and its description: every failure has a message that
// names the shader. The compiler runs in the reader, where it may run out of time or memory, since
// no check before it can tell what a macro will become; a crash there is one here. Text that
// defines no macro is compiled in this process besides, as it is, so that what it reaches guides
// the fuzzer.
#include "base/error.h"
#include "base/memory.h"
#include "shader/compiler.h"
#include "shader/unit.h"
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

// What the reader does with an answer (shader/compiler.c).
static void check_answer(void *user, const glsl_answer *answer) {
    const spirv code = {.words = answer->data, .count = answer->size / sizeof *code.words};
    arena memory = {0};
    shader_binary binary;
    if (answer->outcome > GLSL_LAST) abort();
    if (answer->outcome != GLSL_DONE || !spirv_validate(&code)) return;
    spirv copy = {.words = mem_copy(answer->data, answer->size), .count = code.count};
    if (spirv_reflect(&copy, *(const shader_stage *)user, &memory, &binary)) {
        binary.size = answer->size;
        check(&binary);
    }
    mem_free(copy.words);
    arena_free(&memory);
}

static void compile_here(const char *text) {
    strbuf source = {0};
    if (strstr(text, "define") || strchr(text, '\\')) return;
    strbuf_add(&source, "#version 460\n%s", text);
    for (shader_stage stage = SHADER_COMPUTE; stage <= SHADER_FRAGMENT; stage++)
        glsl_run(strbuf_text(&source), stage, check_answer, &stage);
    strbuf_free(&source);
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
    compile_here(copy);
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
