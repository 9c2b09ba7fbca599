// The pass type `slices`: what it is made of is known when the script has run. In a frame it does
// its steps, then the grid as of the frame's time.
#include "pass/slices/slices.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/swap.h"
#include "pass/slices/slices_templates_parts.h"
#include <string.h>

const char *const slices_names[SLICES_NAME_COUNT] = {SLICES_NAMES(KERNEL_NAME_TEXT)};
static const pass_kernel kernels[SLICES_KERNELS] = {
    [SLICES_DRAW] = {.shader = "pass/slices/templates_draw.comp", .without_fields = true},
};

// ---- the grid ---------------------------------------------------------------------------------

// Where slices stand in space changes nothing of what flows in them.
static bool same_flow(const slices_flow *a, const slices_flow *b) {
    return a->desc.height == b->desc.height && a->clock.step == b->clock.step &&
           a->clock.warm_up == b->clock.warm_up;
}

static bool exchange_grids(field_grid *grid, field_grid *other) {
    slices_flow *a = (slices_flow *)grid, *b = (slices_flow *)other;
    if (!a->solver || !b->solver || !same_flow(a, b) || !flow_exchange(a->solver, b->solver))
        return false;
    if (a->templates && b->templates) template_set_exchange(&a->templates->set, &b->templates->set);
    SWAP(a->fresh, b->fresh);
    slices_forget(a);
    slices_forget(b);
    return true;
}

static const char *field_name(const field_grid *grid, size_t index) {
    const slices_flow *f = (const slices_flow *)grid;
    for (int i = 0; i < PASS_FLUID_NAMES; i++)
        if (f->used[i] && index-- == 0) return pass_fluid_fields[i].name;
    return NULL;
}

static int find_field(field_grid *grid, const char *name, int *components) {
    return pass_slices_use(((slices_flow *)grid)->pass, name, components);
}

static bool slices_check_desc(const pass *p, const pass_slices_desc *d) {
    float length = d->axis.x * d->axis.x + d->axis.y * d->axis.y + d->axis.z * d->axis.z;
    if (!(d->height >= 1e-6 && d->height <= 1e6))
        return err_set("%s: 'height' is %g m; accepted: 1e-6 to 1e6", p->label, d->height);
    if (!(length > 1e-12f))
        return err_set("%s: 'axis' is {0, 0, 0}; a direction is accepted", p->label);
    if (!(d->time_step >= 1e-5 && d->time_step <= 3600))
        return err_set("%s: 'time_step' is %g s; accepted: 1e-5 to 3600", p->label, d->time_step);
    if (!(d->warm_up >= 0 && d->warm_up <= 86400))
        return err_set("%s: 'warm_up' is %g s; accepted: 0 to 86400", p->label, d->warm_up);
    return true;
}

static field_grid grid_of(const slices_flow *f, const field_extrusion *extrusion) {
    box3 box = field_extrusion_box(extrusion);
    return (field_grid){
        .name = f->pass->label,
        .box = box,
        .size = {f->desc.size[0], f->desc.size[1], f->desc.count + 1},
        .channel_count = PASS_FLUID_CHANNELS,
        .simulated = true,
        .extruded = extrusion,
        .state = {.active = box},
        .exchange = exchange_grids,
        .field_name = field_name,
        .find_field = find_field,
    };
}

field_grid *pass_slices_open(pass *p, const pass_slices_desc *desc) {
    if (!slices_check_desc(p, desc)) return NULL;
    slices_flow *f = p->state = arena_alloc(p->host->memory, sizeof *f);
    double cell = desc->height / desc->size[1];
    *f = (slices_flow){
        .pass = p,
        .desc = *desc,
        .width = cell * desc->size[0],
        .cell = cell,
        .clock = {.step = desc->time_step, .warm_up = desc->warm_up},
        .fresh = true,
        .shown_steps = UINT64_MAX,
    };
    f->extrusion = field_extrusion_make(desc->position, desc->axis, (float)f->width,
                                        (float)desc->height, desc->count);
    f->extrusion.vectors = 1u << PASS_FLUID_VELOCITY / 4;
    f->grid = grid_of(f, &f->extrusion);
    f->used[PASS_FLUID_DENSITY] = true;
    static const char *const parts[SLICES_LABELS] = {"step", "sources", "templates", "fields"};
    for (int i = 0; i < SLICES_LABELS; i++)
        f->labels[i] = arena_format(p->host->memory, "%s.%s", p->label, parts[i]);
    return &f->grid;
}

const field_grid *pass_slices_only(pass *p, uint32_t slice) {
    slices_flow *f = slices_of(p);
    if (f->only[slice]) return f->only[slice];
    field_extrusion *extrusion = &f->only_extrusion[slice];
    *extrusion = f->extrusion;
    extrusion->only = (int)slice;
    field_grid *grid = f->only[slice] = arena_alloc(p->host->memory, sizeof *grid);
    *grid = grid_of(f, extrusion);
    for (int i = 0; i < PASS_FLUID_CHANNELS / 4; i++)
        pass_host_add_grid_image(p->host, grid, i, pass_grid_image(p->host, &f->grid, i));
    return grid;
}

int pass_slices_use(pass *p, const char *name, int *components) {
    return pass_fluid_use(p->label, pass_fluid_fields, PASS_FLUID_NAMES, slices_of(p)->used, name,
                          components);
}

// ---- declaring --------------------------------------------------------------------------------

static bool add_image(pass *p, slices_flow *f, int output, int index) {
    if (!pass_add_output(p, output,
                         (graph_image_desc){.width = f->desc.size[0],
                                            .height = f->desc.size[1],
                                            .depth = f->desc.count + 1,
                                            .optional = true,
                                            .keep = true}))
        return false;
    pass_host_add_grid_image(p->host, &f->grid, index, *pass_image(p, output));
    return true;
}

static bool gives(const pass *p, int uniform) {
    return p->uniforms[p->names[uniform].uniform];
}

static bool check_viscosity(const pass *p) {
    return !gives(p, N_viscosity) || !gives(p, N_reynolds) ||
           err_set("%s: 'reynolds' and 'viscosity' say the same; give one of them", p->label);
}

static bool slices_declare(pass *p) {
    slices_flow *f = slices_of(p);
    return check_viscosity(p) && add_image(p, f, N_scalars, 0) &&
           add_image(p, f, N_velocity, PASS_FLUID_VELOCITY / 4);
}

static flow_desc structure_of(const pass *p, const slices_flow *f) {
    flow_desc d = {
        .size = {f->desc.size[0], f->desc.size[1]},
        .slices = f->desc.count,
        .advection = (flow_advection)pass_option(p, N_advection),
        .solver = (flow_solver)pass_option(p, N_solver),
        .templates = f->templates && slices_has_pressing(p),
        .sources = f->templates && slices_has_pushing(p),
        .max_iterations = f->desc.max_iterations,
    };
    static const int faces[4] = {N_sides, N_sides, N_bottom, N_top};
    for (int i = 0; i < 4; i++) d.faces[i] = (flow_face)pass_option(p, faces[i]);
    for (size_t i = 0; i < f->part_count; i++) {
        bool template = slices_is_template(f->parts[i]);
        bool obstacle = slices_is_obstacle(f->parts[i]);
        d.obstacles = d.obstacles || obstacle;
        d.sources = d.sources || !(template || obstacle);
    }
    return d;
}

// ---- a frame ----------------------------------------------------------------------------------

static bool slices_update(pass *p) {
    const slices_flow *f = slices_of(p);
    const float size[3] = {(float)f->desc.size[0], (float)f->desc.size[1], (float)f->desc.count};
    pass_set(p, N_size, size, sizeof size);
    pass_set_float(p, N_blend, (float)slices_blend(f, p->host->context->time));
    return true;
}

static bool slices_rehearse(pass *p) {
    slices_flow *f = slices_of(p);
    flow_numbers numbers;
    if (!slices_numbers(p, &numbers)) return false;
    for (size_t i = 0; i < f->part_count; i++) {
        pass *part = f->parts[i];
        if (!pass_rehearse(part)) return err_prefix("%s: ", part->label);
    }
    return true;
}

static void note_content(slices_flow *f) {
    f->grid.state.content++;
    for (uint32_t i = 0; i < f->desc.count; i++)
        if (f->only[i]) f->only[i]->state.content = f->grid.state.content;
}

// The images of the last two states.
static void bind_looks(const slices_flow *f, kernel *k) {
    static const int names[FLOW_LOOKS][2] = {{N_scalars_now, N_scalars_before},
                                             {N_velocity_now, N_velocity_before}};
    for (int look = 0; look < FLOW_LOOKS; look++) {
        gpu_image *now = flow_image(f->solver, (flow_look)look, 0);
        gpu_image *before = flow_image(f->solver, (flow_look)look, 1);
        gpu_image *both[2] = {now, before ? before : now};
        for (int i = 0; i < 2; i++)
            kernel_bind(k, names[look][i],
                        (gpu_binding){.image = both[i], .sampler = GPU_NEAREST_CLAMP});
    }
}

// The grid for the host's time, unless it is that already.
static bool show(pass *p, slices_flow *f) {
    double blend = slices_blend(f, p->host->context->time);
    uint64_t steps = flow_steps(f->solver);
    if (steps == f->shown_steps && blend == f->shown_blend && pass_has_content(p)) return true;
    f->shown_steps = steps;
    f->shown_blend = blend;
    note_content(f);
    if (f->fresh || !flow_image(f->solver, FLOW_SCALARS, 0)) return pass_clear_outputs(p);
    kernel *k = pass_use(p, SLICES_SHOW);
    if (!k) return false;
    bind_looks(f, k);
    return kernel_run(k, p->host->device, f->desc.size[0], f->desc.size[1], f->desc.count + 1);
}

static bool slices_record(pass *p) {
    slices_flow *f = slices_of(p);
    f->last_steps = 0;
    if (!p->host->hold && !slices_advance(p)) return false;
    if (f->last_steps && !flow_watch(f->solver, p->host->device)) return false;
    gpu_pass_next(p->host->device, f->labels[SLICES_FIELDS]);
    return !pass_is_watched(p) || (pass_prepare(p) && show(p, f));
}

// ---- building ---------------------------------------------------------------------------------

static bool slices_complete(pass *p) {
    slices_flow *f = slices_of(p);
    if (p->host->interaction) slices_take_hand(p);
    flow_desc structure = structure_of(p, f);
    f->solver = flow_create(p->host->memory, &structure);
    if (!f->solver) return err_prefix("%s: ", p->label);
    const graph_image writes[] = {*pass_image(p, N_scalars), *pass_image(p, N_velocity)};
    return pass_add_part(p, &(pass_part){
                                .name = "step",
                                .writes = writes,
                                .write_count = COUNT_OF(writes),
                                .fields = true,
                                .with = f->parts,
                                .with_count = f->part_count,
                                .simulates = true,
                                .record = slices_record,
                            });
}

// Templates are drawn into the flow, if there are any.
static bool slices_defines(pass *p, size_t index, pass_defines *out) {
    const slices_flow *f = slices_of(p);
    if (index != SLICES_DRAW) return true;
    if (f->templates) slices_templates_define_draw(f, out);
    return f->templates;
}

static bool each_part(const slices_flow *f, bool (*call)(pass *part)) {
    for (size_t i = 0; i < f->part_count; i++)
        if (!call(f->parts[i])) return false;
    return true;
}

static bool slices_build(pass *p) {
    slices_flow *f = slices_of(p);
    const pass_host *host = p->host;
    if (!flow_build(f->solver, host->device, host->library, host->reader))
        return err_prefix("%s: ", p->label);
    return pass_build_kernels(p) && each_part(f, pass_build_part);
}

static bool slices_allocate(pass *p) {
    slices_flow *f = slices_of(p);
    return (flow_allocate(f->solver, p->host->device) || err_prefix("%s: ", p->label)) &&
           (!f->templates || slices_templates_allocate(f));
}

static void slices_list_memory(const pass *p, budget_list *out) {
    const slices_flow *f = slices_of(p);
    flow_list_memory(f->solver, out);
    if (f->templates) slices_templates_list_memory(f, out);
}

static void slices_destroy(pass *p) {
    slices_flow *f = slices_of(p);
    if (!f) return;
    if (f->templates) slices_templates_destroy(f);
    if (f->solver) flow_destroy(f->solver, p->host->device);
    mem_free(f->parts);
}

const pass_type slices_type = {
    .name = "slices",
    .constructed = true,
    .shader = "pass/slices/slices.comp",
    .kernels = kernels,
    .kernel_count = SLICES_KERNELS,
    .names = {slices_names, SLICES_NAME_COUNT},
    .solver = &flow_kernel_table,
    .unscaled = true,
    .simulation = &slices_simulation,
    .declare = slices_declare,
    .complete = slices_complete,
    .defines = slices_defines,
    .build = slices_build,
    .allocate = slices_allocate,
    .list_memory = slices_list_memory,
    .update = slices_update,
    .rehearse = slices_rehearse,
    .record = slices_record,
    .destroy = slices_destroy,
};
