// Features of a device: which roil needs, which it takes when they are there, and which a host has
// enabled on a device of its own.
#include "base/memory.h"
#include "gpu/vk.h"
#include <stddef.h>
#include <string.h>

typedef enum feature_kind {
    NEEDED, // roil does not work without
    WANTED, // where the device has it: shaders may lean on it
    FREE,   // taken when it is there, and told apart in `gpu_info`, `gpu_limits` or here
} feature_kind;

typedef struct feature_row {
    const char *name;
    size_t at; // of the VkBool32 in vk_features
    feature_kind kind;
} feature_row;

#define CORE(name) #name, offsetof(vk_features, core.features.name)
#define V11(name) #name, offsetof(vk_features, v11.name)
#define V12(name) #name, offsetof(vk_features, v12.name)
#define V13(name) #name, offsetof(vk_features, v13.name)

static const feature_row rows[] = {
    {V13(dynamicRendering), NEEDED},
    {V13(synchronization2), NEEDED},
    {V13(maintenance4), NEEDED},
    {V12(timelineSemaphore), NEEDED},
    {V12(scalarBlockLayout), NEEDED},
    {CORE(shaderStorageImageExtendedFormats), NEEDED},
    {CORE(shaderStorageImageReadWithoutFormat), WANTED},
    {CORE(shaderStorageImageWriteWithoutFormat), WANTED},
    {CORE(vertexPipelineStoresAndAtomics), WANTED},
    {CORE(fragmentStoresAndAtomics), WANTED},
    {CORE(shaderUniformBufferArrayDynamicIndexing), WANTED}, // hide.c
    {V11(storageBuffer16BitAccess), WANTED},
    {V11(uniformAndStorageBuffer16BitAccess), WANTED},
    {CORE(drawIndirectFirstInstance), FREE},
    {CORE(multiDrawIndirect), FREE},
    {CORE(shaderInt64), FREE},
    // Shaders are written by strangers: an index out of bounds must stay inside its own binding.
    {CORE(robustBufferAccess), FREE},
    {V13(robustImageAccess), FREE},
};

static VkBool32 *feature(vk_features *f, const feature_row *row) {
    return (VkBool32 *)((char *)f + row->at);
}

static VkBool32 has(const vk_features *f, const feature_row *row) {
    return *(const VkBool32 *)((const char *)f + row->at);
}

void vk_features_chain(vk_features *f) {
    f->core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    f->v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    f->v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    f->v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    f->core.pNext = &f->v11;
    f->v11.pNext = &f->v12;
    f->v12.pNext = &f->v13;
    f->v13.pNext = NULL;
}

void vk_features_read(const vk_calls *vk, VkPhysicalDevice physical, vk_features *out) {
    memset(out, 0, sizeof *out);
    vk_features_chain(out);
    vk->GetPhysicalDeviceFeatures2(physical, &out->core);
}

void vk_features_choose(const vk_features *there, vk_features *out) {
    memset(out, 0, sizeof *out);
    vk_features_chain(out);
    for (size_t i = 0; i < COUNT_OF(rows); i++) *feature(out, &rows[i]) = has(there, &rows[i]);
}

const char *vk_features_missing(const vk_features *there, const vk_features *enabled, size_t *at) {
    for (; *at < COUNT_OF(rows); ++*at) {
        const feature_row *row = &rows[*at];
        bool asked = row->kind == NEEDED || (row->kind == WANTED && has(there, row));
        if (asked && !has(enabled, row)) return rows[(*at)++].name;
    }
    return NULL;
}

// Features that came to the core from extensions, whose structs a host may have chained instead.
#define ALONE(type, TYPE, part, name)                                                              \
    {                                                                                              \
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##TYPE##_FEATURES,                                       \
            offsetof(VkPhysicalDevice##type##Features, name), offsetof(vk_features, part.name)     \
    }
static const struct {
    VkStructureType type;
    size_t from, to; // of a VkBool32
} alone[] = {
    ALONE(DynamicRendering, DYNAMIC_RENDERING, v13, dynamicRendering),
    ALONE(Synchronization2, SYNCHRONIZATION_2, v13, synchronization2),
    ALONE(Maintenance4, MAINTENANCE_4, v13, maintenance4),
    ALONE(ImageRobustness, IMAGE_ROBUSTNESS, v13, robustImageAccess),
    ALONE(TimelineSemaphore, TIMELINE_SEMAPHORE, v12, timelineSemaphore),
    ALONE(ScalarBlockLayout, SCALAR_BLOCK_LAYOUT, v12, scalarBlockLayout),
    ALONE(16BitStorage, 16BIT_STORAGE, v11, storageBuffer16BitAccess),
    ALONE(16BitStorage, 16BIT_STORAGE, v11, uniformAndStorageBuffer16BitAccess),
};

static void read_alone(const VkBaseInStructure *from, vk_features *out) {
    for (size_t i = 0; i < COUNT_OF(alone); i++)
        if (from->sType == alone[i].type)
            memcpy((char *)out + alone[i].to, (const char *)from + alone[i].from, sizeof(VkBool32));
}

// What a host enabled, in the structs of core versions or in those of the features alone.
void vk_features_of_host(const void *chain, vk_features *out) {
    memset(out, 0, sizeof *out);
    vk_features_chain(out);
    for (const VkBaseInStructure *at = chain; at; at = at->pNext) {
        switch (at->sType) {
        case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2:
            out->core.features = ((const VkPhysicalDeviceFeatures2 *)at)->features;
            break;
        case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES:
            out->v11 = *(const VkPhysicalDeviceVulkan11Features *)at;
            break;
        case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES:
            out->v12 = *(const VkPhysicalDeviceVulkan12Features *)at;
            break;
        case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES:
            out->v13 = *(const VkPhysicalDeviceVulkan13Features *)at;
            break;
        default:
            read_alone(at, out);
            break;
        }
    }
    vk_features_chain(out);
}
