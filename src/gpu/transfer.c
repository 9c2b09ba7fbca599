// Transfers: data that the host writes into memory of the device's reach, on any thread, and that
// is then copied into images beside the frames.
//
// A device with a queue that only copies gets the copies there: that submission waits for the work
// submitted before it, which may still read the images, and ends by handing them over to the other
// queue family. gpu_transfer_finish takes them over there, and makes the next submission wait for
// the copies. What the images held before is given up, so nothing needs to be handed over the other
// way (Vulkan 1.3 specification, 7.7.4 "Queue Family Ownership Transfer"). On all other devices the
// copies are recorded like any command, and the hazard tracker knows them.
#include "base/memory.h"
#include "gpu/vk.h"
#include <assert.h>
#include <inttypes.h>
#include <string.h>

struct gpu_transfer {
    gpu_buffer *buffer;
    VkCommandPool pool; // of the queue for copies; NULL: there is none
    VkCommandBuffer commands;
    uint64_t serial; // of the submission with the copies, on either queue; 0: never started
    gpu_transfer_part *parts;
    size_t count, capacity;
};

// ---- the queue --------------------------------------------------------------------------------

// A family that copies and does nothing else, in texels of any alignment. -1: none.
int vk_transfer_family_find(const vk_calls *vk, VkPhysicalDevice physical) {
    VkQueueFamilyProperties list[16];
    uint32_t count = COUNT_OF(list);
    vk->GetPhysicalDeviceQueueFamilyProperties(physical, &count, list);
    for (uint32_t i = 0; i < count; i++) {
        const VkQueueFlags other =
            VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_VIDEO_DECODE_BIT_KHR;
        VkExtent3D step = list[i].minImageTransferGranularity;
        if (!(list[i].queueFlags & VK_QUEUE_TRANSFER_BIT) || (list[i].queueFlags & other)) continue;
        if (step.width == 1 && step.height == 1 && step.depth == 1) return (int)i;
    }
    return -1;
}

bool vk_copier_open(gpu *g) {
    vk_copier *c = &g->copier;
    if (c->family < 0) return true;
    g->vk.GetDeviceQueue(g->device, (uint32_t)c->family, 0, &c->queue);
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    return vk_check(g, g->vk.CreateSemaphore(g->device, &info, NULL, &c->timeline),
                    "creating the timeline of copies");
}

void vk_copier_close(gpu *g) {
    g->vk.DestroySemaphore(g->device, g->copier.timeline, NULL);
}

static uint64_t copied(gpu *g) {
    uint64_t value = 0;
    VkResult result = g->vk.GetSemaphoreCounterValue(g->device, g->copier.timeline, &value);
    if (result == VK_ERROR_DEVICE_LOST) vk_lose(g, result);
    return result == VK_SUCCESS && value <= g->copier.submitted ? value : 0;
}

static bool wait_copied(gpu *g, uint64_t serial) {
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &g->copier.timeline,
                                .pValues = &serial};
    if (!vk_alive(g)) return false;
    VkResult result = g->vk.WaitSemaphores(g->device, &info, g->timeout);
    if (result == VK_TIMEOUT || result == VK_ERROR_DEVICE_LOST) return vk_lose(g, result);
    return vk_check(g, result, "waiting for copies to '%s'", g->info.name);
}

// ---- life -------------------------------------------------------------------------------------

gpu_transfer *gpu_transfer_create(gpu *g, uint64_t size) {
    gpu_transfer *t = mem_alloc(sizeof *t);
    t->buffer =
        vk_buffer_create(g, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VK_MEMORY_UPLOAD, "transfer");
    if (t->buffer && (g->copier.family < 0 ||
                      vk_commands_create(g, (uint32_t)g->copier.family, &t->pool, &t->commands)))
        return t;
    gpu_transfer_destroy(g, t);
    return NULL;
}

void gpu_transfer_destroy(gpu *g, gpu_transfer *t) {
    if (!t) return;
    if (t->pool && t->serial > 0) wait_copied(g, t->serial);
    g->vk.DestroyCommandPool(g->device, t->pool, NULL);
    gpu_buffer_destroy(g, t->buffer);
    mem_free(t->parts);
    mem_free(t);
}

uint64_t gpu_transfer_size(const gpu_transfer *t) {
    return t->buffer->size;
}

void *gpu_transfer_map(gpu_transfer *t) {
    return vk_memory_map(&t->buffer->memory);
}

// ---- copies -----------------------------------------------------------------------------------

static bool check_part(const gpu_transfer *t, const gpu_transfer_part *part) {
    VkExtent3D extent;
    uint64_t bytes;
    vk_image_extent(part->image, 0, &extent, &bytes);
    const char *label = part->image->desc.label;
    if (part->slices == 0 || part->slices > extent.depth)
        return err_set("image '%s': %u slices are given, it has %u", label, part->slices,
                       extent.depth);
    bytes = bytes / extent.depth * part->slices;
    if (part->offset % GPU_TRANSFER_ALIGN != 0 || part->offset > t->buffer->size ||
        bytes > t->buffer->size - part->offset)
        return err_set("image '%s': %" PRIu64 " bytes from byte %" PRIu64 " of a transfer of "
                       "%" PRIu64,
                       label, bytes, part->offset, t->buffer->size);
    return true;
}

static void copy_part(const gpu *g, VkCommandBuffer commands, const gpu_transfer *t,
                      const gpu_transfer_part *part) {
    VkBufferImageCopy region = {
        .bufferOffset = part->offset,
        .imageSubresource = {.aspectMask = part->image->aspect, .layerCount = 1},
        .imageExtent = {part->image->desc.width, part->image->desc.height, part->slices}};
    g->vk.CmdCopyBufferToImage(commands, t->buffer->handle, part->image->handle,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

static VkImageMemoryBarrier2 barrier_of(const gpu_image *image) {
    return (VkImageMemoryBarrier2){
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->handle,
        .subresourceRange = {.aspectMask = image->aspect, .levelCount = 1, .layerCount = 1}};
}

static void record_barrier(const gpu *g, VkCommandBuffer commands,
                           const VkImageMemoryBarrier2 *barrier) {
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                             .imageMemoryBarrierCount = 1,
                             .pImageMemoryBarriers = barrier};
    g->vk.CmdPipelineBarrier2(commands, &info);
}

// Half of a barrier: the first queue hands the image over, the second takes it.
static VkImageMemoryBarrier2 handover(const gpu *g, const gpu_image *image) {
    VkImageMemoryBarrier2 barrier = barrier_of(image);
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    barrier.srcQueueFamilyIndex = (uint32_t)g->copier.family;
    barrier.dstQueueFamilyIndex = g->family;
    return barrier;
}

static void record_copy(const gpu *g, gpu_transfer *t, const gpu_transfer_part *part) {
    VkImageMemoryBarrier2 begin = barrier_of(part->image), end = handover(g, part->image);
    begin.srcStageMask = begin.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    begin.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    begin.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    end.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    end.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    record_barrier(g, t->commands, &begin);
    copy_part(g, t->commands, t, part);
    record_barrier(g, t->commands, &end);
}

static VkResult record_copies(gpu *g, gpu_transfer *t) {
    VkResult result = g->vk.ResetCommandPool(g->device, t->pool, 0);
    if (result != VK_SUCCESS) return result;
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    result = g->vk.BeginCommandBuffer(t->commands, &begin);
    if (result != VK_SUCCESS) return result;
    for (size_t i = 0; i < t->count; i++) record_copy(g, t, &t->parts[i]);
    return g->vk.EndCommandBuffer(t->commands);
}

static bool submit_copies(gpu *g, gpu_transfer *t) {
    VkResult result = record_copies(g, t);
    VkCommandBufferSubmitInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                          .commandBuffer = t->commands};
    VkSemaphoreSubmitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                  .semaphore = g->timeline,
                                  .value = g->submitted,
                                  .stageMask = VK_PIPELINE_STAGE_2_COPY_BIT};
    VkSemaphoreSubmitInfo signal = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                    .semaphore = g->copier.timeline,
                                    .value = g->copier.submitted + 1,
                                    .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    VkSubmitInfo2 info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                          .waitSemaphoreInfoCount = 1,
                          .pWaitSemaphoreInfos = &wait,
                          .commandBufferInfoCount = 1,
                          .pCommandBufferInfos = &commands,
                          .signalSemaphoreInfoCount = 1,
                          .pSignalSemaphoreInfos = &signal};
    if (result == VK_SUCCESS)
        result = g->vk.QueueSubmit2(g->copier.queue, 1, &info, VK_NULL_HANDLE);
    if (result == VK_ERROR_DEVICE_LOST) return vk_lose(g, result);
    if (!vk_check(g, result, "submitting copies to '%s'", g->info.name)) return false;
    t->serial = ++g->copier.submitted;
    return true;
}

static bool record_in_order(gpu *g, gpu_transfer *t) {
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return false;
    vk_uses_begin(g);
    for (size_t i = 0; i < t->count; i++) vk_use_image(g, t->parts[i].image, 0, 1, vk_image_to);
    vk_uses_flush(g, commands);
    for (size_t i = 0; i < t->count; i++) copy_part(g, commands, t, &t->parts[i]);
    t->serial = atomic_load(&g->open_serial);
    return true;
}

bool gpu_transfer_start(gpu *g, gpu_transfer *t, const gpu_transfer_part *parts, size_t count) {
    assert(gpu_transfer_done(g, t));
    if (!vk_alive(g)) return false;
    for (size_t i = 0; i < count; i++)
        if (!check_part(t, &parts[i])) return false;
    MEM_RESERVE(t->parts, count, t->capacity);
    memcpy(t->parts, parts, count * sizeof *parts);
    t->count = count;
    return t->pool ? submit_copies(g, t) : record_in_order(g, t);
}

bool gpu_transfer_done(gpu *g, const gpu_transfer *t) {
    return (t->pool ? copied(g) : vk_completed(g)) >= t->serial;
}

bool gpu_transfer_finish(gpu *g, gpu_transfer *t) {
    VkCommandBuffer commands = t->pool ? vk_commands(g) : VK_NULL_HANDLE;
    if (!commands) return vk_alive(g);
    const VkPipelineStageFlags2 readers = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                          VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                          VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    for (size_t i = 0; i < t->count; i++) {
        VkImageMemoryBarrier2 barrier = handover(g, t->parts[i].image);
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT; // where submissions wait
        barrier.dstStageMask = readers;
        barrier.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
        record_barrier(g, commands, &barrier);
        t->parts[i].image->tracked[0].state =
            (hazard_state){.write_stages = readers,
                           .visible_stages = readers,
                           .visible_access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                           .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    }
    if (t->serial > g->copier.wait) g->copier.wait = t->serial;
    return true;
}
