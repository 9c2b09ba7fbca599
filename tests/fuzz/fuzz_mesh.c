// Mesh import: any bytes, as the kind of file that their beginning suggests, give a mesh whose
// indices are in range or a message.
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "media/mesh.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char folder[PATH_CAP], files[3][PATH_CAP];

static void clean(void) {
    for (int i = 0; i < 3; i++) unlink(files[i]);
    rmdir(folder);
}

static void prepare(void) {
    static const char *const NAMES[3] = {"a.obj", "a.gltf", "a.glb"};
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/roil-fuzz-XXXXXX", base ? base : P_tmpdir);
    if (!mkdtemp(folder)) __builtin_trap();
    for (int i = 0; i < 3; i++)
        if (!path_join(files[i], folder, NAMES[i])) __builtin_trap();
    atexit(clean);
    log_set_level(LOG_ERROR);
}

static const char *choose(const uint8_t *data, size_t size) {
    if (size >= 4 && memcmp(data, "glTF", 4) == 0) return files[2];
    return size > 0 && data[0] == '{' ? files[1] : files[0];
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (!folder[0]) prepare();
    const char *path = choose(data, size);
    if (!file_write(path, data, size)) __builtin_trap();
    arena memory = {0};
    mesh_data mesh;
    if (mesh_load(path, folder, &memory, &mesh)) {
        for (uint32_t i = 0; i < mesh.index_count; i++)
            if (mesh.indices[i] >= mesh.vertex_count) __builtin_trap();
        for (uint32_t i = 0; i < mesh.part_count; i++)
            if (mesh.parts[i].texture >= (int)mesh.texture_count) __builtin_trap();
    } else if (!err_get()[0]) {
        __builtin_trap();
    }
    arena_free(&memory);
    err_clear();
    return 0;
}
