// GPU time of each pass: two timestamps, taken when all earlier work has finished. And an event at
// its end, which tells at which pass a device hangs: events can be asked for without waiting, while
// lavapipe waits for all work before it answers about timestamps.
//
// lavapipe at times misses the first timestamp after it was idle and leaves 0 there, so a
// difference is believed only within what the host clock allows: no pass is shorter than nothing or
// longer than the time from the opening of its frame to the moment its results were first asked
// for.
#include "base/clock.h"
#include "base/str.h"
#include "gpu/vk.h"
#include <assert.h>
#include <string.h>

bool vk_timer_create(gpu *g, vk_timer *out) {
    if (g->info.timestamp_period <= 0.0f) return true;
    VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                  .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                  .queryCount = 2 * GPU_MAX_PASSES};
    return vk_check(g, g->vk.CreateQueryPool(g->device, &info, NULL, &out->queries),
                    "creating timestamp queries");
}

void vk_timer_destroy(gpu *g, vk_timer *timer) {
    g->vk.DestroyQueryPool(g->device, timer->queries, NULL);
    for (int i = 0; i < GPU_MAX_PASSES; i++) g->vk.DestroyEvent(g->device, timer->ends[i], NULL);
}

void vk_timer_begin(gpu *g, vk_timer *timer, VkCommandBuffer commands) {
    for (uint32_t i = 0; i < timer->count; i++) {
        if (timer->ends[i]) g->vk.ResetEvent(g->device, timer->ends[i]);
    }
    timer->count = 0;
    timer->longest = 0.0;
    timer->began = clock_seconds();
    if (timer->queries) g->vk.CmdResetQueryPool(commands, timer->queries, 0, 2 * GPU_MAX_PASSES);
}

static void stamp(gpu *g, uint32_t query) {
    if (!g->frame->timer.queries) return;
    g->vk.CmdWriteTimestamp2(g->frame->batch.commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                             g->frame->timer.queries, query);
}

// Without memory for the event a hang goes unnamed, and all else works.
static void mark_end(gpu *g, vk_timer *timer, uint32_t pass) {
    VkEventCreateInfo info = {.sType = VK_STRUCTURE_TYPE_EVENT_CREATE_INFO};
    VkEvent *end = &timer->ends[pass];
    if (!*end && g->vk.CreateEvent(g->device, &info, NULL, end) != VK_SUCCESS) return;
    VkMemoryBarrier2 all = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                            .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    VkDependencyInfo after = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .memoryBarrierCount = 1,
                              .pMemoryBarriers = &all};
    g->vk.CmdSetEvent2(g->frame->batch.commands, *end, &after);
}

const char *vk_timer_running(gpu *g, const vk_timer *timer) {
    for (uint32_t i = 0; i < timer->count; i++) {
        if (!timer->ends[i]) return NULL;
        VkResult status = g->vk.GetEventStatus(g->device, timer->ends[i]);
        if (status == VK_EVENT_RESET) return timer->labels[i];
        if (status != VK_EVENT_SET) return NULL;
    }
    return NULL;
}

void gpu_pass_begin(gpu *g, const char *label) {
    assert(g->frame && !g->in_pass);
    if (!g->frame || atomic_load(&g->lost)) return;
    g->in_pass = true;
    if (g->begin_label) {
        VkDebugUtilsLabelEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                     .pLabelName = label};
        g->begin_label(g->frame->batch.commands, &info);
    }
    vk_timer *timer = &g->frame->timer;
    if (timer->count >= GPU_MAX_PASSES) return; // recorded all the same, but not timed
    str_copy(timer->labels[timer->count], sizeof timer->labels[0], label);
    stamp(g, 2 * timer->count);
}

void gpu_pass_end(gpu *g) {
    if (!g->frame || !g->in_pass) return;
    g->in_pass = false;
    vk_timer *timer = &g->frame->timer;
    if (timer->count < GPU_MAX_PASSES) {
        stamp(g, 2 * timer->count + 1);
        mark_end(g, timer, timer->count++);
    }
    if (g->end_label) g->end_label(g->frame->batch.commands);
}

void gpu_pass_next(gpu *g, const char *label) {
    if (!g->frame || !g->in_pass) return;
    const vk_timer *timer = &g->frame->timer;
    if (timer->count >= GPU_MAX_PASSES || strcmp(timer->labels[timer->count], label) == 0) return;
    gpu_pass_end(g);
    gpu_pass_begin(g, label);
}

static double milliseconds(const gpu *g, const vk_timer *timer, uint64_t begin, uint64_t end) {
    uint64_t mask = g->timestamp_bits >= 64 ? UINT64_MAX : (UINT64_C(1) << g->timestamp_bits) - 1;
    if (begin == 0 || end == 0) return 0.0;
    uint64_t ticks = (end - begin) & mask;
    double value = (double)ticks * (double)g->info.timestamp_period * 1e-6;
    if (ticks > mask / 2) return 0.0; // negative
    return value < timer->longest ? value : timer->longest;
}

size_t gpu_frame_times(gpu *g, uint64_t frame, gpu_pass_time *out, size_t capacity) {
    vk_frame *slot = &g->frames[frame % GPU_FRAMES_IN_FLIGHT];
    if (frame == 0 || slot->number != frame || slot == g->frame) return 0;
    vk_timer *timer = &slot->timer;
    if (timer->count == 0 || !gpu_frame_wait(g, frame)) return 0;
    if (timer->longest <= 0.0) timer->longest = (clock_seconds() - timer->began) * 1e3;

    uint64_t ticks[2 * GPU_MAX_PASSES] = {0};
    if (timer->queries) {
        if (!vk_wait_where_driver_would(g)) return 0;
        VkResult result =
            g->vk.GetQueryPoolResults(g->device, timer->queries, 0, 2 * timer->count, sizeof ticks,
                                      ticks, sizeof *ticks, VK_QUERY_RESULT_64_BIT);
        if (result != VK_NOT_READY && !vk_check(g, result, "reading timestamps")) return 0;
    }
    size_t count = timer->count < capacity ? timer->count : capacity;
    for (size_t i = 0; i < count; i++) {
        str_copy(out[i].label, sizeof out[i].label, timer->labels[i]);
        out[i].milliseconds = milliseconds(g, timer, ticks[2 * i], ticks[2 * i + 1]);
    }
    return count;
}
