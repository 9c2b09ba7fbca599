// VDB reader: any bytes give grids or a message. The corpus holds files written by OpenVDB 10 that
// cover the value types, tiles, halves, Blosc, zlib, shared trees, frustum and turned transforms,
// and absurd boxes; tests/unit/media_vdb.c reads the same files.
#include "base/error.h"
#include "media/vdb.h"
#include <math.h>
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SIDE = 24 };

static void sample(const char *path, const vdb_grid_info *grid) {
    static float out[SIDE * SIDE * SIDE * 3];
    vdb_sample_desc desc = {.path = path,
                            .grid = grid->name,
                            .box = grid->box,
                            .size = {SIDE, SIDE, SIDE},
                            .components = grid->components,
                            .out = out};
    size_t count = SIDE * SIDE * SIDE * (size_t)grid->components;
    float step = grid->voxel_size[0] * SIDE;
    for (int exact = 0; exact < 2; exact++) { // scaled to the box; then voxel by voxel
        if (exact)
            desc.box.max =
                (float3){desc.box.min.x + step, desc.box.min.y + step, desc.box.min.z + step};
        if (!vdb_sample(&desc, NULL)) continue;
        for (size_t i = 0; i < count; i++)
            if (!isfinite(out[i])) __builtin_trap();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    int fd = memfd_create("fuzz.vdb", 0);
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    if (fd < 0 || write(fd, data, size) != (ssize_t)size) __builtin_trap();
    arena memory = {0};
    vdb_info info;
    if (vdb_read_info(path, &memory, &info)) {
        for (size_t i = 0; i < info.count && i < 8; i++)
            if (info.grids[i].components) sample(path, &info.grids[i]);
    } else if (!err_get()[0]) {
        __builtin_trap();
    }
    arena_free(&memory);
    close(fd);
    err_clear();
    return 0;
}
