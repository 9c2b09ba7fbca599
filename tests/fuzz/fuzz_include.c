// The include resolver and the annotation parser on hostile text. The input is split at zero bytes
// into generated texts "a", "b", "c", ...; "a" is the shader. Its includes reach the others, and a
// folder that holds nothing.
#include "base/memory.h"
#include "shader/unit.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MAX_TEXTS = 8 };

static char folder[] = "/tmp/roil-fuzz-XXXXXX";

static void remove_folder(void) {
    rmdir(folder);
}

static shader_library *open_library(void) {
    if (!mkdtemp(folder)) abort();
    atexit(remove_folder);
    return shader_library_create(&(shader_library_desc){.shader_root = folder});
}

// The compiler must see no directive that reads files.
static void check(const shader_unit *unit) {
    const char *code = strbuf_text(&unit->code);
    if (unit->code.length != unit->text.length || strlen(code) != unit->code.length) abort();
    for (const char *at = code; (at = strstr(at, "include")) != NULL; at++) {
        const char *before = at;
        while (before > code && strchr(" \t\v\f", before[-1])) before--;
        if (before == code || before[-1] != '#') continue;
        for (before--; before > code && strchr(" \t\v\f", before[-1]); before--) {
        }
        if (before == code || before[-1] == '\n') abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static shader_library *library;
    static const char *const names[MAX_TEXTS] = {"a", "b", "c", "d", "e", "f", "g", "h"};
    if (!library) library = open_library();
    char *copy = mem_alloc(size + 1), *at = copy; // zeroed: terminates the last text
    shader_text texts[MAX_TEXTS];
    size_t count = 0;
    if (size) memcpy(copy, data, size);
    for (; count < MAX_TEXTS && at <= copy + size; at += strlen(at) + 1) {
        texts[count] = (shader_text){names[count], at};
        count++;
    }
    shader_unit unit;
    unit_desc desc = {.name = "a", .texts = texts, .text_count = count, .without_fields = true};
    if (unit_load(library, &desc, &unit)) {
        arena memory = {0};
        unit_inserts inserts = {0};
        const shader_interface *interface = unit_annotations(&unit, &memory, &inserts);
        strbuf prelude = {0};
        shader_compile_desc compile = {.name = "a", .counters = true};
        check(&unit);
        if (interface && !unit_prelude(&unit, interface, &compile, &prelude)) abort();
        strbuf_free(&prelude);
        mem_free(inserts.items);
        arena_free(&memory);
        unit_free(&unit);
    }
    mem_free(copy);
    return 0;
}
