// Life of the pass type `particles`, and what other passes see of it.
#include "pass/particles.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/particles_parts.h"
#include <math.h>
#include <string.h>

const field *particles_field(const pass *p, const char *name) {
    size_t index;
    return pass_find_key(p, name, &index) == PASS_FIELD ? p->fields[index] : NULL;
}

static uint32_t parts_of(const particles_state *s) {
    return s->desc.count > PASS_PARTICLES_EACH ? 2 : 1;
}

// ---- declaring --------------------------------------------------------------------------------

static bool check(const pass *p, const pass_particles_desc *d) {
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
    if (!check(p, desc)) return false;
    particles_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    *s = (particles_state){.pass = p, .desc = *desc, .fresh = true};
    return particles_open_at(p, s);
}

static bool has_uniform(const pass *p, const char *name) {
    size_t index;
    const shader_uniform *declared;
    return pass_find_key(p, name, &index) == PASS_UNIFORM &&
           (p->uniforms[index] || pass_inherited_uniform(p, index, &declared));
}

static bool is_carried(const pass *p) {
    static const char *const uniforms[] = {"gravity", "drag", "drag_square", "outward"};
    enum { AUTO, CARRIED };
    size_t index;
    pass_find_key(p, "motion", &index);
    if (p->options[index] != AUTO) return p->options[index] == CARRIED;
    for (size_t i = 0; i < COUNT_OF(uniforms); i++)
        if (has_uniform(p, uniforms[i])) return false;
    return !particles_field(p, "force") && !particles_field(p, "speed");
}

bool particles_declare(pass *p) {
    particles_state *s = particles_of(p);
    if (p->mesh_count > 1)
        return err_set("%s: %zu meshes; one at most, on whose surface they are born", p->label,
                       p->mesh_count);
    if (!has_uniform(p, "rate") && !has_uniform(p, "burst"))
        return err_set("%s: neither 'rate' nor 'burst' is given, so none is ever born", p->label);
    s->carried = is_carried(p);
    s->carries = particles_field(p, "quantity") != NULL;
    int output = pass_find_image(p, "particles");
    p->images[output] = graph_add_image(
        p->host->graph,
        &(graph_image_desc){.name = arena_format(p->host->memory, "%s.particles", p->label),
                            .format = p->formats[output],
                            .width = 1,
                            .height = 1});
    const graph_image reads[] = {p->images[pass_find_image(p, "depth")],
                                 p->images[pass_find_image(p, "normal")]};
    return p->images[output].id && pass_add_part(p, &(pass_part){
                                                        .name = "step",
                                                        .reads = reads,
                                                        .read_count = COUNT_OF(reads),
                                                        .writes = &p->images[output],
                                                        .write_count = 1,
                                                        .fields = true,
                                                        .simulates = true,
                                                        .record = particles_record,
                                                    });
}

// ---- building ---------------------------------------------------------------------------------

static const char birth_shader[] = "pass/particles/birth.comp";

bool particles_check(pass *p) {
    particles_state *s = particles_of(p);
    shader_define defines[PASS_PARTICLES_DEFINES + 3];
    size_t count = pass_particles_defines(p, defines);
    defines[count++] = (shader_define){"CARRIED", s->carried ? "1" : "0"};
    defines[count++] = (shader_define){"MESH", p->mesh_count ? "1" : "0"};
    defines[count++] = (shader_define){"AT", s->desc.at ? "1" : "0"};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, count, &p->binary) &&
           pass_compile(p, birth_shader, SHADER_COMPUTE, defines, count, &s->birth);
}

bool particles_build(pass *p) {
    particles_state *s = particles_of(p);
    if (!particles_check(p)) return false;
    s->birth_block = arena_alloc(p->host->memory, pass_block_size(&s->birth) + 16);
    p->pipeline = pass_create_compute(p, &p->binary);
    s->birth_pipeline = pass_create_compute(p, &s->birth);
    return p->pipeline && s->birth_pipeline;
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

static bool make(gpu *device, const char *label, uint64_t size, gpu_buffer **out) {
    if (!*out) *out = gpu_buffer_create(device, &(gpu_buffer_desc){.label = label, .size = size});
    return *out != NULL;
}

static bool make_buffers(const pass *p, particles_state *s) {
    gpu *device = p->host->device;
    uint64_t left = s->desc.count;
    bool done = !s->carries || make(device, "quantities", 4 * left, &s->buffers.quantities);
    for (uint32_t i = 0; i < parts_of(s) && done; i++) {
        uint64_t here = left < PASS_PARTICLES_EACH ? left : PASS_PARTICLES_EACH;
        done = make(device, "positions", 16 * here, &s->buffers.positions[i]) &&
               make(device, "velocities", 16 * here, &s->buffers.velocities[i]);
        left -= here;
    }
    return done;
}

bool particles_allocate(pass *p) {
    particles_state *s = particles_of(p);
    return (make_buffers(p, s) && make_triangles(p, s) && particles_make_lost(p, s) &&
            particles_make_at(p, s)) ||
           err_prefix("%s: ", p->label);
}

void particles_destroy(pass *p) {
    particles_state *s = particles_of(p);
    if (!s) return;
    particles_destroy_lost(p, s);
    particles_destroy_at(p, s);
    if (s->birth_pipeline) gpu_pipeline_destroy(p->host->device, s->birth_pipeline);
    gpu_buffer *const all[] = {s->buffers.positions[0],  s->buffers.positions[1],
                               s->buffers.velocities[0], s->buffers.velocities[1],
                               s->buffers.quantities,    s->triangles};
    for (size_t i = 0; i < COUNT_OF(all); i++)
        if (all[i]) gpu_buffer_destroy(p->host->device, all[i]);
}

// ---- a frame ----------------------------------------------------------------------------------

static void write_uint(const shader_binary *binary, unsigned char *block, const char *name,
                       uint32_t value) {
    pass_write_member(binary, block, name, &value, sizeof value);
}

static void write_float(const shader_binary *binary, unsigned char *block, const char *name,
                        double value) {
    float rounded = (float)value;
    pass_write_member(binary, block, name, &rounded, sizeof rounded);
}

static void write_births(const particles_state *s, const shader_binary *binary,
                         unsigned char *block) {
    const particles_births *b = &s->births;
    write_uint(binary, block, "birth_first", (uint32_t)(b->first % s->desc.count));
    write_uint(binary, block, "birth_count", b->burst + b->steady);
    write_uint(binary, block, "birth_burst", b->burst);
    write_float(binary, block, "birth_burst_rest", b->burst_rest);
    write_float(binary, block, "birth_first_rest", b->steady_rest);
    write_float(binary, block, "birth_every", b->every);
}

bool particles_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const particles_state *s = particles_of(p);
    pass_particles_write(p, binary, block);
    write_births(s, binary, block);
    write_float(binary, block, "time_step", s->desc.time_step);
    write_uint(binary, block, "mesh_triangles", s->triangle_count);
    pass_write_member(binary, block, "mesh_from", s->places[0], sizeof s->places[0]);
    pass_write_member(binary, block, "mesh_to", s->places[1], sizeof s->places[1]);
    pass_write_box(binary, block, s->box);
    return particles_fill_at(p, binary, block);
}

bool particles_rehearse(pass *p) {
    particles_rates rates;
    return particles_sum_shares(p) && particles_rates_of(p, &rates) && particles_find_places(p);
}

bool particles_record(pass *p) {
    particles_of(p)->last_steps = 0;
    return p->host->hold || particles_advance(p);
}

// ---- for passes that read them ----------------------------------------------------------------

bool pass_find_particles(pass *p) {
    int input = pass_find_image(p, "particles");
    if (input < 0 || p->face->images[input].output) return true;
    p->particles = p->images[input].id ? pass_writer(p->host, p->images[input]) : NULL;
    if (p->particles && pass_is(p->particles, "particles")) return true;
    return err_set("%s: 'particles' is missing: a pass particles { }, as in particles = sparks or "
                   "from = sparks",
                   p->label);
}

const pass *pass_particles_of(const pass *p) {
    return p->particles;
}

size_t pass_particles_defines(const pass *particles, shader_define out[PASS_PARTICLES_DEFINES]) {
    const particles_state *s = particles_of(particles);
    out[0] = (shader_define){"PARTICLE_PARTS", parts_of(s) > 1 ? "2" : "1"};
    out[1] = (shader_define){"PARTICLE_QUANTITY", s->carries ? "1" : "0"};
    return PASS_PARTICLES_DEFINES;
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
static const char *const uniforms[] = {UNIFORMS(KERNEL_NAME_TEXT)};

#define SLOTS(NAME)                                                                                \
    NAME(ParticlePositions), NAME(ParticlePositionsMore), NAME(ParticleVelocities),                \
        NAME(ParticleVelocitiesMore), NAME(ParticleQuantities), NAME(BirthTriangles),              \
        NAME(BirthShares), NAME(Instances)
enum { SLOTS(KERNEL_NAME_ID), SLOT_COUNT };
static const char *const slots[] = {SLOTS(KERNEL_NAME_TEXT)};

static void find_values(const pass *particles, uint32_t out[UNIFORM_COUNT]) {
    const particles_state *s = particles_of(particles);
    const pass_host *host = particles->host;
    float seed[4];
    pass_evaluate_vector(particles, "seed", seed);
    const float back =
        (float)fmin(fmax(particles_reached(s) - host->context->time, 0), s->desc.time_step);
    out[N_particle_count] = s->desc.count;
    out[N_particle_used] = pass_particles_used(particles);
    out[N_particle_next] = (uint32_t)(s->clock.born % s->desc.count);
    out[N_particle_round] = (uint32_t)(s->clock.born - out[N_particle_next]);
    out[N_particle_seed] = (uint32_t)lrintf(seed[0]) + host->frame->size.v[3] * 2654435761u;
    memcpy(&out[N_particle_back], &back, sizeof back);
}

void pass_particles_write(const pass *particles, const shader_binary *binary,
                          unsigned char *block) {
    uint32_t values[UNIFORM_COUNT];
    find_values(particles, values);
    for (int i = 0; i < UNIFORM_COUNT; i++)
        pass_write_member(binary, block, uniforms[i], &values[i], sizeof values[i]);
}

// The particles that a pass has to do with: those that it is itself, or reads.
static const pass *source_of(const pass *p) {
    return pass_is(p, "particles") ? p : p->particles;
}

static void set_values(const pass *p, kernel *k, const kernel_place *places) {
    uint32_t values[UNIFORM_COUNT];
    if (!source_of(p)) return;
    find_values(source_of(p), values);
    for (int i = 0; i < UNIFORM_COUNT; i++)
        kernel_set_at(k, &places[i], &values[i], sizeof values[i]);
}

static gpu_buffer *find_buffer(const pass *particles, int slot) {
    const particles_state *s = particles_of(particles);
    gpu_buffer *const all[SLOT_COUNT] = {
        [N_ParticlePositions] = s->buffers.positions[0],
        [N_ParticlePositionsMore] = s->buffers.positions[1],
        [N_ParticleVelocities] = s->buffers.velocities[0],
        [N_ParticleVelocitiesMore] = s->buffers.velocities[1],
        [N_ParticleQuantities] = s->buffers.quantities,
        [N_BirthTriangles] = s->triangles,
        [N_BirthShares] = s->at.buffer,
        [N_Instances] = s->desc.at ? scene_instances_buffer(s->desc.at) : NULL,
    };
    return all[slot];
}

bool pass_particles_bind(const pass *particles, const char *name, gpu_binding *out) {
    *out = (gpu_binding){0};
    for (int i = 0; i < SLOT_COUNT; i++)
        if (strcmp(slots[i], name) == 0) out->buffer = find_buffer(particles, i);
    return out->buffer;
}

static bool bind(pass *p, int slot, gpu_binding *out) {
    const pass *from = source_of(p);
    out->buffer = from ? find_buffer(from, slot) : NULL;
    return out->buffer;
}

static size_t defines_of(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]) {
    return p->particles ? pass_particles_defines(p->particles, out) : 0;
}

const pass_provider pass_particles_provider = {
    .slots = {slots, SLOT_COUNT},
    .uniforms = {uniforms, UNIFORM_COUNT},
    .find = pass_find_particles,
    .defines = defines_of,
    .set = set_values,
    .bind = bind,
};
