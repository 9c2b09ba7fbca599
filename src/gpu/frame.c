// Frames in flight: each slot has its command buffer, uniform memory and timestamps, and is used
// again once the frame that had it before has finished.
#include "base/memory.h"
#include "gpu/vk.h"
#include <assert.h>
#include <inttypes.h>
#include <string.h>

static const uint64_t uniform_chunk = 256 << 10;
static const uint64_t uniform_largest = 64 << 10;

static vk_frame *slot_of(gpu *g, uint64_t frame) {
    vk_frame *slot = &g->frames[frame % GPU_FRAMES_IN_FLIGHT];
    return slot->number == frame ? slot : NULL;
}

uint64_t gpu_frame_begin(gpu *g) {
    assert(!g->frame);
    if (!vk_flush(g)) return 0;
    uint64_t number = g->frame_number + 1;
    vk_frame *frame = &g->frames[number % GPU_FRAMES_IN_FLIGHT];
    if (!vk_batch_begin(g, &frame->batch)) return 0;
    g->frame_number = number;
    g->frame = frame;
    g->in_pass = false;
    g->window.shows = false;
    frame->number = number;
    frame->uniforms.chunk = 0;
    frame->uniforms.offset = 0;
    vk_timer_begin(g, &frame->timer, frame->batch.commands);
    vk_collect(g);
    return number;
}

bool gpu_frame_end(gpu *g) {
    assert(g->frame && !g->in_pass);
    vk_frame *frame = g->frame;
    if (!frame) return err_set("no frame is open");
    g->frame = NULL;
    if (!vk_alive(g)) return false;
    if (!vk_batch_submit(g, &frame->batch)) return false;
    vk_collect(g);
    return vk_alive(g) && vk_present(g); // that may have been found lost by now
}

bool gpu_frame_wait(gpu *g, uint64_t frame) {
    if (!vk_alive(g)) return false;
    if (frame > g->frame_number) return err_set("frame %" PRIu64 " was never begun", frame);
    vk_frame *slot = slot_of(g, frame);
    if (!slot) return true; // its slot is in use again, so it has finished
    if (slot == g->frame) return err_set("frame %" PRIu64 " is still open", frame);
    if (!vk_wait(g, slot->batch.serial)) return false;
    vk_collect(g);
    return true;
}

bool gpu_frame_done(gpu *g, uint64_t frame) {
    if (frame > g->frame_number) return false;
    const vk_frame *slot = slot_of(g, frame);
    return !slot || (slot != g->frame && vk_completed(g) >= slot->batch.serial);
}

uint64_t gpu_frame_open(const gpu *g) {
    return g->frame ? g->frame->number : 0;
}

static bool next_chunk(gpu *g, vk_uniforms *u) {
    size_t next = u->count > 0 ? u->chunk + 1 : 0;
    if (next == u->count) {
        gpu_buffer *buffer = vk_buffer_create(g, uniform_chunk, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                              VK_MEMORY_UNIFORM, "uniforms");
        if (!buffer) return false;
        *MEM_ADD(u->chunks, u->count, u->capacity) = buffer;
    }
    u->chunk = next;
    u->offset = 0;
    return true;
}

// Chunks are never given back before the device: a frame that needed them once will do so again.
bool vk_uniforms_add(gpu *g, const void *data, size_t size, VkDescriptorBufferInfo *out) {
    vk_uniforms *u = &g->frame->uniforms;
    uint64_t largest = g->limits.maxUniformBufferRange;
    if (largest > uniform_largest) largest = uniform_largest;
    if (size == 0 || size > largest) {
        return err_set("a uniform block of %zu bytes; 1 to %" PRIu64 " are accepted", size,
                       largest);
    }
    uint64_t align = g->limits.minUniformBufferOffsetAlignment;
    uint64_t offset = (u->offset + align - 1) & ~(align - 1);
    if (u->count == 0 || offset + size > uniform_chunk) {
        if (!next_chunk(g, u)) return false;
        offset = 0;
    }
    gpu_buffer *chunk = u->chunks[u->chunk];
    memcpy((char *)vk_memory_map(&chunk->memory) + offset, data, size);
    u->offset = offset + size;
    *out = (VkDescriptorBufferInfo){.buffer = chunk->handle, .offset = offset, .range = size};
    return true;
}
