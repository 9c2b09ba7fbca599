// Pipelines of equal descriptions share what the driver made of them: a table of reference counts
// by the hash of the description.
//
// Nothing is built under the lock, so that threads build side by side. Two that ask for the same at
// the same moment both build it, and the later one takes what the earlier one has added.
#include "base/memory.h"
#include "gpu/vk.h"

void vk_built_free(gpu *g, void *object) {
    vk_built *built = object;
    vkDestroyPipeline(g->device, built->handle, NULL);
    vkDestroyPipelineLayout(g->device, built->layout, NULL);
    vkDestroyDescriptorSetLayout(g->device, built->set_layout, NULL);
    mem_free(built);
}

static vk_built **row_of(gpu *g, hash128 key) {
    return &g->built[key.low % VK_BUILT_ROWS];
}

// With the lock held.
static vk_built *find(gpu *g, hash128 key) {
    vk_built *built = *row_of(g, key);
    while (built && (built->key.low != key.low || built->key.high != key.high)) built = built->next;
    if (built) built->references++;
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
    pthread_mutex_lock(&g->built_lock);
    bool last = --built->references == 0;
    if (last) {
        vk_built **at = row_of(g, built->key);
        while (*at != built) at = &(*at)->next;
        *at = built->next;
    }
    pthread_mutex_unlock(&g->built_lock);
    if (last) vk_retire(g, vk_built_free, built);
}
