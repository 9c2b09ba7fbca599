#include "pass/march/probe.h"
#include "pass/pass_impl.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define NAMES(NAME) NAME(origin), NAME(way), NAME(nearest), NAME(farthest), NAME(Probed)
KERNEL_NAMES(NAMES);

enum { RESULT = (1 + PASS_PROBE_VALUES) * 4 * sizeof(float) };

typedef struct probe_state {
    gpu_buffer *result;
    float origin[3], way[3], range[2];
} probe_state;

static bool probe_update(pass *p) {
    const probe_state *s = p->state;
    pass_set(p, N_origin, s->origin, sizeof s->origin);
    pass_set(p, N_way, s->way, sizeof s->way);
    pass_set_float(p, N_nearest, s->range[0]);
    pass_set_float(p, N_farthest, s->range[1]);
    return true;
}

static size_t probe_buffers(const pass *p, pass_buffer out[PASS_BUFFERS]) {
    probe_state *s = p->state;
    out[0] = (pass_buffer){&s->result, "probe", RESULT};
    return 1;
}

static bool probe_record(pass *p) {
    const probe_state *s = p->state;
    if (!pass_prepare(p)) return false;
    kernel *k = pass_use(p, 0);
    if (!k) return false;
    kernel_bind_buffer(k, N_Probed, s->result);
    return kernel_run(k, p->host->device, 1, 1, 1);
}

static const pass_kernel kernels[] = {{0}};

const pass_type pass_probe_type = {
    .name = "probe",
    .constructed = true,
    .shader = "pass/march/probe.comp",
    .kernels = kernels,
    .kernel_count = 1,
    .names = {names, sizeof names / sizeof *names},
    .update = probe_update,
    .buffers = probe_buffers,
    .record = probe_record,
};

static bool probe_set(pass *p, const field *density, const field *const *values, size_t count) {
    if (!pass_set_field(p, "density", density)) return false;
    for (size_t i = 0; i < count; i++) {
        char name[32];
        snprintf(name, sizeof name, "value_%zu", i);
        const field *value = values[i]; // three become four
        if (value->components == 3) value = field_swizzle(p->host->memory, value, "rgbr");
        if (!pass_set_field(p, name, value)) return false;
    }
    return true;
}

pass *pass_probe_create(pass_host *host, const field *density, const field *const *values,
                        size_t count) {
    pass *p = pass_create(host, &pass_probe_type, NULL, "probe");
    if (!p) return NULL;
    p->state = arena_alloc(host->memory, sizeof(probe_state));
    if (probe_set(p, density, values, count) && pass_build(p) && pass_allocate(p)) return p;
    pass_destroy(p);
    return NULL;
}

bool pass_probe_sees(const pass_host *host, const field *node) {
    const field_grid *grids[16];
    size_t count = field_grids(node, grids, 16);
    for (size_t i = 0; i < count && i < 16; i++)
        for (int k = 0; k < FIELD_GRID_IMAGES; k++) {
            graph_image image = pass_grid_image(host, grids[i], k);
            if (image.id && field_samples(node, grids[i], k) &&
                !graph_get_image(host->graph, image))
                return false;
        }
    return true;
}

// Cuts the ray to the box. False: it misses it.
static bool cut(probe_state *s, box3 box) {
    const float low[3] = {box.min.x, box.min.y, box.min.z};
    const float high[3] = {box.max.x, box.max.y, box.max.z};
    s->range[0] = 0;
    s->range[1] = INFINITY;
    for (int i = 0; i < 3; i++) {
        float a = (low[i] - s->origin[i]) / s->way[i], b = (high[i] - s->origin[i]) / s->way[i];
        if (s->way[i] == 0) {
            if (s->origin[i] < low[i] || s->origin[i] > high[i]) return false;
            continue;
        }
        s->range[0] = fmaxf(s->range[0], fminf(a, b));
        s->range[1] = fminf(s->range[1], fmaxf(a, b));
    }
    return s->range[1] > s->range[0] && isfinite(s->range[1]);
}

bool pass_probe_look(pass *p, const float origin[3], const float way[3],
                     float out[1 + PASS_PROBE_VALUES][4]) {
    probe_state *s = p->state;
    gpu *g = p->host->device;
    box3 box;
    memset(out, 0, RESULT);
    out[0][3] = -1;
    memcpy(s->origin, origin, sizeof s->origin);
    memcpy(s->way, way, sizeof s->way);
    if (!pass_density_box(p, &box)) return false;
    if (box3_is_empty(box) || !cut(s, box)) return true;
    if (!gpu_frame_begin(g)) return false;
    gpu_pass_begin(g, "probe");
    bool done = probe_record(p);
    gpu_pass_end(g);
    return gpu_frame_end(g) && done && gpu_buffer_read(g, s->result, 0, out, RESULT);
}
