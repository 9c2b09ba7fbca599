// Images and semaphores that another process or API opens by a file descriptor.
//
// Such an image has memory of its own (a dedicated allocation), as drivers want it, which is taken
// from the budget like any other.
#include "base/memory.h"
#include "gpu/vk.h"
#include <string.h>

static const VkExternalMemoryHandleTypeFlagBits BY_FD =
    VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;

typedef struct shared { // what gpu_shared.inside points to
    VkImage image;
    VkDeviceMemory memory;
    VkSemaphore semaphore;
    budget_part *part;
} shared;

static void shared_free(gpu *g, void *object) {
    shared *s = object;
    g->vk.DestroyImage(g->device, s->image, NULL);
    g->vk.FreeMemory(g->device, s->memory, NULL);
    g->vk.DestroySemaphore(g->device, s->semaphore, NULL);
    budget_give(s->part);
    mem_free(s);
}

static void name_device(gpu *g, gpu_shared *out) {
    VkPhysicalDeviceVulkan11Properties v11 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceProperties2 two = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                       .pNext = &v11};
    g->vk.GetPhysicalDeviceProperties2(g->physical, &two);
    memcpy(out->device, v11.deviceUUID, sizeof out->device);
    memcpy(out->driver, v11.driverUUID, sizeof out->driver);
}

// ---- images -----------------------------------------------------------------------------------

static VkImageUsageFlags usage(void) {
    return VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
           VK_IMAGE_USAGE_SAMPLED_BIT;
}

// Of which size, too: fewer texels may be allowed than of other images.
static bool can_export(gpu *g, int format, uint32_t width, uint32_t height) {
    VkPhysicalDeviceExternalImageFormatInfo by = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO, .handleType = BY_FD};
    VkPhysicalDeviceImageFormatInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2,
        .pNext = &by,
        .format = (VkFormat)format,
        .type = VK_IMAGE_TYPE_2D,
        .usage = usage()};
    VkExternalImageFormatProperties can = {.sType =
                                               VK_STRUCTURE_TYPE_EXTERNAL_IMAGE_FORMAT_PROPERTIES};
    VkImageFormatProperties2 p = {.sType = VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2,
                                  .pNext = &can};
    if (!g->vk.GetMemoryFdKHR)
        return err_set("the device '%s' cannot share images: it is made without %s", g->info.name,
                       VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
    VkResult result = g->vk.GetPhysicalDeviceImageFormatProperties2(g->physical, &info, &p);
    if (result != VK_SUCCESS || !(can.externalMemoryProperties.externalMemoryFeatures &
                                  VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT))
        return err_set("the device '%s' cannot share images of Vulkan format %d", g->info.name,
                       format);
    const VkExtent3D most = p.imageFormatProperties.maxExtent;
    return (width > 0 && height > 0 && width <= most.width && height <= most.height) ||
           err_set("a shared image of %u x %u; the device allows 1 x 1 to %u x %u", width, height,
                   most.width, most.height);
}

static bool create_image(gpu *g, shared *s, int format, uint32_t width, uint32_t height) {
    VkExternalMemoryImageCreateInfo by = {
        .sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO, .handleTypes = BY_FD};
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .pNext = &by,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = (VkFormat)format,
                              .extent = {width, height, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .usage = usage()};
    return vk_check(g, g->vk.CreateImage(g->device, &info, NULL, &s->image),
                    "creating a shared image");
}

static uint32_t find_type(const gpu *g, uint32_t allowed) {
    for (uint32_t i = 0; i < g->heaps.memoryTypeCount; i++)
        if ((allowed >> i & 1) &&
            (g->heaps.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
            return i;
    uint32_t first = 0;
    while (!(allowed >> first & 1)) first++;
    return first;
}

static bool allocate(gpu *g, shared *s, gpu_shared *out) {
    VkMemoryRequirements needs;
    g->vk.GetImageMemoryRequirements(g->device, s->image, &needs);
    VkMemoryDedicatedAllocateInfo own = {.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO,
                                         .image = s->image};
    VkExportMemoryAllocateInfo by = {.sType = VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO,
                                     .pNext = &own,
                                     .handleTypes = BY_FD};
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .pNext = &by,
                                 .allocationSize = needs.size,
                                 .memoryTypeIndex = find_type(g, needs.memoryTypeBits)};
    out->size = needs.size;
    out->type = info.memoryTypeIndex;
    s->part = budget_take(gpu_get_budget(g), needs.size, "shared images");
    return s->part &&
           vk_check(g, g->vk.AllocateMemory(g->device, &info, NULL, &s->memory),
                    "memory for a shared image") &&
           vk_check(g, g->vk.BindImageMemory(g->device, s->image, s->memory, 0),
                    "binding memory to a shared image");
}

static bool finish(gpu *g, shared *s, bool done, gpu_shared *out) {
    out->inside = s;
    if (done) return true;
    shared_free(g, s);
    *out = (gpu_shared){.fd = -1};
    return false;
}

bool gpu_share_image(gpu *g, int format, uint32_t width, uint32_t height, gpu_shared *out) {
    *out = (gpu_shared){.fd = -1};
    if (!vk_alive(g) || !can_export(g, format, width, height)) return false;
    shared *s = mem_alloc(sizeof *s);
    bool done = create_image(g, s, format, width, height) && allocate(g, s, out);
    VkMemoryGetFdInfoKHR by = {.sType = VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR,
                               .memory = s->memory,
                               .handleType = BY_FD};
    done = done && vk_check(g, g->vk.GetMemoryFdKHR(g->device, &by, &out->fd),
                            "sharing the memory of an image");
    out->image = VK_HANDLE(s->image);
    name_device(g, out);
    return finish(g, s, done, out);
}

// ---- semaphores -------------------------------------------------------------------------------

static bool can_export_semaphore(gpu *g) {
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkPhysicalDeviceExternalSemaphoreInfo info = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_SEMAPHORE_INFO,
        .pNext = &type,
        .handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
    VkExternalSemaphoreProperties can = {.sType = VK_STRUCTURE_TYPE_EXTERNAL_SEMAPHORE_PROPERTIES};
    if (!g->vk.GetSemaphoreFdKHR)
        return err_set("the device '%s' cannot share semaphores: it is made without %s",
                       g->info.name, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
    g->vk.GetPhysicalDeviceExternalSemaphoreProperties(g->physical, &info, &can);
    return (can.externalSemaphoreFeatures & VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT) ||
           err_set("the device '%s' cannot share timeline semaphores", g->info.name);
}

bool gpu_share_semaphore(gpu *g, gpu_shared *out) {
    *out = (gpu_shared){.fd = -1};
    if (!vk_alive(g) || !can_export_semaphore(g)) return false;
    shared *s = mem_alloc(sizeof *s);
    VkExportSemaphoreCreateInfo by = {.sType = VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO,
                                      .handleTypes =
                                          VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .pNext = &by,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    bool done = vk_check(g, g->vk.CreateSemaphore(g->device, &info, NULL, &s->semaphore),
                         "creating a shared semaphore");
    VkSemaphoreGetFdInfoKHR get = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR,
                                   .semaphore = s->semaphore,
                                   .handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
    done = done &&
           vk_check(g, g->vk.GetSemaphoreFdKHR(g->device, &get, &out->fd), "sharing a semaphore");
    out->semaphore = VK_HANDLE(s->semaphore);
    name_device(g, out);
    return finish(g, s, done, out);
}

void gpu_unshare(gpu *g, gpu_shared *from) {
    if (from->inside) vk_retire(g, shared_free, from->inside);
    *from = (gpu_shared){.fd = -1};
}
