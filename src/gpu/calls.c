// Finding the Vulkan calls by name.
#include "gpu/calls.h"
#include "base/error.h"
#include <stddef.h>

// The loader's. All other calls are found through it.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name);

// Missing ones stay NULL.
#define FIND(get, object, name) vk->name = (PFN_vk##name)vk->get(object, "vk" #name)
#define REQUIRE(get, object, name)                                                                 \
    FIND(get, object, name);                                                                       \
    if (!vk->name) return err_set("Vulkan has no call vk" #name "; roil needs Vulkan 1.3");

bool vk_calls_find_global(vk_calls *vk, PFN_vkGetInstanceProcAddr get) {
    vk->GetInstanceProcAddr = get ? get : vkGetInstanceProcAddr;
#define CALL(name) REQUIRE(GetInstanceProcAddr, NULL, name)
    VK_CALLS_GLOBAL(CALL)
#undef CALL
    return true;
}

bool vk_calls_find_instance(vk_calls *vk, VkInstance instance) {
#define CALL(name) REQUIRE(GetInstanceProcAddr, instance, name)
#define OPTIONAL(name) FIND(GetInstanceProcAddr, instance, name);
    VK_CALLS_INSTANCE(CALL)
    VK_CALLS_INSTANCE_OPTIONAL(OPTIONAL)
#undef CALL
#undef OPTIONAL
    return true;
}

bool vk_calls_find_device(vk_calls *vk, VkDevice device) {
#define CALL(name) REQUIRE(GetDeviceProcAddr, device, name)
#define OPTIONAL(name) FIND(GetDeviceProcAddr, device, name);
    VK_CALLS_DEVICE(CALL)
    VK_CALLS_DEVICE_OPTIONAL(OPTIONAL)
    return true;
}
