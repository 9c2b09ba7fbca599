// Which devices there are, what they can do, and which one is meant.
#include "base/memory.h"
#include "base/str.h"
#include "gpu/vk.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static gpu_kind kind_of(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return GPU_DISCRETE;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return GPU_INTEGRATED;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return GPU_VIRTUAL;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return GPU_CPU;
    default:
        return GPU_OTHER;
    }
}

static bool can_present(const vk_calls *vk, VkPhysicalDevice physical, uint32_t family,
                        VkSurfaceKHR surface) {
    VkBool32 can = VK_FALSE;
    return vk->GetPhysicalDeviceSurfaceSupportKHR(physical, family, surface, &can) == VK_SUCCESS &&
           can;
}

int vk_queue_family_find(const vk_calls *vk, VkPhysicalDevice physical, VkSurfaceKHR surface) {
    VkQueueFamilyProperties list[16];
    uint32_t count = COUNT_OF(list);
    vk->GetPhysicalDeviceQueueFamilyProperties(physical, &count, list);
    for (uint32_t i = 0; i < count; i++) {
        VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if ((list[i].queueFlags & wanted) != wanted) continue;
        if (!surface || can_present(vk, physical, i, surface)) return (int)i;
    }
    return -1;
}

bool vk_has_extension(const vk_calls *vk, VkPhysicalDevice physical, const char *name) {
    uint32_t count = 0;
    if (vk->EnumerateDeviceExtensionProperties(physical, NULL, &count, NULL) != VK_SUCCESS) {
        return false;
    }
    VkExtensionProperties *list = mem_alloc(count * sizeof *list);
    bool found = false;
    VkResult result = vk->EnumerateDeviceExtensionProperties(physical, NULL, &count, list);
    for (uint32_t i = 0; result == VK_SUCCESS && i < count && !found; i++) {
        found = strcmp(list[i].extensionName, name) == 0;
    }
    mem_free(list);
    return found;
}

static void lacks(gpu_info *info, const char *what) {
    size_t length = strlen(info->missing);
    snprintf(info->missing + length, sizeof info->missing - length, "%s%s", length ? ", " : "",
             what);
    info->usable = false;
}

// The environment may turn them down, so that what stands in for them can be tried on any device.
bool vk_can_push(const vk_calls *vk, VkPhysicalDevice physical) {
    const char *set = getenv("ROIL_PUSH_DESCRIPTORS");
    return vk_has_extension(vk, physical, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME) &&
           !(set && strcmp(set, "0") == 0);
}

// A device older than 1.3 does not know the feature structs, so nothing more is asked of it.
static void list_missing(const vk_calls *vk, VkPhysicalDevice physical, VkSurfaceKHR surface,
                         uint32_t version, const vk_features *features, gpu_info *info) {
    info->usable = true;
    if (version < VK_API_VERSION_1_3) {
        lacks(info, "Vulkan 1.3");
        return;
    }
    if (vk_queue_family_find(vk, physical, VK_NULL_HANDLE) < 0) {
        lacks(info, "a graphics and compute queue");
    } else if (surface && vk_queue_family_find(vk, physical, surface) < 0) {
        lacks(info, "a queue that can show pictures in the window");
    }
    if (surface && !vk_has_extension(vk, physical, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) {
        lacks(info, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    }
    vk_features there;
    vk_features_read(vk, physical, &there);
    info->int64 = features->core.features.shaderInt64;
    size_t at = 0;
    for (const char *name; (name = vk_features_missing(&there, features, &at));) lacks(info, name);
}

static gpu_limits limits_of(const vk_features *features, const VkPhysicalDeviceLimits *l) {
    return (gpu_limits){.group_threads = l->maxComputeWorkGroupInvocations,
                        .shared_bytes = l->maxComputeSharedMemorySize,
                        .storage_buffers = l->maxPerStageDescriptorStorageBuffers,
                        .storage_images = l->maxPerStageDescriptorStorageImages,
                        .first_instance = features->core.features.drawIndirectFirstInstance};
}

// As tools of vendors print it: groups of 4, 2, 2, 2 and 6 bytes.
static void print_uuid(const uint8_t id[VK_UUID_SIZE], char out[37]) {
    for (size_t i = 0; i < VK_UUID_SIZE; i++) {
        bool group = i == 4 || i == 6 || i == 8 || i == 10;
        out += snprintf(out, 4, "%s%02x", group ? "-" : "", id[i]);
    }
}

void vk_choice_describe(const vk_calls *vk, VkPhysicalDevice physical, VkSurfaceKHR surface,
                        const vk_features *features, bool pushes, vk_choice *choice) {
    *choice = (vk_choice){.physical = physical, .pushes = pushes};
    gpu_info *info = &choice->info;
    VkPhysicalDeviceVulkan11Properties v11 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, .pNext = &v11};
    VkPhysicalDeviceProperties2 two = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->GetPhysicalDeviceProperties2(physical, &two);
    const VkPhysicalDeviceProperties *p = &two.properties;
    if (p->apiVersion >= VK_API_VERSION_1_2) {
        two.pNext = &driver;
        vk->GetPhysicalDeviceProperties2(physical, &two);
        print_uuid(v11.deviceUUID, info->uuid);
    }

    str_copy(info->name, sizeof info->name, p->deviceName);
    snprintf(info->driver, sizeof info->driver, "%.120s %.120s", driver.driverName,
             driver.driverInfo);
    info->kind = kind_of(p->deviceType);
    info->max_storage_range = p->limits.maxStorageBufferRange;
    info->api_major = VK_API_VERSION_MAJOR(p->apiVersion);
    info->api_minor = VK_API_VERSION_MINOR(p->apiVersion);
    info->subgroup_size = v11.subgroupSize;
    info->subpixel_bits = p->limits.subPixelPrecisionBits;
    VkPhysicalDeviceMemoryProperties memory;
    vk->GetPhysicalDeviceMemoryProperties(physical, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++) {
        const VkMemoryHeap *heap = &memory.memoryHeaps[i];
        if ((heap->flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) && heap->size > info->memory) {
            info->memory = heap->size;
        }
    }
    int family = vk_queue_family_find(vk, physical, surface);
    if (family >= 0) {
        VkQueueFamilyProperties list[16];
        uint32_t count = COUNT_OF(list);
        vk->GetPhysicalDeviceQueueFamilyProperties(physical, &count, list);
        if (list[family].timestampValidBits > 0) {
            info->timestamp_period = p->limits.timestampPeriod;
        }
    }
    list_missing(vk, physical, surface, p->apiVersion, features, info);
    const gpu_limits limits = limits_of(features, &p->limits);
    choice->profile = vk_profile_find(info, driver.driverID, driver.driverInfo, &limits);
}

static int rank(gpu_kind kind) {
    static const int ranks[] = {[GPU_DISCRETE] = 0,
                                [GPU_INTEGRATED] = 1,
                                [GPU_VIRTUAL] = 2,
                                [GPU_OTHER] = 3,
                                [GPU_CPU] = 4};
    return ranks[kind];
}

// Of a device older than 1.3 none.
static void read_features(const vk_calls *vk, VkPhysicalDevice physical, vk_features *out) {
    VkPhysicalDeviceProperties2 two = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->GetPhysicalDeviceProperties2(physical, &two);
    memset(out, 0, sizeof *out);
    if (two.properties.apiVersion >= VK_API_VERSION_1_3) vk_features_read(vk, physical, out);
}

int vk_choices_find(const vk_calls *vk, VkInstance instance, VkSurfaceKHR surface, vk_choice *out) {
    VkPhysicalDevice list[VK_MAX_DEVICES];
    uint32_t count = VK_MAX_DEVICES;
    VkResult result = vk->EnumeratePhysicalDevices(instance, &count, list);
    if ((result != VK_SUCCESS && result != VK_INCOMPLETE) || count == 0) {
        err_set("no Vulkan device was found; install the driver of your GPU, or Mesa's software "
                "driver (Debian: mesa-vulkan-drivers)");
        return -1;
    }
    for (uint32_t i = 0; i < count; i++) {
        vk_features features;
        vk_choice choice;
        read_features(vk, list[i], &features);
        vk_choice_describe(vk, list[i], surface, &features, vk_can_push(vk, list[i]), &choice);
        uint32_t at = i;
        for (; at > 0 && rank(out[at - 1].info.kind) > rank(choice.info.kind); at--) {
            out[at] = out[at - 1];
        }
        out[at] = choice;
    }
    return (int)count;
}

int gpu_list(gpu_info *out, int capacity) {
    vk_instance instance;
    vk_calls vk = {0};
    if (!vk_instance_create(&instance, &vk, false, NULL, NULL)) return -1;
    vk_choice choices[VK_MAX_DEVICES];
    int count = vk_choices_find(&vk, instance.handle, VK_NULL_HANDLE, choices);
    for (int i = 0; i < count && i < capacity; i++) out[i] = choices[i].info;
    vk_instance_destroy(&instance, &vk);
    return count;
}

static bool contains(const char *text, const char *part) {
    size_t length = strlen(part);
    for (; *text; text++) {
        size_t i = 0;
        while (i < length && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (i == length) return true;
    }
    return false;
}

static bool is_index(const char *text, int count, int *out) {
    if (*text == '\0' || strspn(text, "0123456789") != strlen(text)) return false;
    long value = strtol(text, NULL, 10);
    if (value < 0 || value >= count) return false; // "4090" is part of a name
    *out = (int)value;
    return true;
}

static const vk_choice *usable(const vk_choice *choice) {
    if (choice->info.usable) return choice;
    return ERR_NULL("device '%s' cannot run roil: it lacks %s", choice->info.name,
                    choice->info.missing);
}

const vk_choice *vk_choice_pick(const vk_choice *choices, int count, const char *device) {
    int index;
    if (!device || !*device) {
        for (int i = 0; i < count; i++) {
            if (choices[i].info.usable) return &choices[i];
        }
        return usable(&choices[0]);
    }
    if (is_index(device, count, &index)) return usable(&choices[index]);
    for (int i = 0; i < count; i++) {
        if (strcasecmp(choices[i].info.uuid, device) == 0) return usable(&choices[i]);
    }
    for (int i = 0; i < count; i++) {
        if (contains(choices[i].info.name, device)) return usable(&choices[i]);
    }
    strbuf names = {0};
    for (int i = 0; i < count; i++) {
        strbuf_add(&names, "%s%d: %s", i ? ", " : "", i, choices[i].info.name);
    }
    err_set("no device is called '%s'; there are: %s (an index, a UUID or a part of a name is "
            "accepted)",
            device, strbuf_text(&names));
    strbuf_free(&names);
    return NULL;
}
