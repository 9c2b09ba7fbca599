// Finding the Vulkan calls by name.
#include "gpu/calls.h"
#include "base/error.h"
#include <stddef.h>

// The loader's. All other calls are found through it.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name);

static bool is_there(PFN_vkVoidFunction found, const char *name) {
    return found || err_set("Vulkan has no call %s; roil needs Vulkan 1.3", name);
}

bool vk_calls_find_global(vk_calls *vk, PFN_vkGetInstanceProcAddr get) {
    PFN_vkVoidFunction found;
    vk->GetInstanceProcAddr = get ? get : vkGetInstanceProcAddr;
#define FIND(name)                                                                                 \
    found = vk->GetInstanceProcAddr(NULL, "vk" #name);                                             \
    if (!is_there(found, "vk" #name)) return false;                                                \
    vk->name = (PFN_vk##name)found;
    VK_CALLS_GLOBAL(FIND)
#undef FIND
    return true;
}

bool vk_calls_find_instance(vk_calls *vk, VkInstance instance) {
    PFN_vkVoidFunction found;
#define FIND(name)                                                                                 \
    found = vk->GetInstanceProcAddr(instance, "vk" #name);                                         \
    if (!is_there(found, "vk" #name)) return false;                                                \
    vk->name = (PFN_vk##name)found;
    VK_CALLS_INSTANCE(FIND)
#undef FIND
#define FIND(name) vk->name = (PFN_vk##name)vk->GetInstanceProcAddr(instance, "vk" #name);
    VK_CALLS_INSTANCE_OPTIONAL(FIND)
#undef FIND
    return true;
}

bool vk_calls_find_device(vk_calls *vk, VkDevice device) {
    PFN_vkVoidFunction found;
#define FIND(name)                                                                                 \
    found = vk->GetDeviceProcAddr(device, "vk" #name);                                             \
    if (!is_there(found, "vk" #name)) return false;                                                \
    vk->name = (PFN_vk##name)found;
    VK_CALLS_DEVICE(FIND)
#undef FIND
#define FIND(name) vk->name = (PFN_vk##name)vk->GetDeviceProcAddr(device, "vk" #name);
    VK_CALLS_DEVICE_OPTIONAL(FIND)
#undef FIND
    return true;
}
