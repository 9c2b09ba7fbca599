// A device that belongs to the program which embeds roil: taken as it is, never destroyed.
//
// roil submits to one queue of it, under the host's lock, and never waits for the device as a
// whole: other queues are at work for others. The host's images are handed over in a layout and
// given back in one, in the frame that uses them, and semaphores of the host order that frame among
// its own work, as libplacebo's pl_vulkan_hold and pl_vulkan_release do it.
#include "base/log.h"
#include "base/memory.h"
#include "base/words.h"
#include "gpu/vk.h"
#include <assert.h>
#include <string.h>

uint32_t vk_host_extensions(const vk_calls *vk, VkPhysicalDevice physical, bool pushes,
                            const char *out[GPU_MAX_NEEDS]) {
    static const char *const shares[] = {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME,
                                         VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME};
    uint32_t count = 0;
    if (pushes) out[count++] = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    for (size_t i = 0; i < COUNT_OF(shares); i++)
        if (vk_has_extension(vk, physical, shares[i])) out[count++] = shares[i];
    return count;
}

// ---- taking it over ---------------------------------------------------------------------------

static bool find_calls(const gpu_host *host, vk_calls *vk) {
    if (!host->instance || !host->physical)
        return err_set("the host's Vulkan device: `instance` and `physical` are needed");
    if (host->get_proc) {
        vk->GetInstanceProcAddr = (PFN_vkGetInstanceProcAddr)host->get_proc;
    } else if (!vk_calls_find_global(vk, NULL)) {
        return false;
    }
    return vk_calls_find_instance(vk, host->instance);
}

static bool has_name(const gpu_host *host, const char *name) {
    return words_find(host->extensions, host->extension_count, name) >= 0;
}

static bool is_usable(const vk_choice *choice) {
    return choice->info.usable || err_set("the host's device '%s' cannot run roil: it lacks %s",
                                          choice->info.name, choice->info.missing);
}

static bool has_queue(const vk_calls *vk, const gpu_host *host) {
    VkQueueFamilyProperties list[16];
    uint32_t count = COUNT_OF(list);
    vk->GetPhysicalDeviceQueueFamilyProperties(host->physical, &count, list);
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if (host->family >= count || host->index >= list[host->family].queueCount)
        return err_set("the host's Vulkan device has no queue %u of family %u", host->index,
                       host->family);
    return (list[host->family].queueFlags & wanted) == wanted ||
           err_set("the host's queue family %u cannot both draw and compute", host->family);
}

bool vk_host_open(gpu *g, const gpu_host *host, vk_choice *out) {
    if (!host->device) return err_set("the host's Vulkan device: `device` is needed");
    if (!host->lock != !host->unlock)
        return err_set("the host's Vulkan device: `lock` and `unlock` go together");
    if (!find_calls(host, &g->vk) || !has_queue(&g->vk, host)) return false;
    vk_features there, enabled;
    vk_features_read(&g->vk, host->physical, &there);
    if (host->features)
        vk_features_of_host(host->features, &enabled);
    else
        vk_features_choose(&there, &enabled);
    vk_choice_describe(&g->vk, host->physical, VK_NULL_HANDLE, &enabled,
                       has_name(host, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME) &&
                           vk_can_push(&g->vk, host->physical),
                       out);
    if (!is_usable(out)) return false;
    if (there.core.features.robustBufferAccess && !enabled.core.features.robustBufferAccess)
        log_write(LOG_WARNING, "the host's device is made without robustBufferAccess: shaders of "
                               "effects may read and write beyond their buffers");
    g->host = *host;
    g->host.extensions = NULL; // the host's to free
    g->host.features = NULL;
    g->instance.labels = host->labels;
    g->draws_many = enabled.core.features.multiDrawIndirect;
    return true;
}

void vk_host_forget_calls(gpu *g, const gpu_host *host) {
    if (!has_name(host, VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME)) g->vk.GetMemoryFdKHR = NULL;
    if (!has_name(host, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME))
        g->vk.GetSemaphoreFdKHR = NULL;
}

bool gpu_host_find_needs(const gpu_host *host, void *core, void *v11, void *v12, void *v13,
                         gpu_host_needs *out) {
    vk_calls vk = {0};
    vk_features there, want;
    vk_choice choice;
    *out = (gpu_host_needs){0};
    if (!find_calls(host, &vk)) return false;
    vk_features_read(&vk, host->physical, &there);
    vk_features_choose(&there, &want);
    const bool pushes = vk_can_push(&vk, host->physical);
    vk_choice_describe(&vk, host->physical, VK_NULL_HANDLE, &there, pushes, &choice);
    if (!is_usable(&choice)) return false;
    out->extension_count = vk_host_extensions(&vk, host->physical, pushes, out->extensions);
    *(VkPhysicalDeviceFeatures2 *)core = want.core;
    *(VkPhysicalDeviceVulkan11Features *)v11 = want.v11;
    *(VkPhysicalDeviceVulkan12Features *)v12 = want.v12;
    *(VkPhysicalDeviceVulkan13Features *)v13 = want.v13;
    ((VkPhysicalDeviceFeatures2 *)core)->pNext = v11;
    ((VkPhysicalDeviceVulkan11Features *)v11)->pNext = v12;
    ((VkPhysicalDeviceVulkan12Features *)v12)->pNext = v13;
    return true;
}

VkResult vk_host_submit(gpu *g, const VkSubmitInfo2 *info) {
    const gpu_host *host = &g->host;
    if (host->lock) host->lock(host->user, host->family, host->index);
    VkResult result = g->vk.QueueSubmit2(g->queue, 1, info, VK_NULL_HANDLE);
    if (host->unlock) host->unlock(host->user, host->family, host->index);
    return result;
}

// ---- semaphores -------------------------------------------------------------------------------

bool gpu_frame_sync(gpu *g, const gpu_semaphore *waits, size_t wait_count,
                    const gpu_semaphore *signals, size_t signal_count) {
    vk_syncs *s = &g->syncs;
    if (!g->frame) return err_set("no frame is open for semaphores of a host");
    if (wait_count > GPU_MAX_SYNC - s->wait_count || signal_count > GPU_MAX_SYNC - s->signal_count)
        return err_set("%zu semaphores to wait for and %zu to signal; %d of each are accepted",
                       wait_count, signal_count, GPU_MAX_SYNC);
    for (size_t i = 0; i < wait_count; i++) s->waits[s->wait_count++] = waits[i];
    for (size_t i = 0; i < signal_count; i++) s->signals[s->signal_count++] = signals[i];
    g->frame->batch.syncs = true;
    return true;
}

static VkSemaphoreSubmitInfo submit_info(gpu_semaphore semaphore) {
    return (VkSemaphoreSubmitInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                   .semaphore = (VkSemaphore)(uintptr_t)semaphore.handle,
                                   .value = semaphore.value,
                                   .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
}

void vk_host_add_syncs(gpu *g, VkSemaphoreSubmitInfo *waits, uint32_t *wait_count,
                       VkSemaphoreSubmitInfo *signals, uint32_t *signal_count) {
    vk_syncs *s = &g->syncs;
    for (uint32_t i = 0; i < s->wait_count; i++) waits[(*wait_count)++] = submit_info(s->waits[i]);
    for (uint32_t i = 0; i < s->signal_count; i++)
        signals[(*signal_count)++] = submit_info(s->signals[i]);
    *s = (vk_syncs){0};
}

// ---- images -----------------------------------------------------------------------------------

static bool is_of_depth_alone(int layout) {
    return layout == VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL ||
           layout == VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
}

// What of the image changes its layout. A stencil does so too, unless it has a layout of its own.
static VkImageAspectFlags aspect_of(const gpu_host_image *image) {
    switch (image->format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        if (is_of_depth_alone(image->before) || is_of_depth_alone(image->after))
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

static void record(gpu *g, const gpu_host_image *image, VkImageLayout from, VkImageLayout to,
                   bool ours, bool leaves) {
    const VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    const VkAccessFlags2 any = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = ours ? VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT : all,
        .srcAccessMask = ours ? VK_ACCESS_2_TRANSFER_WRITE_BIT : VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = all,
        .dstAccessMask = any,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = leaves ? g->family : VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = leaves ? VK_QUEUE_FAMILY_EXTERNAL : VK_QUEUE_FAMILY_IGNORED,
        .image = (VkImage)(uintptr_t)image->image,
        .subresourceRange = {.aspectMask = aspect_of(image), .levelCount = 1, .layerCount = 1}};
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                             .imageMemoryBarrierCount = 1,
                             .pImageMemoryBarriers = &barrier};
    g->vk.CmdPipelineBarrier2(g->frame->batch.commands, &info);
}

static bool create_view(gpu *g, gpu_image *image, int format) {
    VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = image->handle,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = (VkFormat)format,
                                  .subresourceRange = {.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT,
                                                       .levelCount = 1,
                                                       .layerCount = 1}};
    return vk_check(g, g->vk.CreateImageView(g->device, &info, NULL, &image->all),
                    "creating a view of the host's %s", image->desc.label);
}

gpu_image *gpu_image_borrow(gpu *g, const gpu_host_image *from) {
    if (!(aspect_of(from) & VK_IMAGE_ASPECT_DEPTH_BIT))
        return ERR_NULL("the host's %s: Vulkan format %d is no format of depths", from->label,
                        from->format);
    if (from->before == VK_IMAGE_LAYOUT_UNDEFINED)
        return ERR_NULL("the host's %s: in layout UNDEFINED it has no content", from->label);
    gpu_image *image = mem_alloc(sizeof *image);
    image->desc = (gpu_image_desc){.label = mem_copy(from->label, strlen(from->label) + 1),
                                   .format = GPU_D32F,
                                   .width = from->width,
                                   .height = from->height,
                                   .mips = 1,
                                   .use = GPU_USE_SAMPLED};
    image->handle = (VkImage)(uintptr_t)from->image;
    image->aspect = aspect_of(from);
    image->borrowed = true;
    // Whatever the host did with it: the first use waits for all that was submitted before.
    image->tracked[0].state = (hazard_state){.write_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                             .write_access = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                             .layout = (VkImageLayout)from->before};
    if (create_view(g, image, from->format)) return image;
    gpu_image_destroy(g, image);
    return NULL;
}

void gpu_image_give_back(gpu *g, gpu_image *borrowed, const gpu_host_image *to) {
    assert(g->frame && borrowed->borrowed);
    record(g, to, borrowed->tracked[0].state.layout, (VkImageLayout)to->after, false, false);
    gpu_image_destroy(g, borrowed);
}

// Nothing converts colours to depths or whole numbers. The latter are never filtered or blended.
static bool can_blit(gpu *g, const gpu_image_desc *from, const gpu_host_image *to) {
    const VkFormatFeatureFlags fractions = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                           VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    VkFormatProperties p;
    g->vk.GetPhysicalDeviceFormatProperties(g->physical, (VkFormat)to->format, &p);
    return ((p.optimalTilingFeatures & VK_FORMAT_FEATURE_BLIT_DST_BIT) &&
            (p.optimalTilingFeatures & fractions) && aspect_of(to) == VK_IMAGE_ASPECT_COLOR_BIT &&
            (g->format_features[from->format] & VK_FORMAT_FEATURE_BLIT_SRC_BIT)) ||
           err_set("the host's %s: the device cannot convert %s to Vulkan format %d", to->label,
                   gpu_format_name(from->format), to->format);
}

static void copy(gpu *g, gpu_image *from, const gpu_host_image *to) {
    VkImageSubresourceLayers layers = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1};
    VkImageCopy region = {.srcSubresource = layers,
                          .dstSubresource = layers,
                          .extent = {from->desc.width, from->desc.height, 1}};
    g->vk.CmdCopyImage(g->frame->batch.commands, from->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       (VkImage)(uintptr_t)to->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                       &region);
}

static void blit(gpu *g, gpu_image *from, const gpu_host_image *to, bool scaled) {
    const gpu_image_desc *d = &from->desc;
    VkImageSubresourceLayers layers = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1};
    VkImageBlit region = {.srcSubresource = layers,
                          .srcOffsets = {{0}, {(int32_t)d->width, (int32_t)d->height, 1}},
                          .dstSubresource = layers,
                          .dstOffsets = {{0}, {(int32_t)to->width, (int32_t)to->height, 1}}};
    const bool smooth =
        g->format_features[d->format] & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    g->vk.CmdBlitImage(g->frame->batch.commands, from->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       (VkImage)(uintptr_t)to->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                       &region, scaled && smooth ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
}

bool gpu_image_hand_out(gpu *g, gpu_image *from, const gpu_host_image *to) {
    assert(g->frame);
    bool scaled = from && (from->desc.width != to->width || from->desc.height != to->height);
    bool same = from && !scaled && (int)vk_format_get(from->desc.format)->format == to->format;
    bool can = !from || same || can_blit(g, &from->desc, to);
    VkImageLayout layout = (VkImageLayout)to->before;
    if (from && can) {
        vk_uses_begin(g);
        vk_use_image(g, from, 0, 1, vk_image_from);
        vk_uses_flush(g, g->frame->batch.commands);
        // What it held before does not count: every texel is written.
        record(g, to, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, false,
               false);
        layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        if (same)
            copy(g, from, to);
        else
            blit(g, from, to, scaled);
    }
    if (to->external && layout != VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL) {
        // Whoever acquires it has to name the layouts that it is released between: always these.
        record(g, to, layout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, false, false);
        layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    }
    record(g, to, layout, (VkImageLayout)to->after, from && can, to->external);
    return can;
}
