// Births that found no place in the shape: counted on the device, read some frames later.
#include "pass/particles/particles_parts.h"

bool particles_make_lost(pass *p, particles_state *s) {
    return !pass_given_field(p, N_shape) ||
           kernel_readback_make(&s->lost.count, p->host->device, "births without a place", 1);
}

bool particles_begin_lost(pass *p, particles_state *s) {
    static const float zero[4] = {0};
    s->lost.births = 0;
    if (s->lost.count.image) gpu_image_clear(p->host->device, s->lost.count.image, zero);
    return true;
}

bool particles_end_lost(pass *p, particles_state *s) {
    particles_lost *lost = &s->lost;
    return !lost->count.image || !lost->births ||
           kernel_readback_send(&lost->count, p->host->device, lost->births);
}

double particles_lost_share(const pass *p) {
    uint64_t births;
    const uint32_t *count =
        kernel_readback_newest(&particles_of(p)->lost.count, p->host->device, &births);
    return count ? (double)*count / (double)births : 0;
}
