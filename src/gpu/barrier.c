// What a command touches, gathered before it is recorded, and the barriers that follow.
//
// All uses of a command are merged per level and buffer first: two bindings of one image are one
// access, and barriers of neighbouring levels become one.
#include "base/memory.h"
#include "gpu/vk.h"
#include <assert.h>

const hazard_access vk_image_from = {.stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                     .reads = VK_ACCESS_2_TRANSFER_READ_BIT,
                                     .layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
const hazard_access vk_image_to = {.stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                   .writes = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
const hazard_access vk_buffer_from = {.stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                      .reads = VK_ACCESS_2_TRANSFER_READ_BIT};
const hazard_access vk_buffer_to = {.stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                    .writes = VK_ACCESS_2_TRANSFER_WRITE_BIT};

void vk_uses_begin(gpu *g) {
    g->uses.count = 0;
    g->uses.stamp++;
}

// False on a contradiction with another use by the same command.
static bool want(gpu *g, vk_tracked *tracked, hazard_access access, vk_use use) {
    vk_uses *uses = &g->uses;
    if (tracked->stamp == uses->stamp) return hazard_merge(&tracked->wanted, &access);
    tracked->stamp = uses->stamp;
    tracked->wanted = access;
    *MEM_ADD(uses->list, uses->count, uses->capacity) = use;
    return true;
}

bool vk_use_image(gpu *g, gpu_image *image, uint32_t mip, uint32_t count, hazard_access access) {
    assert(count <= image->desc.mips && mip <= image->desc.mips - count);
    for (uint32_t i = mip; i < mip + count; i++) {
        if (!want(g, &image->tracked[i], access, (vk_use){.image = image, .mip = i})) {
            return err_set("image '%s', level %u, is used in two ways at once: what is written by "
                           "a command can be neither sampled nor drawn to by it",
                           image->desc.label, i);
        }
    }
    return true;
}

bool vk_use_buffer(gpu *g, gpu_buffer *buffer, hazard_access access) {
    if (access.writes && buffer->kind == GPU_BUFFER_READBACK) g->host_reads = true;
    return want(g, &buffer->tracked, access, (vk_use){.buffer = buffer});
}

static VkImageMemoryBarrier2 image_barrier(const vk_use *use, const hazard_barrier *b) {
    return (VkImageMemoryBarrier2){.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                   .srcStageMask = b->source_stages,
                                   .srcAccessMask = b->source_access,
                                   .dstStageMask = b->stages,
                                   .dstAccessMask = b->access,
                                   .oldLayout = b->old_layout,
                                   .newLayout = b->layout,
                                   .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .image = use->image->handle,
                                   .subresourceRange = {.aspectMask = use->image->aspect,
                                                        .baseMipLevel = use->mip,
                                                        .levelCount = 1,
                                                        .layerCount = 1}};
}

static bool extends(const VkImageMemoryBarrier2 *last, const VkImageMemoryBarrier2 *next) {
    return last->image == next->image &&
           last->subresourceRange.baseMipLevel + last->subresourceRange.levelCount ==
               next->subresourceRange.baseMipLevel &&
           last->srcStageMask == next->srcStageMask && last->srcAccessMask == next->srcAccessMask &&
           last->dstStageMask == next->dstStageMask && last->dstAccessMask == next->dstAccessMask &&
           last->oldLayout == next->oldLayout && last->newLayout == next->newLayout;
}

static void add_image_barrier(vk_uses *uses, uint32_t *count, VkImageMemoryBarrier2 barrier) {
    if (*count > 0 && extends(&uses->images[*count - 1], &barrier)) {
        uses->images[*count - 1].subresourceRange.levelCount++;
        return;
    }
    *MEM_ADD(uses->images, *count, uses->image_capacity) = barrier;
}

static void add_buffer_barrier(vk_uses *uses, uint32_t *count, const gpu_buffer *buffer,
                               const hazard_barrier *b) {
    *MEM_ADD(uses->buffers, *count, uses->buffer_capacity) =
        (VkBufferMemoryBarrier2){.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
                                 .srcStageMask = b->source_stages,
                                 .srcAccessMask = b->source_access,
                                 .dstStageMask = b->stages,
                                 .dstAccessMask = b->access,
                                 .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                 .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                 .buffer = buffer->handle,
                                 .size = VK_WHOLE_SIZE};
}

void vk_uses_flush(gpu *g, VkCommandBuffer commands) {
    vk_uses *uses = &g->uses;
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    for (size_t i = 0; i < uses->count; i++) {
        const vk_use *use = &uses->list[i];
        vk_tracked *tracked = use->image ? &use->image->tracked[use->mip] : &use->buffer->tracked;
        hazard_barrier barrier;
        if (!hazard_track(&tracked->state, &tracked->wanted, &barrier)) continue;
        if (use->image) {
            add_image_barrier(uses, &info.imageMemoryBarrierCount, image_barrier(use, &barrier));
        } else {
            add_buffer_barrier(uses, &info.bufferMemoryBarrierCount, use->buffer, &barrier);
        }
    }
    uses->count = 0;
    if (info.imageMemoryBarrierCount == 0 && info.bufferMemoryBarrierCount == 0) return;
    info.pImageMemoryBarriers = uses->images;
    info.pBufferMemoryBarriers = uses->buffers;
    g->vk.CmdPipelineBarrier2(commands, &info);
}
