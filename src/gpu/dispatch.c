// Compute work: check, barriers, bind, dispatch.
#include "gpu/vk.h"

static bool check(gpu *g, const gpu_dispatch_desc *desc) {
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

bool gpu_dispatch(gpu *g, const gpu_dispatch_desc *desc) {
    uint32_t groups[3];
    if (!check(g, desc) || !count_groups(g, desc, groups)) return false;
    VkCommandBuffer commands = g->frame->batch.commands;
    const gpu_pipeline *pipeline = desc->pipeline;
    vk_uses_begin(g);
    if (!vk_bindings_use(g, pipeline, desc->bindings, desc->binding_count)) return false;
    vk_uses_flush(g, commands);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline->built->handle);
    if (!vk_bindings_push(g, commands, pipeline, desc->bindings, desc->binding_count)) return false;
    vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
    return true;
}
