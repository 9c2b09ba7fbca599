// Mesh import: any bytes, as the kind of file that their beginning suggests. What a worker of the
// reader runs is called in this process, so that a crash of assimp is a crash. Left out is what
// mesh_import refuses before assimp sees it: a glTF file whose objects are nested more than 100
// deep. The corpus and one input in sixteen go the whole way, through the reader, and give a mesh
// whose indices are in range or a message.
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "media/mesh_import.h"
#include "whole_way.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SEEDS = 32 }; // the first inputs, which are the corpus

static char folder[PATH_CAP], files[3][PATH_CAP];
static const char *const NAMES[3] = {"./a.obj", "./a.gltf", "./a.glb"};

static void clean(void) {
    for (int i = 0; i < 3; i++) unlink(files[i]);
    rmdir(folder);
}

static void prepare(void) {
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/roil-fuzz-XXXXXX", base ? base : P_tmpdir);
    if (!mkdtemp(folder)) __builtin_trap();
    for (int i = 0; i < 3; i++)
        if (!path_join(files[i], folder, NAMES[i] + 2)) __builtin_trap();
    atexit(clean);
    log_set_level(LOG_ERROR);
}

static size_t choose(const uint8_t *data, size_t size) {
    if (size >= 4 && memcmp(data, "glTF", 4) == 0) return 2;
    return size > 0 && data[0] == '{' ? 1 : 0;
}

static const uint8_t *current;
static size_t current_size;

// The mesh itself; every other file is missing.
static bool give(const isolate_call *call, const char *name, size_t max, void **data,
                 size_t *size) {
    if (strcmp(name, call->bytes) != 0 || current_size > max)
        return err_set("%s: cannot be read", name);
    char *copy = mem_alloc(current_size + 1);
    if (current_size) memcpy(copy, current, current_size);
    *data = copy;
    *size = current_size;
    return true;
}

static void import_here(size_t kind) {
    isolate_call call = {.name = "fuzz",
                         .bytes = NAMES[kind],
                         .size = strlen(NAMES[kind]),
                         .out = memfd_create("fuzz", MFD_CLOEXEC),
                         .channel = -1,
                         .ask = give};
    if (call.out < 0) __builtin_trap();
    err_clear();
    if (!mesh_import(&call) && !err_get()[0]) __builtin_trap();
    close(call.out);
}

static void import_whole_way(const char *path, const uint8_t *data, size_t size) {
    arena memory = {0};
    mesh_data mesh;
    fuzz_write(path, data, size);
    if (mesh_load(path, folder, &memory, &mesh)) {
        for (uint32_t i = 0; i < mesh.index_count; i++)
            if (mesh.indices[i] >= mesh.vertex_count) __builtin_trap();
        for (uint32_t i = 0; i < mesh.part_count; i++)
            if (mesh.parts[i].texture >= (int)mesh.texture_count) __builtin_trap();
    } else {
        fuzz_expect_message();
    }
    arena_free(&memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (fuzz_has_word_of_crash(data, size)) return 0;
    static unsigned count;
    if (!folder[0]) prepare();
    size_t kind = choose(data, size);
    current = data;
    current_size = size;
    import_here(kind);
    if (count++ % 16 == 0 || count < SEEDS) import_whole_way(files[kind], data, size);
    err_clear();
    return 0;
}
