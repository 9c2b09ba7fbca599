// Births that found no place in the shape: counted on the device, read some frames later, never
// waited for. The count is an image, which can be copied to where the host reads it, into one of as
// many places as frames can be in flight.
#include "base/memory.h"
#include "pass/particles/particles_parts.h"

bool particles_make_lost(pass *p, particles_state *s) {
    gpu *device = p->host->device;
    if (!pass_given_field(p, N_shape) || s->lost.count) return true;
    s->lost.count = gpu_image_create(device, &(gpu_image_desc){.label = "births without a place",
                                                               .format = GPU_R32U,
                                                               .width = 1,
                                                               .height = 1,
                                                               .use = GPU_USE_STORAGE});
    s->lost.found = gpu_buffer_create(device, &(gpu_buffer_desc){.label = "births without a place",
                                                                 .size = 4 * PARTICLES_PLACES,
                                                                 .kind = GPU_BUFFER_READBACK});
    return s->lost.count && s->lost.found;
}

void particles_destroy_lost(pass *p, particles_state *s) {
    gpu_image_destroy(p->host->device, s->lost.count);
    gpu_buffer_destroy(p->host->device, s->lost.found);
}

bool particles_begin_lost(pass *p, particles_state *s) {
    static const float zero[4] = {0};
    s->lost.births = 0;
    if (s->lost.count) gpu_image_clear(p->host->device, s->lost.count, zero);
    return true;
}

bool particles_end_lost(pass *p, particles_state *s) {
    particles_lost *lost = &s->lost;
    if (!lost->count || !lost->births) return true;
    lost->places[lost->next] =
        (particles_lost_place){gpu_frame_open(p->host->device), lost->births};
    bool done = gpu_image_copy_to_buffer(p->host->device, lost->count, lost->found,
                                         4 * (uint64_t)lost->next);
    lost->next = (lost->next + 1) % PARTICLES_PLACES;
    return done;
}

double particles_lost_share(const pass *p) {
    const particles_lost *lost = &particles_of(p)->lost;
    for (uint32_t age = 1; age <= PARTICLES_PLACES; age++) {
        uint32_t place = (lost->next + PARTICLES_PLACES - age) % PARTICLES_PLACES;
        const particles_lost_place *at = &lost->places[place];
        if (!at->frame || !gpu_frame_done(p->host->device, at->frame)) continue;
        const uint32_t *counts = gpu_buffer_map(lost->found);
        return (double)counts[place] / (double)at->births;
    }
    return 0;
}
