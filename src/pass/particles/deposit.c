// Deposit: particles added up in the cells of a box (add), then shown as an image (show), which
// leaves the sums empty.
#include "pass/particles/deposit.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/particles/particles.h"
#include "pass/pass_impl.h"
#include <math.h>
#include <string.h>

#define NAMES(NAME) NAME(density), NAME(velocity), NAME(moving), NAME(cells), NAME(DepositSums)
KERNEL_NAMES(NAMES);

enum { ADD, SHOW, STAGES };
static const pass_kernel kernels[STAGES] = {
    [ADD] = {.define = "STAGE_ADD"},
    [SHOW] = {.define = "STAGE_SHOW", .without_fields = true},
};

typedef struct deposit_state {
    field_grid grid; // first: the effect has it
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
    const bool velocity = strcmp(name, "velocity") == 0;
    *components = velocity ? 3 : 1;
    if (velocity) return 4; // the first channel of the second image
    if (strcmp(name, "density") == 0) return 0;
    err_set("%s: no field '%s'; it has density and velocity", grid->name, name);
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
        .channel_count = 7,
        .state = {.active = desc->box},
        .field_name = field_name,
        .find_field = find_field,
    };
    for (int i = 0; i < 3; i++) s->grid.size[i] = cells_along(sides[i], longest, desc->resolution);
    return &s->grid;
}

// ---- life -------------------------------------------------------------------------------------

static bool deposit_declare(pass *p) {
    deposit_state *s = state_of(p);
    const uint32_t *n = s->grid.size;
    const graph_image_desc size = {.width = n[0], .height = n[1], .depth = n[2]};
    graph_image_desc optional = size;
    optional.optional = true;
    if (!pass_add_output(p, N_density, size) || !pass_add_output(p, N_velocity, optional))
        return false;
    pass_host_add_grid_image(p->host, &s->grid, 0, *pass_image(p, N_density));
    pass_host_add_grid_image(p->host, &s->grid, 1, *pass_image(p, N_velocity));
    return pass_add_to_graph(p);
}

static size_t deposit_buffers(const pass *p, pass_buffer out[PASS_BUFFERS]) {
    deposit_state *s = p->state;
    const uint32_t *n = s->grid.size;
    const uint64_t sums = graph_is_read(p->host->graph, *pass_image(p, N_velocity)) ? 5 : 1;
    out[0] = (pass_buffer){&s->sums, "sums of particles", 4 * sums * n[0] * n[1] * n[2]};
    return 1;
}

// ---- a frame ----------------------------------------------------------------------------------

static bool deposit_update(pass *p) {
    const field_grid *grid = &state_of(p)->grid;
    const float cells[3] = {(float)grid->size[0], (float)grid->size[1], (float)grid->size[2]};
    pass_set(p, N_cells, cells, sizeof cells);
    pass_set_int(p, N_moving, graph_is_read(p->host->graph, *pass_image(p, N_velocity)));
    pass_set_box(p, grid->box);
    return true;
}

static bool add(pass *p, const deposit_state *s) {
    kernel *k = pass_use(p, ADD);
    if (k) kernel_bind_buffer(k, N_DepositSums, s->sums);
    return k && kernel_run_each(k, p->host->device, pass_particles_used(p->particles));
}

static bool show(pass *p, const deposit_state *s) {
    const uint32_t *n = s->grid.size;
    kernel *k = pass_use(p, SHOW);
    if (k) kernel_bind_buffer(k, N_DepositSums, s->sums);
    return k && kernel_run(k, p->host->device, n[0], n[1], n[2]);
}

static bool deposit_record(pass *p) {
    deposit_state *s = state_of(p);
    if (!pass_prepare(p)) return false;
    if (!s->empty) gpu_buffer_fill(p->host->device, s->sums, 0);
    s->empty = false; // until they are shown
    s->empty = add(p, s) && show(p, s);
    s->grid.state.content++;
    return s->empty;
}

const pass_type deposit_type = {
    .name = "deposit",
    .constructed = true,
    .shader = "pass/particles/deposit.comp",
    PASS_KERNELS,
    .unscaled = true,
    .declare = deposit_declare,
    .update = deposit_update,
    .record = deposit_record,
    .buffers = deposit_buffers,
};
