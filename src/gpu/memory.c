// Device memory: blocks of 64 MiB per memory type, handed out in parts.
//
// Images and buffers never share a block, so bufferImageGranularity, which only rules neighbours of
// different kind, is respected by construction. Objects larger than half a block get memory of
// their own. Empty blocks go back to the driver, except the last of its sort.
//
// A block is taken from the budget whole, as spare; an object in it takes its bytes from the spare
// ones under its own label. So the sum is what the driver gave, whatever lies in it.
#include "base/memory.h"
#include "gpu/vk.h"
#include <inttypes.h>

static const uint64_t block_size = UINT64_C(64) << 20;

// Memory properties in order of preference; the specification promises the last of each kind.
static uint32_t find_type(const gpu *g, uint32_t allowed, vk_memory_kind kind) {
    enum {
        LOCAL = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
        HOST = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
        CACHED = VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
    };
    static const VkMemoryPropertyFlags wishes[][2] = {
        [VK_MEMORY_DEVICE] = {LOCAL, 0},
        [VK_MEMORY_UPLOAD] = {HOST, HOST},
        [VK_MEMORY_UNIFORM] = {HOST | LOCAL, HOST},
        [VK_MEMORY_READBACK] = {HOST | CACHED, HOST},
    };
    for (int wish = 0; wish < 2; wish++) {
        VkMemoryPropertyFlags flags = wishes[kind][wish];
        for (uint32_t i = 0; i < g->heaps.memoryTypeCount; i++) {
            bool fits = (g->heaps.memoryTypes[i].propertyFlags & flags) == flags;
            if ((allowed >> i & 1) && fits) return i;
        }
    }
    return UINT32_MAX;
}

// Of vk_pool.budgets.
static int side_of(const gpu *g, uint32_t type) {
    const VkMemoryHeap *heap = &g->heaps.memoryHeaps[g->heaps.memoryTypes[type].heapIndex];
    return (heap->flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0;
}

// `label` is who wants it, for the message.
static bool add_spare(gpu *g, int side, uint64_t size, const char *label) {
    budget_part *more = budget_take(g->pool.budgets[side], size, label);
    if (!more) return false;
    budget_move(more, g->pool.spare[side], size);
    budget_give(more);
    return true;
}

static void drop_spare(gpu *g, int side, uint64_t size) {
    budget_part *gone = budget_take(g->pool.budgets[side], 0, "");
    budget_move(g->pool.spare[side], gone, size);
    budget_give(gone);
}

static void block_destroy(gpu *g, vk_block *block) {
    if (block->memory) {
        g->pool.reserved -= block->spans.size;
        drop_spare(g, side_of(g, block->type), block->spans.size);
        g->vk.FreeMemory(g->device, block->memory, NULL);
    }
    allocator_deinit(&block->spans);
    mem_free(block);
}

static VkResult block_allocate(gpu *g, uint64_t size, uint32_t type, VkDeviceMemory *out) {
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .allocationSize = size,
                                 .memoryTypeIndex = type};
    return g->vk.AllocateMemory(g->device, &info, NULL, out);
}

static vk_block *block_create(gpu *g, uint64_t size, uint32_t type, bool image, const char *label) {
    VkDeviceMemory memory;
    int side = side_of(g, type);
    // What was let go but not yet destroyed may make room.
    if (!add_spare(g, side, size, label) &&
        (g->frame || !gpu_idle(g) || !add_spare(g, side, size, label)))
        return NULL;
    VkResult result = block_allocate(g, size, type, &memory);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY && !g->frame && gpu_idle(g)) {
        result = block_allocate(g, size, type, &memory);
    }
    if (!vk_check(g, result,
                  "'%s' needs %" PRIu64 " MiB of device memory, %" PRIu64 " MiB are taken", label,
                  (size + (1 << 20) - 1) >> 20, g->pool.reserved >> 20)) {
        drop_spare(g, side, size);
        return NULL;
    }
    vk_block *block = mem_alloc(sizeof *block);
    *block = (vk_block){.memory = memory, .type = type, .image = image};
    allocator_init(&block->spans, size);
    g->pool.reserved += size;
    if (g->heaps.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
        void *map = NULL;
        result = g->vk.MapMemory(g->device, memory, 0, VK_WHOLE_SIZE, 0, &map);
        if (!vk_check(g, result, "mapping the memory of '%s'", label)) {
            block_destroy(g, block);
            return NULL;
        }
        block->map = map;
    }
    *MEM_ADD(g->pool.blocks, g->pool.count, g->pool.capacity) = block;
    return block;
}

static bool take(gpu *g, vk_block *block, const VkMemoryRequirements *needs, const char *label,
                 vk_memory *out) {
    int side = side_of(g, block->type);
    if (!allocator_alloc(&block->spans, needs->size, needs->alignment, &out->place)) return false;
    out->block = block;
    out->size = needs->size;
    out->part = budget_take(g->pool.budgets[side], 0, label); // of nothing: is never refused
    budget_move(g->pool.spare[side], out->part, needs->size);
    g->pool.used += needs->size;
    return true;
}

bool vk_memory_alloc(gpu *g, const VkMemoryRequirements *needs, vk_memory_kind kind, bool image,
                     const char *label, vk_memory *out) {
    *out = (vk_memory){0};
    uint32_t type = find_type(g, needs->memoryTypeBits, kind);
    if (type == UINT32_MAX) return err_set("'%s': the device has no memory of this sort", label);
    if (needs->size > g->max_allocation) {
        return err_set("'%s' needs %" PRIu64 " MiB; the device allows %" PRIu64 " MiB an object",
                       label, needs->size >> 20, g->max_allocation >> 20);
    }
    uint64_t heap = g->heaps.memoryHeaps[g->heaps.memoryTypes[type].heapIndex].size;
    uint64_t size = heap / 16 < block_size ? heap / 16 : block_size;
    uint64_t limit = budget_get_limit(g->pool.budgets[side_of(g, type)]);
    if (size > limit / 32) size = limit / 32; // a small limit is for objects, not for spare bytes
    bool single = needs->size > size / 2;
    for (size_t i = 0; i < g->pool.count && !single; i++) {
        vk_block *block = g->pool.blocks[i];
        if (block->type != type || block->image != image || block->single) continue;
        if (take(g, block, needs, label, out)) return true;
    }
    vk_block *block = block_create(g, single ? needs->size : size, type, image, label);
    if (!block) return false;
    block->single = single;
    return take(g, block, needs, label, out);
}

static bool has_twin(const gpu *g, const vk_block *block) {
    for (size_t i = 0; i < g->pool.count; i++) {
        const vk_block *other = g->pool.blocks[i];
        if (other != block && other->type == block->type && other->image == block->image &&
            !other->single) {
            return true;
        }
    }
    return false;
}

void vk_memory_free(gpu *g, vk_memory *memory) {
    vk_block *block = memory->block;
    if (!block) return;
    allocator_free(&block->spans, memory->place.span);
    g->pool.used -= memory->size;
    budget_move(memory->part, g->pool.spare[side_of(g, block->type)], memory->size);
    budget_give(memory->part);
    *memory = (vk_memory){0};
    if (block->spans.used > 0 || !(block->single || has_twin(g, block))) return;
    for (size_t i = 0; i < g->pool.count; i++) {
        if (g->pool.blocks[i] == block) g->pool.blocks[i] = g->pool.blocks[--g->pool.count];
    }
    block_destroy(g, block);
}

void *vk_memory_map(const vk_memory *memory) {
    if (!memory->block || !memory->block->map) return NULL;
    return memory->block->map + memory->place.offset;
}

void vk_pool_init(gpu *g, uint64_t limit) {
    bool shared = g->profile.shares_memory;
    g->pool.budgets[0] = budget_host();
    budget *all = shared ? budget_host() : budget_create("device memory", g->info.memory);
    g->pool.budgets[1] = all;
    if (limit) {
        g->pool.whole = all;
        g->pool.budgets[1] =
            budget_create_within(all, "device memory", limit, "`device_memory` of roil_desc");
    }
    for (int side = 0; side < 2; side++)
        g->pool.spare[side] =
            budget_take(g->pool.budgets[side], 0, "room in blocks of the device's memory");
}

void vk_pool_deinit(gpu *g) {
    for (size_t i = 0; i < g->pool.count; i++) block_destroy(g, g->pool.blocks[i]);
    mem_free(g->pool.blocks);
    for (int side = 0; side < 2; side++) budget_give(g->pool.spare[side]);
    if (g->pool.budgets[1]) budget_destroy(g->pool.budgets[1]);
    if (g->pool.whole) budget_destroy(g->pool.whole);
    g->pool = (vk_pool){0};
}

uint64_t gpu_image_bytes(const gpu_image_desc *d) {
    uint64_t bytes = 0, width = d->width, height = d->height, depth = d->depth ? d->depth : 1;
    for (uint32_t i = 0; i < (d->mips ? d->mips : 1); i++) {
        bytes += width * height * depth * gpu_format_size(d->format);
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
        depth = depth > 1 ? depth / 2 : 1;
    }
    return bytes;
}

bool gpu_memory_fits(gpu *g, const budget_list *wanted, uint64_t freed) {
    budget *all = g->pool.budgets[1];
    if (budget_ask(all, wanted->rows, wanted->count, freed)) return true;
    // Retired objects may still count.
    return !g->frame && gpu_idle(g) && budget_ask(all, wanted->rows, wanted->count, freed);
}

void gpu_lend_memory(gpu *g, const gpu_image_desc *going, size_t count) {
    uint64_t bytes = 0;
    for (size_t i = 0; i < count; i++) bytes += gpu_image_bytes(&going[i]);
    budget_lend(g->pool.budgets[1], bytes);
}

budget *gpu_get_budget(const gpu *g) {
    return g->pool.budgets[1];
}

gpu_memory_use gpu_get_memory_use(const gpu *g) {
    return (gpu_memory_use){
        .used = g->pool.used, .reserved = g->pool.reserved, .blocks = (uint32_t)g->pool.count};
}
