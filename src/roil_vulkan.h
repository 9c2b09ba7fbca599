// roil on a host's Vulkan device: the device is the host's own, and pictures go into its images.
// This is the only header of roil that includes Vulkan's; include it beside roil.h. The rules of
// roil.h on errors, threads and memory hold here too.
//
//   roil_vulkan_needs needs;
//   roil_vulkan_find_needs(vkGetInstanceProcAddr, instance, physical, &needs);
//   ... vkCreateDevice with needs.features and needs.extensions among the host's own ...
//   roil_vulkan vulkan = {.instance = instance, .physical = physical, .device = device,
//                         .extensions = needs.extensions, .extension_count =
//                         needs.extension_count};
//   roil *r = roil_create(&(roil_desc){.vulkan = &vulkan});
//
// roil destroys nothing that it was given, and waits for its own work alone: never for the device
// or a queue as a whole. The device must outlive the roil. Validation and messages of Vulkan are
// those of the host's instance.
#pragma once
#include "roil.h"
#include <vulkan/vulkan.h>
#ifdef __cplusplus
extern "C" {
#endif

// ---- device -----------------------------------------------------------------------------------

enum { ROIL_VULKAN_EXTENSIONS = 4 };
typedef struct roil_vulkan_needs {
    VkPhysicalDeviceFeatures2 features; // what roil needs, and what it takes where it is there;
                                        // chained to the three structs below: do not copy
    VkPhysicalDeviceVulkan11Features v11;
    VkPhysicalDeviceVulkan12Features v12;
    VkPhysicalDeviceVulkan13Features v13;
    const char *extensions[ROIL_VULKAN_EXTENSIONS]; // of the device, those that it has; static
    uint32_t extension_count;
} roil_vulkan_needs;
// Tells what a device should be made with: Vulkan 1.3 (the instance asks for it, too), these
// extensions and features, and a queue that draws and computes. A host may enable more. What it may
// leave out: robustBufferAccess and robustImageAccess, without which shaders of effects of
// strangers can read and write beyond what is theirs; shaderInt64, drawIndirectFirstInstance,
// multiDrawIndirect and the extensions, without which some work takes longer. `get` is the host's
// vkGetInstanceProcAddr; NULL: that of the loader that roil is linked to. False with a message: the
// device cannot run roil. Any thread.
bool roil_vulkan_find_needs(PFN_vkGetInstanceProcAddr get, VkInstance instance,
                            VkPhysicalDevice physical, roil_vulkan_needs *out);

struct roil_vulkan {               // for roil_desc.vulkan; only read by roil_create
    PFN_vkGetInstanceProcAddr get; // as above; all calls are found through it
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    uint32_t family, index; // of the queue that roil submits to: it draws and computes
    // What the device was made with. `features` is a chain as vkCreateDevice takes it; NULL: that
    // of roil_vulkan_find_needs.
    const VkPhysicalDeviceFeatures2 *features;
    const char *const *extensions;
    uint32_t extension_count;
    bool labels; // VK_EXT_debug_utils is enabled in the instance: objects and passes get names
    // Called around each submission to the queue, on the thread that calls roil. NULL, both: no
    // other thread submits to it meanwhile.
    void (*lock)(void *user, uint32_t family, uint32_t index);
    void (*unlock)(void *user, uint32_t family, uint32_t index);
    void *user; // passed to both
};

#ifdef __cplusplus
}
#endif
