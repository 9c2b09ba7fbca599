// Compute work: check, barriers, bind, dispatch.
//
// Mesa's lavapipe (22.3) deals a dispatch out before it begins: each core takes a run of its
// groups, as many as the others, and waits for the slowest. The upper half of a picture is not as
// dear as the lower one, so there a dispatch goes in slices, whose halves are more alike.
#include "base/worker.h"
#include "gpu/vk.h"
#include <string.h>

enum { MOST_SLICES = 16, GROUPS_A_CORE = 8 }; // of a slice, at least

static bool dispatch_check(gpu *g, const gpu_dispatch_desc *desc) {
    if (!vk_alive(g)) return false;
    const gpu_pipeline *pipeline = desc->pipeline;
    if (!g->frame) return err_set("pipeline '%s': no frame is open", pipeline->label);
    if (pipeline->bind_point != VK_PIPELINE_BIND_POINT_COMPUTE) {
        return err_set("pipeline '%s' draws and cannot be dispatched", pipeline->label);
    }
    return vk_bindings_check(g, pipeline, desc->bindings, desc->binding_count);
}

static bool count_groups(gpu *g, const gpu_dispatch_desc *desc, uint32_t groups[3]) {
    for (int i = 0; i < 3; i++) {
        uint32_t threads = desc->threads[i] ? desc->threads[i] : 1;
        uint32_t local = desc->pipeline->local_size[i];
        groups[i] = threads / local + (threads % local != 0);
        if (groups[i] > g->limits.maxComputeWorkGroupCount[i]) {
            return err_set("pipeline '%s': %u threads along %c; the device allows %llu",
                           desc->pipeline->label, threads, "xyz"[i],
                           (unsigned long long)g -> limits.maxComputeWorkGroupCount[i] * local);
        }
    }
    return true;
}

static uint32_t count_slices(const vk_built *built, const uint32_t groups[3], uint32_t along) {
    if (!built->sliced) return 1;
    uint64_t least = GROUPS_A_CORE * (uint64_t)worker_cores();
    uint64_t most = (uint64_t)groups[0] * groups[1] * groups[2] / least;
    most = most < MOST_SLICES ? most : MOST_SLICES;
    most = most < groups[along] / 2 ? most : groups[along] / 2;
    return most > 1 ? (uint32_t)most : 1;
}

// Groups are numbered along x first, then y, then z.
static void dispatch(const gpu *g, VkCommandBuffer commands, const vk_built *built,
                     const uint32_t groups[3]) {
    uint32_t along = groups[2] > 1 ? 2 : groups[1] > 1 ? 1 : 0;
    uint32_t slices = count_slices(built, groups, along), first[3] = {0}, count[3];
    memcpy(count, groups, sizeof count);
    for (uint32_t i = 1; i <= slices; i++) {
        uint32_t end = (uint32_t)((uint64_t)groups[along] * i / slices);
        count[along] = end - first[along];
        if (first[along] == 0)
            g->vk.CmdDispatch(commands, count[0], count[1], count[2]);
        else
            g->vk.CmdDispatchBase(commands, first[0], first[1], first[2], count[0], count[1],
                                  count[2]);
        first[along] = end;
    }
}

bool gpu_dispatch(gpu *g, const gpu_dispatch_desc *desc) {
    uint32_t groups[3];
    if (!dispatch_check(g, desc) || !count_groups(g, desc, groups)) return false;
    VkCommandBuffer commands = g->frame->batch.commands;
    const gpu_pipeline *pipeline = desc->pipeline;
    vk_uses_begin(g);
    if (!vk_bindings_use(g, pipeline, desc->bindings, desc->binding_count)) return false;
    vk_uses_flush(g, commands);
    g->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline->built->handle);
    if (!vk_bindings_bind(g, commands, pipeline, desc->bindings, desc->binding_count)) return false;
    dispatch(g, commands, pipeline->built, groups);
    return true;
}
