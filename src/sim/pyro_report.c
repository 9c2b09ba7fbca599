// Three dispatches per frame, and a copy of their result to one of as many places as frames can be
// in flight (as in flow_report.c).
#include "sim/pyro_impl.h"
#include <string.h>

bool pyro_report_allocate(pyro *p, gpu *g) {
    pyro_reporter *r = &p->reporter;
    const uint64_t record = PYRO_REPORT_WORDS * sizeof(float);
    if (r->result) return true;
    r->found = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "report of burning gas",
                                                       .size = PYRO_REPORT_PLACES * record,
                                                       .kind = GPU_BUFFER_READBACK});
    r->result = gpu_image_create(g, &(gpu_image_desc){.label = "report of burning gas",
                                                      .format = GPU_R32U,
                                                      .width = PYRO_REPORT_WORDS,
                                                      .height = 1,
                                                      .use = GPU_USE_STORAGE});
    return r->found && r->result;
}

void pyro_report_destroy(pyro *p, gpu *g) {
    gpu_buffer_destroy(g, p->reporter.found);
    gpu_image_destroy(g, p->reporter.result);
    p->reporter = (pyro_reporter){0};
}

bool pyro_watch(pyro *p, gpu *g, const pyro_numbers *n) {
    pyro_reporter *r = &p->reporter;
    const uint32_t place = r->next;
    const float weights[3] = {1, 1, 1};
    const int32_t gas_groups = (int32_t)(pyro_cells(p) / PYRO_CELLS_A_GROUP);
    const int32_t flow_groups = (int32_t)(pyro_flow_cells(p) / PYRO_CELLS_A_GROUP);
    if (p->steps == 0) return true;
    kernel *gas = pyro_use(p, PYRO_K_REPORT), *flow = pyro_use(p, PYRO_K_REPORT_FLOW);
    kernel *last = pyro_use(p, PYRO_K_REPORT_LAST);
    pyro_set_burning(gas, n);
    kernel_set_float(gas, N_mass, 353 * n->cell * n->cell * n->cell);
    kernel_set_int(gas, N_first, 0);
    kernel_set(flow, N_inflow, n->inflow, sizeof n->inflow);
    kernel_set(flow, N_weights, weights, sizeof weights);
    kernel_set_int(flow, N_first, gas_groups);
    if (p->desc.advection == PYRO_REFLECTION) // of which the right-hand side is
        kernel_bind_buffer(flow, N_PyroPressure, p->buffers[PYRO_MEM_MORE_PRESSURE]);
    kernel_bind_image(last, N_result, r->result);
    kernel_set_int(last, N_groups, gas_groups + flow_groups);
    if (!pyro_run_gas(p, g, gas) || !pyro_run(p, g, flow) ||
        !kernel_run(last, g, PYRO_CELLS_A_GROUP, 1, 1) ||
        !gpu_image_copy_to_buffer(g, r->result, r->found,
                                  place * PYRO_REPORT_WORDS * sizeof(float)))
        return false;
    r->places[place].frame = gpu_frame_open(g);
    r->places[place].step = p->steps;
    r->next = (place + 1) % PYRO_REPORT_PLACES;
    return true;
}

bool pyro_read(const pyro *p, gpu *g, pyro_report *out) {
    const pyro_reporter *r = &p->reporter;
    for (uint32_t age = 1; age <= PYRO_REPORT_PLACES; age++) {
        const uint32_t place = (r->next + PYRO_REPORT_PLACES - age) % PYRO_REPORT_PLACES;
        if (r->places[place].frame == 0 || !gpu_frame_done(g, r->places[place].frame)) continue;
        float w[PYRO_REPORT_WORDS];
        memcpy(w, (const char *)gpu_buffer_map(r->found) + place * sizeof w, sizeof w);
        *out = (pyro_report){.step = r->places[place].step,
                             .bad = (uint32_t)w[0],
                             .speed = w[1],
                             .residual = w[2],
                             .hottest = w[3],
                             .fuel = w[4],
                             .burnt = w[5],
                             .soot = w[6],
                             .power = w[7]};
        return true;
    }
    return false;
}
