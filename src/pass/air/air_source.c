// Sources of simulated air: passes of the types `lbm_source` and `pyro_source`, which the air's
// pass runs. Their fields become values of the cells of their box so many times a second of the
// simulation (air_turn), which is what costs; before each step the values are given to the air,
// where meshes are then. Near particles, which move on, they are found for each step
// (shaders/pass/air/source_particles.glsl).
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "pass/air/air_parts.h"
#include "sim/lbm.h"
#include "sim/pyro.h"
#include <string.h>

static bool air_source_declare(pass *p) {
    if (pass_given_field(p, N_radius) && !p->particles)
        return err_set("%s: 'radius' is of particles, and it has none; say whose, as in particles "
                       "= sparks",
                       p->label);
    return pass_given_field(p, N_shape) || p->mesh_count || p->particles ||
           err_set("%s: it has no place; give it a mesh, shape = sphere { ... } or particles = "
                   "sparks",
                   p->label);
}

static bool check_gives(const air *a, const pass *p) {
    strbuf names = {0};
    bool given = pass_gives(p, N_velocity_factor);
    for (size_t i = 0; i < a->kind->source_field_count; i++) {
        const int name = a->kind->source_fields[i];
        given = given || pass_given_field(p, name);
        strbuf_add(&names, "%s%s",
                   i == 0                                ? ""
                   : i + 1 < a->kind->source_field_count ? ", "
                                                         : " or ",
                   air_names[name]);
    }
    if (!given) err_set("%s: it gives the air nothing; say its %s", p->label, strbuf_text(&names));
    strbuf_free(&names);
    return given;
}

static bool samples(const air *a, const field *given) {
    for (size_t i = 0; i < a->kind->output_count; i++)
        if (field_samples(given, &a->grid, (int)i)) return true;
    return false;
}

static bool carries(const air *a, const pass *particles) {
    for (size_t i = 0; particles && i < particles->face->field_count; i++)
        if (particles->fields[i] && samples(a, particles->fields[i])) return true;
    return false;
}

bool air_is_read_by(const air *a, const pass *p, const char *instead) {
    for (size_t i = 0; i < p->face->field_count; i++) {
        const field *given = p->fields[i];
        if (given && (samples(a, given)))
            return err_set("%s: '%s' reads the air that it is given to; fields of other air, of "
                           "files and of shapes are accepted%s",
                           p->label, p->face->fields[i].name, instead),
                   true;
    }
    return false;
}

bool pass_air_add_source(pass *p, pass *source) {
    air *a = air_of(p);
    if (!check_gives(a, source) || air_is_read_by(a, source, "")) return false;
    air_source *s = source->state = arena_alloc(p->host->memory, sizeof *s);
    *s = (air_source){.air = a, .turn = UINT64_MAX, .coupled = carries(a, source->particles)};
    voxels_rule rule = (voxels_rule)pass_option(source, N_rule);
    air_meshes *meshes = source->mesh_count ? air_add_giver(a) : NULL;
    for (size_t i = 0; i < source->mesh_count; i++) air_add_body(meshes, source->meshes[i], rule);
    if (meshes) s->giver = a->giver_count;
    if (a->source_count < 32) s->note = UINT32_C(1) << a->source_count;
    source->runs_in = p;
    *MEM_ADD(a->sources, a->source_count, a->source_capacity) = source;
    bool fine = true;
    for (size_t i = 0; i < a->kind->source_field_count && fine; i++) {
        const int name = a->kind->source_fields[i];
        int components;
        fine =
            !pass_given_field(source, name) || pass_air_use(p, air_names[name], &components) >= 0;
    }
    return fine;
}

// ---- particles --------------------------------------------------------------------------------
// They come to the time of a frame before the air does, which looks back from there. Particles that
// the air carries cannot: they come after it, and it looks ahead from the frame before.

graph_image air_source_reads(const pass *source) {
    const air_source *s = source->state;
    if (!source->particles) return (graph_image){0};
    const graph_image image = source->images[pass_find_image(source, "particles")];
    return s->coupled ? graph_add_history(source->host->graph, image) : image;
}

bool air_source_waits(const pass *source) {
    const air_source *s = source->state;
    const pass *particles = source->particles;
    return particles && !s->coupled &&
           pass_get_simulation(particles)->left(particles, source->host->context->time) > 0;
}

static bool mark(pass *p, const air_source *s) {
    const uint32_t count = pass_particles_provider.count(p);
    if (!p->particles) return true;
    gpu_buffer_fill(p->host->device, s->marks, 0);
    kernel *k = count ? pass_use(p, AIR_MARK) : NULL;
    if (k) kernel_bind_buffer(k, N_SourceMarks, s->marks);
    return !count || (k && kernel_run_each(k, p->host->device, count));
}

// ---- building ---------------------------------------------------------------------------------

static bool air_source_defines(pass *p, size_t index, pass_defines *out) {
    const air_source *s = p->state;
    if (index == AIR_MARK) return p->particles;
    if (index == AIR_EVALUATE) return true;
    out->count += s->air->kind->source_defines(s->air, out->items + out->count);
    pass_define_flag(out, "MESHES", s->giver);
    return true;
}

static void air_source_destroy(pass *p) {
    air_source *s = p->state;
    if (!s) return;
    gpu_buffer_destroy(p->host->device, s->values);
    gpu_buffer_destroy(p->host->device, s->marks);
}

void air_forget_source(pass *source) {
    air_source *s = source->state;
    s->turn = UINT64_MAX;
}

bool air_source_is_away(const pass *source) {
    const air_source *s = source->state;
    return s->turn != UINT64_MAX && !s->met;
}

// ---- values -----------------------------------------------------------------------------------

static bool air_source_update(pass *p) {
    const air_source *s = p->state;
    pass_set_box(p, s->air->grid.box);
    pass_set_float(p, N_cell_size, (float)s->air->units.cell);
    pass_set(p, N_first, s->cells.first, sizeof s->cells.first);
    pass_set(p, N_count, s->cells.count, sizeof s->cells.count);
    pass_set_float(p, N_step_seconds, (float)air_step_seconds(s->air));
    pass_set_float(p, N_time_scale, (float)s->air->desc.time_scale);
    return true;
}

enum { SOURCE_VALUE = 16, SOURCE_MARK = 4 }; // bytes of a cell
static const char values_label[] = "values of a source", marks_label[] = "particles of a source";

// As much as wherever the box may move, so that frames seldom take any. One that grows gets more.
static uint64_t bytes_of(const pass *p, uint64_t each, uint64_t cells) {
    const uint64_t most = gpu_get_info(p->host->device)->max_storage_range;
    return each * cells < most ? each * cells : most;
}

static bool make_values(pass *p, air_source *s) {
    const float *n = s->cells.count;
    uint64_t size = SOURCE_VALUE * (uint64_t)n[0] * (uint64_t)n[1] * (uint64_t)n[2];
    uint64_t most = gpu_get_info(p->host->device)->max_storage_range;
    if (s->values && gpu_buffer_size(s->values) >= size) return true;
    if (size > most)
        return err_set("its box has %.0f x %.0f x %.0f cells, of which the device can bind %llu at "
                       "most; give 'shape' an end, as by the product with a box",
                       (double)n[0], (double)n[1], (double)n[2],
                       (unsigned long long)(most / SOURCE_VALUE));
    s->known = false;
    gpu *device = p->host->device;
    return gpu_buffer_make(device, &s->values, values_label, bytes_of(p, SOURCE_VALUE, s->most)) &&
           (!p->particles ||
            gpu_buffer_make(device, &s->marks, marks_label, bytes_of(p, SOURCE_MARK, s->most)));
}

// Values that depend on numbers only, and these are as they were, are known already.
static bool are_known(const pass *p, const air_source *s) {
    const field_texture *textures;
    return s->known && !p->particles && field_program_textures(p->program, &textures) == 0 &&
           memcmp(s->last, p->numbers, field_program_block_size(p->program)) == 0 &&
           memcmp(&s->last_cells, &s->cells, sizeof s->cells) == 0;
}

static bool find_values(pass *p, air_source *s) {
    if (!make_values(p, s) || !pass_prepare(p)) return false;
    if (are_known(p, s)) return true;
    const size_t size = field_program_block_size(p->program);
    if (!s->last) s->last = arena_alloc(p->host->memory, size + 16);
    memcpy(s->last, p->numbers, size);
    s->last_cells = s->cells;
    if (!mark(p, s)) return false;
    kernel *k = pass_use(p, AIR_EVALUATE);
    if (k) kernel_bind_buffer(k, N_SourceValues, s->values);
    if (k && s->marks) kernel_bind_buffer(k, N_SourceMarks, s->marks);
    const float *n = s->cells.count;
    s->known = k && kernel_run(k, p->host->device, (uint32_t)n[0], (uint32_t)n[1], (uint32_t)n[2]);
    return s->known;
}

// What the first turn takes; of a box that cannot be evaluated, which its frame will tell, nothing.
static void air_source_list_memory(const pass *p, budget_list *out) {
    const air_source *s = p->state;
    pass_host *host = p->host;
    const field_context *now = host->context;
    field_context first = *now;
    double end;
    air_cells cells;
    uint64_t most;
    air_turn(s->air, &first.time, &end);
    host->context = &first;
    if (!s->values && air_source_cells(s->air, p, end, &cells, &most)) {
        budget_list_add(out, values_label, bytes_of(p, SOURCE_VALUE, most));
        if (p->particles) budget_list_add(out, marks_label, bytes_of(p, SOURCE_MARK, most));
    }
    host->context = now;
}

// As of the beginning of the turn, whenever in it that is. Particles move on with each step, and
// are as in the middle of it.
static bool begin_turn(pass *p, air_source *s) {
    double begin, end;
    uint64_t turn = air_turn(s->air, &begin, &end);
    if (p->particles) {
        turn = s->air->kind->steps(s->air);
        end = air_step_time(s->air, turn + 1);
        begin = 0.5 * (air_step_time(s->air, turn) + end);
    }
    if (turn == s->turn) return true;
    pass_host *host = p->host;
    const field_context *now = host->context;
    field_context first = *now;
    first.time = begin;
    host->context = &first;
    bool done = air_source_cells(s->air, p, end, &s->cells, &s->most) &&
                (s->cells.count[0] <= 0 || find_values(p, s));
    host->context = now;
    s->turn = done ? turn : UINT64_MAX;
    s->met = s->met || s->cells.count[0] > 0;
    return done;
}

// ---- a step -----------------------------------------------------------------------------------

static bool source_give(pass *p, air_source *s) {
    const air *a = s->air;
    voxels *meshes = s->giver ? a->givers[s->giver - 1].cells : NULL;
    kernel *k = pass_use(p, AIR_GIVE);
    if (!k || !pass_evaluate_values(p)) return false;
    const double rate = (double)pass_value(p, N_rate);
    air_source_update(p);
    kernel_set_float(k, N_velocity_factor, pass_value(p, N_velocity_factor));
    kernel_set_float(k, N_share, rate > 0 ? (float)sim_decay(&a->units, rate) : 1);
    kernel_bind_buffer(k, N_SourceValues, s->values);
    if (meshes) kernel_bind_buffer(k, N_SourceIds, voxels_ids(meshes));
    if (meshes) kernel_bind_buffer(k, N_SourceMotions, voxels_motions(meshes));
    uint32_t threads[3];
    for (int i = 0; i < 3; i++) threads[i] = (uint32_t)s->cells.count[i];
    a->kind->bind(a, p, AIR_GIVE, k);
    return a->kind->give(a, p, k, threads) &&
           kernel_run(k, p->host->device, threads[0], threads[1], threads[2]);
}

// Whether it gives in a step that begins at the host's time. While the air warms up there are no
// particles: they are those of the frames from 0 on.
static bool gives_now(pass *p, const air_source *s, bool *gives) {
    float during[4];
    const double time = p->host->context->time;
    *gives = false;
    if (p->particles && time < 0) return true;
    if (!pass_evaluate_now(p, N_during, during)) return false;
    *gives = time + air_step_seconds(s->air) > (double)during[0] && time < (double)during[1];
    return true;
}

bool air_run_source(pass *p) {
    air_source *s = p->state;
    bool gives;
    if (!gives_now(p, s, &gives)) return err_prefix("%s: ", p->label);
    if (!gives) return true;
    if (begin_turn(p, s) && (s->cells.count[0] <= 0 || source_give(p, s))) return true;
    return err_prefix("%s: ", p->label);
}

#define SOURCE_TYPE(KIND)                                                                          \
    {                                                                                              \
        .name = #KIND "_source", .constructed = true, .shader = "pass/air/" #KIND "_source.comp",  \
        .kernels =                                                                                 \
            (const pass_kernel[AIR_SOURCE_KERNELS]){                                               \
                [AIR_EVALUATE] = {.define = "STAGE_EVALUATE"},                                     \
                [AIR_MARK] = {.define = "STAGE_MARK"},                                             \
                [AIR_GIVE] = {.shader = "pass/air/" #KIND "/give.comp", .without_fields = true},   \
            },                                                                                     \
        .kernel_count = AIR_SOURCE_KERNELS, .names = {air_names, AIR_NAME_COUNT},                  \
        .solver = &KIND##_kernel_table, .unscaled = true, .meshes = PASS_USES_MESHES,              \
        .declare = air_source_declare, .defines = air_source_defines,                              \
        .list_memory = air_source_list_memory, .update = air_source_update,                        \
        .destroy = air_source_destroy,                                                             \
    }

const pass_type lbm_source_type = SOURCE_TYPE(lbm);
const pass_type pyro_source_type = SOURCE_TYPE(pyro);
