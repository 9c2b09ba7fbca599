// A step: one dispatch over all elements. Or two, where there are faces that air can pass, which
// take many registers, and on software devices, which take both ways of a branch, time everywhere:
// over the elements that no face touches, whose shader knows nothing of faces, and over a list of
// those that one does. Each element has places in memory of its own, so their order does not
// matter; where a bundle has elements of both, the first leaves those of the second as they are.
#include "base/memory.h"
#include "sim/lbm_impl.h"
#include <string.h>

static const char shader[] = "sim/lbm/step.comp";

static bool is_software(const gpu_info *device) {
    return device && device->kind == GPU_CPU && device->int64;
}

static bool is_passable(const lbm *l) {
    for (int i = 0; i < 6; i++)
        if (l->desc.faces[i] >= LBM_OPEN) return true;
    return false;
}

bool lbm_step_compile(lbm *l, const gpu_info *device, shader_library *library,
                      const shader_reader *reader) {
    static const char *const regions[] = {"LBM_WHOLE", "LBM_CORE", "LBM_SKIN"};
    lbm_stepper *s = &l->stepper;
    s->parts = is_passable(l) ? 2 : 1;
    for (int i = 0; i < 2 * s->parts; i++) {
        lbm_kernel *k = &s->kernels[i / 2][i % 2];
        const bool bundled = l->layout.bundle > 1 && i < 2; // not those in the list
        const bool software = is_software(device) && l->layout.lanes == 4;
        const shader_define defines[] = {
            {"LBM_SOFTWARE", software ? "1" : "0"},
            {"LBM_KEEP", i % 2 ? "1" : "0"},
            {"LBM_REGION", regions[s->parts == 1 ? 0 : 1 + i / 2]},
            {"LBM_BUNDLED", bundled ? "1" : "0"},
        };
        k->threads[0] = l->desc.size[0] * l->desc.size[1];
        k->threads[1] = 1;
        k->threads[2] = l->layout.layers / (bundled ? l->layout.bundle : 1);
        if (!lbm_kernel_compile(l, k, shader, library, reader, defines, 4)) return false;
    }
    return true;
}

bool lbm_step_build(lbm *l, gpu *g) {
    for (int i = 0; i < 2 * l->stepper.parts; i++)
        if (!sim_kernel_build(&l->stepper.kernels[i / 2][i % 2].base, g)) return false;
    return true;
}

// ---- the elements at faces --------------------------------------------------------------------

static bool at_face(const lbm *l, uint32_t x, uint32_t y, uint32_t layer) {
    const uint32_t at[3] = {x, y, layer};
    const uint32_t last[3] = {l->desc.size[0] - 1, l->desc.size[1] - 1, l->layout.layers - 1};
    for (int i = 0; i < 3; i++)
        if (l->desc.faces[2 * i] != LBM_PERIODIC && (at[i] == 0 || at[i] == last[i])) return true;
    return false;
}

// In the order of memory, so that neighbours in the list read what is side by side.
static uint32_t list_skin(const lbm *l, uint32_t *out) {
    const uint32_t nx = l->desc.size[0], ny = l->desc.size[1];
    const uint32_t bundle = l->layout.bundle, span = l->layout.layers / bundle;
    uint32_t count = 0;
    for (uint32_t i = 0; i < l->layout.elements; i++) {
        const uint32_t column = i / bundle % (nx * ny);
        const uint32_t z = i / bundle / (nx * ny) + i % bundle * span;
        if (at_face(l, column % nx, column / nx, z)) out[count++] = column + nx * ny * z;
    }
    return count;
}

bool lbm_step_allocate(lbm *l, gpu *g) {
    lbm_stepper *s = &l->stepper;
    if (s->parts == 1 || s->skin) return true;
    uint32_t *list = mem_alloc(l->layout.elements * sizeof *list);
    s->skin_count = list_skin(l, list);
    s->skin = gpu_buffer_create(
        g, &(gpu_buffer_desc){.label = "elements at faces", .size = s->skin_count * 4ull});
    bool done = s->skin && gpu_buffer_write(g, s->skin, 0, list, s->skin_count * 4ull);
    mem_free(list);
    for (int kept = 0; kept < 2; kept++) {
        uint32_t threads[3] = {s->skin_count, 1, 1};
        memcpy(s->kernels[1][kept].threads, threads, sizeof threads);
    }
    return done;
}

void lbm_step_destroy(lbm *l, gpu *g) {
    lbm_stepper *s = &l->stepper;
    for (int i = 0; i < 4; i++) sim_kernel_destroy(&s->kernels[i / 2][i % 2].base, g);
    gpu_buffer_destroy(g, s->skin);
    s->skin = NULL;
}

// ---- a step -----------------------------------------------------------------------------------

static void set_numbers(const lbm *l, lbm_kernel *k, const lbm_numbers *n) {
    const float most = n->max_speed > 0 ? n->max_speed : 1e6f;
    float buoyancy[LBM_MAX_SCALARS][4] = {0};
    for (int i = 0; i < LBM_MAX_SCALARS; i++)
        memcpy(buoyancy[i], n->buoyancy[i], sizeof n->buoyancy[i]);
    lbm_kernel_set(k, "tau", &n->tau, sizeof n->tau);
    lbm_kernel_set(k, "scalar_tau", n->scalar_tau, sizeof n->scalar_tau);
    lbm_kernel_set(k, "smagorinsky", &n->smagorinsky, sizeof n->smagorinsky);
    lbm_kernel_set(k, "acceleration", n->acceleration, sizeof n->acceleration);
    lbm_kernel_set(k, "buoyancy", buoyancy, sizeof buoyancy);
    lbm_kernel_set(k, "ambient", n->ambient, sizeof n->ambient);
    lbm_kernel_set(k, "decay", n->decay, sizeof n->decay);
    lbm_kernel_set(k, "max_speed", &most, sizeof most);
    lbm_kernel_set(k, "force_scale", &l->force_scale, sizeof l->force_scale);
    lbm_kernel_set(k, "skin_count", &l->stepper.skin_count, sizeof l->stepper.skin_count);
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
