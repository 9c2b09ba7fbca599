// The pipeline cache on disk.
//
// Drivers trust what they are given, so the file is wrapped: a magic word, the size and a hash of
// the driver's data, and the data, whose own header must name this very device and driver. Anything
// else is ignored, and the cache starts empty.
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "gpu/vk.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { CACHE_MAX = 256 << 20 };

typedef struct cache_head {
    char magic[8];
    uint64_t size, hash; // of the data that follows
} cache_head;

static const char cache_magic[8] = "roilpc1";

bool vk_cache_pack(const void *data, size_t size, void **out, size_t *out_size) {
    if (size == 0 || size > CACHE_MAX - sizeof(cache_head)) return false;
    cache_head head = {.size = size, .hash = hash64(data, size)};
    memcpy(head.magic, cache_magic, sizeof head.magic);
    *out_size = sizeof head + size;
    *out = mem_alloc(*out_size);
    memcpy(*out, &head, sizeof head);
    memcpy((char *)*out + sizeof head, data, size);
    return true;
}

const void *vk_cache_unpack(const void *file, size_t size, const VkPhysicalDeviceProperties *device,
                            size_t *out_size) {
    cache_head head;
    VkPipelineCacheHeaderVersionOne inner;
    if (size < sizeof head + sizeof inner) return NULL;
    memcpy(&head, file, sizeof head);
    const char *data = (const char *)file + sizeof head;
    if (memcmp(head.magic, cache_magic, sizeof head.magic) != 0) return NULL;
    if (head.size != size - sizeof head || head.hash != hash64(data, size - sizeof head)) {
        return NULL;
    }
    memcpy(&inner, data, sizeof inner);
    if (inner.headerVersion != VK_PIPELINE_CACHE_HEADER_VERSION_ONE ||
        inner.vendorID != device->vendorID || inner.deviceID != device->deviceID ||
        memcmp(inner.pipelineCacheUUID, device->pipelineCacheUUID, VK_UUID_SIZE) != 0) {
        return NULL;
    }
    *out_size = size - sizeof head;
    return data;
}

static void choose_path(gpu *g, const char *dir, const VkPhysicalDeviceProperties *device) {
    char name[64], path[PATH_CAP];
    snprintf(name, sizeof name, "pipelines-%04x-%04x-%016" PRIx64 ".bin", device->vendorID,
             device->deviceID, hash64(device->pipelineCacheUUID, VK_UUID_SIZE));
    if (path_join(path, dir, name)) g->cache_path = mem_copy(path, strlen(path) + 1);
}

bool vk_cache_create(gpu *g, const char *dir) {
    VkPhysicalDeviceProperties2 two = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    g->vk.GetPhysicalDeviceProperties2(g->physical, &two);
    const VkPhysicalDeviceProperties *device = &two.properties;
    void *file = NULL;
    size_t file_size = 0;
    VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    if (dir) choose_path(g, dir, device);
    if (g->cache_path && file_exists(g->cache_path) &&
        file_read(g->cache_path, CACHE_MAX, &file, &file_size)) {
        info.pInitialData = vk_cache_unpack(file, file_size, device, &info.initialDataSize);
        if (info.pInitialData) g->cache_hash = hash64(info.pInitialData, info.initialDataSize);
    }
    VkResult result = g->vk.CreatePipelineCache(g->device, &info, NULL, &g->cache);
    if (result != VK_SUCCESS && info.pInitialData) {
        info.pInitialData = NULL;
        info.initialDataSize = 0;
        result = g->vk.CreatePipelineCache(g->device, &info, NULL, &g->cache);
    }
    mem_free(file);
    return vk_check(g, result, "creating the pipeline cache");
}

static void save(gpu *g) {
    size_t size = 0, file_size;
    void *file = NULL;
    if (g->vk.GetPipelineCacheData(g->device, g->cache, &size, NULL) != VK_SUCCESS || size == 0)
        return;
    void *data = mem_alloc(size);
    if (g->vk.GetPipelineCacheData(g->device, g->cache, &size, data) == VK_SUCCESS &&
        hash64(data, size) != g->cache_hash && vk_cache_pack(data, size, &file, &file_size)) {
        if (!file_make_parent_folders(g->cache_path) ||
            !file_write(g->cache_path, file, file_size)) {
            log_write(LOG_WARNING, "the pipeline cache was not saved: %s", err_get());
        }
    }
    mem_free(file);
    mem_free(data);
}

void vk_cache_destroy(gpu *g) {
    if (!g->cache) return;
    if (g->cache_path && !atomic_load(&g->lost)) save(g);
    g->vk.DestroyPipelineCache(g->device, g->cache, NULL);
    g->cache = VK_NULL_HANDLE;
}
