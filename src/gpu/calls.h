// The Vulkan calls that roil makes, found through a vkGetInstanceProcAddr: the loader's, or that of
// a host whose device is used. No other call is made, so that a host's loader, its layers and what
// it records with see all that there is.
#pragma once
#include <stdbool.h>
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#define VK_CALLS_GLOBAL(X)                                                                         \
    X(CreateInstance)                                                                              \
    X(EnumerateInstanceExtensionProperties)                                                        \
    X(EnumerateInstanceLayerProperties)                                                            \
    X(EnumerateInstanceVersion)

#define VK_CALLS_INSTANCE(X)                                                                       \
    X(CreateDevice)                                                                                \
    X(DestroyInstance)                                                                             \
    X(EnumerateDeviceExtensionProperties)                                                          \
    X(EnumeratePhysicalDevices)                                                                    \
    X(GetDeviceProcAddr)                                                                           \
    X(GetPhysicalDeviceExternalSemaphoreProperties)                                                \
    X(GetPhysicalDeviceFeatures2)                                                                  \
    X(GetPhysicalDeviceFormatProperties)                                                           \
    X(GetPhysicalDeviceImageFormatProperties2)                                                     \
    X(GetPhysicalDeviceImageFormatProperties)                                                      \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceProperties2)                                                                \
    X(GetPhysicalDeviceQueueFamilyProperties)

#define VK_CALLS_DEVICE(X)                                                                         \
    X(AllocateCommandBuffers)                                                                      \
    X(AllocateDescriptorSets)                                                                      \
    X(AllocateMemory)                                                                              \
    X(BeginCommandBuffer)                                                                          \
    X(BindBufferMemory)                                                                            \
    X(BindImageMemory)                                                                             \
    X(CmdBeginRendering)                                                                           \
    X(CmdBindDescriptorSets)                                                                       \
    X(CmdBindIndexBuffer)                                                                          \
    X(CmdBindPipeline)                                                                             \
    X(CmdBlitImage)                                                                                \
    X(CmdClearColorImage)                                                                          \
    X(CmdClearDepthStencilImage)                                                                   \
    X(CmdCopyBuffer)                                                                               \
    X(CmdCopyBufferToImage)                                                                        \
    X(CmdCopyImage)                                                                                \
    X(CmdCopyImageToBuffer)                                                                        \
    X(CmdDispatch)                                                                                 \
    X(CmdDispatchBase)                                                                             \
    X(CmdDraw)                                                                                     \
    X(CmdDrawIndexed)                                                                              \
    X(CmdDrawIndexedIndirect)                                                                      \
    X(CmdDrawIndirect)                                                                             \
    X(CmdEndRendering)                                                                             \
    X(CmdFillBuffer)                                                                               \
    X(CmdPipelineBarrier2)                                                                         \
    X(CmdResetQueryPool)                                                                           \
    X(CmdSetEvent2)                                                                                \
    X(CmdSetScissor)                                                                               \
    X(CmdSetViewport)                                                                              \
    X(CmdWriteTimestamp2)                                                                          \
    X(CreateBuffer)                                                                                \
    X(CreateCommandPool)                                                                           \
    X(CreateComputePipelines)                                                                      \
    X(CreateDescriptorPool)                                                                        \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateDescriptorUpdateTemplate)                                                              \
    X(CreateEvent)                                                                                 \
    X(CreateGraphicsPipelines)                                                                     \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreatePipelineCache)                                                                         \
    X(CreatePipelineLayout)                                                                        \
    X(CreateQueryPool)                                                                             \
    X(CreateSampler)                                                                               \
    X(CreateSemaphore)                                                                             \
    X(CreateShaderModule)                                                                          \
    X(DestroyBuffer)                                                                               \
    X(DestroyCommandPool)                                                                          \
    X(DestroyDescriptorPool)                                                                       \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyDescriptorUpdateTemplate)                                                             \
    X(DestroyDevice)                                                                               \
    X(DestroyEvent)                                                                                \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyPipeline)                                                                             \
    X(DestroyPipelineCache)                                                                        \
    X(DestroyPipelineLayout)                                                                       \
    X(DestroyQueryPool)                                                                            \
    X(DestroySampler)                                                                              \
    X(DestroySemaphore)                                                                            \
    X(DestroyShaderModule)                                                                         \
    X(DeviceWaitIdle)                                                                              \
    X(EndCommandBuffer)                                                                            \
    X(FreeMemory)                                                                                  \
    X(GetBufferMemoryRequirements)                                                                 \
    X(GetDeviceQueue)                                                                              \
    X(GetEventStatus)                                                                              \
    X(GetImageMemoryRequirements)                                                                  \
    X(GetPipelineCacheData)                                                                        \
    X(GetQueryPoolResults)                                                                         \
    X(GetSemaphoreCounterValue)                                                                    \
    X(MapMemory)                                                                                   \
    X(QueueSubmit2)                                                                                \
    X(ResetCommandPool)                                                                            \
    X(ResetDescriptorPool)                                                                         \
    X(ResetEvent)                                                                                  \
    X(UpdateDescriptorSetWithTemplate)                                                             \
    X(WaitSemaphores)

// Of extensions: NULL where these are not enabled.
#define VK_CALLS_INSTANCE_OPTIONAL(X)                                                              \
    X(CreateDebugUtilsMessengerEXT)                                                                \
    X(DestroyDebugUtilsMessengerEXT)                                                               \
    X(DestroySurfaceKHR)                                                                           \
    X(GetPhysicalDeviceSurfaceCapabilitiesKHR)                                                     \
    X(GetPhysicalDeviceSurfaceFormatsKHR)                                                          \
    X(GetPhysicalDeviceSurfaceSupportKHR)

#define VK_CALLS_DEVICE_OPTIONAL(X)                                                                \
    X(AcquireNextImageKHR)                                                                         \
    X(CreateSwapchainKHR)                                                                          \
    X(DestroySwapchainKHR)                                                                         \
    X(GetMemoryFdKHR)                                                                              \
    X(GetSemaphoreFdKHR)                                                                           \
    X(GetSwapchainImagesKHR)                                                                       \
    X(QueuePresentKHR)

typedef struct vk_calls {
    PFN_vkGetInstanceProcAddr GetInstanceProcAddr;
#define VK_CALL(name) PFN_vk##name name;
    VK_CALLS_GLOBAL(VK_CALL)
    VK_CALLS_INSTANCE(VK_CALL)
    VK_CALLS_INSTANCE_OPTIONAL(VK_CALL)
    VK_CALLS_DEVICE(VK_CALL)
    VK_CALLS_DEVICE_OPTIONAL(VK_CALL)
#undef VK_CALL
} vk_calls;

// In this order, each once its object is there. `get` NULL: the loader that roil is linked to.
// False with a message that names a call which is not there.
bool vk_calls_find_global(vk_calls *vk, PFN_vkGetInstanceProcAddr get);
bool vk_calls_find_instance(vk_calls *vk, VkInstance instance);
bool vk_calls_find_device(vk_calls *vk, VkDevice device);
