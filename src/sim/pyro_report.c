// Three dispatches per frame, whose result is read when the frame is done.
#include "sim/pyro_impl.h"
#include <string.h>

bool pyro_watch(pyro *p, gpu *g, const pyro_numbers *n) {
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
    kernel_bind_image(last, N_result, p->report.image);
    kernel_set_int(last, N_groups, gas_groups + flow_groups);
    return pyro_run_gas(p, g, gas) && pyro_run(p, g, flow) &&
           kernel_run(last, g, PYRO_CELLS_A_GROUP, 1, 1) &&
           kernel_readback_send(&p->report, g, p->steps);
}

bool pyro_read(const pyro *p, gpu *g, pyro_report *out) {
    float w[PYRO_REPORT_WORDS];
    uint64_t step;
    const void *found = kernel_readback_newest(&p->report, g, &step);
    if (!found) return false;
    memcpy(w, found, sizeof w);
    *out = (pyro_report){.step = step,
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
