// Deposit: particles added up in the cells of a box (add), then shown as an image (show), which
// leaves the sums empty.
#include "pass/deposit.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/particles.h"
#include "pass/pass_impl.h"
#include <math.h>
#include <string.h>

enum { GROUP = 256, ACROSS = 1024 }; // threads of a group of particles; such groups side by side

typedef enum deposit_stage { ADD, SHOW, STAGES } deposit_stage;

typedef struct deposit_state {
    field_grid grid; // first: the effect has it
    shader_binary binary[STAGES];
    gpu_pipeline *pipeline[STAGES];
    unsigned char *block[STAGES];
    gpu_buffer *sums;
    bool empty; // these are
} deposit_state;

static deposit_state *state_of(const pass *p) {
    return p->state;
}

// ---- the grid ---------------------------------------------------------------------------------

static const char *field_name(const field_grid *grid, size_t index) {
    (void)grid;
    return index == 0 ? "density" : NULL;
}

static int find_field(field_grid *grid, const char *name, int *components) {
    *components = 1;
    if (strcmp(name, "density") == 0) return 0;
    err_set("%s: no field '%s'; it has density", grid->name, name);
    return -1;
}

static uint32_t cells_along(float side, float longest, uint32_t resolution) {
    return (uint32_t)fmaxf(roundf(side / longest * (float)resolution), 1);
}

field_grid *pass_deposit_open(pass *p, const pass_deposit_desc *desc) {
    const box3 *b = &desc->box;
    const float sides[3] = {b->max.x - b->min.x, b->max.y - b->min.y, b->max.z - b->min.z};
    float longest = fmaxf(sides[0], fmaxf(sides[1], sides[2]));
    bool flat = !(sides[0] > 0 && sides[1] > 0 && sides[2] > 0 && longest < 1e6f);
    if (flat || desc->resolution < PASS_DEPOSIT_LEAST || desc->resolution > PASS_DEPOSIT_MOST) {
        if (flat)
            err_set("%s: 'box' is missing or flat; it is where particles are counted, as in box = "
                    "{ min = {-1, -1, 0}, max = {1, 1, 2} }",
                    p->label);
        else
            err_set("%s: 'resolution' is %u; %d to %d cells along the longest side are accepted",
                    p->label, desc->resolution, PASS_DEPOSIT_LEAST, PASS_DEPOSIT_MOST);
        return NULL;
    }
    deposit_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->grid = (field_grid){
        .name = p->label,
        .box = desc->box,
        .channel_count = 1,
        .state = {.active = desc->box},
        .field_name = field_name,
        .find_field = find_field,
    };
    for (int i = 0; i < 3; i++) s->grid.size[i] = cells_along(sides[i], longest, desc->resolution);
    return &s->grid;
}

// ---- life -------------------------------------------------------------------------------------

bool deposit_declare(pass *p) {
    deposit_state *s = state_of(p);
    int output = pass_find_image(p, "density");
    p->images[output] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.density", p->label),
                            .format = p->formats[output],
                            .width = s->grid.size[0],
                            .height = s->grid.size[1],
                            .depth = s->grid.size[2],
                        });
    if (!p->images[output].id) return false;
    pass_host_add_grid_image(p->host, &s->grid, 0, p->images[output]);
    return pass_add_to_graph(p);
}

static bool compile(pass *p, deposit_stage stage) {
    deposit_state *s = state_of(p);
    shader_define defines[PASS_PARTICLES_DEFINES + 2];
    size_t count = pass_particles_defines(pass_particles_of(p), defines);
    defines[count++] = (shader_define){stage == ADD ? "STAGE_ADD" : "STAGE_SHOW", "1"};
    if (stage == SHOW) defines[count++] = (shader_define){"WITHOUT_FIELDS", "1"};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, count, &s->binary[stage]);
}

bool deposit_check(pass *p) {
    return compile(p, ADD) && compile(p, SHOW);
}

bool deposit_build(pass *p) {
    deposit_state *s = state_of(p);
    for (int i = 0; i < STAGES; i++) {
        if (!compile(p, (deposit_stage)i)) return false;
        s->pipeline[i] = pass_create_compute(p, &s->binary[i]);
        s->block[i] = arena_alloc(p->host->memory, pass_block_size(&s->binary[i]) + 16);
        if (!s->pipeline[i]) return false;
    }
    p->binary = s->binary[ADD];
    return true;
}

bool deposit_allocate(pass *p) {
    deposit_state *s = state_of(p);
    const uint32_t *n = s->grid.size;
    if (!s->sums)
        s->sums = gpu_buffer_create(
            p->host->device,
            &(gpu_buffer_desc){.label = "sums of particles", .size = 4ull * n[0] * n[1] * n[2]});
    return s->sums || err_prefix("%s: ", p->label);
}

void deposit_destroy(pass *p) {
    deposit_state *s = state_of(p);
    for (int i = 0; s && i < STAGES; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(p->host->device, s->pipeline[i]);
    if (s && s->sums) gpu_buffer_destroy(p->host->device, s->sums);
}

// ---- a frame ----------------------------------------------------------------------------------

bool deposit_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const field_grid *grid = &state_of(p)->grid;
    const float cells[3] = {(float)grid->size[0], (float)grid->size[1], (float)grid->size[2]};
    pass_write_member(binary, block, "cells", cells, sizeof cells);
    pass_write_box(binary, block, grid->box);
    pass_particles_write(pass_particles_of(p), binary, block);
    return true;
}

static bool run(pass *p, deposit_stage stage, const uint32_t threads[3]) {
    deposit_state *s = state_of(p);
    const shader_binary *binary = &s->binary[stage];
    pass_override overrides[GPU_MAX_SLOTS] = {{"DepositSums", {.buffer = s->sums}}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {.pipeline = s->pipeline[stage], .bindings = bindings};
    memcpy(desc.threads, threads, sizeof desc.threads);
    size_t count = 1;
    for (size_t i = 0; i < binary->slot_count && count < GPU_MAX_SLOTS; i++) {
        overrides[count].name = binary->slots[i].name;
        count += pass_particles_bind(pass_particles_of(p), overrides[count].name,
                                     &overrides[count].binding);
    }
    return pass_fill_block(p, binary, s->block[stage]) &&
           pass_bind(p, binary, s->block[stage], overrides, count, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

bool deposit_record(pass *p) {
    deposit_state *s = state_of(p);
    uint32_t groups = (pass_particles_used(pass_particles_of(p)) + GROUP - 1) / GROUP;
    uint32_t across = groups < ACROSS ? groups : ACROSS;
    if (!pass_prepare(p)) return false;
    if (!s->empty) gpu_buffer_fill(p->host->device, s->sums, 0);
    s->empty = false; // until they are shown
    if (groups && !run(p, ADD, (uint32_t[3]){across * GROUP, (groups + across - 1) / across, 1}))
        return false;
    s->empty = run(p, SHOW, s->grid.size);
    s->grid.state.content++;
    return s->empty;
}
