// Life of a device: features, creation, destruction.
#include "base/log.h"
#include "base/memory.h"
#include "gpu/vk.h"
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { NICER = 2 }; // are threads of a device that yields

// `copies`: a second family to have a queue of; -1: none.
static VkDevice vk_device_create(gpu *g, const vk_choice *choice, int copies) {
    vk_features there, want;
    vk_features_read(&g->vk, choice->physical, &there);
    vk_features_choose(&there, &want);
    want.core.features.drawIndirectFirstInstance = g->profile.limits.first_instance;
    g->draws_many = want.core.features.multiDrawIndirect;

    const char *extensions[1 + GPU_MAX_NEEDS];
    uint32_t extension_count =
        vk_host_extensions(&g->vk, choice->physical, choice->pushes, extensions);
    if (g->window.surface) extensions[extension_count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    float priority = 1.0f;
    VkDeviceQueueCreateInfo queues[2] = {{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                          .queueFamilyIndex = g->family,
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
    VkResult result = g->vk.CreateDevice(choice->physical, &info, NULL, &device);
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
    g->vk.GetPhysicalDeviceProperties2(g->physical, &properties);
    g->limits = properties.properties.limits;
    if (!g->draws_many) g->limits.maxDrawIndirectCount = 1;
    g->max_allocation = v11.maxMemoryAllocationSize;
    g->max_buffer = v13.maxBufferSize;
    g->vk.GetPhysicalDeviceMemoryProperties(g->physical, &g->heaps);
    for (int i = 1; i < GPU_FORMAT_COUNT; i++) {
        VkFormatProperties p;
        g->vk.GetPhysicalDeviceFormatProperties(g->physical, vk_format_get((gpu_format)i)->format,
                                                &p);
        g->format_features[i] = p.optimalTilingFeatures;
    }
    VkQueueFamilyProperties families[16];
    uint32_t count = COUNT_OF(families);
    g->vk.GetPhysicalDeviceQueueFamilyProperties(g->physical, &count, families);
    g->timestamp_bits = families[g->family].timestampValidBits;
}

static void load_calls(gpu *g, bool pushes) {
    VkDevice d = g->device;
    if (pushes)
        g->push_descriptors = (PFN_vkCmdPushDescriptorSetWithTemplateKHR)g->vk.GetDeviceProcAddr(
            d, "vkCmdPushDescriptorSetWithTemplateKHR");
    if (!g->instance.labels) return;
    g->begin_label = (PFN_vkCmdBeginDebugUtilsLabelEXT)g->vk.GetDeviceProcAddr(
        d, "vkCmdBeginDebugUtilsLabelEXT");
    g->end_label =
        (PFN_vkCmdEndDebugUtilsLabelEXT)g->vk.GetDeviceProcAddr(d, "vkCmdEndDebugUtilsLabelEXT");
    g->set_name = (PFN_vkSetDebugUtilsObjectNameEXT)g->vk.GetDeviceProcAddr(
        d, "vkSetDebugUtilsObjectNameEXT");
}

static bool is_small(const gpu_desc *desc) {
    return desc->small || vk_small_device_wanted();
}

// What is known of the device before it is there, whoever makes it.
static void take_choice(gpu *g, const gpu_desc *desc, const vk_choice *choice) {
    g->info = choice->info;
    g->physical = choice->physical;
    g->profile = choice->profile;
    if (is_small(desc)) vk_profile_make_small(&g->profile);
}

static bool finish_device(gpu *g, const gpu_desc *desc, const vk_choice *choice, uint32_t index) {
    if (!vk_calls_find_device(&g->vk, g->device)) return false;
    g->vk.GetDeviceQueue(g->device, g->family, index, &g->queue);
    load_limits(g);
    vk_pool_init(g, desc->memory);
    load_calls(g, choice->pushes);
    return true;
}

static bool open_own_device(gpu *g, const gpu_desc *desc) {
    vk_choice choices[VK_MAX_DEVICES];
    int count = vk_choices_find(&g->vk, g->instance.handle, g->window.surface, choices);
    const vk_choice *choice = count > 0 ? vk_choice_pick(choices, count, desc->device) : NULL;
    if (!choice) return false;
    take_choice(g, desc, choice);
    g->family = (uint32_t)vk_queue_family_find(&g->vk, g->physical, g->window.surface);
    g->copier.family = vk_transfer_family_find(&g->vk, g->physical);
    g->device = vk_device_create(g, choice, g->copier.family);
    return g->device && finish_device(g, desc, choice, 0);
}

static bool open_host_device(gpu *g, const gpu_desc *desc) {
    const gpu_host *host = desc->host;
    vk_choice choice;
    g->copier.family = -1;
    if (!vk_host_open(g, host, &choice)) return false;
    take_choice(g, desc, &choice);
    g->family = host->family;
    g->device = host->device;
    if (!finish_device(g, desc, &choice, host->index)) return false;
    vk_host_forget_calls(g, host);
    return true;
}

static bool validation_wanted(const gpu_desc *desc) {
    const char *set = getenv("ROIL_VALIDATE");
    return desc->validate || (set && strcmp(set, "1") == 0);
}

static bool open_device(gpu *g, const gpu_desc *desc) {
    if (desc->host) return open_host_device(g, desc);
    return vk_instance_create(&g->instance, &g->vk, validation_wanted(desc), desc->window,
                              &g->messages) &&
           vk_window_open(g, desc->window) && open_own_device(g, desc);
}

static bool open_timeline(gpu *g) {
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    return vk_check(g, g->vk.CreateSemaphore(g->device, &info, NULL, &g->timeline),
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

// In nanoseconds.
static uint64_t timeout_of(const gpu *g, double seconds) {
    if (!(seconds > 0.0)) seconds = g->profile.timeout;
    return seconds < 1e9 ? (uint64_t)(seconds * 1e9) : UINT64_MAX;
}

static gpu *create(const gpu_desc *desc) {
    gpu *g = mem_alloc(sizeof *g);
    pthread_mutex_init(&g->retire_lock, NULL);
    pthread_mutex_init(&g->built_lock, NULL);
    if (!open_device(g, desc) || !open_commands(g) || !vk_samplers_create(g) ||
        !vk_cache_create(g, desc->cache_dir)) {
        gpu_destroy(g);
        return NULL;
    }
    g->timeout = timeout_of(g, desc->timeout);
    g->waiting = desc->waiting;
    g->waiting_user = desc->user;
    log_write(LOG_DEBUG, "device: %s, %s%s", g->info.name, g->info.driver,
              g->instance.validating ? ", with validation" : "");
    return g;
}

typedef struct made_apart {
    const gpu_desc *desc;
    gpu *made;
    char *message;
} made_apart;

// Threads of the driver are as nice as the one that makes them, which may not be less nice again.
static void *create_apart(void *user) {
    made_apart *m = user;
    const id_t self = (id_t)gettid();
    setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + NICER);
    m->made = create(m->desc);
    if (!m->made) m->message = mem_copy(err_get(), strlen(err_get()) + 1);
    return NULL;
}

static gpu *create_nicely(const gpu_desc *desc) {
    made_apart m = {.desc = desc};
    pthread_t thread;
    if (pthread_create(&thread, NULL, create_apart, &m) != 0) return create(desc); // none is left
    pthread_join(thread, NULL);
    if (m.message) err_set("%s", m.message);
    mem_free(m.message);
    return m.made;
}

gpu *gpu_create(const gpu_desc *desc) {
    static const gpu_desc defaults = {0};
    if (!desc) desc = &defaults;
    gpu *g = desc->yields ? create_nicely(desc) : create(desc);
    if (g) g->owner = pthread_self();
    return g;
}

static void close_frame(gpu *g, vk_frame *frame) {
    for (size_t i = 0; i < frame->uniforms.count; i++) {
        gpu_buffer_destroy(g, frame->uniforms.chunks[i]);
    }
    mem_free(frame->uniforms.chunks);
    vk_timer_destroy(g, &frame->timer);
    g->vk.DestroySemaphore(g->device, frame->acquired, NULL);
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
        g->vk.DestroySampler(g->device, g->samplers[i], NULL);
    }
    vk_cache_destroy(g);
    g->vk.DestroySemaphore(g->device, g->timeline, NULL);
    vk_copier_close(g);
    vk_pool_deinit(g);
    if (!g->host.device) g->vk.DestroyDevice(g->device, NULL);
}

static atomic_bool left_any;

bool gpu_left_any(void) {
    return atomic_load(&left_any);
}

// A host's other queues are not ours. One that counts as lost since it took no more work may still
// be at what it took before.
static VkResult wait_for_ours(gpu *g) {
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &g->timeline,
                                .pValues = &g->submitted};
    return g->submitted ? g->vk.WaitSemaphores(g->device, &info, g->timeout) : VK_SUCCESS;
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
    VkResult rest = g->host.device ? wait_for_ours(g) : g->vk.DeviceWaitIdle(g->device);
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
    if (g->window.surface) g->vk.DestroySurfaceKHR(g->instance.handle, g->window.surface, NULL);
    vk_instance_destroy(&g->instance, &g->vk);
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
