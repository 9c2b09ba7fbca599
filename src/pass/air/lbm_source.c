// Sources of simulated air: passes of the type `lbm_source`, which the air's pass runs. Their
// fields become values of the cells of their box so many times a second of the simulation
// (lbm_air_turn), which is what costs; before each step the values are given to the air, where
// meshes are then.
#include "base/error.h"
#include "base/memory.h"
#include "pass/air/lbm_parts.h"
#include <string.h>

static const int fields[PASS_FLUID_NAMES] = {N_density, N_temperature, N_dye, N_pressure,
                                             N_velocity};

enum { EVALUATE, GIVE, KERNELS };
static const pass_kernel kernels[KERNELS] = {
    [GIVE] = {.shader = "pass/air/lbm/give.comp", .without_fields = true},
};

typedef struct source_state {
    lbm_air *air;
    uint32_t note;       // its bit of the guard's notes; 0: there was none left
    size_t giver;        // which of the air's are its meshes, from 1; 0: it has none
    uint64_t turn;       // in which the values were found; UINT64_MAX: never
    lbm_cells cells;     // of its box in this turn
    uint64_t most;       // cells that the box has, wherever it is
    gpu_buffer *values;  // of as many; NULL: none yet
    unsigned char *last; // the numbers that they were found with
    lbm_cells last_cells;
    bool known; // these two
    bool met;   // it has been in the air's box
} source_state;

static bool gives(const pass *p) {
    for (int i = 0; i < PASS_FLUID_NAMES; i++)
        if (pass_given_field(p, fields[i])) return true;
    return pass_gives(p, N_velocity_factor);
}

static bool lbm_source_declare(pass *p) {
    if (!pass_given_field(p, N_shape) && !p->mesh_count)
        return err_set("%s: it has no place; give it a mesh, or shape = sphere { ... }", p->label);
    return gives(p) || err_set("%s: it gives the air nothing; say its density, temperature, dye, "
                               "velocity or pressure",
                               p->label);
}

// What the air holds is known when a step is done, and a source gives before it.
static bool reads_itself(const lbm_air *a, const pass *source) {
    for (size_t i = 0; i < source->face->field_count; i++) {
        const field *given = source->fields[i];
        if (given && (field_samples(given, &a->grid, 0) || field_samples(given, &a->grid, 1)))
            return err_set("%s: '%s' reads the air that it is given to; fields of other air, of "
                           "files and of shapes are accepted",
                           source->label, source->face->fields[i].name),
                   true;
    }
    return false;
}

bool pass_lbm_add_source(pass *p, pass *source) {
    lbm_air *a = lbm_air_of(p);
    if (reads_itself(a, source)) return false;
    source_state *s = source->state = arena_alloc(p->host->memory, sizeof *s);
    *s = (source_state){.air = a, .turn = UINT64_MAX};
    voxels_rule rule = (voxels_rule)pass_option(source, N_rule);
    lbm_meshes *meshes = source->mesh_count ? lbm_air_add_giver(a) : NULL;
    for (size_t i = 0; i < source->mesh_count; i++)
        lbm_air_add_body(meshes, source->meshes[i], rule);
    if (meshes) s->giver = a->giver_count;
    if (a->source_count < 32) s->note = UINT32_C(1) << a->source_count;
    source->runs_in = p;
    MEM_RESERVE(a->sources, a->source_count + 1, a->source_capacity);
    a->sources[a->source_count++] = source;
    for (int i = 0; i < PASS_FLUID_NAMES; i++)
        if (pass_given_field(source, fields[i])) a->used[i] = true;
    return true;
}

// ---- building ---------------------------------------------------------------------------------

static bool lbm_source_defines(pass *p, size_t index, pass_defines *out) {
    const source_state *s = p->state;
    if (index == EVALUATE) return true;
    out->count += lbm_defines(s->air->solver, out->items + out->count);
    pass_define_flag(out, "MESHES", s->giver);
    return true;
}

static void lbm_source_destroy(pass *p) {
    source_state *s = p->state;
    if (s) gpu_buffer_destroy(p->host->device, s->values);
}

void lbm_air_forget_source(pass *source) {
    source_state *s = source->state;
    s->turn = UINT64_MAX;
}

bool lbm_source_is_buried(const pass *source) {
    const source_state *s = source->state;
    const uint32_t *notes = s->air->report.notes;
    return (notes[0] & ~notes[1] & s->note) != 0;
}

bool lbm_source_is_away(const pass *source) {
    const source_state *s = source->state;
    return s->turn != UINT64_MAX && !s->met;
}

// ---- values -----------------------------------------------------------------------------------

static bool lbm_source_update(pass *p) {
    const source_state *s = p->state;
    pass_set_box(p, s->air->grid.box);
    pass_set_float(p, N_cell_size, (float)s->air->units.cell);
    pass_set(p, N_first, s->cells.first, sizeof s->cells.first);
    pass_set(p, N_count, s->cells.count, sizeof s->cells.count);
    return true;
}

enum { SOURCE_VALUE = 16 }; // bytes of a cell
static const char values_label[] = "values of a source";

// As much as wherever the box may move, so that frames seldom take any. One that grows gets more.
static uint64_t values_bytes(const pass *p, uint64_t cells) {
    const uint64_t most = gpu_get_info(p->host->device)->max_storage_range;
    return SOURCE_VALUE * cells < most ? SOURCE_VALUE * cells : most;
}

static bool make_values(pass *p, source_state *s) {
    const float *n = s->cells.count;
    uint64_t size = SOURCE_VALUE * (uint64_t)n[0] * (uint64_t)n[1] * (uint64_t)n[2];
    uint64_t most = gpu_get_info(p->host->device)->max_storage_range;
    if (s->values && gpu_buffer_size(s->values) >= size) return true;
    if (size > most)
        return err_set("its box has %.0f x %.0f x %.0f cells, of which the device can bind %llu at "
                       "most; give 'shape' an end, as by the product with a box",
                       (double)n[0], (double)n[1], (double)n[2],
                       (unsigned long long)(most / SOURCE_VALUE));
    if (s->values) gpu_buffer_destroy(p->host->device, s->values);
    s->values =
        gpu_buffer_create(p->host->device, &(gpu_buffer_desc){.label = values_label,
                                                              .size = values_bytes(p, s->most)});
    s->known = false;
    return s->values != NULL;
}

// Values that depend on numbers only, and these are as they were, are known already.
static bool are_known(const pass *p, const source_state *s) {
    const field_texture *textures;
    return s->known && field_program_textures(p->program, &textures) == 0 &&
           memcmp(s->last, p->numbers, field_program_block_size(p->program)) == 0 &&
           memcmp(&s->last_cells, &s->cells, sizeof s->cells) == 0;
}

static bool find_values(pass *p, source_state *s) {
    if (!make_values(p, s) || !pass_prepare(p)) return false;
    if (are_known(p, s)) return true;
    const size_t size = field_program_block_size(p->program);
    if (!s->last) s->last = arena_alloc(p->host->memory, size + 16);
    memcpy(s->last, p->numbers, size);
    s->last_cells = s->cells;
    kernel *k = pass_use(p, EVALUATE);
    if (k) kernel_bind_buffer(k, N_SourceValues, s->values);
    const float *n = s->cells.count;
    s->known = k && kernel_run(k, p->host->device, (uint32_t)n[0], (uint32_t)n[1], (uint32_t)n[2]);
    return s->known;
}

// What the first turn takes; of a box that cannot be evaluated, which its frame will tell, nothing.
static void lbm_source_list_memory(const pass *p, budget_list *out) {
    const source_state *s = p->state;
    pass_host *host = p->host;
    const field_context *now = host->context;
    field_context first = *now;
    double end;
    lbm_cells cells;
    uint64_t most;
    lbm_air_turn(s->air, &first.time, &end);
    host->context = &first;
    if (!s->values && lbm_source_cells(s->air, p, end, &cells, &most))
        budget_list_add(out, values_label, values_bytes(p, most));
    host->context = now;
}

// As of the beginning of the turn, whenever in it that is.
static bool begin_turn(pass *p, source_state *s) {
    double begin, end;
    uint64_t turn = lbm_air_turn(s->air, &begin, &end);
    if (turn == s->turn) return true;
    pass_host *host = p->host;
    const field_context *now = host->context;
    field_context first = *now;
    first.time = begin;
    host->context = &first;
    bool done = lbm_source_cells(s->air, p, end, &s->cells, &s->most) &&
                (s->cells.count[0] <= 0 || find_values(p, s));
    host->context = now;
    s->turn = done ? turn : UINT64_MAX;
    s->met = s->met || s->cells.count[0] > 0;
    return done;
}

// ---- a step -----------------------------------------------------------------------------------

static bool lbm_source_give(pass *p, source_state *s) {
    const lbm_air *a = s->air;
    const uint32_t depth = lbm_depth(a->solver);
    voxels *meshes = s->giver ? a->givers[s->giver - 1].cells : NULL;
    uint32_t threads[3];
    kernel *k = pass_use(p, GIVE);
    if (!k || !pass_evaluate_values(p)) return false;
    const double rate = (double)pass_value(p, N_rate);
    lbm_source_update(p);
    kernel_set_float(k, N_step_speed, (float)sim_velocity(&a->units, 1));
    kernel_set_float(k, N_clamp_speed, lbm_air_clamp_speed(a));
    kernel_set_float(k, N_velocity_factor, pass_value(p, N_velocity_factor));
    kernel_set_float(k, N_pascal, (float)(1 / lbm_air_pascals(a)));
    kernel_set_int(k, N_note, (int32_t)s->note);
    kernel_set_float(k, N_share, rate > 0 ? (float)sim_decay(&a->units, rate) : 1);
    kernel_set_int(k, N_lbm_parity, (int32_t)lbm_parity(a->solver));
    lbm_bind(a->solver, k, pass_solver_places(p, GIVE));
    kernel_bind_buffer(k, N_SourceValues, s->values);
    kernel_bind_buffer(k, N_SourceNotes, lbm_guard_notes(a->guard));
    if (meshes) kernel_bind_buffer(k, N_SourceIds, voxels_ids(meshes));
    if (meshes) kernel_bind_buffer(k, N_SourceMotions, voxels_motions(meshes));
    for (int i = 0; i < 3; i++) threads[i] = (uint32_t)s->cells.count[i];
    if (threads[2] > depth) threads[2] = depth;
    return kernel_run(k, p->host->device, threads[0], threads[1], threads[2]);
}

bool lbm_air_run_source(pass *p) {
    source_state *s = p->state;
    if (begin_turn(p, s) && (s->cells.count[0] <= 0 || lbm_source_give(p, s))) return true;
    return err_prefix("%s: ", p->label);
}

const pass_type lbm_source_type = {
    .name = "lbm_source",
    .constructed = true,
    .shader = "pass/air/lbm_source.comp",
    .kernels = kernels,
    .kernel_count = KERNELS,
    .names = {lbm_names, LBM_NAME_COUNT},
    .solver = &lbm_kernel_table,
    .unscaled = true,
    .meshes = PASS_USES_MESHES,
    .declare = lbm_source_declare,
    .defines = lbm_source_defines,
    .list_memory = lbm_source_list_memory,
    .update = lbm_source_update,
    .destroy = lbm_source_destroy,
};
