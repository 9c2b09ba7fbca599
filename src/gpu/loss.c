// What driver calls answer, how long they are waited for, and how the loss of a device is told.
//
// A device is lost when the driver says so, or when it finishes nothing for gpu_desc.timeout: then
// its work is taken to hang, and nothing may wait for it any more. What is known of the loss is
// written down once, by the thread of the gpu, and every later call repeats it.
#include "base/clock.h"
#include "gpu/vk.h"
#include <stdarg.h>
#include <stdio.h>

static const char *result_text(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "the driver has no host memory left";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "the device has no memory left";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost (a shader that ran too long, or a driver fault)";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "the driver allows no more objects of this kind";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return "the device does not support the format";
    case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
        return "something else draws to the window";
    default:
        return "the driver refuses";
    }
}

bool vk_check(gpu *g, VkResult result, const char *what, ...) {
    if (result == VK_SUCCESS) return true;
    if (result == VK_ERROR_DEVICE_LOST) atomic_store(&g->lost, true);
    char text[512];
    va_list args;
    va_start(args, what);
    vsnprintf(text, sizeof text, what, args);
    va_end(args);
    return err_set("%s: %s (Vulkan result %d)", text, result_text(result), (int)result);
}

bool vk_alive(gpu *g) {
    if (!atomic_load(&g->lost)) return true;
    if (atomic_load(&g->loss_written)) return err_set("%s", g->loss);
    return err_set("the device '%s' was lost; it must be created anew", g->info.name);
}

bool gpu_is_lost(const gpu *g) {
    return atomic_load(&g->lost);
}

// Of the submission that the device is at. NULL when that is no frame or cannot be known. What has
// finished is not asked for again: a lost device may report anything.
static const char *running_pass(gpu *g) {
    for (int i = 0; i < GPU_FRAMES_IN_FLIGHT; i++) {
        const vk_frame *frame = &g->frames[i];
        if (frame->batch.serial == g->completed + 1) return vk_timer_running(g, &frame->timer);
    }
    return NULL;
}

bool vk_lose(gpu *g, VkResult how) {
    if (!atomic_load(&g->loss_written)) {
        const char *pass = running_pass(g);
        char why[96] = "a shader that ran too long, or a driver fault";
        if (how == VK_TIMEOUT) {
            g->hung = true;
            if (g->given_up)
                snprintf(why, sizeof why, "it was given up while it worked");
            else
                snprintf(why, sizeof why, "it finished no work in %g s, a shader may run endlessly",
                         (double)g->timeout * 1e-9);
        }
        snprintf(g->loss, sizeof g->loss, "the device '%s' was lost%s%s%s (%s)", g->info.name,
                 pass ? " in pass '" : "", pass ? pass : "", pass ? "'" : "", why);
        atomic_store(&g->loss_written, true);
        atomic_store(&g->lost, true);
    }
    return err_set("%s", g->loss);
}

typedef struct wait {        // nanoseconds
    uint64_t since_progress; // the device's last
    uint64_t all;
} wait;

// Waits for as long as nobody need be asked. A driver that answers a long wait with a short one
// would make `all` too long, and is not known.
static VkResult wait_once(gpu *g, uint64_t serial, wait *w) {
    static const uint64_t tick = 100000000, patience = 1000000000;
    bool asks = g->waiting && pthread_equal(g->owner, pthread_self());
    uint64_t left = g->timeout - w->since_progress, before = vk_completed(g);
    uint64_t time = asks && left > tick ? tick : left;
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &g->timeline,
                                .pValues = &serial};
    VkResult result = g->vk.WaitSemaphores(g->device, &info, time);
    if (result != VK_TIMEOUT) return result;
    w->all += time;
    w->since_progress =
        vk_completed(g) > before ? 0 : w->since_progress + time; // slow, but at work
    if (asks && w->all >= patience)
        g->given_up = !g->waiting(g->waiting_user, (double)w->all * 1e-9);
    return g->given_up || w->since_progress >= g->timeout ? VK_TIMEOUT : VK_NOT_READY;
}

bool vk_wait(gpu *g, uint64_t serial) {
    if (!vk_alive(g)) return false;
    wait w = {0};
    while (serial > g->completed) {
        VkResult result = wait_once(g, serial, &w);
        if (result == VK_NOT_READY) continue;
        if (result == VK_TIMEOUT || result == VK_ERROR_DEVICE_LOST) return vk_lose(g, result);
        if (!vk_check(g, result, "waiting for '%s'", g->info.name)) return false;
        if (serial > g->completed) g->completed = serial;
    }
    return true;
}

bool vk_wait_where_driver_would(gpu *g) {
    return !g->profile.waits_in_calls || vk_wait(g, g->submitted);
}

uint64_t gpu_pending(gpu *g) {
    uint64_t before = g->completed;
    if (atomic_load(&g->lost)) return 0;
    uint64_t pending = g->submitted - vk_completed(g);
    double now = clock_seconds();
    if (!pending || g->completed > before || g->stalled == 0) g->stalled = pending ? now : 0;
    if (pending && (now - g->stalled) * 1e9 >= (double)g->timeout) vk_lose(g, VK_TIMEOUT);
    return atomic_load(&g->lost) ? 0 : pending;
}

void gpu_give_up(gpu *g) {
    g->given_up = true;
    vk_lose(g, VK_TIMEOUT);
}

uint64_t vk_completed(gpu *g) {
    uint64_t value = 0;
    VkResult result = g->vk.GetSemaphoreCounterValue(g->device, g->timeline, &value);
    if (result == VK_ERROR_DEVICE_LOST) vk_lose(g, result);
    // A lost device may report any value; nothing beyond what was submitted can have finished.
    if (result == VK_SUCCESS && value > g->completed && value <= g->submitted) {
        g->completed = value;
    }
    return g->completed;
}
