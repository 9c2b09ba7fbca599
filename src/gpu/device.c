// Life of a device: features, creation, destruction.
#include "base/log.h"
#include "base/memory.h"
#include "gpu/vk.h"
#include <stdlib.h>
#include <string.h>

static void chain(vk_features *f) {
    f->core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    f->v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    f->v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    f->v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    f->core.pNext = &f->v11;
    f->v11.pNext = &f->v12;
    f->v12.pNext = &f->v13;
}

void vk_features_read(VkPhysicalDevice physical, vk_features *out) {
    memset(out, 0, sizeof *out);
    chain(out);
    vkGetPhysicalDeviceFeatures2(physical, &out->core);
}

// `copies`: a second family to have a queue of; -1: none.
static VkDevice vk_device_create(const vk_choice *choice, const gpu_limits *limits, uint32_t family,
                                 int copies, bool presents) {
    vk_features has, want = {0};
    vk_features_read(choice->physical, &has);
    chain(&want);
    want.v13.dynamicRendering = VK_TRUE;
    want.v13.synchronization2 = VK_TRUE;
    want.v13.maintenance4 = VK_TRUE;
    want.v12.timelineSemaphore = VK_TRUE;
    want.v12.scalarBlockLayout = VK_TRUE;
    want.core.features.shaderStorageImageExtendedFormats = VK_TRUE;
    // Shaders are written by strangers: an index out of bounds must stay inside its own binding.
    want.core.features.robustBufferAccess = has.core.features.robustBufferAccess;
    want.v13.robustImageAccess = has.v13.robustImageAccess;
    // Conveniences that shaders may lean on where they exist.
    want.core.features.shaderStorageImageReadWithoutFormat =
        has.core.features.shaderStorageImageReadWithoutFormat;
    want.core.features.shaderStorageImageWriteWithoutFormat =
        has.core.features.shaderStorageImageWriteWithoutFormat;
    want.core.features.vertexPipelineStoresAndAtomics =
        has.core.features.vertexPipelineStoresAndAtomics;
    want.core.features.fragmentStoresAndAtomics = has.core.features.fragmentStoresAndAtomics;
    want.core.features.shaderUniformBufferArrayDynamicIndexing =
        has.core.features.shaderUniformBufferArrayDynamicIndexing; // hide.c
    want.core.features.drawIndirectFirstInstance = limits->first_instance;
    want.core.features.shaderInt64 = has.core.features.shaderInt64;
    want.core.features.multiDrawIndirect = has.core.features.multiDrawIndirect;
    want.v11.storageBuffer16BitAccess = has.v11.storageBuffer16BitAccess;
    want.v11.uniformAndStorageBuffer16BitAccess = has.v11.uniformAndStorageBuffer16BitAccess;

    const char *extensions[2];
    uint32_t extension_count = 0;
    if (choice->pushes) extensions[extension_count++] = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    if (presents) extensions[extension_count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    float priority = 1.0f;
    VkDeviceQueueCreateInfo queues[2] = {{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                          .queueFamilyIndex = family,
                                          .queueCount = 1,
                                          .pQueuePriorities = &priority}};
    queues[1] = queues[0];
    queues[1].queueFamilyIndex = (uint32_t)copies;
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &want.core,
                               .queueCreateInfoCount = copies < 0 ? 1 : 2,
                               .pQueueCreateInfos = queues,
                               .enabledExtensionCount = extension_count,
                               .ppEnabledExtensionNames = extensions};
    VkDevice device = VK_NULL_HANDLE;
    VkResult result = vkCreateDevice(choice->physical, &info, NULL, &device);
    if (result != VK_SUCCESS) {
        err_set("the device does not start: vkCreateDevice gives error %d", (int)result);
    }
    return device;
}

void vk_name(gpu *g, VkObjectType type, uint64_t handle, const char *label) {
    if (!g->set_name || !label) return;
    VkDebugUtilsObjectNameInfoEXT info = {.sType =
                                              VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                          .objectType = type,
                                          .objectHandle = handle,
                                          .pObjectName = label};
    g->set_name(g->device, &info);
}

static void load_limits(gpu *g) {
    VkPhysicalDeviceVulkan13Properties v13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
    VkPhysicalDeviceVulkan11Properties v11 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, .pNext = &v13};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &v11};
    vkGetPhysicalDeviceProperties2(g->physical, &properties);
    g->limits = properties.properties.limits;
    g->max_allocation = v11.maxMemoryAllocationSize;
    g->max_buffer = v13.maxBufferSize;
    vkGetPhysicalDeviceMemoryProperties(g->physical, &g->heaps);
    for (int i = 1; i < GPU_FORMAT_COUNT; i++) {
        VkFormatProperties p;
        vkGetPhysicalDeviceFormatProperties(g->physical, vk_format_get((gpu_format)i)->format, &p);
        g->format_features[i] = p.optimalTilingFeatures;
    }
    VkQueueFamilyProperties families[16];
    uint32_t count = COUNT_OF(families);
    vkGetPhysicalDeviceQueueFamilyProperties(g->physical, &count, families);
    g->timestamp_bits = families[g->family].timestampValidBits;
}

static void load_calls(gpu *g, bool pushes) {
    VkDevice d = g->device;
    if (pushes)
        g->push_descriptors =
            (PFN_vkCmdPushDescriptorSetKHR)vkGetDeviceProcAddr(d, "vkCmdPushDescriptorSetKHR");
    if (!g->instance.labels) return;
    g->begin_label =
        (PFN_vkCmdBeginDebugUtilsLabelEXT)vkGetDeviceProcAddr(d, "vkCmdBeginDebugUtilsLabelEXT");
    g->end_label =
        (PFN_vkCmdEndDebugUtilsLabelEXT)vkGetDeviceProcAddr(d, "vkCmdEndDebugUtilsLabelEXT");
    g->set_name =
        (PFN_vkSetDebugUtilsObjectNameEXT)vkGetDeviceProcAddr(d, "vkSetDebugUtilsObjectNameEXT");
}

static bool open_device(gpu *g, const gpu_desc *desc) {
    vk_choice choices[VK_MAX_DEVICES];
    int count = vk_choices_find(g->instance.handle, g->window.surface, choices);
    const vk_choice *choice = count > 0 ? vk_choice_pick(choices, count, desc->device) : NULL;
    if (!choice) return false;
    g->info = choice->info;
    g->physical = choice->physical;
    g->profile = choice->profile;
    if (desc->small || vk_small_device_wanted()) vk_profile_make_small(&g->profile);
    g->family = (uint32_t)vk_queue_family_find(g->physical, g->window.surface);
    g->copier.family = vk_transfer_family_find(g->physical);
    g->device = vk_device_create(choice, &g->profile.limits, g->family, g->copier.family,
                                 g->window.surface != VK_NULL_HANDLE);
    if (!g->device) return false;
    vkGetDeviceQueue(g->device, g->family, 0, &g->queue);
    load_limits(g);
    vk_pool_init(g);
    load_calls(g, choice->pushes);
    return true;
}

static bool open_timeline(gpu *g) {
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    return vk_check(g, vkCreateSemaphore(g->device, &info, NULL, &g->timeline),
                    "creating the timeline semaphore");
}

static bool open_commands(gpu *g) {
    if (!open_timeline(g) || !vk_copier_open(g)) return false;
    for (int i = 0; i < VK_BATCHES; i++) {
        if (!vk_batch_create(g, &g->batches[i])) return false;
    }
    for (int i = 0; i < GPU_FRAMES_IN_FLIGHT; i++) {
        if (!vk_batch_create(g, &g->frames[i].batch)) return false;
        if (!vk_timer_create(g, &g->frames[i].timer)) return false;
    }
    return vk_window_prepare(g);
}

static bool validation_wanted(const gpu_desc *desc) {
    const char *set = getenv("ROIL_VALIDATE");
    return desc->validate || (set && strcmp(set, "1") == 0);
}

// In nanoseconds.
static uint64_t timeout_of(const gpu *g, double seconds) {
    if (!(seconds > 0.0)) seconds = g->profile.timeout;
    return seconds < 1e9 ? (uint64_t)(seconds * 1e9) : UINT64_MAX;
}

gpu *gpu_create(const gpu_desc *desc) {
    static const gpu_desc defaults = {0};
    if (!desc) desc = &defaults;
    gpu *g = mem_alloc(sizeof *g);
    pthread_mutex_init(&g->retire_lock, NULL);
    pthread_mutex_init(&g->built_lock, NULL);
    if (!vk_instance_create(&g->instance, validation_wanted(desc), desc->window, &g->messages) ||
        !vk_window_open(g, desc->window) || !open_device(g, desc) || !open_commands(g) ||
        !vk_samplers_create(g) || !vk_cache_create(g, desc->cache_dir)) {
        gpu_destroy(g);
        return NULL;
    }
    g->timeout = timeout_of(g, desc->timeout);
    g->waiting = desc->waiting;
    g->waiting_user = desc->user;
    g->owner = pthread_self();
    log_write(LOG_DEBUG, "device: %s, %s%s", g->info.name, g->info.driver,
              g->instance.validating ? ", with validation" : "");
    return g;
}

static void close_frame(gpu *g, vk_frame *frame) {
    for (size_t i = 0; i < frame->uniforms.count; i++) {
        gpu_buffer_destroy(g, frame->uniforms.chunks[i]);
    }
    mem_free(frame->uniforms.chunks);
    vk_timer_destroy(g, &frame->timer);
    vkDestroySemaphore(g->device, frame->acquired, NULL);
    vk_batch_destroy(g, &frame->batch);
}

static void close_device(gpu *g) {
    for (int i = 0; i < GPU_FRAMES_IN_FLIGHT; i++) close_frame(g, &g->frames[i]);
    for (int i = 0; i < VK_BATCHES; i++) vk_batch_destroy(g, &g->batches[i]);
    gpu_buffer_destroy(g, g->ring.buffer);
    vk_window_close(g);
    vk_collect_all(g);
    vk_built_close(g);
    for (int i = 0; i < GPU_SAMPLER_COUNT; i++) {
        vkDestroySampler(g->device, g->samplers[i], NULL);
    }
    vk_cache_destroy(g);
    vkDestroySemaphore(g->device, g->timeline, NULL);
    vk_copier_close(g);
    vk_pool_deinit(g);
    vkDestroyDevice(g->device, NULL);
}

static atomic_bool left_any;

bool gpu_left_any(void) {
    return atomic_load(&left_any);
}

// Work that hangs never lets go of what it uses, and drivers wait for it without a limit when the
// device is destroyed; and where waiting fails nobody knows what is still in use. All of such a
// device, `g` too, is left to the end of the process: the caller must get on, and can have a new
// device beside it. A lost one has nothing to wait for.
static bool comes_to_rest(gpu *g) {
    if (!atomic_load(&g->lost)) vk_wait(g, g->submitted);
    if (g->hung) {
        log_write(LOG_WARNING, "%s; its memory stays in use", g->loss);
        return false;
    }
    VkResult rest = vkDeviceWaitIdle(g->device);
    if (rest == VK_SUCCESS || rest == VK_ERROR_DEVICE_LOST) return true;
    log_write(LOG_WARNING,
              "the device '%s' cannot be waited for (Vulkan result %d); its memory stays in use",
              g->info.name, (int)rest);
    return false;
}

void gpu_destroy(gpu *g) {
    if (!g) return;
    if (g->device && !comes_to_rest(g)) {
        atomic_store(&left_any, true);
        return;
    }
    if (g->device) close_device(g);
    if (g->window.surface) vkDestroySurfaceKHR(g->instance.handle, g->window.surface, NULL);
    vk_instance_destroy(&g->instance);
    pthread_mutex_destroy(&g->retire_lock);
    pthread_mutex_destroy(&g->built_lock);
    mem_free(g->retired);
    mem_free(g->uses.list);
    mem_free(g->uses.images);
    mem_free(g->uses.buffers);
    mem_free(g->cache_path);
    mem_free(g);
}

const gpu_info *gpu_get_info(const gpu *g) {
    return &g->info;
}

uint64_t gpu_validation_messages(const gpu *g) {
    return atomic_load(&g->messages);
}
