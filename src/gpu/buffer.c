// Buffers: the two kinds of gpu.h, and the host-visible ones that this layer needs itself.
#include "base/memory.h"
#include "gpu/vk.h"
#include <inttypes.h>
#include <string.h>

static void buffer_free(gpu *g, void *object) {
    gpu_buffer *buffer = object;
    g->vk.DestroyBuffer(g->device, buffer->handle, NULL);
    vk_memory_free(g, &buffer->memory);
    mem_free(buffer->label);
    mem_free(buffer);
}

gpu_buffer *vk_buffer_create(gpu *g, uint64_t size, VkBufferUsageFlags usage, vk_memory_kind kind,
                             const char *label) {
    if (!vk_alive(g)) return NULL;
    vk_collect(g);
    if (!label) label = "buffer";
    if (size == 0 || size > g->max_buffer) {
        err_set("buffer '%s': %" PRIu64 " bytes; 1 to %" PRIu64 " are accepted", label, size,
                g->max_buffer);
        return NULL;
    }
    gpu_buffer *buffer = mem_alloc(sizeof *buffer);
    buffer->label = mem_copy(label, strlen(label) + 1);
    buffer->size = size;
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                               .size = (size + 3) & ~UINT64_C(3), // fills count in words
                               .usage = usage};
    VkResult result = g->vk.CreateBuffer(g->device, &info, NULL, &buffer->handle);
    if (!vk_check(g, result, "creating buffer '%s'", label)) {
        buffer_free(g, buffer);
        return NULL;
    }
    VkMemoryRequirements needs;
    g->vk.GetBufferMemoryRequirements(g->device, buffer->handle, &needs);
    if (!vk_memory_alloc(g, &needs, kind, false, label, &buffer->memory) ||
        !vk_check(g,
                  g->vk.BindBufferMemory(g->device, buffer->handle, buffer->memory.block->memory,
                                         buffer->memory.place.offset),
                  "binding memory to buffer '%s'", label)) {
        buffer_free(g, buffer);
        return NULL;
    }
    vk_name(g, VK_OBJECT_TYPE_BUFFER, VK_HANDLE(buffer->handle), label);
    return buffer;
}

gpu_buffer *gpu_buffer_create(gpu *g, const gpu_buffer_desc *desc) {
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    bool readback = desc->kind == GPU_BUFFER_READBACK;
    if (!readback) {
        usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
        if (desc->size > g->info.max_storage_range) {
            err_set("buffer '%s': %" PRIu64 " bytes; the device binds at most %" PRIu64,
                    desc->label ? desc->label : "buffer", desc->size, g->info.max_storage_range);
            return NULL;
        }
    }
    gpu_buffer *buffer = vk_buffer_create(
        g, desc->size, usage, readback ? VK_MEMORY_READBACK : VK_MEMORY_DEVICE, desc->label);
    if (buffer) buffer->kind = desc->kind;
    return buffer;
}

bool gpu_buffer_make(gpu *g, gpu_buffer **buffer, const char *label, uint64_t size) {
    if (size == 0 || (*buffer && (*buffer)->size == size)) return true;
    gpu_buffer_destroy(g, *buffer);
    *buffer = gpu_buffer_create(g, &(gpu_buffer_desc){.label = label, .size = size});
    return *buffer != NULL;
}

void gpu_buffer_destroy(gpu *g, gpu_buffer *buffer) {
    if (!buffer) return;
    vk_retire(g, buffer_free, buffer);
}

uint64_t gpu_buffer_size(const gpu_buffer *buffer) {
    return buffer->size;
}

const void *gpu_buffer_map(gpu_buffer *buffer) {
    return buffer->kind == GPU_BUFFER_READBACK ? vk_memory_map(&buffer->memory) : NULL;
}
