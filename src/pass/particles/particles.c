// Life of the pass type `particles`, and what other passes see of it.
#include "pass/particles/particles.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/particles/particles_parts.h"
#include <math.h>
#include <string.h>

static const char *const names[] = {PARTICLES_NAMES(KERNEL_NAME_TEXT)};
static const pass_kernel kernels[PARTICLES_KERNELS] = {
    [PARTICLES_BIRTH] = {.shader = "pass/particles/birth.comp"},
};

static uint32_t parts_of(const particles_state *s) {
    return s->desc.count > PASS_PARTICLES_EACH ? 2 : 1;
}

// ---- declaring --------------------------------------------------------------------------------

static bool particles_check_desc(const pass *p, const pass_particles_desc *d) {
    if (d->count < 1 || d->count > PASS_PARTICLES_MOST)
        return err_set("%s: 'count' is %u; accepted: 1 to %d", p->label, d->count,
                       PASS_PARTICLES_MOST);
    if (!(d->time_step >= 1e-5 && d->time_step <= 3600))
        return err_set("%s: 'time_step' is %g s; accepted: 1e-5 to 3600", p->label, d->time_step);
    if (!(d->warm_up >= 0 && d->warm_up <= 86400))
        return err_set("%s: 'warm_up' is %g s; accepted: 0 to 86400", p->label, d->warm_up);
    return true;
}

bool pass_particles_open(pass *p, const pass_particles_desc *desc) {
    if (!particles_check_desc(p, desc)) return false;
    particles_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    *s = (particles_state){.pass = p, .desc = *desc, .fresh = true};
    return particles_open_at(p, s);
}

static bool is_carried(const pass *p) {
    static const int uniforms[] = {N_gravity, N_drag, N_drag_square, N_outward};
    enum { AUTO, CARRIED };
    const size_t motion = pass_option(p, N_motion);
    if (motion != AUTO) return motion == CARRIED;
    for (size_t i = 0; i < COUNT_OF(uniforms); i++)
        if (pass_gives(p, uniforms[i])) return false;
    return !pass_given_field(p, N_force) && !pass_given_field(p, N_speed);
}

static bool particles_record(pass *p) {
    particles_of(p)->last_steps = 0;
    return p->host->hold || particles_advance(p);
}

static bool particles_declare(pass *p) {
    particles_state *s = particles_of(p);
    if (p->mesh_count > 1)
        return err_set("%s: %zu meshes; one at most, on whose surface they are born", p->label,
                       p->mesh_count);
    if (!pass_gives(p, N_rate) && !pass_gives(p, N_burst))
        return err_set("%s: neither 'rate' nor 'burst' is given, so none is ever born", p->label);
    s->carried = is_carried(p);
    s->carries = pass_given_field(p, N_quantity) != NULL;
    const graph_image reads[] = {*pass_image(p, N_depth), *pass_image(p, N_normal)};
    return pass_add_output(p, N_particles, (graph_image_desc){.width = 1, .height = 1}) &&
           pass_add_part(p, &(pass_part){
                                .name = "step",
                                .reads = reads,
                                .read_count = COUNT_OF(reads),
                                .writes = pass_image(p, N_particles),
                                .write_count = 1,
                                .fields = true,
                                .simulates = true,
                                .record = particles_record,
                            });
}

// ---- building ---------------------------------------------------------------------------------

static bool particles_defines(pass *p, size_t index, pass_defines *out) {
    const particles_state *s = particles_of(p);
    (void)index;
    pass_define_flag(out, "CARRIED", s->carried);
    pass_define_flag(out, "MESH", p->mesh_count);
    pass_define_flag(out, "AT", s->desc.at);
    return true;
}

static bool make_triangles(pass *p, particles_state *s) {
    if (!p->mesh_count || s->triangles) return true;
    const mesh_data *mesh = &p->meshes[0]->data;
    particles_triangle *all = mem_alloc((mesh->index_count / 3 + 1) * sizeof *all);
    s->triangle_count = particles_list_triangles(mesh, all);
    uint64_t size = s->triangle_count * sizeof *all;
    gpu *device = p->host->device;
    uint64_t most = gpu_get_info(device)->max_storage_range;
    if (size > most)
        err_set("%u triangles; the device can bind %llu at most", s->triangle_count,
                (unsigned long long)(most / sizeof *all));
    else if (size)
        s->triangles =
            gpu_buffer_create(device, &(gpu_buffer_desc){.label = "triangles", .size = size});
    bool done = s->triangles && gpu_buffer_write(device, s->triangles, 0, all, size);
    mem_free(all);
    return done || err_prefix("%s: ", p->meshes[0]->name);
}

static bool make_buffers(const pass *p, particles_state *s) {
    gpu *device = p->host->device;
    uint64_t left = s->desc.count;
    bool done =
        !s->carries || gpu_buffer_make(device, &s->buffers.quantities, "quantities", 4 * left);
    for (uint32_t i = 0; i < parts_of(s) && done; i++) {
        uint64_t here = left < PASS_PARTICLES_EACH ? left : PASS_PARTICLES_EACH;
        done = gpu_buffer_make(device, &s->buffers.positions[i], "positions", 16 * here) &&
               gpu_buffer_make(device, &s->buffers.velocities[i], "velocities", 16 * here);
        left -= here;
    }
    return done;
}

static void particles_list_memory(const pass *p, budget_list *out) {
    const particles_state *s = particles_of(p);
    const uint64_t count = s->desc.count;
    if (s->carries && !s->buffers.quantities) budget_list_add(out, "quantities", 4 * count);
    for (uint32_t i = 0; i < parts_of(s); i++) {
        const uint64_t left = count - i * (uint64_t)PASS_PARTICLES_EACH;
        const uint64_t here = left < PASS_PARTICLES_EACH ? left : PASS_PARTICLES_EACH;
        if (!s->buffers.positions[i]) budget_list_add(out, "positions", 16 * here);
        if (!s->buffers.velocities[i]) budget_list_add(out, "velocities", 16 * here);
    }
    if (p->mesh_count && !s->triangles)
        budget_list_add(out, "triangles",
                        p->meshes[0]->data.index_count / 3 * sizeof(particles_triangle));
}

static bool particles_allocate(pass *p) {
    particles_state *s = particles_of(p);
    return (make_buffers(p, s) && make_triangles(p, s) && particles_make_lost(p, s) &&
            particles_make_at(p, s)) ||
           err_prefix("%s: ", p->label);
}

static void particles_destroy(pass *p) {
    particles_state *s = particles_of(p);
    if (!s) return;
    gpu *device = p->host->device;
    kernel_readback_destroy(&s->lost.count, p->host->device);
    gpu_buffer *const all[] = {s->buffers.positions[0],
                               s->buffers.positions[1],
                               s->buffers.velocities[0],
                               s->buffers.velocities[1],
                               s->buffers.quantities,
                               s->triangles,
                               s->at.buffer};
    for (size_t i = 0; i < COUNT_OF(all); i++) gpu_buffer_destroy(device, all[i]);
}

// ---- a frame ----------------------------------------------------------------------------------

static void set_births(pass *p) {
    const particles_state *s = particles_of(p);
    const particles_births *b = &s->births;
    pass_set_int(p, N_birth_first, (int32_t)(b->first % s->desc.count));
    pass_set_int(p, N_birth_count, (int32_t)(b->burst + b->steady));
    pass_set_int(p, N_birth_burst, (int32_t)b->burst);
    pass_set_float(p, N_birth_burst_rest, (float)b->burst_rest);
    pass_set_float(p, N_birth_first_rest, (float)b->steady_rest);
    pass_set_float(p, N_birth_every, (float)b->every);
}

static bool particles_update(pass *p) {
    const particles_state *s = particles_of(p);
    set_births(p);
    pass_set_float(p, N_time_step, (float)s->desc.time_step);
    pass_set_int(p, N_mesh_triangles, (int32_t)s->triangle_count);
    pass_set(p, N_mesh_from, s->places[0], sizeof s->places[0]);
    pass_set(p, N_mesh_to, s->places[1], sizeof s->places[1]);
    pass_set_box(p, s->box);
    return particles_set_at(p);
}

static bool particles_rehearse(pass *p) {
    particles_rates rates;
    return particles_sum_shares(p) && particles_rates_of(p, &rates) && particles_find_places(p);
}

const pass_type particles_type = {
    .name = "particles",
    .constructed = true,
    .shader = "pass/particles/particles.comp",
    PASS_KERNELS,
    .meshes = PASS_USES_MESHES,
    .unscaled = true,
    .simulation = &particles_simulation,
    .declare = particles_declare,
    .defines = particles_defines,
    .allocate = particles_allocate,
    .list_memory = particles_list_memory,
    .update = particles_update,
    .rehearse = particles_rehearse,
    .record = particles_record,
    .destroy = particles_destroy,
};

// ---- for passes that read them ----------------------------------------------------------------

static bool find_particles(pass *p) {
    int input = pass_find_image(p, "particles");
    if (input < 0 || p->face->images[input].output) return true;
    if (p->face->images[input].optional && !p->images[input].id) return true;
    p->particles = p->images[input].id ? pass_writer(p->host, p->images[input]) : NULL;
    if (p->particles && p->particles->type == &particles_type) return true;
    return err_set("%s: 'particles' is missing: a pass particles { }, as in particles = sparks or "
                   "from = sparks",
                   p->label);
}

uint32_t pass_particles_count(const pass *particles) {
    return particles_of(particles)->desc.count;
}

uint32_t pass_particles_used(const pass *particles) {
    const particles_state *s = particles_of(particles);
    uint64_t born = s->fresh ? 0 : s->clock.born;
    return born < s->desc.count ? (uint32_t)born : s->desc.count;
}

#define UNIFORMS(NAME)                                                                             \
    NAME(particle_count), NAME(particle_used), NAME(particle_next), NAME(particle_round),          \
        NAME(particle_seed), NAME(particle_back)
enum { UNIFORMS(KERNEL_NAME_ID), UNIFORM_COUNT };
_Static_assert((int)UNIFORM_COUNT <= PASS_PROVIDER_VALUES, "a provider has room for these");
static const char *const uniforms[] = {UNIFORMS(KERNEL_NAME_TEXT)};

#define SLOTS(NAME)                                                                                \
    NAME(ParticlePositions), NAME(ParticlePositionsMore), NAME(ParticleVelocities),                \
        NAME(ParticleVelocitiesMore), NAME(ParticleQuantities)
enum { SLOTS(KERNEL_NAME_ID), SLOT_COUNT };
static const char *const slots[] = {SLOTS(KERNEL_NAME_TEXT)};

// The particles that a pass has to do with: those that it is itself, or reads.
static const pass *source_of(const pass *p) {
    return p->type == &particles_type ? p : p->particles;
}

static size_t defines_of(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]) {
    if (!source_of(p)) return 0;
    const particles_state *s = particles_of(source_of(p));
    out[0] = (shader_define){"PARTICLE_PARTS", parts_of(s) > 1 ? "2" : "1"};
    out[1] = (shader_define){"PARTICLE_QUANTITY", s->carries ? "1" : "0"};
    return 2;
}

static bool find_values(const pass *p, uint32_t out[PASS_PROVIDER_VALUES]) {
    const pass *particles = source_of(p);
    if (!particles) return false;
    const particles_state *s = particles_of(particles);
    const pass_host *host = particles->host;
    float seed[4] = {0};
    pass_evaluate_now(particles, N_seed, seed);
    double back = particles_reached(s) - host->context->time;
    if (!p->runs_in) back = fmin(fmax(back, 0), s->desc.time_step); // else it has steps of its own
    out[N_particle_count] = s->desc.count;
    out[N_particle_used] = pass_particles_used(particles);
    out[N_particle_next] = (uint32_t)(s->clock.born % s->desc.count);
    out[N_particle_round] = (uint32_t)(s->clock.born - out[N_particle_next]);
    out[N_particle_seed] = (uint32_t)lrintf(seed[0]) + host->frame->size.v[3] * 2654435761u;
    memcpy(&out[N_particle_back], &(float){(float)back}, sizeof(float));
    return true;
}

static uint32_t count_of(const pass *p) {
    return source_of(p) ? pass_particles_used(source_of(p)) : 0;
}

static bool bind_buffer(pass *p, int slot, gpu_binding *out) {
    if (!source_of(p)) return false;
    const particles_buffers *buffers = &particles_of(source_of(p))->buffers;
    gpu_buffer *const all[SLOT_COUNT] = {
        [N_ParticlePositions] = buffers->positions[0],
        [N_ParticlePositionsMore] = buffers->positions[1],
        [N_ParticleVelocities] = buffers->velocities[0],
        [N_ParticleVelocitiesMore] = buffers->velocities[1],
        [N_ParticleQuantities] = buffers->quantities,
    };
    out->buffer = all[slot];
    return out->buffer;
}

const pass_provider pass_particles_provider = {
    .slots = {slots, SLOT_COUNT},
    .uniforms = {uniforms, UNIFORM_COUNT},
    .find = find_particles,
    .defines = defines_of,
    .values = find_values,
    .bind = bind_buffer,
    .count = count_of,
};
