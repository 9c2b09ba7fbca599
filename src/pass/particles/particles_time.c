// The clock of particles. Steps are so long whatever is drawn; the state is that at the end of the
// step in which the time of the frame lies, and what is drawn goes back from there.
#include "base/error.h"
#include "base/memory.h"
#include "pass/particles/particles_parts.h"
#include <math.h>

enum { BRIEF = 64 }; // of what a submit may move, in a window: one part of so many

static const double rounding = 1e-6;  // of a step
static const double most_lost = 0.05; // share of the births

double particles_reached(const particles_state *s) {
    return (double)s->clock.steps * s->desc.time_step - s->desc.warm_up;
}

static int64_t particles_left(const pass *p, double time) {
    const particles_state *s = particles_of(p);
    double steps = ceil((time + s->desc.warm_up) / s->desc.time_step - rounding);
    return (int64_t)fmax(steps, 0) - (s->fresh ? 0 : (int64_t)s->clock.steps);
}

static int64_t particles_most(const pass *p) {
    double moves = gpu_get_profile(p->host->device)->particle_moves;
    double steps = moves / particles_of(p)->desc.count;
    return (int64_t)fmax(1, p->host->brief ? steps / BRIEF : steps);
}

static double reached(const pass *p) {
    const particles_state *s = particles_of(p);
    return s->fresh ? -(double)INFINITY : particles_reached(s);
}

static void restart(pass *p) {
    particles_of(p)->fresh = true;
}

// ---- a step -----------------------------------------------------------------------------------

bool particles_rates_of(const pass *p, particles_rates *out) {
    static const int uniforms[] = {N_rate, N_burst, N_burst_time, N_burst_period};
    const particles_state *s = particles_of(p);
    double *const slots[] = {&out->rate, &out->burst, &out->burst_time, &out->burst_period};
    *out = (particles_rates){.begin = particles_reached(s), .step = s->desc.time_step};
    for (size_t i = 0; i < COUNT_OF(uniforms); i++) {
        float value[4];
        if (!pass_evaluate_now(p, uniforms[i], value)) return false;
        *slots[i] = (double)value[0];
    }
    if (!s->desc.at) return true;
    out->rate *= s->at.total;
    out->burst *= s->at.total;
    return true;
}

static bool find_births(const pass *p, particles_state *s) {
    particles_rates rates;
    if (!particles_rates_of(p, &rates)) return false;
    s->births = particles_next(&s->clock, &rates, s->desc.count);
    return true;
}

bool particles_find_places(const pass *p) {
    particles_state *s = particles_of(p);
    const field *shape = pass_given_field(p, N_shape);
    s->box = (box3){{0, 0, 0}, {0, 0, 0}};
    if (shape && !p->mesh_count) {
        if (!field_bounds(shape, p->host->context, &s->box)) return false;
        if (!box3_is_finite(s->box))
            return err_set("%s: 'shape' has no end; make it zero outside of a box, as by the "
                           "product with box { }",
                           p->label);
    }
    for (int i = 0; i < 2 && p->mesh_count; i++) {
        field_context then = *p->host->context;
        then.time += (i - 0.5) * s->desc.time_step;
        if (!scene_mesh_transform(p->meshes[0], &then, s->places[i]))
            return err_prefix("%s: ", p->meshes[0]->name);
    }
    return true;
}

static bool give_birth(pass *p, particles_state *s, uint32_t count) {
    kernel *k = pass_use(p, PARTICLES_BIRTH);
    s->lost.births += count;
    if (!k) return false;
    kernel_bind_image(k, N_lost, s->lost.count.image);
    kernel_bind_buffer(k, N_BirthTriangles, s->triangles);
    kernel_bind_buffer(k, N_BirthShares, s->at.buffer);
    if (s->desc.at) kernel_bind_buffer(k, N_Instances, scene_instances_buffer(s->desc.at));
    return kernel_run_each(k, p->host->device, count);
}

static bool move(pass *p, particles_state *s) {
    const uint32_t used = pass_particles_used(p), born = s->births.burst + s->births.steady;
    if (!used) return true;
    if (born && !particles_find_places(p)) return false;
    if (!pass_prepare(p) || (born && !give_birth(p, s, born))) return false;
    kernel *k = pass_use(p, PARTICLES_MOVE);
    return k && kernel_run_each(k, p->host->device, used);
}

static bool step(pass *p, particles_state *s) {
    particles_clock before = s->clock;
    bool done = find_births(p, s) && move(p, s);
    if (!done) s->clock = before; // no number of it was found: it is still to be done
    return done;
}

bool particles_advance(pass *p) {
    particles_state *s = particles_of(p);
    int64_t left = pass_waits(p) ? 0 : particles_left(p, p->host->context->time),
            limit = particles_most(p);
    if (s->fresh && !particles_find_places(p)) return false; // told before the first birth
    if (!particles_sum_shares(p) || !particles_write_shares(p)) return false;
    if (s->fresh) s->clock = (particles_clock){0};
    s->fresh = false;
    if (left > limit) left = limit;
    const field_context *frame = p->host->context;
    field_context now = *frame;
    p->host->context = &now;
    bool fine = left <= 0 || particles_begin_lost(p, s);
    for (int64_t i = 0; i < left && fine; i++) {
        now.time = particles_reached(s) + 0.5 * s->desc.time_step;
        fine = step(p, s);
    }
    p->host->context = frame;
    s->last_steps = left > 0 ? (uint64_t)left : 0;
    return fine && (left <= 0 || particles_end_lost(p, s));
}

// ---- asking -----------------------------------------------------------------------------------

static double work(const pass *p) {
    return (double)particles_of(p)->last_steps * pass_particles_used(p);
}

static size_t readouts(const pass *p, pass_readout *out, size_t capacity) {
    const particles_state *s = particles_of(p);
    const pass_readout all[] = {
        {"born", "", (double)s->clock.born},
        {"slots", "", pass_particles_used(p)},
        {"steps", "", (double)s->clock.steps},
        {"time step", "s", s->desc.time_step},
        {"without a place", "%", 100 * particles_lost_share(p)},
    };
    for (size_t i = 0; i < COUNT_OF(all) && i < capacity; i++) out[i] = all[i];
    return COUNT_OF(all);
}

// As the numbers are now, if all live to the longest.
static double most_alive(const pass *p) {
    particles_rates rates;
    if (!particles_rates_of(p, &rates)) return 0;
    float shortest[4], longest[4];
    if (!pass_evaluate_now(p, N_lifetime_min, shortest) ||
        !pass_evaluate_now(p, N_lifetime_max, longest))
        return 0;
    double life = (double)fmaxf(shortest[0], longest[0]);
    double bursts = rates.burst_period > 0 ? ceil(life / rates.burst_period) : 1;
    return rates.rate * life + bursts * rates.burst;
}

// More than there are slots for, so that who is born takes the place of one that could live on; or
// births that came to nothing.
static const char *trouble(const pass *p) {
    particles_state *s = particles_of(p);
    double lost = particles_lost_share(p);
    double alive = most_alive(p);
    if (alive > s->desc.count)
        snprintf(s->trouble, sizeof s->trouble,
                 "the oldest die early, to make room: set 'count' to %.0f, as many as live at a "
                 "time by 'rate', 'burst' and 'lifetime' (it is %u)",
                 ceil(alive), s->desc.count);
    else if (lost > most_lost)
        snprintf(
            s->trouble, sizeof s->trouble,
            "%.0f %% of the births found no place: 'shape' is above the threshold in too small "
            "a part of its box; multiply it by a smaller box { }, or lower the threshold",
            100 * lost);
    else
        return NULL;
    return s->trouble;
}

const pass_simulation particles_simulation = {
    .left = particles_left,
    .most = particles_most,
    .reached = reached,
    .restart = restart,
    .exchange = particles_exchange,
    .save = particles_save,
    .load = particles_load,
    .readouts = readouts,
    .work = work,
    .work_name = "particle steps",
    .trouble = trouble,
};
