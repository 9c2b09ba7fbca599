// Showing an image in the window: it is copied, scaled, to one that the window lends.
//
// Two semaphores tie a frame to the display. `acquired` belongs to the frame's slot: the frame's
// transfers wait for it, so it is free when the slot is used again. `drawn` belongs to the window's
// image: the display waits for it, and has done so when it lends the same image again.
#include "gpu/vk.h"

// A window that lies hidden may lend no image for ever. The frame is then passed over.
static const uint64_t longest_turn = 1000000000; // nanoseconds

static VkResult acquire(gpu *g) {
    vk_swapchain *chain = g->window.swapchain;
    VkResult result =
        g->vk.AcquireNextImageKHR(g->device, chain->handle, longest_turn, g->frame->acquired,
                                  VK_NULL_HANDLE, &g->window.image);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) chain->stale = true;
    if (result == VK_TIMEOUT) return VK_NOT_READY;
    return result == VK_SUBOPTIMAL_KHR ? VK_SUCCESS : result;
}

// VK_NOT_READY: there is none for this frame.
static VkResult obtain(gpu *g, VkExtent2D size) {
    for (int i = 0; i < 3; i++) { // a window that is being resized may outrun us
        VkResult result = vk_swapchain_fit(g, size);
        if (result == VK_SUCCESS) result = acquire(g);
        if (result != VK_ERROR_OUT_OF_DATE_KHR) return result;
    }
    return VK_NOT_READY;
}

static void relayout(const gpu *g, VkCommandBuffer commands, VkImage image, VkImageLayout from,
                     VkImageLayout to, bool filled) {
    VkPipelineStageFlags2 transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    VkAccessFlags2 write = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = transfer, // the stage that waits for `acquired`
        .srcAccessMask = filled ? write : 0,
        .dstStageMask = filled ? VK_PIPELINE_STAGE_2_NONE : transfer,
        .dstAccessMask = filled ? 0 : write,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {
            .aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .levelCount = 1, .layerCount = 1}};
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                             .imageMemoryBarrierCount = 1,
                             .pImageMemoryBarriers = &barrier};
    g->vk.CmdPipelineBarrier2(commands, &info);
}

// Texel by texel where the sizes are equal.
static VkFilter filter_for(const gpu *g, const gpu_image_desc *d, VkExtent2D size) {
    bool equal = d->width == size.width && d->height == size.height;
    bool smooth = g->format_features[d->format] & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    return smooth && !equal ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
}

static void copy_scaled(gpu *g, VkCommandBuffer commands, gpu_image *image) {
    const vk_swapchain *chain = g->window.swapchain;
    const gpu_image_desc *d = &image->desc;
    VkImage target = chain->images[g->window.image];
    VkImageSubresourceLayers layers = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1};
    VkImageBlit region = {
        .srcSubresource = layers,
        .srcOffsets = {{0}, {(int32_t)d->width, (int32_t)d->height, 1}},
        .dstSubresource = layers,
        .dstOffsets = {{0}, {(int32_t)chain->size.width, (int32_t)chain->size.height, 1}}};
    vk_uses_begin(g);
    vk_use_image(g, image, 0, 1, vk_image_from);
    vk_uses_flush(g, commands);
    relayout(g, commands, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
             false);
    g->vk.CmdBlitImage(commands, image->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                       filter_for(g, d, chain->size));
    relayout(g, commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
             VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, true);
}

static bool present_check(gpu *g, const gpu_image *image) {
    if (!vk_alive(g)) return false;
    const gpu_image_desc *d = &image->desc;
    if (!g->window.maker.create_surface) {
        return err_set("image '%s' cannot be shown: the device was created without a window",
                       d->label);
    }
    if (!g->frame) return err_set("image '%s' cannot be shown: no frame is open", d->label);
    if (g->window.shows) {
        return err_set("image '%s' cannot be shown: the frame shows another one", d->label);
    }
    bool plain = d->format != GPU_D32F && d->format != GPU_R32U && d->format != GPU_RGBA8_SRGB;
    bool can = g->format_features[d->format] & VK_FORMAT_FEATURE_BLIT_SRC_BIT;
    if (d->depth > 0 || !plain || !can) {
        return err_set("image '%s' (%s%s) cannot be shown; a 2D image of colours is accepted, such "
                       "as rgba8 or rgba16f",
                       d->label, d->depth ? "3D " : "", gpu_format_name(d->format));
    }
    return true;
}

bool gpu_present(gpu *g, gpu_image *image) {
    if (!present_check(g, image) || !vk_window_revive(g)) return false;
    if (!g->window.surface) return true;
    VkResult result = obtain(g, (VkExtent2D){image->desc.width, image->desc.height});
    if (result == VK_NOT_READY) return true;
    if (result == VK_ERROR_SURFACE_LOST_KHR) {
        g->window.lost = true;
        return true;
    }
    if (!vk_check(g, result, "showing image '%s'", image->desc.label)) return false;
    vk_batch *batch = &g->frame->batch;
    copy_scaled(g, batch->commands, image);
    batch->wait = g->frame->acquired;
    batch->signal = g->window.swapchain->drawn[g->window.image];
    g->window.shows = true;
    return true;
}

bool vk_present(gpu *g) {
    if (!g->window.shows) return true;
    g->window.shows = false;
    if (!vk_wait_where_driver_would(g)) return false;
    vk_swapchain *chain = g->window.swapchain;
    VkPresentInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                             .waitSemaphoreCount = 1,
                             .pWaitSemaphores = &chain->drawn[g->window.image],
                             .swapchainCount = 1,
                             .pSwapchains = &chain->handle,
                             .pImageIndices = &g->window.image};
    VkResult result = g->vk.QueuePresentKHR(g->queue, &info);
    switch (result) {
    case VK_SUCCESS:
        chain->fitted = true;
        return true;
    case VK_SUBOPTIMAL_KHR: // some drivers say so from the first image on: a new one would not help
        chain->stale = chain->fitted;
        return true;
    case VK_ERROR_OUT_OF_DATE_KHR:
        chain->stale = true;
        return true;
    case VK_ERROR_SURFACE_LOST_KHR:
        g->window.lost = true;
        return true;
    case VK_ERROR_DEVICE_LOST:
        return vk_lose(g, result);
    default:
        return vk_check(g, result, "showing a picture in the window");
    }
}
