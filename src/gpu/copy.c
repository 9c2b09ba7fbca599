// Clearing, copying and reading back.
#include "gpu/vk.h"
#include <inttypes.h>
#include <string.h>

void gpu_image_clear(gpu *g, gpu_image *image, const float color[4]) {
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return;
    vk_uses_begin(g);
    vk_use_image(g, image, 0, image->desc.mips, vk_image_to);
    vk_uses_flush(g, commands);
    VkImageSubresourceRange range = {
        .aspectMask = image->aspect, .levelCount = image->desc.mips, .layerCount = 1};
    if (image->desc.format == GPU_D32F) {
        float depth = color[0] < 0.0f ? 0.0f : color[0] > 1.0f ? 1.0f : color[0];
        VkClearDepthStencilValue value = {.depth = depth};
        g->vk.CmdClearDepthStencilImage(commands, image->handle,
                                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
        return;
    }
    VkClearColorValue value = vk_clear_color(image, color);
    g->vk.CmdClearColorImage(commands, image->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value,
                             1, &range);
}

void gpu_buffer_fill(gpu *g, gpu_buffer *buffer, uint32_t word) {
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return;
    vk_uses_begin(g);
    vk_use_buffer(g, buffer, vk_buffer_to);
    vk_uses_flush(g, commands);
    g->vk.CmdFillBuffer(commands, buffer->handle, 0, VK_WHOLE_SIZE, word);
}

bool gpu_image_copy_to_buffer(gpu *g, gpu_image *image, gpu_buffer *buffer, uint64_t offset) {
    VkExtent3D extent;
    uint64_t bytes;
    vk_image_extent(image, 0, &extent, &bytes);
    if (offset > buffer->size || bytes > buffer->size - offset) {
        return err_set("image '%s' needs %" PRIu64 " bytes at %" PRIu64
                       " of buffer '%s', which has %" PRIu64,
                       image->desc.label, bytes, offset, buffer->label, buffer->size);
    }
    uint32_t texel = gpu_format_size(image->desc.format);
    if (offset % texel != 0) {
        return err_set("image '%s' cannot be copied to byte %" PRIu64
                       " of buffer '%s'; a multiple of %u is accepted",
                       image->desc.label, offset, buffer->label, texel);
    }
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return false;
    vk_uses_begin(g);
    vk_use_image(g, image, 0, 1, vk_image_from);
    vk_use_buffer(g, buffer, vk_buffer_to);
    vk_uses_flush(g, commands);
    VkBufferImageCopy region = {.bufferOffset = offset,
                                .imageSubresource = {.aspectMask = image->aspect, .layerCount = 1},
                                .imageExtent = extent};
    g->vk.CmdCopyImageToBuffer(commands, image->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               buffer->handle, 1, &region);
    return true;
}

static bool copy_bytes(gpu *g, gpu_buffer *from, uint64_t offset, gpu_buffer *to, uint64_t size) {
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return false;
    vk_uses_begin(g);
    vk_use_buffer(g, from, vk_buffer_from);
    vk_use_buffer(g, to, vk_buffer_to);
    vk_uses_flush(g, commands);
    VkBufferCopy region = {.srcOffset = offset, .size = size};
    g->vk.CmdCopyBuffer(commands, from->handle, to->handle, 1, &region);
    return true;
}

bool gpu_buffer_copy(gpu *g, gpu_buffer *from, gpu_buffer *to, uint64_t size) {
    if (size > from->size || size > to->size || from == to) {
        return err_set("%" PRIu64 " bytes cannot be copied from buffer '%s' (%" PRIu64
                       ") to '%s' (%" PRIu64 "); another buffer of that size is accepted",
                       size, from->label, from->size, to->label, to->size);
    }
    return size == 0 || copy_bytes(g, from, 0, to, size);
}

static bool check_copy(const gpu_image *from, const gpu_image *to) {
    VkExtent3D extent, other;
    uint64_t bytes;
    vk_image_extent(from, 0, &extent, &bytes);
    vk_image_extent(to, 0, &other, &bytes);
    return (from != to && from->desc.format == to->desc.format &&
            memcmp(&extent, &other, sizeof extent) == 0) ||
           err_set("image '%s' cannot be copied to '%s'; another image of its format and size is "
                   "accepted",
                   from->desc.label, to->desc.label);
}

static bool copy_regions(gpu *g, gpu_image *from, gpu_image *to, VkImageCopy *regions,
                         uint32_t count) {
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return false;
    vk_uses_begin(g);
    vk_use_image(g, from, 0, 1, vk_image_from);
    vk_use_image(g, to, 0, 1, vk_image_to);
    vk_uses_flush(g, commands);
    for (uint32_t i = 0; i < count; i++)
        regions[i].srcSubresource = regions[i].dstSubresource =
            (VkImageSubresourceLayers){.aspectMask = from->aspect, .layerCount = 1};
    g->vk.CmdCopyImage(commands, from->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to->handle,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, count, regions);
    return true;
}

bool gpu_image_copy(gpu *g, gpu_image *from, gpu_image *to) {
    if (!check_copy(from, to)) return false;
    VkImageCopy whole = {.extent = {0}};
    uint64_t bytes;
    vk_image_extent(from, 0, &whole.extent, &bytes);
    return copy_regions(g, from, to, &whole, 1);
}

bool gpu_image_copy_areas(gpu *g, gpu_image *from, gpu_image *to, const gpu_area *areas,
                          size_t count) {
    VkImageCopy regions[GPU_MAX_AREAS] = {{.extent = {0}}};
    if (!check_copy(from, to)) return false;
    if (count > GPU_MAX_AREAS)
        return err_set("%zu areas of image '%s'; at most %d are copied at once", count,
                       from->desc.label, GPU_MAX_AREAS);
    for (size_t i = 0; i < count; i++) {
        const gpu_area *a = &areas[i];
        const gpu_image_desc *size = &from->desc;
        if (!a->width || !a->height || a->x > size->width || a->width > size->width - a->x ||
            a->y > size->height || a->height > size->height - a->y)
            return err_set("area %zu is not inside of image '%s'", i, from->desc.label);
        regions[i].srcOffset = regions[i].dstOffset = (VkOffset3D){(int32_t)a->x, (int32_t)a->y, 0};
        regions[i].extent = (VkExtent3D){a->width, a->height, size->depth ? size->depth : 1};
    }
    return !count || copy_regions(g, from, to, regions, (uint32_t)count);
}

// ---- reading back -----------------------------------------------------------------------------

static bool between_frames(gpu *g, const char *label) {
    if (!vk_alive(g)) return false;
    if (g->frame) return err_set("'%s' cannot be read while a frame is open", label);
    return true;
}

static gpu_buffer *target_create(gpu *g, uint64_t size, const char *label) {
    gpu_buffer_desc desc = {.label = label, .size = size, .kind = GPU_BUFFER_READBACK};
    return gpu_buffer_create(g, &desc);
}

bool gpu_image_read(gpu *g, gpu_image *image, void *out, size_t size) {
    if (!between_frames(g, image->desc.label)) return false;
    VkExtent3D extent;
    uint64_t bytes;
    vk_image_extent(image, 0, &extent, &bytes);
    if (size != bytes) {
        return err_set("image '%s' has %" PRIu64 " bytes; room for %zu was given",
                       image->desc.label, bytes, size);
    }
    gpu_buffer *target = target_create(g, bytes, image->desc.label);
    if (!target) return false;
    bool ok = gpu_image_copy_to_buffer(g, image, target, 0) && gpu_idle(g);
    if (ok) memcpy(out, gpu_buffer_map(target), size);
    gpu_buffer_destroy(g, target);
    return ok;
}

bool gpu_buffer_read(gpu *g, gpu_buffer *buffer, uint64_t offset, void *out, size_t size) {
    if (!between_frames(g, buffer->label)) return false;
    if (offset > buffer->size || size > buffer->size - offset) {
        return err_set("buffer '%s': bytes %" PRIu64 " to %" PRIu64 " of %" PRIu64, buffer->label,
                       offset, offset + size, buffer->size);
    }
    if (size == 0) return true;
    if (buffer->kind == GPU_BUFFER_READBACK) {
        if (!gpu_idle(g)) return false;
        memcpy(out, (const char *)gpu_buffer_map(buffer) + offset, size);
        return true;
    }
    gpu_buffer *target = target_create(g, size, buffer->label);
    if (!target) return false;
    bool ok = copy_bytes(g, buffer, offset, target, size) && gpu_idle(g);
    if (ok) memcpy(out, gpu_buffer_map(target), size);
    gpu_buffer_destroy(g, target);
    return ok;
}
