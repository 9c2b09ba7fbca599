// A step: diffusion, advection with forces and sources, the projection; then the images of the
// state.
#include "base/error.h"
#include "sim/flow_impl.h"
#include <math.h>
#include <string.h>

// Central differences are stable up to 1/4 of the square of a cell per step.
static const float explicit_limit = 0.2f;
enum { MOST_STAGES = 30 };

// Runs a thread for each cell, or for each corner of a cell.
static bool run_each(const flow *f, gpu *g, kernel *k, bool corners) {
    const uint32_t *size = f->desc.size;
    return kernel_run(k, g, size[0] + corners, size[1] + corners, f->desc.slices);
}

static void set_walls(kernel *k, const flow_numbers *n) {
    float walls[4][4] = {0};
    for (int i = 0; i < 4; i++) memcpy(walls[i], n->wall_velocity[i], sizeof n->wall_velocity[i]);
    kernel_set(k, N_wall_velocity, walls, sizeof walls);
    kernel_set_float(k, N_friction, n->friction);
}

// ---- diffusion --------------------------------------------------------------------------------

static int count_stages(float diffusion) {
    int stages = 3; // so that the last one writes where the first one read
    while (stages < MOST_STAGES &&
           explicit_limit * (float)(stages * stages + stages) / 2 < diffusion)
        stages += 3;
    return stages;
}

// Diffusion is separate from advection: central differences of a field are added where the field
// was advected to. Within advection it would diverge where the field moves about a cell.
static bool diffuse(flow *f, gpu *g, const flow_numbers *n) {
    float diffusion = n->viscosity > 0 ? n->viscosity * n->dt / (n->cell * n->cell) : 0;
    if (!(diffusion > 0)) return true;
    kernel *k = flow_use(f, FLOW_DIFFUSE);
    const int stages = count_stages(diffusion);
    const float parts = (float)(stages * stages + stages) / 2;
    if (diffusion > explicit_limit * parts) diffusion = explicit_limit * parts;
    set_walls(k, n);
    for (int j = 1; j <= stages; j++) {
        const float own = j == 1 ? 1 : (2 * (float)j - 1) / (float)j;
        const float weights[3] = {own, (1 - (float)j) / (float)j, own * diffusion / parts};
        gpu_buffer *const *v = &f->buffers[FLOW_MEM_VELOCITY];
        kernel_bind_buffer(k, N_FlowVelocityFrom, v[(j + 2) % 3]);
        kernel_bind_buffer(k, N_FlowVelocityLast, v[(j == 1 ? j + 2 : j + 1) % 3]);
        kernel_bind_buffer(k, N_FlowVelocityTo, v[j % 3]);
        kernel_set(k, N_weights, weights, sizeof weights);
        if (!run_each(f, g, k, true)) return false;
    }
    return true;
}

// ---- advection --------------------------------------------------------------------------------

static void set_carry(const flow *f, kernel *k, const flow_numbers *n) {
    float fresh[4];
    for (int i = 0; i < 4; i++) {
        const float inward = n->wall_velocity[i][i / 2] * (i % 2 ? -1.0f : 1.0f);
        fresh[i] = f->desc.faces[i] == FLOW_OPEN || (f->desc.faces[i] == FLOW_CLOSED && inward > 0);
    }
    kernel_set(k, N_fresh, fresh, sizeof fresh);
    kernel_set_float(k, N_reach, n->dt / n->cell);
}

static bool flow_predict(flow *f, gpu *g, const flow_numbers *n) {
    kernel *k = flow_use(f, FLOW_PREDICT);
    set_carry(f, k, n);
    return run_each(f, g, k, true);
}

static bool flow_advance(flow *f, gpu *g, const flow_numbers *n) {
    kernel *k = flow_use(f, FLOW_ADVANCE);
    const float most = 32 * n->cell / n->dt;
    float kept[3];
    for (int i = 0; i < 3; i++) kept[i] = expf(-n->decay[i] * n->dt);
    set_carry(f, k, n);
    set_walls(k, n);
    kernel_set_float(k, N_dt, n->dt);
    kernel_set(k, N_acceleration, n->acceleration, sizeof n->acceleration);
    kernel_set(k, N_buoyancy, n->buoyancy, sizeof n->buoyancy);
    kernel_set_float(k, N_vorticity, n->vorticity);
    kernel_set(k, N_kept, kept, sizeof kept);
    kernel_set_float(k, N_max_speed, n->max_speed > 0 && n->max_speed < most ? n->max_speed : most);
    kernel_bind_buffer(k, N_FlowVelocityTo, f->buffers[FLOW_MEM_VELOCITY_NEXT]);
    kernel_bind_buffer(k, N_FlowScalarsTo, flow_pair(f, FLOW_MEM_SCALARS, 1));
    return run_each(f, g, k, true);
}

// ---- looks ------------------------------------------------------------------------------------

gpu_image *flow_image(const flow *f, flow_look look, int which) {
    return f->kept > (uint64_t)which ? f->looks[(f->kept + 1 + (uint64_t)which) % 2][look] : NULL;
}

gpu_image_desc flow_describe_look(const flow *f, flow_look look) {
    return (gpu_image_desc){.label = look == FLOW_SCALARS ? "flow's scalars" : "flow's velocity",
                            .format = look == FLOW_SCALARS ? GPU_RGBA16F : GPU_RG16F,
                            .width = f->desc.size[0],
                            .height = f->desc.size[1],
                            .depth = f->desc.slices,
                            .use = GPU_USE_SAMPLED | GPU_USE_STORAGE};
}

static bool flow_make_look(flow *f, gpu *g, uint32_t which, flow_look look) {
    gpu_image **image = &f->looks[which][look];
    const gpu_image_desc desc = flow_describe_look(f, look);
    if (!*image) *image = gpu_image_create(g, &desc);
    return *image != NULL;
}

bool flow_keep(flow *f, gpu *g, const flow_numbers *n) {
    for (flow_look i = 0; i < FLOW_LOOKS; i++)
        if (!flow_make_look(f, g, f->kept % 2, i)) return false;
    kernel *k = flow_use(f, FLOW_LOOK_AT);
    kernel_bind_image(k, N_scalars, f->looks[f->kept % 2][FLOW_SCALARS]);
    kernel_bind_image(k, N_velocity, f->looks[f->kept % 2][FLOW_VELOCITY]);
    kernel_set_float(k, N_pressure_unit, n->dt / n->cell);
    f->kept++;
    return run_each(f, g, k, false);
}

// ---- a step -----------------------------------------------------------------------------------

bool flow_reset(flow *f, gpu *g) {
    f->kept = f->steps = 0;
    f->current = 0;
    f->built = false;
    kernel_readback_forget(&f->report);
    for (int i = 0; i < FLOW_MEM_COUNT; i++)
        if (f->buffers[i]) gpu_buffer_fill(g, f->buffers[i], 0);
    return true;
}

bool flow_step(flow *f, gpu *g, const flow_numbers *n, bool keep) {
    if (!(n->dt > 0) || !(n->cell > 0))
        return err_set("a step of %g s on cells of %g m; both must be more than 0", (double)n->dt,
                       (double)n->cell);
    if (!diffuse(f, g, n)) return false;
    if (f->desc.advection == FLOW_MACCORMACK && !flow_predict(f, g, n)) return false;
    if (!flow_advance(f, g, n) || !flow_project(f, g, n)) return false;
    f->current ^= 1;
    f->steps++;
    return !keep || flow_keep(f, g, n);
}
