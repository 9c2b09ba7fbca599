// Showing an image in the window: it is copied, scaled, to one that the window lends.
//
// Two semaphores tie a frame to the display. `acquired` belongs to the frame's slot: the frame's
// transfers wait for it, so it is free when the slot is used again. `drawn` belongs to the window's
// image: the display waits for it, and has done so when it lends the same image again.
//
// Where the profile says so (keeps_shown), an image that is lent again still holds what was shown
// in it, and only what has changed since is copied.
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

static bool is_as_large(const gpu_image_desc *d, VkExtent2D size) {
    return d->width == size.width && d->height == size.height;
}

// Texel by texel where the sizes are equal.
static VkFilter filter_for(const gpu *g, const gpu_image_desc *d, VkExtent2D size) {
    bool smooth = g->format_features[d->format] & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    return smooth && !is_as_large(d, size) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
}

static VkImageBlit whole_blit(const gpu_image_desc *d, VkExtent2D size) {
    return (VkImageBlit){.srcOffsets = {{0}, {(int32_t)d->width, (int32_t)d->height, 1}},
                         .dstOffsets = {{0}, {(int32_t)size.width, (int32_t)size.height, 1}}};
}

static VkImageBlit blit_of(gpu_area a) {
    VkOffset3D from = {(int32_t)a.x, (int32_t)a.y, 0};
    VkOffset3D to = {(int32_t)(a.x + a.width), (int32_t)(a.y + a.height), 1};
    return (VkImageBlit){.srcOffsets = {from, to}, .dstOffsets = {from, to}};
}

// Returns how many blits it takes to fill an image of the window.
static uint32_t list_blits(const gpu *g, const gpu_image_desc *d, VkImageBlit out[GPU_MAX_AREAS]) {
    const vk_swapchain *chain = g->window.swapchain;
    const vk_areas *missing = &chain->missing[g->window.image];
    uint32_t count = missing->count;
    out[0] = whole_blit(d, chain->size);
    bool whole = !chain->kept[g->window.image] || !is_as_large(d, chain->size);
    if (whole) count = 1;
    for (uint32_t i = 0; i < count && !whole; i++) out[i] = blit_of(missing->list[i]);
    for (uint32_t i = 0; i < count; i++)
        out[i].srcSubresource = out[i].dstSubresource =
            (VkImageSubresourceLayers){.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1};
    return count;
}

static void copy_scaled(gpu *g, VkCommandBuffer commands, gpu_image *image) {
    vk_swapchain *chain = g->window.swapchain;
    VkImage target = chain->images[g->window.image];
    bool *kept = &chain->kept[g->window.image];
    VkImageBlit blits[GPU_MAX_AREAS];
    uint32_t count = list_blits(g, &image->desc, blits);
    if (!count) return;
    vk_uses_begin(g);
    vk_use_image(g, image, 0, 1, vk_image_from);
    vk_uses_flush(g, commands);
    relayout(g, commands, target,
             *kept ? VK_IMAGE_LAYOUT_PRESENT_SRC_KHR : VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, false);
    g->vk.CmdBlitImage(commands, image->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, count, blits,
                       filter_for(g, &image->desc, chain->size));
    relayout(g, commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
             VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, true);
    chain->missing[g->window.image].count = 0;
    *kept = g->profile.keeps_shown;
}

// ---- what has changed -------------------------------------------------------------------------

static gpu_area joined(gpu_area a, gpu_area b) {
    uint32_t right = a.x + a.width > b.x + b.width ? a.x + a.width : b.x + b.width;
    uint32_t bottom = a.y + a.height > b.y + b.height ? a.y + a.height : b.y + b.height;
    uint32_t x = a.x < b.x ? a.x : b.x, y = a.y < b.y ? a.y : b.y;
    return (gpu_area){x, y, right - x, bottom - y};
}

static uint64_t size_of(gpu_area a) {
    return (uint64_t)a.width * a.height;
}

// Where there are too many, it is joined to the one that grows least.
static void add_area(vk_areas *to, gpu_area a) {
    uint32_t best = 0;
    uint64_t least = UINT64_MAX;
    for (uint32_t i = 0; i < to->count; i++) {
        uint64_t more = size_of(joined(to->list[i], a)) - size_of(to->list[i]);
        if (more >= least) continue;
        least = more;
        best = i;
    }
    if (least > 0 && to->count < GPU_MAX_AREAS)
        to->list[to->count++] = a;
    else
        to->list[best] = joined(to->list[best], a);
}

// An image of another size than the window's is shown scaled, and always as a whole.
static void note_changed(gpu *g, const gpu_image *image, const gpu_area *changed, size_t count) {
    vk_swapchain *chain = g->window.swapchain;
    if (!chain) return;
    const gpu_area whole = {0, 0, chain->size.width, chain->size.height};
    bool known = changed && is_as_large(&image->desc, chain->size);
    for (uint32_t i = 0; i < chain->count; i++) {
        vk_areas *missing = &chain->missing[i];
        if (!known) *missing = (vk_areas){{whole}, 1};
        for (size_t k = 0; known && k < count; k++) add_area(missing, changed[k]);
    }
}

static bool check_changed(const gpu_image *image, const gpu_area *changed, size_t count) {
    const gpu_image_desc *d = &image->desc;
    for (size_t i = 0; changed && i < count; i++) {
        const gpu_area *a = &changed[i];
        if (!a->width || !a->height || a->x > d->width || a->width > d->width - a->x ||
            a->y > d->height || a->height > d->height - a->y)
            return err_set("image '%s' cannot be shown: what has changed lies outside of it",
                           d->label);
    }
    return true;
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

bool gpu_present(gpu *g, gpu_image *image, const gpu_area *changed, size_t count) {
    if (!present_check(g, image) || !check_changed(image, changed, count) || !vk_window_revive(g))
        return false;
    note_changed(g, image, changed, count); // also where the frame is passed over
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
