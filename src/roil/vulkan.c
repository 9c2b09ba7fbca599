// A host's Vulkan device, images and semaphores, handed to the layer gpu as numbers and pointers.
#include "base/error.h"
#include "base/memory.h"
#include "roil/roil_impl.h"
#include "roil_vulkan.h"

static gpu_host host_of(const roil_vulkan *v) {
    return (gpu_host){.get_proc = (void (*(*)(void *, const char *))(void))v->get,
                      .instance = v->instance,
                      .physical = v->physical,
                      .device = v->device,
                      .family = v->family,
                      .index = v->index,
                      .features = v->features,
                      .extensions = v->extensions,
                      .extension_count = v->extension_count,
                      .labels = v->labels,
                      .lock = v->lock,
                      .unlock = v->unlock,
                      .user = v->user};
}

bool roil_vulkan_find_needs(PFN_vkGetInstanceProcAddr get, VkInstance instance,
                            VkPhysicalDevice physical, roil_vulkan_needs *out) {
    const gpu_host host =
        host_of(&(roil_vulkan){.get = get, .instance = instance, .physical = physical});
    gpu_host_needs needs;
    *out = (roil_vulkan_needs){0};
    if (!gpu_host_find_needs(&host, &out->features, &out->v11, &out->v12, &out->v13, &needs))
        return false;
    out->extension_count = needs.extension_count;
    for (uint32_t i = 0; i < needs.extension_count; i++) out->extensions[i] = needs.extensions[i];
    return true;
}

gpu *roil_open_host(const gpu_desc *how, const roil_vulkan *vulkan) {
    const gpu_host host = host_of(vulkan);
    gpu_desc with = *how;
    with.host = &host;
    return gpu_create(&with);
}
