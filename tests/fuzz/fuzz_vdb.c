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

static uint64_t named; // voxels of the boxes that may hold something

static void found(void *user, const int32_t low[3], const int32_t high[3]) {
    const vdb_sample_desc *desc = user;
    uint64_t voxels = 1;
    for (int i = 0; i < 3; i++) {
        if (low[i] < 0 || low[i] > high[i] || high[i] >= (int32_t)desc->size[i]) __builtin_trap();
        voxels *= (uint64_t)(high[i] - low[i]) + 1;
    }
    named += voxels;
}

// The same in blocks, some of them outside.
static void read_blocks(const char *path, const vdb_grid_info *grid) {
    static float block[VDB_BLOCK * VDB_BLOCK * VDB_BLOCK * 3];
    vdb_sample_desc desc = {.path = path,
                            .grid = grid->name,
                            .box = grid->box,
                            .size = {SIDE, SIDE, SIDE},
                            .components = grid->components};
    vdb_blocks *blocks = vdb_blocks_open(&desc, NULL);
    if (!blocks) return;
    named = 0;
    vdb_blocks_visit(blocks, found, &desc);
    if (named > 100 * SIDE * SIDE * SIDE) __builtin_trap(); // far more than the box has
    int count = VDB_BLOCK * VDB_BLOCK * VDB_BLOCK * grid->components;
    for (int32_t at = -SIDE; at <= SIDE; at += VDB_BLOCK - 1) {
        const int32_t corner[3] = {at, 3, -at};
        vdb_blocks_read(blocks, corner, block);
        for (int i = 0; i < count; i++)
            if (!isfinite(block[i])) __builtin_trap();
    }
    vdb_blocks_background(blocks, block);
    for (int i = 0; i < grid->components; i++)
        if (!isfinite(block[i])) __builtin_trap();
    vdb_blocks_close(blocks);
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
            if (info.grids[i].components) {
                sample(path, &info.grids[i]);
                read_blocks(path, &info.grids[i]);
            }
    } else if (!err_get()[0]) {
        __builtin_trap();
    }
    arena_free(&memory);
    close(fd);
    err_clear();
    return 0;
}
