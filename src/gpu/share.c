// Pipelines of equal descriptions share what the driver made of them: a table of reference counts
// by the hash of the description.
//
// The last few that nobody uses any more are kept: an effect that is edited to and fro wants them
// again, and a driver takes tens of milliseconds to build one.
//
// Nothing is built under the lock, so that threads build side by side. Two that ask for the same at
// the same moment both build it, and the later one takes what the earlier one has added.
#include "base/memory.h"
#include "gpu/vk.h"
#include <string.h>

void vk_built_free(gpu *g, void *object) {
    vk_built *built = object;
    g->vk.DestroyPipeline(g->device, built->handle, NULL);
    g->vk.DestroyDescriptorUpdateTemplate(g->device, built->descriptors, NULL);
    g->vk.DestroyPipelineLayout(g->device, built->layout, NULL);
    g->vk.DestroyDescriptorSetLayout(g->device, built->set_layout, NULL);
    mem_free(built);
}

static vk_built **row_of(gpu *g, hash128 key) {
    return &g->built[key.low % VK_BUILT_ROWS];
}

// These three with the lock held.
static void remove_idle(gpu *g, const vk_built *built) {
    uint32_t at = 0;
    while (g->idle[at] != built) at++;
    g->idle_count--;
    memmove(g->idle + at, g->idle + at + 1, (g->idle_count - at) * sizeof *g->idle);
}

// Makes room for one more; returns what had to go, which is in no table any more, or NULL.
static vk_built *make_room(gpu *g) {
    if (g->idle_count < VK_BUILT_IDLE) return NULL;
    vk_built *oldest = g->idle[0], **at = row_of(g, oldest->key);
    remove_idle(g, oldest);
    while (*at != oldest) at = &(*at)->next;
    *at = oldest->next;
    return oldest;
}

static vk_built *find(gpu *g, hash128 key) {
    vk_built *built = *row_of(g, key);
    while (built && (built->key.low != key.low || built->key.high != key.high)) built = built->next;
    if (built && built->references++ == 0) remove_idle(g, built);
    return built;
}

vk_built *vk_built_find(gpu *g, hash128 key) {
    pthread_mutex_lock(&g->built_lock);
    vk_built *found = find(g, key);
    pthread_mutex_unlock(&g->built_lock);
    return found;
}

vk_built *vk_built_add(gpu *g, vk_built *built) {
    pthread_mutex_lock(&g->built_lock);
    vk_built *found = find(g, built->key);
    if (!found) {
        vk_built **row = row_of(g, built->key);
        built->references = 1;
        built->next = *row;
        *row = built;
    }
    pthread_mutex_unlock(&g->built_lock);
    if (!found) return built;
    vk_built_free(g, built);
    return found;
}

void vk_built_release(gpu *g, vk_built *built) {
    vk_built *gone = NULL;
    pthread_mutex_lock(&g->built_lock);
    if (--built->references == 0) {
        gone = make_room(g);
        g->idle[g->idle_count++] = built;
    }
    pthread_mutex_unlock(&g->built_lock);
    if (gone) vk_retire(g, vk_built_free, gone);
}

void vk_built_close(gpu *g) {
    while (g->idle_count) vk_built_free(g, g->idle[--g->idle_count]);
}
