// A step: diffusion, advection with forces and sources, the projection; and what the state looks
// like after it.
#include "base/error.h"
#include "sim/flow_impl.h"
#include <math.h>
#include <string.h>

// Central differences are stable up to 1/4 of a cell's square in a step.
static const float explicit_limit = 0.2f;
enum { MOST_STAGES = 30 };

static void set_float(sim_kernel *k, const char *name, float value) {
    sim_kernel_set(k, name, &value, sizeof value);
}

static void threads_of(const flow *f, bool corners, uint32_t out[3]) {
    out[0] = f->desc.size[0] + corners;
    out[1] = f->desc.size[1] + corners;
    out[2] = f->desc.slices;
}

static void set_walls(sim_kernel *k, const flow_numbers *n) {
    float walls[4][4] = {0};
    for (int i = 0; i < 4; i++) memcpy(walls[i], n->wall_velocity[i], sizeof n->wall_velocity[i]);
    sim_kernel_set(k, "wall_velocity", walls, sizeof walls);
    set_float(k, "friction", n->friction);
}

// ---- diffusion --------------------------------------------------------------------------------

static int count_stages(float diffusion) {
    int stages = 3; // so that the last one writes where the first one read
    while (stages < MOST_STAGES &&
           explicit_limit * (float)(stages * stages + stages) / 2 < diffusion)
        stages += 3;
    return stages;
}

// A part of its own, before advection: central differences of a field, added to where that has gone
// in the step, burst where it goes about a cell.
static bool diffuse(flow *f, gpu *g, const flow_numbers *n) {
    float diffusion = n->viscosity > 0 ? n->viscosity * n->dt / (n->cell * n->cell) : 0;
    if (!(diffusion > 0)) return true;
    sim_kernel *k = &f->kernels.diffuse;
    const int stages = count_stages(diffusion);
    const float parts = (float)(stages * stages + stages) / 2;
    if (diffusion > explicit_limit * parts) diffusion = explicit_limit * parts;
    set_walls(k, n);
    for (int j = 1; j <= stages; j++) {
        const float own = j == 1 ? 1 : (2 * (float)j - 1) / (float)j;
        const float weights[3] = {own, (1 - (float)j) / (float)j, own * diffusion / parts};
        gpu_buffer *const *v = &f->buffers[FLOW_MEM_VELOCITY];
        const sim_slot more[] = {{"FlowVelocityFrom", v[(j + 2) % 3], NULL},
                                 {"FlowVelocityLast", v[(j == 1 ? j + 2 : j + 1) % 3], NULL},
                                 {"FlowVelocityTo", v[j % 3], NULL}};
        flow_call call = {.kernel = k, .more = more, .count = 3};
        threads_of(f, true, call.threads);
        sim_kernel_set(k, "weights", weights, sizeof weights);
        if (!flow_run(f, g, &call)) return false;
    }
    return true;
}

// ---- advection --------------------------------------------------------------------------------

static void set_carry(const flow *f, sim_kernel *k, const flow_numbers *n) {
    float fresh[4];
    for (int i = 0; i < 4; i++) {
        const float inward = n->wall_velocity[i][i / 2] * (i % 2 ? -1.0f : 1.0f);
        fresh[i] = f->desc.faces[i] == FLOW_OPEN || (f->desc.faces[i] == FLOW_CLOSED && inward > 0);
    }
    sim_kernel_set(k, "fresh", fresh, sizeof fresh);
    set_float(k, "reach", n->dt / n->cell);
}

static bool predict(flow *f, gpu *g, const flow_numbers *n) {
    flow_call call = {.kernel = &f->kernels.predict};
    threads_of(f, true, call.threads);
    set_carry(f, call.kernel, n);
    return flow_run(f, g, &call);
}

static bool advance(flow *f, gpu *g, const flow_numbers *n) {
    sim_kernel *k = &f->kernels.advance;
    const float most = 32 * n->cell / n->dt;
    float kept[3];
    for (int i = 0; i < 3; i++) kept[i] = expf(-n->decay[i] * n->dt);
    set_carry(f, k, n);
    set_walls(k, n);
    set_float(k, "dt", n->dt);
    sim_kernel_set(k, "acceleration", n->acceleration, sizeof n->acceleration);
    sim_kernel_set(k, "buoyancy", n->buoyancy, sizeof n->buoyancy);
    set_float(k, "vorticity", n->vorticity);
    sim_kernel_set(k, "kept", kept, sizeof kept);
    set_float(k, "max_speed", n->max_speed > 0 && n->max_speed < most ? n->max_speed : most);
    const sim_slot more[] = {
        {"FlowVelocityTo", f->buffers[FLOW_MEM_VELOCITY_NEXT], NULL},
        {"FlowScalarsTo", flow_pair(f, FLOW_MEM_SCALARS, 1), NULL},
    };
    flow_call call = {.kernel = k, .more = more, .count = 2};
    threads_of(f, true, call.threads);
    return flow_run(f, g, &call);
}

// ---- looks ------------------------------------------------------------------------------------

gpu_image *flow_image(const flow *f, flow_look look, int which) {
    return f->kept > (uint64_t)which ? f->looks[(f->kept + 1 + (uint64_t)which) % 2][look] : NULL;
}

bool flow_make_look(flow *f, gpu *g, uint32_t which, flow_look look) {
    gpu_image **image = &f->looks[which][look];
    if (*image) return true;
    *image = gpu_image_create(
        g, &(gpu_image_desc){.label = look == FLOW_SCALARS ? "flow's scalars" : "flow's velocity",
                             .format = look == FLOW_SCALARS ? GPU_RGBA16F : GPU_RG16F,
                             .width = f->desc.size[0],
                             .height = f->desc.size[1],
                             .depth = f->desc.slices,
                             .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
    return *image != NULL;
}

static bool look(flow *f, gpu *g, const flow_numbers *n) {
    for (flow_look i = 0; i < FLOW_LOOKS; i++)
        if (!flow_make_look(f, g, f->kept % 2, i)) return false;
    const sim_slot more[] = {{"scalars", NULL, f->looks[f->kept % 2][FLOW_SCALARS]},
                             {"velocity", NULL, f->looks[f->kept % 2][FLOW_VELOCITY]}};
    flow_call call = {.kernel = &f->kernels.look, .more = more, .count = 2};
    threads_of(f, false, call.threads);
    set_float(call.kernel, "pressure_unit", n->dt / n->cell);
    f->kept++;
    return flow_run(f, g, &call);
}

// ---- a step -----------------------------------------------------------------------------------

bool flow_reset(flow *f, gpu *g) {
    f->kept = f->steps = 0;
    f->current = 0;
    f->built = false;
    memset(f->reporter.places, 0, sizeof f->reporter.places);
    for (int i = 0; i < FLOW_MEM_COUNT; i++)
        if (f->buffers[i]) gpu_buffer_fill(g, f->buffers[i], 0);
    return true;
}

bool flow_step(flow *f, gpu *g, const flow_numbers *n, bool keep) {
    if (!(n->dt > 0) || !(n->cell > 0))
        return err_set("a step of %g s on cells of %g m; both must be more than 0", (double)n->dt,
                       (double)n->cell);
    if (!diffuse(f, g, n)) return false;
    if (f->desc.advection == FLOW_MACCORMACK && !predict(f, g, n)) return false;
    if (!advance(f, g, n) || !flow_project(f, g, n)) return false;
    f->current ^= 1;
    f->steps++;
    return !keep || look(f, g, n);
}
