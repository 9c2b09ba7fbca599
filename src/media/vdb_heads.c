// The job "vdb heads": what files say of themselves, found without OpenVDB and in no process that
// has it.
#include "base/memory.h"
#include "media/vdb_describe.h"
#include "media/vdb_wire.h"
#include <string.h>

static bool put_grid(const isolate_call *call, const vdb_grid_info *g) {
    vdb_sent_grid sent = {.components = g->components,
                          .grid_class = g->grid_class,
                          .name = (uint32_t)strlen(g->name) + 1,
                          .type = (uint32_t)strlen(g->type) + 1,
                          .saved_half = g->saved_half,
                          .linear = g->linear,
                          .axis_aligned = g->axis_aligned,
                          .sheared = g->sheared,
                          .active_voxels = g->active_voxels,
                          .box = g->box};
    memcpy(sent.voxel_size, g->voxel_size, sizeof sent.voxel_size);
    memcpy(sent.background, g->background, sizeof sent.background);
    memcpy(sent.index_min, g->index_min, sizeof sent.index_min);
    memcpy(sent.index_max, g->index_max, sizeof sent.index_max);
    return isolate_put(call, &sent, sizeof sent) && isolate_put(call, g->name, sent.name) &&
           isolate_put(call, g->type, sent.type);
}

bool vdb_put_info(const isolate_call *call, const vdb_info *info) {
    const vdb_sent_info sent = {(uint32_t)info->count, (uint32_t)strlen(info->metadata) + 1,
                                info->y_up};
    bool done =
        isolate_put(call, &sent, sizeof sent) && isolate_put(call, info->metadata, sent.text);
    for (size_t i = 0; done && i < info->count; i++) done = put_grid(call, &info->grids[i]);
    return done;
}

static bool put_head(const isolate_call *call, const vdb_layout *l, arena *memory) {
    const vdb_sent_info without = {.count = VDB_NO_EXTENTS};
    vdb_info info;
    if (!vdb_tells_extents(l)) return isolate_put(call, &without, sizeof without);
    return vdb_describe(l, NULL, memory, &info) && vdb_put_info(call, &info);
}

bool vdb_heads_work(const isolate_call *call) {
    const char *name = call->bytes, *end = name + call->size;
    bool done = true;
    for (; done && name < end; name += strlen(name) + 1) {
        arena memory = {0};
        vdb_layout layout;
        void *bytes;
        size_t size;
        if (!call->ask(call, name, VDB_FILE_BYTES_MAX, &bytes, &size)) return false;
        done = vdb_layout_read(name, bytes, size, &memory, &layout) &&
               put_head(call, &layout, &memory);
        arena_free(&memory);
        mem_free(bytes);
    }
    return done;
}
