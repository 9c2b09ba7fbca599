// Deferred destruction: an object that was let go dies when no submission can still use it.
//
// Invariant: serials in the queue never fall, so the oldest entry is the first to be ready. Any
// thread may append; only the thread of the gpu takes out.
#include "base/memory.h"
#include "gpu/vk.h"
#include <string.h>

void vk_retire(gpu *g, void (*destroy)(gpu *g, void *object), void *object) {
    pthread_mutex_lock(&g->retire_lock);
    if (g->retired_first > 64 && g->retired_first > g->retired_count / 2) {
        g->retired_count -= g->retired_first;
        memmove(g->retired, g->retired + g->retired_first, g->retired_count * sizeof *g->retired);
        g->retired_first = 0;
    }
    *MEM_ADD(g->retired, g->retired_count, g->retired_capacity) =
        (vk_retired){.serial = atomic_load(&g->open_serial), .destroy = destroy, .object = object};
    pthread_mutex_unlock(&g->retire_lock);
}

static bool take(gpu *g, uint64_t completed, vk_retired *out) {
    pthread_mutex_lock(&g->retire_lock);
    bool ready =
        g->retired_first < g->retired_count && g->retired[g->retired_first].serial <= completed;
    if (ready) *out = g->retired[g->retired_first++];
    pthread_mutex_unlock(&g->retire_lock);
    return ready;
}

static void collect_until(gpu *g, uint64_t completed) {
    vk_retired entry;
    while (take(g, completed, &entry)) entry.destroy(g, entry.object);
}

void vk_collect(gpu *g) {
    collect_until(g, vk_completed(g));
}

void vk_collect_all(gpu *g) {
    collect_until(g, UINT64_MAX);
}
