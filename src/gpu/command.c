// Command buffers and the timeline.
//
// Every submission signals the next serial on one timeline semaphore, so "has it finished" is one
// comparison. A submission that fails leaves the tracked layouts wrong: the device counts as lost.
#include "gpu/vk.h"
#include <string.h>

bool vk_commands_create(gpu *g, uint32_t family, VkCommandPool *pool, VkCommandBuffer *commands) {
    VkCommandPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                    .queueFamilyIndex = family};
    if (!vk_check(g, g->vk.CreateCommandPool(g->device, &info, NULL, pool),
                  "creating a command pool")) {
        return false;
    }
    VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                          .commandPool = *pool,
                                          .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                          .commandBufferCount = 1};
    return vk_check(g, g->vk.AllocateCommandBuffers(g->device, &buffer, commands),
                    "creating a command buffer");
}

bool vk_batch_create(gpu *g, vk_batch *out) {
    return vk_commands_create(g, g->family, &out->pool, &out->commands);
}

void vk_batch_destroy(gpu *g, vk_batch *batch) {
    g->vk.DestroyCommandPool(g->device, batch->pool, NULL);
    vk_sets_free(g, &batch->sets);
    memset(batch, 0, sizeof *batch);
}

bool vk_batch_begin(gpu *g, vk_batch *batch) {
    if (!vk_wait(g, batch->serial) || !vk_sets_reset(g, &batch->sets)) return false;
    if (!vk_check(g, g->vk.ResetCommandPool(g->device, batch->pool, 0),
                  "resetting a command pool")) {
        return false;
    }
    VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                     .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (!vk_check(g, g->vk.BeginCommandBuffer(batch->commands, &info),
                  "opening a command buffer")) {
        return false;
    }
    atomic_store(&g->open_serial, g->submitted + 1);
    g->host_reads = false;
    return true;
}

// Waiting on the semaphore orders execution; only this makes the bytes visible to the host.
static void publish_to_host(const gpu *g, VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                             .memoryBarrierCount = 1,
                             .pMemoryBarriers = &barrier};
    g->vk.CmdPipelineBarrier2(commands, &info);
}

static VkResult end_and_submit(gpu *g, vk_batch *batch) {
    VkResult result = g->vk.EndCommandBuffer(batch->commands);
    if (result != VK_SUCCESS) return result;
    VkCommandBufferSubmitInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                          .commandBuffer = batch->commands};
    VkSemaphoreSubmitInfo waits[2 + GPU_MAX_SYNC], signals[2 + GPU_MAX_SYNC];
    uint32_t wait_count = 0, signal_count = 0;
    if (batch->wait)
        waits[wait_count++] =
            (VkSemaphoreSubmitInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                    .semaphore = batch->wait,
                                    .stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT};
    if (g->copier.wait)
        waits[wait_count++] =
            (VkSemaphoreSubmitInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                    .semaphore = g->copier.timeline,
                                    .value = g->copier.wait,
                                    .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    signals[signal_count++] =
        (VkSemaphoreSubmitInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                .semaphore = g->timeline,
                                .value = g->submitted + 1,
                                .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    if (batch->signal)
        signals[signal_count++] =
            (VkSemaphoreSubmitInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                    .semaphore = batch->signal,
                                    .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    if (batch->syncs) vk_host_add_syncs(g, waits, &wait_count, signals, &signal_count);
    VkSubmitInfo2 info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                          .commandBufferInfoCount = 1,
                          .pCommandBufferInfos = &commands,
                          .waitSemaphoreInfoCount = wait_count,
                          .pWaitSemaphoreInfos = waits,
                          .signalSemaphoreInfoCount = signal_count,
                          .pSignalSemaphoreInfos = signals};
    batch->wait = batch->signal = VK_NULL_HANDLE;
    batch->syncs = false;
    g->copier.wait = 0;
    return vk_host_submit(g, &info);
}

bool vk_batch_submit(gpu *g, vk_batch *batch) {
    if (g->host_reads) publish_to_host(g, batch->commands);
    VkResult result = end_and_submit(g, batch);
    if (result == VK_ERROR_DEVICE_LOST) return vk_lose(g, result);
    if (!vk_check(g, result, "submitting work to '%s'", g->info.name)) {
        atomic_store(&g->lost, true);
        return false;
    }
    batch->serial = ++g->submitted;
    vk_ring_mark(g);
    return true;
}

VkCommandBuffer vk_commands(gpu *g) {
    if (!vk_alive(g)) return VK_NULL_HANDLE;
    if (g->frame) return g->frame->batch.commands;
    if (!g->batch) {
        vk_batch *batch = &g->batches[g->batch_next];
        if (!vk_batch_begin(g, batch)) return VK_NULL_HANDLE;
        g->batch_next = (g->batch_next + 1) % VK_BATCHES;
        g->batch = batch;
    }
    return g->batch->commands;
}

bool vk_flush(gpu *g) {
    if (!vk_alive(g)) return false;
    if (!g->batch) return true;
    vk_batch *batch = g->batch;
    g->batch = NULL;
    return vk_batch_submit(g, batch);
}

bool gpu_idle(gpu *g) {
    if (!g->frame && !vk_flush(g)) return false;
    if (!vk_wait(g, g->submitted)) return false;
    vk_collect(g);
    return true;
}
