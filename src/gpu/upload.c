// Data from the host, through a staging ring.
//
// Data goes in pieces of at most a quarter of the ring. When the ring is full between frames, what
// was recorded is submitted and the oldest part waited for. Inside a frame nothing can be submitted
// early, so such a piece gets a staging buffer of its own, which dies with the frame.
#include "gpu/vk.h"
#include <inttypes.h>
#include <string.h>

enum { RING_SIZE = 16 << 20, PIECE_SIZE = RING_SIZE / 4, PIECE_ALIGN = 16 };

typedef struct piece {
    gpu_buffer *buffer;
    uint64_t offset;
    void *map;
    bool own; // of this piece alone
} piece;

void vk_ring_mark(gpu *g) {
    vk_ring *ring = &g->ring;
    uint64_t marked = ring->mark_count > 0 ? ring->marks[ring->mark_count - 1].head : ring->tail;
    if (ring->head == marked) return;
    if (ring->mark_count < sizeof ring->marks / sizeof *ring->marks) ring->mark_count++;
    // With no mark left the newest one is moved on: its part is freed later than it could be.
    ring->marks[ring->mark_count - 1].head = ring->head;
    ring->marks[ring->mark_count - 1].serial = g->submitted;
}

static void ring_reclaim(vk_ring *ring, uint64_t completed) {
    uint32_t done = 0;
    while (done < ring->mark_count && ring->marks[done].serial <= completed) {
        ring->tail = ring->marks[done++].head;
    }
    ring->mark_count -= done;
    memmove(ring->marks, ring->marks + done, ring->mark_count * sizeof *ring->marks);
}

static bool ring_take(vk_ring *ring, uint64_t size, uint64_t *offset) {
    uint64_t at = (ring->head + PIECE_ALIGN - 1) & ~(uint64_t)(PIECE_ALIGN - 1);
    if (at % ring->size + size > ring->size) at += ring->size - at % ring->size; // never wraps
    if (at + size - ring->tail > ring->size) return false;
    *offset = at % ring->size;
    ring->head = at + size;
    return true;
}

static gpu_buffer *staging_create(gpu *g, uint64_t size) {
    return vk_buffer_create(g, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VK_MEMORY_UPLOAD, "staging");
}

static bool piece_alone(gpu *g, uint64_t size, piece *out) {
    gpu_buffer *buffer = staging_create(g, size);
    if (!buffer) return false;
    *out = (piece){.buffer = buffer, .map = vk_memory_map(&buffer->memory), .own = true};
    return true;
}

static bool piece_take(gpu *g, uint64_t size, piece *out) {
    vk_ring *ring = &g->ring;
    if (!ring->buffer) {
        ring->buffer = staging_create(g, RING_SIZE);
        if (!ring->buffer) return false;
        ring->size = RING_SIZE;
    }
    uint64_t offset;
    ring_reclaim(ring, vk_completed(g));
    while (!ring_take(ring, size, &offset)) {
        if (g->frame) return piece_alone(g, size, out);
        if (!vk_flush(g)) return false;
        if (ring->mark_count == 0) return piece_alone(g, size, out);
        if (!vk_wait(g, ring->marks[0].serial)) return false;
        ring_reclaim(ring, g->completed);
    }
    *out = (piece){.buffer = ring->buffer,
                   .offset = offset,
                   .map = (char *)vk_memory_map(&ring->buffer->memory) + offset};
    return true;
}

static void piece_drop(gpu *g, piece *p) {
    if (p->own) gpu_buffer_destroy(g, p->buffer);
}

static bool copy_rows(gpu *g, gpu_image *image, uint32_t mip, const VkOffset3D *at,
                      const VkExtent3D *extent, const void *data, uint64_t size) {
    piece p;
    if (!piece_take(g, size, &p)) return false;
    memcpy(p.map, data, size);
    VkCommandBuffer commands = vk_commands(g);
    if (commands) {
        VkBufferImageCopy region = {
            .bufferOffset = p.offset,
            .imageSubresource = {.aspectMask = image->aspect, .mipLevel = mip, .layerCount = 1},
            .imageOffset = *at,
            .imageExtent = *extent};
        g->vk.CmdCopyBufferToImage(commands, p.buffer->handle, image->handle,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    }
    piece_drop(g, &p);
    return commands != VK_NULL_HANDLE;
}

// Whole slices while they fit into a piece, else rows of one slice. The pieces do not overlap, so
// one barrier before the first serves all; `piece_take` may submit between them, and a barrier also
// orders later submissions.
bool gpu_image_write(gpu *g, gpu_image *image, uint32_t mip, const void *data, size_t size) {
    if (!vk_alive(g)) return false;
    if (mip >= image->desc.mips) {
        return err_set("image '%s' has no level %u, only %u levels", image->desc.label, mip,
                       image->desc.mips);
    }
    VkExtent3D extent;
    uint64_t bytes;
    vk_image_extent(image, mip, &extent, &bytes);
    if (size != bytes) {
        return err_set("image '%s', level %u: %zu bytes given; %" PRIu64 " are needed",
                       image->desc.label, mip, size, bytes);
    }
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return false;
    vk_uses_begin(g);
    vk_use_image(g, image, mip, 1, vk_image_to);
    vk_uses_flush(g, commands);

    uint64_t row = bytes / extent.height / extent.depth, slice = row * extent.height;
    uint32_t slices = slice <= PIECE_SIZE ? (uint32_t)(PIECE_SIZE / slice) : 1;
    uint32_t rows = slice <= PIECE_SIZE ? extent.height : (uint32_t)(PIECE_SIZE / row);
    const char *bytes_left = data;
    for (uint32_t z = 0; z < extent.depth; z += slices) {
        for (uint32_t y = 0; y < extent.height; y += rows) {
            VkExtent3D part = {extent.width, extent.height - y < rows ? extent.height - y : rows,
                               extent.depth - z < slices ? extent.depth - z : slices};
            VkOffset3D at = {0, (int32_t)y, (int32_t)z};
            uint64_t part_size = row * part.height * part.depth;
            if (!copy_rows(g, image, mip, &at, &part, bytes_left, part_size)) return false;
            bytes_left += part_size;
        }
    }
    return true;
}

static bool copy_bytes(gpu *g, gpu_buffer *buffer, uint64_t offset, const void *data,
                       uint64_t size) {
    piece p;
    if (!piece_take(g, size, &p)) return false;
    memcpy(p.map, data, size);
    VkCommandBuffer commands = vk_commands(g);
    if (commands) {
        VkBufferCopy region = {.srcOffset = p.offset, .dstOffset = offset, .size = size};
        g->vk.CmdCopyBuffer(commands, p.buffer->handle, buffer->handle, 1, &region);
    }
    piece_drop(g, &p);
    return commands != VK_NULL_HANDLE;
}

bool gpu_buffer_write(gpu *g, gpu_buffer *buffer, uint64_t offset, const void *data, size_t size) {
    if (!vk_alive(g)) return false;
    if (offset > buffer->size || size > buffer->size - offset) {
        return err_set("buffer '%s': bytes %" PRIu64 " to %" PRIu64 " of %" PRIu64, buffer->label,
                       offset, offset + size, buffer->size);
    }
    if (size == 0) return true;
    VkCommandBuffer commands = vk_commands(g);
    if (!commands) return false;
    vk_uses_begin(g);
    vk_use_buffer(g, buffer, vk_buffer_to);
    vk_uses_flush(g, commands);
    for (uint64_t done = 0; done < size;) {
        uint64_t part = size - done < PIECE_SIZE ? size - done : PIECE_SIZE;
        if (!copy_bytes(g, buffer, offset + done, (const char *)data + done, part)) return false;
        done += part;
    }
    return true;
}
