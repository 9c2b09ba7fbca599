// A step is one dispatch over all elements, or bundles of them, unless there are faces that air can
// pass. The elements that touch these, the skin, are expensive. Then |- on GPUs the threads of the
// skin come first, and the others, the core, follow in the same dispatch: | the few slow ones run
// while the others work, and no group has both kinds; |- scalars of 27 directions, whose core is
// faster without the code for faces, and software devices, | which execute both sides of a branch,
// use two dispatches, with a shader for each part. |Each element has its own memory, so the order
// does not matter.
#include "base/memory.h"
#include "sim/lbm_impl.h"
#include <string.h>

static const char shader[] = "sim/lbm/step.comp";

static bool is_passable(const lbm *l) {
    for (int i = 0; i < 6; i++)
        if (l->desc.faces[i] >= LBM_OPEN) return true;
    return false;
}

static lbm_skin_order find_order(const lbm *l, bool software) {
    if (!is_passable(l)) return LBM_NO_SKIN;
    const bool alone = l->desc.scalars > 0 && l->desc.scalar_set == LBM_SCALAR_D3Q27;
    return software || alone ? LBM_SKIN_APART : LBM_SKIN_FIRST;
}

bool lbm_step_compile(lbm *l, const gpu_profile *device, shader_library *library,
                      const shader_reader *reader) {
    static const char *const regions[][2] = {
        [LBM_NO_SKIN] = {"LBM_WHOLE"},
        [LBM_SKIN_FIRST] = {"LBM_SKIN_FIRST"},
        [LBM_SKIN_APART] = {"LBM_CORE", "LBM_SKIN"},
    };
    const bool software = device->lbm_software_step && l->layout.lanes == 4;
    lbm_stepper *s = &l->stepper;
    s->order = find_order(l, software);
    s->parts = s->order == LBM_SKIN_APART ? 2 : 1;
    for (int i = 0; i < 2 * s->parts; i++) {
        lbm_kernel *k = &s->kernels[i / 2][i % 2];
        const shader_define defines[] = {
            {"LBM_SOFTWARE", software ? "1" : "0"},
            {"LBM_KEEP", i % 2 ? "1" : "0"},
            {"LBM_REGION", regions[s->order][i / 2]},
        };
        if (!lbm_kernel_compile(l, k, shader, library, reader, defines, 3)) return false;
    }
    return true;
}

bool lbm_step_build(lbm *l, gpu *g) {
    for (int i = 0; i < 2 * l->stepper.parts; i++)
        if (!kernel_build(&l->stepper.kernels[i / 2][i % 2].base, g)) return false;
    return true;
}

// ---- what faces touch ---------------------------------------------------------------------------

static bool at_face(const lbm *l, uint32_t x, uint32_t y, uint32_t layer) {
    const uint32_t at[3] = {x, y, layer};
    const uint32_t last[3] = {l->desc.size[0] - 1, l->desc.size[1] - 1, lbm_depth(l) - 1};
    for (int i = 0; i < 3; i++)
        if (l->desc.faces[2 * i] != LBM_PERIODIC && (at[i] == 0 || at[i] == last[i])) return true;
    return false;
}

// Lists the skin in the order of memory, so that neighbours in the list read adjacent memory.
static uint32_t list_skin(const lbm *l, uint32_t *out) {
    const uint32_t nx = l->desc.size[0], layer = nx * l->desc.size[1];
    uint32_t count = 0;
    for (uint32_t i = 0; i < layer * lbm_depth(l); i++)
        if (at_face(l, i % layer % nx, i % layer / nx, i / layer)) out[count++] = i;
    return count;
}

// Where the core follows in the same dispatch, the skin gets as many threads as the lattice has
// columns in a layer.
static void set_threads(lbm *l) {
    lbm_stepper *s = &l->stepper;
    const uint32_t layer = l->desc.size[0] * l->desc.size[1];
    if (s->order == LBM_SKIN_FIRST) s->skin_layers = (s->skin_count + layer - 1) / layer;
    const uint32_t threads[2][3] = {{layer, 1, lbm_depth(l) + s->skin_layers},
                                    {s->skin_count, 1, 1}};
    for (int i = 0; i < 2 * s->parts; i++)
        memcpy(s->kernels[i / 2][i % 2].threads, threads[i / 2], sizeof threads[0]);
}

bool lbm_step_allocate(lbm *l, gpu *g) {
    lbm_stepper *s = &l->stepper;
    bool done = true;
    if (s->order != LBM_NO_SKIN && !s->skin) {
        uint32_t *list = mem_alloc(l->layout.elements * sizeof *list);
        s->skin_count = list_skin(l, list);
        s->skin = gpu_buffer_create(
            g, &(gpu_buffer_desc){.label = "elements at faces", .size = s->skin_count * 4ull});
        done = s->skin && gpu_buffer_write(g, s->skin, 0, list, s->skin_count * 4ull);
        mem_free(list);
    }
    set_threads(l);
    return done;
}

void lbm_step_list_memory(const lbm *l, budget_list *out) {
    uint64_t inner = 1;
    for (int i = 0; i < 3; i++) {
        const uint64_t size = i < 2 ? l->desc.size[i] : lbm_depth(l);
        inner *= l->desc.faces[2 * i] == LBM_PERIODIC ? size : size > 2 ? size - 2 : 0;
    }
    const uint64_t all = (uint64_t)l->desc.size[0] * l->desc.size[1] * lbm_depth(l);
    if (l->stepper.order != LBM_NO_SKIN && !l->stepper.skin)
        budget_list_add(out, "elements at faces", (all - inner) * 4);
}

void lbm_step_destroy(lbm *l, gpu *g) {
    lbm_stepper *s = &l->stepper;
    for (int i = 0; i < 4; i++) kernel_destroy(&s->kernels[i / 2][i % 2].base, g);
    gpu_buffer_destroy(g, s->skin);
    s->skin = NULL;
}

// ---- a step -----------------------------------------------------------------------------------

static void set_numbers(const lbm *l, lbm_kernel *k, const lbm_numbers *n) {
    const float most = n->max_speed > 0 ? n->max_speed : 1e6f;
    float buoyancy[LBM_MAX_SCALARS][4] = {0};
    for (int i = 0; i < LBM_MAX_SCALARS; i++)
        memcpy(buoyancy[i], n->buoyancy[i], sizeof n->buoyancy[i]);
    kernel_set(&k->base, N_tau, &n->tau, sizeof n->tau);
    kernel_set(&k->base, N_scalar_tau, n->scalar_tau, sizeof n->scalar_tau);
    kernel_set(&k->base, N_smagorinsky, &n->smagorinsky, sizeof n->smagorinsky);
    kernel_set(&k->base, N_acceleration, n->acceleration, sizeof n->acceleration);
    kernel_set(&k->base, N_buoyancy, buoyancy, sizeof buoyancy);
    kernel_set(&k->base, N_ambient, n->ambient, sizeof n->ambient);
    kernel_set(&k->base, N_decay, n->decay, sizeof n->decay);
    kernel_set(&k->base, N_max_speed, &most, sizeof most);
    kernel_set(&k->base, N_force_scale, &l->force_scale, sizeof l->force_scale);
    kernel_set(&k->base, N_outflow_scale, &l->outflow_scale, sizeof l->outflow_scale);
    kernel_set(&k->base, N_skin_layers, &l->stepper.skin_layers, sizeof l->stepper.skin_layers);
    kernel_set(&k->base, N_skin_count, &l->stepper.skin_count, sizeof l->stepper.skin_count);
    lbm_walls_set(l, k, n);
}

bool lbm_step(lbm *l, gpu *g, const lbm_numbers *numbers, bool keep) {
    if (!lbm_walls_ready(l) || (keep && !lbm_make_moments(l, g, l->kept % 2))) return false;
    for (int part = 0; part < l->stepper.parts; part++) {
        lbm_kernel *k = &l->stepper.kernels[part][keep];
        set_numbers(l, k, numbers);
        if (!lbm_kernel_run(l, k, g)) return false;
    }
    l->kept += keep;
    l->steps++;
    return true;
}
