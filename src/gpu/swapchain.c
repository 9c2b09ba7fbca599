// The window's surface and the images that are shown in it.
//
// The window changes while frames are under way, so nothing here is final: a swapchain that fits no
// more is replaced, and the old one dies with the frame in which it was found out. That frame's
// work is behind the last present in the one queue there is, so no present uses it any more. A lost
// surface is replaced when the old one has died, for a window bears only one at a time.
#include "base/memory.h"
#include "gpu/vk.h"

static void swapchain_free(gpu *g, void *object) {
    vk_swapchain *chain = object;
    for (uint32_t i = 0; i < chain->count; i++) {
        g->vk.DestroySemaphore(g->device, chain->drawn[i], NULL);
    }
    g->vk.DestroySwapchainKHR(g->device, chain->handle, NULL);
    mem_free(chain);
}

static void old_surface_free(gpu *g, void *object) {
    (void)object;
    g->vk.DestroySurfaceKHR(g->instance.handle, g->window.old_surface, NULL);
    g->window.old_surface = VK_NULL_HANDLE;
}

static bool surface_create(gpu *g) {
    const gpu_window *maker = &g->window.maker;
    return maker->create_surface(maker->user, g->instance.handle, &g->window.surface) ||
           err_prefix("the window gives no surface to draw to: ");
}

bool vk_window_open(gpu *g, const gpu_window *window) {
    if (!window) return true;
    g->window.maker = *window;
    return surface_create(g);
}

// What is shown is encoded already, so the format must be one that stores what it is given.
static bool choose_format(gpu *g, VkSurfaceFormatKHR *out) {
    VkSurfaceFormatKHR list[64];
    uint32_t count = COUNT_OF(list);
    VkResult result =
        g->vk.GetPhysicalDeviceSurfaceFormatsKHR(g->physical, g->window.surface, &count, list);
    if (result == VK_INCOMPLETE) result = VK_SUCCESS;
    if (!vk_check(g, result, "asking for the formats of the window")) return false;
    for (uint32_t i = 0; i < count; i++) {
        *out = list[i];
        if (list[i].colorSpace != VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) continue;
        if (list[i].format == VK_FORMAT_B8G8R8A8_UNORM) return true;
        if (list[i].format == VK_FORMAT_R8G8B8A8_UNORM) return true;
    }
    return err_set("the window takes no pictures of 8 bits a channel from '%s'", g->info.name);
}

static bool check_usage(gpu *g) {
    VkSurfaceCapabilitiesKHR caps;
    VkResult result =
        g->vk.GetPhysicalDeviceSurfaceCapabilitiesKHR(g->physical, g->window.surface, &caps);
    if (!vk_check(g, result, "asking what the window can do")) return false;
    if (caps.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) return true;
    return err_set("the window takes no copies of pictures from '%s'", g->info.name);
}

bool vk_window_prepare(gpu *g) {
    if (!g->window.surface) return true;
    if (!choose_format(g, &g->window.format) || !check_usage(g)) return false;
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (int i = 0; i < GPU_FRAMES_IN_FLIGHT; i++) {
        VkResult result = g->vk.CreateSemaphore(g->device, &info, NULL, &g->frames[i].acquired);
        if (!vk_check(g, result, "creating a semaphore")) return false;
    }
    return true;
}

static void retire_swapchain(gpu *g) {
    if (g->window.swapchain) vk_retire(g, swapchain_free, g->window.swapchain);
    g->window.swapchain = NULL;
}

void vk_window_close(gpu *g) {
    retire_swapchain(g);
}

static void retire_surface(gpu *g) {
    retire_swapchain(g);
    g->window.old_surface = g->window.surface;
    g->window.surface = VK_NULL_HANDLE;
    g->window.lost = false;
    vk_retire(g, old_surface_free, NULL);
}

bool vk_window_revive(gpu *g) {
    if (g->window.lost) retire_surface(g);
    return g->window.surface || g->window.old_surface || surface_create(g);
}

// ---- the swapchain ----------------------------------------------------------------------------

static VkCompositeAlphaFlagBitsKHR choose_alpha(const VkSurfaceCapabilitiesKHR *caps) {
    VkCompositeAlphaFlagsKHR has = caps->supportedCompositeAlpha;
    if (has & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) return VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    return (VkCompositeAlphaFlagBitsKHR)(has & ~(has - 1)); // the lowest bit
}

static VkResult get_images(gpu *g, vk_swapchain *chain) {
    uint32_t count = VK_MAX_SHOWN;
    VkResult result = g->vk.GetSwapchainImagesKHR(g->device, chain->handle, &count, chain->images);
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    while (result == VK_SUCCESS && chain->count < count) {
        result = g->vk.CreateSemaphore(g->device, &info, NULL, &chain->drawn[chain->count]);
        if (result == VK_SUCCESS) chain->count++;
    }
    return result;
}

static VkResult swapchain_create(gpu *g, const VkSurfaceCapabilitiesKHR *caps, VkExtent2D size) {
    uint32_t images = caps->minImageCount + 1;
    if (caps->maxImageCount > 0 && images > caps->maxImageCount) images = caps->maxImageCount;
    vk_swapchain *old = g->window.swapchain;
    VkSwapchainCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                     .surface = g->window.surface,
                                     .minImageCount = images,
                                     .imageFormat = g->window.format.format,
                                     .imageColorSpace = g->window.format.colorSpace,
                                     .imageExtent = size,
                                     .imageArrayLayers = 1,
                                     .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                     .preTransform = caps->currentTransform,
                                     .compositeAlpha = choose_alpha(caps),
                                     .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                     .clipped = !g->profile.keeps_shown,
                                     .oldSwapchain = old ? old->handle : VK_NULL_HANDLE};
    vk_swapchain *chain = mem_alloc(sizeof *chain);
    chain->size = size;
    VkResult result = g->vk.CreateSwapchainKHR(g->device, &info, NULL, &chain->handle);
    retire_swapchain(g); // the old one is of no more use, whatever the result
    if (result == VK_SUCCESS) result = get_images(g, chain);
    if (result == VK_SUCCESS) {
        g->window.swapchain = chain;
    } else {
        swapchain_free(g, chain);
    }
    return result;
}

static uint32_t clamp(uint32_t value, uint32_t least, uint32_t most) {
    return value < least ? least : value > most ? most : value;
}

VkResult vk_swapchain_fit(gpu *g, VkExtent2D size) {
    VkSurfaceCapabilitiesKHR caps;
    VkResult result =
        g->vk.GetPhysicalDeviceSurfaceCapabilitiesKHR(g->physical, g->window.surface, &caps);
    if (result != VK_SUCCESS) return result;
    if (caps.currentExtent.width != UINT32_MAX) {
        size = caps.currentExtent;
    } else {
        size.width = clamp(size.width, caps.minImageExtent.width, caps.maxImageExtent.width);
        size.height = clamp(size.height, caps.minImageExtent.height, caps.maxImageExtent.height);
    }
    if (size.width == 0 || size.height == 0) return VK_NOT_READY;
    const vk_swapchain *chain = g->window.swapchain;
    if (chain && !chain->stale && chain->size.width == size.width &&
        chain->size.height == size.height) {
        return VK_SUCCESS;
    }
    return swapchain_create(g, &caps, size);
}
