// Births at instances: which of them, by shares that a field says of each. The shares are summed up
// on the host, where the number of births is known too, and the device looks for a random number in
// the sums. Who is born where follows from its number and the sums alone.
#include "base/error.h"
#include "pass/particles/particles_parts.h"
#include <math.h>

bool particles_open_at(pass *p, particles_state *s) {
    particles_at *at = &s->at;
    if (!s->desc.at) return true;
    at->count = scene_instances_count(s->desc.at);
    if (!at->count) return err_set("%s: 'at' has no instances", p->label);
    at->sums = arena_alloc(p->host->memory, at->count * sizeof *at->sums);
    at->shares = arena_alloc(p->host->memory, at->count * sizeof *at->shares);
    return true;
}

bool particles_make_at(pass *p, particles_state *s) {
    particles_at *at = &s->at;
    if (!s->desc.at || at->buffer) return true;
    return gpu_buffer_make(p->host->device, &at->buffer, "shares of births",
                           at->count * sizeof(float)) &&
           scene_instances_allocate(s->desc.at, p->host->device);
}

// Those that are not shown, too: what burns may have fallen.
bool particles_sum_shares(const pass *p) {
    particles_state *s = particles_of(p);
    particles_at *at = &s->at;
    if (!s->desc.at) return true;
    if (s->desc.share &&
        !field_eval_instances(s->desc.share, p->host->context, scene_instances_entries(s->desc.at),
                              at->count, at->shares))
        return err_prefix("%s: 'share': ", p->label);
    at->total = 0;
    for (uint32_t i = 0; i < at->count; i++) {
        const float share = s->desc.share ? at->shares[i][0] : 1;
        at->total += isfinite(share) && share > 0 ? fmin((double)share, 1e9) : 0;
        if (at->sums[i] != (float)at->total) at->written = false;
        at->sums[i] = (float)at->total;
    }
    return true;
}

bool particles_write_shares(const pass *p) {
    particles_at *at = &particles_of(p)->at;
    if (!at->buffer || at->written) return true;
    at->written =
        gpu_buffer_write(p->host->device, at->buffer, 0, at->sums, at->count * sizeof *at->sums);
    return at->written;
}

bool particles_set_at(pass *p) {
    const particles_state *s = particles_of(p);
    mat4 group;
    float tint[4];
    if (!s->desc.at) return true;
    if (!scene_instances_place(s->desc.at, p->host->context, group, tint)) return false;
    pass_set(p, N_birth_group, group, sizeof group);
    pass_set_int(p, N_birth_instances, (int32_t)s->at.count);
    return true;
}
