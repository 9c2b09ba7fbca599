// VDB reader: any bytes give grids or a message, in this process what a worker of roil-reader-vdb
// does in its own. The corpus holds files written by OpenVDB 10 that
// cover the value types, tiles, halves, Blosc, zlib, shared trees, frustum and turned transforms,
// and absurd boxes; tests/unit/media_vdb.c reads the same files.
#include "base/error.h"
#include "base/memory.h"
#include "media/vdb_wire.h"
#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SIDE = 24 };

static const char name[] = "fuzz.vdb";
static const uint8_t *bytes;
static size_t byte_count;

static void sample(const vdb_file *f, const vdb_grid_info *grid) {
    static float out[SIDE * SIDE * SIDE * 3];
    vdb_sample_desc desc = {.path = name,
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
        if (!vdb_file_sample(f, &desc, NULL)) continue;
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
static void read_blocks(const vdb_file *f, const vdb_grid_info *grid) {
    static float block[VDB_BLOCK * VDB_BLOCK * VDB_BLOCK * 3];
    vdb_sample_desc desc = {.path = name,
                            .grid = grid->name,
                            .box = grid->box,
                            .size = {SIDE, SIDE, SIDE},
                            .components = grid->components};
    vdb_blocks *blocks = vdb_blocks_open(f, &desc);
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

// ---- whole frames, as a job
// -----------------------------------------------------------------------

static bool give(const isolate_call *call, const char *file, size_t max, void **data,
                 size_t *size) {
    (void)call, (void)file, (void)max;
    *data = mem_copy(bytes, byte_count);
    *size = byte_count;
    return true;
}

static void check_frame(int out, const vdb_sent_frame *sent) {
    vdb_frame_head head;
    struct stat info;
    if (pread(out, &head, sizeof head, 0) != sizeof head || fstat(out, &info) != 0)
        __builtin_trap();
    const texels_shape shape = {{SIDE, SIDE, SIDE}, sent->y_up != 0, sent->width};
    uint64_t end = head.images[0].texels;
    if (sent->sparse) {
        uint32_t index[(SIDE / VDB_BRICK) * (SIDE / VDB_BRICK) * (SIDE / VDB_BRICK)];
        if (pread(out, index, sizeof index, (off_t)head.images[0].index) != sizeof index)
            __builtin_trap();
        for (size_t i = 0; i < COUNT_OF(index); i++)
            if (index[i] > head.images[0].bricks) __builtin_trap();
        end += (uint64_t)head.images[0].bricks * VDB_BLOCK * VDB_BLOCK * VDB_BLOCK *
               texels_bytes(&shape);
    } else {
        end += texels_image_bytes(&shape, 0);
    }
    if (end != (uint64_t)info.st_size) __builtin_trap();
}

static void make_frame(const vdb_grid_info *grid, bool sparse, bool y_up) {
    struct {
        vdb_sent_frame frame;
        vdb_sent_source source;
        char name[1100];
    } sent = {.frame = {.box = grid->box,
                        .size = {SIDE, SIDE, SIDE},
                        .y_up = y_up,
                        .sparse = sparse,
                        .count = 1,
                        .width = grid->components,
                        .max_bytes = 1 << 24},
              .source = {.components = grid->components,
                         .channels = {0, 1, 2},
                         .gains = {1, 1, -1},
                         .name = (uint32_t)strlen(grid->name) + 1}};
    static_assert(offsetof(vdb_sent_source, name) + sizeof(uint32_t) == sizeof(vdb_sent_source) &&
                      sizeof sent.frame % _Alignof(vdb_sent_source) == 0,
                  "they follow one another without a gap");
    memcpy(sent.name, grid->name, sent.source.name);
    const isolate_call call = {.name = name,
                               .bytes = &sent,
                               .size = sizeof sent,
                               .out = memfd_create("frame", 0),
                               .ask = give};
    if (call.out < 0) __builtin_trap();
    if (vdb_frame_work(&call)) check_frame(call.out, &sent.frame);
    close(call.out);
}

static void describe(void) {
    const isolate_call call = {.name = name,
                               .bytes = name,
                               .size = sizeof name,
                               .out = memfd_create("heads", 0),
                               .ask = give};
    if (call.out < 0) __builtin_trap();
    err_clear();
    if (!vdb_heads_work(&call) && !err_get()[0]) __builtin_trap();
    close(call.out);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    arena memory = {0};
    vdb_info info;
    bytes = data;
    byte_count = size;
    describe();
    vdb_file *f = vdb_file_open(name, data, size);
    if (f && vdb_file_info(f, &memory, &info)) {
        for (size_t i = 0; i < info.count && i < 8; i++) {
            if (!info.grids[i].components) continue;
            sample(f, &info.grids[i]);
            read_blocks(f, &info.grids[i]);
            make_frame(&info.grids[i], i % 2, i % 4 > 1);
            make_frame(&info.grids[i], i % 2 == 0, i % 4 > 1);
        }
    } else if (!err_get()[0]) {
        __builtin_trap();
    }
    vdb_file_close(f);
    arena_free(&memory);
    err_clear();
    return 0;
}
