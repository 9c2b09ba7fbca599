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

// ---- frames -----------------------------------------------------------------------------------

typedef struct roil_vulkan_image { // of the host: two-dimensional, of one level and one layer
    VkImage image;                 // VK_NULL_HANDLE: none
    VkFormat format;
    uint32_t width, height;
    // The layouts in which roil finds the image and in which it leaves it. Its content need not be
    // kept where an image is written: `before` may be VK_IMAGE_LAYOUT_UNDEFINED there.
    VkImageLayout before, after;
    // It goes to another process or API (VK_QUEUE_FAMILY_EXTERNAL) with each frame, between the
    // layouts VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL and `after`; only for images that are written.
    bool external;
} roil_vulkan_image;

typedef struct roil_vulkan_semaphore {
    VkSemaphore semaphore;
    uint64_t value; // of a timeline; of a binary semaphore it is ignored
} roil_vulkan_semaphore;

enum { ROIL_VULKAN_SEMAPHORES = 8 };
typedef struct roil_vulkan_frame {
    // Depths of the host's scene, as roil_view.projection makes them, of any format of depths, with
    // VK_IMAGE_USAGE_SAMPLED_BIT. Its size may be another than that of the layer.
    roil_vulkan_image depth;
    // Where the images of the layer go, by roil_layer_image, with VK_IMAGE_USAGE_TRANSFER_DST_BIT.
    // Their sizes and formats may be others than those of the layer, as far as vkCmdBlitImage
    // converts them.
    roil_vulkan_image images[ROIL_LAYER_IMAGES];
    // The frame waits for these before it reads or writes an image, and signals those when it is
    // done: at most ROIL_VULKAN_SEMAPHORES of each.
    const roil_vulkan_semaphore *waits, *signals;
    uint32_t wait_count, signal_count;
} roil_vulkan_frame;
// Renders one frame of a layer, as roil_render does, into the host's images, and returns once it is
// submitted. Several layers of a roil are drawn by one call each, one behind the other on the one
// queue. All images belong to the queue's family, to which the host gives them first where another
// one has them. They must live until the frame has finished, which the semaphores tell.
//
// Where it fails, the images still come into the layouts `after`, with undefined content, and the
// semaphores are waited for and signalled, unless an argument is refused or the device is lost.
bool roil_vulkan_render(roil_effect *e, double frame, const roil_vulkan_frame *f);
// The same for a host whose steps are uneven, as roil_advance.
bool roil_vulkan_advance(roil_effect *e, double frame, const roil_vulkan_frame *f);

// ---- images for other processes and APIs ------------------------------------------------------

typedef struct roil_vulkan_shared {
    // Of roil_vulkan_share_image: as roil_vulkan_frame.images takes it.
    roil_vulkan_image image;
    // Of roil_vulkan_share_semaphore, a timeline: for `signals` and `waits`.
    roil_vulkan_semaphore semaphore;
    // To be imported as VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT, or as such a semaphore, by a
    // device and a driver of these UUIDs. Whoever imports or closes it owns it.
    int fd;
    VkDeviceSize size;    // of the image's memory, which is dedicated to it ...
    uint32_t memory_type; // ... and its type
    uint8_t device_uuid[VK_UUID_SIZE], driver_uuid[VK_UUID_SIZE];
    void *inside; // roil's own
} roil_vulkan_shared;
// Make an image that a layer can be drawn into, and a semaphore, on the device of roil, its own or
// the host's, that another process or API can open. The image is made with tiling OPTIMAL, one
// level, and the usages TRANSFER_DST, TRANSFER_SRC and SAMPLED, which whoever imports it says, too,
// with a dedicated allocation. A semaphore is imported for good, into a timeline. False with a
// message, as where the device lacks VK_KHR_external_memory_fd or VK_KHR_external_semaphore_fd, or
// cannot export such a thing.
//
// Whoever imports the image waits for what the frame signals, and acquires the image in each frame,
// by a barrier from VK_QUEUE_FAMILY_EXTERNAL to its own family and from TRANSFER_DST_OPTIMAL to
// image.after (GENERAL). It need not give it back, but the next frame must wait until it was read:
// the other side may signal the shared timeline, too, for `waits`.
bool roil_vulkan_share_image(roil *r, VkFormat format, uint32_t width, uint32_t height,
                             roil_vulkan_shared *out);
bool roil_vulkan_share_semaphore(roil *r, roil_vulkan_shared *out);
// Call it once the frames that use it are done, and before roil_destroy. The file descriptor, and
// what was imported by it, stay.
void roil_vulkan_unshare(roil *r, roil_vulkan_shared *shared);

#ifdef __cplusplus
}
#endif
