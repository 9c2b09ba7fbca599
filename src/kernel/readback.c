#include "kernel/readback.h"
#include <string.h>

enum { PLACES = KERNEL_READBACK_PLACES };

bool kernel_readback_make(kernel_readback *r, gpu *g, const char *label, uint32_t words) {
    if (r->image) return true;
    r->words = words;
    r->found = gpu_buffer_create(g, &(gpu_buffer_desc){.label = label,
                                                       .size = PLACES * words * sizeof(uint32_t),
                                                       .kind = GPU_BUFFER_READBACK});
    r->image = gpu_image_create(g, &(gpu_image_desc){.label = label,
                                                     .format = GPU_R32U,
                                                     .width = words,
                                                     .height = 1,
                                                     .use = GPU_USE_STORAGE});
    return r->found && r->image;
}

void kernel_readback_destroy(kernel_readback *r, gpu *g) {
    gpu_buffer_destroy(g, r->found);
    gpu_image_destroy(g, r->image);
    *r = (kernel_readback){0};
}

bool kernel_readback_send(kernel_readback *r, gpu *g, uint64_t tag) {
    const uint32_t place = r->next;
    if (!gpu_image_copy_to_buffer(g, r->image, r->found,
                                  (uint64_t)place * r->words * sizeof(uint32_t)))
        return false;
    r->places[place].frame = gpu_frame_open(g);
    r->places[place].tag = tag;
    r->next = (place + 1) % PLACES;
    return true;
}

bool kernel_readback_sent(const kernel_readback *r) {
    return r->places[(r->next + PLACES - 1) % PLACES].frame != 0;
}

void kernel_readback_forget(kernel_readback *r) {
    memset(r->places, 0, sizeof r->places);
}

const void *kernel_readback_newest(const kernel_readback *r, gpu *g, uint64_t *tag) {
    for (uint32_t age = 1; age <= PLACES; age++) {
        const uint32_t place = (r->next + PLACES - age) % PLACES;
        if (!r->places[place].frame || !gpu_frame_done(g, r->places[place].frame)) continue;
        *tag = r->places[place].tag;
        return (const uint32_t *)gpu_buffer_map(r->found) + (size_t)place * r->words;
    }
    return NULL;
}
