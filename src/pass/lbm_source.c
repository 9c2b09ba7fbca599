// Sources of simulated air: passes of the type `lbm_source`, which the air's pass runs. Their
// fields become values of the cells of their box so many times a second of the simulation
// (lbm_air_turn), which is what costs; before each step the values are given to the air, where
// meshes are then.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/lbm_parts.h"
#include <string.h>

static const char give_shader[] = "pass/lbm/give.comp";

typedef struct source_state {
    lbm_air *air;
    uint32_t note; // its bit of the guard's notes; 0: there was none left
    size_t giver;  // which of the air's are its meshes, from 1; 0: it has none
    shader_binary give;
    gpu_pipeline *pipeline; // that gives
    unsigned char *block;   // of its uniforms
    uint64_t turn;          // in which the values were found; UINT64_MAX: never
    lbm_cells cells;        // of its box in this turn
    gpu_buffer *values;     // of these; NULL: none yet
    unsigned char *last;    // the numbers that they were found with
    lbm_cells last_cells;
    bool known; // these two
    bool met;   // it has been in the air's box
} source_state;

static bool gives(const pass *p) {
    size_t index;
    for (int i = 0; i < PASS_LBM_NAMES; i++)
        if (pass_find_key(p, pass_lbm_names[i], &index) == PASS_FIELD && p->fields[index])
            return true;
    return pass_find_key(p, "velocity_factor", &index) == PASS_UNIFORM && p->uniforms[index];
}

bool lbm_source_declare(pass *p) {
    if (!lbm_source_shape(p) && !p->mesh_count)
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
    size_t option;
    pass_find_key(source, "rule", &option);
    voxels_rule rule = (voxels_rule)source->options[option];
    lbm_meshes *meshes = source->mesh_count ? lbm_air_add_giver(a) : NULL;
    for (size_t i = 0; i < source->mesh_count; i++)
        lbm_air_add_body(meshes, source->meshes[i], rule);
    if (meshes) s->giver = a->giver_count;
    if (a->source_count < 32) s->note = UINT32_C(1) << a->source_count;
    source->runs_in = p;
    MEM_RESERVE(a->sources, a->source_count + 1, a->source_capacity);
    a->sources[a->source_count++] = source;
    for (int i = 0; i < PASS_LBM_NAMES; i++) {
        size_t index;
        if (pass_find_key(source, pass_lbm_names[i], &index) == PASS_FIELD && source->fields[index])
            a->used[i] = true;
    }
    return true;
}

// ---- building ---------------------------------------------------------------------------------

static bool compile(pass *p) {
    source_state *s = p->state;
    shader_define defines[LBM_MAX_DEFINES + 2];
    size_t count = lbm_defines(s->air->solver, defines);
    defines[count++] = (shader_define){"MESHES", s->giver ? "1" : "0"};
    defines[count++] = (shader_define){"WITHOUT_FIELDS", ""};
    return pass_compile(p, p->shader, SHADER_COMPUTE, NULL, 0, &p->binary) &&
           pass_compile(p, give_shader, SHADER_COMPUTE, defines, count, &s->give);
}

bool lbm_source_check(pass *p) {
    return compile(p);
}

bool lbm_source_build(pass *p) {
    source_state *s = p->state;
    if (!compile(p)) return false;
    s->block = arena_alloc(p->host->memory, pass_block_size(&s->give) + 16);
    s->last = arena_alloc(p->host->memory, field_program_block_size(p->program) + 16);
    p->pipeline = pass_create_compute(p, &p->binary);
    s->pipeline = pass_create_compute(p, &s->give);
    return p->pipeline && s->pipeline;
}

void lbm_source_destroy(pass *p) {
    source_state *s = p->state;
    if (!s) return;
    if (s->pipeline) gpu_pipeline_destroy(p->host->device, s->pipeline);
    if (s->values) gpu_buffer_destroy(p->host->device, s->values);
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

static void write_place(const source_state *s, const shader_binary *binary, unsigned char *block) {
    const float cell = (float)s->air->units.cell;
    pass_write_box(binary, block, s->air->grid.box);
    pass_write_member(binary, block, "cell_size", &cell, sizeof cell);
    pass_write_member(binary, block, "first", s->cells.first, sizeof s->cells.first);
    pass_write_member(binary, block, "count", s->cells.count, sizeof s->cells.count);
}

bool lbm_source_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    write_place(p->state, binary, block);
    return true;
}

static bool make_values(pass *p, source_state *s) {
    const float *n = s->cells.count;
    uint64_t size = 16 * (uint64_t)n[0] * (uint64_t)n[1] * (uint64_t)n[2];
    uint64_t most = gpu_get_info(p->host->device)->max_storage_range;
    if (s->values && gpu_buffer_size(s->values) >= size) return true;
    if (size > most)
        return err_set("its box has %.0f x %.0f x %.0f cells, of which the device can bind %llu at "
                       "most; give 'shape' an end, as by the product with a box",
                       (double)n[0], (double)n[1], (double)n[2], (unsigned long long)(most / 16));
    if (s->values) gpu_buffer_destroy(p->host->device, s->values);
    s->values = gpu_buffer_create(p->host->device,
                                  &(gpu_buffer_desc){.label = "values of a source", .size = size});
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
    memcpy(s->last, p->numbers, field_program_block_size(p->program));
    s->last_cells = s->cells;
    const pass_override overrides[] = {{"SourceValues", {.buffer = s->values}}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc dispatch = {.pipeline = p->pipeline, .bindings = bindings};
    for (int i = 0; i < 3; i++) dispatch.threads[i] = (uint32_t)s->cells.count[i];
    s->known =
        pass_bind(p, &p->binary, p->block, overrides, 1, bindings, &dispatch.binding_count) &&
        gpu_dispatch(p->host->device, &dispatch);
    return s->known;
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
    bool done = lbm_source_cells(s->air, p, end, &s->cells) &&
                (s->cells.count[0] <= 0 || find_values(p, s));
    host->context = now;
    s->turn = done ? turn : UINT64_MAX;
    s->met = s->met || s->cells.count[0] > 0;
    return done;
}

// ---- a step -----------------------------------------------------------------------------------

static bool fill_give(const pass *p, source_state *s) {
    const lbm_air *a = s->air;
    float rate[4], factor[4];
    if (!pass_evaluate_vector(p, "rate", rate) ||
        !pass_evaluate_vector(p, "velocity_factor", factor))
        return false;
    const float speed = (float)sim_velocity(&a->units, 1);
    const float most = lbm_air_clamp_speed(a);
    const float share = rate[0] > 0 ? (float)sim_decay(&a->units, (double)rate[0]) : 1;
    const float pascal = (float)(1 / lbm_air_pascals(a));
    const uint32_t parity = lbm_parity(a->solver);
    write_place(s, &s->give, s->block);
    pass_write_member(&s->give, s->block, "step_speed", &speed, sizeof speed);
    pass_write_member(&s->give, s->block, "clamp_speed", &most, sizeof most);
    pass_write_member(&s->give, s->block, "velocity_factor", factor, sizeof *factor);
    pass_write_member(&s->give, s->block, "pascal", &pascal, sizeof pascal);
    pass_write_member(&s->give, s->block, "note", &s->note, sizeof s->note);
    pass_write_member(&s->give, s->block, "share", &share, sizeof share);
    pass_write_member(&s->give, s->block, "lbm_parity", &parity, sizeof parity);
    return true;
}

static gpu_buffer *find_buffer(const source_state *s, const char *name) {
    voxels *meshes = s->giver ? s->air->givers[s->giver - 1].cells : NULL;
    if (strcmp(name, "SourceValues") == 0) return s->values;
    if (strcmp(name, "SourceNotes") == 0) return lbm_guard_notes(s->air->guard);
    if (meshes && strcmp(name, "SourceIds") == 0) return voxels_ids(meshes);
    return meshes && strcmp(name, "SourceMotions") == 0 ? voxels_motions(meshes) : NULL;
}

static size_t override(const source_state *s, pass_override out[GPU_MAX_SLOTS]) {
    size_t count = 0;
    for (size_t i = 0; i < s->give.slot_count; i++) {
        const char *name = s->give.slots[i].name;
        gpu_binding *binding = &out[count].binding;
        if (!lbm_bind(s->air->solver, name, binding))
            *binding = (gpu_binding){.buffer = find_buffer(s, name)};
        out[count].name = name;
        count += binding->buffer || binding->image;
    }
    return count;
}

static bool give(pass *p, source_state *s) {
    const uint32_t depth = lbm_depth(s->air->solver);
    pass_override overrides[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc dispatch = {.pipeline = s->pipeline, .bindings = bindings};
    for (int i = 0; i < 3; i++) dispatch.threads[i] = (uint32_t)s->cells.count[i];
    if (dispatch.threads[2] > depth) dispatch.threads[2] = depth;
    if (!fill_give(p, s)) return false;
    size_t count = override(s, overrides);
    return pass_bind(p, &s->give, s->block, overrides, count, bindings, &dispatch.binding_count) &&
           gpu_dispatch(p->host->device, &dispatch);
}

bool lbm_air_run_source(pass *p) {
    source_state *s = p->state;
    if (begin_turn(p, s) && (s->cells.count[0] <= 0 || give(p, s))) return true;
    return err_prefix("%s: ", p->label);
}
